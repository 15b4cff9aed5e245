"""Periodic motions of one spring: twist and torque over crank angle, its stages in time, the loop in its law."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby, pairwise

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure, SubFigure

from torsional.laws import Law, hinge_rows
from torsional.numerics.arrays import Array
from torsional.plots import style
from torsional.plots.branches import look
from torsional.quantities import cycles, waveform
from torsional.quantities.branches import SHARE_SAMPLES, letter, stage_parts, stage_shares

STAGES = {"free play": "#ffffff", "stop": "#f2b48c"}
STAGE_SHADES = ("#dfe9f2", "#aac6de", "#7ba5c9", "#5485b2")
_PATCH = {"facecolor": "white", "edgecolor": "none", "alpha": 0.8, "pad": 0.8}


@style.styled
def plot_solutions(
    solutions: xr.Dataset,
    element: str,
    law: Law | None = None,
    *,
    stiffness: float = 0.0,
    title: str = "",
    figure: Figure | SubFigure | None = None,
) -> Figure:
    """Motions of one ``element``: twist, stages and torque over crank angle, and beside them torque over twist.

    ``solutions``: points of a periodic response, in general those at one value of its parameter; ``law`` and
    ``stiffness`` [Nm/rad] the spring's.  Stages of the law are shaded; under the twist stands which of them the spring
    is in and what share of the time.  Drawn in ``figure`` or in one of its own.
    """
    strip = strip_height(solutions, law)
    if figure is None:
        figure = Figure(figsize=(10.5, 4.8 + strip))
        FigureCanvasAgg(figure)
    grid = figure.add_gridspec(3, 2, height_ratios=[2.3, strip, 2.3], width_ratios=[1.45, 1.0])
    twist = figure.add_subplot(grid[0, 0])
    stages, torque = (figure.add_subplot(grid[row, 0], sharex=twist) for row in (1, 2))
    loop = figure.add_subplot(grid[:, 1])
    plot_signals(solutions.twist.sel(element=element), solutions, law=law, axes=twist)
    plot_signals(solutions.torque.sel(element=element), solutions, axes=torque)
    _draw_strips(stages, solutions, element, law)
    plot_loops(solutions, element, law, stiffness=stiffness, axes=loop)
    for axes in (twist, stages):
        axes.tick_params(labelbottom=False)
        axes.set_xlabel("")
    loop.legend(loc="upper left")
    twist.set_title(style.plain(title, 80), loc="left")
    return style.figure_of(twist)


def strip_height(solutions: xr.Dataset, law: Law | None) -> float:
    """Height [inch] of the strips of stages, one a motion."""
    return 0.26 * solutions.sizes["point"] if hinge_rows(law) is not None else 0.02


@style.styled
def plot_signals(
    orders: xr.DataArray, solutions: xr.Dataset, *, law: Law | None = None, axes: Axes | None = None
) -> Figure:
    """Signals over crank angle, order 0 as their mean; ``orders`` (point, order); the stages of a ``law`` shaded."""
    figure, drawn = style.on(axes, (7.0, 2.6))
    quantity = str(orders.attrs["quantity"])
    for point in range(orders.sizes["point"]):
        signal = waveform(orders.isel(point=point))
        degrees = style.shown(np.asarray(signal.crank_angle), "crank_angle")
        drawn.plot(degrees, style.shown(signal, quantity), gid="signal", **_look(solutions, point))  # type: ignore[arg-type]
    last = 720 * cycles(orders)
    drawn.set_xlim(0, last)
    drawn.set_xticks(range(0, last + 1, 120 * cycles(orders)))
    if law is not None:
        _shade(drawn, law, upright=False)
    drawn.set_xlabel(style.label("crank_angle"))
    drawn.set_ylabel(style.label(quantity, name="twist" if quantity == "relative_angle" else ""))
    return figure


@style.styled
def plot_loops(
    solutions: xr.Dataset, element: str, law: Law | None = None, *, stiffness: float = 0.0, axes: Axes | None = None
) -> Figure:
    """Torque over twist in motion, damping included, about the ``law`` and ``stiffness`` [Nm/rad] of the spring."""
    figure, drawn = style.on(axes, (5.0, 4.6))
    twists, torques = (waveform(solutions[name].sel(element=element)) for name in ("twist", "torque"))
    room = 0.1 * float(np.ptp(twists.values)) or 0.01
    angle = np.linspace(float(twists.min()) - room, float(twists.max()) + room, 400)
    static = stiffness * angle + (law.torque(angle) if law is not None else 0.0)
    drawn.plot(style.shown(angle, "relative_angle"), static, color=style.INK, linewidth=1.0, zorder=2, label="spring")
    for point in range(twists.sizes["point"]):
        x, y = style.shown(twists.isel(point=point)), style.shown(torques.isel(point=point))
        told = {**_look(solutions, point), "label": _solution_name(solutions, point)}
        drawn.plot([*x, x[0]], [*y, y[0]], gid="loop", **told)  # type: ignore[arg-type]
    drawn.set_xlim(*style.shown(angle[[0, -1]], "relative_angle"))
    high, low = float(torques.max()), float(torques.min())
    drawn.set_ylim(low - 0.12 * (high - low), high + 0.25 * (high - low))
    if law is not None:
        _shade(drawn, law, upright=True)
    drawn.set_xlabel(style.label("relative_angle", name="twist"))
    drawn.set_ylabel(style.label("torque", name="torque, damping included"))
    return figure


def _solution_name(solutions: xr.Dataset, point: int) -> str:
    """A motion's letter, the branch it is on, and whether it is stable."""
    number = int(solutions.branch[point])
    return f"{letter(point)}: branch {number}, {solutions.kind.values[number]}" + (
        "" if bool(solutions.stable[point]) else ", unstable"
    )


