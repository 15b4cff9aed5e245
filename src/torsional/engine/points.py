"""Operating points solved, and what they say about the mean."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from torsional.engine.orders import FloatArray


@dataclass(frozen=True, eq=False)
class OperatingPoints:
    """Operating points solved: ``speed`` [rad/s] in the broadcast shape S of speed and torque, flattened to (B,).

    ``coefficients`` of the pressure shapes by group of equal cylinders (B, G, K); ``heat`` (B,) [J a cylinder and
    cycle, or the factor on a measured trace's combustion]; ``peak_pressure`` (B, G) [Pa]; ``friction`` (B, G), the mean
    friction torque of one cylinder [Nm].
    """

    shape: tuple[int, ...]
    speed: FloatArray
    coefficients: FloatArray
    heat: FloatArray
    peak_pressure: FloatArray
    friction: FloatArray


@dataclass(frozen=True, eq=False)
class MeanTorque:
    """Mean torque of each throw [Nm], shape S + (throws,): of the gas, and what friction takes of it."""

    gas: FloatArray
    friction: FloatArray

    @property
    def net(self) -> FloatArray:
        """Gas less friction; the sum over the throws is the engine's brake torque."""
        return np.asarray(self.gas - self.friction)
