"""Results: xarray Datasets with named dimensions, units and provenance; saved as netCDF or CSV, and loaded again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError, nearest
from torsional.model import Model
from torsional.results.names import ANY, NAMES, Named
from torsional.spreadsheet import BYTE_ORDER_MARK, csv_text
from torsional.units import QUANTITIES

__all__ = ["ANY", "NAMES", "Named", "Variable", "dataset", "labelled", "load_results", "of_model", "save_results"]

Variable = tuple[tuple[str, ...], Any, str]
"""Dimensions, values, and the quantity's name in the nomenclature."""

SCHEMA = 1
COMPLEX = "real_imaginary"


def dataset(
    variables: Mapping[str, Variable],
    coordinates: Mapping[str, tuple[Any, str] | tuple[Any, str, str]],
    means: Mapping[str, str] = MappingProxyType({}),
    /,
    *,
    analysis: str,
    **provenance: object,
) -> xr.Dataset:
    """The result of an analysis: a `labelled` Dataset with names that mean the same in every analysis, see ``NAMES``.

    ``means``: {name: meaning} of variables and coordinates that no other analysis has.  Raises ModelError for a name
    that is in neither, and for a quantity that the name does not stand for.

    >>> ds = dataset({"torque": (("speed",), [1.0], "torque")}, {"speed": ([100.0], "speed")}, analysis="example")
    >>> ds.torque.attrs["units"], ds.speed.attrs["units"]
    ('Nm', 'rad/s')
    """
    told = [(name, quantity) for name, (_, _, quantity) in variables.items()]
    for name, given in coordinates.items():
        if not isinstance(given[1], str):
            remedy = "dimensions stand before the values of a variable, not of a coordinate"
            raise ModelError("a coordinate is (values, quantity)", where=name, found=repr(given)[:60], remedy=remedy)
    for name, quantity in [*told, *((name, given[1]) for name, given in coordinates.items())]:
        if name not in means:
            _known(name, quantity)
    return labelled(variables, coordinates, analysis=analysis, **provenance)


def _known(name: str, quantity: str) -> None:
    if name not in NAMES:
        remedy = nearest(name, NAMES, listed=False) or "tell its meaning as a third argument, {name: meaning}"
        raise ModelError("results have no such name", where=name, remedy=remedy)
    meant = NAMES[name].quantity
    if meant not in (quantity, ANY):
        raise ModelError("the name stands for another quantity", where=name, found=quantity or "none", allowed=meant)


def labelled(
    variables: Mapping[str, Variable],
    coordinates: Mapping[str, tuple[Any, str] | tuple[Any, str, str]],
    *,
    analysis: str,
    **provenance: object,
) -> xr.Dataset:
    """A Dataset by any names, whose every variable carries its unit and long name from the nomenclature.

    ``variables``: {name: (dimensions, values, quantity)}; ``coordinates``: {dimension: (values, quantity or "")}, with
    the dimension as a third entry where the coordinate only labels it;
    ``provenance`` is kept in the attributes (model, hash, settings) beside the analysis and the version.
    """
    from torsional import __version__

    data = {name: xr.Variable(dims, np.asarray(v), _described(q)) for name, (dims, v, q) in variables.items()}
    coords = {name: _coordinate(name, *given) for name, given in coordinates.items()}
    told = {key: v if isinstance(v, str | int | float) else json.dumps(v) for key, v in provenance.items()}
    return xr.Dataset(data, coords, {"analysis": analysis, "torsional_version": __version__, "schema": SCHEMA, **told})


def of_model(data: xr.Dataset, model: Model, gear: str | None = None) -> xr.Dataset:
    """The result with the model it is of in its attributes, and the ``gear`` where it is of one alone."""
    return data.assign_attrs(model=model.name, model_hash=model.hash, **({} if gear is None else {"gear": gear}))


def _coordinate(name: str, values: Any, quantity: str, dimension: str = "") -> xr.Variable:
    return xr.Variable((dimension or name,), np.asarray(values), _described(quantity))


