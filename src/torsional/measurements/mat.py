"""MATLAB 5 files through SciPy, after their elements have been walked through."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from torsional.files.opening import read_bytes
from torsional.measurements.mat_channels import found_in
from torsional.measurements.mat_elements import sound_variables
from torsional.measurements.recording import Found

BYTES = 4_000_000_000


def read(path: Path) -> Found:
    """The channels of numeric variables and structures; objects, functions and what else could run are left alone."""
    from scipy.io import loadmat

    sound, left_out = sound_variables(read_bytes(path, BYTES))
    tree = loadmat(path, variable_names=sound, chars_as_strings=True) if sound else {}
    found = found_in({name: _plain(tree[name]) for name in sound if name in tree}, "MATLAB 5")
    return Found(found.channels, found.format, found.start, [*found.left_out, *left_out])


def _plain(value: Any) -> Any:
    """An array, a text, or a structure as a mapping; None for anything else."""
    if type(value) is not np.ndarray:
        return None
    if value.dtype.names is not None:
        return {name: _plain(value[name].ravel()[0]) for name in value.dtype.names} if value.size == 1 else None
    if value.dtype.kind == "U":
        return str(value.ravel()[0]) if value.size == 1 else ""
    return value if value.dtype.kind in "biufc" else None
