"""A picture for dark pages: paper and ink changed for each other, colours as they are."""

from __future__ import annotations

from typing import Any

from matplotlib.collections import Collection, QuadMesh
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

PAPER, LETTERS = "#15191e", "#e6e9ec"
GREY = 0.06
"""How far red, green and blue may lie apart in what is ink, line or shade."""
_PARTS: tuple[tuple[type, tuple[str, ...]], ...] = (
    (Text, ("color",)),
    (Line2D, ("color", "markerfacecolor", "markeredgecolor")),
    (Patch, ("facecolor", "edgecolor")),
    (Collection, ("facecolor", "edgecolor")),
)


def darkened(figure: Figure) -> Figure:
    """The figure with its greys turned over; it is changed itself."""
    artists = figure.findobj()
    boxes = [box for artist in artists if isinstance(artist, Text) and (box := artist.get_bbox_patch()) is not None]
    mapped = [axes for axes in figure.axes if any(isinstance(each, QuadMesh) for each in axes.collections)]
    on_maps = {text for axes in mapped for text in axes.texts}  # chosen for the colours below them
    for artist in dict.fromkeys([*artists, *boxes]):
        if artist in on_maps:
            continue
        for kind, parts in _PARTS:
            if isinstance(artist, kind):
                _turn(artist, parts)
    return figure


def _turn(artist: Any, parts: tuple[str, ...]) -> None:
    """Read all before any is set: some follow others."""
    found = {part: _single(getattr(artist, f"get_{part}")()) for part in parts}
    for part, rgba in found.items():
        if rgba is not None and rgba[3] and max(rgba[:3]) - min(rgba[:3]) < GREY:
            getattr(artist, f"set_{part}")(_turned(rgba))


def _single(colour: Any) -> tuple[float, float, float, float] | None:
    """A colour; None for the many of a map, and for none."""
    try:
        return to_rgba(colour[0] if getattr(colour, "ndim", 1) == 2 and len(colour) == 1 else colour)
    except (ValueError, TypeError):
        return None


def _turned(rgba: tuple[float, float, float, float]) -> tuple[float, ...]:
    """White becomes paper, black letters, and greys what lies between."""
    low, high = to_rgba(PAPER), to_rgba(LETTERS)
    share = 1.0 - sum(rgba[:3]) / 3
    return (*(a + share * (b - a) for a, b in zip(low[:3], high[:3], strict=True)), rgba[3])
