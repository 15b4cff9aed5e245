"""This project at DMF-LCP-1: the public call with its dataset, the march alone, and many operating points."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable
from itertools import product

import numpy as np
from ledger import Floor
from tests.validation import dmf_lcp
from tests.validation.dmf_lcp import NODES, PRIMARY, RPM, SECONDARY, Flywheel

NAMES = [f"node_{i}" for i in range(NODES)]
RADIUS = 0.9  # ρ∞, Exudyn's default too

# T2
SPEEDS, TORQUES = np.linspace(600.0, 2000.0, 20) * RPM, np.linspace(50.0, 750.0, 15)
POINTS = [(float(speed), float(torque)) for speed, torque in product(SPEEDS, TORQUES)]


def system():
    """The flywheel as a line of components."""
    from torsional import Coupling, Inertia, Powertrain, Shaft, assemble
    from torsional.components import Damper
    from torsional.laws import Contacts

    parts = {name: Inertia(float(J)) for name, J in zip(NAMES, dmf_lcp.INERTIA, strict=True)}
    for a, b, k, c in dmf_lcp.LINEAR:
        part = Shaft(NAMES[b], NAMES[a], k, c) if k else Damper(NAMES[b], NAMES[a], c)
        parts[f"{'shaft' if k else 'grease'}_{a}_{b}"] = part
    springs: dict[tuple[int, int], list[tuple[float, float, float, float]]] = {}
    for a, b, gap, k in zip(dmf_lcp.PLUS, dmf_lcp.MINUS, dmf_lcp.GAP, dmf_lcp.SPRING_STIFFNESS, strict=True):
        springs.setdefault((int(a), int(b)), []).append((-float(gap), -1.0, float(k), dmf_lcp.CONTACT_TIME))
    for (a, b), rows in springs.items():
        parts[f"spring_{a}_{b}"] = Coupling(NAMES[a], NAMES[b], Contacts(*zip(*rows, strict=True)))
    return assemble(Powertrain(parts))


def response(step: float, span: float, sampling: float) -> Callable[[], object]:
    """The public call on the assembled line, its dataset with every node, connection and energy."""
    from torsional import Excitation
    from torsional.solvers.transient import SpeedProfile, TorqueHistory, transient

    low, high, ramp, mean = dmf_lcp.RUN_UP.drive
    drives = [
        Excitation([NAMES[PRIMARY]], [0, dmf_lcp.ORDER], low, [[mean, -1j * dmf_lcp.SWING]]),
        TorqueHistory(NAMES[dmf_lcp.VEHICLE], (0.0,), (-mean,)),
    ]
    settings = {"speed": SpeedProfile.ramp(low, high, ramp), "step": step, "output": sampling}
    line = system()
    return lambda: transient(line, drives, span, "rest", spectral_radius=RADIUS, **settings)


def told_of_response(found) -> np.ndarray:
    """θ0 − θ1 [rad] over time."""
    angle = found.angle
    return (angle.sel(node=NAMES[PRIMARY]) - angle.sel(node=NAMES[SECONDARY])).values


def march(step: float, span: float, sampling: float, flywheel: Flywheel = dmf_lcp.RUN_UP) -> Callable[[], object]:
    """The steps alone, with their energies; what is made once of the arrays is made before."""
    from torsional.numerics.stepping.alpha_method import AlphaMethod
    from torsional.numerics.stepping.marching import begin
    from torsional.numerics.stepping.marching import march as marched
    from torsional.numerics.stepping.plan import prepare

    plan = prepare(flywheel.equations())
    start = begin(plan, np.zeros(NODES), np.zeros(NODES))
    method, stride = AlphaMethod.chung_hulbert(RADIUS), round(sampling / step)
    return lambda: marched(plan, method, step, round(span / step), start, stride=stride)


def told_of_march(found) -> np.ndarray:
    """θ0 − θ1 [rad] over time."""
    q = found.records.q
    return q[:, PRIMARY] - q[:, SECONDARY]


def explicit(tolerance: float, span: float, sampling: float) -> Callable[[], object]:
    """The explicit integrator of the same arrays."""
    from torsional.numerics.explicit.march import explicit_march

    arrays, times, rest = dmf_lcp.equations(), np.linspace(0.0, span, round(span / sampling) + 1), np.zeros(NODES)
    return lambda: explicit_march(arrays, times, rest, rest, tolerance=tolerance)


def told_of_explicit(found) -> np.ndarray:
    """θ0 − θ1 [rad] over time."""
    return found.angles[:, PRIMARY] - found.angles[:, SECONDARY]


def floor(step: float, span: float) -> Floor:
    """Additions and multiplications of a step of the active-set iteration, with 1.15 passes and 0.15 factors a step.

    A pass: both substitutions, twist, rate and torque of each connection from the solution and the torques to the
    nodes, 12 a connection; 4 a hinge for its test; 6 a node.  A factor: 2 an update, 1 a coupling, 4 a connection for
    the matrix.  Once a step: 25 a node for the prediction and the energies, 8 a connection for what dampers lose.
    """
    from torsional.numerics.linear.sparse_factor import tape_of

    pairs = {(a, b) for a, b, *_ in dmf_lcp.LINEAR} | set(zip(dmf_lcp.PLUS, dmf_lcp.MINUS, strict=True))
    joined = {frozenset((int(a), int(b))) for a, b in pairs}
    tape = tape_of([set(pair) for pair in joined], NODES)
    couplings, updates, edges, hinges = tape.couplings.shape[1], tape.updates.shape[1], len(joined), dmf_lcp.PLUS.size
    once = 4 * couplings + NODES + 12 * edges + 4 * hinges + 6 * NODES
    factor = 2 * updates + couplings + NODES + 4 * edges
    each = 1.15 * once + 0.15 * factor + 25 * NODES + 8 * edges
    return Floor(flops=each * span / step, bytes=0.0)


# --- T2 ---


def operate(point: tuple[float, float], step: float = 1e-4, span: float = 3.0, sampling: float = 1e-3) -> float:
    """One operating point from rest; the swing of θ0 − θ1 over the last third."""
    speed, torque = point
    flywheel = Flywheel(speed, speed, span, torque)
    twist = told_of_march(march(step, span, sampling, flywheel)())
    assert np.isfinite(twist).all()
    return float(np.ptp(twist[2 * twist.size // 3 :]))


def operate_all(processes: int) -> tuple[float, float, np.ndarray]:
    """Time on the clock and CPU time [s] for all operating points, and their swings; workers are warm before."""
    context = multiprocessing.get_context("spawn")
    with context.Pool(processes) as pool:
        pool.map(_warm, range(4 * processes), chunksize=1)
        begun = time.perf_counter()
        told = pool.map(_timed, POINTS, chunksize=5)
        clock = time.perf_counter() - begun
    seconds, swings = np.array(told).T
    return clock, float(seconds.sum()), swings


def _warm(_: int) -> float:
    return operate(POINTS[0], span=0.1)


def _timed(point: tuple[float, float]) -> tuple[float, float]:
    begun = time.process_time()
    swing = operate(point)
    return time.process_time() - begun, swing
