"""The report on an optimisation: the front, the designs that stand out beside the nominal one, and their vibration."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import Path

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.model import Model
from torsional.plots.fronts import plot_chosen, plot_front
from torsional.report.blocks import Block, Items, Section, Table, Text, picture
from torsional.report.page import html_page
from torsional.studies.optimise.curves import curves_of
from torsional.studies.optimise.plan import Asked
from torsional.studies.optimise.result import chosen, quantities
from torsional.studies.sweeps.work import OK
from torsional.units import QUANTITIES, show

REASONS = 5


def write_optimisation(found: xr.Dataset, asked: Asked, path: Path) -> Path:
    """Write one self-contained HTML page about the ``found`` designs."""
    build = asked.task.build
    models = [(build.name, build.hash)] if isinstance(build, Model) else []
    subject = models[0][0] if models else asked.name
    parts = [_words(found), _front(found), _chosen(found, asked), _curves(found, asked), _method(found, asked)]
    page = html_page(asked.name, "the best designs", f"The best designs of: {subject}", parts, models)
    path.write_text(page, encoding="utf-8")
    return path


def _words(found: xr.Dataset) -> Section:
    return Section("found", "What was found", (Items("In words", tuple(found.attrs["findings"].split("\n"))),))


def _front(found: xr.Dataset) -> Section:
    several = len(json.loads(found.attrs["objectives"])) > 1
    caption = (
        "Every design that was asked, by its objectives; designs far out are left out of the picture. "
        if several
        else ""
    )
    caption += "The line joins designs that no other one betters." if several else "The best design so far."
    drawn = picture(plot_front(found), caption, "Designs by their objectives, with the front and the chosen ones.")
    return Section("front", "The front" if several else "The search", (drawn,))


def _chosen(found: xr.Dataset, asked: Asked) -> Section:
    best = chosen(found)
    head = ("", *best.role.values.tolist())
    every = quantities(found, asked.task)
    marked = {name: _marked(name, found, asked) for name in every}
    rows = {
        name: (marked[name], *(_shown(value, quantity) for value in best[name].values))
        for name, quantity in every.items()
    }
    criteria = tuple(row for name, row in rows.items() if name not in asked.task.axes)
    values = tuple(rows[name] for name in asked.task.axes)
    numbers = frozenset(range(1, len(head)))
    blocks: tuple[Block, ...] = (
        Table("What they do", head, criteria, numbers),
        Table("What they are", head, values, numbers),
    )
    return Section("designs", "The designs that stand out", blocks)


def _marked(name: str, found: xr.Dataset, asked: Asked) -> str:
    """A row's name, an objective and its limit told."""
    told = name if name in asked.task.axes else name.replace("_", " ")
    notes = []
    if name in asked.task.objectives:
        notes.append("as large as can be" if name in asked.task.maximised else "as small as can be")
    limit = asked.task.limits.get(name)
    if limit is not None:
        quantity = str(found[name].attrs.get("quantity", "number"))
        notes += [f"least {show(limit.least, quantity)}"] if np.isfinite(limit.least) else []
        notes += [f"most {show(limit.most, quantity)}"] if np.isfinite(limit.most) else []
    return f"{told} ({', '.join(notes)})" if notes else told


def _shown(value: object, quantity: str) -> str:
    if isinstance(value, float | np.floating) and not np.isfinite(value):
        return "default"
    if quantity in QUANTITIES:
        return show(float(value), quantity)  # type: ignore[arg-type]
    return f"{value:.4g}" if isinstance(value, float | np.floating) else str(value)


def _curves(found: xr.Dataset, asked: Asked) -> Section:
    title = "Their vibration over speed"
    try:
        data, words = curves_of(asked.task, found)
    except ModelError as error:
        return Section("curves", title, (Text(f"No curves over speed: {error}.", "note"),))
    caption = f"Acceleration at the gearbox input, {words}."
    return Section("curves", title, (picture(plot_chosen(data), caption, "Acceleration over engine speed."),))


def _method(found: xr.Dataset, asked: Asked) -> Section:
    method = json.loads(found.attrs["method"])
    kinds = {1: "differential evolution", 2: "NSGA-II"}
    words = (
        f"Searched by {kinds.get(len(asked.task.objectives), 'NSGA-III')}: {method['generations']} generations of "
        f"{method['population']} designs, seed {method['seed']}; the same seed gives the same designs. Ends, designs "
        f"between them and the knee were refined by sequential quadratic programming with exact derivatives of the "
        f"linear response."
    )
    if found.attrs["not_refined"]:
        words = words.partition(" Ends,")[0] + f" Not refined by gradients: {found.attrs['not_refined']}."
    axes = [
        (
            name,
            *(_end(value, found, asked, name) for value in ((axis.low, axis.high) if not axis.levels else axis.levels)),
        )
        for name, axis in asked.task.axes.items()
    ]
    rows = tuple(
        (name, " to ".join(ends) if not asked.task.axes[name].levels else ", ".join(ends)) for name, *ends in axes
    )
    blocks: list[Block] = [Text(words), Table("What may be chosen", ("", "values"), rows)]
    failed = found.status.values != OK
    if failed.any():
        told = Counter(map(str, found.reason.values[failed])).most_common(REASONS)
        blocks.append(Items(f"{int(failed.sum())} designs have no answer", tuple(f"{n} × {why}" for why, n in told)))
    return Section("method", "How it was searched", tuple(blocks))


def _end(value: object, found: xr.Dataset, asked: Asked, name: str) -> str:
    return _shown(value, quantities(found, asked.task)[name])
