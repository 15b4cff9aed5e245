"""The claim about whole runs with gap-activated springs against general integrators (E1)."""

from __future__ import annotations

import time as clock
from collections.abc import Callable
from functools import partial
from statistics import median
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from torsional.numerics.arrays import Array
from torsional.solvers.transient import transient
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.claims.loose_springs import SAMPLING, SPAN, LooseMotion
from torsional.studies.trucks import Trucks

CONDITION = (
    "the truck's DMF with straight springs in three channels, their play 0.7° to 1°, shoes and tabs that only push, no "
    "dry friction; top gear, 650 rpm, 300 Nm, third order, 0.5 s from equilibrium on; error: RMS of the relative angle "
    "over the run, of the RMS of its swing"
)
STEP = 1e-4
STIFF = ("LSODA", "BDF", "Radau")
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
ROUNDS = 3


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
    trucks=0,  # about a method, not about trucks
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
