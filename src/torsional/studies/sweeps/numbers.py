"""The numbers of a system as functions of a plan's parameters, found by building a few designs and proven on others.

Most parameters of a model file come into the equations unchanged, added to others, squared (the order that an absorber
is tuned to) or divided by (the angle at which a spring carries a torque).  Where every number of the assembled system
follows from the parameters in this way, designs need not be built one by one.  What does not follow is not guessed:
then there is no `Fit`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from torsional.laws import Hinges, Law
from torsional.numerics.arrays import Array, IntArray
from torsional.solvers.variants import NUMBERS
from torsional.studies.sweeps.designs import Axis, Values
from torsional.system import BoolArray, System

EXACT = 1e-12
"""Of a number's size: nothing but rounding."""
PROBES = np.array([0.0, 1.0, 0.381966, 0.763932])
CORNERS = 16
_BASES: tuple[Callable[[Array], Array], ...] = (lambda p: p, lambda p: p * p, lambda p: 1.0 / p)


@dataclass(frozen=True, eq=False)
class Told:
    """The ``numbers`` of a system in one row, and a ``form`` that tells all else that linear analyses look at."""

    numbers: Array
    form: tuple[Any, ...]

    @classmethod
    def of(cls, system: System) -> Told:
        """Connections' fields, inertias, parameters of laws."""
        c, m = system.connections, system.masses
        rows = [getattr(c, name) for name in NUMBERS] + [m.inertia]
        rows += [law.parameters for law in c.laws if law is not None]
        kinds = tuple(None if law is None else (type(law), law.parameters.size) for law in c.laws)
        arrays = tuple(a.tobytes() for a in (system.T, c.weights, m.weights, c.whole_speed))
        form = system.nodes, c.names, m.names, kinds, arrays, repr(c.loads), repr(m.switches)
        return cls(np.concatenate(rows), form)


@dataclass(frozen=True, eq=False)
class _Term:
    """What one parameter does to the numbers at ``places``: slope × basis of the parameter, from its ``start`` on."""

    name: str
    places: IntArray
    basis: Callable[[Array], Array]
    slope: Array
    start: float


@dataclass(frozen=True, eq=False)
class Fit:
    """Numbers of a system over designs; ``spans``: between which values of the parameters they are proven."""

    start: Array
    centre: Mapping[str, float]
    terms: tuple[_Term, ...]
    spans: Mapping[str, tuple[float, float]]

    @property
    def places(self) -> IntArray:
        """Of the numbers that vary."""
        return np.unique(np.concatenate([term.places for term in self.terms] or [np.zeros(0, np.int64)])).astype(int)

    def at(self, columns: Mapping[str, Array]) -> Array:
        """The numbers (designs, …) of some designs."""
        count = max(len(column) for column in columns.values())
        found = np.repeat(self.start[None], count, axis=0)
        for term in self.terms:
            moved = term.basis(columns[term.name]) - term.basis(np.array(term.start))
            found[:, term.places] += moved[:, None] * term.slope
        return found

    def covers(self, columns: Mapping[str, Any]) -> BoolArray:
        """Which designs (designs,) have plain numbers within the values that are proven."""
        each = []
        for name, column in columns.items():
            low, high = self.spans[name]
            if isinstance(column, np.ndarray):
                each.append((low <= column) & (column <= high))
            else:
                each.append(np.array([_plain(value) and low <= value <= high for value in column]))
        return np.asarray(np.all(each, axis=0))


