"""Periodic motion the slow way: Newton's equations integrated in time from stage to stage, closed by shooting.

Nothing of the package takes part: matrices, forces and loads are written out here, and the integrator is SciPy's.
Written from the equations of motion M θ'' + C θ' + K θ + Wᵀ f(W θ) = Re Σ_h u_h exp(i h Ω t).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq, root

RPM = np.pi / 30.0
Dense = Callable[[float], np.ndarray]


@dataclass(frozen=True)
class Stages:
    """A piecewise-linear torque through the origin: slopes [Nm/rad], and the angles [rad] where one ends.

    >>> law = Stages((-0.08, 0.08), (25e3, 10e3, 25e3))
    >>> law.torque(0.1, law.stage(0.1)), law.torque(-0.1, law.stage(-0.1))
    (1300.0, -1300.0)
    """

    edges: tuple[float, ...]
    slopes: tuple[float, ...]

    def stage(self, x: float) -> int:
        return int(np.searchsorted(self.edges, x))

    def bounds(self, stage: int) -> tuple[float, float]:
        return (-np.inf, *self.edges, np.inf)[stage], (-np.inf, *self.edges, np.inf)[stage + 1]

    def slope(self, x: float, stage: int) -> float:
        return self.slopes[stage]

    def torque(self, x: float, stage: int) -> float:
        """The line of the stage, also beyond its ends: an integrator must not see the kink."""
        first = self.stage(0.0)
        low, high = min(first, stage), max(first, stage)
        steps = sum((self.slopes[i] - self.slopes[i + 1]) * self.edges[i] for i in range(low, high))
        return self.slopes[stage] * x + (steps if stage > first else -steps)

    def along(self, x: np.ndarray) -> np.ndarray:
        """Torques of many angles."""
        at = np.searchsorted(self.edges, x)
        return np.choose(at, [self.torque(x, stage) for stage in range(len(self.slopes))])

    def slopes_along(self, x: np.ndarray) -> np.ndarray:
        """Slopes at many angles."""
        return np.asarray(self.slopes)[np.searchsorted(self.edges, x)]


@dataclass(frozen=True)
class Cubic:
    """The torque γ x³ of a Duffing oscillator beside its linear spring; one stage."""

    gamma: float

    def stage(self, x: float) -> int:
        return 0

    def bounds(self, stage: int) -> tuple[float, float]:
        return -np.inf, np.inf

    def slope(self, x: float, stage: int) -> float:
        return 3 * self.gamma * x * x

    def torque(self, x: float, stage: int) -> float:
        return self.gamma * x**3

    def along(self, x: np.ndarray) -> np.ndarray:
        """Torques of many angles."""
        return self.gamma * x**3

    def slopes_along(self, x: np.ndarray) -> np.ndarray:
        """Slopes at many angles."""
        return 3 * self.gamma * x**2


@dataclass(frozen=True)
class Case:
    """M, C, K (node, node) without the laws; ``weights`` (law, node); complex ``loads`` (node) by harmonic.

    The loads' base frequency is ``order`` times the speed; harmonic 0 is the mean.
    """

    M: np.ndarray
    C: np.ndarray
    K: np.ndarray
    weights: np.ndarray
    laws: tuple[Stages | Cubic, ...]
    loads: Mapping[int, np.ndarray]
    order: float = 1.0

    @property
    def nodes(self) -> int:
        return len(self.M)

    def relative(self, state: np.ndarray) -> np.ndarray:
        """Relative angles (law) of a state (angles, then rates)."""
        return self.weights @ state[: self.nodes]

    def linear(self) -> tuple[np.ndarray, np.ndarray]:
        """A and B of z' = A z + B (load − Wᵀ f) for z = (angles, rates)."""
        n, inverse = self.nodes, np.linalg.inv(self.M)
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ self.K, -inverse @ self.C]])
        return A, np.vstack([np.zeros((n, n)), inverse])


# --- the cases ---


