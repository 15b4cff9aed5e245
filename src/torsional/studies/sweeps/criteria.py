"""Criteria: single figures taken from analyses, by one definition for sweeps, sensitivity and optimisation."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Annotated, Any, Literal, TypeAlias

import numpy as np
import xarray as xr
from pydantic import Field, PrivateAttr

from torsional.errors import ModelError, nearest
from torsional.files.scaling import quantity_at, read_document
from torsional.files.schema.fields import Block
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import labelled
from torsional.studies.sweeps.absorbers import EnvelopeRun, FrictionRun, InertiaRun
from torsional.studies.sweeps.analyses import Analysis, Asking
from torsional.studies.sweeps.batch import Batch
from torsional.studies.sweeps.periodic import PeriodicRun
from torsional.studies.sweeps.settled import SettledRun
from torsional.studies.sweeps.verdicts import ClaimsRun
from torsional.studies.sweeps.work import Together
from torsional.system import BoolArray
from torsional.units import quoted, read, read_range

Single: TypeAlias = Analysis | ClaimsRun | EnvelopeRun | InertiaRun | FrictionRun | PeriodicRun | SettledRun
"""One analysis."""
WORST: Mapping[str, Callable[[Array], Any]] = {"largest": np.max, "smallest": np.min, "mean": np.mean}
CLOSE = 1e-9


class Criterion(Block):
    """One figure of a design: the ``worst`` of a ``figure`` of the analysis asked as ``of``, or the ``sum`` of values
    of the model file (key paths of one quantity)."""

    of: str = Field("", description="name of the analysis")
    figure: str = Field("", description="a variable of its answer")
    worst: Literal["largest", "smallest", "mean"] = Field("largest", description="of all values that are selected")
    select: dict[str, Any] = Field(
        default_factory=dict, description="by dimension: a label, several, or a range as 600:1000 rpm; default: all"
    )
    sum: list[str] = Field(default_factory=list, description="key paths instead of an analysis")

    def refuse_unknown(self, ask: Mapping[str, Any]) -> None:
        """ModelError where it names neither an analysis that is asked nor key paths, or a figure that is not there."""
        if bool(self.of) == bool(self.sum) or bool(self.of) != bool(self.figure):
            raise ModelError("a criterion is a figure of an analysis, or a sum", allowed="of and figure, or sum")
        if self.of and self.of not in ask:
            raise ModelError(
                "no such analysis is asked", where="of", found=quoted(self.of), remedy=nearest(self.of, ask)
            )
        known = ask[self.of].gives if self.of else {}
        if known and self.figure not in known:
            told = {"found": quoted(self.figure), "remedy": nearest(self.figure, known)}
            raise ModelError("the analysis has no such figure", where="figure", **told)

    def read(self, answers: Mapping[str, xr.Dataset]) -> tuple[float, str]:
        """The figure and its quantity, of an analysis."""
        data = answers[self.of]
        if self.figure not in data:
            told = {"where": self.of, "found": quoted(self.figure), "remedy": nearest(self.figure, map(str, data))}
            raise ModelError("the analysis has no such figure", **told)
        values = data[self.figure]
        for dimension, label in self.select.items():
            values = selected(values, dimension, label)
        numbers = values.values[~np.isnan(values.values)]
        found = float(WORST[self.worst](numbers)) if numbers.size else float("nan")
        return found, str(values.attrs.get("quantity", "number"))


class CriteriaRun(Asking):
    """Single figures of a design: analyses by name, and what is taken from them."""

    analysis: Literal["criteria"]
    ask: dict[str, Annotated[Single, Field(discriminator="analysis")]] = Field(
        default_factory=dict, description="analyses by names of your own"
    )
    criteria: dict[str, Criterion] = Field(description="figures by names of your own", min_length=1)
    _quantities: dict[str, str] = PrivateAttr(default_factory=dict)

    @property
    def settings(self) -> dict[str, Any]:
        """The settings of its analyses and the criteria."""
        told = {name: each.settings for name, each in self.ask.items()}
        criteria = {name: each.model_dump(mode="json") for name, each in self.criteria.items()}
        return {"analysis": self.analysis, "ask": told, "criteria": criteria}

    def refuse_unknown(self, model: Model) -> None:
        """ModelError, with its place, for a criterion that cannot be of a model."""
        for name, each in self.criteria.items():
            try:
                each.refuse_unknown(self.ask)
                if each.sum:
                    self._summed(each.sum, model)
            except ModelError as error:
                raise error.located(prefix=f"run.criteria.{name}") from None

    def quantity(self, name: str, model: Model | None = None) -> str:
        """The quantity of a criterion, "" where nothing tells it before it is asked."""
        one = self.criteria[name]
        if one.sum:
            return "" if model is None else self._quantity(one.sum[0], model)
        return self.ask[one.of].gives.get(one.figure, "")

    def of(self, names: Iterable[str]) -> CriteriaRun:
        """The same question for some of the criteria alone."""
        return self.model_copy(update={"criteria": {name: self.criteria[name] for name in names}})

    def with_asked(self, ask: Mapping[str, Any]) -> CriteriaRun:
        """A copy with other analyses by the same names."""
        return self.model_copy(update={"ask": dict(ask)})

    def __call__(self, model: Model) -> xr.Dataset:
        """Every criterion as a single figure with its unit."""
        return self.taken({name: each(model) for name, each in self._wanted.items()}, model)

    @property
    def _wanted(self) -> dict[str, Any]:
        """The analyses of which a criterion is taken."""
        wanted = {each.of for each in self.criteria.values()}
        return {name: each for name, each in self.ask.items() if name in wanted}

    def possible(self, batch: Batch) -> bool:
        """Whether designs can be asked together."""
        return all(isinstance(each, Together) and each.possible(batch) for each in self._wanted.values())

    def covers(self, batch: Batch, columns: Mapping[str, Any]) -> BoolArray:
        """Which of them."""
        count = len(next(iter(columns.values())))
        each = [run.covers(batch, columns) for run in self._wanted.values() if isinstance(run, Together)]
        return np.asarray(np.all(each, axis=0)) if each else np.ones(count, dtype=bool)

    def many(self, batch: Batch, columns: Mapping[str, Any]) -> xr.Dataset:
        """The same of many designs."""
        answers = {n: run.many(batch, columns) for n, run in self._wanted.items() if isinstance(run, Together)}
        rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
        found: dict[str, tuple[tuple[str], Any, str]] = {}
        for name, each in self.criteria.items():
            if each.sum:
                told = [self._summed(each.sum, batch.model, row) for row in rows]
            else:
                told = [each.read({each.of: answers[each.of].isel(design=place)}) for place in range(len(rows))]
            found[name] = (("design",), np.array([value for value, _ in told]), told[0][1])
        return labelled(found, {}, analysis="criteria")

    def taken(self, answers: Mapping[str, xr.Dataset], model: Model) -> xr.Dataset:
        """The criteria of answers that are there, and of the values of the model's file."""
        found = {}
        for name, each in self.criteria.items():
            value, quantity = self._summed(each.sum, model) if each.sum else each.read(answers)
            found[name] = ((), value, quantity)
        return labelled(found, {}, analysis="criteria")

    def _summed(self, paths: list[str], model: Model, row: Mapping[str, Any] | None = None) -> tuple[float, str]:
        """The sum of what the model's file, or a design in its ``row``, has at some paths."""
        own = row or {}
        quantities = {self._quantity(path, model) for path in paths}
        if len(quantities) > 1:
            raise ModelError("values of different quantities have no sum", found=", ".join(sorted(quantities)))
        quantity = quantities.pop()
        values = [own[path] if path in own else _at(model.document, path) for path in paths]
        return sum(read(value, quantity, path) for value, path in zip(values, paths, strict=True)), quantity

    def _quantity(self, path: str, model: Model) -> str:
        if path not in self._quantities:
            if not model.document:
                remedy = "take figures of an analysis"
                raise ModelError("no model file describes this model", where="sum", remedy=remedy)
            try:
                self._quantities[path] = quantity_at(read_document(model.document), path)
            except ModelError as error:
                raise ModelError(error.problem, where="sum", found=quoted(path)) from None
        return self._quantities[path]


