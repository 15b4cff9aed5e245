"""A run in time: what a system does under its drives from a start on."""

from __future__ import annotations

import itertools
import math
import time as clock
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.solvers.transient.honesty import honest
from torsional.solvers.transient.marching import COMPLETE, Accuracy, Marched, marched
from torsional.solvers.transient.presented import joined, kept, presented
from torsional.solvers.transient.problem import Drives, Levels, Problem
from torsional.solvers.transient.resuming import resumable, resumed
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.solvers.transient.starts import MotionState, starting
from torsional.system import System
from torsional.units import show

Progress = Callable[[float, float, float], None]
"""Called with the simulated time [s], the end [s] and how many seconds are simulated in one of the clock."""

PIECES = 100
"""Pieces of a run between which it can be stopped and the step be changed."""
FEWEST = 1000
"""Steps of the shortest piece."""
HALVINGS = 6
MOST_SAMPLES = 100_000
"""Samples of a run that does not say how many it wants."""


@checked
def transient(
    system: System,
    drives: Drives,
    time: float,
    start: object = None,
    *,
    speed: float | SpeedProfile | None = None,
    hold: str = "",
    levels: Levels | None = None,
    reference: str = "",
    reference_time: float = np.inf,
    step: float = 1e-4,
    method: str = "chung_hulbert",
    spectral_radius: float = 0.8,
    angle_error: float = 0.0,
    tolerance: float = 1e-8,
    output: float | ArrayLike = 0.0,
    keep: Sequence[str] = (),
    progress: Progress | None = None,
) -> xr.Dataset:
    """Motion of a ``system`` under ``drives`` over a ``time`` [s], laws, contacts and friction as they are.

    ``drives``: an `Excitation` (its orders keep to the mean rotation) or any of `OrderTorques`, `CylinderTorques`,
    `TorqueHistory`, `Governor`, or several.  ``start``: "equilibrium" under the mean torques (default), "vibrating"
    (the linear response), "rest", a `MotionState`, the result of another run, or one motion of `harmonic_response` or
    `periodic_response`; from a result with the same drives and settings it goes on to the last bit, its ledger too.
    ``speed`` [rad/s]: the mean speed or a `SpeedProfile`, default that of the excitation.  ``hold``: the node that
    takes up the mean torque where no spring to the ground does.  ``levels`` {name: (times, values)} that normal loads
    follow.
    ``reference``: node whose speed counts for centrifugal forces; with ``reference_time`` [s] the dampers to ground
    follow it.  ``step`` [s], ``method`` (chung_hulbert, hht, bossak, newmark; "explicit" chooses its steps by
    ``tolerance``; "exact" goes from event to event, to rounding, in lines of linear parts, hinges and contacts under
    harmonic torques), ``spectral_radius`` ρ∞; with an ``angle_error`` [rad] steps are halved and doubled so that none
    makes more of it.  ``output``: interval [s] of the samples (default every step, up to 100 000 of them), ``keep``:
    names of the nodes and elements in the result (default all).  ``progress`` is called now and then.

    Dimensions time, node, element: ``angle`` [rad], the deviation from the mean rotation, ``angular_velocity`` [rad/s],
    whole, ``acceleration``; ``twist`` and ``torque`` [Nm] of elements, damping and laws included; ``memory`` and
    ``normal_load`` of friction, ``friction_loss`` [J] of each part that rubs; ``energy`` [J] by share.  Interrupted
    from the keyboard it gives what was reached, with a ``status`` that says so; ``method_share`` in the attributes is
    what the steps made or lost of the energy that passed through.  A step that produces energy is halved; ModelError
    where that does not help.

    M q̈ + C q̇ + K q + Σ w f(w·q, w·q̇, memory) = u(t, angle); generalised-α steps after Chung and Hulbert (J. Appl.
    Mech. 60 (1993) 371).

    >>> from torsional.components import Inertia, Shaft
    >>> from torsional.engine import Excitation
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> one = assemble(Powertrain({"disc": Inertia(1.0), "spring": Shaft("ground", "disc", 100.0)}))
    >>> unit = Excitation(("disc",), [0.0], 10.0, [[100.0]])
    >>> found = transient(one, unit, 0.1 * np.pi, "rest")
    >>> round(float(found.angle.max()), 4)  # loaded at once, it swings to twice the static angle
    2.0
    """
    if not 0 < time < np.inf:
        raise ModelError("a run takes some time", where="time", found=f"{time:g} s")
    given = {"hold": hold, "levels": levels, "reference": reference, "reference_time": reference_time}
    problem = Problem.of(system, drives, speed, **given)  # type: ignore[arg-type]
    kept(keep, system.nodes, system.connections.names)
    accuracy = Accuracy(_fitting(step, time), method, spectral_radius, angle_error, tolerance)
    notes = {"switched": words} if (words := _switching(problem)) else {}
    run, state = Run(problem, accuracy, progress, notes), started(problem, start)
    state = resumed(start, state, problem, run.accuracy)
    moments = wanted(output, time)
    told = run.over(state, time, moments) if isinstance(moments, float) else run.at(state, time, moments)
    notes |= honest(problem, told.end.standing, run.accuracy)
    settings = {"step": run.accuracy.step, "method": method, "spectral_radius": spectral_radius}
    found = presented(problem, told, keep, reference=problem.reference_node, **settings, **run.notes)
    return resumable(found, problem, told.end, run.accuracy)


