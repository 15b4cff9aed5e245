"""Exact motion in time of M q̈ + C q̇ + K q + Σ_e w_e f_e(w_e · q) = u(t) with piecewise-linear f_e and harmonic loads.

    u(t) = u_0 + Re Σ_h u_h exp(ihωt), and one more constant load between two times

Every stage is linear and is solved without a step error; its end, where a connection's angle passes a hinge, is found
to rounding.  The reference for harmonic balance, and the start of branches that hang on no other.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray, IntArray
from torsional.numerics.piecewise.basis import StageBases
from torsional.numerics.piecewise.march import Tables, equations, march, new_tables
from torsional.numerics.piecewise.monodromy import monodromy
from torsional.numerics.piecewise.series import Motion, Record

SAMPLES = 256  # a period of the base frequency
SAMPLES_OF_HIGHEST = 16  # a period of the highest harmonic that counts
COUNTS = 1e-3  # share of the largest load from which a harmonic counts
WINDOW = 8  # repetitions over which the decay toward a steady state is measured
AT_REST = 1e-13  # of a state's entries: no more than rounding
NEUTRAL = 1e-9  # multipliers this little beyond one count as stable: undamped modes

Pulse = tuple[float, float, ArrayLike]


class Trajectory(NamedTuple):
    """Samples (…,) of ``times`` [s], ``angles`` and ``rates`` (…, N), the last state and the number of crossings."""

    times: Array
    angles: Array
    rates: Array
    state: Array
    crossings: int


class Flow(NamedTuple):
    """The state after some periods, and the way there: ``stages`` (s, m) from ``times`` (s,) [s] on, the first zero."""

    state: Array
    times: Array
    stages: IntArray


class Steady(NamedTuple):
    """A ``state`` of t = 0 that, if ``converged``, repeats after ``subharmonic`` periods; it took ``periods``."""

    state: Array
    converged: bool
    periods: int
    subharmonic: int


class Closed(NamedTuple):
    """A periodic motion by Newton's method: its state of t = 0, whether it closes, and its monodromy matrix."""

    state: Array
    converged: bool
    monodromy: Array


