"""Plans of sweeps in files: read as strictly as model files, every key path tried on the model before any work."""

from __future__ import annotations

import copy
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.files.edit import changed, put
from torsional.files.faults import told_of
from torsional.files.load import load_model
from torsional.files.opening import TABLE_BYTES, read_text
from torsional.files.reader import read_tree
from torsional.files.scaling import read_document, values_at
from torsional.files.scenario import load_scenario
from torsional.files.scenario_schema import KINDS
from torsional.files.schema.fields import Block, Quantity, only_version
from torsional.model import Model
from torsional.studies.sweeps.analyses import TransientRun
from torsional.studies.sweeps.criteria import CriteriaRun, Question
from torsional.studies.sweeps.designs import Axis, Designs, grid, sampled, table
from torsional.studies.sweeps.sweep import CHUNK
from torsional.studies.sweeps.verdicts import ClaimsRun
from torsional.studies.sweeps.work import Run, Work
from torsional.studies.sweeps.workers import Processes, Settings
from torsional.tables import cells, named, numbers
from torsional.units import quoted

VERSION, KEY = 1, "torsional_sweep"
Share = Annotated[float, Quantity("ratio", above=0)]
MANY = 10_000_000


def _version(value: object) -> object:
    return only_version(value, VERSION, KEY)


class Choice(Block):
    """How designs are chosen."""

    method: Literal["grid", "latin_hypercube", "sobol", "morris", "saltelli", "table"] = "grid"
    count: Annotated[int, Field(ge=1, le=MANY)] | None = Field(
        None, description="of hypercubes and Sobol points, of Morris's trajectories, of Saltelli's base points"
    )
    seed: Annotated[int, Field(ge=0, lt=2**32)] = 0
    file: str = Field("", description="of a table: CSV with key paths as header, beside the plan")


class Parameter(Block):
    """What one key path of the model may be: ``values``, all from ``low`` to ``high``, or the model's own value and as
    much to either side as ``tolerance`` says."""

    parameter: str = Field(description="key path of the model file, as clutch.stiffness")
    values: list[Any] | None = None
    low: float | int | str | None = None
    high: float | int | str | None = None
    tolerance: Share | None = Field(None, description="share of the model's own value, as 10 %")
    points: Annotated[int, Field(ge=2, le=1_000_000)] | None = Field(None, description="of a grid")
    spacing: Literal["even", "logarithmic"] = "even"


class SweepFile(Block):
    """A plan: the model, what is varied and how, what is asked of every design."""

    torsional_sweep: Annotated[int, BeforeValidator(_version)]
    name: str = Field("", max_length=200)
    model: str = Field(description="model file, beside the plan")
    over: list[Parameter] = Field(default_factory=list, description="parameters with their values or ends")
    designs: Choice = Field(default_factory=lambda: Choice.model_validate({}))
    run: Question
    chunk: Annotated[int, Field(ge=1, le=100_000)] = CHUNK
    workers: Settings = Field(
        default_factory=lambda: Processes(kind="processes", count=0), description="who works on it"
    )


@dataclass(frozen=True)
class Plan:
    """A sweep as its file asks for it: the ``work``, designs a ``chunk``, the ``workers``."""

    name: str
    work: Work
    chunk: int
    workers: Settings


@checked
def load_plan(path: str | os.PathLike[str]) -> Plan:
    """The plan of a file; what it names is read from its own folder.

    ModelError, and no other error, says what is wrong: file, key path with line, what was found, what is allowed.  The
    first value of every parameter is tried on the model, so that a misspelt key path is told before any work.
    """
    tree, folder = read_tree(path), Path(path).parent
    if KEY not in tree.data:
        remedy = "is this a model file?" if "torsional" in tree.data else f"write '{KEY}: {VERSION}'"
        raise ModelError(f"the key '{KEY}' is missing", remedy=remedy, file=tree.file)
    with told_of(tree):
        file = SweepFile.model_validate(tree.data)
        model = load_model(folder / file.model)
        designs = _designs(file, model, folder)
        run = asked_of(file.run, folder, model)
    return Plan(file.name or Path(path).stem, Work(model, designs, run), file.chunk, file.workers)


def _designs(file: SweepFile, model: Model, folder: Path) -> Designs:
    choice = file.designs
    if choice.method == "table":
        if not choice.file:
            raise ModelError("the key 'file' is missing", where="designs", allowed="a CSV file beside the plan")
        return table(_columns(folder / choice.file, model))
    if not file.over:
        raise ModelError("a sweep needs a parameter to vary", where="over")
    axes = axes_of(file.over, model, choice.method)
    if choice.method == "grid":
        return grid({path: axis.levels for path, axis in axes.items()})
    if choice.count is None:
        raise ModelError("the key 'count' is missing", where="designs", allowed="how many designs")
    return sampled(choice.method, axes, choice.count, choice.seed)


def axes_of(over: Sequence[Parameter], model: Model, method: str) -> dict[str, Axis]:
    """What each parameter may be, in SI; ModelError, with its place, for one that is named twice or cannot be."""
    axes: dict[str, Axis] = {}
    for number, given in enumerate(over):
        if given.parameter in axes:
            raise ModelError("the parameter is named twice", where=f"over.{number}", found=quoted(given.parameter))
        axes[given.parameter] = _axis(given, f"over.{number}", model, method)
    return axes


