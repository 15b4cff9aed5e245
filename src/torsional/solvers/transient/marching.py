"""One stretch of a run: from a state over a number of steps to what was recorded, by any of the integrators."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.numerics.explicit.element_torques import element_torques
from torsional.numerics.explicit.march import explicit_march
from torsional.numerics.stepping.alpha_method import AlphaMethod
from torsional.numerics.stepping.marching import Count, Entry, Settings, Status, begin, march
from torsional.numerics.stepping.state import State as Standing
from torsional.solvers.transient.exactly import exact_motion
from torsional.solvers.transient.problem import Problem
from torsional.solvers.transient.starts import MotionState

METHODS = ("chung_hulbert", "hht", "bossak", "newmark", "explicit", "exact")
LEDGER = ("kinetic", "strain", "sources", "dampers", "contacts", "friction", "method")
"""Shares of the energy [J]: what kinetic and strain gain is sources − dampers − contacts − friction + method."""
_ENTRIES = [Entry.KINETIC, Entry.STRAIN, Entry.WORKED, Entry.DAMPED, Entry.STRUCK, Entry.RUBBED, Entry.MADE]
COMPLETE = "complete"
_WORDS = {
    Status.DONE: COMPLETE,
    Status.UNSETTLED: "the torques of a step did not come to agree with its motion",
    Status.INDEFINITE: "a stiffness, a damping or an inertia is negative",
    Status.NOT_FINITE: "the motion grew beyond all numbers",
    Status.PRODUCES: "the time step made more than 1 % of the energy of its own",
}
RUNGS = 8


@dataclass(frozen=True)
class Accuracy:
    """How finely a run is stepped: ``step`` [s], the ``method``, its ``spectral_radius`` ρ∞, the error of an angle
    [rad] that a step may make (``angle_error``; 0: the step stays), the ``tolerance`` of the explicit integrator."""

    step: float = 1e-4
    method: str = "chung_hulbert"
    spectral_radius: float = 0.8
    angle_error: float = 0.0
    tolerance: float = 1e-8

    def __post_init__(self) -> None:
        if not 0 < self.step < np.inf:
            raise ModelError("the step must be positive", where="step", found=f"{self.step:g} s")
        if self.method not in METHODS:
            allowed = ", ".join(METHODS)
            raise ModelError("unknown method", where="method", found=self.method, allowed=allowed)
        if not 0 <= self.angle_error < np.inf:
            raise ModelError("the error of an angle is finite", where="angle_error", found=f"{self.angle_error:g} rad")
        if not 0 < self.tolerance < 1:
            raise ModelError("the tolerance lies between 0 and 1", where="tolerance", found=f"{self.tolerance:g}")
        _ = self.family

    @property
    def family(self) -> AlphaMethod:
        """The member of the generalised-α family; that of the explicit integrator is not asked."""
        if self.method in ("newmark", "explicit", "exact"):
            return AlphaMethod.newmark()
        found: AlphaMethod = getattr(AlphaMethod, self.method)(self.spectral_radius)
        return found

    @property
    def settings(self) -> Settings:
        """What the compiled march is told."""
        return Settings(rungs=RUNGS, angle_error=self.angle_error) if self.angle_error > 0 else Settings()


class Marched(NamedTuple):
    """What was recorded: ``time`` (S,) [s]; ``angle``, ``speed``, ``acceleration`` (S, N) of the coordinates;
    ``torque``, ``memory``, ``load``, and ``lost`` [J] in their laws, (S, E) of the connections; ``energy`` (S, shares)
    [J] since the start."""

    time: Array
    angle: Array
    speed: Array
    acceleration: Array
    torque: Array
    memory: Array
    load: Array
    lost: Array
    energy: Array
    end: MotionState
    steps: int
    iterations: int
    status: str


def motion_lost(told: Marched, accuracy: Accuracy, where: str) -> ModelError:
    """The refusal of a march whose steps lose the motion, to be raised."""
    found = f"{told.status}, with a step of {accuracy.step:.3g} s"
    remedy = "give stiff stops a contact time (damping), or take a smaller step"
    return ModelError("the steps lose the motion", where=where, found=found, remedy=remedy)


def marched(problem: Problem, state: MotionState, steps: int, accuracy: Accuracy, every: int = 1) -> Marched:
    """Go on from a state for ``steps`` steps and keep ``every`` one of them, the first and the last included."""
    kept = np.append(np.arange(0, steps, every), steps)
    if accuracy.method == "explicit":
        return _explicit(problem, state, state.time + accuracy.step * kept, accuracy)
    if accuracy.method == "exact":
        return _exact(problem, state, state.time + accuracy.step * kept)
    plan, own = problem.plan, standing_of(problem, state, accuracy.step)
    told = march(plan, accuracy.family, accuracy.step, steps, own, at=kept, settings=accuracy.settings)
    records, count = told.records, len(state.memory)
    memory, load, lost = np.zeros((3, len(kept), count))
    for whole, own_part in ((memory, records.memory), (load, records.load), (lost, records.lost)):
        whole[:, plan.laws.of] = own_part
    end = MotionState(
        time=float(records.time[-1]),
        angle=records.q[-1],
        speed=records.v[-1],
        memory=memory[-1],
        integral=told.state.integral[: len(problem.acting.governors)],
        reference=float(told.state.reference[0]),
        charge=told.state.integral[len(problem.acting.governors) :],
        standing=told.state,
        step=accuracy.step,
    )
    energy = records.ledger[:, _ENTRIES]
    status = told.status if np.isfinite(energy).all() else Status.NOT_FINITE
    return Marched(
        time=records.time,
        angle=records.q,
        speed=records.v,
        acceleration=records.acceleration,
        torque=records.torque,
        memory=memory,
        load=load,
        lost=lost,
        energy=energy,
        end=end,
        steps=told.count(Count.STEPS) - int(own.counts[Count.STEPS]),
        iterations=told.count(Count.SOLVES) - int(own.counts[Count.SOLVES]),
        status=_WORDS[status],
    )


def method_share(standing: Standing | None) -> float:
    """Energy that the method itself has made (or lost, negative), over all that passed through; nan without ledger."""
    if standing is None:
        return float("nan")
    through = float(standing.ledger[Entry.THROUGHPUT])
    return float(standing.ledger[Entry.MADE]) / through if through > 0 else 0.0


def standing_of(problem: Problem, state: MotionState, step: float) -> Standing:
    """The state as the compiled march wants it; one that a march has left goes on to the last bit."""
    if state.standing is None:
        return begin(
            problem.plan,
            state.angle,
            state.speed,
            time=state.time,
            memory=state.memory[problem.plan.laws.of],
            reference=state.reference,
            integral=_remembered(problem, state),
            step=step,
        )
    if state.step == step:
        return state.standing
    counts = state.standing.counts.copy()
    counts[Count.BASE_STEPS] = counts[Count.RUNG] = 0
    return state.standing._replace(counts=counts, begin=np.array([state.time]))


def _remembered(problem: Problem, state: MotionState) -> Array:
    """Integrals of the governors, and charges of the cylinders less one behind them; full ones where other cylinders
    or none were there before."""
    governors, leaks = len(problem.acting.governors), len(problem.acting.leaks)
    known = state.charge is not None and len(state.charge) == leaks
    charge = state.charge if state.charge is not None and known else np.zeros(leaks)
    return np.append(state.integral if state.integral.size else np.zeros(governors), charge)


def _explicit(problem: Problem, state: MotionState, times: Array, accuracy: Accuracy) -> Marched:
    """The same by the explicit integrator, which keeps no ledger."""
    run = explicit_march(
        problem.equations,
        times,
        state.angle,
        state.speed,
        tolerance=accuracy.tolerance,
        flows={law.address: law.flow_address for law in problem.system.connections.laws if law is not None},
        reference_speed=state.reference,
        integral=_remembered(problem, state),
        memory=state.memory,
    )
    torque, load = np.zeros((2, *run.memories.shape))
    connected, outside = problem.equations.connected, problem.plan.outside
    element_torques(connected, outside, times, run.angles, run.rates, run.memories, run.references, torque, load)
    end = MotionState(
        time=float(times[-1]),
        angle=run.angles[-1],
        speed=run.rates[-1],
        memory=run.memories[-1],
        integral=run.integrals[-1, : len(problem.acting.governors)],
        reference=float(run.references[-1]),
        charge=run.integrals[-1, len(problem.acting.governors) :],
    )
    return Marched(
        time=times,
        angle=run.angles,
        speed=run.rates,
        acceleration=run.accelerations,
        torque=torque,
        memory=run.memories,
        load=load,
        lost=np.full_like(load, np.nan),
        energy=np.full((len(times), len(LEDGER)), np.nan),
        end=end,
        steps=run.steps,
        iterations=0,
        status=COMPLETE,
    )


def _exact(problem: Problem, state: MotionState, times: Array) -> Marched:
    """The same from event to event, to rounding, without a ledger."""
    run = exact_motion(problem, state, times)
    none, speed = np.zeros_like(run.torque), problem.start_speed
    end = MotionState(float(times[-1]), run.angles[-1], run.rates[-1], none[-1], np.zeros(0), speed)
    unbooked = np.full((len(times), len(LEDGER)), np.nan)
    motion = (run.angles, run.rates, run.accelerations, run.torque)
    return Marched(times, *motion, none, none, none, unbooked, end, run.events, 0, COMPLETE)
