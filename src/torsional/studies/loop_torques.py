"""What a system would have shown in measured loops: torques along their angles, and what errors of these do to them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache

import numpy as np

from torsional.numerics.arrays import Array
from torsional.solvers.hysteresis import followed
from torsional.studies.estimates import Measured
from torsional.studies.records import Record
from torsional.system import System

TORQUE_OFFSET, ANGLE_OFFSET = "torque_offset", "angle_offset"
"""What the sensors tell too much: parameters of the rig, not of the flywheel."""
ENLARGED = 2.0
"""Errors are tried so many times larger than they are, as far as slopes reach: friction bends what is smaller than its
own steps, and what is farther away."""
Making = Callable[[Mapping[str, float]], System]


class LoopTorques:
    """The torques that a system, ``made`` of parameters by name, would have shown in measured loops between two
    nodes, the first one turned; in so many ``steps`` of a cycle.

    The offsets of the sensors are parameters too where they are named.
    """

    def __init__(self, made: Making, ends: tuple[str, str], loops: Sequence[Record], steps: int) -> None:
        self.made, self.ends, self.loops, self.steps = made, ends, loops, steps
        self._along = lru_cache(maxsize=2)(self._followed)

    def __call__(self, values: Mapping[str, float]) -> list[Array]:
        """The torques [Nm] at the clear instants of every loop."""
        own = {name: value for name, value in values.items() if name not in (TORQUE_OFFSET, ANGLE_OFFSET)}
        torques = self._along(tuple(own.items()), values.get(ANGLE_OFFSET, 0.0))
        return [torque + values.get(TORQUE_OFFSET, 0.0) for torque in torques]

    def extrapolated(self, values: Mapping[str, float]) -> list[Array]:
        """The same without what the steps leave, as far as that goes with them: 2 T(h/2) − T(h).

        L. F. Richardson, Phil. Trans. R. Soc. A 226 (1927) 299.
        """
        half = LoopTorques(self.made, self.ends, self.loops, 2 * self.steps)
        return [2.0 * short - long for long, short in zip(self(values), half(values), strict=True)]

    def errors(self, values: Mapping[str, float]) -> list[Array]:
        """What the encoders' noise does to them, an array (samples, errors) for each loop: changes [Nm] by one standard
        deviation of each error of the angle's waves."""
        base = self(values)
        own = {name: value for name, value in values.items() if name not in (TORQUE_OFFSET, ANGLE_OFFSET)}
        offset, zero = values.get(ANGLE_OFFSET, 0.0), values.get(TORQUE_OFFSET, 0.0)
        system = self.made(own)
        changes = []
        for loop, exact in zip(self.loops, base, strict=True):
            courses = [loop.course(self.steps, offset, ENLARGED * error) for error in loop.swing_errors]
            moved = followed(system, *self.ends, courses)
            changes.append(np.column_stack([loop.of_cycle(each.torque) + zero - exact for each in moved]) / ENLARGED)
        return changes

    def _followed(self, values: tuple[tuple[str, float], ...], offset: float) -> list[Array]:
        courses = [loop.course(self.steps, offset) for loop in self.loops]
        found = followed(self.made(dict(values)), *self.ends, courses)
        return [loop.of_cycle(each.torque) for loop, each in zip(self.loops, found, strict=True)]


def torques_in(loops: Sequence[Record]) -> list[Measured]:
    """The torques of measured loops where they do not jump, each over its own noise."""
    return [Measured(loop.name, loop.torque[loop.clear], loop.noise) for loop in loops]