def _axis(given: Parameter, where: str, model: Model, method: str) -> Axis:
    """What a parameter of a plan may be, tried on the model."""
    path = given.parameter
    if given.values is not None:
        if not (given.low is None and given.high is None and given.tolerance is None):
            raise ModelError("a parameter has values or ends, not both", where=where, found=quoted(path))
        _refuse_unknown(path, given.values, model, f"{where}.values")
        return Axis(tuple(_in_si(path, value, model) for value in given.values))
    low, high = _ends(given, where, model)
    try:
        axis = Axis(low=low, high=high, log=given.spacing == "logarithmic")
    except ModelError as error:
        raise ModelError(error.problem, where=where, found=error.found) from None
    if method != "grid":
        return axis
    if given.points is None:
        raise ModelError("the key 'points' is missing", where=where, allowed="how many values of a grid")
    return Axis(tuple(np.asarray(axis.at(np.linspace(0.0, 1.0, given.points))).tolist()))


def _ends(given: Parameter, where: str, model: Model) -> tuple[float, float]:
    """The ends of a range in SI, as they are given or about the model's own value; both tried on the model."""
    path, told = given.parameter, [given.low, given.high]
    if given.tolerance is not None:
        if told != [None, None]:
            raise ModelError("a parameter has ends or a tolerance, not both", where=where, found=quoted(path))
        if given.tolerance >= 1:
            found, allowed = f"{given.tolerance:g}", "a share below 1, as 0.1 or 10 %"
            raise ModelError("the tolerance is too large", where=f"{where}.tolerance", found=found, allowed=allowed)
        own = own_value(path, model, where)
        told = [*sorted((own * (1.0 - given.tolerance), own * (1.0 + given.tolerance)))]
    if None in told:
        allowed = "values: [...], low and high, or tolerance"
        raise ModelError("a parameter needs values or ends", where=where, found=quoted(path), allowed=allowed)
    places = [f"{where}.{end}" if given.tolerance is None else f"{where}.tolerance" for end in ("low", "high")]
    low, high = (number_at(path, value, model, place) for value, place in zip(told, places, strict=True))
    return low, high


def own_value(path: str, model: Model, where: str) -> float:
    """The model's own value in SI; a ModelError where it has none, several, or 0."""
    found = values_at(read_document(copy.deepcopy(dict(model.document))), path)
    if not found:  # misspelt, perhaps
        number_at(path, 1.0, model, f"{where}.parameter")
    own = next(iter(found.values()), 0.0)
    if len(found) != 1 or own == 0:
        problem = "a tolerance is about one value that the model file gives, other than 0"
        raise ModelError(problem, where=f"{where}.parameter", found=quoted(path), remedy="give low and high")
    return own


def _refuse_unknown(path: str, values: list[Any], model: Model, where: str) -> None:
    """A key path that no value fits is refused; values that do not fit are failures of their designs."""
    if not values:
        raise ModelError("a parameter has no values", where=where)
    first: ModelError | None = None
    for value in values:
        try:
            changed(model, {path: value})
            return
        except ModelError as error:
            first = first or error
    assert first is not None  # there are values
    raise _refused(first, where)


def _refused(error: ModelError, where: str) -> ModelError:
    """What the model says against a value, at the place in the plan."""
    told = f"the model refuses it: {error.where}: {error.problem}" if error.where else error.problem
    return ModelError(told, where=where, found=error.found, allowed=error.allowed, remedy=error.remedy)


def _in_si(path: str, value: Any, model: Model) -> Any:
    """A value with its unit in SI where the key holds a quantity; anything else, and what does not fit, as it is."""
    if not isinstance(value, str):
        return value
    document = copy.deepcopy(dict(model.document))
    try:
        put(document, path, value)
        found = values_at(read_document(document), path)
    except ModelError:
        return value
    return next(iter(found.values())) if len(found) == 1 else value


def number_at(
    path: str, value: Any, model: Model, where: str, kept: Mapping[str, float] = MappingProxyType({})
) -> float:
    """An end of a range in SI, tried on the model; values ``kept`` in a ratio to it, by key path, go with it."""
    number = _in_si(path, value, model)
    plain = isinstance(number, int | float) and not isinstance(number, bool)
    try:
        changed(model, {path: value, **({other: ratio * number for other, ratio in kept.items()} if plain else {})})
    except ModelError as error:
        raise _refused(error, where) from None
    if not plain:
        raise ModelError("the ends of a range are numbers", where=where, found=quoted(value))
    return float(number)


def _columns(path: Path, model: Model) -> dict[str, list[float]]:
    """A table of designs: a key path a column, with its unit in brackets, a design a row."""
    try:
        held = cells(read_text(path, TABLE_BYTES))
        heads = [named(cell) for cell in held.header]
        values = numbers(held, [name for name, _ in heads])
    except ModelError as error:
        raise error.located(file=error.file or path.name) from None
    return {
        name: (column * (number_at(name, f"1 {unit}", model, name) if unit else 1.0)).tolist()
        for (name, unit), column in zip(heads, values, strict=True)
    }


def asked_of(run: Any, folder: Path, model: Model) -> Run:
    """The analysis, with the scenario it names read, its claims known, its criteria tried."""
    if isinstance(run, CriteriaRun):
        run.refuse_unknown(model)
        return run.with_asked({name: asked_of(each, folder, model) for name, each in run.ask.items()})
    if isinstance(run, TransientRun):
        source = run.scenario if run.scenario in KINDS else str(folder / run.scenario)
        return run.with_scenario(load_scenario(source))
    if isinstance(run, ClaimsRun):
        run.refuse_unknown()
    return run  # type: ignore[no-any-return]
