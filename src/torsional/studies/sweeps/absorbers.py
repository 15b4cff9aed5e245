"""Analyses of absorbers for plans: the worst within full load with twists and losses, inertia as installation space,
friction in the clutch."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from torsional.errors import ModelError
from torsional.files.scenario_blocks import GearName
from torsional.files.schema.fields import Node, Order, Speed
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import labelled
from torsional.stamps import Mass
from torsional.studies.answers import main_order
from torsional.studies.down_speeding import LOADS, Bench, half_swing, looked_at
from torsional.studies.friction import WASHER, answered
from torsional.studies.sweeps.analyses import Asking, SpeedRange
from torsional.studies.sweeps.batch import Batch
from torsional.studies.sweeps.envelopes import Envelope, spring_ways
from torsional.system import BoolArray
from torsional.units import RPM


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

    gives: ClassVar[Mapping[str, str]] = {
        "acceleration_swing": "acceleration",
        "twist": "relative_angle",
        "reach": "ratio",
        "loss": "power",
    }

    def __call__(self, model: Model) -> xr.Dataset:
        """Half the swing of the ``acceleration_swing`` at the gearbox input by gear and speed, the largest over mean
        torques; of every spring of the absorber, and of its pendulum, the largest ``twist``, mean and vibration
        together, its ``reach`` (over the way to the stop, or along the path; 0 without) and the largest mean power that
        its damper takes (``loss``)."""
        ways = spring_ways(model)
        bench = Bench(
            model, loads=self.loads, orders=self.orders, stops=ways, gears=self.gears, speed=self.speeds(model)
        )
        found, twist, loss = bench.answers()
        reach = twist[0] / np.array(list(ways.values()))
        return self._told((), model, half_swing(found[0], bench.orders).max(axis=1), (twist[0], reach, loss[0]))

    def possible(self, batch: Batch) -> bool:
        """Whether designs can be asked together: what changes a pendulum's path cannot."""
        paths = [name.split(".") for name in batch.designs.axes]
        kept = all(steps[:2] != ["absorber", "pendulum"] or steps[-1] in ("mass", "damping") for steps in paths)
        return kept and all(batch.answers(gear) for gear in self._gears(batch.model))

    def covers(self, batch: Batch, columns: Mapping[str, Any]) -> BoolArray:
        """Which of them."""
        return np.asarray(np.all([batch.covers(gear, columns) for gear in self._gears(batch.model)], axis=0))

    def many(self, batch: Batch, columns: Mapping[str, Any]) -> xr.Dataset:
        """The same of many designs."""
        model, speeds = batch.model, self.speeds(batch.model)
        orders = np.array(self.orders or [main_order(model)], dtype=float)
        torque = np.multiply.outer(np.array(self.loads), model.full_load(speeds))
        envelope = Envelope(batch, list(spring_ways(model)), speeds, torque, orders)
        size, springs = envelope.answers(self._gears(model), columns)
        return self._told(("design",), model, size, springs)

    def _gears(self, model: Model) -> list[str]:
        return list(self.gears or model.gear_names)

    def _told(
        self, front: tuple[str, ...], model: Model, size: Array, springs: tuple[Array, Array, Array]
    ) -> xr.Dataset:
        each = (*front, "element")
        twist, reach, loss = springs
        data = labelled(
            {
                "acceleration_swing": ((*front, "gear", "speed"), size, "acceleration"),
                "twist": (each, twist, "relative_angle"),
                "reach": (each, reach, "ratio"),
                "loss": (each, loss, "power"),
            },
            {
                "gear": (np.array(self._gears(model)), ""),
                "speed": (self.speeds(model), "speed"),
                "element": (np.array(list(spring_ways(model)), dtype=str), ""),
            },
            analysis="envelope",
        )
        data.acceleration_swing.attrs["amplitude"] = "half peak-to-peak"
        return data

    def speeds(self, model: Model) -> Array:
        """The speeds [rad/s] asked."""
        if self.speed is None:
            return looked_at(model, self.step)
        low, high, *step = self.speed
        return np.arange(low, high + 1e-9 * high, step[0] if step else self.step)


class InertiaRun(Asking):
    """What the absorber needs of installation space: the moment of inertia of all its bodies."""

    analysis: Literal["inertia"]
    gives: ClassVar[Mapping[str, str]] = {"inertia": "inertia"}

    def __call__(self, model: Model) -> xr.Dataset:
        """The ``inertia`` of flywheels, flange and absorber rings, planets by spin, pendulums at their distance."""
        if model.absorber is None:
            raise ModelError("the model has no absorber block", where="absorber")
        parts = {name: model.components.get(name, part) for name, part in model.absorber.components.items()}
        masses = [stamp for name, part in parts.items() for stamp in part.stamps(name) if isinstance(stamp, Mass)]
        return _whole((), float(sum(mass.inertia for mass in masses)))

    def possible(self, batch: Batch) -> bool:
        """Whether designs can be asked together."""
        return batch.model.absorber is not None and batch.answers(batch.model.gear_name(None))

    def covers(self, batch: Batch, columns: Mapping[str, Any]) -> BoolArray:
        """Which of them."""
        return batch.covers(batch.model.gear_name(None), columns)

    def many(self, batch: Batch, columns: Mapping[str, Any]) -> xr.Dataset:
        """The same of many designs."""
        model = batch.model
        assert model.absorber is not None  # possible
        system, tables, _ = batch.numbers(model.gear_name(None), columns)
        own = {s.name for name, part in model.absorber.components.items() for s in part.stamps(name)}
        places = [place for place, name in enumerate(system.masses.names) if name in own]
        return _whole(("design",), tables["inertia"][:, places].sum(axis=1))


def _whole(front: tuple[str, ...], inertia: Any) -> xr.Dataset:
    return labelled({"inertia": (front, inertia, "inertia")}, {}, analysis="inertia")


class FrictionRun(Asking):
    """What a friction washer beside the clutch damper does over speed: the firing order by harmonic balance."""

    analysis: Literal["friction"]
    speed: SpeedRange | None = Field(None, description="default: the lowest speed to three quarters of the highest")
    element: Node = Field(WASHER, description="the connection that rubs")

    gives: ClassVar[Mapping[str, str]] = {
        "peak": "acceleration",
        "peak_speed": "speed",
        "far": "acceleration",
        "power": "power",
        "far_power": "power",
    }

    def __call__(self, model: Model) -> xr.Dataset:
        """Largest acceleration at the gearbox input (``peak``, half peak-to-peak) and its speed, that at the highest
        speed (``far``), mean power [W] lost in the washer at both; top gear, 60 % of the full-load peak."""
        found = answered(model, self.ends(model), self.element)
        peak, at = found.peak
        values = {
            "peak": (peak, "acceleration"),
            "peak_speed": (at, "speed"),
            "far": (float(found.amplitude[-1]), "acceleration"),
            "power": (found.at(at, found.power), "power"),
            "far_power": (float(found.power[-1]), "power"),
        }
        return labelled({name: ((), v, quantity) for name, (v, quantity) in values.items()}, {}, analysis="friction")

    def ends(self, model: Model) -> tuple[float, float]:
        """The speeds [rad/s] between which it is asked."""
        low, high = model.operation.speed
        return (low, 0.75 * high) if self.speed is None else (self.speed[0], self.speed[1])
