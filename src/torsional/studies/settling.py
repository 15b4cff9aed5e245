"""Where runs by time steps end up: a witness of the claims beside harmonic balance and the exact motion in time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from torsional.engine import Excitation
from torsional.engine.orders import HIGHEST_ORDER
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.numerics.piecewise.motion import PiecewiseMotion
from torsional.solvers.transient import MotionState, OrderTorques, TorqueHistory, engine_drive, steady_state, transient
from torsional.system import System, assemble

STEP = 5e-5
"""Longest time step [s]: half of it changes no amplitude that the claims ask for by more than 0.1 %."""
REPEATING = 1e-7
"""Share of a motion's size within which it must repeat itself: what dies out slowly, by 1 % a period, has a hundred
times that to go."""


@dataclass(frozen=True, eq=False)
class Stepped:
    """A line under a ``drive`` at one speed, stepped in time; ``hold``: the node that takes up the mean torque.

    ``longest`` time step [s]; ``patience``: periods that a motion is given to repeat itself.
    """

    system: System
    drive: Excitation
    hold: str = ""
    longest: float = STEP
    patience: int = 3000

    @classmethod
    def of(
        cls, model: Model, speed: float, torque: float, highest_order: float = HIGHEST_ORDER, **options: Any
    ) -> Stepped:
        """A model in its top gear at a ``speed`` [rad/s] and mean ``torque`` [Nm]."""
        drive = engine_drive(model, speed, torque, highest_order)
        return cls(assemble(model.powertrain()), drive, model.landmarks.load, **options)

    @property
    def speed(self) -> float:
        """The mean speed [rad/s]."""
        return float(np.ravel(self.drive.speed)[0])

    @property
    def period(self) -> float:
        """Period of the drive's lowest order [s]."""
        return float(2 * np.pi / (self.drive.orders[self.drive.orders > 0].min() * self.speed))

    @property
    def step(self) -> float:
        """The time step [s], a whole number of which makes a period."""
        return self.period / float(np.ceil(self.period / self.longest))

    def begun(self, timed: PiecewiseMotion, state: Array) -> MotionState:
        """A state of the exact motion in time, at the crank angle zero, as a start; friction remembers nothing."""
        base = timed.bases.coordinates
        return MotionState.at_rest(self.system).moved(base.angles(state), base.rates(state))

    def settled(self, start: object = "equilibrium") -> xr.Dataset:
        """The steady motion that a run ends on, in orders."""
        limits: dict[str, Any] = {"tolerance": REPEATING, "most_periods": self.patience, "thorough": False}
        return steady_state(self.system, self.drive, hold=self.hold, start=start, step=self.step, **limits)

    def run(self, start: object, periods: int, *pulses: TorqueHistory) -> xr.Dataset:
        """The motion over some periods of the drive, with ``pulses`` besides."""
        drives: list[OrderTorques | TorqueHistory] = [OrderTorques(self.drive), *pulses]
        return transient(self.system, drives, periods * self.period, start, hold=self.hold, step=self.step)

    def friction_power(self, start: object, periods: int) -> float:
        """Mean power [W] that laws with a memory take up over some periods, from the ledger of energy."""
        taken = self.run(start, periods).energy.sel(share="friction")
        return float((taken[-1] - taken[0]) / (periods * self.period))


def order_of(found: xr.Dataset, element: str, order: float) -> float:
    """0-peak of one order of an element's twist [rad] in a steady motion."""
    return float(abs(found.twist.sel(element=element, order=order).item()))


def swing_of(run: xr.Dataset, node: str) -> float:
    """Half the swing of a node's speed [rad/s] over a run."""
    return float(np.ptp(run.angular_velocity.sel(node=node).values) / 2)


def reach_of(run: xr.Dataset, element: str) -> tuple[float, float]:
    """Smallest and largest twist [rad] of an element over a run."""
    twist = run.twist.sel(element=element)
    return float(twist.min()), float(twist.max())
