"""A power split absorber by its numbers, and the speed at which it cancels."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from torsional.absorbers import cancellation_frequency
from torsional.components import Inertia, PlanetSpin, Superposition
from torsional.engine import Excitation
from torsional.model import Model
from torsional.numerics.arrays import Array, ComplexArray
from torsional.solvers.harmonic import node_angles, order_response
from torsional.solvers.operating import at_operating_point
from torsional.studies.answers import lowest, main_order, mean_torque
from torsional.studies.trucks import only, replaced, stiffness
from torsional.units import RPM

WIDE = np.linspace(300.0, 3000.0, 136) * RPM
"""Speeds among which cancellation is looked for [rad/s]."""


@dataclass(frozen=True)
class Parts:
    """The numbers of a power split absorber: k, J2, J3, J4, planet ratio g, gear quotient r; its nodes and springs."""

    k: float
    J2: float
    J3: float
    J4: float
    g: float
    r: float
    nodes: tuple[str, str, str]
    springs: str
    planets: str
    gear: str

    @classmethod
    def of(cls, model: Model) -> Parts:
        """Read off a truck with a power split absorber."""
        gear, planets, springs = only(model, Superposition), only(model, PlanetSpin), model.landmarks.springs[0]
        train: Any = model.components[gear]
        spin: Any = model.components[planets]
        inertia = {node: inertia_at(model, node) for node in (train.b, train.node)}
        k, nodes = stiffness(model, springs), (train.a, train.b, train.node)
        J2, J4 = inertia[train.b], inertia[train.node]
        return cls(k, J2, spin.inertia, J4, spin.ratio, train.ratio, nodes, springs, planets, gear)

    def cancellation(self) -> float:
        """Angular frequency [rad/s] at which the undamped absorber's output stands still."""
        return cancellation_frequency(self.k, self.J2, self.J3, self.g, self.r)

    def planets_for(self, omega: ArrayLike, quotient: float) -> Array:
        """Planet inertia [kgm²] that moves the cancellation to ω: J3 = (k/ω² − J2 (1 − r)) / (g (g − r))."""
        return (self.k / np.asarray(omega) ** 2 - self.J2 * (1 - quotient)) / (self.g * (self.g - quotient))


def inertia_at(model: Model, node: str) -> float:
    """Inertia of the discs on a node [kgm²]."""
    parts = [(name, part) for name, part in model.components.items() if isinstance(part, Inertia)]
    return float(sum(part.inertia for name, part in parts if (part.node or name) == node))


def damped(model: Model, damping: float) -> Model:
    """A copy with this viscous damping beside the absorber's springs [Nms/rad]."""
    return replaced(model, model.landmarks.springs[0], damping=damping)


def transfer(model: Model) -> Callable[[Array], ComplexArray]:
    """Angle of the output over that of the primary at the firing order, as a function of speed."""
    first, _, output = Parts.of(model).nodes
    system, order = at_operating_point(model, mean_torque(model))[0], main_order(model)

    def ratio(speed: Array) -> ComplexArray:
        *_, q = order_response(system, Excitation.unit(first, [order], speed))
        angle = node_angles(system, q)
        return np.asarray(angle[:, system.node_index(output)] / angle[:, system.node_index(first)])

    return ratio


def cancelled(model: Model) -> float:
    """Speed [rad/s] at which the output of the undamped absorber is found to stand still against the primary."""
    ratio = transfer(damped(model, 0.0))
    return lowest(lambda speed: np.abs(ratio(speed)), WIDE)
