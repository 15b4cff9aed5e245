"""What a run must say of itself: dampers that the step gave to stops, energy that the steps made or took away."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from torsional.numerics.arrays import Array
from torsional.numerics.motion.data import CONTACT_TIME
from torsional.numerics.stepping.marching import Entry
from torsional.numerics.stepping.plan import PACE
from torsional.numerics.stepping.state import State as Standing
from torsional.solvers.transient.marching import Accuracy, method_share
from torsional.solvers.transient.problem import Problem

TOLD = 0.01
"""Share of all energy that passed through from which it is told."""
ALONE = 1e-4
"""The same of one connection, whose energy may be nothing beside that of its neighbours: it comes and goes many times.

Runs that are right have 1e-6 at most, a mass that is pumped up between its stops 4e-4 and more.
"""
STIFF = 0.5
"""h ω of a closed contact from which the guard gives it a contact time of half a step."""
FELT = 0.1
"""Share of the energy that reaches the lighter body at a contact from which what the guard's damper takes is told.

Detailed flywheels at 0.1 ms have 1e-5 to 0.04, orders within 0.3 % of those at 5 µs, and 0.4 where springs just touch
their tabs and rattle there.
"""
_MOST = 4


def honest(problem: Problem, standing: Standing | None, accuracy: Accuracy) -> dict[str, str]:
    """What is to be said, in words: of contacts ``guarded`` by dampers, ``damped`` where that is felt, and so on."""
    if accuracy.method in ("explicit", "exact"):
        return {}
    said = _unresolved(problem, accuracy.step) | _restless(problem, accuracy.step)
    names = problem.system.connections.names
    said |= _guarded(problem, standing, accuracy.step) | _unguarded(problem, accuracy.step)
    share = method_share(standing)
    if abs(share) > TOLD:
        did = "made" if share > 0 else "took away"
        said["energy_error"] = (
            f"the time steps {did} {abs(share):.2g} of the energy that passed through; take a smaller step"
        )
    elif alone := _made_alone(standing, names):
        said["energy_error"] = alone
    return said


NOTES = ("energy_error", "damped", "guarded", "unguarded", "restless", "refined", "unresolved")
"""What may be said of a run, each the name of an attribute."""


def said(attributes: Mapping[str, object]) -> str:
    """All that the attributes of a run say of it, in one line; "" where there is nothing to be said."""
    told = [name for name in NOTES if name in attributes and not (name == "guarded" and "damped" in attributes)]
    return "; ".join(f"{name}: {attributes[name]}" for name in told)


def _guarded(problem: Problem, standing: Standing | None, step: float) -> dict[str, str]:
    """Contacts that the step gave a damper, and what it took; ``damped`` where that is felt."""
    hinges, names = problem.plan.hinges, problem.system.connections.names
    raised = (step * hinges.values[PACE] > STIFF) & (hinges.values[CONTACT_TIME] < 0.5 * step)
    if standing is None or not raised.any():
        return {}
    listed = list(dict.fromkeys(names[e] for e in hinges.of[raised]))
    more = f" and {len(listed) - _MOST} more" if len(listed) > _MOST else ""
    taken = standing.passed[2]
    whole = float(taken.sum()) / max(float(standing.ledger[Entry.THROUGHPUT]), 1e-300)
    nearby = taken / np.maximum(_beside(problem, standing.passed[1]), 1e-300)
    worst = int(nearby.argmax())
    took = f"it took {max(whole, 0.0):.2g} of the energy that passed through"
    if nearby[worst] > FELT:
        took += f", at {names[worst]} {nearby[worst]:.2g} of what reaches its lighter side"
    which = f"{', '.join(listed[:_MOST])}{more}: stiffer than the step of {step:.3g} s can follow"
    words = f"{which}, so that their contacts are given a damper; {took}; a smaller step has none"
    felt = whole > TOLD or nearby[worst] > FELT
    return {"guarded": words} | ({"damped": words} if felt else {})


def _unguarded(problem: Problem, step: float) -> dict[str, str]:
    """Contacts with a damper of their own kind, which no step can guard, that are stiffer than it can follow."""
    c, M = problem.system.connections, problem.system.M
    loose = {i: law.unguarded_stiffness for i, law in enumerate(c.laws) if law is not None and law.unguarded_stiffness}
    stiff = {i: k * (c.weights[i] @ np.linalg.lstsq(M, c.weights[i])[0]) for i, k in loose.items()}
    names = [c.names[i] for i, square in stiff.items() if step * np.sqrt(square) > STIFF]
    if not names:
        return {}
    which = f"the contacts of {', '.join(names[:_MOST])} are stiffer than the step of {step:.3g} s can follow"
    return {"unguarded": f"{which}, and their damper is of a kind that no step can guard; take a smaller step"}


def _beside(problem: Problem, through: Array) -> Array:
    """The most energy that went through a connection or another one of the same body, of its two bodies the less.

    What happens at a contact matters little where a spring beside it passes on far more.
    """
    touches = problem.system.connections.weights != 0.0
    most = np.where(touches, through[:, None], 0.0).max(axis=0)
    return np.asarray(np.where(touches, most, np.inf).min(axis=1))


def _made_alone(standing: Standing | None, names: tuple[str, ...]) -> str:
    """The connection at which the steps made most energy of their own, if that is much for what goes through it."""
    if standing is None:
        return ""
    made, through = standing.passed[:2]
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