def dmf12(damping: float = 15.0, mean: float = 1000.0, third: float = 2500.0) -> Case:
    """A truck's driveline of twelve bodies with a two-stage dual mass flywheel, excited in the third order."""
    inertia = np.array([0.05, *[0.1] * 6, 1.5, 0.8, 0.3, 0.5, 400.0])
    stiffness = np.array([*[2e6] * 7, 0.0, 8e4, 3e4, 6e3])
    damper = np.array([*[5.0] * 7, damping, 10.0, 5.0, 10.0])
    difference = np.diff(np.eye(12), axis=0)
    K = difference.T @ np.diag(stiffness) @ difference
    K[11, 11] += 1000.0
    throws = np.isin(np.arange(12), range(1, 7)) / 6.0
    law = Stages((-0.08, 0.08), (25e3, 10e3, 25e3))
    C = difference.T @ np.diag(damper) @ difference
    return Case(np.diag(inertia), C, K, -difference[7:8], (law,), {0: mean * throws, 1: third * throws}, 3.0)


def _oscillator(damping: float, stiffness: float, law: Stages | Cubic, loads: Mapping[int, float]) -> Case:
    one = np.eye(1)
    return Case(one, damping * one, stiffness * one, one, (law,), {h: np.array([u]) for h, u in loads.items()})


def two_stage(mean: float, amplitude: float) -> Case:
    """x'' + 0.04 x' + f(x) = T_m + T_a cos Ωt, f = x up to 1, then 1 + 2 (x − 1)."""
    return _oscillator(0.04, 0.0, Stages((1.0,), (1.0, 2.0)), {0: mean, 1: amplitude})


def duffing_nlvib() -> Case:
    """x'' + 0.05 x' + x + 0.1 x³ = 0.18 cos Ωt, example 01 of NLvib."""
    return _oscillator(0.05, 1.0, Cubic(0.1), {1: 0.18})


def duffing_skhippr() -> Case:
    """x'' + 0.16 x' + x + 2 x³ = 0.5 cos ωt, the example of SKHiPPR."""
    return _oscillator(0.16, 1.0, Cubic(2.0), {1: 0.5})


def one_stop() -> Case:
    """M 1, K 40, C 0.1 √40, F 100 cos: a one-sided stop of 1000 behind a gap of 10."""
    return _oscillator(0.1 * np.sqrt(40.0), 40.0, Stages((10.0,), (0.0, 1000.0)), {1: 100.0})


def nlvib03() -> Case:
    """Two masses, the first before a one-sided spring of 100 at a gap of 1, the second excited; NLvib example 03."""
    K = np.array([[1.0, -1.0], [-1.0, 2.0]])
    law = Stages((1.0,), (0.0, 100.0))
    return Case(np.eye(2), 0.03 * K, K, np.array([[1.0, 0.0]]), (law,), {1: np.array([0.0, 0.1])})


# --- motion in time ---


