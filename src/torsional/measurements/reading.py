"""Measurement files into Datasets, whatever their format; whatever a file holds, nothing but a ModelError comes out."""

from __future__ import annotations

import contextlib
import io
import logging
import os
import sys
import traceback
import warnings
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.files.opening import first_bytes, shown
from torsional.measurements.formats import HEAD, Format, format_of
from torsional.measurements.recording import Found, printable, recording

BYTES = 8_000_000_000


@checked
def read_measurement(path: str | os.PathLike[str]) -> xr.Dataset:
    """The channels of a measurement file: MDF 4, UFF 58, MATLAB 5 and 7.3, CSV, Parquet.

    Every channel is a variable over the dimension of its raster, with the file's values and ``units``, and its
    ``long_name``, ``group`` and ``comment`` where the file has them.  Rasters are ``time`` [s], the next ``time_2`` and
    so on, ``sampling`` "even" or "uneven", with a ``sampling_rate`` [Hz] where even.  Attributes tell the ``format``,
    the ``source``, when the recording began (``start``) and which channels hold no numbers (``left_out``).

    Raises ModelError, and no other error, for what is no such file, is cut or damaged, too large, or holds times that
    do not increase; for MDF and Parquet also where the extra ``measurement`` is not installed.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     written = Path(folder, "run.csv").write_text("time [s],n_mot [rpm]\\n0,1500\\n0.01,1501\\n")
    ...     data = read_measurement(f"{folder}/run.csv")
    >>> data.n_mot.values.tolist(), data.n_mot.attrs["units"], data.time.attrs["sampling_rate"]
    ([1500.0, 1501.0], 'rpm', 100.0)
    """
    file = Path(path)
    form = _form(file)
    try:
        with silenced():
            found: Found = import_module(f"torsional.measurements.{form.module}").read(file)
            return recording(found, file.name)
    except ModelError as error:
        raise error if error.file else error.located(file=shown(path)) from None
    except MemoryError:
        raise ModelError("there is not enough memory for the recording", file=shown(path)) from None
    except Exception as error:
        # A last resort against defects of the libraries that read the formats: damage must end in a sentence.
        problem = f"the file cannot be read as {form.words}"
        told = {"found": printable(" ".join(str(error).split())[:120]) or type(error).__name__}
        raise ModelError(problem, remedy="is it cut or broken?", file=shown(path), **told) from None


def _form(file: Path) -> Format:
    head = first_bytes(file, HEAD, BYTES)
    try:
        return format_of(file, head)
    except ModelError as error:
        raise error.located(file=shown(file)) from None


@contextlib.contextmanager
def silenced() -> Iterator[None]:
    """What libraries that read and write files warn of, log and print is not the user's business: errors are."""
    before, hook = logging.root.manager.disable, sys.unraisablehook
    logging.disable(logging.CRITICAL)
    sys.unraisablehook = _unheard
    try:
        with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
            warnings.simplefilter("ignore")
            yield
    except Exception as error:
        told: BaseException | None = error
        while told is not None:  # what the libraries have half made goes here, where nobody hears it fail to
            traceback.clear_frames(told.__traceback__)
            told = told.__context__
        raise
    finally:
        sys.unraisablehook = hook
        logging.disable(before)


def _unheard(_: object) -> None:
    """What cannot be raised is not told."""
