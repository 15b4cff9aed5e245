"""Motions in time as they settle, for plans: stops, gaps, friction and springs in detail at operating points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, Literal

import numpy as np
import xarray as xr
from pydantic import Field, PrivateAttr

from torsional.engine import Engine
from torsional.engine.orders import HIGHEST_ORDER
from torsional.files.scenario_blocks import Time, TorqueOrZero
from torsional.files.schema.fields import Order
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities import swing
from torsional.results import Variable, labelled
from torsional.solvers.transient.drives import OrderTorques
from torsional.solvers.transient.sweeps import engine_drive, settled_rows
from torsional.studies.scenarios.lines import inner_parts
from torsional.studies.scenarios.running import STEP, with_tabs
from torsional.studies.sweeps.analyses import OverSpeed


class SettledRun(OverSpeed):
    """The motion that time stepping settles on over speed, under mean torques or at full load."""

    gives: ClassVar[Mapping[str, str]] = {
        "acceleration_swing": "acceleration",
        "twist_swing": "relative_angle",
        "torque_swing": "torque",
        "periods": "number",
        "method_share": "ratio",
    }
    analysis: Literal["settled"]
    torques: list[TorqueOrZero] = Field(default_factory=list, description="mean; default: full load at each speed")
    highest_order: Order = Field(HIGHEST_ORDER, description="of the engine's torque")
    step: Time = Field(STEP, description="of time, made to fit the period of the drive")
    _known: tuple[Engine, Any, list[list[OrderTorques]]] | None = PrivateAttr(None)

    def __call__(self, model: Model) -> xr.Dataset:
        """Half the swing of a node's acceleration, ``acceleration_swing``, and of the absorber's springs and the clutch
        their ``twist_swing`` and ``torque_swing``, over mean torque, where some are named, and speed.

        Absorbers that have details are taken in detail.  ``periods`` of the drive after which the motion repeats
        itself, 0 where it never does; ``method_share``: energy that the time steps made or lost of their own.
        """
        marks, speeds, gear = model.landmarks, self.speeds(model), model.gear_name(self.gear or None)
        found = settled_rows(model, gear, speeds, self._drives(model, speeds), step=self.step)
        rows = [with_tabs(row, marks.springs, inner_parts(model)) for row in found]
        names = [name for name in marks.observed_elements if name in rows[0].element.values]
        squared = [np.square(row.value * row.order) for row in rows]
        shaken = [at * row.angle.sel(node=self.place(model)) for row, at in zip(rows, squared, strict=True)]
        values = {"acceleration_swing": self._over(_swung(shaken), "acceleration")}
        for name, quantity in (("twist", "relative_angle"), ("torque", "torque")):
            carried = [row[name].sel(element=names) for row in rows]
            values[f"{name}_swing"] = self._over(_swung(carried), quantity, "element")
        for name, quantity in (("periods", "number"), ("method_share", "ratio")):
            values[name] = self._over(np.stack([row[name].values for row in rows]), quantity)
        return self._told(values, speeds, names)

    def _drives(self, model: Model, speeds: Array) -> list[list[OrderTorques]]:
        """The engine's torques of every row, one for each speed; made once for all designs that share an engine."""
        over = [np.full(speeds.size, torque) for torque in self.torques] or [model.full_load(speeds)]
        asked = (model.landmarks, speeds.tolist(), [row.tolist() for row in over])
        if self._known is None or self._known[0] is not model.engine or self._known[1] != asked:
            made = [
                [
                    OrderTorques(engine_drive(model, speed, torque, self.highest_order))
                    for speed, torque in zip(speeds.tolist(), row.tolist(), strict=True)
                ]
                for row in over
            ]
            self._known = model.running_engine, asked, made
        return self._known[2]

    def _over(self, values: Array, quantity: str, *further: str) -> Variable:
        """A variable from values (rows, speeds, …)."""
        whole = ("mean_torque", "speed", *further)
        return (whole, values, quantity) if self.torques else (whole[1:], values[0], quantity)

    def _told(self, values: Mapping[str, Variable], speeds: Array, names: Sequence[str]) -> xr.Dataset:
        torques = {"mean_torque": (np.array(self.torques), "torque")} if self.torques else {}
        coordinates = {**torques, "speed": (speeds, "speed"), "element": (np.array(names, dtype=str), "")}
        data = labelled(values, coordinates, analysis="settled")
        for name in ("acceleration_swing", "twist_swing", "torque_swing"):
            data[name].attrs["amplitude"] = "half peak-to-peak"
        return data


def _swung(rows: Sequence[xr.DataArray]) -> Array:
    """Half the swing of orders, (rows, speeds, …)."""
    return np.stack([swing(row).values for row in rows])
