"""Views as tables: SI values under headings with their units, a row for each place in the grid."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.results import labelled
from torsional.units import QUANTITIES
from torsional.workbench.exports.seen import Seen, alone
from torsional.workbench.views import Answer

Variables = dict[str, tuple[tuple[str, ...], Any, str]]
Coordinates = dict[str, tuple[Any, str]]
PEAK = "0-peak"


def table(view: str, seen: Sequence[Seen]) -> xr.Dataset:
    """What a view shows, designs one below the other; ModelError for a view that is no table."""
    if view not in TABLES:
        raise ModelError("there is no table of this view", where="ask.view", found=view, allowed=", ".join(TABLES))
    if view == "model":
        alone(seen, view)
    parts = [labelled(*TABLES[view](each.answer), analysis=view) for each in seen]
    if len(parts) == 1:
        return parts[0]
    names = xr.DataArray(_told_apart([each.name for each in seen]), dims="variant", name="variant")
    return xr.concat(parts, names, join="outer", combine_attrs="override")


def _told_apart(names: Sequence[str]) -> list[str]:
    """Names of designs, numbered where two have the same."""
    return [name if names.count(name) == 1 else f"{name} ({n + 1})" for n, name in enumerate(names)]


def response(answer: Answer) -> tuple[Variables, Coordinates]:
    """Amplitudes at each place, and the mean torque that belongs to each speed."""
    found: Variables = {
        f"{place['quantity']} {place['name']}, {PEAK}": (("speed", "order"), values.T, place["quantity"])
        for place, values in zip(answer["places"], answer["value"], strict=True)
    }
    found["mean_torque"] = (("speed",), answer["torque"], "torque")
    return found, {"speed": (answer["speed"], "speed"), "order": (answer["orders"], "engine_order")}


def over_map(answer: Answer) -> tuple[Variables, Coordinates]:
    """One amplitude over gear, mean torque and speed."""
    dims = ("gear", "mean_torque", "speed")
    name = f"{answer['quantity']} {answer['place']}, order {answer['order']:g}, {PEAK}"
    found: Variables = {
        name: (dims, answer["value"], answer["quantity"]),
        "within_full_load": (dims[1:], answer["within"].astype(bool), ""),
    }
    axes = {"mean_torque": (answer["torque"], "torque"), "speed": (answer["speed"], "speed")}
    return found, {"gear": (answer["gears"], ""), **axes}


def modes(answer: Answer) -> tuple[Variables, Coordinates]:
    """Frequencies by name, shapes and shares of energy."""
    found: Variables = {
        "frequency": (("mode",), answer["frequency"], "frequency"),
        "name": (("mode",), np.array(answer["name"]), ""),
        "damping_ratio": (("mode",), answer["damping_ratio"], "damping_ratio"),
        "shape": (("mode", "node"), answer["shape"], "mode_shape"),
        "elastic_share": (("mode", "element"), answer["elastic_share"], "energy_share"),
    }
    if answer["order_speed"] is not None:
        found[f"order {answer['order']:g} meets it at"] = (("mode",), answer["order_speed"], "speed")
    places = {"node": (answer["nodes"], ""), "element": (answer["elements"], "")}
    return found, {"mode": (np.arange(len(answer["name"])), ""), **places}


def interference(answer: Answer) -> tuple[Variables, Coordinates]:
    """Frequencies over speed, and the speeds at which orders meet them."""
    found: Variables = {"frequency": (("gear", "mode", "speed"), answer["frequency"], "frequency")}
    for number, order in enumerate(answer["orders"]):
        found[f"order {order:g} meets it at"] = (("gear", "mode"), answer["crossing"][:, :, number], "speed")
    modes = np.arange(answer["frequency"].shape[1])
    return found, {"gear": (answer["gears"], ""), "mode": (modes, ""), "speed": (answer["speed"], "speed")}


def characteristic(answer: Answer) -> tuple[Variables, Coordinates]:
    """Torque over twist."""
    found: Variables = {f"torque {answer['element']}": (("twist",), answer["torque"], "torque")}
    return found, {"twist": (answer["angle"], "relative_angle")}


def criteria(answer: Answer) -> tuple[Variables, Coordinates]:
    """A row for each figure."""
    listed = answer["criteria"]
    columns = {key: np.array([each[key] for each in listed]) for key in ("value", "label", "better")}
    units = np.array([QUANTITIES[each["quantity"]].unit.strip("-") for each in listed])
    found: Variables = {
        "value": (("criterion",), columns["value"].astype(float), ""),
        "unit": (("criterion",), units, ""),
        "meaning": (("criterion",), columns["label"], ""),
        "better": (("criterion",), columns["better"], ""),
    }
    return found, {"criterion": ([each["name"] for each in listed], "")}


def model(answer: Answer) -> tuple[Variables, Coordinates]:
    """The discs of the chain, their inertias referred to engine speed."""
    discs = answer["chain"]["nodes"]
    found: Variables = {
        "inertia": (("disc",), np.array([disc["inertia"] for disc in discs]), "inertia"),
        "speed_ratio": (("disc",), np.array([disc["ratio"] for disc in discs]), "gear_ratio"),
    }
    return found, {"disc": ([disc["name"] for disc in discs], "")}


TABLES: Mapping[str, Callable[[Answer], tuple[Variables, Coordinates]]] = {
    "response": response,
    "map": over_map,
    "modes": modes,
    "interference": interference,
    "characteristic": characteristic,
    "criteria": criteria,
    "model": model,
}
