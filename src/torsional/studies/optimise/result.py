"""The answer of an optimisation: every design with its figures, which are best, and what is to be said of them."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.files.scaling import quantity_at, read_document
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import labelled
from torsional.studies.optimise.front import front, knee
from torsional.studies.optimise.generations import Answers, Columns
from torsional.studies.optimise.search import scored
from torsional.studies.optimise.task import Method, Task
from torsional.studies.sweeps.work import OK, STATUS
from torsional.units import show

NOMINAL, KNEE, SEARCHED = "nominal", "knee", ", before gradients"
KNEE_WORDS = (
    "the knee is the design of the front with the least sum of objectives, each scaled from its best on the front, 0, "
    "to its worst there, 1: of two objectives the one farthest from the line through both ends"
)


def best_of(name: str) -> str:
    """The role of the end of the front at which an objective is best."""
    return f"best {name}"


def ends(task: Task, goals: Array) -> dict[str, int]:
    """Places on a front (designs, objectives) at which each objective is best, by role."""
    return {best_of(name): int(goals[:, place].argmin()) for place, name in enumerate(task.objectives)}


def told(
    task: Task,
    method: Method,
    found: Sequence[tuple[Columns, Answers]],
    searched: int,
    reason: str,
) -> xr.Dataset:
    """All designs along ``design`` with their roles; of the generations ``found`` the first were ``searched``, what
    follows was refined, or there is a ``reason`` why not."""
    sizes = [answers.status.size for _, answers in found]
    scores = [scored(task, answers) for _, answers in found]
    goals, beyond = (np.concatenate([each[side] for each in scores]) for side in (0, 1))
    within = (beyond <= 0).all(axis=1)
    places = np.flatnonzero(within)
    on = places[front(goals[within])] if within.any() else places
    first = int(task.nominal_values is None)
    status = np.concatenate([answers.status for _, answers in found])
    columns = {name: [v for each, _ in found for v in each[name]] for name in task.axes}
    labels: dict[str, Any] = {name: ("design", _labels(values)) for name, values in columns.items()}
    data = _figures(found).assign_coords(**labels, role=("design", _roles(task, goals, within, sum(sizes[:searched]))))
    data = data.assign(
        generation=("design", np.repeat(np.arange(first, first + len(found)), sizes)),
        on_front=("design", np.isin(np.arange(sum(sizes)), on)),
        within=("design", within),
        status=("design", status),
        reason=("design", np.array([r for _, answers in found for r in answers.reasons], dtype=str)),
    )
    data.status.attrs |= {"flag_values": list(range(len(STATUS))), "flag_meanings": "; ".join(STATUS)}
    data = data.assign_attrs(_asked(task, method), knee=KNEE_WORDS, not_refined=reason)
    data.attrs |= {f"designs {word.partition(':')[0]}": int((status == n).sum()) for n, word in enumerate(STATUS)}
    return data.assign_attrs(findings="\n".join(findings(data)))


def _figures(found: Sequence[tuple[Columns, Answers]]) -> xr.Dataset:
    """The figures of all generations, one after the other."""
    quantities = {name: quantity for _, answers in found for name, quantity in answers.quantities.items()}
    figures = {}
    for name, quantity in quantities.items():
        parts = [answers.figures.get(name, np.full(answers.status.size, np.nan)) for _, answers in found]
        figures[name] = (("design",), np.concatenate(parts), quantity)
    return labelled(figures, {}, analysis="optimisation")


def _asked(task: Task, method: Method) -> dict[str, str]:
    """Objectives, limits and method as attributes."""
    limits = {name: _ended(limit.least, limit.most) for name, limit in task.limits.items()}
    return {
        "objectives": json.dumps(list(task.objectives)),
        "maximised": json.dumps(sorted(task.maximised)),
        "limits": json.dumps(limits),
        "method": json.dumps(asdict(method)),
    }


def _ended(least: float, most: float) -> list[float | None]:
    return [end if np.isfinite(end) else None for end in (least, most)]


def _labels(values: Sequence[object]) -> np.ndarray:
    """Values as an array; the defaults of the file, None, as not a number, mixed kinds as texts."""
    if all(v is None or (isinstance(v, int | float) and not isinstance(v, bool)) for v in values):
        return np.array([np.nan if v is None else v for v in values], dtype=float)
    return np.array([v if isinstance(v, str) else json.dumps(v) for v in values])


def _roles(task: Task, goals: Array, within: Any, searched: int) -> np.ndarray:
    """The names of the designs that stand out; a design of several names bears them all."""
    names: list[list[str]] = [[] for _ in within]
    if task.nominal_values is not None:
        names[0].append(NOMINAL)
    for count, word in ((len(within), ""), *(((searched, SEARCHED),) if searched < len(within) else ())):
        places = np.flatnonzero(within[:count])
        on = places[front(goals[places])]
        chosen = ends(task, goals[on]) if on.size else {}
        chosen |= {KNEE: knee(goals[on])} if on.size and len(task.objectives) > 1 else {}
        for role, place in chosen.items():
            names[on[place]].append(f"{role}{word}")
    return np.array(["; ".join(each) for each in names])


def role(data: xr.Dataset, name: str) -> xr.Dataset | None:
    """The design of a role; None where there is none."""
    at = [place for place, told in enumerate(data.role.values) if name in str(told).split("; ")]
    return data.isel(design=at[0]) if at else None


def chosen(data: xr.Dataset) -> xr.Dataset:
    """The designs that stand out in the end: the nominal one, the ends of the front, its knee."""
    names = [NOMINAL, *(best_of(name) for name in json.loads(data.attrs["objectives"])), KNEE]
    places: dict[int, list[str]] = {}
    for name in names:
        for place, told in enumerate(data.role.values):
            if name in str(told).split("; "):
                places.setdefault(place, []).append(name)
    told = ["; ".join(each).replace("_", " ") for each in places.values()]
    return data.isel(design=list(places)).assign_coords(role=("design", np.array(told, dtype=str)))


def findings(data: xr.Dataset) -> Iterator[str]:
    """What an engineer would say of the result, sentence by sentence."""
    objectives, status = json.loads(data.attrs["objectives"]), data.status.values
    failed = int((status != OK).sum())
    count, good = status.size, int(data.within.sum())
    yield (
        f"{count} designs were asked: {good} keep all limits, {count - good - failed} do not, {failed} have no answer."
    )
    if not good:
        yield "No design keeps all limits: widen the ends of the parameters, or the limits."
        return
    yield f"{int(data.on_front.sum())} designs are bettered by none in all objectives; {data.attrs['knee']}."
    own = role(data, NOMINAL)
    for name in [*(best_of(each) for each in objectives), KNEE]:
        one = role(data, name)
        if one is None:
            continue
        yield f"{_named(name)}: {_against(one, own, objectives)}."
        before = role(data, f"{name}{SEARCHED}")
        if before is not None:
            yield f"Gradients made of it what was, before: {_against(before, None, objectives)}."
    if data.attrs["not_refined"]:
        yield f"Not refined by gradients: {data.attrs['not_refined']}."


def _named(role: str) -> str:
    told = role.replace("_", " ")
    return f"{told[:1].upper()}{told[1:]}"


def _against(one: xr.Dataset, other: xr.Dataset | None, objectives: Sequence[str]) -> str:
    return ", ".join(f"{name.replace('_', ' ')} {_shown(one[name])}{_change(one, other, name)}" for name in objectives)


def _shown(value: xr.DataArray) -> str:
    return show(float(value), str(value.attrs.get("quantity", "number")))


def _change(one: xr.Dataset, other: xr.Dataset | None, name: str) -> str:
    if other is None or not np.isfinite(float(other[name])) or float(other[name]) == 0:
        return ""
    change = 100 * (float(one[name]) / float(other[name]) - 1)
    return f" ({change:+.1f} %)"


def quantities(data: xr.Dataset, task: Task) -> dict[str, str]:
    """Criteria and parameters of a result with their quantities, "" where a parameter is none."""
    named = dict.fromkeys((*task.objectives, *task.limits, *map(str, data.data_vars)))
    found = {name: str(data[name].attrs["quantity"]) for name in named if "quantity" in data[name].attrs}
    for path in task.axes:
        found[path] = ""
        if isinstance(task.build, Model) and task.build.document:
            with contextlib.suppress(ModelError):
                found[path] = quantity_at(read_document(task.build.document), path)
    return found