def _look(solutions: xr.Dataset, point: int) -> dict[str, object]:
    """The line of a motion: in its branch's colour, further ones of the same branch in colours of their own."""
    numbers = [int(n) for n in solutions.branch.values]
    number, spare = numbers[point], max(numbers) + 1
    again = [i for i in range(len(numbers)) if numbers[i] in numbers[:i]]
    return look(spare + again.index(point) if point in again else number, bool(solutions.stable[point]))


def _stage_colour(name: str) -> str:
    """The shade of a stage: the stiffer the darker, the stop in another colour; the same for coasting."""
    plain = name.removesuffix(", coast")
    number = int(plain.removeprefix("stage ")) if plain.startswith("stage ") else 1
    return STAGES.get(plain, STAGE_SHADES[min(number, len(STAGE_SHADES)) - 1])


def _shade(axes: Axes, law: Law, upright: bool) -> None:
    """Shades for the stages of a law and lines between them; stages out of sight do not widen the picture."""
    if hinge_rows(law) is None:
        return
    low, high = axes.get_xlim() if upright else axes.get_ylim()
    edges = np.unique([g for g in style.shown(law.edges, "relative_angle") if low < g < high])
    borders = [low, *edges, high]
    for a, b in pairwise(borders):
        name = stage_parts(law, np.radians([0.5 * (a + b)]))[0]
        (axes.axvspan if upright else axes.axhspan)(a, b, color=_stage_colour(name), alpha=0.55, zorder=0, linewidth=0)
        _name_stage(axes, name, 0.5 * (a + b), (b - a) / (high - low), upright)
    for edge in edges:
        (axes.axvline if upright else axes.axhline)(edge, color=style.FAINT, linewidth=0.8, zorder=1, gid="boundary")
    (axes.set_xlim if upright else axes.set_ylim)(low, high)


def _name_stage(axes: Axes, name: str, at: float, share: float, upright: bool) -> None:
    if upright and share > 0.15:
        axes.text(
            at, 0.01, name, transform=axes.get_xaxis_transform(), ha="center", va="bottom", fontsize=8, bbox=_PATCH
        )
    elif not upright and share > 0.1:
        axes.text(
            0.995, at, name, transform=axes.get_yaxis_transform(), ha="right", va="center", fontsize=8, bbox=_PATCH
        )


def _draw_strips(axes: Axes, solutions: xr.Dataset, element: str, law: Law | None) -> None:
    """One strip a motion: its stage over crank angle in shades, and the share of time in each stage beside it."""
    axes.grid(visible=False)
    axes.set_yticks([])
    for side in ("left", "bottom"):
        axes.spines[side].set_visible(False)
    axes.tick_params(bottom=False)
    if hinge_rows(law) is None:
        return
    signals = waveform(solutions.twist.sel(element=element), SHARE_SAMPLES)
    degrees = style.shown(signals.crank_angle.values, "crank_angle")
    for row, signal in enumerate(signals.values):
        _draw_strip(axes, row, degrees, stage_parts(law, signal))
        told = ", ".join(f"{name} {100 * share:.1f} %" for name, share in stage_shares(law, signal).items())
        colour = str(_look(solutions, row)["color"])
        place = {"ha": "right", "va": "center", "fontsize": 9, "weight": "bold"}
        axes.text(-0.012 * degrees[-1], row, letter(row), color=colour, **place)  # type: ignore[arg-type]
        axes.text(0.5 * degrees[-1], row, told, ha="center", va="center", fontsize=8, bbox=_PATCH)
    axes.set_ylim(len(signals) - 0.5, -0.5)


def _draw_strip(axes: Axes, row: int, degrees: Array, names: Sequence[str]) -> None:
    step, start = float(degrees[1] - degrees[0]), 0
    for name, run in groupby(names):
        length = len(list(run))
        axes.barh(row, length * step, 0.8, left=start * step, color=_stage_colour(name), gid="stage", zorder=1)
        start += length
