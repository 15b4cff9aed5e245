"""The heat that gives a wanted mean torque, cylinders that burn alike taken together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from torsional.engine.orders import BoolArray, FloatArray, IntArray
from torsional.errors import ModelError
from torsional.units import show_speed

BATCH = 2048
"""Operating points solved at a time, so that a map of a million needs no more memory than one of a thousand."""


@dataclass(frozen=True, eq=False)
class Groups:
    """Cylinders with one pressure: how many, and which column, heat factor and valves they have; arrays (G,)."""

    of_cylinder: IntArray
    count: IntArray
    column: IntArray
    heat: FloatArray
    sealed: BoolArray

    @classmethod
    def gathered(cls, column: IntArray, heat: FloatArray, sealed: BoolArray) -> Groups:
        """Groups of equal rows among the cylinders' columns, heat factors and valve states, each (cylinders,)."""
        rows = np.stack([column, heat, sealed], axis=1).astype(float)
        kinds, member, count = np.unique(rows, axis=0, return_inverse=True, return_counts=True)
        return cls(member.reshape(-1), count, kinds[:, 0].astype(int), kinds[:, 1], kinds[:, 2].astype(bool))

    def coefficients(self, unfired: FloatArray, fired: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Both coefficients by group, (B, G, K + 1), the last shape being that of a sealed cylinder."""
        edge = ((0, 0), (0, 0), (0, 1))
        still = np.pad(unfired[:, self.column % unfired.shape[1]], edge)
        burning = np.pad(fired[:, self.column % fired.shape[1]] * self.heat[:, None], edge)
        still[:, self.sealed], burning[:, self.sealed] = 0.0, 0.0
        still[:, self.sealed, -1] = 1.0
        return still, burning


@dataclass(frozen=True, eq=False)
class Balance:
    """Mean brake torque of the engine as a function of the heat: a concave line of straight pieces.

    ``work`` mean torque per shape (K + 1,) [Nm]; ``shapes`` around firing (K + 1, W), where the peak pressure is
    found; ``friction_arm`` torque per mean pressure of a cylinder V/4π [m³]; ``peak_factor`` of the friction.
    """

    work: FloatArray
    shapes: FloatArray
    count: IntArray
    friction_arm: float
    peak_factor: float

    def heat(self, still: FloatArray, burning: FloatArray, wanted: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Heat (B,) for the wanted torque before the constant friction (B,), and the peak pressures (B, G).

        The peak pressure is the largest of affine functions of the heat, so Newton's steps end on the exact piece
        after a few passes.
        """
        parts = [slice(start, start + BATCH) for start in range(0, max(len(wanted), 1), BATCH)]
        solved = [self._heat(still[part], burning[part], wanted[part]) for part in parts]
        heats, peaks = zip(*solved, strict=True)
        return np.concatenate(heats), np.concatenate(peaks)

    def _heat(self, still: FloatArray, burning: FloatArray, wanted: FloatArray) -> tuple[FloatArray, FloatArray]:
        gas, slope = (still @ self.work) @ self.count, (burning @ self.work) @ self.count
        loss = self.peak_factor * self.friction_arm * self.count
        heat, piece = (wanted - gas) / slope, np.full(still.shape[:2], -1)
        for _ in range(50):
            found = ((still + heat[:, None, None] * burning) @ self.shapes).argmax(axis=2)
            if np.array_equal(found, piece):
                break
            piece, highest, last = found, self.shapes.T[found], heat
            fixed, rising = (still * highest).sum(axis=2), (burning * highest).sum(axis=2)
            gain = slope - rising @ loss
            if (gain <= 0).any():
                raise ModelError("friction eats up what more heat gives", where="friction.peak_pressure_factor")
            heat = (wanted - gas + fixed @ loss) / gain
            if np.allclose(heat, last, rtol=1e-14, atol=0.0):  # at a kink two pieces may take turns for ever
                break
        return heat, fixed + heat[:, None] * rising

    def unfired(self, still: FloatArray) -> FloatArray:
        """Torque without any heat, before the constant friction (B,)."""
        peak = (still @ self.shapes).max(axis=2)
        return np.asarray((still @ self.work) @ self.count - self.peak_factor * self.friction_arm * (peak @ self.count))


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


def refuse_below_motored(wanted: FloatArray, least: FloatArray, speed: FloatArray) -> None:
    """Raise ModelError where less torque is wanted than the motored engine gives."""
    short = wanted < least - 1e-9 * (1.0 + np.abs(least))
    if short.any():
        index = int(np.argmax(short))
        raise ModelError(
            "the mean torque is below that of the motored engine without any fuel",
            where="mean_torque",
            found=f"{wanted[index]:g} Nm at {show_speed(float(speed[index]))}",
            allowed=f"{least[index]:g} Nm and more",
            remedy="engine brakes are not in the built-in cycle; see motored_torque",
        )
