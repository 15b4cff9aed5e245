"""Plans of identifications in files, read as strictly as those of sweeps."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field

from torsional.arguments import checked
from torsional.errors import ModelError, nearest
from torsional.files.edit import changed, parsed_edit
from torsional.files.faults import told_of
from torsional.files.load import load_model
from torsional.files.reader import read_tree
from torsional.files.scaling import quantity_at, read_document, values_at
from torsional.files.schema.fields import Block, Quantity, only_version
from torsional.model import Model
from torsional.studies.estimates import LEVEL, Unknown
from torsional.studies.identification.measured import AnyMeasured
from torsional.studies.identification.sources import Loops, Source
from torsional.studies.identification.task import Candidate, Task
from torsional.studies.loop_torques import ANGLE_OFFSET, TORQUE_OFFSET
from torsional.studies.sweeps.plan import number_at, own_value
from torsional.units import quoted

VERSION, KEY = 1, "torsional_identify"
Level = Annotated[float, Quantity("ratio", above=0)]
ZEROS = (
    Unknown(TORQUE_OFFSET, "torque", 0.0, -1000.0, 1000.0, scale=10.0),
    Unknown(ANGLE_OFFSET, "relative_angle", 0.0, -0.1, 0.1, scale=0.002),
)
"""Zeros of a rig's sensors, looked for with everything else."""


def _version(value: object) -> object:
    return only_version(value, VERSION, KEY)


class Looked(Block):
    """A parameter that is looked for between ``low`` and ``high``, from ``start`` on (default: the model's own)."""

    parameter: str = Field(description="key path of the model file, as clutch.stiffness")
    low: float | int | str
    high: float | int | str
    start: float | int | str | None = None
    together: list[str] = Field(default_factory=list, description="key paths that keep their ratio to it")


class Method(Block):
    """How it is searched, and how sure intervals are."""

    starts: Annotated[int, Field(ge=1, le=1000)] = Field(1, description="the first as given, the others at random")
    seed: Annotated[int, Field(ge=0, lt=2**32)] = 0
    confidence: Level = Field(LEVEL, description="of the intervals, as 95 %")
    profiles: Annotated[int, Field(ge=0, le=41)] = Field(0, description="points of each parameter's profile")


class Other(Block):
    """Another model of the same data: what is set otherwise, and what else is looked for."""

    set: list[str] = Field(default_factory=list, description="changes of the model file, as clutch.damping=0")
    over: list[Looked] = Field(default_factory=list, description="further parameters")


class IdentifyFile(Block):
    """A plan: the model, what is looked for, what was measured, what is held back, which models are compared."""

    torsional_identify: Annotated[int, BeforeValidator(_version)]
    name: str = Field("", max_length=200)
    model: str = Field(description="model file, beside the plan")
    over: list[Looked] = Field(min_length=1, description="parameters that are looked for")
    measured: list[AnyMeasured] = Field(min_length=1, description="tables beside the plan")
    hold_back: list[str] = Field(default_factory=list, description="points that are predicted, not fitted")
    models: dict[str, Other] = Field(default_factory=dict, description="other models of the same data, by name")
    method: Method = Field(default_factory=lambda: Method.model_validate({}))


@checked
def load_identification(path: str | os.PathLike[str]) -> Task:
    """The identification of a plan's file; what it names is read from its own folder.

    ModelError, and no other error, says what is wrong: file, key path with line, what was found, what is allowed.
    """
    tree, folder = read_tree(path), Path(path).parent
    if KEY not in tree.data:
        other = next((key for key in ("torsional_sweep", "torsional_optimise") if key in tree.data), "")
        remedy = f"torsional {other.partition('_')[2]} takes this plan" if other else f"write '{KEY}: {VERSION}'"
        raise ModelError(f"the key '{KEY}' is missing", remedy=remedy, file=tree.file)
    with told_of(tree):
        file = IdentifyFile.model_validate(tree.data)
        return _task(file, load_model(folder / file.model), folder, Path(path).stem)