def _described(quantity: str) -> dict[str, str]:
    if not quantity:
        return {}
    entry = QUANTITIES[quantity]
    return {"units": entry.unit, "long_name": entry.long_name, "quantity": quantity}


@checked
def save_results(result: xr.Dataset | xr.DataArray, path: str | Path) -> Path:
    """Write a result, or one quantity of it, whole as netCDF 4 (.nc) or as a table for spreadsheets (.csv).

    In netCDF complex values become a last dimension of real and imaginary part; `load_results` reads it back.  A table
    has a row for each place in the grid, a column for each variable and node or connection, and units in its headings:
    SI, speeds in rpm as well.  Its rows are those of the first variable; what lies over other dimensions is left out.

    The file appears whole or not at all: it is written beside its place and then moved there.  Raises ModelError for
    any other ending.

    >>> import tempfile
    >>> made = dataset({"mean_torque": (("speed",), [1e3], "torque")}, {"speed": ([90.0], "speed")}, analysis="example")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_results(made, f"{folder}/map.csv").read_text(encoding="utf-8-sig").splitlines()[-1]
    '90.0,859.4366926962349,1000.0'
    """
    target = Path(path)
    if target.suffix.lower() not in _WRITERS:
        told = {"found": repr(str(target)), "allowed": "a name ending in .nc, or in .csv for spreadsheets"}
        raise ModelError("results are saved as netCDF or CSV", where="path", **told)
    data = result.to_dataset(name=result.name or "value") if isinstance(result, xr.DataArray) else result
    partial = target.with_name(f".{target.name}.partial")
    try:
        _WRITERS[target.suffix.lower()](data, partial)
        partial.replace(target)
    finally:
        partial.unlink(missing_ok=True)
    return target


def _write_netcdf(data: xr.Dataset, target: Path) -> None:
    parts = {name: _split(v) if np.iscomplexobj(v) else v.variable for name, v in data.data_vars.items()}
    xr.Dataset(parts, data.coords, data.attrs).to_netcdf(target, engine="h5netcdf")


def _write_table(data: xr.Dataset, target: Path) -> None:
    target.write_text(BYTE_ORDER_MARK + csv_text(data), encoding="utf-8", newline="")


_WRITERS = {".nc": _write_netcdf, ".nc4": _write_netcdf, ".csv": _write_table}


def _split(values: xr.DataArray) -> xr.Variable:
    pair = np.stack([values.values.real, values.values.imag], axis=-1)
    return xr.Variable((*values.dims, COMPLEX), pair, {**values.attrs, "complex": "yes"})


@checked
def load_results(path: str | Path) -> xr.Dataset:
    """Read what `save_results` wrote, complex values joined again; raises ModelError for anything else.

    >>> import tempfile
    >>> made = dataset({"mean_torque": (("speed",), [1e3], "torque")}, {"speed": ([90.0], "speed")}, analysis="example")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     load_results(save_results(made, f"{folder}/map.nc")).mean_torque.values.tolist()
    [1000.0]
    """
    try:
        with xr.open_dataset(path, engine="h5netcdf") as opened:
            found = opened.load()
    except (OSError, ValueError, KeyError, RuntimeError) as error:
        raise ModelError("this is not a result file", file=str(path), remedy=str(error)[:120]) from None
    if found.attrs.get("schema") != SCHEMA:
        told = str(found.attrs.get("schema"))
        raise ModelError("the result file has another schema", file=str(path), found=told, allowed=f"schema {SCHEMA}")
    return found.assign({name: _joined(v) for name, v in found.data_vars.items() if COMPLEX in v.dims})


def _joined(values: xr.DataArray) -> xr.Variable:
    attrs = {key: value for key, value in values.attrs.items() if key != "complex"}
    return xr.Variable(values.dims[:-1], values.values[..., 0] + 1j * values.values[..., 1], attrs)
