"""What drives a line in time: orders, torques over time, governors; the engine's cylinders are in `cylinders`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked_fields
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.solvers.transient.acting import Acting, Drive, Governing, Source, row_of
from torsional.solvers.transient.profiles import Level, Profile, level_of, of_orders
from torsional.solvers.transient.speed_profile import SpeedProfile, as_speed
from torsional.system import System

BEYOND = 1e-9


@dataclass(frozen=True, eq=False)
@checked_fields
class OrderTorques:
    """The orders of an ``excitation`` over the crank angle, its operating points over speed joined by straight lines.

    ``feedback``: the events move with the node's own motion; without it they keep to the mean rotation, which is what
    the frequency domain means.  Raises ModelError for speeds that the excitation does not reach; one with a single
    operating point holds at every speed.

    >>> OrderTorques(Excitation.unit("crank", [1.5, 3.0], [100.0]), feedback=True).excitation.nodes
    ('crank',)
    """

    excitation: Excitation
    feedback: bool = False

    def acting(self, system: System, speed: SpeedProfile) -> Acting:
        """One source a node and operating point; the mean torque belongs to the line's load."""
        given = self.excitation
        at = np.atleast_1d(given.speed)
        torque = given.torque.reshape(at.size, len(given.nodes), -1)
        if at.ndim > 1:
            raise ModelError("the excitation has more than one axis of speeds", where="excitation")
        sources: list[Source] = []
        for point, (weight, harmonics) in enumerate(zip(self._weights(at, speed), torque, strict=True)):
            if weight is not None and not weight.value.any():
                continue
            if point not in self._profiles:
                self._profiles[point] = tuple(of_orders(given.orders, own) for own in harmonics)
            sources += [
                Source(row_of(system, node), profile, weight, self._feedback(system, node))
                for node, profile in zip(given.nodes, self._profiles[point], strict=True)
            ]
        return Acting(tuple(sources), taken_up=tuple(_mean(source) for source in sources))

    @cached_property
    def _profiles(self) -> dict[int, tuple[Profile, ...]]:
        """Torques of the nodes by operating point, as far as they were asked for; the same for every line."""
        return {}

    def _feedback(self, system: System, node: str) -> float:
        ratio = float(system.speed_ratio[system.node_index(node)])
        return 1.0 / ratio if self.feedback and ratio else 0.0

    @staticmethod
    def _weights(at: Array, speed: SpeedProfile) -> list[Level | None]:
        """The share of each operating point over time."""
        if at.size == 1:
            return [None]
        low, high = speed.range
        if low < at.min() * (1 - BEYOND) or high > at.max() * (1 + BEYOND):
            allowed = f"{at.min():g} to {at.max():g} rad/s"
            found = f"{low:g} to {high:g} rad/s"
            raise ModelError("the excitation does not reach the speeds", where="speed", found=found, allowed=allowed)
        order = np.argsort(at)
        time = speed.crossings(at)
        shares = [np.interp(speed.at(time), at[order], unit[order]) for unit in np.eye(at.size)]
        return [Level(time, share) for share in shares]


def _mean(source: Source) -> tuple[Array, Level]:
    """The mean torque of a source over time."""
    mean = source.profile.mean if source.profile is not None else 1.0
    level = source.level or Level(np.zeros(1), np.ones(1))
    return source.row, Level(level.time, mean * level.value)


@dataclass(frozen=True)
@checked_fields
class TorqueHistory:
    """A torque [Nm] at a ``node`` over ``times`` [s]: straight lines between them, constant before and after.

    What it has at the time zero belongs to the mean load that a run in equilibrium starts from.

    >>> TorqueHistory("input", (0.0, 0.1, 0.2), (0.0, 300.0, 0.0)).node
    'input'
    """

    node: str
    times: tuple[float, ...]
    torques: tuple[float, ...]

    def __post_init__(self) -> None:
        for name in ("times", "torques"):
            object.__setattr__(self, name, tuple(float(v) for v in np.atleast_1d(getattr(self, name))))
        level_of(self.times, self.torques, f"torque of {self.node}")

    def acting(self, system: System, speed: SpeedProfile) -> Acting:
        """One source without a profile."""
        level = Level(np.array(self.times), np.array(self.torques))
        row = row_of(system, self.node)
        return Acting((Source(row, level=level),), taken_up=((row, _constant(float(level.at(0.0)))),))