@dataclass(frozen=True)
class PiecewiseMotion:
    """Motion of ``bases`` under ``loads`` (harmonics + 1, N), complex 0-peak [Nm], of ``base_frequency`` ω [rad/s].

    States z are those of ``bases.coordinates`` (its ``state``, ``angles`` and ``rates`` convert); None is rest at zero.
    Rigid modes have no part in them, but for speeds that dampers act on.  Crossings are looked for on a grid of
    ``samples_per_period`` of ω, default 256 and at least 16 a period of the highest harmonic that counts, and where an
    angle turned in between.  Raises ModelError for loads of the wrong shape.

    One-sided oscillator x″ + 0.1 x′ + x + 8 max(x, 0) = cos 2t:

    >>> bases = StageBases([[1.0]], [[0.1]], [[1.0]], [[1.0]], [[0.0, 0.0, 1.0, 8.0]])
    >>> motion = PiecewiseMotion(bases, [[0.0], [1.0]], 2.0)
    >>> end = motion.run(periods=150).state
    >>> bases.coordinates.angles(end).round(10), bases.coordinates.rates(end).round(10)
    (array([-0.86119488]), array([0.10004788]))
    """

    bases: StageBases
    loads: ArrayLike
    base_frequency: float
    samples_per_period: int = 0
    _motion: Motion = field(init=False, repr=False)
    _tables: dict[int, Tables] = field(init=False, repr=False, default_factory=dict)

    def __post_init__(self) -> None:
        loads = np.atleast_2d(np.asarray(self.loads, dtype=complex))
        if loads.shape[1] != len(self.bases.coordinates.shapes) or not np.isfinite(loads).all():
            raise ModelError("loads need finite values (harmonics + 1, coordinates)", found=str(loads.shape))
        if not 0.0 < self.base_frequency < np.inf:
            raise ModelError("the base frequency must be positive", found=f"{self.base_frequency:g} rad/s")
        moved = np.asarray(self.bases.coordinates.acceleration(loads), dtype=complex)
        size = np.abs(moved).max(axis=1)
        orders = np.flatnonzero(size[1:]) + 1
        counting = np.flatnonzero(size > COUNTS * size[1:].max(initial=0.0))
        samples = max(SAMPLES, SAMPLES_OF_HIGHEST * int(counting.max(initial=0)))
        object.__setattr__(self, "samples_per_period", self.samples_per_period or samples)
        object.__setattr__(self, "_motion", equations(self.bases, moved, orders, float(self.base_frequency)))

    @property
    def period(self) -> float:
        """2π/ω [s]."""
        return 2.0 * np.pi / self.base_frequency

    def run(
        self,
        state: ArrayLike | None = None,
        periods: int = 1,
        *,
        samples_per_period: int = 0,
        pulse: Pulse | None = None,
    ) -> Trajectory:
        """Motion over whole periods from a state at t = 0, sampled evenly, the end left out.

        ``pulse``: (begin [s], end [s], load (N,) [Nm]) of one more constant load.
        """
        samples = samples_per_period or self.samples_per_period
        z, stage = self._start(state)
        kept = np.empty((samples * periods, z.size))
        crossings = self._march(z, stage, periods, samples, pulse, kept=kept)[0]
        times: Array = np.linspace(0.0, periods * self.period, len(kept), endpoint=False)
        return Trajectory(times, *self._seen(kept), z, crossings)

    def flow(self, state: ArrayLike | None = None, periods: int = 1, *, pulse: Pulse | None = None) -> Flow:
        """State after whole periods, and the crossings of stages on the way."""
        places = 64 * periods
        while True:
            z, stage = self._start(state)
            first = stage.copy()
            count, times, stages = self._march(z, stage, periods, self.samples_per_period, pulse, places=places)
            if count <= places:
                return Flow(z, np.append(0.0, times[:count]), np.vstack([first, stages[:count]]))
            places = count

    def steady(
        self,
        state: ArrayLike | None = None,
        most_periods: int = 2000,
        tolerance: float = 1e-9,
        longest: int = 3,
        *,
        newton: bool = False,
    ) -> Steady:
        """Follow the motion until it repeats after 1, 2, … ``longest`` periods of the load.

        It has when what is left to go, d r/(1 − r) of a difference d that shrinks by r each time, is within
        ``tolerance`` of the largest state met.  With ``newton`` the motion is closed by Newton's method after 16, 32,
        64, … periods if that leads to a stable one: quick where little is damped, but maybe not the one it tends to.
        """
        z, stage = self._start(state)
        strobes, scale = np.empty((most_periods + 1, z.size)), float(np.abs(z).max())
        strobes[0] = z
        for n in range(1, most_periods + 1):
            self._march(z, stage, 1, self.samples_per_period, None)
            strobes[n], scale = z, max(scale, float(np.abs(z).max()))
            for repeat in range(1, longest + 1):
                if _left(strobes[: n + 1], repeat) <= tolerance * scale:
                    return Steady(z, True, n, _shortest(strobes[: n + 1], repeat, 10.0 * tolerance * scale))
            closed = self._stable(z, longest) if newton and n >= 16 and n & (n - 1) == 0 else None
            if closed is not None:
                return Steady(closed[0], True, n, closed[1])
        return Steady(z, False, most_periods, 0)

    def _stable(self, z: Array, longest: int) -> tuple[Array, int] | None:
        """The first stable motion of 1, 2, … periods that Newton's method finds from a state, and its periods."""
        for repeat in range(1, longest + 1):
            closed = self.shoot(z, repeat)
            if closed.converged and np.abs(np.linalg.eigvals(closed.monodromy)).max() < 1.0 + NEUTRAL:
                return closed.state, repeat
        return None

    def shoot(self, state: ArrayLike | None = None, periods: int = 1, tolerance: float = 1e-12) -> Closed:
        """The periodic motion near a state, stable or not, that closes after ``periods`` of the load.

        Newton's method on z(T) − z(0), with the exact monodromy matrix; ``tolerance`` of the largest entry of z.
        """
        z = self._start(state)[0]
        growth, one, converged = np.eye(z.size), np.eye(z.size), False
        for _ in range(40):
            way = self.flow(z, periods)
            growth = monodromy(self.bases, way.times, way.stages, periods * self.period)
            miss = way.state - z
            converged = bool(np.abs(miss).max() <= tolerance * np.abs(z).max())
            if converged:
                break
            try:
                z = z + np.linalg.solve(one - growth, miss)
            except np.linalg.LinAlgError:
                break
        return Closed(z, converged, growth)

    def harmonics(self, state: ArrayLike, count: int, periods: int = 1) -> ComplexArray:
        """Complex 0-peak harmonics (count + 1, m) of the connections' angles [rad] from a state of t = 0.

        Harmonic h turns h/``periods`` times a period of the load, x(t) = x_0 + Re Σ X_h exp(ihωt/periods).  By Fourier
        sums of samples, whose error falls with their fourth power since the angles' second derivative has no jumps.
        """
        samples = max(1024, self.samples_per_period, 8 * count)
        z, stage = self._start(state)
        kept = np.empty((samples * periods, z.size))
        self._march(z, stage, periods, samples, None, kept=kept)
        angles = kept @ self.bases.coordinates.angle_rows.T
        spectrum = np.fft.rfft(angles, axis=0)[: count + 1] * (2.0 / len(angles))
        spectrum[0] *= 0.5
        return np.asarray(spectrum)

    def _start(self, state: ArrayLike | None) -> tuple[Array, IntArray]:
        coordinates = self.bases.coordinates
        z = np.zeros(coordinates.size) if state is None else np.array(state, dtype=float)
        if z.shape != (coordinates.size,) or not np.isfinite(z).all():
            raise ModelError("a state needs finite entries", found=str(z.shape), allowed=f"({coordinates.size},)")
        return z, self.bases.stage(coordinates.angle_rows @ z)

    def _seen(self, states: Array) -> tuple[Array, Array]:
        coordinates = self.bases.coordinates
        return coordinates.angles(states), coordinates.rates(states)

    def _march(
        self,
        z: Array,
        stage: IntArray,
        periods: int,
        samples: int,
        pulse: Pulse | None,
        *,
        places: int = 0,
        kept: Array | None = None,
    ) -> tuple[int, Array, IntArray]:
        """Carry z and stages on in place; crossings met, and where the first ``places`` of them lie."""
        motion, window = self._motion, np.full(2, np.inf)
        tables = self._table(samples)
        if pulse is not None:
            begin, end, load = pulse
            elastic = motion.scale.size
            push = self.bases.coordinates.acceleration(np.asarray(load, dtype=float))[elastic:]
            motion, window = motion._replace(pulse=push), np.array([begin, end], dtype=float)
            tables = new_tables(motion, samples)
        record = Record(np.empty(places), np.empty((places, len(stage)), np.int64), _kept(kept, z.size))
        count = march(motion, tables, z, stage, periods, window, record)
        if count < 0:
            raise ModelError("the motion passes a hinge without end", remedy="look for a law of enormous stiffness")
        return count, record.times, record.stages

    def _table(self, samples: int) -> Tables:
        if samples not in self._tables:
            self._tables[samples] = new_tables(self._motion, samples)
        return self._tables[samples]


def _kept(states: Array | None, size: int) -> Array:
    return np.empty((0, size)) if states is None else states


def _left(strobes: Array, repeat: int) -> float:
    """What is left to go of a motion that repeats after so many periods, judged by how its differences shrink."""
    far = repeat * WINDOW
    if len(strobes) <= repeat + far:
        return np.inf
    now = float(np.abs(strobes[-1] - strobes[-1 - repeat]).max())
    before = float(np.abs(strobes[-1 - far] - strobes[-1 - far - repeat]).max())
    if now <= AT_REST * np.abs(strobes[-1]).max():
        return now
    ratio = (now / before) ** (1.0 / WINDOW) if before > 0.0 else 1.0
    return now * ratio / (1.0 - ratio) if ratio < 1.0 else np.inf


def _shortest(strobes: Array, repeat: int, close: float) -> int:
    """The smallest divisor of a number of periods after which the motion repeats as well."""
    for divisor in range(1, repeat):
        if repeat % divisor == 0 and np.abs(strobes[-1] - strobes[-1 - divisor]).max() <= close:
            return divisor
    return repeat
