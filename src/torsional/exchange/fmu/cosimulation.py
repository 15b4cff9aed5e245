"""A run in time of a line with functional mock-up units in it."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.exchange.fmu.coupling import FmuPart, PartTorques, Running
from torsional.numerics.arrays import Array
from torsional.numerics.motion.tables import LEVEL_OF, TIME, VALUE
from torsional.solvers.transient.marching import COMPLETE, Accuracy, Marched, marched
from torsional.solvers.transient.presented import kept, presented
from torsional.solvers.transient.problem import Drives, Problem
from torsional.solvers.transient.run import together
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.solvers.transient.starts import MotionState, starting
from torsional.system import System


@checked
def co_simulation(
    system: System,
    drives: Drives,
    time: float,
    parts: object,
    start: object = "rest",
    *,
    communication_step: float = 1e-4,
    speed: float | SpeedProfile | None = None,
    hold: str = "",
    step: float = 1e-4,
    method: str = "chung_hulbert",
    spectral_radius: float = 0.8,
    keep: Sequence[str] = (),
) -> xr.Dataset:
    """Motion of a ``system`` under ``drives`` over a ``time`` [s], with one or several `FmuPart` as ``parts``.

    At each ``communication_step`` [s] the units are told the motion and step ahead; over the same step the line takes
    ``step`` [s] after step under torques that run in straight lines to those found.  The error of the coupling is of
    second order in the communication step.  The other arguments and the Dataset are those of `transient`, with samples
    at the points of communication.  What a unit does belongs to the work of sources in the ledger.

    Raises ModelError for a file that is no unit, none for co-simulation or none for this machine, for variables that
    are not there, and where a unit gives up; FMPy is wanted (the extra `fmi`).
    """
    listed = [parts] if isinstance(parts, FmuPart) else parts
    if not isinstance(listed, Sequence) or not listed or not all(isinstance(part, FmuPart) for part in listed):
        raise ModelError("units are wanted", where="parts", found=repr(parts)[:60], remedy="name FmuPart(…) or several")
    if not 0 < time < math.inf or not 0 < communication_step <= time:
        found = f"{communication_step:g} s of {time:g} s"
        raise ModelError("steps of communication divide the time", where="communication_step", found=found)
    own = list(drives) if isinstance(drives, Sequence) else [drives]
    accuracy = Accuracy(step, method, spectral_radius)
    problem = Problem.of(system, [*own, *(PartTorques(part) for part in listed)], speed, hold=hold)
    kept(keep, system.nodes, system.connections.names)
    state = starting(start, problem.system, problem.acting, problem.hold, problem.start_speed)
    with contextlib.ExitStack() as stack:
        running = [Running(part, system, stack) for part in listed]
        told = _Coupled(problem, accuracy, running, [len(part.torques) for part in listed]).over(
            state, time, communication_step
        )
    settings: dict[str, Any] = {"step": step, "method": method, "spectral_radius": spectral_radius}
    run = presented(problem, told, keep, reference=problem.reference_node, **settings)
    units = ", ".join(str(part.path) for part in listed)
    return run.assign_attrs(analysis="co-simulation", communication_step=communication_step, units_coupled=units)


class _Coupled:
    """A line and the units in it, from one point of communication to the next."""

    def __init__(self, problem: Problem, accuracy: Accuracy, units: Sequence[Running], counts: Sequence[int]) -> None:
        self.problem, self.accuracy, self.units = problem, accuracy, units
        outside, last = problem.plan.outside, len(problem.acting.sources) - bool(problem.hold)
        levels = outside.source_places[LEVEL_OF, last - sum(counts) : last]
        self.knots, self.places = outside.knots, outside.level_start[levels]

    def over(self, state: MotionState, time: float, length: float) -> Marched:
        """The whole run, as far as it goes."""
        count = max(round(time / length), 1)
        begun, width = state.time, time / count
        motion = (state.angle, state.speed, np.zeros_like(state.angle))
        torque = np.concatenate([unit.begin(begun, motion, self._frame(begun)) for unit in self.units])
        self._hold(begun, width, torque, torque)
        told: list[Marched] = []
        status = COMPLETE
        try:
            for k in range(count):
                at = begun + k * width
                last = told[-1] if told else None
                if last is not None:
                    motion = (last.angle[-1], last.speed[-1], last.acceleration[-1])
                found = np.concatenate([unit.step(at, width, motion, self._frame(at)) for unit in self.units])
                self._hold(at, width, torque, found)
                told.append(self._piece(last.end if last else state, width))
                torque = found
        except KeyboardInterrupt:
            if not told:
                raise
            status = f"interrupted at {told[-1].end.time:.6g} s"
        return together(told, status)

    def _frame(self, time: float) -> tuple[float, float]:
        return float(self.problem.speed.angle(time)), float(self.problem.speed.at(time))

    def _hold(self, time: float, width: float, first: Array, last: Array) -> None:
        """Torques in straight lines over the step to come."""
        self.knots[TIME, self.places], self.knots[TIME, self.places + 1] = time, time + width
        self.knots[VALUE, self.places], self.knots[VALUE, self.places + 1] = first, last

    def _piece(self, state: MotionState, width: float) -> Marched:
        steps = max(math.ceil(width / self.accuracy.step - 1e-9), 1)
        own = Accuracy(width / steps, self.accuracy.method, self.accuracy.spectral_radius)
        told = marched(self.problem, state, steps, own, steps)
        if told.status not in (COMPLETE, "the time step made more than 1 % of the energy of its own"):
            where, remedy = f"time {state.time:.6g} s", "take a shorter communication step"
            raise ModelError("the line and its units lose the motion", where=where, found=told.status, remedy=remedy)
        return told
