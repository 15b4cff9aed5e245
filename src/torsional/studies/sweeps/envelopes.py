"""The worst within full load of many designs together: what `Bench` tells of one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from torsional.absorbers import CentrifugalPendulum
from torsional.laws import Hinges
from torsional.laws.hinges import hinge_angles
from torsional.model import Model
from torsional.numerics.arrays import Array, ComplexArray
from torsional.studies.down_speeding import half_swing, travels
from torsional.studies.sweeps.batch import Asked, Batch
from torsional.studies.swinging import way
from torsional.system import System


@dataclass(frozen=True)
class Envelope:
    """Designs of a ``batch`` at ``speeds`` (speeds,) and mean ``torque`` (loads, speeds), by ``orders``, with the
    twists of ``springs``."""

    batch: Batch
    springs: Sequence[str]
    speeds: Array
    torque: Array
    orders: Array

    def answers(self, gears: Sequence[str], columns: Mapping[str, Any]) -> tuple[Array, tuple[Array, Array, Array]]:
        """The largest half swing (designs, gears, speeds); largest twist, reach and loss of springs (designs, springs)
        in any of the gears."""
        each = [self._one_gear(gear, columns) for gear in gears]
        springs = [np.max([found[1][which] for found in each], axis=0) for which in range(3)]
        return np.stack([found[0] for found in each], axis=1), (springs[0], springs[1], springs[2])

    def _one_gear(self, gear: str, columns: Mapping[str, Any]) -> tuple[Array, tuple[Array, Array, Array]]:
        model, loads = self.batch.model, len(self.torque)
        ends = {n: stamp.weights for stamp in model.powertrain(gear).stamps if (n := stamp.name) in self.springs}
        nodes = list(dict.fromkeys((model.landmarks.input, *(node for w in ends.values() for node in w))))
        asked = Asked(np.tile(self.speeds, loads), self.torque.ravel(), self.orders, tuple(nodes), grid=False)
        found = self.batch.angles(gear, asked, columns)
        shape = (len(found), loads, self.speeds.size, self.orders.size)
        omega = np.multiply.outer(self.speeds, self.orders)
        size = half_swing(-np.square(omega) * found[:, 0].reshape(shape), self.orders).max(axis=1)
        twist, reach, loss = (np.zeros((len(found), len(self.springs))) for _ in range(3))
        for place, name in enumerate(self.springs):
            weights = np.array([ends[name].get(node, 0.0) for node in nodes])
            swing = np.einsum("n,dnso->dso", weights, found).reshape(shape)
            told = self._spring(gear, name, swing, columns)
            twist[:, place], reach[:, place], loss[:, place] = told
        return size, (twist, reach, loss)

    def _spring(
        self, gear: str, name: str, swing: ComplexArray, columns: Mapping[str, Any]
    ) -> tuple[Array, Array, Array]:
        """Largest twist, reach and loss of one spring, (designs,) each."""
        system, tables, laws = self.batch.numbers(gear, columns)
        place = system.connections.names.index(name)
        mean = self._mean(gear, system, place, laws.get(place)).reshape(-1, *self.torque.shape)
        largest = (np.abs(mean) + np.abs(swing).sum(axis=-1)).max(axis=(1, 2))
        omega = np.multiply.outer(self.speeds, self.orders)
        lost = (np.abs(omega * swing) ** 2).sum(axis=-1).max(axis=(1, 2))
        power = 0.5 * tables["damping"][:, place] * lost
        return largest, largest / self._way(name, laws.get(place)), power

    def _mean(self, gear: str, system: System, place: int, rows: Array | None) -> Array:
        """Mean twists (designs or 1, states); statics give every design the same mean torques."""
        state = self.batch.state(gear, self.torque.ravel())
        if rows is None or not isinstance(system.connections.laws[place], Hinges):
            return np.asarray(state.angle[None, :, place])
        return hinge_angles(rows, state.torque[:, place])

    def _way(self, name: str, rows: Array | None) -> Any:
        """The way to the stop, the outermost hinge of a law that has one; that of a pendulum's path."""
        if rows is not None and name in travels(self.batch.model):
            return rows[:, 1::3].max(axis=1)
        return spring_ways(self.batch.model)[name]


def spring_ways(model: Model) -> dict[str, float]:
    """The springs of the absorber and its pendulum: way to the stop [rad], of a pendulum to the end of its path."""
    ways = dict.fromkeys(model.landmarks.springs, float("inf")) | travels(model)
    for name, part in model.components.items():
        if isinstance(part, CentrifugalPendulum) and part.count == 1:
            ways[f"{name}.suspension"] = way(part) / part.distance
    return ways
