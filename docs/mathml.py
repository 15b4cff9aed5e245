"""Formulas as MathML, written at build time: the pages need neither a script nor the network."""

from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.util.math import get_node_equation_number


def setup(app: Any) -> dict[str, bool]:
    """Sphinx's entry to an extension."""
    app.add_html_math_renderer("mathml", (_inline, None), (_display, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _inline(writer: Any, node: nodes.math) -> None:
    writer.body.append(_converted(node, "inline"))
    raise nodes.SkipNode


def _display(writer: Any, node: nodes.math_block) -> None:
    writer.body.append(writer.starttag(node, "div", CLASS="math notranslate nohighlight"))
    if node["number"]:
        writer.body.append(f'<span class="eqno">({get_node_equation_number(writer, node)})')
        writer.add_permalink_ref(node, "Link to this equation")
        writer.body.append("</span>")
    writer.body.append(_converted(node, "block") + "</div>\n")
    raise nodes.SkipNode


def _converted(node: nodes.Element, display: str) -> str:
    """MathML of a formula; the converter knows ``align*`` but not ``aligned``."""
    return str(convert(node.astext().strip().replace("{aligned}", "{align*}"), display=display))
