"""What fits say, in sentences: how sure each parameter is, what the data leave open, which model explains them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from torsional.studies.estimates import CONFUSED, Unknown
from torsional.studies.identification.task import Fit, Task
from torsional.units import show

EXPLAINED = 1.1
"""RMS of residuals over the noise up to which a model leaves no more than noise."""
WORSE = 10.0
"""Difference of a criterion from which on the other model has next to no support (Burnham and Anderson, § 2.6)."""
AWAY = 1.5
"""Misfit of held-back points over that of fitted ones from which on the model does not carry over to them."""


def findings(task: Task, fits: Sequence[Fit]) -> Iterator[str]:
    """The sentences, the most important first."""
    own = fits[0]
    yield from _quality(own)
    yield from _validation(own)
    for unknown, estimate, (low, high) in zip(
        own.found.unknowns, own.found.estimates, own.found.intervals(task.level), strict=True
    ):
        yield _parameter(unknown, float(estimate), float(low), float(high), task.level)
    yield from _open(own)
    if len(fits) > 1:
        yield _compared(fits)


def _quality(fit: Fit) -> Iterator[str]:
    misfit = fit.found.misfit
    if misfit <= EXPLAINED:
        yield f"The model leaves no more than noise: residuals are {misfit:.2f} times it (RMS)."
    else:
        worst = fit.found.points[int(np.argmax(fit.found.misfits))]
        yield (
            f"The model leaves more than noise: residuals are {misfit:.2f} times it (RMS), most at {worst}, "
            f"{fit.found.misfits.max():.2f}; intervals then tell too little."
        )
    stuck = fit.found.at_bounds()
    if stuck:
        yield f"At a bound: {', '.join(stuck)}; the data ask for more, or tell nothing of it."


def _validation(fit: Fit) -> Iterator[str]:
    if np.isfinite(fit.held_misfit):
        carried = fit.held_misfit <= AWAY * fit.found.misfit
        yield (
            f"Points held back are predicted {'as well' if carried else 'worse'}: "
            f"{fit.held_misfit:.2f} times the noise, {fit.found.misfit:.2f} where it was fitted."
        )


def _parameter(unknown: Unknown, estimate: float, low: float, high: float, level: float) -> str:
    value = show(estimate, unknown.quantity)
    if not np.isfinite(high):
        return f"{unknown.name}: {value}, of which the data tell nothing."
    ends = f"{show(low, unknown.quantity)} to {show(high, unknown.quantity)}"
    share = f", ±{50.0 * (high - low) / abs(estimate):.2g} %" if estimate else ""
    return f"{unknown.name}: {value}, {100 * level:g} % interval {ends}{share}."


def _open(fit: Fit) -> Iterator[str]:
    """What the data cannot tell."""
    left = [way for way in fit.found.ways if way.untold]
    for way in left:
        size = "not at all" if not np.isfinite(way.deviation) else f"to ±{100 * way.deviation:.3g} % only"
        yield f"The data tell {size} (over the parameters' scales): {way.words}."
    for one, other, value in fit.found.confused():
        yield f"Hardly told apart (correlation {value:+.3f}, limit {CONFUSED}): {one} and {other}."


def _compared(fits: Sequence[Fit]) -> str:
    """Which model explains the same data best, and what is left of the others."""
    best = min(fits, key=lambda fit: fit.found.aicc)
    told = []
    for fit in fits:
        if fit is best:
            continue
        off = fit.found.aicc - best.found.aicc
        verdict = "rejected" if off > WORSE else "nearly as good"
        told.append(
            f"{fit.candidate.name} is {verdict} (AICc {off:+.4g}, BIC {fit.found.bic - best.found.bic:+.4g}, "
            f"residuals {fit.found.misfit:.2f} times the noise)"
        )
    return f"Best by Akaike's criterion is {best.candidate.name}; {'; '.join(told)}."
