"""Cylinder pressure as a sum of fixed shapes, the one form that every source of gas torque is brought to."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from torsional.engine.cylinder import Cylinder
from torsional.engine.orders import FloatArray


@dataclass(frozen=True, eq=False)
class PressureShapes:
    """p(θ) = Σ_k (unfired_k + heat fired_k) shape_k(θ): the pressure is affine in the heat.

    ``shapes`` [Pa per unit], shape (K, samples), on the grid of crank angles that starts at the cylinder's own firing
    top dead centre.  ``coefficients`` takes mean effective pressures [Pa] of shape (B,) and gives ``unfired`` and
    ``fired``, each of shape (B, Z, K), with Z the number of cylinders or 1 where all are alike.

    Because p is affine in the heat, so are torque, harmonics and mean torque: a whole map costs one small matrix
    product, and the heat for a wanted torque follows without search.
    """

    shapes: FloatArray
    coefficients: Callable[[FloatArray], tuple[FloatArray, FloatArray]]


class GasSource(Protocol):
    """What gives an engine its cylinder pressure: a measured trace or a calculated cycle."""

    def pressure_shapes(self, cylinder: Cylinder, firing_angles: FloatArray) -> PressureShapes:
        """The pressure above a piston, for cylinders that fire at these crank angles [rad]."""
        ...
