"""Torque harmonics at named nodes: what excites a powertrain."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked, checked_fields
from torsional.engine.orders import ComplexArray, FloatArray, checked_orders
from torsional.errors import ModelError, nearest


@dataclass(frozen=True, eq=False)
@checked_fields
class Excitation:
    """Complex 0-peak torque harmonics at nodes, T(t) = Re Σ_n T_n exp(i n θ), θ = Ω t the engine's crank angle.

    ``nodes`` names; ``orders`` (orders,) multiples of 0.5; ``speed`` [rad/s] of any shape S, one entry an operating
    point; ``torque`` [Nm] complex, shape S + (nodes, orders).  Order 0 is the mean torque.
    Raises ModelError for shapes that do not fit, a node named twice, or values that are not finite.

    >>> unit = Excitation.unit("crank", [1.5, 3.0], [60.0, 70.0])
    >>> unit.torque.shape
    (2, 1, 2)
    """

    nodes: tuple[str, ...]
    orders: FloatArray
    speed: FloatArray
    torque: ComplexArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "nodes", tuple(self.nodes))
        object.__setattr__(self, "orders", checked_orders(self.orders))
        object.__setattr__(self, "speed", np.asarray(self.speed, dtype=float))
        object.__setattr__(self, "torque", np.asarray(self.torque, dtype=complex))
        wanted = (*self.speed.shape, len(self.nodes), len(self.orders))
        if self.torque.shape != wanted:
            allowed = f"{wanted}: speed, nodes, orders"
            raise ModelError(
                "the torque has another shape", where="torque", found=str(self.torque.shape), allowed=allowed
            )
        if len(set(self.nodes)) < len(self.nodes):
            raise ModelError("a node is named twice", where="nodes", found=", ".join(self.nodes))

    @classmethod
    @checked
    def unit(cls, node: str, orders: ArrayLike, speed: ArrayLike) -> Excitation:
        """One newton metre of every order at one node: the responses to it are receptances."""
        at, n = np.asarray(speed, dtype=float), checked_orders(orders)
        return cls((node,), n, at, np.ones((*at.shape, 1, len(n)), dtype=complex))

    def at(self, node: str) -> ComplexArray:
        """Harmonics at one node [Nm], shape S + (orders,)."""
        if node not in self.nodes:
            raise ModelError("nothing excites this node", where=node, remedy=nearest(node, self.nodes))
        return np.asarray(self.torque[..., self.nodes.index(node), :])

    def selected(self, orders: ArrayLike) -> Excitation:
        """The same with these of its orders only."""
        n = checked_orders(orders)
        missing = n[~np.isin(n, self.orders)]
        if missing.size:
            found, allowed = f"{missing[0]:g}", ", ".join(f"{order:g}" for order in self.orders)
            raise ModelError("the order is not in the excitation", where="orders", found=found, allowed=allowed)
        picked = [int(np.flatnonzero(self.orders == order)[0]) for order in n]
        return Excitation(self.nodes, n, self.speed, self.torque[..., picked])

    def lumped(self, node: str) -> Excitation:
        """The same torques all acting on one node, as on a rigid crankshaft."""
        return Excitation((node,), self.orders, self.speed, self.torque.sum(axis=-2, keepdims=True))

    def waveform(self, crank_angle: ArrayLike) -> FloatArray:
        """Torque over crank angle [Nm], shape S + (nodes,) + that of the crank angle [rad]: the sum of the orders.

        >>> Excitation(("crank",), [3.0], 60.0, [[100.0]]).waveform([0.0, np.pi / 3]).round(9).tolist()
        [[100.0, -100.0]]
        """
        angle = np.asarray(crank_angle, dtype=float)
        turns = np.exp(1j * np.multiply.outer(self.orders, angle))
        return np.asarray(np.tensordot(self.torque, turns, axes=1).real)


def checked_nodes(nodes: str | Sequence[str], throws: int) -> tuple[str, ...]:
    """The nodes the throws act on: one a throw, or a single one for all."""
    names = (nodes,) if isinstance(nodes, str) else tuple(nodes)
    if len(names) not in (1, throws):
        allowed = f"{throws}, one a throw, or a single node for all"
        raise ModelError(
            "the number of nodes does not fit the crankshaft", where="nodes", found=str(len(names)), allowed=allowed
        )
    return names
