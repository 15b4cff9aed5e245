"""Floquet multipliers along branches: from segment to segment between crossings of stages, or by sampled tangents."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from torsional.numerics.arrays import Array, ComplexArray, IntArray
from torsional.numerics.balance.forces import forces_along
from torsional.numerics.continuation.following import Point
from torsional.numerics.floquet.remembering import monodromy_remembering
from torsional.numerics.floquet.sampled import monodromy_sampled
from torsional.numerics.piecewise.basis import Coordinates, StageBases, coordinates
from torsional.numerics.piecewise.monodromy import multipliers, ordered
from torsional.numerics.piecewise.motion import PiecewiseMotion
from torsional.solvers.periodic.equations import Split
from torsional.solvers.periodic.problem import BoolArray, HarmonicProblem
from torsional.solvers.periodic.states import driving

SAMPLES = 512
"""Samples a period of laws that are not piecewise linear."""
TORUS = "Neimark–Sacker"
HALVINGS = 24
MARGIN = 1e-6
"""A multiplier counts as outside of the unit circle beyond this excess."""


Turning = tuple[float, float]
"""Mean speed and frequency of the base order [rad/s], where the linear part depends on them; else zeros."""


def turning(split: Split, speed: float, pace: float) -> Turning:
    """What the linear part depends on: centrifugal stiffness on the speed, hysteretic damping on the frequency."""
    varies = bool(split.matrices[3].any() or split.matrices[4].any())
    return (speed, pace) if varies else (0.0, 0.0)


def _damping_and_stiffness(split: Split, at: Turning) -> tuple[Array, Array]:
    """C and K without the references; hysteretic damping as the viscous one of equal loss at the base frequency."""
    s = split.system.switched(split.speed)
    speed, pace = at
    return s.C + (s.H / pace if pace else 0.0), s.K + speed**2 * s.S


@lru_cache(maxsize=256)
def stage_bases(split: Split, at: Turning = (0.0, 0.0)) -> StageBases:
    """The linear systems between the hinges, made once for all branches of a system whose laws are all straight."""
    damping, stiffness = _damping_and_stiffness(split, at)
    laws = [rows.packed for law in split.laws if (rows := law.straight) is not None]
    return StageBases(split.matrices[0], damping, stiffness, split.weights, laws, split.rigid_turning)


def _motion_at(harmonics: ComplexArray, tau: Array) -> Array:
    """Angles (m, times) of harmonics (m, H + 1) at τ."""
    turns = np.exp(1j * np.multiply.outer(np.arange(harmonics.shape[1]), tau))
    return np.asarray((harmonics @ turns).real)


def _crossings_along(problem: HarmonicProblem, points: Array) -> tuple[list[Array], list[IntArray]]:
    """Angles τ of the crossings of each scaled point, ascending, and the stages (crossings, m) that follow them."""
    m, count = problem.connections, problem.harmonics
    forces = np.empty((len(points), m, count + 1), dtype=complex)
    found, number = np.empty((len(points), m, 4 * count + 16, 3)), np.empty((len(points), m))
    forces_along(problem.balance, points, forces, found, number)
    harmonics = problem.harmonics_of(points)
    edges = [law.edges for law in problem.setting.split.laws]
    times: list[Array] = []
    stages: list[IntArray] = []
    for i in range(len(points)):
        at = np.unique(np.concatenate([found[i, e, : int(number[i, e]), 0] for e in range(m)]))
        middles = at + 0.5 * np.diff(at, append=at[0] + 2 * np.pi) if at.size else np.zeros(1)
        angles = _motion_at(harmonics[i], middles)
        times.append(at)
        stages.append(np.stack([np.searchsorted(edge, own) for edge, own in zip(edges, angles, strict=True)], axis=1))
    return times, stages


def branch_multipliers(problem: HarmonicProblem, points: Array) -> ComplexArray:
    """Floquet multipliers (points, states) over the period of the problem's base order, by falling modulus."""
    return np.concatenate([_multipliers(piece, points[run]) for run, piece in problem.pieces(points)])


def _multipliers(problem: HarmonicProblem, points: Array) -> ComplexArray:
    value = points[:, -1] * problem.scale[-1]
    speed = value if problem.setting.speed is None else np.full(len(points), problem.setting.speed)
    pace = problem.base_order * speed
    if not problem.setting.split.straight:
        found = [_sampled(problem, z, float(p)) for z, p in zip(points, pace, strict=True)]
        return ordered(np.linalg.eigvals(np.array(found)))
    times, stages = _crossings_along(problem, points)
    split = problem.setting.split
    at = [turning(split, float(v), float(p)) for v, p in zip(speed, pace, strict=True)]
    times = [t / p for t, p in zip(times, pace, strict=True)]
    if len(set(at)) == 1:
        return multipliers(stage_bases(split, at[0]), times, stages, 2 * np.pi / pace)
    each = zip(at, times, stages, pace, strict=True)
    return np.concatenate([multipliers(stage_bases(split, a), [t], [s], [2 * np.pi / p]) for a, t, s, p in each])


