"""The claim about whole runs with gap-activated springs against general integrators (E1)."""

from __future__ import annotations

import time as clock
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from statistics import median
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import xarray as xr
from scipy.integrate import solve_ivp

from torsional.numerics.arrays import Array
from torsional.results import labelled
from torsional.solvers.transient import transient
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.claims.loose_springs import SAMPLING, SPAN, LooseMotion
from torsional.studies.trucks import Trucks

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture

CONDITION = (
    "the truck's DMF with straight springs in three channels, their play 0.7° to 1°, shoes and tabs that only push, no "
    "dry friction; top gear, 650 rpm, 300 Nm, third order, 0.5 s from equilibrium on; error: RMS of the relative angle "
    "over the run, of the RMS of its swing"
)
STEP = 1e-4
STIFF = ("LSODA", "BDF", "Radau")
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
ROUNDS = 3


FINER = (2e-4, 5e-5)
"""Other steps [s] that the picture shows."""


class Run(NamedTuple):
    """One whole run: CPU time [s] (median of some), error [-], tolerance or step, work: steps or evaluations of ẏ."""

    seconds: float
    error: float
    accuracy: float
    work: float


def stepped(motion: LooseMotion, step: float = STEP) -> Run:
    """The public call, its dataset with everything in it."""

    def once() -> Array:
        line, drive, load = motion.system, motion.excitation, motion.model.landmarks.load
        found = transient(line, drive, SPAN, motion.start, hold=load, step=step, output=SAMPLING)
        return np.asarray((found.angle.sel(node="secondary") - found.angle.sel(node="primary")).values)

    return _timed(motion, once, step, ROUNDS)._replace(work=float(round(SPAN / step)))


def integrated(motion: LooseMotion, method: str, error: float) -> list[Run]:
    """Runs of a general integrator with tighter and tighter tolerances, the last coming to an ``error`` or the
    tightest there is."""
    start, times = np.concatenate([motion.start.angle, motion.start.speed]), motion.times
    rates, options = motion.rates(), {}
    if method in STIFF:
        options["jac"] = motion.jacobian()
    counts: list[float] = []

    def once(tolerance: float) -> Array:
        allowed = {"rtol": tolerance, "atol": 1e-3 * tolerance}
        found = solve_ivp(rates, (0.0, SPAN), start, method=method, t_eval=times, **allowed, **options)
        counts.append(float(found.nfev))
        return motion.twist(found.y[: len(start) // 2].T) if found.success else np.full(len(times), np.inf)

    once(TOLERANCES[0])  # warms the caches
    runs: list[Run] = []
    for tolerance in TOLERANCES:
        runs.append(_timed(motion, partial(once, tolerance), tolerance, 1)._replace(work=counts[-1]))
        if runs[-1].error <= error:
            break
    return runs


def _timed(motion: LooseMotion, once: Callable[[], Array], accuracy: float, rounds: int) -> Run:
    """One round warms the caches where several are timed."""
    twist, seconds = once() if rounds > 1 else np.zeros(0), []
    for _ in range(rounds):
        begun = clock.process_time()
        twist = once()
        seconds.append(clock.process_time() - begun)
    return Run(median(seconds), motion.error(twist), accuracy, 0.0)


def work_precision(data: xr.Dataset) -> Picture:
    """Error over the time that it takes."""
    from torsional.plots import plot_work_precision

    return plot_work_precision(data)


@claim(
    "E1",
    "6.1",
    "The LCP form solves gap-activated springs faster than a general integrator.",
    "CPU time of whole runs in one process, compiled code warm: the active-set steps (the LCP's solution) with their "
    "dataset take less than each of the stiff adaptive integrators at the loosest tolerance that comes to their error, "
    "right-hand side compiled and Jacobian given. An explicit integrator is told too",
    varies="time step 0.2, 0.1 and 0.05 ms; tolerance of four adaptive integrators from 1e-3 on, as far as is needed",
    picture=work_precision,
    leading="their error [-]",
    trucks=0,  # about a method, not about trucks
)
def e1(trucks: Trucks) -> Finding:
    motion = LooseMotion(trucks.dmf)
    ours = stepped(motion)
    tried = {method: integrated(motion, method, ours.error) for method in (*STIFF, "RK45")}
    peers = {method: runs[-1] for method, runs in tried.items()}
    figures: dict[str, Figure] = {"their error [-]": ours.error, "active-set steps of 0.1 ms": ours.work}
    timed: dict[str, Figure] = {"active-set steps of 0.1 ms: time [ms]": 1e3 * ours.seconds}
    for method, run in peers.items():
        figures[f"its error over theirs [-]: {method}"] = run.error / ours.error
        figures[f"{method} with tolerance {run.accuracy:g}: evaluations of the rates [-]"] = run.work
        timed[f"{method} with tolerance {run.accuracy:g}: time over theirs [-]"] = run.seconds / ours.seconds
    equal = all(peers[method].error <= ours.error for method in STIFF)
    quicker = all(peers[method].seconds > ours.seconds for method in STIFF)
    reason = "" if equal else "not every integrator came to the same error"
    if equal and not quicker:
        reason = "a stiff integrator is as quick here"
    every = {OURS: sorted([ours, *(stepped(motion, step) for step in FINER)], key=lambda run: run.accuracy)} | tried
    return Finding(equal and quicker, CONDITION, figures, reason, _drawn(every), measured=timed)


OURS = "active-set steps"


def _drawn(every: Mapping[str, Sequence[Run]]) -> xr.Dataset:
    """All runs; what the clock measured is marked so."""
    runs = [(method, run) for method, found in every.items() for run in found]
    data = labelled(
        {
            "method": (("run",), np.array([method for method, _ in runs]), ""),
            "error": (("run",), np.array([run.error for _, run in runs]), "relative_difference"),
            "accuracy": (("run",), np.array([run.accuracy for _, run in runs]), "number"),
            "work": (("run",), np.array([run.work for _, run in runs]), "number"),
            "cpu_time": (("run",), np.array([run.seconds for _, run in runs]), "time"),
        },
        {"run": (np.arange(len(runs)), "")},
        analysis="claim E1",
        ours=OURS,
    )
    data.cpu_time.attrs["measured"] = 1
    data.accuracy.attrs["long_name"] = "tolerance of an integrator, or time step in seconds"
    return data
