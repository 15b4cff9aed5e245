"""Time steps with contacts against the complementarity problem that they solve."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.numerics.contacts.complementarity import violation
from torsional.numerics.contacts.step import OneSided, Step, step_problem
from torsional.numerics.stepping.marching import Count
from torsional.numerics.stepping.plan import PACE
from torsional.numerics.stepping.state import EXTERNAL, OWN, Q, V
from torsional.numerics.stepping.state import State as Standing
from torsional.solvers.transient.honesty import STIFF
from torsional.solvers.transient.linear_parts import Parts, parts_of
from torsional.solvers.transient.marching import COMPLETE, Accuracy, marched, motion_lost
from torsional.solvers.transient.problem import Drives, Problem
from torsional.solvers.transient.resuming import resumed
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.solvers.transient.starts import starting
from torsional.system import System

WHAT = "the certificate"
Flags = NDArray[np.bool_]


class Certificate(NamedTuple):
    """The largest ``violation`` of complementarity in some ``steps``, over the largest force or overlap at the time;
    the most contacts ``closed`` at once, and how many times one opened or closed (``changes``)."""

    violation: float
    closed: int
    changes: int
    steps: int


@checked
def certified(
    system: System,
    drives: Drives,
    run: xr.Dataset,
    steps: int = 100,
    *,
    speed: float | SpeedProfile | None = None,
    hold: str = "",
) -> Certificate:
    """How well the next ``steps`` of a ``run`` solve the complementarity problem of their contacts.

    ``system``, ``drives``, ``speed``, ``hold`` as in the run, of constant implicit steps, which goes on from its end.
    With the motion q⁺, v⁺ that a step found, its forces λ⁺ = max(0, −k (g⁺ + τ ġ⁺)) are put into

        0 ≤ λ⁺ ⟂ p + M λ⁺ ≥ 0,

    which is set up anew from matrices at every step, and has one solution (`torsional.numerics.contacts.step`).
    Contact times are those under the guard.  Raises ModelError for parts that are neither linear nor one-sided
    springs, for springs that soften, for a run without steps or one that does not go on under these drives, and
    where the steps lose the motion.

    >>> from torsional.components import Coupling, Inertia
    >>> from torsional.laws import Contacts
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.solvers.transient import MotionState, transient
    >>> from torsional.system import assemble
    >>> stop = Coupling("ground", "disc", Contacts((0.10035,), (1.0,), (100.0,), (0.01,)))
    >>> line = assemble(Powertrain({"disc": Inertia(1.0), "stop": stop}))
    >>> run = transient(line, (), 0.05, MotionState.at_rest(line).moved(0.0, [1.0]), speed=0.0)
    >>> found = certified(line, (), run, steps=1000, speed=0.0)  # into the stop
    >>> found.closed, found.violation < 1e-11
    (1, True)
    """
    if "end_step" not in run.attrs:
        remedy = "give it a run of `transient` by implicit steps"
        raise ModelError(
            "the run has no steps to go on by", where="run", found=str(run.attrs.get("method")), remedy=remedy
        )
    problem = Problem.of(system, drives, speed, hold=hold)
    accuracy = Accuracy(float(run.attrs["end_step"]), run.attrs["method"], float(run.attrs["spectral_radius"]))
    begun = starting(run, problem.system, problem.acting, problem.hold, problem.start_speed)
    state = resumed(run, begun, problem, accuracy)
    if state.standing is None or state.standing.counts[Count.RUNG]:
        remedy = "give it the drives of the run, one with constant steps"
        raise ModelError("the run does not go on from its end", where="run", remedy=remedy)
    parts = _guarded(problem, accuracy.step)
    worst, most, changes = 0.0, 0, 0
    for _ in range(steps):
        gone = marched(problem, state, 1, accuracy)
        before, after = state.standing, gone.end.standing
        if gone.status != COMPLETE or before is None or after is None:
            raise motion_lost(gone, accuracy, f"time {gone.end.time:.6g} s")
        told, were, are = _step(parts, before, after, accuracy)
        worst, most, changes = max(worst, told), max(most, int(are.sum())), changes + int((were != are).sum())
        state = gone.end
    return Certificate(worst, most, changes, steps)


def _guarded(problem: Problem, step: float) -> Parts:
    """The parts with the contact times that the steps give them."""
    parts = parts_of(problem, WHAT)
    if not (parts.walls.stiffness > 0).all():
        name = problem.system.connections.names[parts.of[(parts.walls.stiffness <= 0).argmax()]]
        raise ModelError(f"{WHAT} knows one-sided springs, not stages that soften", where=name)
    stiff = step * problem.plan.hinges.values[PACE] > STIFF
    own = parts.walls.contact_time
    walls = OneSided(
        parts.walls.directions,
        parts.walls.gap,
        parts.walls.stiffness,
        np.where(stiff, np.maximum(own, 0.5 * step), own),
    )
    return parts._replace(walls=walls)


def _step(parts: Parts, before: Standing, after: Standing, accuracy: Accuracy) -> tuple[float, Flags, Flags]:
    """Violation of one step, and which contacts push at its begin and at its end."""
    family, (one, other) = accuracy.family, (before.coordinates, after.coordinates)
    step = Step(accuracy.step, family.alpha_m, family.alpha_f, family.gamma, family.beta)
    was, now = (parts.walls.force(own[Q], own[V]) for own in (one, other))
    linear, motion = (parts.mass, parts.damping, parts.stiffness), (one[Q], one[V], one[OWN], was)
    problem = step_problem(linear, parts.walls, motion, (one[EXTERNAL], other[EXTERNAL]), step)
    return violation(problem.matrix, problem.offset, now, problem.scale), was > 0.0, now > 0.0
