"""MATLAB 5 files: a vector a channel and a raster, and structures that tell their units, names and rasters."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.measurements.mat_channels import EVENTS, NAMES, RASTERS, START, UNITS
from torsional.measurements.recording import PULSES

LONGEST = 63
"""Letters of a name."""
MOST = 2**31 - 1
_KEYWORDS = {
    *("break", "case", "catch", "classdef", "continue", "else", "elseif", "end", "for", "function", "global"),
    *("if", "otherwise", "parfor", "persistent", "return", "spmd", "switch", "try", "while"),
}


def write(data: xr.Dataset, path: Path) -> None:
    """Write every raster and channel as a column vector."""
    from scipy.io import savemat

    dims = {str(dim): name for dim, name in zip(data.dims, _identifiers(map(str, data.dims), ()), strict=True)}
    titles = [str(name) for name in data.data_vars]
    names = dict(zip(titles, _identifiers(titles, dims.values()), strict=True))
    vectors: dict[str, Any] = {short: np.asarray(data[dim].values) for dim, short in dims.items()}
    vectors |= {short: np.asarray(data[title].values) for title, short in names.items()}
    for name, values in vectors.items():
        if values.nbytes > MOST:
            raise ModelError("MATLAB 5 holds 2 GB a variable", where=repr(name), found=f"{values.nbytes} bytes")
    units = {short: str(data[dim].attrs.get("units", "")) for dim, short in dims.items()}
    units |= {short: str(data[title].attrs.get("units", "")) for title, short in names.items()}
    rasters = {short: dims[str(data[title].dims[0])] for title, short in names.items()}
    events = {short: 1.0 for title, short in names.items() if data[title].attrs.get("kind") == PULSES}
    notes: dict[str, Any] = {UNITS: units, NAMES: {short: title for title, short in names.items()}, RASTERS: rasters}
    notes |= {EVENTS: events} if events else {}
    start = {START: data.attrs["start"]} if data.attrs.get("start") else {}
    savemat(path, vectors | notes | start, long_field_names=True, oned_as="column", appendmat=False)


def _identifiers(titles: Iterable[str], taken: Iterable[str]) -> list[str]:
    """Names as MATLAB has them, letters, digits and underscores, no two alike."""
    used = {UNITS, NAMES, RASTERS, START, EVENTS, *_KEYWORDS, *taken}
    found = []
    for title in titles:
        plain = re.sub(r"[^A-Za-z0-9_]+", "_", title).strip("_")
        plain = (plain if plain[:1].isalpha() else f"x{plain}")[:LONGEST]
        numbered = (f"{plain[: LONGEST - 8]}_{number}" for number in range(2, MOST))
        name = plain if plain not in used else next(each for each in numbered if each not in used)
        used.add(name)
        found.append(name)
    return found
