"""What a run must say of itself: dampers that the step gave to stops, energy that the steps made or took away."""

from __future__ import annotations

import numpy as np

from torsional.solvers.transient.marching import Accuracy, Marched, method_share
from torsional.solvers.transient.problem import Problem

TOLD = 0.01
"""Share of all energy that passed through from which it is told."""
ALONE = 1e-4
"""The same of one connection, whose energy may be nothing beside that of its neighbours: it comes and goes many times.

Runs that are right have 1e-6 at most, a mass that is pumped up between its stops 4e-4 and more.
"""
STIFF = 0.5
"""h ω of a closed contact from which the guard gives it a contact time of half a step."""
_MOST = 4


def honest(problem: Problem, told: Marched, accuracy: Accuracy) -> dict[str, str]:
    """``guarded`` and ``energy_error`` in words, where there is something to say."""
    if accuracy.method == "explicit":
        return {}
    said = _unresolved(problem, accuracy.step) | _restless(problem, accuracy.step)
    hinges, names = problem.plan.hinges, problem.system.connections.names
    stiff = accuracy.step * hinges.pace > STIFF
    raised = stiff & (hinges.contact_time < 0.5 * accuracy.step)
    if raised.any():
        listed = list(dict.fromkeys(names[e] for e in hinges.of[raised]))
        more = f" and {len(listed) - _MOST} more" if len(listed) > _MOST else ""
        said["guarded"] = (
            f"{', '.join(listed[:_MOST])}{more}: stiffer than the step of {accuracy.step:.3g} s can follow, "
            "so that their contacts are given a damper; a smaller step has none"
        )
    share = method_share(told)
    if abs(share) > TOLD:
        did = "made" if share > 0 else "took away"
        said["energy_error"] = (
            f"the time steps {did} {abs(share):.2g} of the energy that passed through; take a smaller step"
        )
    elif alone := _made_alone(told, names):
        said["energy_error"] = alone
    return said


def _made_alone(told: Marched, names: tuple[str, ...]) -> str:
    """The connection at which the steps made most energy of their own, if that is much for what goes through it."""
    if told.end.standing is None:
        return ""
    made, through, _ = told.end.standing.passed
    share = np.where(made > 0, made, 0.0) / np.where(through > 0, through, 1.0)
    worst = int(share.argmax()) if share.size else 0
    if not share.size or share[worst] <= ALONE:
        return ""
    return (
        f"the time steps made {share[worst]:.2g} of the energy that passed through {names[worst]}; take a smaller step"
    )


def _unresolved(problem: Problem, step: float) -> dict[str, str]:
    """Levels over time that change faster than the step."""
    driven = problem.equations.driven
    for first, last in zip(driven.level_start[:-1], driven.level_start[1:], strict=True):
        spacing = np.diff(np.unique(driven.level_time[first:last]))
        if spacing.size and spacing.min() < step * (1 - 1e-9):
            at = driven.level_time[first:last][int(spacing.argmin())]
            lasts = f"a value given over time changes within {spacing.min():.3g} s"
            return {"unresolved": f"{lasts} near {at:.6g} s, less than the step of {step:.3g} s; take a smaller one"}
    return {}


def _restless(problem: Problem, step: float) -> dict[str, str]:
    """Governors of a torque that corrects the speed by more than its error within a step."""
    for governing in problem.acting.governors:
        if governing.act is None:
            continue
        answer = governing.sense @ np.linalg.lstsq(problem.system.M, governing.act, rcond=None)[0]
        gain = float(governing.proportional * step * answer)
        if gain > 1.0:
            told = f"a governor's proportional share corrects {gain:.2g} times the error of the speed in one step"
            return {"restless": f"{told} of {step:.3g} s, and chatters; take a smaller step or share"}
    return {}
