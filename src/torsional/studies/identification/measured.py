"""Blocks of a plan that name what was measured, and what each of them reads."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal, TypeAlias

import numpy as np
import xarray as xr
from pydantic import Field

from torsional.errors import ModelError, nearest
from torsional.files.opening import TABLE_BYTES, read_text
from torsional.files.scenario import load_scenario
from torsional.files.scenario_blocks import GearName
from torsional.files.scenario_schema import KINDS
from torsional.files.schema.fields import Block, Node, Quantity
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.identification.sources import History, Loops, Orders, ends_of
from torsional.studies.order_curves import BETWEEN, CARRIED, NODAL, Amplitude, curves_of_result, curves_of_table
from torsional.studies.raw_loops import Cut, loops_of_run, places_of
from torsional.studies.records import loops_of_file, white_noise
from torsional.tables import cells, named, parse_table
from torsional.units import quoted

Share = Annotated[float, Quantity("ratio", above=0)]
Weights = dict[str, Share]
LEAST = 4


class Seen(Block):
    """What all have in common."""

    file: str = Field(description="table beside the plan")
    weights: Weights = Field(default_factory=dict, description="of points among others, by their names; default: 1")
    zeros: bool = False


class PointBlock(Block):
    """When an operating point was held."""

    name: str = Field("", max_length=200, description="default: loop 1, loop 2 …")
    begin: Annotated[float, Quantity("time")]
    end: Annotated[float, Quantity("time")]


class LoopsBlock(Seen):
    """Loops of a rig: columns loop, time, speed, angle and torque; with a mapping, cut out of a measurement."""

    kind: Literal["loops"]
    gear: GearName = ""
    turned: Node = Field("", description="default: the flywheel on the crankshaft")
    held: Node = Field("", description="default: the flywheel that carries the clutch")
    zeros: bool = Field(True, description="whether the sensors' zeros are looked for too")
    mapping: str = Field("", description="mapping file beside the plan, of a measurement of any format")
    points: list[PointBlock] = Field(default_factory=list, description="of a measurement; default: all of it is one")
    sensor: Node = Field("", description="connection of the mapped torque; default: the only one")
    inertia: Annotated[float, Quantity("inertia", least=0)] | None = Field(
        None, description="between that and the springs; default: what a rig has there"
    )
    speed: Annotated[float, Quantity("speed", least=0)] | None = Field(
        None, description="of rotation; default: what channels tell"
    )

    def source(self, model: Model, folder: Path) -> Loops:
        """The loops, with the nodes between which they were measured."""
        ends, gear = ends_of(model, self.turned, self.held), model.gear_name(self.gear or None)
        if not self.mapping:
            return Loops(loops_of_file(folder / self.file), ends, gear, self.weights)
        data = channels_of(folder, self.file, self.mapping, model)
        places = places_of(data, model, ends, self.sensor, self.inertia)
        cuts = [Cut(each.name or f"loop {n}", each.begin, each.end) for n, each in enumerate(self.points, 1)]
        records = loops_of_run(data, places, cuts, self.speed)
        return Loops(records, (places.drive, places.held), gear, self.weights)


class OrdersBlock(Seen):
    """Order curves: columns speed, order, one that names the quantity, and phase; or a result in netCDF."""

    kind: Literal["orders"]
    name: str = Field("", description="default: the file's name")
    place: Node = Field(description="node or connection")
    quantity: Literal["", *CARRIED] = Field("", description="of a result in netCDF")  # type: ignore[valid-type]
    amplitude: Amplitude = Field("0-peak", description="what a table tells")
    gear: GearName = Field("", description="engaged; default: the last listed")
    torque: Annotated[float, Quantity("torque")] | None = Field(None, description="mean; default: full load")
    noise: Share = Field(0.02, description="over the RMS of the curve")

    def source(self, model: Model, folder: Path) -> Orders:
        """Its curves, speeds where all orders were measured."""
        path, name = folder / self.file, self.name or Path(self.file).stem
        if path.suffix.lower() in (".nc", ".nc4"):
            found = curves_of_result(path, self.place, self.quantity)
        else:
            found = curves_of_table(path, self.amplitude)
        whole = found.dropna("speed")
        if whole.speed.size < LEAST:
            found_ = f"{whole.speed.size} speeds at which all orders were measured"
            raise ModelError("too little was measured", where="file", found=found_, allowed=f"{LEAST} at least")
        _refuse_place(model, self.place, str(found.name), self.gear)
        curves = {float(n): whole.sel(order=n).values for n in whole.order.values if n > 0}
        gear = model.gear_name(self.gear or None)
        return Orders(
            name,
            curves,
            whole.speed.values,
            self.place,
            str(found.name),
            gear,
            self.torque,
            self.noise,
            self.weights,
        )


class HistoryBlock(Seen):
    """A signal in time: columns time and one that names the quantity; with a mapping, a channel of a measurement."""

    kind: Literal["history"]
    name: str = Field("", description="default: the file's name")
    place: Node = Field(description="node or connection")
    mapping: str = Field("", description="mapping file beside the plan, of a measurement of any format")
    quantity: Literal["", *CARRIED] = Field("", description="of a measurement")  # type: ignore[valid-type]
    scenario: str = Field(description="name of a kind, or of a file beside the plan; it begins at time zero")
    noise: float | None = Field(None, gt=0, description="standard deviation in SI; default: that of white noise in it")

    def source(self, model: Model, folder: Path) -> History:
        """The signal, with the scenario it was measured in."""
        times, values, quantity = self._mapped(model, folder) if self.mapping else self._table(folder)
        source = self.scenario if self.scenario in KINDS else str(folder / self.scenario)
        noise = self.noise or white_noise(times, values)
        if not noise > 0:
            raise ModelError("the signal tells no noise of its own", where="noise", remedy="give noise")
        name = self.name or Path(self.file).stem
        weight = self.weights.get(name, 1.0)
        return History(name, times, values, self.place, quantity, load_scenario(source), noise, weight)

    def _table(self, folder: Path) -> tuple[Array, Array, str]:
        text = read_text(folder / self.file, TABLE_BYTES)
        heads = [named(cell)[0] for cell in cells(text).header]
        quantity = next((head for head in heads if head in CARRIED), "")
        if not quantity:
            raise ModelError("one column must name the quantity", where="file", allowed=", ".join(CARRIED))
        table = parse_table(text, {"time": "time", quantity: quantity}, increasing="time")
        return np.array(table["time"]), np.array(table[quantity]), quantity

    def _mapped(self, model: Model, folder: Path) -> tuple[Array, Array, str]:
        data = channels_of(folder, self.file, self.mapping, model)
        there = {name: BETWEEN.get(name, name) for name in (self.quantity and [self.quantity]) or CARRIED}
        for quantity, name in there.items():
            dim = "node" if quantity in NODAL else "element"
            if name in data and self.place in data[dim].values:
                own = data[name].sel({dim: self.place})
                kept = (own.time.values >= 0.0) & np.isfinite(own.values)
                if kept.any():
                    return own.time.values[kept], own.values[kept], quantity
        wanted = self.quantity or "signal"
        raise ModelError(f"the mapping brings no {wanted} to this place", where="place", found=quoted(self.place))


def channels_of(folder: Path, file: str, mapping: str, model: Model) -> xr.Dataset:
    """Channels of a measurement at their places of the model."""
    from torsional.measurements import load_mapping, mapped, read_measurement

    return mapped(read_measurement(folder / file), load_mapping(folder / mapping), model)


def _refuse_place(model: Model, place: str, quantity: str, gear: str) -> None:
    """A node for quantities of nodes, a connection for the others."""
    line = model.powertrain(gear or None)
    known = [*line.nodes] if quantity in NODAL else list(line.components)
    if place not in known:
        what = "node" if quantity in NODAL else "connection"
        raise ModelError(
            f"the model has no such {what}", where="place", found=quoted(place), remedy=nearest(place, known)
        )


AnyMeasured: TypeAlias = Annotated[LoopsBlock | OrdersBlock | HistoryBlock, Field(discriminator="kind")]
