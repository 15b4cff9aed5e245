"""From one line to the next in the middle of a run: nodes that both have keep their speeds, springs their twists.

Where the new line ties nodes that turn at different speeds, they meet as in a plastic impact: no momentum along any
motion that the line allows is lost, energy is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from torsional.numerics.arrays import Array
from torsional.powertrain import Powertrain
from torsional.solvers.transient.starts import MotionState
from torsional.stamps import GROUND, Mass
from torsional.structure import weight_rows
from torsional.system import System, assemble


@dataclass(frozen=True, eq=False)
class Turning:
    """A ``line`` with its ``system``, in a frame of the speed ``frame`` [rad/s] from the time zero on."""

    line: Powertrain
    system: System
    frame: float

    @classmethod
    def of(cls, line: Powertrain, frame: float) -> Turning:
        """The line assembled."""
        return cls(line, assemble(line), frame)

    def masses(self) -> tuple[Array, Array]:
        """Rows of all inertias over the nodes, and their sizes [kgm²]."""
        stamps = [stamp for stamp in self.line.stamps if isinstance(stamp, Mass)]
        settled = [mass.switch if mass.switch and mass.switch.above(self.frame) else mass for mass in stamps]
        return weight_rows(stamps, self.system.nodes), np.array([mass.inertia for mass in settled])

    def speeds(self, deviation: Array) -> Array:
        """Whole speeds of all nodes [rad/s]."""
        return np.asarray(self.system.T @ deviation + self.frame * self.system.speed_ratio)

    def kinetic(self, speeds: Array) -> Array:
        """Kinetic energy [J] of whole speeds (…, nodes)."""
        rows, inertia = self.masses()
        return np.asarray(0.5 * (speeds @ rows.T) ** 2 @ inertia)

    def momentum(self, speeds: Array) -> Array:
        """Momentum [Nms] along the rigid rotation, as at the engine, of whole speeds (…, nodes)."""
        rows, inertia = self.masses()
        return np.asarray((speeds @ rows.T) @ (inertia * (rows @ self.system.speed_ratio)))


def carried_over(state: MotionState, old: Turning, new: Turning, crank: str) -> MotionState:
    """A state of the ``old`` line as one of the ``new``.

    The angle of the ``crank`` stays; where gears mesh at another angle the part behind them is turned as a whole.
    min Σ J (w·ω_new − w·ω_old)² over the speeds that the new line allows.
    """
    before, places = old.speeds(state.speed), _places(old, new)
    speed = _met(new, before[places])
    names = old.system.connections.names
    memory = dict(zip(names, state.memory, strict=False))
    own = [memory.get(name, 0.0) for name in new.system.connections.names]
    kept = np.array([*own, *state.memory[len(names) :]])  # behind them what drives remember, as the engine's friction
    angle = _angles(state, old, new, crank, places)
    return MotionState(state.time, angle, speed, kept, state.integral, state.reference, charge=state.charge)


def _places(old: Turning, new: Turning) -> list[int]:
    """Where the new line's nodes are in the old one."""
    return [old.system.node_index(node) for node in new.system.nodes]


def _met(new: Turning, wanted: Array) -> Array:
    """Speeds of the coordinates, as deviations, after the impact."""
    rows, inertia = new.masses()
    heavy = np.sqrt(inertia)[:, None]
    left = rows @ (wanted - new.frame * new.system.speed_ratio)
    return np.asarray(np.linalg.lstsq(heavy * (rows @ new.system.T), heavy[:, 0] * left, rcond=None)[0])


def _angles(state: MotionState, old: Turning, new: Turning, crank: str, places: list[int]) -> Array:
    """Coordinates with the twists of the old line and the angle of its crank, each node as close as can be to where it
    was."""
    turned = new.frame * state.time * (old.system.speed_ratio[places] - new.system.speed_ratio)
    node = old.system.T[places] @ state.angle + turned
    near = np.linalg.lstsq(new.system.T, node, rcond=None)[0]
    theirs, mine = old.system.connections, new.system.connections
    common = [i for i, name in enumerate(mine.names) if name in theirs.names and _bound(new, name)]
    twist = theirs.weights[[theirs.names.index(mine.names[i]) for i in common]] @ state.angle
    at = new.system.node_index(crank)
    rows = np.vstack([mine.weights[common], new.system.T[at]])
    missing = np.append(twist, node[at]) - rows @ near
    return np.asarray(near + np.linalg.lstsq(rows, missing, rcond=None)[0])


def _bound(new: Turning, name: str) -> bool:
    """Whether a connection holds nodes of the line together: a spring or a law, and not from the ground."""
    c = new.system.connections
    i = c.names.index(name)
    grounded = any(GROUND in s.weights for s in new.line.stamps if s.name == name and not isinstance(s, Mass))
    return bool((c.stiffness[i] > 0 or c.laws[i] is not None) and not grounded)