def fitted(build: Callable[[Values], Told | None], axes: Mapping[str, Axis], designs: Sequence[Values]) -> Fit | None:
    """The numbers that ``build`` tells of designs as functions of the parameters; None where they are not found.

    Proven on the corners of what the ``axes`` allow and on some ``designs``, to rounding.
    """
    spans = {name: span for name, axis in axes.items() if (span := _span(axis)) is not None}
    centre = {name: float(low + PROBES[2] * (high - low)) for name, (low, high) in spans.items()}
    reference = build(centre) if len(spans) == len(axes) else None
    if reference is None:
        return None
    terms: list[_Term] = []
    for name, (low, high) in spans.items():
        found = _terms(build, name, low + PROBES * (high - low), centre, reference) if high > low else []
        if found is None:
            return None
        terms += found
    fit = Fit(reference.numbers, centre, tuple(terms), spans)
    corners = [dict(zip(spans, row, strict=True)) for row in product(*spans.values())]
    inside = [row for row in designs if fit.covers({name: [value] for name, value in row.items()})[0]]
    proof = [*corners[:: max(1, len(corners) // CORNERS)], corners[-1], *inside]
    return fit if all(_proven(fit, row, build(row), reference) for row in proof) else None


def _span(axis: Axis) -> tuple[float, float] | None:
    """The least and the largest value; of levels those that a positive number can be."""
    if not axis.levels:
        return axis.low, axis.high
    sound = [float(v) for v in axis.levels if _plain(v) and v > 0 and np.isfinite(v)]
    return (min(sound), max(sound)) if sound else None


def _plain(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _terms(
    build: Callable[[Values], Told | None], name: str, values: Array, centre: Mapping[str, float], reference: Told
) -> list[_Term] | None:
    """What one parameter does to the numbers."""
    told = [build({**centre, name: float(value)}) for value in values]
    if any(each is None or each.form != reference.form for each in told):
        return None
    rows = np.array([each.numbers for each in told if each is not None])
    left = np.flatnonzero((rows != reference.numbers).any(axis=0))
    terms = []
    for basis in _BASES:
        if values.min() <= 0 and basis is _BASES[2]:
            continue
        x = basis(values)
        slope = (rows[1, left] - rows[0, left]) / (x[1] - x[0])
        slope = np.where(abs(slope - 1.0) < EXACT, 1.0, slope)
        off = abs(rows[:, left] - rows[0, left] - (x - x[0])[:, None] * slope)
        fine = (off <= EXACT * abs(rows[:, left]).max(axis=0, initial=0.0)).all(axis=0)
        if fine.any():
            terms.append(_Term(name, left[fine], basis, slope[fine], centre[name]))
        left = left[~fine]
    return None if left.size else terms


def _proven(fit: Fit, design: Values, told: Told | None, reference: Told) -> bool:
    if told is None or told.form != reference.form:
        return False
    numbers = fit.at({name: np.array([float(value)]) for name, value in design.items()})[0]
    return bool((abs(numbers - told.numbers) <= EXACT * (abs(numbers) + abs(fit.start))).all())


def parts_of(system: System, numbers: Array) -> tuple[dict[str, Array], dict[int, Array]]:
    """Tables by field, and parameters by place of a law, from rows (designs, …) of `Told`'s numbers."""
    c, at = system.connections, 0
    tables = {}
    for name, size in (*((name, len(c.names)) for name in NUMBERS), ("inertia", len(system.masses.names))):
        tables[name] = numbers[:, at : at + size]
        at += size
    laws = {}
    for place, law in enumerate(c.laws):
        if law is not None:
            laws[place] = numbers[:, at : at + law.parameters.size]
            at += law.parameters.size
    return tables, laws


def system_of(system: System, tables: Mapping[str, Array], laws: Mapping[int, Array], design: int) -> System:
    """One design: the ``system`` that stands for all with numbers of its own, from `parts_of`."""
    c = system.connections
    own = tuple(
        law if law is None or np.array_equal(law.parameters, laws[place][design]) else _bent(law, laws[place][design])
        for place, law in enumerate(c.laws)
    )
    told = {name: np.array(tables[name][design]) for name in NUMBERS}
    masses = replace(system.masses, inertia=np.array(tables["inertia"][design]))
    return replace(system.with_connections(**told, laws=own), masses=masses)


def _bent(law: Law, row: Array) -> Law:
    """A law of hinges like another one, with parameters of its own; its stops go with their hinges."""
    assert isinstance(law, Hinges)  # no other law is fitted
    gaps, sides, changes = (tuple(row[first::3].tolist()) for first in (1, 2, 3))
    stops = [gap for gap, known in zip(gaps, law.gaps, strict=True) if known in law.stops]
    return Hinges(float(row[0]), gaps, sides, changes, tuple(sorted(stops)))
