"""A periodic response as one picture: branches of every place, and below them the motions at one value."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure, SubFigure

from torsional.laws import Law
from torsional.plots import style
from torsional.plots.branches import Kind, plot_branches
from torsional.plots.solution import plot_solutions, strip_height

COLUMN, PANEL, MOTION = 5.6, 2.3, 4.8
"""Width of a column, height of a panel of branches and of the motions of one spring [inch]."""


@style.styled
def plot_periodic(
    result: xr.Dataset,
    shown: Sequence[Kind],
    *,
    elements: Sequence[str] = (),
    nodes: Sequence[str] = (),
    solutions: xr.Dataset | None = None,
    laws: Mapping[str, Law | None] | None = None,
    stiffness: Mapping[str, float] | None = None,
    heading: str = "",
    title: str = "",
) -> Figure:
    """Branches of every place in a column of its own: torques of ``elements``, accelerations of ``nodes``.

    ``shown`` and ``solutions`` as `plot_branches` takes them, under a ``heading``; the motions of each element follow
    below, with its law of ``laws`` and its ``stiffness`` [Nm/rad], under a ``title``.
    """
    columns = [("element", name) for name in elements] + [("node", name) for name in nodes]
    known = dict(laws or {})
    motions = [] if solutions is None or not solutions.sizes["point"] else list(elements)
    heights = [PANEL * len(shown), *(MOTION + strip_height(solutions, known.get(name)) for name in motions)]  # type: ignore[arg-type]
    figure = Figure(figsize=(max(COLUMN * len(columns) + 2.0, 10.0 if motions else 0.0), sum(heights)))
    FigureCanvasAgg(figure)
    parts = figure.subfigures(len(heights), 1, height_ratios=heights, squeeze=False).ravel()
    axes = parts[0].subplots(len(shown), len(columns), sharex=True, squeeze=False)
    for number, (kind, name) in enumerate(columns):
        panels: list[Axes] = list(axes[:, number])
        last = number == len(columns) - 1
        place = {"element": name} if kind == "element" else {"node": name}
        plot_branches(result, shown, **place, solutions=solutions, legend=last, axes=panels)
        panels[0].set_title(style.readable(name))
    if heading:
        parts[0].suptitle(style.plain(heading, 110), x=0.01, ha="left", fontsize=10)
    for part, name in zip(parts[1:], motions, strict=True):
        assert isinstance(part, SubFigure) and solutions is not None
        spring = (stiffness or {}).get(name, 0.0)
        told = style.readable(name) + (f": {title}" if title else "")
        plot_solutions(solutions, name, known.get(name), stiffness=spring, title=told, figure=part)
    return figure
