"""What happens when: levels over time, starter, governors, shares of heat; plain values, no time step taken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from torsional.errors import ModelError
from torsional.files.scenario_blocks import SpeedGovernor, Starter
from torsional.model import Model
from torsional.solvers.transient.acting import Acting, Drive, Source
from torsional.solvers.transient.cylinders import CylinderTorques
from torsional.solvers.transient.drives import Governor, TorqueHistory, all_acting
from torsional.solvers.transient.profiles import Level
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.system import System
from torsional.units import show

LET_GO = 1e-3
"""Time [s] within which a line that was held back is free to accelerate."""

Knots = tuple[tuple[float, ...], tuple[float, ...]]
"""Times [s] and values, straight lines between them; a jump is two knots at one time."""

KEEPING = (60.0, 0.5)
"""Droop [rad/s] and reset time [s] of the governor of an idling engine."""
NEVER = -1e4
"""A speed [rad/s] that is wanted while a governor shall give nothing."""


def ramp(at: float, within: float, before: float, after: float) -> Knots:
    """A value that changes in a straight line, beginning ``at`` [s], ``within`` [s].

    >>> ramp(0.3, 0.05, 0.0, 1.0)
    ((0.3, 0.35), (0.0, 1.0))
    """
    return (at, at + within), (before, after)


def pulse(at: float, length: float, height: float, rest: float = 0.0) -> Knots:
    """A value that is ``height`` from ``at`` [s] on for ``length`` [s], and ``rest`` otherwise.

    >>> pulse(1.0, 0.5, 7.0)
    ((1.0, 1.0, 1.5, 1.5), (0.0, 7.0, 7.0, 0.0))
    """
    return (at, at, at + length, at + length), (rest, height, height, rest)


def starter_motor(block: Starter, crank: str, torque: float) -> Governor:
    """The starter: T = ``torque`` (1 − speed/free speed) between nought and the torque at standstill, until it is off.

    It pushes and never brakes: the pinion runs free above its speed.
    """
    wanted = SpeedProfile((0.0, block.until, block.until), (block.speed, block.speed, NEVER))
    slope = torque / block.speed
    return Governor(crank, wanted, acts_on=crank, proportional=slope, low=0.0, high=torque)


def speed_governor(block: SpeedGovernor, crank: str, wanted: float, start: float = 0.0) -> Governor:
    """What adds heat as a share of that for the governor's torque, from ``start`` [s] on: (1 + 1/(reset s))/droop."""
    knots = SpeedProfile((0.0, start, start), (NEVER, NEVER, wanted)) if start > 0 else SpeedProfile.constant(wanted)
    gain = 1.0 / block.droop
    return Governor(crank, knots, proportional=gain, integral=gain / block.reset, low=0.0, high=1.0)


def idle_keeper(crank: str, wanted: float, share: float) -> Governor:
    """What trims the heat of an idling engine, ``share`` of its most, so slowly that it does not follow vibrations."""
    gain = 1.0 / KEEPING[0]
    return Governor(crank, wanted, proportional=gain, integral=gain / KEEPING[1], low=-share, high=1.0 - share)


def fuel_cut(crank: str, below: float, width: float) -> Governor:
    """What takes all heat away while the speed is ``width`` [rad/s] and more under ``below``; nothing above it."""
    return Governor(crank, below, proportional=-1.0 / width, low=-1.0, high=0.0)


def cylinders(model: Model, speed: float, torque: float, level: Knots) -> CylinderTorques:
    """The engine at a speed [rad/s], its heat the ``level`` times that of the mean ``torque`` [Nm]."""
    times, values = level
    return CylinderTorques.of(model, speed, torque, level=values, level_times=times)


def heat_for(model: Model, speed: float, torques: Sequence[float]) -> tuple[float, tuple[float, ...]]:
    """The highest of some mean torques [Nm], and for each the share of its heat that gives it at a speed [rad/s].

    Heat grows the torque in proportion from that of the motored engine on.  Raises ModelError for a torque below that.
    """
    least, most = float(model.running_engine.motored_torque(speed)), max(torques)
    for torque in torques:
        if torque < least:
            allowed = f"{show(least, 'torque')} and more, which is the motored engine"
            raise ModelError("no engine brakes so much", found=show(torque, "torque"), allowed=allowed)
    most = most if most > least + 1.0 else least + 1.0
    return most, tuple((torque - least) / (most - least) for torque in torques)


def torque_pulse(node: str, at: float, length: float, height: float) -> TorqueHistory:
    """A torque [Nm] at a node from ``at`` [s] on for ``length`` [s]."""
    return TorqueHistory(node, *pulse(at, length, height))


@dataclass(frozen=True, eq=False)
class HeldBack:
    """What keeps a line from accelerating under the mean torques of some ``drives`` up to the time zero.

    It acts on every mass in proportion to its inertia, as its own acceleration does from there on, so that springs
    are twisted beforehand as they are afterwards: −M 1 a, a = Σ torque / Σ M.
    """

    drives: tuple[Drive, ...]

    def acting(self, system: System, speed: SpeedProfile) -> Acting:
        """One source along the momentum of the rigid rotation."""
        told = all_acting(self.drives, system, speed)
        mean = sum(float(row.sum() * level.at(0.0)) for row, level in told.taken_up)
        row = np.asarray(system.M.sum(axis=1))
        return Acting((Source(row, level=Level(np.array([0.0, LET_GO]), np.array([-mean / row.sum(), 0.0]))),))
