"""What a report computes: every variant's modes, interference, full-load response and maps, and their ratios."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr

from torsional.errors import ModelError, nearest
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities import acceleration, irregularity, named_modes, swing
from torsional.report.labels import labels
from torsional.report.motions import Motions, sought
from torsional.results import dataset
from torsional.solvers.campbell import campbell
from torsional.solvers.map import response_map
from torsional.solvers.run_up import full_load_response

Progress = Callable[[int, int], None]


@dataclass(frozen=True, eq=False)
class Response:
    """Forced response of one variant at its node to be kept quiet; everything in SI.

    ``orders`` complex acceleration orders (gear, speed, order) at full load and ``swing`` half its peak-to-peak;
    ``map`` (gear, mean_torque, speed) the same over the grid, ``within`` full load; ``full`` the dataset at full load;
    ``curve`` (speed) the full-load torque [Nm]; ``idle`` the crankshaft's irregularity (load) at idle.
    """

    node: str
    full: xr.Dataset
    orders: xr.DataArray
    swing: xr.DataArray
    grid: xr.Dataset
    map: xr.DataArray
    curve: xr.DataArray
    idle: xr.DataArray | None

    @property
    def within(self) -> xr.DataArray:
        """Whether a cell (torque, speed) lies at or below full load."""
        within: xr.DataArray = self.grid.within_full_load
        return within


@dataclass(frozen=True, eq=False)
class Variant:
    """One model analysed: ``interference`` as `campbell` gives it, ``names`` of the modes by gear, ``response``.

    ``missing`` says in a sentence why there is no response; ``motions`` those of springs with stages, where it has
    some, and ``unmoved`` why they are not told.
    """

    label: str
    model: Model
    interference: xr.Dataset
    names: dict[str, list[str]]
    response: Response | None
    missing: str = ""
    motions: Motions | None = None
    unmoved: str = ""

    @property
    def main_order(self) -> float | None:
        """The engine's main order; None without an engine."""
        return float(self.interference.order[0]) if self.interference.order.size else None

    def modes(self, gear: str) -> xr.Dataset:
        """The modes of one gear in the middle of the operating range (frequency, damping ratio, shares)."""
        middle = float(np.mean(self.model.operation.speed))
        return self.interference.sel(gear=gear).sel(speed=middle, method="nearest")


@dataclass(frozen=True, eq=False)
class Comparison:
    """All variants, the first set against the others; ``gears`` are those shown in maps."""

    variants: tuple[Variant, ...]
    gears: tuple[str, ...]

    @property
    def first(self) -> Variant:
        """The model the report is about."""
        return self.variants[0]

    @property
    def answered(self) -> list[tuple[Variant, Response]]:
        """Variants that have a response, with it."""
        return [(variant, variant.response) for variant in self.variants if variant.response is not None]

    def ratio(self, other: Variant) -> xr.DataArray | None:
        """Map of the first variant over another's, in the cells both have at or below full load; None without any."""
        if self.first.response is None or other.response is None:
            return None
        quotient, both, _ = self.overlaid(other)
        kept = quotient.where(both)
        known = kept.size and bool(np.isfinite(kept.values).any())
        return kept if known else None

    def overlaid(self, other: Variant) -> tuple[xr.DataArray, xr.DataArray, xr.DataArray]:
        """Ratio in all common cells (gear, torque, speed), whether both reach a cell, and the lower full-load curve."""
        mine, theirs = self.first.response, other.response
        assert mine is not None and theirs is not None
        quotient = (mine.map / theirs.map).transpose("gear", "mean_torque", "speed").rename("ratio")
        one, two = xr.align(mine.curve, theirs.curve)
        return quotient, mine.within & theirs.within, one.where(one <= two, two)


def analysed(
    models: Sequence[Model], gears: Sequence[str], speeds: int, torques: int, progress: Progress
) -> Comparison:
    """All models analysed; grids follow the first model's where another's range allows it."""
    grid = _grid(models[0], speeds, torques) if models[0].engine is not None else (np.empty(0), np.empty(0))
    variants = []
    for done, (model, label) in enumerate(zip(models, labels(models), strict=True)):
        variants.append(_variant(model, label, _fitting(model, grid, speeds, torques)))
        progress(done + 1, len(models) + 1)
    return Comparison(tuple(variants), _shown_gears(variants[0], gears))


def usable_speeds(model: Model) -> tuple[float, float]:
    """The operating range [rad/s], cut to where the full-load curve reaches."""
    low, high = model.operation.speed
    curve = model.full_load_curve
    if curve is None:
        return low, high
    low, high = max(low, curve.speeds[0]), min(high, curve.speeds[-1])
    if low >= high:
        raise ModelError("the full-load curve and the operating range have no speed in common", where="operation.speed")
    return low, high


def _grid(model: Model, speeds: int, torques: int) -> tuple[Array, Array]:
    curved = model.full_load_curve is not None
    loads = model.torques(torques) if curved or model.operation.torque else np.zeros(1)
    return np.linspace(*usable_speeds(model), speeds), loads


