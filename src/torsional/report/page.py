"""The page: sections put through the template."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from torsional import __version__
from torsional.report.analysis import Comparison
from torsional.report.blocks import Section
from torsional.report.sections import sections

HERE = Path(__file__).parent


def rendered(comparison: Comparison) -> str:
    """The whole page about models as text."""
    first, *others = comparison.variants
    about = ", ".join(variant.label for variant in others)
    return html_page(
        first.model.name,
        "torsional vibrations",
        f"Torsional vibrations{f', compared with {about}' if about else ''}",
        sections(comparison),
        [(variant.label, variant.model.hash) for variant in comparison.variants],
    )


def html_page(title: str, subject: str, lead: str, parts: Sequence[Section], models: Sequence[tuple[str, str]]) -> str:
    """A page of sections as text, the ``models`` (label, hash) named at its foot; what a user named is escaped."""
    environment = Environment(
        loader=FileSystemLoader(HERE), autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    return environment.get_template("template.html.j2").render(
        title=title, subject=subject, lead=lead, sections=parts, variants=models, version=__version__
    )
