"""Friction of turning parts against their own whole speed: it turns round with them and holds them at standstill."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from torsional.laws import LuGre
from torsional.numerics.arrays import Array
from torsional.system import Connections, System

YIELD = 0.002
"""Twist [rad] by which a part at rest gives way before its friction slides."""
RINGING = 0.001
"""Damping of friction that sticks over its stiffness [s]."""


class Drag(NamedTuple):
    """Dry friction ``torque`` [Nm] and ``damping`` [Nms/rad] from the ground along a ``row``, on its whole speed.

    ``mean``: what it takes at the time zero [Nm].
    """

    name: str
    row: Array
    torque: float
    damping: float
    mean: float

    @property
    def law(self) -> LuGre | None:
        """Bristles without a drop from sticking to sliding; none for friction without a dry part."""
        if not self.torque > 0:
            return None
        bristles, held = (self.torque / YIELD, RINGING * self.torque / YIELD), (self.torque, self.torque)
        return LuGre(*bristles, *held, stribeck_rate=1.0, grease_damping=self.damping)

    def memory(self, speed: Array, frame_speed: float) -> float:
        """Deflection [rad] of bristles that slide, the coordinates having a ``speed`` beside the frame's [rad/s]."""
        return YIELD * float(np.sign(self.row @ speed + self.row.sum() * frame_speed))


def taken(torque: float, damping: float, rate: ArrayLike) -> Array:
    """Torque [Nm] that dry friction and damping take at constant rates [rad/s].

    >>> taken(60.0, 0.5, np.array([-100.0, 0.0, 100.0])).tolist()
    [-110.0, 0.0, 110.0]
    """
    turning = np.asarray(rate, dtype=float)
    return np.asarray(torque * np.sign(turning) + damping * turning)


def dragged(system: System, drags: Sequence[Drag]) -> System:
    """The system with friction as further connections behind its own."""
    if not drags:
        return system
    c, none = system.connections, np.zeros(len(drags))
    laws = tuple(drag.law for drag in drags)
    more = Connections(
        names=tuple(_free(drag.name, c.names) for drag in drags),
        weights=np.concatenate([c.weights, [drag.row for drag in drags]]),
        stiffness=np.append(c.stiffness, none),
        damping=np.append(c.damping, [0.0 if drag.law else drag.damping for drag in drags]),
        loss_factor=np.append(c.loss_factor, none),
        centrifugal_stiffness=np.append(c.centrifugal_stiffness, none),
        laws=c.laws + laws,
        loads=c.loads + (None,) * len(drags),
        whole_speed=np.append(c.whole_speed, np.ones(len(drags), dtype=bool)),
        swings=c.swings + (None,) * len(drags),
    )
    return dataclasses.replace(system, connections=dataclasses.replace(more, names=c.names + more.names))


def _free(name: str, known: Sequence[str]) -> str:
    """The name, made longer until it is its own."""
    while name in known:
        name += "_"
    return name
