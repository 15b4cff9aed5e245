"""The powertrain drawn as discs and springs."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from torsional.plots import style
from torsional.plots.layout import Chain, Link, chain
from torsional.powertrain import Powertrain
from torsional.units import show

THICKNESS = 0.3
TALLEST = 1.15
SLANTED = {"rotation": 50, "fontsize": 7.5, "linespacing": 1.0, "zorder": 4}
LOOKS: dict[str, Any] = {
    "spring": "-",
    "gear": (0, (1, 1)),
    "damper": (0, (4, 2)),
    "planets": "-.",
    "friction": (0, (1, 2)),
}
PATCH = {"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 0.3}


@style.styled
def plot_chain(
    powertrain: Powertrain,
    *,
    absorber: Sequence[str] = (),
    clutch: str = "",
    throws: Sequence[str] = (),
    axes: Axes | None = None,
) -> Figure:
    """The powertrain as discs and springs; ``absorber`` and ``clutch`` name connections, ``throws`` nodes, in colour.

    A disc's height is the fourth root of its inertia referred to engine speed, which is the diameter of a steel disc
    of one thickness: the picture is to scale in that sense.
    """
    line = chain(powertrain)
    xs, ys = (np.array([place[i] for place in line.places.values()]) for i in (0, 1))
    width = float(np.ptp(xs)) + 2.0
    figure, drawn = style.on(axes, (max(6.0, 0.66 * width), 3.0 + 0.52 * max(float(np.ptp(ys)) - 2.2, 0.0)))
    beside: dict[float, float] = {}
    for link in line.links:
        colour = style.COLOURS[1] if link.name in absorber else style.COLOURS[2] if link.name == clutch else style.INK
        _draw_link(drawn, line, link, colour, beside)
    _draw_discs(drawn, line, throws)
    drawn.set_xlim(xs.min() - 0.8, xs.max() + 0.8)
    drawn.set_ylim(ys.min() - 2.9, max(ys.max() + 0.7, 2.9))
    drawn.set_axis_off()
    return figure


def _draw_discs(axes: Axes, line: Chain, throws: Sequence[str]) -> None:
    largest = max(line.inertia.values())
    for node, (x, y) in line.places.items():
        inertia = line.inertia[node]
        half = max(TALLEST * (inertia / largest) ** 0.25, 0.04) if inertia else 0.03
        colour = style.COLOURS[4] if node in throws else "#c9ced6"
        corner = (x - THICKNESS / 2, y - half)
        axes.add_patch(Rectangle(corner, THICKNESS, 2 * half, facecolor=colour, edgecolor=style.INK, zorder=3))
        text = style.readable(node) + (f"\n{show(inertia, 'inertia')}" if inertia else "")
        if y <= 0:
            axes.text(x + 0.12, y - TALLEST - 0.05, text, ha="right", va="top", **SLANTED)  # type: ignore[arg-type]
        else:
            axes.text(x + 0.3, y, text, ha="left", va="center", fontsize=7.5, linespacing=1.0)


def _draw_link(axes: Axes, line: Chain, link: Link, colour: str, beside: dict[float, float]) -> None:
    """One link between its nodes; springs and gears carry their name, above the line or beside an upright one."""
    for first, second in pairwise(link.nodes):
        (x1, y1), (x2, y2) = line.places[first], line.places[second]
        aside = 0.14 if x1 == x2 and link.kind != "spring" else 0.0  # a gear beside the spring of the same two nodes
        x, y = _zigzag(x1, y1, x2, y2) if link.kind == "spring" else (np.array([x1, x2]) - aside, np.array([y1, y2]))
        if link.kind == "friction":  # beside the spring of the same two nodes, along or upright
            x, y = (
                np.array([0.8 * x1 + 0.2 * x2, 0.2 * x1 + 0.8 * x2]),
                np.array([0.8 * y1 + 0.2 * y2, 0.2 * y1 + 0.8 * y2]),
            )
            x, y = x + 0.3 * (x1 == x2), y - 0.3 * (x1 != x2)
        thick = {"gear": 3.0}.get(link.kind, 1.2)
        axes.plot(x, y, color=colour, linestyle=LOOKS[link.kind], linewidth=thick, zorder=2, gid=f"link-{link.kind}")
    if link.kind in ("spring", "gear"):
        detail = link.described if link.kind == "spring" else _speeds(line, link)
        text = style.readable(link.name) + (f"\n{detail}" if detail else "")
        _name_link(axes, line, link, text, colour, beside)


def _name_link(axes: Axes, line: Chain, link: Link, text: str, colour: str, beside: dict[float, float]) -> None:
    """The name above a level link; those of a branch stand beside it, one under the other, clear of the names below."""
    spots = [line.places[node] for node in link.nodes]
    (x1, y1), (x2, _) = spots[0], spots[-1]
    if all(y == y1 for _, y in spots):
        place = (0.5 * (x1 + x2) - 0.1, y1 + TALLEST + 0.05)
        axes.text(*place, text, color=colour, ha="left", va="bottom", bbox=PATCH, **SLANTED)  # type: ignore[arg-type]
        return
    x, y = max(spots, key=lambda spot: spot[1])
    beside[x] = beside.get(x, y - 0.2) - 0.55
    axes.text(x + 0.35, beside[x], text, color=colour, ha="left", va="center", fontsize=7.5, linespacing=1.0)


def _speeds(line: Chain, link: Link) -> str:
    a, b = (abs(line.ratio[node]) for node in link.nodes[:2])
    return f"{max(a, b) / min(a, b):.4g} : 1" if min(a, b) > 0 and len(link.nodes) == 2 else ""


def _zigzag(x1: float, y1: float, x2: float, y2: float) -> tuple[np.ndarray, np.ndarray]:
    """A coil spring seen from the side, from one point to another."""
    along = np.array([0.0, 0.25, *np.linspace(0.3, 0.7, 7), 0.75, 1.0])
    across = 0.22 * np.array([0, 0, 1, -1, 1, -1, 1, -1, 1, 0, 0])
    length = float(np.hypot(x2 - x1, y2 - y1)) or 1.0
    dx, dy = (x2 - x1) / length, (y2 - y1) / length
    return x1 + along * (x2 - x1) - across * dy, y1 + along * (y2 - y1) + across * dx
