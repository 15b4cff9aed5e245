"""`torsional optimise`: the best designs of a plan, or of a preset on a truck."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from torsional import __version__
from torsional.cli.answers import print_json
from torsional.cli.documents import described, json_text
from torsional.cli.failures import clean
from torsional.cli.interrupts import Kept, taken
from torsional.cli.outputs import Writer, checked, text_writer, written
from torsional.cli.progress import counting
from torsional.cli.study import truck_of, trucks_of
from torsional.cli.sweep import refuse_begun, tell_states
from torsional.cli.tables import Column, Table, print_tables
from torsional.errors import ModelError, nearest
from torsional.numerics.compiling import WATCH
from torsional.results import save_results
from torsional.studies.optimise.optimise import optimised
from torsional.studies.optimise.plan import Asked, load_optimisation
from torsional.studies.optimise.presets import PRESETS, preset
from torsional.studies.optimise.result import chosen, quantities
from torsional.studies.optimise.search import pymoo
from torsional.units import show

SUFFIXES = (".nc", ".csv", ".json", ".html", ".png", ".svg")


def run(
    plan: str,
    model: Path | None,
    changes: Sequence[str] | None,
    given: Mapping[str, str],
    population: int,
    generations: int,
    seed: int | None,
    folder: Path | None,
    resume: bool,
    processes: int,
    as_json: bool,
    output: Sequence[Path] | None,
    quiet: bool,
) -> None:
    """Answer the command."""
    pymoo()
    asked, outputs, at = _asked(plan, model, changes, given, output, folder)
    own = asked.method
    method = replace(
        own,
        population=population or own.population,
        generations=generations or own.generations,
        seed=own.seed if seed is None else seed,
    )
    if not resume:
        refuse_begun(at)
    silent = quiet or as_json
    try:
        with WATCH.silent(silent), counting(asked.name, "designs", silent) as moved:
            found = optimised(asked.task, method, asked.between, at, processes or asked.processes, moved)
    except KeyboardInterrupt:
        taken()
        raise Kept(f"what was worked out is kept in {at}; --resume goes on") from None
    _deliver(found, asked, at, outputs, as_json, quiet)


def _asked(
    plan: str,
    model: Path | None,
    changes: Sequence[str] | None,
    given: Mapping[str, str],
    output: Sequence[Path] | None,
    folder: Path | None,
) -> tuple[Asked, list[Path], Path]:
    """The optimisation of a plan's file or of a preset, where it goes and where it is kept."""
    if plan in PRESETS:
        truck, outputs = truck_of(model, changes, output, SUFFIXES)
        return preset(plan, trucks_of(truck), given), outputs, folder or Path(f"{plan}.optimise")
    path = Path(plan)
    if not path.suffix and not path.exists():
        raise ModelError("there is no such preset, and no such plan", found=repr(plan), remedy=nearest(plan, PRESETS))
    for name, value in (("MODEL", model), ("--set", changes), *((f"--{key}", each) for key, each in given.items())):
        if value:
            raise ModelError("a plan names its own model and limits", where=name, remedy="change the plan")
    outputs = checked(output, SUFFIXES, [path])
    return load_optimisation(path), outputs, folder or path.with_suffix(".optimise")


def _deliver(
    found: xr.Dataset, asked: Asked, folder: Path, outputs: Sequence[Path], as_json: bool, quiet: bool
) -> None:
    head = {"torsional": __version__, "command": "optimise", "plan": asked.name, "folder": str(folder)}
    wanted = as_json or any(path.suffix.lower() == ".json" for path in outputs)
    text = json_text({**head, "result": described(found)}) if wanted else ""
    written({path: _writer(found, asked, path, text) for path in outputs})
    if as_json:
        print_json(text)
    elif not quiet:
        print("\n".join(map(clean, found.attrs["findings"].split("\n"))), end="\n\n")
        print_tables([chosen_table(found, asked)])
    if not quiet:
        print("\n".join(f"written: {path}" for path in (folder, *outputs)), file=sys.stderr)
    tell_states(found.status.values, found.reason.values)


def _writer(found: xr.Dataset, asked: Asked, path: Path, text: str) -> Writer:
    suffix = path.suffix.lower()
    if suffix == ".json":
        return text_writer(text)
    if suffix in (".png", ".svg"):
        return lambda draft: _drawn(found, draft)
    if suffix == ".html":
        from torsional.report.optimisation import write_optimisation

        return lambda draft: write_optimisation(found, asked, draft)
    return lambda draft: save_results(found, draft)


def _drawn(found: xr.Dataset, draft: Path) -> None:
    from torsional.plots import save_png, save_svg
    from torsional.plots.fronts import plot_front

    figure = plot_front(found)
    draft.write_bytes(save_png(figure) if draft.suffix.lower() == ".png" else save_svg(figure))


def chosen_table(found: xr.Dataset, asked: Asked) -> Table:
    """The designs that stand out, a column each: criteria and parameters."""
    best = chosen(found)
    rows: list[list[Any]] = []
    for name, quantity in quantities(found, asked.task).items():
        rows.append([name.replace("_", " ") if name in found.data_vars else name, *_cells(best[name], quantity)])
    return Table(asked.name, [Column(""), *(Column(str(role)) for role in best.role.values)], rows)


def _cells(values: xr.DataArray, quantity: str) -> list[str]:
    if values.dtype.kind != "f":
        return list(map(str, values.values))
    return [show(float(v), quantity or "number") if np.isfinite(v) else "-" for v in values.values]
