"""What a report is made of: sections that hold paragraphs, tables and pictures."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

from matplotlib.figure import Figure

from torsional.plots import save_svg


@dataclass(frozen=True)
class Text:
    """One paragraph; ``tone`` is plain, note or warning."""

    text: str
    tone: str = "plain"
    kind: ClassVar[str] = "text"


@dataclass(frozen=True)
class Heading:
    """A heading inside a section; ``name`` for links to it, a ``badge`` behind it in a ``tone``: good, partly, bad."""

    text: str
    name: str = ""
    badge: str = ""
    tone: str = ""
    kind: ClassVar[str] = "heading"


@dataclass(frozen=True)
class Items:
    """A list of sentences under a heading."""

    title: str
    sentences: tuple[str, ...]
    kind: ClassVar[str] = "items"


@dataclass(frozen=True)
class Table:
    """A table: ``head`` and ``rows`` of text; ``numbers`` are columns set to the right; ``folded`` starts closed.

    ``wrapped``: cells hold sentences; ``links``: where first cells lead to, by their text.
    """

    caption: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    numbers: frozenset[int] = frozenset()
    folded: bool = False
    wrapped: bool = False
    links: Mapping[str, str] = field(default_factory=dict)
    kind: ClassVar[str] = "table"


@dataclass(frozen=True)
class Picture:
    """A figure as a data address, with what is to be seen in it and a text for those who cannot see it."""

    source: str
    width: int
    height: int
    caption: str
    alternative: str
    kind: ClassVar[str] = "picture"

    @property
    def narrow(self) -> bool:
        """Whether two such pictures may stand side by side."""
        return self.width <= 700


Block = Heading | Text | Items | Table | Picture


@dataclass(frozen=True)
class Section:
    """A headed part of the page."""

    name: str
    title: str
    blocks: tuple[Block, ...]


def picture(figure: Figure, caption: str, alternative: str) -> Picture:
    """A matplotlib figure embedded as SVG data: an image can neither run a script nor clash with another's names."""
    width, height = (round(96 * inches) for inches in figure.get_size_inches())
    source = "data:image/svg+xml;base64," + base64.b64encode(save_svg(figure)).decode("ascii")
    return Picture(source, width, height, caption, alternative)


def table(
    caption: str,
    head: Sequence[str],
    rows: Sequence[Sequence[str]],
    numbers: Sequence[int] = (),
    folded: bool = False,
    wrapped: bool = False,
) -> Table:
    """A table from sequences."""
    return Table(caption, tuple(head), tuple(tuple(row) for row in rows), frozenset(numbers), folded, wrapped)