def started(problem: Problem, start: object) -> MotionState:
    """The state that a ``start`` means."""
    return starting(start, problem.system, problem.acting, problem.hold, problem.start_speed)


def run_of(problem: Problem, step: float, time: float) -> Run:
    """A run by the default method over a ``time`` [s], for who takes its pieces as they come and keeps none."""
    return Run(problem, Accuracy(_fitting(step, time)))


def _switching(problem: Problem) -> str:
    """What is to be said of inertias that switch within the range of mean speeds: in time they do not."""
    masses, (low, high) = problem.system.masses, problem.speed.range
    pairs = zip(masses.names, masses.switches, strict=True)
    names = [name for name, switch in pairs if switch is not None and switch.above(low) != switch.above(high)]
    kept_at = f"what they are at {show(problem.start_speed, 'speed')}"
    return f"the inertias of {', '.join(names)} stay {kept_at}, though the speed passes their switch" if names else ""


@dataclass(eq=False)
class Run:
    """Goes on piece by piece, halves the step where it must, and can be stopped between pieces."""

    problem: Problem
    accuracy: Accuracy
    progress: Progress | None = None
    notes: dict[str, str] = field(default_factory=dict)

    def at(self, state: MotionState, time: float, times: Array) -> Marched:
        """A run over a ``time`` [s] of which the moments ``times`` [s] from its start on are kept."""
        whole, edges = self.accuracy, np.unique(np.concatenate([[0.0], times, [time]]))
        parts: list[Marched] = []
        for begin, end in itertools.pairwise(edges):
            steps = max(math.ceil((end - begin) / whole.step - 1e-9), 1)
            self.accuracy = replace(whole, step=(end - begin) / steps)
            parts.append(self.over(parts[-1].end if parts else state, end - begin, end - begin))
            if parts[-1].status != COMPLETE:
                break
        self.accuracy = whole
        return _picked(together(parts, parts[-1].status), state.time + times)

    def over(self, state: MotionState, time: float, output: float = 0.0) -> Marched:
        """Everything from a state on over a ``time`` [s], kept at intervals of ``output`` [s]."""
        parts: list[Marched] = []
        begun, status = clock.perf_counter(), COMPLETE
        try:
            for part in self.pieces(state, time, output):
                parts.append(part)
                self._tell(part.end.time, state.time + time, begun, part.end.time - state.time)
        except KeyboardInterrupt:
            if not parts:
                raise
            status = f"interrupted at {parts[-1].end.time:.6g} s"
        return together(parts, status)

    def pieces(self, state: MotionState, time: float, output: float = 0.0) -> Iterator[Marched]:
        """The same piece by piece, each from the end of the one before."""
        total = max(round(time / self.accuracy.step), 1)
        every = max(round(output / self.accuracy.step), 1) if output else 1 + total // MOST_SAMPLES
        length = max(int(np.ceil(total / PIECES)), FEWEST)
        length += -length % every
        for left in range(total, 0, -length):
            part = self._piece(state, min(length, left), every, total)
            yield part
            state = part.end

    def _piece(self, state: MotionState, steps: int, every: int, total: int) -> Marched:
        """One piece, with halved steps where the method's own production asks for it."""
        refine = self._refinement
        for _ in range(HALVINGS):
            accuracy = replace(self.accuracy, step=self.accuracy.step / refine)
            told = marched(self.problem, state, steps * refine, accuracy, every * refine)
            if told.status == COMPLETE:
                self._refinement = refine
                return told
            refine *= 2
            self.notes["refined"] = (
                f"step halved to {self.accuracy.step / refine:.3g} s from {state.time:.6g} s on: {told.status}"
            )
        raise ModelError(
            "no step was small enough for a run that can be believed",
            where=f"time {state.time:.6g} s",
            found=f"{told.status}, with a step of {accuracy.step:.3g} s",
            remedy="give stiff stops a contact time (damping), take spectral_radius=0, or a smaller step",
        )

    _refinement: int = 1

    def _tell(self, reached: float, end: float, begun: float, simulated: float) -> None:
        if self.progress is not None:
            self.progress(reached, end, simulated / max(clock.perf_counter() - begun, 1e-9))