@dataclass(frozen=True)
@checked_fields
class Governor:
    """A speed governor T = clip(k_p e + ∫ k_i e dt, low, high), e = wanted − speed of the node ``sense`` [rad/s].

    It gives a torque [Nm] at the node ``acts_on``, or where that is "" a change of the cylinders' level [-].
    ``wanted`` [rad/s] at the node: a number or a `SpeedProfile`; ``proportional`` [Nms/rad] or [s/rad], ``integral``
    [Nm/rad] or [1/rad].  With a node ``against`` it is the speed of ``sense`` less that of this one, both as they are
    at the engine.

    >>> Governor("throw1", 62.8, acts_on="throw1", proportional=20.0, low=-100.0, high=300.0).integral
    0.0
    """

    sense: str
    wanted: float | SpeedProfile
    acts_on: str = ""
    proportional: float = 0.0
    integral: float = 0.0
    low: float = -np.inf
    high: float = np.inf
    against: str = ""

    def __post_init__(self) -> None:
        for name in ("proportional", "integral"):
            if not np.isfinite(getattr(self, name)):
                raise ModelError("must be finite", where=f"governor.{name}", found=f"{getattr(self, name)}")
        if not self.low < self.high:
            found = f"{self.low:g} to {self.high:g}"
            raise ModelError("the governor's range goes from a lower to a higher value", where="governor", found=found)

    def acting(self, system: System, speed: SpeedProfile) -> Acting:
        """One governor."""
        act = row_of(system, self.acts_on) if self.acts_on else None
        values = self.proportional, self.integral, self.low, self.high
        sense = row_of(system, self.sense)
        if self.against:
            sense = sense / sense.sum() - (other := row_of(system, self.against)) / other.sum()
        return Acting(governors=(Governing(sense, act, as_speed(self.wanted).level, *values),))


def _constant(value: float) -> Level:
    return Level(np.zeros(1), np.array([value]))


def at_start(acting: Acting) -> tuple[tuple[Array, Level], ...]:
    """Mean torques of sources as they are at the time zero, whatever their levels do later."""
    return tuple((row, _constant(float(level.at(0.0)))) for row, level in map(_mean, acting.sources))


def all_acting(
    drives: Drive | Excitation | Sequence[Drive | Excitation], system: System, speed: SpeedProfile
) -> Acting:
    """All drives together; an `Excitation` keeps to the mean rotation."""
    listed = drives if isinstance(drives, Sequence) else (drives,)
    told = Acting()
    for drive in listed:
        own = OrderTorques(drive) if isinstance(drive, Excitation) else drive
        told = told.joined(own.acting(system, speed))
    if not any(source.governed for source in told.sources) and any(g.act is None for g in told.governors):
        remedy = "say acts_on, the node on which its torque acts, or drive the line by CylinderTorques"
        raise ModelError("the governor has no engine to act on", where="governor", remedy=remedy)
    return told


def held(acting: Acting, system: System, hold: str, time: ArrayLike = ()) -> Acting:
    """The drives with the torque at ``hold`` that balances their mean load through the speed ratios."""
    if not hold:
        return acting
    row = row_of(system, hold)
    ratio = float(row.sum())
    if not ratio:
        raise ModelError(f"node '{hold}' does not turn and takes up no mean torque", where=hold)
    times = np.unique(np.concatenate([[0.0], *(level.time for _, level in acting.taken_up)]))
    load = sum((r.sum() * level.at(times) for r, level in acting.taken_up), np.zeros(len(times)))
    return acting.joined(Acting((Source(row, level=Level(times, -load / ratio)),)))
