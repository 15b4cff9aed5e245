"""Engines with fewer cylinders at work: some of them deactivated, or a shorter engine in the place of the whole one.

A deactivated cylinder gets no fuel and no air (``valves`` "closed": it compresses and expands what it holds, a gas
spring without work) or goes on breathing ("working").  The others burn so much more that the mean torque stays.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from torsional.components import Component
from torsional.engine import CrankLayout, FullLoad
from torsional.engine.orders import HALF_ORDERS, BoolArray
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities import acceleration, swing
from torsional.results import labelled
from torsional.solvers.map import response_map
from torsional.solvers.modal import modal
from torsional.solvers.operating import at_operating_point
from torsional.stamps import GROUND
from torsional.studies.answers import mean_torque, mode_of
from torsional.studies.trucks import mapped
from torsional.units import RPM

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STEP = 25 * RPM
"""Step of the speeds [rad/s]."""
LOADS = (0.1, 0.2, 0.3, 0.4, 0.5)
"""Mean torques over the peak of the full-load curve."""
WHOLE, SECOND, BESIDE, SHORTER = "all cylinders", "every second off", "neighbours off", "shorter engine"
"""Names of engines in results."""


def every_second(layout: CrankLayout) -> tuple[int, ...]:
    """Every second cylinder of the firing order, so that the others fire at even distances.

    Raises ModelError for an odd number of cylinders, of which every second one cannot be.

    >>> every_second(CrankLayout.inline((1, 5, 3, 6, 2, 4)))
    (4, 5, 6)
    """
    if layout.cylinders % 2:
        raise ModelError(
            "every second of an odd number of cylinders cannot be: over two turns of the cycle it would be all of them",
            where="engine.firing_order",
            found=f"{layout.cylinders} cylinders",
            allowed="an even number",
        )
    return tuple(sorted(layout.firing_order[1::2]))


def neighbours(layout: CrankLayout) -> tuple[int, ...]:
    """As many that fire one after the other: the bad choice, of which a long pause is left.

    >>> neighbours(CrankLayout.inline((1, 5, 3, 6, 2, 4)))
    (2, 4, 6)
    """
    return tuple(sorted(layout.firing_order[layout.cylinders - layout.cylinders // 2 :]))


def deactivated(model: Model, cylinders: tuple[int, ...], valves: str = "closed") -> Model:
    """A copy whose engine runs with these cylinders alone without fuel, whichever it ran without before."""
    engine = model.running_engine
    spread = () if cylinders else engine.heat_spread
    changed = dataclasses.replace(engine, deactivated=cylinders, deactivated_valves=valves, heat_spread=spread)
    return model.replaced(engine=changed)


def evenly(cylinders: int) -> CrankLayout:
    """An engine in line that fires evenly: odd numbers up, then even numbers down, 1-3-4-2 for four."""
    return CrankLayout.inline((*range(1, cylinders + 1, 2), *range(cylinders - cylinders % 2, 0, -2)))


def shorter(cylinders: int) -> int:
    """How many cylinders the next smaller engine of a family has: two fewer, of four and less one fewer.

    >>> [shorter(cylinders) for cylinders in (8, 6, 4)]
    [6, 4, 3]
    """
    return cylinders - 2 if cylinders > 4 else cylinders - 1


def downsized(model: Model, cylinders: int) -> Model:
    """A copy with an engine of fewer ``cylinders`` of the same size: as many throws fewer, full load in proportion.

    The throws in the middle go; damper, flywheel and the line behind stay.  Raises ModelError for a vee, whose throws
    carry two cylinders, for a number that is not smaller, and where the throws do not stand one behind the other.
    """
    engine = model.running_engine
    own = engine.layout.cylinders
    if not 1 <= cylinders < own:
        allowed = f"1 to {own - 1}" if own > 1 else "an engine of more than one cylinder"
        raise ModelError(
            "a smaller engine has fewer cylinders", where="cylinders", found=str(cylinders), allowed=allowed
        )
    if engine.layout.throw_count < own:
        remedy = "ask for deactivated cylinders alone"
        raise ModelError(
            "down-sizing is worked out for engines in line", where="engine.layout", found="V", remedy=remedy
        )
    curve = engine.full_load
    share = cylinders / own
    smaller = dataclasses.replace(
        engine,
        layout=evenly(cylinders),
        deactivated=(),
        heat_spread=(),
        full_load=curve and FullLoad(curve.speeds, tuple(share * torque for torque in curve.torques)),
    )
    nodes = model.landmarks.throws
    if len(nodes) == 1:
        return model.replaced(engine=smaller)
    return _with_throws_left_out(model, (cylinders + 1) // 2, own - cylinders).replaced(engine=smaller)


def _with_throws_left_out(model: Model, first: int, count: int) -> Model:
    """A copy without ``count`` throws behind the ``first`` ones; what joined the last of them to the next one, or to
    the flywheel, joins the one before to it."""
    nodes = model.landmarks.throws
    gone, before = set(nodes[first : first + count]), nodes[first - 1]
    last = nodes[first + count - 1]
    bridged: list[str] = []

    def change(parts: dict[str, Component]) -> dict[str, Component]:
        kept: dict[str, Component] = {}
        for name, part in parts.items():
            touched = {node for stamp in part.stamps(name) for node in stamp.weights} - {GROUND}
            if not touched & gone:
                kept[name] = part
            elif last in touched and not touched <= {*nodes[: first + count]}:
                kept[name] = _moved(part, last, before)
                bridged.append(name)
        return kept

    shortened = mapped(model, change)
    if len(bridged) != 1:
        raise ModelError(
            "throws can be left out where one shaft joins each to the next",
            where="landmarks.throws",
            found=f"{len(bridged)} connections behind '{last}'",
        )
    marks = dataclasses.replace(model.landmarks, throws=tuple(node for node in nodes if node not in gone))
    return shortened.replaced(landmarks=marks)


def _moved(part: Component, old: str, new: str) -> Component:
    fields = {field.name: getattr(part, field.name) for field in dataclasses.fields(part)}  # type: ignore[arg-type]
    return dataclasses.replace(part, **{name: new for name, value in fields.items() if value == old})  # type: ignore[type-var]


def engines(model: Model, off: tuple[int, ...] = (), cylinders: int = 0, valves: str = "closed") -> dict[str, Model]:
    """The model with each engine by name: whole, some cylinders ``off`` (empty: every second), as many neighbours off,
    and a shorter one with fewer ``cylinders`` (0: as `shorter` says)."""
    layout = model.running_engine.layout
    chosen = tuple(sorted(off)) or every_second(layout)
    beside = {BESIDE: neighbours(layout)} if not off and len(chosen) > 1 else {}
    named = {WHOLE: (), SECOND if not off else "some off": chosen, **beside}
    told = {name: deactivated(model, numbers, valves) for name, numbers in named.items()}
    return {**told, SHORTER: downsized(model, cylinders or shorter(layout.cylinders))}


def firing_order(model: Model) -> float:
    """Half the number of cylinders that fire."""
    engine = model.running_engine
    return (engine.layout.cylinders - len(engine.deactivated)) / 2


def input_orders(model: Model, speed: Array, torque: Array, gear: str = "") -> xr.DataArray:
    """Orders of the acceleration at the gearbox input [rad/s²], complex 0-peak, (mean_torque, speed, order)."""
    found = response_map(model, speed, torque, [model.gear_name(gear)], HALF_ORDERS, elements=[])
    return acceleration(found.angle.sel(node=model.landmarks.input).isel(gear=0))


def reached(model: Model, speed: Array, torque: Array, share: float) -> BoolArray:
    """Whether a share of the full-load torque reaches a mean torque, (torques, speeds)."""
    return model.within_full_load(speed, torque / share)


def part_loads(model: Model) -> Array:
    """Mean torques [Nm] up to half of the full-load peak, which half of the cylinders reach."""
    return np.array(LOADS) * model.full_load_peak()


def mode_frequencies(model: Model, gear: str = "") -> dict[str, float]:
    """Frequencies [Hz] of the modes that live in the absorber's springs and in the clutch, under `mean_torque`."""
    found = modal(at_operating_point(model, mean_torque(model), gear)[0])
    found = found.isel(mode=np.flatnonzero(found.frequency.values > 0))
    known = set(found.element.values.tolist())
    groups = {name: [part for part in parts if part in known] for name, parts in model.mode_groups.items()}
    return {name: float(found.frequency[mode_of(found, *parts)]) for name, parts in groups.items() if parts}


