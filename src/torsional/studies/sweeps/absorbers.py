"""Analyses of absorbers for plans: the worst within full load with twists and losses, inertia as installation space,
friction in the clutch."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from torsional.absorbers import CentrifugalPendulum
from torsional.errors import ModelError
from torsional.files.scenario_blocks import GearName
from torsional.files.schema.fields import Node, Order, Quantity, Speed
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import labelled
from torsional.stamps import Mass
from torsional.studies.down_speeding import LOADS, Bench, half_swing, looked_at, travels
from torsional.studies.friction import WASHER, answered
from torsional.studies.sweeps.analyses import Asking, SpeedRange
from torsional.studies.swinging import way
from torsional.units import RPM

Torque = Annotated[float, Quantity("torque", least=0)]


class EnvelopeRun(Asking):
    """The worst within full load: what the node behind the clutch and the springs of the absorber do at the mean torque
    and in the gear that is worst."""

    analysis: Literal["envelope"]
    gears: list[GearName] = Field(default_factory=list, description="default: all of them")
    speed: SpeedRange | None = Field(None, description="default: the operating range")
    step: Speed = Field(25 * RPM, description="between speeds, where the range tells none")
    loads: list[Annotated[float, Field(ge=0, le=1)]] = Field(
        default_factory=lambda: list(LOADS), description="mean torques over full load", min_length=1
    )
    orders: list[Order] = Field(default_factory=list, description="default: the main order")

    gives = ("acceleration_swing", "twist", "reach", "loss")

    def __call__(self, model: Model) -> xr.Dataset:
        """Half the swing of the ``acceleration_swing`` at the gearbox input by gear and speed, the largest over mean
        torques; of every spring of the absorber, and of its pendulum, the largest ``twist``, mean and vibration
        together, its ``reach`` (over the way to the stop, or along the path; 0 without) and the largest mean power that
        its damper takes (``loss``)."""
        ways = spring_ways(model)
        bench = Bench(model, loads=self.loads, orders=self.orders, stops=ways, gears=self.gears, speed=self._at(model))
        found, twist, loss = bench.answers()
        data = labelled(
            {
                "acceleration_swing": (
                    ("gear", "speed"),
                    half_swing(found[0], bench.orders).max(axis=1),
                    "acceleration",
                ),
                "twist": (("element",), twist[0], "relative_angle"),
                "reach": (("element",), twist[0] / np.array(list(ways.values())), "ratio"),
                "loss": (("element",), loss[0], "power"),
            },
            {
                "gear": (np.array(bench.gears), ""),
                "speed": (bench.speed, "speed"),
                "element": (np.array(list(ways), dtype=str), ""),
            },
            analysis="envelope",
        )
        data.acceleration_swing.attrs["amplitude"] = "half peak-to-peak"
        return data

    def _at(self, model: Model) -> Array:
        if self.speed is None:
            return looked_at(model, self.step)
        low, high, *step = self.speed
        return np.arange(low, high + 1e-9 * high, step[0] if step else self.step)


class InertiaRun(Asking):
    """What the absorber needs of installation space: the moment of inertia of all its bodies."""

    analysis: Literal["inertia"]
    gives = ("inertia",)

    def __call__(self, model: Model) -> xr.Dataset:
        """The ``inertia`` of flywheels, flange and absorber rings, planets by spin, pendulums at their distance."""
        if model.absorber is None:
            raise ModelError("the model has no absorber block", where="absorber")
        parts = {name: model.components.get(name, part) for name, part in model.absorber.components.items()}
        masses = [stamp for name, part in parts.items() for stamp in part.stamps(name) if isinstance(stamp, Mass)]
        return labelled(
            {"inertia": ((), float(sum(mass.inertia for mass in masses)), "inertia")}, {}, analysis="inertia"
        )


class FrictionRun(Asking):
    """What a friction washer beside the clutch damper does over speed: the firing order by harmonic balance."""

    analysis: Literal["friction"]
    speed: SpeedRange | None = Field(None, description="default: the lowest speed to three quarters of the highest")
    element: Node = Field(WASHER, description="the connection that rubs")

    gives = ("peak", "peak_speed", "far", "power", "far_power")

    def __call__(self, model: Model) -> xr.Dataset:
        """Largest acceleration at the gearbox input (``peak``, half peak-to-peak) and its speed, that at the highest
        speed (``far``), mean power [W] lost in the washer at both; top gear, 60 % of the full-load peak."""
        low, high = model.operation.speed
        ends = (low, 0.75 * high) if self.speed is None else self.speed[:2]
        found = answered(model, (ends[0], ends[1]), self.element)
        peak, at = found.peak
        values = {
            "peak": (peak, "acceleration"),
            "peak_speed": (at, "speed"),
            "far": (float(found.amplitude[-1]), "acceleration"),
            "power": (found.at(at, found.power), "power"),
            "far_power": (float(found.power[-1]), "power"),
        }
        return labelled({name: ((), v, quantity) for name, (v, quantity) in values.items()}, {}, analysis="friction")


def spring_ways(model: Model) -> dict[str, float]:
    """The springs of the absorber and its pendulum: way to the stop [rad], of a pendulum to the end of its path."""
    ways = dict.fromkeys(model.landmarks.springs, float("inf")) | travels(model)
    for name, part in model.components.items():
        if isinstance(part, CentrifugalPendulum) and part.count == 1:
            ways[f"{name}.suspension"] = way(part) / part.distance
    return ways
