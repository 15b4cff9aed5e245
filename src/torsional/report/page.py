"""The page: sections put through the template."""

from __future__ import annotations

from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from torsional import __version__
from torsional.report.analysis import Comparison
from torsional.report.sections import sections

HERE = Path(__file__).parent


def rendered(comparison: Comparison) -> str:
    """The whole page as text; everything a user named is escaped."""
    environment = Environment(
        loader=FileSystemLoader(HERE), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    first, *others = comparison.variants
    about = ", ".join(variant.label for variant in others)
    return environment.get_template("template.html.j2").render(
        title=first.model.name,
        against=about,
        sections=sections(comparison),
        variants=[(variant.label, variant.model.hash) for variant in comparison.variants],
        version=__version__,
    )
