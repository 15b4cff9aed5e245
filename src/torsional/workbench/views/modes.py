"""Modes with their shapes, and where engine orders meet them gear by gear."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from torsional.model import Model
from torsional.quantities import named_modes
from torsional.quantities.modes import modes_of
from torsional.solvers.campbell import campbell
from torsional.workbench.views.asking import Answer, Ask, AskInGear, Names, Number, Orders, main_order


class AskModes(AskInGear):
    """Modes in one gear about a mean torque, at a speed that tunes pendulums (default: idle)."""

    view: Literal["modes"]
    torque: Number | None = None
    speed: Annotated[float, Field(ge=0, le=1e4)] | None = None
    order: Annotated[float, Field(gt=0, le=48)] | None = None

    def answer(self, model: Model) -> Answer:
        """As `modes` tells them."""
        torque = model.typical_torque() if self.torque is None else self.torque
        speed = model.operation.idle if self.speed is None else self.speed
        order = self.order or main_order(model)
        found = modes_of(model, self.engaged(model), torque, speed, order)
        named = {key: [str(name) for name in found[key].values] for key in ("name", "node", "element", "mass")}
        kept = ("frequency", "damped_frequency", "damped_ratio", "shape", "elastic_share", "kinetic_share")
        return {
            "gear": self.engaged(model),
            "torque": torque,
            "speed": speed,
            "order": order,
            "name": named["name"],
            "absorber_mode": model.absorber_mode,
            "nodes": named["node"],
            "elements": named["element"],
            "masses": named["mass"],
            "damping_ratio": found.damped_ratio.values,
            **{key: found[key].values for key in kept},
            "order_speed": None if order is None else found.order_speed.values,
        }


class AskInterference(Ask):
    """Natural frequencies of all gears over speed, and the speeds at which orders meet them."""

    view: Literal["interference"]
    gears: Names | None = None
    torque: Number | None = None
    orders: Orders | None = None

    def answer(self, model: Model) -> Answer:
        """As `campbell` tells them."""
        found = campbell(model, self.torque, self.gears, None, self.orders)
        low, high = model.operation.speed
        middle = found.sel(speed=0.5 * (low + high), method="nearest")
        names = []
        for gear in range(found.sizes["gear"]):
            here = middle.isel(gear=gear)
            kept = np.flatnonzero(np.isfinite(here.frequency.values))
            names.append(named_modes(here.isel(mode=kept), model.mode_groups))
        return {
            "gears": [str(name) for name in found.gear.values],
            "torque": found.attrs["mean_torque"],
            "orders": found.order.values.tolist(),
            "speed": found.speed.values,
            "frequency": found.frequency.transpose("gear", "mode", "speed").values,
            "crossing": found.crossing.transpose("gear", "mode", "order").values,
            "name": names,
            "idle": model.operation.idle,
            "range": (low, high),
        }