def exact_motion(problem: HarmonicProblem, z: Array) -> PiecewiseMotion:
    """The motion in time, in periods of the base order, at the parameter of a scaled point; all laws being hinges."""
    value = float(z[-1] * problem.scale[-1])
    setting = problem.frozen(value).setting
    speed = value if setting.speed is None else setting.speed
    loads = driving(problem, np.array([value]))[0]
    pace = problem.base_order * speed
    return PiecewiseMotion(stage_bases(setting.split, turning(setting.split, speed, pace)), loads, pace)


@lru_cache(maxsize=256)
def _linear(split: Split, damped: bool, at: Turning) -> Coordinates:
    """Coordinates of the linear part with the reference springs in it, and the reference dampers if ``damped``."""
    damping, stiffness = _damping_and_stiffness(split, at)
    w = split.weights
    drag = split.reference_damping if damped else np.zeros(len(w))
    held = stiffness + (w.T * split.reference_stiffness) @ w
    return coordinates(split.matrices[0], damping + (w.T * drag) @ w, held, w, split.rigid_turning)


def _sampled(problem: HarmonicProblem, z: Array, pace: float) -> Array:
    """Monodromy matrix of one point where some law is smooth or remembers."""
    split = problem.setting.split
    at = turning(split, pace / problem.base_order, pace)
    harmonics = problem.harmonics_of(z)
    tau = 2 * np.pi * np.arange(SAMPLES) / SAMPLES
    angles = _motion_at(harmonics, tau)
    rates = _motion_at(1j * pace * np.arange(harmonics.shape[1]) * harmonics, tau)
    reference = np.stack([split.reference_stiffness, split.reference_damping], axis=1)
    if any(law.remembers for law in split.laws):
        laws = [(law.address, law.packed) for law in split.laws]
        remembers = np.array([int(law.remembers) for law in split.laws])
        return monodromy_remembering(
            _linear(split, False, at), laws, remembers, split.reference_stiffness, angles, rates, 2 * np.pi / pace
        )
    told = [law.evaluate(a, r) for law, a, r in zip(split.laws, angles, rates, strict=True)]
    stiffness = np.stack([t[1] for t in told], axis=1) - reference[:, 0]
    damping = np.stack([t[2] for t in told], axis=1) - reference[:, 1]
    return monodromy_sampled(_linear(split, True, at), stiffness, damping, 2 * np.pi / pace).matrix


def with_hidden_events(
    problem: HarmonicProblem, points: tuple[Point, ...], found: ComplexArray, confirmed: BoolArray
) -> tuple[Point, ...]:
    """The points with those bifurcations between them that only the multipliers show.

    A complex pair that leaves the unit circle is a Neimark–Sacker bifurcation; a real multiplier that passes −1 where
    no determinant is watched, as with laws that remember, a period doubling.
    """
    watched = problem.tests
    counts = {name: measure(found) for name, measure in HIDDEN.items() if name not in watched}
    events = np.array([bool(point.event) for point in points])
    quiet = ~(events[:-1] | events[1:]) & confirmed[:-1] & confirmed[1:]
    out = [points[0]]
    for i, end in enumerate(points[1:]):
        for name, count in counts.items():
            if quiet[i] and count[i] != count[i + 1]:
                out.append(_located(problem, points[i], end, name, HIDDEN[name]))
        out.append(end)
    return tuple(out)


def _pairs_outside(values: ComplexArray) -> IntArray:
    """How many complex pairs (…) of multipliers (…, states) lie outside of the unit circle."""
    return np.asarray(np.count_nonzero((np.abs(values) > 1 + MARGIN) & (values.imag > 1e-3), axis=-1))


def _beyond_minus_one(values: ComplexArray) -> IntArray:
    """How many real multipliers are below −1."""
    return np.asarray(np.count_nonzero((values.real < -1 - MARGIN) & (np.abs(values.imag) < 1e-9), axis=-1))


HIDDEN: dict[str, Callable[[ComplexArray], IntArray]] = {"period doubling": _beyond_minus_one, TORUS: _pairs_outside}


def _located(
    problem: HarmonicProblem, start: Point, end: Point, name: str, measure: Callable[[ComplexArray], IntArray]
) -> Point:
    """The place between two points where the measure changes, by halving."""
    low, high, was = start, end, measure(branch_multipliers(problem, start.z[None])[0])
    for _ in range(HALVINGS):
        way = high.z - low.z
        found = problem.correct(low.z + 0.5 * way, way / np.linalg.norm(way))
        if not found.converged:
            break
        middle = low._replace(
            z=found.z,
            tangent=found.tangent,
            values=found.values,
            parameter=float(found.z[-1] * problem.scale[-1]),
            arclength=0.5 * (low.arclength + high.arclength),
            iterations=found.iterations,
            residual=found.residual,
        )
        if measure(branch_multipliers(problem, found.z[None])[0]) == was:
            low = middle
        else:
            high = middle
    return high._replace(event=name, within=float(np.linalg.norm(high.z - low.z)))
