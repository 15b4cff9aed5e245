"""Results: xarray Datasets with named dimensions, units and provenance; saved as netCDF and loaded again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.units import QUANTITIES

Variable = tuple[tuple[str, ...], Any, str]
"""Dimensions, values, and the quantity's name in the nomenclature."""

SCHEMA = 1
COMPLEX = "real_imaginary"


def dataset(
    variables: Mapping[str, Variable],
    coordinates: Mapping[str, tuple[Any, str] | tuple[Any, str, str]],
    *,
    analysis: str,
    **provenance: object,
) -> xr.Dataset:
    """A Dataset whose every variable carries its unit and long name from the nomenclature.

    ``variables``: {name: (dimensions, values, quantity)}; ``coordinates``: {dimension: (values, quantity or "")}, with
    the dimension as a third entry where the coordinate only labels it;
    ``provenance`` is kept in the attributes (model, hash, settings) beside the analysis and the version.

    >>> ds = dataset({"torque": (("speed",), [1.0], "torque")}, {"speed": ([100.0], "speed")}, analysis="example")
    >>> ds.torque.attrs["units"], ds.speed.attrs["units"]
    ('Nm', 'rad/s')
    """
    from torsional import __version__

    data = {name: xr.Variable(dims, np.asarray(v), _described(q)) for name, (dims, v, q) in variables.items()}
    coords = {name: _coordinate(name, *given) for name, given in coordinates.items()}
    plain = (str, int, float)
    settings = {key: value if isinstance(value, plain) else json.dumps(value) for key, value in provenance.items()}
    attrs = {"analysis": analysis, "torsional_version": __version__, "schema": SCHEMA, **settings}
    return xr.Dataset(data, coords, attrs)


def _coordinate(name: str, values: Any, quantity: str, dimension: str = "") -> xr.Variable:
    return xr.Variable((dimension or name,), np.asarray(values), _described(quantity))


def _described(quantity: str) -> dict[str, str]:
    if not quantity:
        return {}
    entry = QUANTITIES[quantity]
    return {"units": entry.unit, "long_name": entry.long_name, "quantity": quantity}


@checked
def save_results(result: xr.Dataset, path: str | Path) -> Path:
    """Write a Dataset as netCDF 4; complex values become a last dimension of real and imaginary part.

    The file appears whole or not at all: it is written beside its place and then moved there.
    """
    target = Path(path)
    if target.suffix not in (".nc", ".nc4"):
        allowed = "a name ending in .nc"
        raise ModelError("results are saved as netCDF", where="path", found=repr(str(target)), allowed=allowed)
    parts = {name: _split(v) if np.iscomplexobj(v) else v.variable for name, v in result.data_vars.items()}
    plain = xr.Dataset(parts, result.coords, result.attrs)
    partial = target.with_name(f".{target.name}.partial")
    try:
        plain.to_netcdf(partial, engine="h5netcdf")
        partial.replace(target)
    finally:
        partial.unlink(missing_ok=True)
    return target


def _split(values: xr.DataArray) -> xr.Variable:
    pair = np.stack([values.values.real, values.values.imag], axis=-1)
    return xr.Variable((*values.dims, COMPLEX), pair, {**values.attrs, "complex": "yes"})


@checked
def load_results(path: str | Path) -> xr.Dataset:
    """Read what `save_results` wrote, complex values joined again; raises ModelError for anything else."""
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
    pair = values.values
    return xr.Variable(values.dims[:-1], pair[..., 0] + 1j * pair[..., 1], attrs)
