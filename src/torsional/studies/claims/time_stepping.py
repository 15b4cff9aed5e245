"""The claims about stepping in time with gap-activated springs (E1, E2)."""

from __future__ import annotations

import time as clock
from collections.abc import Callable
from functools import partial
from statistics import median
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from torsional.numerics.alpha_method import AlphaMethod
from torsional.numerics.arrays import Array
from torsional.numerics.stepping import Settings, begin, march
from torsional.solvers.transient import transient
from torsional.studies.claims.answers import floats, sweep
from torsional.studies.claims.base import Figure, Finding, claim
from torsional.studies.claims.loose_springs import SAMPLING, SPAN, LooseMotion
from torsional.studies.claims.trucks import Trucks
from torsional.units import RPM

CONDITION = (
    "the truck's DMF with straight springs in three channels, their play 0.7° to 1°, shoes and tabs that only push, no "
    "dry friction; top gear, 650 rpm, 300 Nm, third order, 0.5 s from equilibrium on; error: RMS of the relative angle "
    "over the run, of the RMS of its swing"
)
STEP = 1e-4
STIFF = ("LSODA", "BDF", "Radau")
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
ROUNDS = 3
STEPS = np.array([0.05, 0.1, 0.2, 0.25, 0.5, 1.0]) * 1e-3
RADII = (1.0, 0.9, 0.8, 0.5)
SMALL = 0.05
"""Error up to which little accuracy is lost."""
SEVERAL = 3.0
"""Times a step at least that count as several."""
ELSEWHERE = ((700.0, 150.0), (800.0, 100.0), (700.0, 1000.0))
"""Other speeds [rpm] and mean torques [Nm]: two at which the springs rattle, one at which they stay closed."""


class Run(NamedTuple):
    """One whole run: CPU time [s] (median of some), error [-], tolerance or step."""

    seconds: float
    error: float
    accuracy: float


def stepped(motion: LooseMotion, step: float = STEP) -> Run:
    """The public call, its dataset with everything in it."""

    def once() -> Array:
        line, drive, load = motion.system, motion.excitation, motion.model.landmarks.load
        found = transient(line, drive, SPAN, motion.start, hold=load, step=step, output=SAMPLING)
        return np.asarray((found.angle.sel(node="secondary") - found.angle.sel(node="primary")).values)

    return _timed(motion, once, step, ROUNDS)


