"""Branches of periodic motion for plans: what springs with stages do over speed, where their motion loses stability."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from torsional.engine.orders import HIGHEST_ORDER
from torsional.files.schema.fields import Order, Torque, Whole
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities import swing
from torsional.quantities.branches import without_stable
from torsional.results import labelled
from torsional.solvers.periodic import model_response
from torsional.solvers.periodic.machine import engine_load, system_response
from torsional.solvers.periodic.response import Exploration
from torsional.studies.sweeps.analyses import OverSpeed
from torsional.studies.sweeps.batch import Batch
from torsional.studies.sweeps.numbers import system_of
from torsional.system import BoolArray


class PeriodicRun(OverSpeed):
    """The main branch of periodic motion over speed, of a model whose springs have stages."""

    gives: ClassVar[Mapping[str, str]] = {
        "twist_swing": "relative_angle",
        "acceleration_swing": "acceleration",
        "worst_speed": "speed",
        "folds": "number",
        "doublings": "number",
        "fold_speed": "speed",
        "doubling_speed": "speed",
        "unstable_share": "ratio",
    }
    analysis: Literal["periodic"]
    torque: Torque | None = Field(None, description="mean; default: full load")
    highest_order: Order = Field(HIGHEST_ORDER, description="of the harmonics")
    count: Whole = Field(4, description="of folds, and of period doublings, whose speeds are told")

    def __call__(self, model: Model) -> xr.Dataset:
        """Half the swing, the largest over the branch, of the ``twist_swing`` of springs with stages and of a node's
        ``acceleration_swing`` with its ``worst_speed``; how many ``folds`` and period ``doublings`` the branch has, and
        at which speeds (none beyond); the ``unstable_share`` of the speeds, in which it has no stable motion."""
        at = self.speeds(model)
        data = model_response(
            model, (at[0], at[-1]), self.torque, self.gear or None, at=at, highest_order=self.highest_order, depth=0
        )
        return self._told(data, model)

    def possible(self, batch: Batch) -> bool:
        """Whether designs can be asked by their numbers."""
        return batch.answers(batch.model.gear_name(self.gear or None))

    def covers(self, batch: Batch, columns: Mapping[str, Any]) -> BoolArray:
        """Which of them."""
        return batch.covers(batch.model.gear_name(self.gear or None), columns)

    def each(self, batch: Batch, columns: Mapping[str, Any]) -> Callable[[int], xr.Dataset]:
        """The answer of each of them, one at a time: the engine's load is worked out once, no model is built."""
        model, at = batch.model, self.speeds(batch.model)
        span = float(at[0]), float(at[-1])
        load = engine_load(model, span, self.torque, self.highest_order)
        asked = Exploration(highest_order=self.highest_order, depth=0, at=at)
        numbers = batch.numbers(model.gear_name(self.gear or None), columns)

        def answer(design: int) -> xr.Dataset:
            return self._told(system_response(model, system_of(*numbers, design), load, span, asked), model)

        return answer

    def _told(self, data: xr.Dataset, model: Model) -> xr.Dataset:
        """The figures of a branch."""
        place, at = self.place(model), self.speeds(model)
        springs = json.loads(data.attrs["laws"])
        twist, shaken = _swings(data, springs, place)
        values: dict[str, Any] = {
            "twist_swing": (("element",), twist.max(axis=0), "relative_angle"),
            "acceleration_swing": ((), float(shaken.max()), "acceleration"),
            "worst_speed": ((), float(data.speed.values[int(shaken.argmax())]), "speed"),
            "unstable_share": ((), _unstable(data, float(at[-1] - at[0])), "ratio"),
        }
        for name, kind in (("fold", "fold"), ("doubling", "period doubling")):
            speeds = np.sort(data.bifurcation_speed.values[data.bifurcation_type.values == kind])
            values[f"{name}s"] = (), speeds.size, "number"
            values[f"{name}_speed"] = ("bifurcation",), _padded(speeds, self.count), "speed"
        return labelled(values, {"element": (springs, "")}, analysis="periodic")


def _swings(data: xr.Dataset, springs: Sequence[str], node: str) -> tuple[Array, Array]:
    """Half the swing of the springs' twists (points, springs) and of a node's acceleration (points,)."""
    orders, names, nodes = data.order.values, data.element.values.tolist(), data.node.values.tolist()
    angle = data.angle.transpose("point", "order", "node").values[..., nodes.index(node)]
    twist = data.twist.transpose("point", "order", "element").values[..., [names.index(name) for name in springs]]
    shaken = -np.square(np.multiply.outer(data.speed.values, orders)) * angle
    signals = np.concatenate([twist, shaken[..., None]], axis=-1)
    half = swing(xr.DataArray(signals, dims=("point", "order", "signal"), coords={"order": orders})).values
    return half[:, :-1], half[:, -1]


def _unstable(data: xr.Dataset, span: float) -> float:
    """The share of a span of speed in which a branch has no stable motion, or was not followed to."""
    stable = float(np.ptp(data.value.values)) - sum(high - low for low, high in without_stable(data))
    return 1.0 - stable / span


def _padded(values: Array, count: int) -> Array:
    return np.append(values[:count], np.full(max(count - values.size, 0), np.nan))