Question: TypeAlias = Annotated[Single | CriteriaRun, Field(discriminator="analysis")]
"""What a plan may ask of every design."""


def selected(values: xr.DataArray, dimension: str, label: Any) -> xr.DataArray:
    """Values at a label of a dimension, at several, or within a range of numbers; ModelError for ones not there."""
    if dimension not in values.dims:
        known = ", ".join(map(str, values.dims)) or "none"
        raise ModelError("the figure has no such dimension", where="select", found=quoted(dimension), allowed=known)
    marks = values[dimension] if dimension in values.coords else values[dimension].copy()
    if isinstance(label, str) and ":" in label:
        low, high, *_ = read_range(label, str(marks.attrs.get("quantity", "number")), dimension)
        inside = (marks.values >= low - CLOSE * abs(low)) & (marks.values <= high + CLOSE * abs(high))
        if not inside.any():
            raise ModelError("no value lies in the range", where=f"select.{dimension}", found=quoted(label))
        return values.isel({dimension: np.flatnonzero(inside)})
    wanted = label if isinstance(label, list) else [label]
    return values.isel({dimension: [_place(marks, each, dimension) for each in wanted]})


def _place(marks: xr.DataArray, label: Any, dimension: str) -> int:
    """Where a label stands among the marks of a dimension."""
    where = f"select.{dimension}"
    if marks.dtype.kind in "fiu":
        number = read(label, str(marks.attrs.get("quantity", "number")), where)
        at = int(abs(marks.values - number).argmin())
        if abs(marks.values[at] - number) > 1e-6 * max(abs(number), 1.0):
            raise ModelError("there is no such value", where=where, found=quoted(label))
        return at
    known = [str(mark) for mark in marks.values]
    if str(label) not in known:
        raise ModelError("there is no such label", where=where, found=quoted(label), remedy=nearest(str(label), known))
    return known.index(str(label))


def _at(document: Any, path: str) -> Any:
    """What a document has at a key path."""
    holder = document
    for step in path.split("."):
        holder = holder[int(step)] if isinstance(holder, list) else holder[step]
    return holder
