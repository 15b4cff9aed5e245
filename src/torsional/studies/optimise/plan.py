"""Plans of optimisations in files, read as strictly as those of sweeps."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field

from torsional.arguments import checked
from torsional.errors import ModelError, nearest
from torsional.files.faults import told_of
from torsional.files.load import load_model
from torsional.files.reader import read_tree
from torsional.files.schema.fields import Block, only_version
from torsional.model import Model
from torsional.studies.optimise.task import Limit, Method, Task
from torsional.studies.sweeps.criteria import CriteriaRun
from torsional.studies.sweeps.plan import Parameter, asked_of, axes_of
from torsional.units import quoted, read

VERSION, KEY = 1, "torsional_optimise"
Count = Annotated[int, Field(ge=1, le=10_000)]


def _version(value: object) -> object:
    return only_version(value, VERSION, KEY)


class Bound(Block):
    """The least and the most that a criterion may be."""

    least: float | int | str | None = None
    most: float | int | str | None = None


class Search(Block):
    """How long and from which seed it is searched."""

    population: Annotated[int, Field(ge=4, le=10_000)] = 40
    generations: Count = 30
    seed: Annotated[int, Field(ge=0, lt=2**32)] = 1


class OptimiseFile(Block):
    """A plan: the model, what may be chosen, criteria, which of them are objectives and which have limits."""

    torsional_optimise: Annotated[int, BeforeValidator(_version)]
    name: str = Field("", max_length=200)
    model: str = Field(description="model file, beside the plan")
    over: list[Parameter] = Field(description="parameters with their ends, or values", min_length=1)
    run: CriteriaRun
    objectives: list[str] = Field(description="criteria to be made small", min_length=1, max_length=10)
    maximise: list[str] = Field(default_factory=list, description="objectives to be made large")
    constraints: dict[str, Bound] = Field(default_factory=dict, description="limits of criteria by name")
    method: Search = Field(default_factory=lambda: Search.model_validate({}))
    refine: bool = Field(True, description="ends and knee by gradients")
    processes: Annotated[int, Field(ge=0, le=4096)] = Field(0, description="side by side; 0: one a core")


@dataclass(frozen=True)
class Asked:
    """An optimisation as it is asked for: its ``name``, the ``task``, how it is searched, and how many designs
    ``between`` the ends of the front are refined (-1: none is)."""

    name: str
    task: Task
    method: Method
    between: int = 3
    processes: int | None = None


@checked
def load_optimisation(path: str | os.PathLike[str]) -> Asked:
    """The optimisation of a plan's file; what it names is read from its own folder.

    ModelError, and no other error, says what is wrong: file, key path with line, what was found, what is allowed.
    """
    tree, folder = read_tree(path), Path(path).parent
    if KEY not in tree.data:
        remedy = "torsional sweep takes this plan" if "torsional_sweep" in tree.data else f"write '{KEY}: {VERSION}'"
        raise ModelError(f"the key '{KEY}' is missing", remedy=remedy, file=tree.file)
    with told_of(tree):
        file = OptimiseFile.model_validate(tree.data)
        return _asked(file, load_model(folder / file.model), folder, Path(path).stem)


def _asked(file: OptimiseFile, model: Model, folder: Path, stem: str) -> Asked:
    run = asked_of(file.run, folder, model)
    assert isinstance(run, CriteriaRun)
    axes = axes_of(file.over, model, "latin_hypercube")
    for number, name in enumerate(file.maximise):
        if name not in file.objectives:
            told = {"found": quoted(name), "remedy": nearest(name, file.objectives)}
            raise ModelError("this is no objective", where=f"maximise.{number}", **told)
    limits = {name: limit_of(run, name, bound, model) for name, bound in file.constraints.items()}
    task = Task(model, axes, run, tuple(file.objectives), limits, frozenset(file.maximise))
    task.refuse_unknown(run.criteria)
    method = Method(file.method.population, file.method.generations, file.method.seed)
    return Asked(file.name or stem, task, method, 3 if file.refine else -1, file.processes or None)


def limit_of(run: CriteriaRun, name: str, bound: Bound, model: Model) -> Limit:
    """The limit of a criterion in SI; ModelError for an unknown one, and for what is no value of its quantity."""
    where = f"constraints.{name}"
    if name not in run.criteria:
        told = {"found": quoted(name), "remedy": nearest(name, run.criteria)}
        raise ModelError("there is no such criterion", where="constraints", **told)
    quantity = run.quantity(name, model) or "number"
    told_ends: dict[str, Any] = {key: getattr(bound, key) for key in ("least", "most")}
    values = {key: read(end, quantity, f"{where}.{key}") for key, end in told_ends.items() if end is not None}
    try:
        return Limit(values.get("least", -np.inf), values.get("most", np.inf))
    except ModelError as error:
        raise error.located(prefix=where) from None
