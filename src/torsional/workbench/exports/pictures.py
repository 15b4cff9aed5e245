"""Views as pictures, in the look of all others; several designs side by side or over each other."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.errors import ModelError
from torsional.plots import panels, plot_campbell, plot_chain, plot_map, plot_mode_shapes, plot_order_cuts, style
from torsional.plots.maps import colour_limits
from torsional.results import labelled
from torsional.units import show
from torsional.workbench.exports import tables
from torsional.workbench.exports.seen import Seen, alone

PANELS = 48


def picture(view: str, seen: Sequence[Seen]) -> Figure:
    """The picture of a view; ModelError for a view that has none."""
    if view not in PICTURES:
        allowed = ", ".join(PICTURES)
        raise ModelError("there is no picture of this view", where="ask.view", found=view, allowed=allowed)
    return PICTURES[view](seen)


@style.styled
def response(seen: Sequence[Seen]) -> Figure:
    """Orders over speed, a panel for each place, a colour for each design."""
    first = seen[0].answer
    places = [place["name"] for place in first["places"]]
    if not places:
        raise ModelError("no place is looked at", where="ask.nodes", remedy="choose a node or a connection")
    columns = min(2, len(places))
    drawn = panels(-(-len(places) // columns), columns, (7.0, 3.8))
    for axes, place in zip(drawn, places, strict=False):
        lines = {each.name or "response": _orders(each, place) for each in seen}
        plot_order_cuts(lines, "", first["orders"], axes=axes)
        style.operating_range(axes, None, first["idle"])
        axes.set_title(f"{style.readable(place)}{_in_gear(first['gear'])}")
        axes.legend()
    return _without(drawn[len(places) :], drawn)


def _orders(seen: Seen, place: str) -> xr.DataArray:
    """Amplitudes (gear, speed, order) of one place; ModelError where a design does not have it."""
    answer = seen.answer
    known = [each["name"] for each in answer["places"]]
    if place not in known:
        raise ModelError(f"'{seen.name}' has no place '{place}'", where="variants", remedy="choose one that all have")
    number = known.index(place)
    quantity = answer["places"][number]["quantity"]
    coordinates = {"speed": (answer["speed"], "speed"), "order": (answer["orders"], "engine_order"), "gear": ([""], "")}
    variable = (("gear", "speed", "order"), answer["value"][number].T[None], quantity)
    found: xr.DataArray = labelled({"value": variable}, coordinates, analysis="response")["value"]
    return found


@style.styled
def over_map(seen: Sequence[Seen]) -> Figure:
    """A map for each gear and design, all with the same colours."""
    maps = [(each, values) for each in seen for values in _maps(each)]
    if len(maps) > PANELS:
        raise ModelError("these are too many maps", found=str(len(maps)), allowed=str(PANELS), remedy="choose a gear")
    columns = min(4 if len(maps) > 4 else 2, len(maps))
    drawn = panels(-(-len(maps) // columns), columns, (6.0, 4.2))
    limits = colour_limits(*(style.shown(values) for _, values in maps))
    for axes, (each, values) in zip(drawn, maps, strict=False):
        answer = each.answer
        place, gear = style.readable(answer["place"]), _in_gear(str(values.gear.values))
        title = f"{place}{gear}, order {answer['order']:g}, 0-peak"
        title += f": {style.plain(each.name, 28)}" if each.name else ""
        within = values.copy(data=answer["within"].astype(bool))
        plot_map(values, within=within, limits=limits, title=title, axes=axes)
    return _without(drawn[len(maps) :], drawn)


def _maps(seen: Seen) -> list[xr.DataArray]:
    data = labelled(*tables.over_map(seen.answer), analysis="map")
    values = next(iter(data.data_vars.values())).rename("value")
    return [values.isel(gear=number) for number in range(values.sizes["gear"])]


@style.styled
def modes(seen: Sequence[Seen]) -> Figure:
    """Mode shapes, a panel for each design."""
    drawn = panels(len(seen), 1, (9.0, 5.0))
    for axes, each in zip(drawn, seen, strict=True):
        data = labelled(*tables.modes(each.answer), analysis="modes")
        powertrain = each.model.powertrain(each.answer["gear"])
        plot_mode_shapes(data, powertrain, names=each.answer["name"], axes=axes)
        axes.set_title(_title(each, f"Modes{_in_gear(each.answer['gear'])}"))
    return style.figure_of(drawn[0])


@style.styled
def interference(seen: Sequence[Seen]) -> Figure:
    """Interference diagrams, a panel for each design."""
    drawn = panels(len(seen), 1, (9.0, 5.2))
    for axes, each in zip(drawn, seen, strict=True):
        answer = each.answer
        orders = {"order": (answer["orders"], "engine_order")}
        found, axes_of = tables.interference(answer)
        crossing = (("gear", "mode", "order"), answer["crossing"], "speed")
        data = labelled({**found, "crossing": crossing}, {**axes_of, **orders}, analysis="interference")
        named = {answer["gears"][-1]: [style.readable(name) for name in answer["name"][-1]]}
        plot_campbell(data, named, speed=each.model.operation.speed, idle=answer["idle"], axes=axes)
        axes.set_title(_title(each, "Interference of orders and modes"))
    return style.figure_of(drawn[0])


@style.styled
def characteristic(seen: Sequence[Seen]) -> Figure:
    """Torque over twist with operating point and swing, a colour for each design."""
    (axes,) = panels(1, 1, (7.6, 4.6))
    for number, each in enumerate(seen):
        answer, colour = each.answer, style.COLOURS[number]
        label = style.plain(each.name or answer["element"].replace("_", " "), 40)
        _spring(axes, each, colour, label)
        point = answer["point"]
        if point:
            at, bar = (float(style.shown(np.array(point[key]), "relative_angle")) for key in ("angle", "swing"))
            height = float(np.interp(point["angle"], answer["angle"], answer["torque"]))
            told = f"{show(point['torque'], 'torque')} at {show(point['speed'], 'speed')}, bar: half peak-to-peak"
            axes.errorbar(at, height, xerr=bar, fmt="o", color=colour, capsize=3.0, label=told)
    axes.set_xlabel(style.label("relative_angle", name="twist"))
    axes.set_ylabel(style.label("torque"))
    axes.set_title(f"{style.readable(seen[0].answer['element'])}{_in_gear(seen[0].answer['gear'])}")
    axes.legend(loc="upper left")
    return style.figure_of(axes)


def _spring(axes: Axes, seen: Seen, colour: str, label: str) -> None:
    """Its curve and its stops; the steep way into a stop is cut off where nothing is to be read any more."""
    answer = seen.answer
    stops = [stop for stop in answer["stops"] if np.isfinite(stop)]
    axes.plot(style.shown(answer["angle"], "relative_angle"), answer["torque"], color=colour, label=label)
    for stop in stops:
        axes.axvline(float(style.shown(np.array(stop), "relative_angle")), color=colour, linestyle=":", linewidth=1.0)
    if stops:
        most = 1.3 * max(abs(float(np.interp(stop, answer["angle"], answer["torque"]))) for stop in stops)
        low, high = axes.get_ylim()
        axes.set_ylim(max(low, -most), min(high, most))


def model(seen: Sequence[Seen]) -> Figure:
    """The chain of discs and springs."""
    one = alone(seen, "model")
    marks = one.model.landmarks
    own = [] if one.model.absorber is None else list(one.model.absorber.components)
    return plot_chain(
        one.model.powertrain(one.answer["gear"]), absorber=own, clutch=marks.clutch, throws=marks.throws
    )


def _in_gear(gear: str) -> str:
    return f", gear {style.plain(gear)}" if gear else ""


def _title(seen: Seen, what: str) -> str:
    return f"{what}: {style.plain(seen.name or seen.model.name, 60)}"


def _without(unused: Sequence[Axes], drawn: Sequence[Axes]) -> Figure:
    for axes in unused:
        axes.remove()
    return style.figure_of(drawn[0])


PICTURES: Mapping[str, Callable[[Sequence[Seen]], Figure]] = {
    "response": response,
    "map": over_map,
    "modes": modes,
    "interference": interference,
    "characteristic": characteristic,
    "model": model,
}
