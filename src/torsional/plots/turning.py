"""Which changed parameter turns which verdict."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from torsional.plots.style import COLOURS, SHADE, on, styled


@styled
def plot_turning(turns: Mapping[str, Sequence[tuple[str, float]]]) -> Figure:
    """Parameters down, claims across: a minus where a lower value alone turns the verdict, a plus where a higher does.

    ``turns``: {claim: [(parameter, factor)]}, a factor below one being lower.
    """
    parameters = list(dict.fromkeys(name for each in turns.values() for name, _ in each))
    count = {name: sum(name == other for each in turns.values() for other, _ in each) for name in parameters}
    parameters.sort(key=lambda name: count[name])
    figure, axes = on(None, (3.2 + 0.42 * len(turns), 1.1 + 0.27 * len(parameters)))
    for x, (_, each) in enumerate(turns.items()):
        axes.axvline(x, color=SHADE, zorder=0)
        for name, factor in each:
            lower = factor < 1
            place = (x - 0.14 if lower else x + 0.14, parameters.index(name))
            axes.text(*place, "−" if lower else "+", ha="center", va="center", weight="bold", color=COLOURS[lower])
    axes.set_xlim(-0.6, len(turns) - 0.4)
    axes.set_ylim(-0.6, len(parameters) - 0.4)
    axes.set_xticks(range(len(turns)), list(turns))
    axes.set_yticks(range(len(parameters)), parameters)
    axes.set_xlabel("claim")
    axes.tick_params(length=0)
    axes.grid(False)
    return figure
