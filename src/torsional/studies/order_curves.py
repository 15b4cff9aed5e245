"""Order curves as measuring systems export them and as results hold them: one quantity at one place, over speed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Literal

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError, nearest
from torsional.files.opening import TABLE_BYTES, read_text, shown
from torsional.quantities import acceleration, angular_velocity
from torsional.results import labelled, load_results
from torsional.tables import cells, named, parse_table

Amplitude = Literal["0-peak", "RMS", "peak-to-peak"]
TO_PEAK: dict[str, float] = {"0-peak": 1.0, "RMS": float(np.sqrt(2.0)), "peak-to-peak": 0.5}
NODAL: dict[str, Callable[[xr.DataArray], xr.DataArray]] = {
    "acceleration": acceleration,
    "angular_velocity": angular_velocity,
    "angle": lambda angle: angle,
}
"""Quantities of nodes, and how they follow from the orders of its angle."""
BETWEEN = {"torque": "torque", "relative_angle": "twist"}
"""Quantities of connections, and their names in results."""
CARRIED = (*NODAL, *BETWEEN)


@checked
def curves_of_table(path: str | Path, amplitude: Amplitude = "0-peak") -> xr.DataArray:
    """Measured orders (order, speed) of a table in CSV, as 0-peak amplitudes, complex where it has a phase.

    Columns ``speed``, ``order`` and one that names the quantity: ``acceleration``, ``angular_velocity``, ``angle``,
    ``torque`` or ``relative_angle``; and ``phase`` where it was measured: that of Re X exp(i n α), α the crank angle.
    Units stand in the header; ``amplitude`` says what the table tells.  Speeds at which an order was not measured are
    no numbers.  Raises ModelError, with the file's name, for a table that cannot be read.
    """
    text = read_text(path, TABLE_BYTES)
    try:
        return _parsed(text, TO_PEAK[amplitude])
    except ModelError as error:
        raise error.located(file=shown(path)) from None


def _parsed(text: str, factor: float) -> xr.DataArray:
    heads = [named(cell)[0] for cell in cells(text).header]
    quantities = [head for head in heads if head in CARRIED]
    if len(quantities) != 1:
        found = ", ".join(quantities) or "none"
        raise ModelError("one column must name the quantity", where="header", found=found, allowed=", ".join(CARRIED))
    (quantity,) = quantities
    columns = {"speed": "speed", "order": "engine_order", quantity: quantity}
    columns |= {"phase": "angle"} if "phase" in heads else {}
    table = {name: np.array(values) for name, values in parse_table(text, columns).items()}
    size = factor * table[quantity]
    values = size * np.exp(1j * table["phase"]) if "phase" in table else size
    orders, row = np.unique(table["order"], return_inverse=True)
    speeds, column = np.unique(table["speed"], return_inverse=True)
    if np.unique(row * speeds.size + column).size < row.size:
        raise ModelError("a speed stands twice in one order", where="speed")
    grid = np.full((orders.size, speeds.size), np.nan, dtype=values.dtype)
    grid[row, column] = values
    return curves(grid, orders, speeds, quantity)


def curves(values: np.ndarray, orders: np.ndarray, speeds: np.ndarray, quantity: str) -> xr.DataArray:
    """Values (order, speed) of a quantity, labelled."""
    axes = {"order": (orders, "engine_order"), "speed": (speeds, "speed")}
    data = labelled({quantity: (("order", "speed"), values, quantity)}, axes, analysis="order curves")
    return data[quantity].assign_attrs(amplitude="0-peak")


@checked
def curves_of_result(
    result: xr.Dataset | str | Path, place: str, quantity: str = "", selection: dict[str, str | float] | None = None
) -> xr.DataArray:
    """The orders (order, speed) of a quantity at a ``place`` of a result: a node or a connection by its name.

    ``quantity`` (default: ``acceleration`` of nodes, ``torque`` of connections); ``selection``: values of further
    dimensions, as ``{"gear": "12"}``.  Raises ModelError for names that the result does not have, and where a further
    dimension has several values.
    """
    data = load_results(result) if isinstance(result, str | Path) else result
    nodes, elements = (data[dim].values.tolist() if dim in data.coords else [] for dim in ("node", "element"))
    if place not in nodes and place not in elements:
        known = [*map(str, nodes), *map(str, elements)]
        raise ModelError("the result has no such place", found=repr(place), remedy=nearest(place, known))
    nodal = place in nodes if quantity in ("", *CARRIED[:3]) and place in nodes else False
    asked = quantity or ("acceleration" if nodal else "torque")
    own = _orders(data, place, asked, nodal)
    for dim, value in (selection or {}).items():
        own = _picked(own, dim, value)
    rest = {str(dim): size for dim, size in own.sizes.items() if dim not in ("order", "speed") and size > 1}
    if rest:
        dim, size = next(iter(rest.items()))
        raise ModelError("one curve an order is wanted", found=f"{size} values of '{dim}'", remedy=f"choose one {dim}")
    alone = own.squeeze([dim for dim in own.dims if dim not in ("order", "speed")], drop=True)
    flat = alone.transpose("order", "speed")
    return curves(flat.values, flat.order.values, flat.speed.values, asked)


def _orders(data: xr.Dataset, place: str, quantity: str, nodal: bool) -> xr.DataArray:
    if quantity not in CARRIED or nodal != (quantity in NODAL):
        allowed = ", ".join(NODAL if nodal else BETWEEN)
        raise ModelError("there is no such quantity at this place", where=place, found=quantity, allowed=allowed)
    name = "angle" if nodal else BETWEEN[quantity]
    if name not in data or not {"order", "speed"} <= set(data[name].dims):
        raise ModelError("the result holds no orders over speed of it", where=place, found=quantity)
    own = data[name].sel({"node" if nodal else "element": place})
    return NODAL[quantity](own) if nodal else own


def _picked(values: xr.DataArray, dim: str, value: str | float) -> xr.DataArray:
    if dim not in values.dims:
        return values
    try:
        if isinstance(value, str):
            return values.sel({dim: value})
        return values.sel({dim: value}, method="nearest", tolerance=1e-6 * max(abs(value), 1.0))
    except KeyError:
        known = ", ".join(map(str, values[dim].values[:8]))
        raise ModelError(f"the result has no such {dim}", found=str(value), allowed=known) from None
