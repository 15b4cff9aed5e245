"""The harmonic balance as a problem for the continuation: unknowns of one base order, along one parameter."""

from __future__ import annotations

import copy
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import NDArray

from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.balance.data import Balance, harmonic_parts, static_part
from torsional.numerics.balance.equations import corrected, equations, half_order_block
from torsional.numerics.continuation.following import Corrected
from torsional.solvers.periodic.equations import Split, balance
from torsional.solvers.periodic.load import Load

BoolArray = NDArray[np.bool_]
JOINED = "joined"
MET = 40
LANDED = 1e-9
"""Share of the watched part nearest behind below which a correction has fallen onto the branch that was left."""
TESTS = ("branch point", "period doubling")


@dataclass(frozen=True, eq=False)
class Setting:
    """What stays as it is along a branch.

    ``split`` system and ``load`` over the parameter, ``hold`` the node that takes up the mean torque, ``speed`` [rad/s]
    where it is not the parameter, ``highest_order`` of the harmonics, ``scale`` of the angles (m,) [rad] and of the
    parameter, ``main_order`` the base order of the main branch.
    """

    split: Split
    load: Load
    hold: str
    speed: float | None
    highest_order: float
    angle_scale: Array
    parameter_scale: float
    samples: int = 0
    main_order: float = 0.0

    def harmonics(self, base_order: float) -> int:
        """How many multiples of a base order there are up to the highest one."""
        return max(int(self.highest_order / base_order + 1e-9), 1)

    def scale(self, base_order: float) -> Array:
        """What the scaled unknowns and the scaled parameter are multiplied with (n + 1,)."""
        return np.append(np.tile(self.angle_scale, 2 * self.harmonics(base_order) + 1), self.parameter_scale)

    def balance(self, base_order: float) -> Balance:
        """The compiled balance in multiples of a base order."""
        count = self.harmonics(base_order)
        half = min((self.harmonics(0.5 * base_order) + 1) // 2, count + 1)
        return balance(
            self.split,
            self.load,
            base_order,
            count,
            self.scale(base_order),
            hold=self.hold,
            speed=self.speed,
            half_orders=half,
            samples=self.samples,
            periods=max(1, round(self.main_order / base_order)),
        )


class HarmonicProblem:
    """Problem of one base order; unknowns and parameter are scaled."""

    def __init__(self, setting: Setting, base_order: float) -> None:
        self.setting, self.base_order = setting, base_order
        self.balance = setting.balance(base_order)
        self.scale = self.balance.scale
        remembers = bool(self.balance.remembers.any())
        self.tests: tuple[str, ...] = TESTS[: 1 if remembers else 2]

    def rescaled(self, setting: Setting) -> Self:
        """The same problem in a setting with other scales."""
        scaled = copy.copy(self)
        scaled.setting, scaled.scale = setting, setting.scale(self.base_order)
        scaled.balance = self.balance._replace(scale=scaled.scale)
        return scaled

    def frozen(self, value: float) -> HarmonicProblem:
        """The problem in which everything but speed and load is as it is at one physical value of the parameter."""
        return self

    def pieces(self, points: Array) -> Iterator[tuple[slice, HarmonicProblem]]:
        """Runs of scaled points (points, n + 1) that share one frozen problem."""
        yield slice(0, len(points)), self

    @property
    def connections(self) -> int:
        """Number m of connections with a law."""
        return len(self.setting.split.laws)

    @cached_property
    def harmonics(self) -> int:
        """Number H of harmonics above the mean."""
        return self.setting.harmonics(self.base_order)

    def correct(self, guess: Array, normal: Array) -> Corrected:
        """Newton's method across a normal."""
        return Corrected(*corrected(self.balance, guess, normal, len(self.tests)))

    def at(self, guess: Array, value: float) -> Corrected:
        """The solution near a scaled guess at one physical value of the parameter."""
        start, normal = guess.copy(), np.zeros_like(guess)
        start[-1], normal[-1] = value / self.scale[-1], 1.0
        return self.correct(start, normal)

    def linearised(self, z: Array) -> tuple[Array, Array, Array, ComplexArray]:
        """Residual, Jacobian, derivative by the parameter (physical) and tangent spectra at a scaled point."""
        n, m, value = z.size - 1, self.connections, float(z[-1] * self.scale[-1])
        residual, jacobian, slope = np.empty(n), np.empty((n, n)), np.empty(n)
        spectra = np.empty((m, 2, n // m + 3), dtype=complex)
        balance = self.frozen(value).balance
        equations(balance, z[:-1] * self.scale[:-1], value, residual, jacobian, slope, spectra)
        return residual, jacobian, slope, spectra

    def half_order_block(self, z: Array) -> Array:
        """The linearised equations of the odd multiples of half the base order at a scaled point."""
        value = float(z[-1] * self.scale[-1])
        if self.balance.remembers.any():
            return self._odd_block(z, value)
        return np.asarray(half_order_block(self.frozen(value).balance, value, self.linearised(z)[3]))

    def _odd_block(self, z: Array, value: float) -> Array:
        """The same of laws that remember: what concerns the odd multiples in the equations of twice the period."""
        frozen = self.frozen(value)
        doubled = HarmonicProblem(frozen.setting, 0.5 * self.base_order)
        harmonics = self.harmonics_of(z)
        wide = np.zeros((harmonics.shape[0], 2 * harmonics.shape[1] - 1), dtype=complex)
        wide[:, ::2] = harmonics
        odd = WatchedProblem.of_odd(doubled).watched[:-1]
        return np.asarray(doubled.linearised(doubled.point_of(wide, value))[1][np.ix_(odd, odd)])

    def linear_size(self, value: float) -> tuple[Array, Array]:
        """Mean angles (m,) and largest harmonics (m,) [rad] of the linear part with its references at a value."""
        m, balance = self.connections, self.frozen(value).balance
        shape = (self.harmonics + 1, m)
        b, db = np.zeros(shape, dtype=complex), np.zeros(shape, dtype=complex)
        g, dg = np.zeros((*shape, m), dtype=complex), np.zeros((*shape, m), dtype=complex)
        static_part(balance, value, b, db)
        speed = value if self.setting.speed is None else self.setting.speed
        harmonic_parts(balance, value, speed, g, dg, b, db)
        return b[0].real, np.abs(b[1:]).max(axis=0)

    def part_motion(self, value: float) -> Array:
        """How far the ends of the connections (m,) move [rad] where harmonics are solved for one by one, else 0.

        A spring that twists a millionth of that is resolved to some digits less than the others.
        """
        balance = self.frozen(value).balance
        ends, nodes = np.abs(balance.weights), balance.weights.shape[1]
        if balance.poles.size:
            return np.zeros(len(ends))
        shape, speed = (self.harmonics + 1, nodes), value if self.setting.speed is None else self.setting.speed
        g, dg = np.zeros((*shape, nodes), dtype=complex), np.zeros((*shape, nodes), dtype=complex)
        b, db = np.zeros(shape, dtype=complex), np.zeros(shape, dtype=complex)
        harmonic_parts(balance._replace(weights=np.eye(nodes)), value, speed, g, dg, b, db)
        return np.asarray(ends @ np.abs(b[1:]).max(axis=0))

    def resting(self, value: float) -> Array | None:
        """Mean angles (m,) [rad] under the mean torque alone, by the balance of harmonic 0; None where that fails."""
        m, balance = self.connections, self.frozen(value).balance
        if balance.remembers.any():
            return None
        scale = np.append(self.scale[:m], self.scale[-1])
        still = balance._replace(table=np.ones((1, 1)), scale=scale)
        b, db = np.zeros((1, m), dtype=complex), np.zeros((1, m), dtype=complex)
        static_part(balance, value, b, db)
        guess, normal = np.append(b[0].real, value) / scale, np.zeros(m + 1)
        normal[-1] = 1.0
        z, *_, converged, _ = corrected(still, guess, normal, 0)
        return np.asarray(z[:m] * scale[:m]) if converged else None

    def harmonics_of(self, z: Array) -> ComplexArray:
        """Complex 0-peak harmonics (…, m, H + 1) of the relative angles [rad] of scaled points (…, n + 1)."""
        m, count = self.connections, self.harmonics
        x = z[..., :-1] * self.scale[:-1]
        out = np.zeros((*z.shape[:-1], m, count + 1), dtype=complex)
        out[..., 0] = x[..., :m]
        parts = x[..., m:].reshape(*z.shape[:-1], count, 2, m)
        out[..., 1:] = np.moveaxis(parts[..., 0, :] + 1j * parts[..., 1, :], -1, -2)
        return out

    def point_of(self, harmonics: ComplexArray, value: float) -> Array:
        """The scaled point of given harmonics (m, any number + 1): the rest is zero, or left out."""
        m, count = self.connections, min(self.harmonics, harmonics.shape[1] - 1)
        z = np.zeros(self.scale.size)
        z[:m] = harmonics[:, 0].real
        rest = z[m:-1].reshape(self.harmonics, 2, m)
        rest[:count, 0], rest[:count, 1] = harmonics[:, 1 : count + 1].real.T, harmonics[:, 1 : count + 1].imag.T
        z[-1] = value
        return np.asarray(z / self.scale)


class WatchedProblem:
    """A problem whose ``watched`` unknowns are zero on the branch it leaves: where they are again it has come back.

    Beyond that place the same branch would be followed once more, moved in time by a period or mirrored.
    """

    def __init__(self, inner: HarmonicProblem, watched: BoolArray) -> None:
        self.inner, self.watched, self.scale = inner, watched, inner.scale
        self.tests = (*inner.tests, JOINED)
        self._met: deque[tuple[Array, Array]] = deque(maxlen=MET)

    @classmethod
    def of_odd(cls, inner: HarmonicProblem) -> WatchedProblem:
        """Watching the odd multiples of the base order, of which a motion of half the period has none."""
        m, count = inner.connections, inner.harmonics
        odd = np.arange(count) % 2 == 0
        return cls(inner, np.concatenate([np.zeros(m, bool), np.repeat(odd, 2 * m), [False]]))

    def correct(self, guess: Array, normal: Array) -> Corrected:
        """Newton's method; the last test is the watched amplitude, negative beyond the place where it was zero."""
        found = self.inner.correct(guess, normal)
        if not found.converged:
            return found._replace(values=np.append(found.values, 0.0))
        part = found.z[self.watched]
        facing = self._facing(guess, normal)
        if facing is not None and np.abs(part).max() < LANDED * np.abs(facing).max():
            return found._replace(values=np.append(found.values, 0.0), converged=False)  # a shorter step may stay on it
        side = 1.0 if facing is None or float(facing @ part) >= 0 else -1.0
        self._met.append((found.z, side * part))
        return found._replace(values=np.append(found.values, side * float(np.sqrt(part @ part))))

    def _facing(self, guess: Array, normal: Array) -> Array | None:
        """The watched part, before any crossing of zero, of the nearest point met that lies behind a guess."""
        best, least = None, np.inf
        for z, part in self._met:
            way = guess - z
            distance = float(way @ way)
            if distance < least and float(way @ normal) >= -1e-9:
                best, least = part, distance
        return best