def integrated(motion: LooseMotion, method: str, error: float) -> Run:
    """A general integrator at the loosest of some tolerances that comes to an ``error``, or at the tightest."""
    start, times = np.concatenate([motion.start.angle, motion.start.speed]), motion.times
    rates, options = motion.rates(), {}
    if method in STIFF:
        options["jac"] = motion.jacobian()

    def once(tolerance: float) -> Array:
        allowed = {"rtol": tolerance, "atol": 1e-3 * tolerance}
        found = solve_ivp(rates, (0.0, SPAN), start, method=method, t_eval=times, **allowed, **options)
        return motion.twist(found.y[: len(start) // 2].T) if found.success else np.full(len(times), np.inf)

    for tolerance in TOLERANCES:
        if motion.error(once(tolerance)) <= error:
            break
    return _timed(motion, partial(once, tolerance), tolerance, 1)


def _timed(motion: LooseMotion, once: Callable[[], Array], accuracy: float, rounds: int) -> Run:
    """One round warms the caches where several are timed."""
    twist, seconds = once() if rounds > 1 else np.zeros(0), []
    for _ in range(rounds):
        begun = clock.process_time()
        twist = once()
        seconds.append(clock.process_time() - begun)
    return Run(median(seconds), motion.error(twist), accuracy)


@claim(
    "E1",
    "6.1",
    "The LCP form solves gap-activated springs faster than a general integrator.",
    "CPU time of whole runs in one process, compiled code warm: the active-set steps (the LCP's solution) with their "
    "dataset take less than each of the stiff adaptive integrators at the loosest tolerance that comes to their error, "
    "right-hand side compiled and Jacobian given. An explicit integrator is told too",
)
def e1(trucks: Trucks) -> Finding:
    motion = LooseMotion(trucks.dmf)
    ours = stepped(motion)
    peers = {method: integrated(motion, method, ours.error) for method in (*STIFF, "RK45")}
    figures: dict[str, Figure] = {
        "active-set steps of 0.1 ms: time [ms]": 1e3 * ours.seconds,
        "their error [-]": ours.error,
    }
    for method, run in peers.items():
        figures[f"{method} with tolerance {run.accuracy:g}: time over theirs [-]"] = run.seconds / ours.seconds
        figures[f"its error over theirs [-]: {method}"] = run.error / ours.error
    equal = all(peers[method].error <= ours.error for method in STIFF)
    quicker = all(peers[method].seconds > ours.seconds for method in STIFF)
    reason = "" if equal else "not every integrator came to the same error"
    if equal and not quicker:
        reason = "a stiff integrator is as quick here"
    return Finding(equal and quicker, CONDITION, figures, reason)


def errors(motion: LooseMotion, radius: float, guard: bool = False) -> Array:
    """Error of runs with every step of `STEPS`, contact times as they are unless under the ``guard``."""
    plan = motion.problem.plan
    state = begin(plan, motion.start.angle, motion.start.speed)
    settings, method, told = Settings(guard=guard, production=np.inf), AlphaMethod.chung_hulbert(radius), []
    for step in STEPS:
        stride = round(SAMPLING / step)
        found = march(plan, method, float(step), round(SPAN / step), state, stride=stride, settings=settings)
        error = motion.error(motion.twist(found.records.q))
        told.append(error if np.isfinite(error) else np.inf)
    return np.array(told)


def largest(errors: Array) -> float:
    """The largest step [s] up to which all errors are small; 0 without one.

    >>> largest(np.array([1e-3, 2e-3, 0.1, 1e-3, 1e-3, 1e-3])), largest(np.full(6, 1.0))
    (0.0001, 0.0)
    """
    good = int(np.argmin(np.append(errors <= SMALL, False)))
    return float(STEPS[good - 1]) if good else 0.0


def growth(table: dict[float, Array]) -> float:
    """How much longer than with radius 1 the step may be with the best radius below."""
    plain = largest(table[1.0])
    return max(largest(table[radius]) for radius in RADII[1:]) / plain if plain else float("nan")


@claim(
    "E2",
    "6.1",
    "With numerical damping the time step can grow several times with little loss of accuracy.",
    "error over steps of 0.05 to 1 ms with spectral radius 1 and below, contact times as they are: the largest step up "
    "to which the error stays within 5 % is at least three times as long with some radius below 1 as with 1, and at "
    "the smallest step their errors are alike (within 10 %)",
)
def e2(trucks: Trucks) -> Finding:
    motion = LooseMotion(trucks.dmf)
    table = {radius: errors(motion, radius) for radius in RADII}
    limits = {radius: largest(found) for radius, found in table.items()}
    best = max(RADII[1:], key=lambda radius: limits[radius])
    guarded, weak = errors(motion, 1.0, guard=True), list[str]()
    figures: dict[str, Figure] = {"steps [ms]": floats(1e3 * STEPS)}
    figures |= {f"error, spectral radius {radius:g} [%]": floats(100 * found) for radius, found in table.items()}
    figures |= {f"largest step, spectral radius {radius:g} [ms]": 1e3 * step for radius, step in limits.items()}
    figures["error, spectral radius 1, contact times of at least half a step [%]"] = floats(100 * guarded)
    figures["gain [-]"] = gain = growth(table)
    for rpm, torque in ELSEWHERE:
        other = LooseMotion(trucks.dmf, rpm * RPM, torque)
        found = growth({radius: errors(other, radius) for radius in RADII})
        figures[f"gain at {rpm:g} rpm, {torque:g} Nm [-]"] = found
        if not found >= SEVERAL:
            weak.append(f"{rpm:g} rpm, {torque:g} Nm")
    alike = abs(table[best][0] / table[1.0][0] - 1) < 0.1
    reasons = [] if gain >= SEVERAL else ["the step grows by less than three times"]
    reasons += [] if alike else ["small steps are not alike"]
    reasons += [f"elsewhere it grows by less than three times: {'; '.join(weak)}"] if weak else []
    reason = ", ".join(reasons)
    plain = {f"error_{round(100 * radius)}": (found, "ratio") for radius, found in table.items()}
    return Finding(gain >= SEVERAL and alike, CONDITION, figures, reason, sweep("E2", "step", STEPS, "time", **plain))