@dataclass(frozen=True)
class _Flight:
    """Integration between kinks: the stages are held, and a crossing is where the next flight starts."""

    case: Case
    frequency: float
    tolerance: float
    max_step: float

    def field(self, stages: tuple[int, ...], columns: int) -> Callable[[float, np.ndarray], np.ndarray]:
        """z' for a state and ``columns`` tangent vectors beside it."""
        case, (A, B), W = self.case, self.case.linear(), self.case.weights
        harmonics, loads = np.array(list(case.loads)), np.array(list(case.loads.values()))
        reaction, push, turn = B @ W.T, loads @ B.T, 1j * self.frequency * harmonics
        # laws of straight stages make one constant matrix; only a curved law is evaluated anew
        fixed = all(isinstance(law, Stages) for law in case.laws)
        wide = np.hstack([W, np.zeros_like(W)])

        def torques(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            parts = [(law.torque(v, s), law.slope(v, s)) for law, v, s in zip(case.laws, x, stages, strict=True)]
            return tuple(np.array(column) for column in zip(*parts, strict=True))

        offset, slope = torques(np.zeros(len(W)))
        rigid, constant = A - reaction @ (slope[:, None] * wide), reaction @ offset

        def derivative(t: float, flat: np.ndarray) -> np.ndarray:
            z = flat.reshape(-1, 1 + columns)
            load = (np.exp(turn * t) @ push).real
            if fixed:
                out = rigid @ z
                out[:, 0] += load - constant
                return out.ravel()
            x = wide @ z[:, 0]
            torque, slope = torques(x)
            out = (A - reaction @ (slope[:, None] * wide)) @ z
            out[:, 0] += load - reaction @ (torque - slope * x)
            return out.ravel()

        return derivative

    def solver(self, stages: tuple[int, ...], start: float, z: np.ndarray, end: float) -> DOP853:
        run = self.field(stages, z.shape[1] - 1)
        return DOP853(
            run, start, z.ravel(), end, max_step=self.max_step, rtol=self.tolerance, atol=0.1 * self.tolerance
        )

    def crossing(
        self, stages: tuple[int, ...], dense: Dense, low: float, high: float, columns: int
    ) -> tuple[float, int, int] | None:
        """The first way out of the stages within a step: when, which law, and into which stage."""
        times = np.linspace(low, high, 9)
        states = np.array([dense(t).reshape(-1, 1 + columns)[:, 0] for t in times])
        found = []
        for number, (law, stage) in enumerate(zip(self.case.laws, stages, strict=True)):
            row = self.case.weights[number]
            for side, edge in zip((-1, 1), law.bounds(stage), strict=True):
                beyond = side * (states[:, : self.case.nodes] @ row - edge)
                out = np.flatnonzero(beyond[1:] > 0.0)
                if out.size:
                    found.append((self._when(dense, row, edge, times[out[0]], times[out[0] + 1]), number, stage + side))
        return min(found, default=None)

    def near(self, stages: tuple[int, ...], ends: np.ndarray, step: float) -> bool:
        """Whether a step with these states (end, angles and rates) could have left a stage: no other is looked into."""
        x, v = ends[:, : self.case.nodes] @ self.case.weights.T, ends[:, self.case.nodes :] @ self.case.weights.T
        reach = 2 * step * np.abs(v).max(axis=0)
        low, high = np.array([law.bounds(s) for law, s in zip(self.case.laws, stages, strict=True)]).T
        return bool(((x.max(axis=0) + reach > high) | (x.min(axis=0) - reach < low)).any())

    def _when(self, dense: Dense, row: np.ndarray, edge: float, low: float, high: float) -> float:
        width = dense(low).size // (2 * self.case.nodes)

        def gap(t: float) -> float:
            return float(row @ dense(t).reshape(-1, width)[: self.case.nodes, 0] - edge)

        if gap(low) * gap(high) > 0.0:
            raise RuntimeError("a stage is touched without being entered: shift the speed a little")
        return float(brentq(gap, low, high, xtol=1e-15 * (1.0 + abs(high)), rtol=1e-14))


def flow(
    case: Case,
    speed: float,
    start: np.ndarray,
    duration: float,
    *,
    columns: np.ndarray | None = None,
    samples: int = 0,
    tolerance: float = 1e-12,
) -> tuple[np.ndarray, np.ndarray]:
    """State (2 node) after ``duration`` [s] from time zero, tangent ``columns`` beside it; and equidistant samples.

    The step in which a stage ends is taken again, to the crossing only; there the force is continuous, so tangent
    vectors pass unchanged.
    """
    z = np.asarray(start, dtype=float)[:, None]
    z = z if columns is None else np.hstack([z, columns])
    flight = _Flight(case, case.order * speed, tolerance, duration / 64.0)
    stages = tuple(law.stage(x) for law, x in zip(case.laws, case.relative(z[:, 0]), strict=True))
    times, kept, width = np.arange(samples) * duration / max(samples, 1), np.empty((samples, len(z))), z.shape[1]
    solver = flight.solver(stages, 0.0, z, duration)
    switch: tuple[int, int] | None = None
    while True:
        before = solver.y.copy()
        if message := solver.step():
            raise RuntimeError(message)
        found = None
        ends = np.array([before, solver.y]).reshape(2, *z.shape)[..., 0]
        if switch is None and flight.near(stages, ends, solver.step_size):
            found = flight.crossing(stages, solver.dense_output(), solver.t_old, solver.t, width - 1)
        if found is not None:  # again from where the step began, and no further than the crossing
            switch = found[1:]
            solver = flight.solver(stages, solver.t_old, before.reshape(z.shape), found[0])
            continue
        inside = (times >= solver.t_old) & (times <= solver.t)
        if inside.any():
            kept[inside] = solver.dense_output()(times[inside]).reshape(len(z), width, -1)[:, 0].T
        if solver.status != "finished":
            continue
        if switch is None:
            return solver.y.reshape(z.shape), kept
        number, stage = switch
        stages, switch = (*stages[:number], stage, *stages[number + 1 :]), None
        solver = flight.solver(stages, solver.t, solver.y.reshape(z.shape), duration)


# --- periodic motion ---


@dataclass(frozen=True)
class Steady:
    """A periodic motion: complex 0-peak harmonics (harmonic, node) and (harmonic, law), harmonic 0 the mean.

    ``orders`` are in multiples of the speed, a half base order apart where the period is doubled.
    """

    case: Case
    speed: float
    sub: int
    state: np.ndarray
    orders: np.ndarray
    angle: np.ndarray
    monodromy: np.ndarray

    @property
    def period(self) -> float:
        return 2 * np.pi * self.sub / (self.case.order * self.speed)

    @property
    def twist(self) -> np.ndarray:
        """Harmonics (harmonic, law) of the relative angles [rad]."""
        return self.angle @ self.case.weights.T

    def at(self, order: float) -> complex:
        """One order of the first law's relative angle."""
        return complex(self.twist[int(np.argmin(abs(self.orders - order))), 0])

    @property
    def multipliers(self) -> np.ndarray:
        """Floquet multipliers by the variational equations, largest first."""
        return _sorted(np.linalg.eigvals(self.monodromy))


def time_steady(
    case: Case,
    speed: float,
    start: np.ndarray | None = None,
    *,
    periods: int = 0,
    sub: int = 1,
    harmonics: int = 40,
) -> Steady:
    """The motion of ``sub`` periods of the load that closes on itself, by Newton on the stroboscopic map.

    ``start`` is a state (angles, then rates) near it (default: the linear response), left to settle for ``periods``.
    With ``sub`` 2 and no start, the motion is sought beside the one of one period, along its flip direction.
    """
    if sub == 2 and start is None:
        return _doubled(case, speed, harmonics)
    period = 2 * np.pi / (case.order * speed)
    z = linear_state(case, speed) if start is None else np.asarray(start, dtype=float)
    for _ in range(periods):
        z = flow(case, speed, z, period, tolerance=1e-9)[0][:, 0]
    return _closed(case, speed, z, sub, harmonics)


def _closed(case: Case, speed: float, z: np.ndarray, sub: int, harmonics: int) -> Steady:
    duration = 2 * np.pi * sub / (case.order * speed)
    eye, tolerance = np.eye(z.size), 1e-6
    for _ in range(30):
        end, _ = flow(case, speed, z, duration, columns=eye, tolerance=tolerance)
        step = np.linalg.solve(end[:, 1:] - eye, z - end[:, 0])
        z, share = z + step, np.abs(step).max() / np.abs(z).max()
        if share < 1e-10 and tolerance == 1e-12:
            return _described(case, speed, z, sub, harmonics, end[:, 1:])
        if share < 1e-3:  # near: from here every figure counts
            tolerance = 1e-12
    raise RuntimeError(f"no periodic motion found in 30 steps; the last was {np.abs(step).max():.1e}")


def _described(
    case: Case, speed: float, z: np.ndarray, sub: int, harmonics: int, monodromy: np.ndarray | None = None
) -> Steady:
    duration, count = 2 * np.pi * sub / (case.order * speed), 4096 * sub
    if monodromy is None:
        monodromy = flow(case, speed, z, duration, columns=np.eye(z.size))[0][:, 1:]
    spectrum = np.fft.rfft(flow(case, speed, z, duration, samples=count)[1][:, : case.nodes], axis=0)
    spectrum = spectrum[: harmonics + 1] * 2 / count
    spectrum[0] /= 2
    return Steady(case, speed, sub, z, np.arange(harmonics + 1) * case.order / sub, spectrum, monodromy)


def _doubled(case: Case, speed: float, harmonics: int) -> Steady:
    """Started along the eigenvector of the multiplier below −1, shorter and longer."""
    single = time_steady(case, speed, harmonics=1)
    values, vectors = np.linalg.eig(single.monodromy)
    flip = vectors[:, np.argmin(values.real)].real
    flip /= np.abs(case.relative(flip)).max()
    reach = np.abs(single.twist[1]).max()
    for share in (0.5, 1.0, 0.25, 1.5, 2.0, 0.1, 3.0):
        try:
            found = _closed(case, speed, single.state + share * reach * flip, 2, harmonics)
        except (RuntimeError, np.linalg.LinAlgError):
            continue
        if abs(found.at(0.5 * case.order)) > 1e-4 * reach:
            return found
    raise RuntimeError("no motion of two periods found beside the one of one period")


def linear_state(case: Case, speed: float) -> np.ndarray:
    """State at time zero of the linear response, with each law's slope at its static angle."""
    static = np.zeros(case.nodes)
    for _ in range(50):
        x = case.weights @ static
        stages = [law.stage(v) for law, v in zip(case.laws, x, strict=True)]
        torque = [law.torque(v, s) for law, v, s in zip(case.laws, x, stages, strict=True)]
        slope = [law.slope(v, s) for law, v, s in zip(case.laws, x, stages, strict=True)]
        K = case.K + case.weights.T @ np.diag(slope) @ case.weights
        mean = case.loads.get(0, np.zeros(case.nodes)).real
        static = static + np.linalg.solve(K, mean - case.K @ static - case.weights.T @ np.array(torque))
    state = np.concatenate([static, np.zeros(case.nodes)])
    for h, load in case.loads.items():
        if h:
            omega = h * case.order * speed
            theta = np.linalg.solve(K + 1j * omega * case.C - omega**2 * case.M, load.astype(complex))
            state += np.concatenate([theta, 1j * omega * theta]).real
    return state


def state_from_orders(orders: np.ndarray, angle: np.ndarray, speed: float) -> np.ndarray:
    """State at time zero of harmonics (order, node) found elsewhere: a start for `time_steady`."""
    rates = 1j * np.asarray(orders)[:, None] * speed * angle
    return np.concatenate([angle.sum(axis=0), rates.sum(axis=0)]).real


def difference_multipliers(steady: Steady, step: float = 1e-5) -> np.ndarray:
    """Floquet multipliers by central differences of the flow over the period, largest first; no tangent takes part."""
    size = np.abs(steady.angle[1:] @ steady.case.weights.T).max() * step
    rate = size * steady.case.order * steady.speed
    scale = np.concatenate([np.full(steady.case.nodes, size), np.full(steady.case.nodes, rate)])
    columns = [
        (_end(steady, steady.state + d) - _end(steady, steady.state - d)) / (2 * d.sum()) for d in np.diag(scale)
    ]
    return _sorted(np.linalg.eigvals(np.array(columns).T))


def _end(steady: Steady, start: np.ndarray) -> np.ndarray:
    return flow(steady.case, steady.speed, start, steady.period)[0][:, 0]


def _sorted(values: np.ndarray) -> np.ndarray:
    return values[np.argsort(-np.abs(values), kind="stable")]


def flip_speed(case: Case, low: float, high: float) -> float:
    """Speed [rad/s] between two where a multiplier of the motion of one period passes −1: its period doubles."""
    return float(brentq(lambda speed: time_steady(case, speed).multipliers.real.min() + 1.0, low, high, xtol=1e-9))


def fold(case: Case, speed: float, start: np.ndarray) -> Steady:
    """The turning point near a motion: it closes on itself and a multiplier is +1, all in one set of equations."""
    eye = np.eye(start.size)

    def gaps(unknown: np.ndarray) -> np.ndarray:
        z, at = unknown[:-1], float(unknown[-1])
        end, _ = flow(case, at, z, 2 * np.pi / (case.order * at), columns=eye)
        return np.append(end[:, 0] - z, np.linalg.det(end[:, 1:] - eye))

    found = root(gaps, np.append(start, speed), tol=1e-13, options={"eps": 1e-12})
    if np.abs(found.fun).max() > 1e-7:
        raise RuntimeError(f"no turning point found: {found.message}")
    return _described(case, float(found.x[-1]), found.x[:-1], 1, 40)
