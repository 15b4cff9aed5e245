"""Measurements and results into files that the user's own programs open."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path

import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError, nearest
from torsional.files.opening import shown
from torsional.measurements.reading import silenced
from torsional.measurements.results_file import as_measurement

Write = Callable[[xr.Dataset, Path], None]
WRITERS: Mapping[str, str] = {
    ".mf4": "mdf_writing",
    ".mdf": "mdf_writing",
    ".uff": "uff_writing",
    ".unv": "uff_writing",
    ".mat": "mat_writing",
    ".parquet": "table_writing",
    ".csv": "table_writing",
}
"""Endings that can be written, and the module here that does it."""


@checked
def write_measurement(data: xr.Dataset, path: str | os.PathLike[str]) -> Path:
    """Write a measurement, or a result over time or speed, as MDF 4.10 (.mf4), UFF 58 binary (.uff), MATLAB 5 (.mat),
    Parquet or CSV, by the ending of ``path``.

    Of a result every node and element becomes a channel, "torque clutch", with its unit; every order one of its own,
    "angle crankshaft order 3", complex 0-peak: UFF and MATLAB keep it so, tables have two columns, and MDF, which knows
    signals over time alone, refuses it.  The file appears whole or not at all.  Raises ModelError for an ending that is
    not known, and for what the format cannot hold.

    >>> import tempfile
    >>> from torsional.measurements import read_measurement
    >>> run = xr.Dataset({"torque": (("time", "element"), [[1.0], [2.0]], {"units": "Nm"})}, {"time": [0.0, 0.1],
    ...     "element": ["clutch"]}, {"analysis": "example"})
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     read_measurement(write_measurement(run, f"{folder}/run.uff"))["torque clutch"].values.tolist()
    [1.0, 2.0]
    """
    target = Path(path)
    write = writer_of(target)
    partial = target.with_name(f".partial-{target.name}")
    try:
        write(data, partial)
        partial.replace(target)
    except OSError as error:
        problem = f"the file cannot be written ({error.strerror or error})"
        raise ModelError(problem, file=shown(target)) from None
    finally:
        partial.unlink(missing_ok=True)
    return target


def writer_of(path: Path) -> Write:
    """What writes a file of that ending; ModelError for one that is not known."""
    ending = path.suffix.lower()
    if ending not in WRITERS:
        remedy = nearest(ending, WRITERS, listed=False) if ending else ""
        told = {"found": repr(ending) if ending else f"{shown(path)!r}, a name without one", "remedy": remedy}
        problem = "the ending of the file says what is written, and this one is not known here"
        raise ModelError(problem, where="path", allowed=", ".join(WRITERS), **told)

    def write(data: xr.Dataset, draft: Path) -> None:
        measured = as_measurement(data)
        with silenced():
            import_module(f"torsional.measurements.{WRITERS[ending]}").write(measured, draft)

    return write
