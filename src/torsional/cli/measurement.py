"""`torsional measurement`: what measurement files hold, the same in other formats, mappings to begin with."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from torsional import __version__
from torsional.cli.answers import print_json
from torsional.cli.documents import json_text
from torsional.cli.failures import clean
from torsional.cli.outputs import Writer, checked, refuse_overwriting, text_writer, written
from torsional.cli.tables import Column, Table, print_tables
from torsional.errors import ModelError
from torsional.measurements.mapped import mapped
from torsional.measurements.mapping_file import load_mapping
from torsional.measurements.reading import read_measurement
from torsional.measurements.starting import starter
from torsional.measurements.writing import WRITERS, writer_of
from torsional.results import save_results

if TYPE_CHECKING:
    import xarray as xr

RESULT = ".nc"
"""The ending of mapped measurements as results."""


def run(what: str, file: Path, **asked: Any) -> None:
    """Answer one of the commands."""
    answers: dict[str, Callable[..., None]] = {"show": _show, "convert": _convert, "mapping": _begin}
    answers[what](file, **asked)


def _show(file: Path, mapping: Path | None, model: Path | None, gear: str, as_json: bool) -> None:
    data = _asked(file, mapping, model, gear)
    rows = [_row(data, str(name)) for name in data.data_vars]
    if as_json:
        head = {"torsional": __version__, "command": "measurement show", "file": str(file)}
        print_json(
            json_text({**head, "attributes": dict(data.attrs), "channels": [row for each in rows for row in each]})
        )
        return
    if "left_out" in data.attrs:
        print(clean(f"Left out, since they hold no numbers: {data.attrs['left_out']}"), end="\n\n")
    print_tables([_table(data, [row for each in rows for row in each])])


def _asked(file: Path, mapping: Path | None, model: Path | None, gear: str) -> xr.Dataset:
    """The measurement, brought to nodes and elements where a mapping says how."""
    if mapping is None:
        if model is not None or gear:
            remedy = "say which channels are which of its nodes with --mapping"
            raise ModelError(
                "a model is asked for with a mapping", where="--model" if model else "--gear", remedy=remedy
            )
        return read_measurement(file)
    from torsional.files import load_model

    plan, described = load_mapping(mapping), None if model is None else load_model(model)
    return mapped(read_measurement(file), plan, described, gear or None)


def _row(data: xr.Dataset, name: str) -> list[dict[str, object]]:
    """What is told of a variable: of each of its places where it has several."""
    values = data[name]
    if values.ndim == 1:
        return [_told(values, name, values)]
    place = str(values.dims[1])
    columns = [values.isel({place: i}) for i in range(values.sizes[place])]
    return [_told(column, f"{name} {column[place].item()}", values) for column in columns if not np.isnan(column).all()]


def _told(values: xr.DataArray, name: str, whole: xr.DataArray) -> dict[str, object]:
    axis = values[values.dims[0]]
    numbers = np.abs(values.values) if np.iscomplexobj(values.values) else values.values
    held = numbers[~np.isnan(numbers)]
    return {
        "channel": name,
        "units": whole.attrs.get("units", ""),
        "over": str(values.dims[0]),
        "samples": int(values.size),
        "rate": axis.attrs.get("sampling_rate"),
        "kind": whole.attrs.get("kind", "signal"),
        "first": float(axis.values[0]),
        "last": float(axis.values[-1]),
        "axis_units": axis.attrs.get("units", ""),
        "least": float(held.min()) if held.size else None,
        "most": float(held.max()) if held.size else None,
        "missing": int(values.size - held.size),
        "group": whole.attrs.get("group", ""),
        "comment": whole.attrs.get("comment", ""),
    }


def _table(data: xr.Dataset, rows: Sequence[dict[str, object]]) -> Table:
    begun = f", begun {data.attrs['start']}" if data.attrs.get("start") else ""
    title = f"{data.attrs.get('source', '')}: {data.attrs.get('format', '')}, {len(rows)} channels{begun}"
    names = ("channel", "unit", "samples", "rate [Hz]", "over [s]", "range")
    columns = [Column(name, "number" if name in names[2:6] else "") for name in names]
    return Table(title, columns, [_cells(row) for row in rows])


def _cells(row: dict[str, Any]) -> list[object]:
    """A line of the table; what runs along no time has its own unit behind it."""
    unit = "" if row["axis_units"] == "s" else f" {row['axis_units']}"
    held = row["samples"] - row["missing"]
    samples = f"{held}/{row['samples']}" if row["missing"] else str(held)
    uneven = "uneven" if row["kind"] == "signal" else row["kind"]
    rate = uneven if row["rate"] is None else f"{row['rate']:.6g}{f' per{unit}' if unit else ''}"
    over = f"{row['first']:.3g} to {row['last']:.3g}{unit}"
    extremes = f"{row['least']:.4g} to {row['most']:.4g}" if held and row["kind"] == "signal" else "-"
    return [row["channel"], row["units"], samples, rate, over, extremes]


def _convert(
    file: Path, output: Path, mapping: Path | None, model: Path | None, gear: str, force: bool, quiet: bool
) -> None:
    endings = (*WRITERS, RESULT) if mapping else tuple(WRITERS)
    inputs = [path for path in (file, mapping, model) if path is not None]
    outputs = checked([output], endings, inputs, where="OUTPUT")
    if not force:
        refuse_overwriting(outputs)
    data = _asked(file, mapping, model, gear)
    written({output: _writer(data, output)})
    if not quiet:
        print(f"written: {output}", file=sys.stderr)


def _writer(data: xr.Dataset, output: Path) -> Writer:
    if output.suffix.lower() == RESULT:
        return lambda draft: save_results(data, draft)
    write = writer_of(output)
    return lambda draft: write(data, draft)


def _begin(file: Path, output: Path | None, force: bool) -> None:
    outputs = checked([output] if output else None, (".yaml", ".yml"), [file])
    if not force:
        refuse_overwriting(outputs)
    text = starter(read_measurement(file))
    if not outputs:
        print(text, end="")
    written({path: text_writer(text) for path in outputs})
