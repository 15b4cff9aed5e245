"""Which cylinder fires when, and on which throw it sits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from torsional.arguments import checked_fields
from torsional.engine.orders import CYCLE, FloatArray
from torsional.errors import ModelError

TWO_PI = 2.0 * math.pi
ANGLE_TOLERANCE = 1e-6


@dataclass(frozen=True)
@checked_fields
class CrankLayout:
    """Firing order, firing intervals and throws of 1 to 16 cylinders, in line or in a vee.

    ``firing_order`` holds cylinder numbers, beginning with cylinder 1; ``firing_intervals`` [rad] the angle from each
    firing to the next, in firing order, adding up to 4π (empty: even).  ``throws`` gives the throw of each cylinder
    and ``banks`` its bank, both numbered from 1, throws along the shaft away from the free end.  In a vee the two
    cylinders of a throw must fire ``bank_angle`` + ``pin_split`` [rad] apart, apart from whole turns, bank 2 after bank
    1 on every throw or before it on every throw.  Prefer ``CrankLayout.inline`` and ``CrankLayout.vee``.

    Raises ModelError that names the field for anything a crankshaft cannot be.

    >>> six = CrankLayout.inline((1, 5, 3, 6, 2, 4))
    >>> np.degrees(six.firing_angles).round().tolist()
    [0.0, 480.0, 240.0, 600.0, 120.0, 360.0]
    """

    firing_order: tuple[int, ...]
    firing_intervals: tuple[float, ...]
    throws: tuple[int, ...]
    banks: tuple[int, ...]
    bank_angle: float = 0.0
    pin_split: float = 0.0

    @classmethod
    def inline(cls, firing_order: Sequence[int], firing_intervals: Sequence[float] = ()) -> CrankLayout:
        """Cylinders in line, each on its own throw (also the choice for a boxer with a throw a cylinder)."""
        order = tuple(firing_order)
        numbers = tuple(range(1, len(order) + 1))
        return cls(order, tuple(firing_intervals), numbers, (1,) * len(order))

    @classmethod
    def vee(
        cls,
        firing_order: Sequence[int],
        bank_angle: float,
        firing_intervals: Sequence[float] = (),
        throws: Sequence[int] | None = None,
        pin_split: float = 0.0,
    ) -> CrankLayout:
        """Two cylinders on a throw; bank 1 holds the first half of the numbers, bank 2 the second (DIN 73021).

        With ``throws`` given (one number a cylinder) the lower-numbered cylinder of a throw is in bank 1, so that any
        other way of numbering can be described.
        """
        order = tuple(firing_order)
        half = len(order) // 2
        if len(order) % 2:
            raise ModelError("a vee has an even number of cylinders", where="firing_order", found=str(len(order)))
        places = tuple(throws) if throws is not None else tuple(range(1, half + 1)) * 2
        banks = tuple(1 if throw not in places[:index] else 2 for index, throw in enumerate(places))
        return cls(order, tuple(firing_intervals), places, banks, bank_angle, pin_split)

    def __post_init__(self) -> None:
        self._check_order()
        self._check_intervals()
        self._check_throws()
        self._check_vee()

    @property
    def cylinders(self) -> int:
        """Number of cylinders."""
        return len(self.firing_order)

    @property
    def throw_count(self) -> int:
        """Number of throws."""
        return len(set(self.throws))

    @cached_property
    def firing_angles(self) -> FloatArray:
        """Crank angle of each cylinder's firing top dead centre [rad], by cylinder number, shape (cylinders,)."""
        steps = self.firing_intervals or (CYCLE / self.cylinders,) * self.cylinders
        angles = np.empty(self.cylinders)
        angles[np.array(self.firing_order) - 1] = np.concatenate([[0.0], np.cumsum(steps)[:-1]])
        return angles

    @cached_property
    def throw_angles(self) -> FloatArray:
        """Crank angle at which each throw points along bank 1, modulo 2π [rad], shape (throws,)."""
        leaders = [self.throws.index(throw) for throw in range(1, self.throw_count + 1)]
        return np.asarray(np.mod(self.firing_angles[leaders], TWO_PI))

    @cached_property
    def throw_members(self) -> FloatArray:
        """1 where a cylinder sits on a throw, else 0; shape (throws, cylinders)."""
        rows = np.arange(1, self.throw_count + 1)[:, None]
        return np.asarray(rows == np.array(self.throws)[None, :], dtype=float)

    def _check_order(self) -> None:
        found = ", ".join(str(number) for number in self.firing_order)
        count = len(self.firing_order)
        if not 1 <= count <= 16:
            raise ModelError("an engine has 1 to 16 cylinders", where="firing_order", found=str(count))
        if sorted(self.firing_order) != list(range(1, count + 1)):
            raise ModelError(
                "the firing order must name every cylinder once",
                where="firing_order",
                found=found,
                allowed=f"1 to {count}",
            )
        if self.firing_order[0] != 1:
            remedy = "turn the list until cylinder 1 leads: crank angles count from its firing top dead centre"
            raise ModelError("the firing order must begin with 1", where="firing_order", found=found, remedy=remedy)

    def _check_intervals(self) -> None:
        if not self.firing_intervals:
            return
        if len(self.firing_intervals) != self.cylinders or min(self.firing_intervals) < 0:
            found = ", ".join(f"{math.degrees(step):g}°" for step in self.firing_intervals)
            allowed = f"{self.cylinders} angles, none negative"
            raise ModelError("one interval a firing is needed", where="firing_intervals", found=found, allowed=allowed)
        total = sum(self.firing_intervals)
        if abs(total - CYCLE) > ANGLE_TOLERANCE:
            found = f"{math.degrees(total):g}°"
            remedy = "angles are in radians" if abs(total - 720.0) < 1.0 else ""
            raise ModelError("the intervals must add up to 720°", where="firing_intervals", found=found, remedy=remedy)

    def _check_throws(self) -> None:
        count = len(set(self.throws))
        listed = len(self.throws) == len(self.banks) == self.cylinders
        if not listed or set(self.throws) != set(range(1, count + 1)):
            found = ", ".join(str(throw) for throw in self.throws)
            allowed = f"{self.cylinders} numbers that leave out no throw"
            raise ModelError("each cylinder needs its throw", where="throws", found=found, allowed=allowed)
        for throw in set(self.throws):
            seated = sorted(bank for bank, place in zip(self.banks, self.throws, strict=True) if place == throw)
            if seated not in ([1], [1, 2]):
                problem = "a throw carries one cylinder of bank 1, or one of each bank"
                raise ModelError(problem, where="throws", found=f"banks {seated} on throw {throw}")

    def _check_vee(self) -> None:
        apart = self.bank_angle + self.pin_split
        lags = {}
        for throw in range(1, self.throw_count + 1):
            seated = [index for index, place in enumerate(self.throws) if place == throw]
            if len(seated) == 2:
                first, second = sorted(seated, key=lambda index: self.banks[index])
                lags[throw] = self.firing_angles[second] - self.firing_angles[first]
        misses = [{t: abs(math.remainder(lag - s * apart, TWO_PI)) for t, lag in lags.items()} for s in (1, -1)]
        best = min(misses, key=lambda miss: sum(miss.values()))
        for throw, miss in best.items():
            if miss > ANGLE_TOLERANCE:
                raise ModelError(
                    f"the two cylinders of throw {throw} do not fire one bank angle apart",
                    where="bank_angle",
                    found=f"{math.degrees(lags[throw]) % 360:g}° between them",
                    allowed=f"{math.degrees(apart):g}° or {math.degrees(-apart) % 360:g}°, the same on every throw",
                    remedy="check firing_order and firing_intervals, or give the pin_split of a split-pin crankshaft",
                )
