"""What a sweep may ask of every design: a block of the plan whose keys are the analysis' settings, and its answer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal, TypeAlias

import numpy as np
import xarray as xr
from pydantic import Field, PrivateAttr

from torsional.errors import ModelError
from torsional.files.scenario_blocks import GearName, Scenario
from torsional.files.schema.fields import Block, Node, Order, Quantity, Torque, Whole
from torsional.model import Model
from torsional.numerics.arrays import Array, size
from torsional.numerics.elimination.backends import backend
from torsional.quantities import acceleration
from torsional.results import labelled
from torsional.solvers.map import response_map
from torsional.solvers.modal import damped_frequencies, natural_frequencies
from torsional.solvers.operating import at_operating_point
from torsional.solvers.run_up import run_up_response
from torsional.studies.down_speeding import half_swing
from torsional.studies.scenarios.peaks import spring_peaks
from torsional.studies.sweeps.batch import Asked, Batch
from torsional.system import BoolArray, System

SpeedRange = Annotated[tuple[float, ...], Quantity("speed", above=0, shape="range")]
POINTS = 57


class Asking(Block):
    """What a plan asks, as plain values: the ``settings`` that tell one sweep from another."""

    gives: ClassVar[Mapping[str, str]] = {}
    """The figures of its answer with their quantities, where they are known beforehand."""

    @property
    def settings(self) -> dict[str, Any]:
        """All keys with their values in SI."""
        return self.model_dump(mode="json")


class OverSpeed(Asking):
    """What analyses over speed share: which speeds, in which gear, where."""

    gear: GearName = Field("", description="engaged; default: the last listed")
    speed: SpeedRange | None = Field(None, description="default: the operating range in 57 points")
    node: Node = Field("", description="default: the one to be kept quiet")

    def speeds(self, model: Model) -> Array:
        """The speeds [rad/s] asked."""
        if self.speed is None:
            return model.speeds(POINTS)
        low, high, *step = self.speed
        return np.arange(low, high + 1e-9 * high, step[0]) if step else np.linspace(low, high, POINTS)

    def place(self, model: Model) -> str:
        """The node asked."""
        place = self.node or model.landmarks.input
        if not place:
            raise ModelError("the model names no node to be kept quiet", where="run.node", remedy="name one")
        return place


class Linear(OverSpeed):
    """What the linear analyses share beyond that: orders, and designs that are asked together."""

    orders: list[Order] = Field(default_factory=list, description="default: the main order")
    backend: Literal["", "numpy", "jax", "cupy"] = Field(
        "", description="array library that asks many designs together, as on a GPU; default: the compiled kernel"
    )

    def asked_orders(self, model: Model) -> Array:
        """The orders asked."""
        return np.array(self.orders or model.engine_orders(1), dtype=float)

    def gears_asked(self, model: Model) -> list[str]:
        """The gears that are engaged one after the other."""
        return [model.gear_name(self.gear or None)]

    def possible(self, batch: Batch) -> bool:
        """Whether designs can be asked together; raises ModelError where the array library is not there."""
        if self.backend:
            backend(self.backend)
        return all(batch.answers(gear) for gear in self.gears_asked(batch.model))

    def covers(self, batch: Batch, columns: Mapping[str, Any]) -> BoolArray:
        """Which of them."""
        return np.asarray(np.all([batch.covers(gear, columns) for gear in self.gears_asked(batch.model)], axis=0))


class ModesRun(Asking):
    """Natural frequencies: the lowest ``count`` elastic modes in one gear."""

    gives: ClassVar[Mapping[str, str]] = {
        "frequency": "frequency",
        "damped_ratio": "damping_ratio",
        "order_speed": "speed",
    }
    analysis: Literal["modes"]
    gear: GearName = Field("", description="engaged; default: the last listed")
    torque: Torque | None = Field(None, description="mean; default: that of most of the operating range")
    count: Whole = Field(6, description="of elastic modes told")

    def __call__(self, model: Model) -> xr.Dataset:
        """Their ``frequency``, ``damped_ratio``, ``order_speed`` of the main order; no number where there are fewer."""
        system, _ = at_operating_point(model, self._mean(model), self.gear or None)
        return self._told(("mode",), self._modes(system), model)

    def possible(self, batch: Batch) -> bool:
        """Whether designs can be asked together."""
        return batch.answers(batch.model.gear_name(self.gear or None))

    def covers(self, batch: Batch, columns: Mapping[str, Any]) -> BoolArray:
        """Which of them."""
        return batch.covers(batch.model.gear_name(self.gear or None), columns)

    def many(self, batch: Batch, columns: Mapping[str, Any]) -> xr.Dataset:
        """The same of many designs."""
        model = batch.model
        systems = batch.systems(model.gear_name(self.gear or None), self._mean(model), columns)
        return self._told(("design", "mode"), np.stack([self._modes(system) for system in systems]), model)

    def _mean(self, model: Model) -> float:
        return model.typical_torque() if self.torque is None else self.torque

    def _modes(self, system: System) -> Array:
        """Natural frequencies [rad/s] and the damping ratios of the damped modes next to them, (count, 2)."""
        omega = natural_frequencies(system)
        omega = omega[omega > 0][: self.count]
        damped, ratio = damped_frequencies(system)
        nearest = abs(damped - omega[:, None]).argmin(axis=1)
        found = np.full((self.count, 2), np.nan)
        found[: omega.size] = np.column_stack([omega, ratio[nearest]])
        return found

    def _told(self, dims: tuple[str, ...], found: Array, model: Model) -> xr.Dataset:
        orders = model.engine_orders(1)
        main = orders[0] if len(orders) else np.nan
        values = {
            "frequency": (found[..., 0] / (2 * np.pi), "frequency"),
            "damped_ratio": (found[..., 1], "damping_ratio"),
            "order_speed": (found[..., 0] / main, "speed"),
        }
        return labelled(
            {name: (dims, v, quantity) for name, (v, quantity) in values.items()},
            {"mode": (np.arange(self.count), "")},
            analysis="modes",
        )


class ResponseRun(Linear):
    """Order response over speed at full load, or under one mean torque."""

    gives: ClassVar[Mapping[str, str]] = {"acceleration": "acceleration"}
    analysis: Literal["response"]
    torque: Torque | None = Field(None, description="mean; default: full load")

    def __call__(self, model: Model) -> xr.Dataset:
        """The ``acceleration`` of a node, 0-peak, over speed and order."""
        speeds = self.speeds(model)
        mean = model.full_load(speeds) if self.torque is None else np.full(speeds.size, self.torque)
        found = run_up_response(model, speeds, mean, self.gear or None, self.asked_orders(model))
        size = abs(acceleration(found.angle.sel(node=self.place(model)))).transpose("speed", "order")
        return self._told(("speed", "order"), size.values, speeds, found.order.values)

    def many(self, batch: Batch, columns: Mapping[str, Any]) -> xr.Dataset:
        """The same of many designs."""
        model = batch.model
        speeds, orders, (gear,) = self.speeds(model), self.asked_orders(model), self.gears_asked(model)
        mean = model.full_load(speeds) if self.torque is None else np.full(speeds.size, self.torque)
        asked = Asked(speeds, mean, orders, (self.place(model),), False, self.backend)
        angles = batch.angles(gear, asked, columns)[:, 0]
        return self._told(("design", "speed", "order"), size(angles) * np.outer(speeds, orders) ** 2, speeds, orders)

    @staticmethod
    def _told(dims: tuple[str, ...], values: Array, speeds: Array, orders: Array) -> xr.Dataset:
        coordinates = {"speed": (speeds, "speed"), "order": (orders, "engine_order")}
        data = labelled({"acceleration": (dims, values, "acceleration")}, coordinates, analysis="response")
        data.acceleration.attrs["amplitude"] = "0-peak"
        return data


class MapRun(Linear):
    """The map over speed and mean torque of all gears, and the worst of it gear by gear."""

    gives: ClassVar[Mapping[str, str]] = {
        "acceleration_swing": "acceleration",
        "worst_speed": "speed",
        "worst_torque": "torque",
    }
    analysis: Literal["map"]
    gears: list[GearName] = Field(default_factory=list, description="default: all of them")
    torques: Whole = Field(13, description="how many mean torques up to full load")

    def __call__(self, model: Model) -> xr.Dataset:
        """Half the swing of a node's acceleration by the orders asked: the largest in reach of full load, by gear, and
        where it is."""
        speeds, torques = self.speeds(model), model.torques(self.torques)
        names, orders = self.gears_asked(model), self.asked_orders(model)
        found = response_map(model, speeds, torques, names, orders, nodes=[self.place(model)], elements=[])
        ripple = acceleration(found.angle.isel(node=0)).transpose("gear", "mean_torque", "speed", "order")
        half = half_swing(ripple.values, orders)
        return self._told((), half.reshape(len(names), -1), model, speeds, torques)

    def many(self, batch: Batch, columns: Mapping[str, Any]) -> xr.Dataset:
        """The same of many designs."""
        model = batch.model
        speeds, torques, orders = self.speeds(model), model.torques(self.torques), self.asked_orders(model)
        names, asked = self.gears_asked(model), Asked(speeds, torques, orders, (self.place(model),), True, self.backend)
        cells = torques.size * speeds.size
        half = np.empty((len(next(iter(columns.values()))), len(names), cells))
        for number, gear in enumerate(names):
            angles = batch.angles(gear, asked, columns).reshape(len(half), cells, orders.size)
            ripple = angles * -np.tile(np.outer(speeds, orders) ** 2, (torques.size, 1))
            for row, values in zip(half, ripple, strict=True):
                row[number] = half_swing(values, orders)
        return self._told(("design",), half, model, speeds, torques)

    def gears_asked(self, model: Model) -> list[str]:
        """Those of the map."""
        return list(model.chosen_gears(self.gears or None))

    def _told(self, front: tuple[str, ...], half: Array, model: Model, speeds: Array, torques: Array) -> xr.Dataset:
        """The largest in reach of full load of half swings (…, gear, mean torques × speeds), and where it is."""
        inside = np.where(model.within_full_load(speeds, torques).ravel(), half, -np.inf)
        at = np.where(np.isnan(inside), -np.inf, inside).argmax(axis=-1)
        most = np.take_along_axis(half, at[..., None], axis=-1)[..., 0]
        row, column = np.unravel_index(at, (torques.size, speeds.size))
        dims = (*front, "gear")
        data = labelled(
            {
                "acceleration_swing": (dims, most, "acceleration"),
                "worst_speed": (dims, speeds[column], "speed"),
                "worst_torque": (dims, torques[row], "torque"),
            },
            {"gear": (np.array(self.gears_asked(model)), "")},
            analysis="map",
        )
        data.acceleration_swing.attrs["amplitude"] = "half peak-to-peak"
        return data


class TransientRun(Asking):
    """A scenario in time, by the name of its kind or of its file."""

    gives: ClassVar[Mapping[str, str]] = {
        "torque_lowest": "torque",
        "torque_highest": "torque",
        "twist_lowest": "relative_angle",
        "twist_highest": "relative_angle",
    }
    analysis: Literal["transient"]
    scenario: str = Field(description="name of a kind, or of a file beside the plan")
    _block: Scenario | None = PrivateAttr(None)

    @property
    def settings(self) -> dict[str, Any]:
        """The values of the scenario, not the name of its file."""
        return {"analysis": self.analysis, **(self._block.model_dump(mode="json") if self._block else {})}

    def with_scenario(self, block: Scenario) -> TransientRun:
        """A copy that has read its scenario."""
        copy = self.model_copy()
        copy._block = block
        return copy

    def __call__(self, model: Model) -> xr.Dataset:
        """Largest and smallest ``torque`` and ``twist`` of the springs."""
        assert self._block is not None  # read with the plan
        found = spring_peaks(model, self._block)
        values = {"torque": (found.torque, "torque"), "twist": (found.twist, "relative_angle")}
        return labelled(
            {
                f"{name}_{end}": (("element",), ends[row], quantity)
                for name, (ends, quantity) in values.items()
                for row, end in enumerate(("lowest", "highest"))
            },
            {"element": (np.array(found.springs, dtype=str), "")},
            analysis="transient",
        )


Analysis: TypeAlias = ModesRun | ResponseRun | MapRun | TransientRun
