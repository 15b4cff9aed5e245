"""The load of a periodic analysis: torque harmonics at nodes as a piecewise cubic of the continued parameter."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked_fields
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray

NEGLIGIBLE = 1e-9


@dataclass(frozen=True, eq=False)
@checked_fields
class Load:
    """Complex 0-peak torque harmonics [Nm] of ``orders`` at ``nodes``, order 0 the mean, over a parameter.

    Piece i holds between ``breaks`` i and i + 1: Σ_d ``coefficients`` (pieces, 4, nodes, orders) (p − break)^d.

    >>> load = Load.through(["crank"], [0.0, 3.0], [60.0, 70.0], [[[1000.0, 400.0]], [[1000.0, 300.0]]])
    >>> load.order(3.0)[0, :2].ravel().real.tolist()
    [400.0, -10.0]
    """

    nodes: tuple[str, ...]
    orders: Array
    breaks: Array
    coefficients: ComplexArray

    @classmethod
    def through(cls, nodes: Sequence[str], orders: ArrayLike, values: ArrayLike, torque: ArrayLike) -> Load:
        """The cubic spline through torques (values, nodes, orders) at rising ``values`` of the parameter."""
        from scipy.interpolate import CubicSpline  # imported where used: half of the analyses need none

        at, given = np.atleast_1d(np.asarray(values, dtype=float)), np.asarray(torque, dtype=complex)
        if at.size < 4:
            return cls.polynomial(nodes, orders, at, given)
        spline = CubicSpline(at, given, axis=0)
        return cls(tuple(nodes), np.asarray(orders, dtype=float), at, np.moveaxis(spline.c, 1, 0)[:, ::-1])

    @classmethod
    def polynomial(cls, nodes: Sequence[str], orders: ArrayLike, values: Array, torque: ComplexArray) -> Load:
        """The parabola, line or constant through three, two or one value."""
        powers = np.vander(values - values[0], increasing=True)
        c = np.zeros((1, 4, *torque.shape[1:]), dtype=complex)
        c[0, : values.size] = np.linalg.solve(powers, torque.reshape(values.size, -1)).reshape(torque.shape)
        ends = np.array([values[0], max(values[-1], values[0] + 1.0)])
        return cls(tuple(nodes), np.asarray(orders, dtype=float), ends, c)

    @classmethod
    def over_speed(cls, excitation: Excitation) -> Load:
        """An excitation over the speeds it has; of a single speed it holds for every one."""
        at = np.atleast_1d(excitation.speed)
        torque = excitation.torque.reshape(at.size, len(excitation.nodes), -1)
        return cls.through(excitation.nodes, excitation.orders, at, torque)

    @classmethod
    def over_amplitude(cls, excitation: Excitation) -> Load:
        """One operating point with every order above 0 times the parameter."""
        mean, varied = _split(excitation)
        return cls.polynomial(
            excitation.nodes, excitation.orders, np.array([0.0, 1.0]), np.stack([mean, mean + varied])
        )

    @classmethod
    def over_mean_torque(cls, excitation: Excitation) -> Load:
        """One operating point with its mean torques in proportion, their sum being the parameter [Nm]."""
        mean, varied = _split(excitation)
        total = mean.sum().real
        if not total:
            raise ModelError(
                "without a mean torque there is no place for more of it", where="excitation", remedy="give order 0"
            )
        return cls.polynomial(
            excitation.nodes, excitation.orders, np.array([0.0, total]), np.stack([varied, mean + varied])
        )

    def at(self, value: ArrayLike) -> ComplexArray:
        """Torques S + (nodes, orders) at values of the parameter of any shape S."""
        p = np.asarray(value, dtype=float)
        piece = np.clip(np.searchsorted(self.breaks, p, "right") - 1, 0, len(self.coefficients) - 1)
        d, c = (p - self.breaks[piece])[..., None, None], self.coefficients
        return np.asarray(c[piece, 0] + d * (c[piece, 1] + d * (c[piece, 2] + d * c[piece, 3])))

    def order(self, order: float) -> ComplexArray:
        """Coefficients of one order (pieces, 4, nodes), zero where the load has none of it."""
        at = np.flatnonzero(np.abs(self.orders - order) < 1e-9)
        shape = self.coefficients.shape[:3]
        return self.coefficients[..., at[0]] if at.size else np.zeros(shape, dtype=complex)

    @property
    def base_order(self) -> float:
        """The largest order of which all that count are multiples."""
        size = np.abs(self.at(self.breaks)).max(axis=(0, 1))
        counts = (self.orders > 0) & (size > NEGLIGIBLE * size[self.orders > 0].max(initial=0.0))
        if not counts.any():
            raise ModelError("nothing but a mean torque acts", where="excitation", remedy="give orders above 0")
        base = 0.0
        for order in self.orders[counts]:
            base = common_order(base, float(order))
        return base

    def refuse_others(self, base_order: float) -> None:
        """Raise ModelError where an order that counts is no multiple of a base order."""
        ratio = self.orders / base_order
        lost = self.orders[np.abs(ratio - np.round(ratio)) > 1e-6]
        if lost.size:
            raise ModelError(
                "the excitation has an order that is no multiple of the base order",
                where="base_order",
                found=f"order {lost[0]:g}",
                allowed=f"multiples of {base_order:g}",
                remedy="leave the base order out, or choose one that divides all orders",
            )


def common_order(a: float, b: float) -> float:
    """The largest number of which both are whole multiples, by Euclid's algorithm."""
    while b > 1e-6:
        a, b = b, a % b
        if a - b < 1e-6:
            b = 0.0
    return round(a, 9)


def _split(excitation: Excitation) -> tuple[ComplexArray, ComplexArray]:
    """Mean torques and the rest (nodes, orders) of an excitation at one operating point."""
    if np.size(excitation.speed) != 1:
        raise ModelError(
            "one operating point is wanted", where="excitation", found=f"{np.size(excitation.speed)} speeds"
        )
    torque = excitation.torque.reshape(len(excitation.nodes), -1)
    mean = np.where(excitation.orders == 0, torque, 0.0)
    return mean, torque - mean