def _task(file: IdentifyFile, model: Model, folder: Path, stem: str) -> Task:
    sources: list[Source] = []
    for number, block in enumerate(file.measured):
        try:
            sources.append(block.source(model, folder))
        except ModelError as error:
            raise error.located(prefix=f"measured.{number}") from None
    _check_points(sources, file)
    zeros = ZEROS if any(isinstance(s, Loops) and b.zeros for s, b in zip(sources, file.measured, strict=True)) else ()
    own = _candidate(file.name or stem, model, file.over, "over", {}, zeros)
    others = [_other(name, block, own, file.over, model, zeros) for name, block in file.models.items()]
    method = file.method
    if method.confidence >= 1:
        raise ModelError("must be below 1", where="method.confidence", found=f"{method.confidence:g}", allowed="95 %")
    return Task(
        file.name or stem,
        tuple(sources),
        (own, *others),
        frozenset(file.hold_back),
        method.starts,
        method.seed,
        method.confidence,
        method.profiles,
    )


def _check_points(sources: Sequence[Source], file: IdentifyFile) -> None:
    """Points must have names of their own, and those that are held back or weighted must be there."""
    names = [point.name for source in sources for point in source.points]
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        remedy = "give one of the tables a name"
        raise ModelError("two points have one name", where="measured", found=quoted(twice[0]), remedy=remedy)
    asked = [("hold_back", name) for name in file.hold_back]
    asked += [(f"measured.{n}.weights", name) for n, block in enumerate(file.measured) for name in block.weights]
    for where, name in asked:
        if name not in names:
            raise ModelError("there is no such point", where=where, found=quoted(name), remedy=nearest(name, names))
    if set(names) <= set(file.hold_back):
        raise ModelError("all points are held back, and none is left to fit", where="hold_back")


def _other(
    name: str, block: Other, own: Candidate, over: Sequence[Looked], model: Model, zeros: Sequence[Unknown]
) -> Candidate:
    """Another model: what it sets is looked for no more."""
    if name == own.name:
        raise ModelError("another model needs another name", where="models", found=quoted(name))
    try:
        given = dict(map(parsed_edit, block.set))
        base = changed(model, given) if given else model
    except ModelError as error:
        raise error.located(prefix=f"models.{name}.set") from None
    left = [each for each in over if not _within(each.parameter, given)]
    paths = [each.parameter for each in left]
    clash = next((each.parameter for each in block.over if each.parameter in paths), "")
    if clash:
        raise ModelError("the parameter is looked for already", where=f"models.{name}.over", found=quoted(clash))
    return _candidate(name, base, [*left, *block.over], f"models.{name}.over", given, zeros)


def _within(path: str, given: Mapping[str, Any]) -> bool:
    """Whether a key path, or a block that holds it, is set."""
    return any(path == key or path.startswith(f"{key}.") for key in given)


def _candidate(
    name: str, model: Model, over: Sequence[Looked], where: str, given: Mapping[str, Any], zeros: Sequence[Unknown]
) -> Candidate:
    unknowns, ratios = [], {}
    for number, each in enumerate(over):
        path, place = each.parameter, f"{where}.{number}"
        if path in ratios:
            raise ModelError("the parameter is named twice", where=place, found=quoted(path))
        kept = [other for other in each.together if not _within(other, given)]
        ratios[path] = {other: _ratio(other, path, model, f"{place}.together") for other in kept}
        unknowns.append(_unknown(each, model, place, ratios[path]))
    return Candidate(name, model, (*unknowns, *zeros), ratios)


def _unknown(each: Looked, model: Model, where: str, kept: Mapping[str, float]) -> Unknown:
    """A parameter with its bounds in SI, both tried on the model."""
    path = each.parameter
    low, high = (number_at(path, getattr(each, end), model, f"{where}.{end}", kept) for end in ("low", "high"))
    if each.start is None:
        start = own_value(path, model, where)
    else:
        start = number_at(path, each.start, model, f"{where}.start", kept)
    document = changed(model, {path: high, **{other: ratio * high for other, ratio in kept.items()}}).document
    quantity = quantity_at(read_document(dict(document)), path)
    try:
        return Unknown(path, quantity, start, low, high, abs(start) or max(abs(low), abs(high)))
    except ModelError as error:
        raise ModelError(error.problem, where=where, found=error.found, remedy="give start") from None


def _ratio(other: str, path: str, model: Model, where: str) -> float:
    """Another value over that of a parameter, as the model has both."""
    figures = read_document(dict(model.document))
    pair = [list(values_at(figures, each).values()) for each in (other, path)]
    if any(len(values) != 1 for values in pair) or not pair[1][0]:
        remedy = "both must be single figures that the model file gives, the parameter's own not 0"
        raise ModelError("there is no ratio to keep", where=where, found=quoted(other), remedy=remedy)
    return pair[0][0] / pair[1][0]
