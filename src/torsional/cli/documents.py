"""Results as JSON: SI values with their units named, every digit kept."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from torsional.units import QUANTITIES

if TYPE_CHECKING:
    import xarray as xr


def amount(value: object, quantity: str) -> dict[str, object]:
    """One SI value with its unit."""
    return {"value": value, "units": QUANTITIES[quantity].unit}


def json_text(document: Mapping[str, object]) -> str:
    """A document as strict JSON: what is no number is null."""
    return json.dumps(_plain(document), ensure_ascii=False, allow_nan=False) + "\n"


def escaped(text: str) -> str:
    """The same JSON document in ASCII."""
    return json.dumps(json.loads(text)) + "\n"


def described(data: xr.Dataset) -> dict[str, object]:
    """A Dataset as a JSON document: attributes, coordinates and variables, complex ones as real and imaginary part."""
    return {
        "attributes": dict(data.attrs),
        "coordinates": {str(name): _variable(values) for name, values in data.coords.items()},
        "variables": {str(name): _variable(values) for name, values in data.data_vars.items()},
    }


def _variable(values: xr.DataArray) -> dict[str, object]:
    told: dict[str, object] = {"dimensions": list(values.dims), **values.attrs}
    if values.dtype.kind == "c":
        return {**told, "real": values.values.real.tolist(), "imaginary": values.values.imag.tolist()}
    return {**told, "values": values.values.tolist()}


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