def compared(
    models: Mapping[str, Mapping[str, Model]], speed: Array, torque: Array, gear: str = "", *, share: float = 0.5
) -> xr.Dataset:
    """Models by concept and engine, side by side: ``swing`` (concept, engine, mean_torque, speed), half the swing of
    the acceleration at the gearbox input over a cycle, ``strongest`` order of it, and the ``energy`` share of orders.

    Cells that ``share`` of the whole engine's full load does not reach hold NaN, so that all are asked alike.
    ``resonance`` (concept, engine, mode): speed at which the firing order meets the absorber's and the clutch mode.
    """
    first = next(iter(models.values()))
    inside = reached(next(iter(first.values())), speed, torque, share)
    orders = [[input_orders(model, speed, torque, gear) for model in row.values()] for row in models.values()]
    size = np.abs([[each.values for each in row] for row in orders])
    swings = np.array([[swing(each).values for each in row] for row in orders])
    power = np.where(inside[..., None], size**2, 0.0).sum(axis=(2, 3))
    grid = ("concept", "engine", "mean_torque", "speed")
    modes = [[mode_frequencies(model, gear) for model in row.values()] for row in models.values()]
    names = list(dict.fromkeys(name for row in modes for each in row for name in each))
    met = [
        [[2 * np.pi * found.get(name, np.nan) / firing_order(model) for name in names] for found, model in told]
        for told in (zip(row, line.values(), strict=True) for row, line in zip(modes, models.values(), strict=True))
    ]
    return labelled(
        {
            "swing": (grid, np.where(inside, swings, np.nan), "acceleration"),
            "strongest": (grid, np.where(inside, HALF_ORDERS[size.argmax(axis=-1)], np.nan), "engine_order"),
            "energy": (("concept", "engine", "order"), power / power.sum(axis=-1, keepdims=True), "energy_share"),
            "resonance": (("concept", "engine", "mode"), met, "speed"),
            "firing_order": (("engine",), [firing_order(model) for model in first.values()], "engine_order"),
        },
        {
            "concept": (np.array(list(models)), ""),
            "engine": (np.array(list(first)), ""),
            "mean_torque": (torque, "torque"),
            "speed": (speed, "speed"),
            "order": (HALF_ORDERS, "engine_order"),
            "mode": (np.array(names), ""),
        },
        analysis="fewer cylinders",
        amplitude="half peak-to-peak over the cycle, orders 0.5 to 12",
    )


def strongest(data: xr.Dataset) -> xr.DataArray:
    """The order with most of the vibration's mean square over the map, of every concept and engine."""
    found: xr.DataArray = data.order[data.energy.argmax("order")]
    return found


def drawn(data: xr.Dataset) -> Figure:
    """The picture of `compared`."""
    from torsional.plots.cylinders import plot_fewer_cylinders

    return plot_fewer_cylinders(data)