def _fitting(model: Model, grid: tuple[Array, Array], speeds: int, torques: int) -> tuple[Array, Array]:
    """The first model's grid brought to a model's own range, or its own where the two have little in common."""
    if model.engine is None:
        return grid
    own = _grid(model, speeds, torques)
    return continued(grid[0], own[0]), continued(grid[1], own[1])


def continued(first: Array, own: Array) -> Array:
    """The points of ``first`` cut or continued by its step to the range of ``own``; ``own`` where they hardly overlap.

    >>> continued(np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.5, 3.0, 5.5])).tolist()
    [1.0, 2.0, 3.0, 4.0, 5.0]
    """
    if min(first.size, own.size) < 2:
        return own
    common = min(first[-1], own[-1]) - max(first[0], own[0])
    if common < 0.5 * max(np.ptp(first), np.ptp(own)):
        return own
    step = first[1] - first[0]
    count = np.arange(np.ceil((own[0] - first[0]) / step - 1e-6), np.floor((own[-1] - first[0]) / step + 1e-6) + 1)
    known = (count >= 0) & (count < first.size)  # taken as they are, since results are joined by equal coordinates
    taken = first[np.clip(count, 0, first.size - 1).astype(int)]
    return np.asarray(np.where(known, taken, first[0] + step * count))


def _variant(model: Model, label: str, grid: tuple[Array, Array]) -> Variant:
    met = campbell(model)
    names = {str(gear): named(model, met, str(gear)) for gear in met.gear.values}
    if model.engine is None:
        return Variant(label, model, met, names, None, "The model has no engine, so this page tells its modes only.")
    try:
        found = _response(model, *grid)
        motions, unmoved = sought(model, usable_speeds(model))
        return Variant(label, model, met, names, found, "", motions, unmoved)
    except ModelError as error:  # modes need less than a response: a report tells them and says what is missing
        return Variant(label, model, met, names, None, f"The vibration under engine torque is not told: {error}.")


def named(model: Model, met: xr.Dataset, gear: str) -> list[str]:
    """Names of a gear's modes in the middle of the operating range, by where their elastic energy is."""
    here = met.sel(gear=gear).sel(speed=float(np.mean(model.operation.speed)), method="nearest")
    here = here.isel(mode=np.isfinite(here.frequency.values))
    return [name.replace("_", " ") for name in named_modes(here, model.mode_groups)]


def _response(model: Model, speeds: Array, torques: Array) -> Response:
    marks = model.landmarks
    node = marks.input or marks.crankshaft
    if model.engine is not None and not node:
        raise ModelError("no node is named whose vibration is asked for", where="landmarks.input")
    grid = response_map(model, speeds, torques)
    full = full_load_response(model, np.linspace(speeds[0], speeds[-1], 141))
    orders = acceleration(full.angle.sel(node=node))
    parts = [swing(acceleration(grid.angle.sel(node=node, gear=[gear]))) for gear in grid.gear.values]
    over = xr.concat(parts, "gear").transpose("gear", "mean_torque", "speed").assign_attrs(parts[0].attrs)
    curve = dataset(
        {"mean_torque": (("speed",), full.mean_torque.values, "torque")},
        {"speed": (full.speed.values, "speed")},
        analysis="curve",
    ).mean_torque
    return Response(node, full, orders, swing(orders).transpose("gear", "speed"), grid, over, curve, _idle(model))


def _idle(model: Model) -> xr.DataArray | None:
    """Irregularity of the crankshaft at idle in the last gear, under the least mean torque and at full load."""
    idle, node = model.operation.idle, model.landmarks.crankshaft
    least = model.operation.torque[0] if model.operation.torque else 0.0
    loads = {"least mean torque": least}
    curve = model.full_load_curve
    if curve is not None and curve.speeds[0] * (1 - 1e-9) <= idle <= curve.speeds[-1]:
        loads["full load"] = float(model.full_load(idle))
    if not node:
        return None
    found = []
    for load in loads.values():
        angle = full_load_response(model, [idle], [load], [model.top_gear]).angle.sel(node=node)
        found.append(float(irregularity(angle).squeeze()))
    told = {"load": list(loads), "mean_torque": ("load", list(loads.values()))}
    return xr.DataArray(found, dims="load", coords=told, attrs={"quantity": "irregularity", "units": "-"})


def _shown_gears(first: Variant, gears: Sequence[str]) -> tuple[str, ...]:
    """The gears asked for, or the one with the largest vibration within full load and the last."""
    known = first.model.gear_names
    for gear in gears:
        if gear not in known:
            raise ModelError(f"there is no gear '{gear}'", where="gears", remedy=nearest(gear, known))
    if gears or first.response is None:
        return tuple(gears) or (first.model.top_gear,)
    largest = first.response.map.where(first.response.within).max(("mean_torque", "speed"))
    worst = str(largest.gear.values[int(largest.argmax("gear"))])
    return tuple(dict.fromkeys((worst, first.model.top_gear)))
