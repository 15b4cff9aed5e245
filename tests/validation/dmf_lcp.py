"""DMF-LCP-1: a dual mass flywheel of two channels with seven shoes each between loose springs, as plain numbers.

A sine of order 3 on the primary flywheel, a constant load at the vehicle.  Every spring acts on one side alone:

    λ = max(0, −k (g + τ ġ)),   g = g0 + θ_plus − θ_minus,   +λ on plus, −λ on minus

Nothing of the package takes part but in `equations`, which says the same in the arrays that time stepping works on.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import chain, pairwise
from typing import TYPE_CHECKING, Any

import numba
import numpy as np

if TYPE_CHECKING:
    from torsional.numerics.motion.data import Equations, Rows

RPM = np.pi / 30.0
PRIMARY, SECONDARY, GEARBOX, VEHICLE, FIRST_SHOE = 0, 1, 2, 3, 4
SHOES, CHANNELS = 7, (1.0, 1.2)  # shoes a channel; how much wider a channel's gaps are
NODES = FIRST_SHOE + SHOES * len(CHANNELS)
END_SHOE, INNER_SHOE = 0.0030, 0.00384
INERTIA = np.array([1.8, 1.0, 0.3, 15.0, *[END_SHOE, *[INNER_SHOE] * 5, END_SHOE] * len(CHANNELS)])
CONTACT_TIME = 2e-5  # s, of every one-sided spring
ORDER, MEAN, SWING = 3.0, 100.0, 1500.0  # of the torque on the primary [Nm]; −MEAN at the vehicle
CLUTCH_STIFFNESS, CLUTCH_DAMPING = 20e3, 5.0

# first node, second node, Nm/rad, Nms/rad
LINEAR = [
    (SECONDARY, GEARBOX, CLUTCH_STIFFNESS, CLUTCH_DAMPING),
    (GEARBOX, VEHICLE, 3000.0, 5.0),
    *[(shoe, PRIMARY, 0.0, 0.3) for shoe in range(FIRST_SHOE, NODES)],
]

# what DOP853 finds with a relative tolerance of 1e-12: s; rad, rad, rad, Nm
REFERENCE = [
    (0.02, 0.102888428417, 0.107521044664, -0.045965971751, 69.989611),
    (0.05, 0.089523996342, 0.195566438356, -0.040448197679, 302.190250),
    (0.10, 0.108247805375, 0.217222337967, -0.051495101227, 229.086294),
]


def _one_sided() -> list[tuple[int, int, float, float]]:
    """Plus, minus, gap g0 [rad], stiffness [Nm/rad] of every one-sided spring."""
    springs = [(PRIMARY, SECONDARY, 0.75, 2e6), (SECONDARY, PRIMARY, 0.75, 2e6)]
    for channel, wide in enumerate(CHANNELS):
        shoes = range(FIRST_SHOE + channel * SHOES, FIRST_SHOE + (channel + 1) * SHOES)
        for before, shoe in pairwise(shoes):
            springs += [(shoe, before, 0.002 * wide, 10500.0), (shoe, before, 0.002 * wide + 0.10, 5e5)]
        for body, gap in ((PRIMARY, 0.002), (SECONDARY, 0.008)):
            springs += [(shoes[0], body, gap * wide, 1e6), (body, shoes[-1], gap * wide, 1e6)]
    return springs


PLUS, MINUS, GAP, SPRING_STIFFNESS = (np.array(column) for column in zip(*_one_sided(), strict=True))
FIRST, SECOND, STIFFNESS, DAMPING = (np.array(column) for column in zip(*LINEAR, strict=True))


@numba.njit(cache=True, error_model="numpy")
def fill_rates(t, y, out, drive):  # type: ignore[no-untyped-def]
    """ẏ into ``out`` of the state y: angles [rad], then their rates [rad/s]; ``drive`` is that of `Flywheel`."""
    angle, rate, torque = y[:NODES], y[NODES:], out[NODES:]
    speed_from, speed_to, span, mean = drive
    turned = speed_from * t + 0.5 * (speed_to - speed_from) * t * t / span
    torque[:] = 0.0
    torque[PRIMARY] = mean + SWING * np.sin(ORDER * turned)
    torque[VEHICLE] = -mean
    for e in range(FIRST.size):
        a, b = FIRST[e], SECOND[e]
        force = STIFFNESS[e] * (angle[a] - angle[b]) + DAMPING[e] * (rate[a] - rate[b])
        torque[a] -= force
        torque[b] += force
    for i in range(PLUS.size):
        a, b = PLUS[i], MINUS[i]
        g = GAP[i] + angle[a] - angle[b] + CONTACT_TIME * (rate[a] - rate[b])
        force = max(0.0, -SPRING_STIFFNESS[i] * g)
        torque[a] += force
        torque[b] -= force
    for i in range(NODES):
        out[i] = rate[i]
        torque[i] /= INERTIA[i]


@numba.njit(cache=True, error_model="numpy")
def fill_jacobian(y, out):  # type: ignore[no-untyped-def]
    """∂ẏ/∂y into ``out``."""
    angle, rate = y[:NODES], y[NODES:]
    out[:] = 0.0
    for i in range(NODES):
        out[i, NODES + i] = 1.0
    for e in range(FIRST.size):
        _couple(out, FIRST[e], SECOND[e], STIFFNESS[e], DAMPING[e])
    for i in range(PLUS.size):
        a, b = PLUS[i], MINUS[i]
        if GAP[i] + angle[a] - angle[b] + CONTACT_TIME * (rate[a] - rate[b]) < 0.0:
            _couple(out, a, b, SPRING_STIFFNESS[i], SPRING_STIFFNESS[i] * CONTACT_TIME)


@numba.njit(cache=True, error_model="numpy")
def _couple(out, a, b, stiffness, damping):  # type: ignore[no-untyped-def]
    for x, y in ((a, b), (b, a)):
        out[NODES + x, x] -= stiffness / INERTIA[x]
        out[NODES + x, y] += stiffness / INERTIA[x]
        out[NODES + x, NODES + x] -= damping / INERTIA[x]
        out[NODES + x, NODES + y] += damping / INERTIA[x]


@dataclass(frozen=True)
class Flywheel:
    """The flywheel on a run from one engine speed [rad/s] to another in ``span`` [s], under a mean torque [Nm].

    >>> flywheel = Flywheel()
    >>> flywheel.right_hand_side(0.0, np.zeros(2 * NODES))[[NODES, NODES + 3]]
    array([55.55555556, -6.66666667])
    """

    speed_from: float = 600 * RPM
    speed_to: float = 2000 * RPM
    span: float = 1.0
    mean: float = MEAN

    @cached_property
    def drive(self) -> tuple[float, float, float, float]:
        """The numbers that the torques follow from."""
        return float(self.speed_from), float(self.speed_to), float(self.span), float(self.mean)

    def right_hand_side(self, t: float, y: np.ndarray) -> np.ndarray:
        """ẏ of the state y."""
        out = np.empty(2 * NODES)
        fill_rates(t, y, out, self.drive)
        return out

    def jacobian(self, t: float, y: np.ndarray) -> np.ndarray:
        """∂ẏ/∂y of the state y."""
        out = np.empty((2 * NODES, 2 * NODES))
        fill_jacobian(y, out)
        return out

    def equations(self, pieces: int = 1024) -> Equations:
        """The same as arrays of time stepping; the sine is made of ``pieces`` cubics, (2π/pieces)⁴/384 off."""
        from torsional.numerics.motion.data import Equations, rows_of

        return Equations(
            coordinates=NODES,
            mass_rows=rows_of(np.eye(NODES)),
            inertia=INERTIA,
            connected=_connected(),
            driven=_driven(self.mean, pieces),
            governed=_ungoverned(),
            reference=rows_of(np.eye(1, NODES)),
            reference_time=np.inf,
            frame_time=np.array([0.0, self.span]),
            frame_value=np.array([self.speed_from, self.speed_to]),
        )


RUN_UP = Flywheel()
right_hand_side, jacobian = RUN_UP.right_hand_side, RUN_UP.jacobian


def equations() -> Equations:
    """The run-up as arrays of time stepping."""
    return RUN_UP.equations()


def observed(y: np.ndarray) -> np.ndarray:
    """What the reference lists, of states y (…, 2 NODES): θ0 − θ1, θ0, middle shoe − θ0 [rad], clutch torque [Nm]."""
    angle, rate = y[..., :NODES], y[..., NODES:]
    twist, slip = (v[..., SECONDARY] - v[..., GEARBOX] for v in (angle, rate))
    clutch = CLUTCH_STIFFNESS * twist + CLUTCH_DAMPING * slip
    middle = FIRST_SHOE + SHOES // 2
    primary = angle[..., PRIMARY]
    return np.stack([primary - angle[..., SECONDARY], primary, angle[..., middle] - primary, clutch], axis=-1)


def _rows(pairs: list[tuple[int, int]]) -> Rows:
    from torsional.numerics.motion.data import rows_of

    table = np.zeros((len(pairs), NODES))
    for row, (a, b) in zip(table, pairs, strict=True):
        row[[a, b]] = 1.0, -1.0
    return rows_of(table)


def _connected() -> Any:
    """One connection for each pair of nodes; +λ on plus is the hinge −max(0, k (−(φ + g0) − τ φ̇)) of φ = θ_plus −
    θ_minus, and where the pair stands the other way round the hinge of the other side."""
    from torsional.numerics.linear.sparse_factor import places
    from torsional.numerics.motion.data import Connected, HingeRows, Laws

    linear = {(a, b): (k, c) for a, b, k, c in LINEAR}
    hinges: dict[tuple[int, int], list[tuple[float, float, float]]] = {pair: [] for pair in linear}
    for a, b, gap, stiffness in _one_sided():
        pair, side = ((b, a), 1.0) if (b, a) in hinges else ((a, b), -1.0)
        hinges.setdefault(pair, []).append((side * gap, side, stiffness))
    of = places(e for e, each in enumerate(hinges.values()) for _ in each)
    gap, side, change = (np.array(column) for column in zip(*chain.from_iterable(hinges.values()), strict=True))
    constants = np.zeros((5, len(hinges)))
    constants[:2] = np.array([linear.get(pair, (0.0, 0.0)) for pair in hinges]).T
    none = Laws(np.zeros((9, 0), dtype=np.int64), np.zeros(0), np.zeros((2, 0)), places(()), np.zeros(0))
    values = np.array([gap, side, change, np.full(gap.size, CONTACT_TIME)])
    return Connected(_rows(list(hinges)), constants, HingeRows(of, values), none)


def _driven(mean: float, pieces: int) -> Any:
    """The sine about its mean as a profile on the primary, the load as a level at the vehicle."""
    from torsional.numerics.motion.data import Driven, rows_of

    rows = np.zeros((2, NODES))
    rows[0, PRIMARY], rows[1, VEHICLE] = 1.0, 1.0
    return Driven(
        rows=rows_of(rows),
        multiple=np.array([ORDER, 0.0]),
        phase=np.zeros(2),
        feedback=np.zeros(2),
        profile_of=np.array([0, -1]),
        profile_start=np.array([0, pieces]),
        profile=_sine(mean, pieces),
        period=np.ones(1),
        level_of=np.array([-1, 0]),
        level_start=np.array([0, 1]),
        level_time=np.zeros(1),
        level_value=np.array([-mean]),
        crank_rows=rows_of(np.zeros((0, NODES))),
        **{
            f"crank_{name}": np.zeros(0)
            for name in ("multiple", "phase", "mass", "radius", "rod", "offset", "included")
        },
    )


def _sine(mean: float, pieces: int) -> np.ndarray:
    """Cubic pieces of mean + SWING sin through values and slopes."""
    step = 2 * np.pi / pieces
    at = step * np.arange(pieces + 1)
    value, slope = mean + SWING * np.sin(at), SWING * step * np.cos(at)
    v0, v1, s0, s1 = value[:-1], value[1:], slope[:-1], slope[1:]
    return np.column_stack([v0, s0, 3 * (v1 - v0) - 2 * s0 - s1, 2 * (v0 - v1) + s0 + s1])


def _ungoverned() -> Any:
    from torsional.numerics.motion.data import Governed, rows_of

    nobody, nothing, edge = rows_of(np.zeros((0, NODES))), np.zeros(0), np.zeros(1, dtype=np.int64)
    places = np.zeros(0, dtype=np.int64)
    return Governed(nobody, nobody, places, nothing, nothing, nothing, nothing, edge, places)
