"""`torsional correlate`: computed orders beside measured ones, order by order."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from torsional.cli import inputs
from torsional.cli.answers import Answer, deliver
from torsional.cli.jobs import RESULTS
from torsional.cli.outputs import checked
from torsional.cli.request import Request, opened
from torsional.cli.tables import Column, Table
from torsional.errors import ModelError
from torsional.model import Landmarks, Model
from torsional.solvers.run_up import run_up_response
from torsional.studies.correlation import correlation, in_words
from torsional.studies.order_curves import TO_PEAK, curves_of_result, curves_of_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SUFFIXES = (*RESULTS, ".html")
RESULT = (".nc", ".nc4")
COLUMNS = {
    "speeds": ("speeds", "number"),
    "amplitude_error": ("amplitude error", "relative_difference"),
    "peak_error": ("peak error", "relative_difference"),
    "peak_shift": ("peak shift", "speed"),
    "phase_difference": ("phase", "angle"),
    "frac": ("FRAC", "ratio"),
    "relative_deviation": ("relative deviation", "relative_difference"),
    "r_squared": ("R²", "ratio"),
}


def run(
    measured: Path,
    computed: Path,
    node: Sequence[str] | None,
    element: Sequence[str] | None,
    gear: str,
    torque: str,
    amplitude: str,
    changes: Sequence[str] | None,
    as_json: bool,
    output: Sequence[Path] | None,
    quiet: bool,
) -> None:
    """Answer the command."""
    outputs = checked(output, SUFFIXES, [measured, computed])
    place = _place(node, element)
    seen = _measured(measured, place, amplitude, gear)
    told, model = _computed(computed, place, str(seen.name), seen, gear, torque, changes)
    found = correlation(seen, told).assign_attrs(place=place)
    named = [(model.name, model.hash)] if model else []
    sentences = in_words(found)
    answer = Answer(
        "correlate",
        [table_of(found)],
        {"settings": {"measured": str(measured), "computed": str(computed), "place": place}},
        found,
        picture=lambda: _picture(found),
        sentences=sentences,
        page=lambda draft: _page(found, sentences, named, draft),
    )
    request = Request(model or Model("measurement", {}, Landmarks()), computed, changes or (), outputs, as_json, quiet)
    deliver(answer, request)


def _place(node: Sequence[str] | None, element: Sequence[str] | None) -> str:
    named = [*(node or ()), *(element or ())]
    if len(named) != 1:
        found = ", ".join(named) or "none"
        raise ModelError("one place is compared", where="--node, --element", found=found, remedy="name one of both")
    return named[0]


def _measured(path: Path, place: str, amplitude: str, gear: str) -> xr.DataArray:
    if path.suffix.lower() in RESULT:
        return curves_of_result(path, place, selection=_selected(gear))
    if amplitude not in TO_PEAK:
        raise ModelError("there is no such amplitude", where="--amplitude", found=amplitude, allowed=", ".join(TO_PEAK))
    return curves_of_table(path, amplitude)  # type: ignore[arg-type]


def _selected(gear: str) -> dict[str, str | float] | None:
    return {"gear": gear} if gear else None


def _computed(
    path: Path,
    place: str,
    quantity: str,
    seen: xr.DataArray,
    gear: str,
    torque: str,
    changes: Sequence[str] | None,
) -> tuple[xr.DataArray, Model | None]:
    """Orders out of a result, or those of a model at the measured speeds."""
    if path.suffix.lower() in RESULT:
        for name, value in (("--torque", torque), ("--set", changes)):
            if value:
                raise ModelError("a result was computed as it is", where=name, remedy="name a model file instead")
        return curves_of_result(path, place, quantity, _selected(gear)), None
    model = opened(path, changes)
    engaged, speeds = inputs.one_gear(model, gear), seen.speed.values
    mean: Any = np.full(speeds.size, inputs.torque(model, torque, speeds)) if torque else None
    found = run_up_response(model, speeds, mean, engaged, seen.order.values[seen.order.values > 0])
    return curves_of_result(found, place, quantity), model


def table_of(found: xr.Dataset) -> Table:
    """Deviations, an order a row."""
    columns = [Column("order", "engine_order"), *(Column(words, kind) for words, kind in COLUMNS.values())]
    values = [found.order.values, *(found[name].values for name in COLUMNS)]
    return Table(
        f"Computed less measured: {found.attrs['quantity'].replace('_', ' ')} of {found.attrs['place']}",
        columns,
        [list(row) for row in zip(*(each.tolist() for each in values), strict=True)],
    )


def _picture(found: xr.Dataset) -> Figure:
    from torsional.plots.correlation import plot_correlation

    return plot_correlation(found)


def _page(found: xr.Dataset, sentences: Sequence[str], models: Sequence[tuple[str, str]], draft: Path) -> None:
    from torsional.report.identification import write_correlation

    write_correlation(found, sentences, models, draft)
