"""Order response over speed at chosen places, and over speed, torque and gear at one of them."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
import xarray as xr
from pydantic import Field

from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities import acceleration, angular_velocity
from torsional.solvers.map import response_map
from torsional.solvers.run_up import run_up_response
from torsional.system import assemble
from torsional.workbench.fields import words
from torsional.workbench.views.asking import (
    Answer,
    Ask,
    AskInGear,
    Names,
    Number,
    Orders,
    main_order,
    observed,
    reached,
    refuse_unknown,
)

Motion = Literal["acceleration", "angular_velocity", "angle"]


class AskResponse(AskInGear):
    """Orders over speed in one gear, at full load or under one mean torque."""

    view: Literal["response"]
    torque: Number | Literal["full_load"] = "full_load"
    nodes: Names | None = None
    elements: Names | None = None
    orders: Orders | None = None
    speeds: Annotated[int, Field(ge=2, le=2000)] = 300
    quantity: Motion = "acceleration"

    def answer(self, model: Model) -> Answer:
        """As `respond` tells them: 0-peak amplitudes of nodes and of torques in connections."""
        gear, _ = self.engaged(model), model.running_engine
        system = assemble(model.powertrain(gear))
        nodes, elements = observed(model, system, self.nodes, self.elements)
        speeds = model.speeds(self.speeds)
        speeds = reached(model, speeds) if self.torque == "full_load" else speeds
        if not speeds.size:
            raise ModelError("the full-load curve reaches none of the speeds", where="operation.speed")
        mean = model.full_load(speeds) if self.torque == "full_load" else np.full(len(speeds), self.torque)
        orders = self.orders or list(model.engine_orders(3))
        found = run_up_response(model, speeds, mean, gear, orders)
        moved = _moved(found.angle.sel(node=nodes), self.quantity)
        twisted = found.torque.sel(element=elements)
        values = [
            abs(moved.transpose("node", "order", "speed").values),
            abs(twisted.transpose("element", "order", "speed").values),
        ]
        return {
            "gear": gear,
            "speed": speeds,
            "torque": mean,
            "orders": orders,
            "places": [
                *({"name": name, "label": words(name), "kind": "node", "quantity": self.quantity} for name in nodes),
                *({"name": name, "label": words(name), "kind": "element", "quantity": "torque"} for name in elements),
            ],
            "value": np.concatenate(values),
            "mean_twist": found.mean_twist.sel(element=elements).values.T,
            "idle": model.operation.idle,
            "range": model.operation.speed,
        }


class AskMap(Ask):
    """One order at one place over mean torque and speed, in some gears or in all."""

    view: Literal["map"]
    gears: Names | None = None
    place: Annotated[str, Field(max_length=64)] = ""
    order: Annotated[float, Field(gt=0, le=48)] | None = None
    speeds: Annotated[int, Field(ge=2, le=200)] = 60
    torques: Annotated[int, Field(ge=2, le=100)] = 30
    quantity: Motion = "acceleration"

    def answer(self, model: Model) -> Answer:
        """As `map` tells it: 0-peak, NaN where not solved."""
        speeds, torques = model.speeds(self.speeds), model.torques(self.torques)
        order = self.order or main_order(model) or 1.0
        place, kind = self._place(model)
        nodes, elements = ([place], []) if kind == "node" else ([], [place])
        found = response_map(model, speeds, torques, self.gears, [order], nodes=nodes, elements=elements)
        values = _moved(found.angle, self.quantity) if kind == "node" else found.torque
        return {
            "gears": [str(name) for name in found.gear.values],
            "place": place,
            "label": words(place),
            "kind": kind,
            "quantity": self.quantity if kind == "node" else "torque",
            "order": order,
            "speed": speeds,
            "torque": torques,
            "value": abs(values.transpose("gear", "mean_torque", "speed", "order", ...).values[..., 0, 0]),
            "within": found.within_full_load.values.astype(float),
            "full_load": _curve(model, speeds),
        }

    def _place(self, model: Model) -> tuple[str, str]:
        """The place asked for and whether it is a node or a connection; else the node to be kept quiet."""
        system = assemble(model.powertrain())
        place = self.place or model.landmarks.input or model.landmarks.crankshaft
        if not place:
            raise ModelError("no node is named whose vibration is asked for", where="landmarks.input")
        refuse_unknown([place], [*system.nodes, *system.connections.names], "place")
        return place, "node" if place in system.nodes else "element"


def _moved(angle: xr.DataArray, quantity: Motion) -> xr.DataArray:
    """Angle orders as accelerations, velocities, or as they are."""
    kinds = {"acceleration": acceleration, "angular_velocity": angular_velocity}
    return kinds[quantity](angle) if quantity in kinds else angle


def _curve(model: Model, speeds: Array) -> Array:
    """Full-load torque [Nm] at each speed, NaN where the curve does not reach or there is none."""
    curve = model.full_load_curve
    found = np.full(speeds.shape, np.nan)
    if curve is not None:
        within = curve.reaches(speeds)
        found[within] = curve(speeds[within])
    return found