def _fitting(step: float, time: float) -> float:
    """The step, or the next smaller one that ends where the run does."""
    steps = time / step if 0 < step < np.inf else 1.0
    return step if abs(steps - round(steps)) <= 1e-9 * steps and round(steps) else time / math.ceil(steps)


def wanted(output: ArrayLike, time: float) -> float | Array:
    """The interval of samples, or the moments [s] that are asked for, rising; ModelError for moments beyond the run."""
    if np.ndim(output) == 0:
        interval = float(np.asarray(output, dtype=float))
        if not 0 <= interval < np.inf:
            raise ModelError("the interval of samples is positive", where="output", found=f"{interval:g} s")
        return interval
    times = np.unique(np.asarray(output, dtype=float))
    if not times.size or not (times[0] >= 0 and times[-1] <= time * (1 + 1e-12)):
        found, allowed = (f"{times[0]:g} to {times[-1]:g} s" if times.size else "none"), f"0 to {time:g} s"
        raise ModelError("a moment lies outside the run", where="output", found=found, allowed=allowed)
    return np.asarray(np.minimum(times, time))


def _picked(told: Marched, times: Array) -> Marched:
    """The record at some of its moments."""
    near = np.searchsorted(told.time, times - 1e-9 * np.maximum(np.abs(times), 1e-3))
    at = np.unique(near[near < told.time.size])
    fields = ("time", "angle", "speed", "acceleration", "torque", "memory", "load", "lost", "energy")
    return told._replace(**{name: getattr(told, name)[at] for name in fields})


def together(parts: Sequence[Marched], status: str) -> Marched:
    """Pieces as one record."""
    return Marched(
        joined([part.time for part in parts]),
        joined([part.angle for part in parts]),
        joined([part.speed for part in parts]),
        joined([part.acceleration for part in parts]),
        joined([part.torque for part in parts]),
        joined([part.memory for part in parts]),
        joined([part.load for part in parts]),
        joined([part.lost for part in parts]),
        joined([part.energy for part in parts]),
        parts[-1].end,
        sum(part.steps for part in parts),
        sum(part.iterations for part in parts),
        status,
    )
