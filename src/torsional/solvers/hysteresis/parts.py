"""Parts of an absorber that do not feel each other while one angle is given, those that are alike taken once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from torsional.numerics.arrays import Array, IntArray
from torsional.stamps import NormalLoad
from torsional.system import BoolArray, Connections

DIGITS = 12
"""Digits to which values agree of parts that are alike."""


class Part(NamedTuple):
    """``connections`` over their own free coordinates and, last, the turned angle; their places in the whole.

    ``columns`` (copies, free) and ``elements`` (copies, connections): one row for each part that is like this one.
    """

    connections: Connections
    columns: IntArray
    elements: IntArray


def grouped(rows: Array) -> IntArray:
    """A label for each coordinate: those that rows (…, coordinates) join have the same."""
    label = np.arange(rows.shape[1])
    for row in rows:
        members = np.unique(label[row != 0])
        if members.size:
            label[np.isin(label, members)] = members[0]
    return label


def parts_of(c: Connections) -> tuple[Part, ...]:
    """Connections over free coordinates and, last, the turned angle, in parts: what coordinates or loads join."""
    of_coordinate, of_element = _labels(c)
    found: dict[object, tuple[list[IntArray], list[IntArray]]] = {}
    for label in np.unique(of_element):
        elements, columns = np.flatnonzero(of_element == label), np.flatnonzero(of_coordinate == label)
        columns_of, elements_of = found.setdefault(_likeness(c, elements, columns), ([], []))
        columns_of.append(columns)
        elements_of.append(elements)
    return tuple(_part(c, np.array(columns), np.array(elements)) for columns, elements in found.values())


def _part(c: Connections, columns: IntArray, elements: IntArray) -> Part:
    free = columns.reshape(len(elements), -1).astype(np.int64)
    own = c.weights[np.ix_(elements[0], np.append(free[0], c.weights.shape[1] - 1))]
    return Part(c.picked(elements[0], own), free, elements)


def _labels(c: Connections) -> tuple[IntArray, IntArray]:
    """Labels of the free coordinates and of the connections."""
    free = c.weights[:, :-1]
    of_coordinate, count = grouped(free), free.shape[1]
    of_element = np.array([of_coordinate[row != 0][0] if row.any() else count + i for i, row in enumerate(free)])
    for i, load in enumerate(c.loads):
        for name in load.share_of if load else ():
            old, new = of_element[c.names.index(name)], of_element[i]
            of_coordinate[of_coordinate == old] = new
            of_element[of_element == old] = new
    return of_coordinate, of_element


def _likeness(c: Connections, elements: IntArray, columns: IntArray) -> object:
    """What is the same of two parts that are alike, in the order of their connections."""
    own = c.weights[np.ix_(elements, np.append(columns, c.weights.shape[1] - 1))]
    values = np.column_stack([c.values, c.whole_speed])[elements]
    names = [c.names[i] for i in elements]
    loads = tuple(_load(c.loads[i], names) for i in elements)
    laws = tuple(c.laws[i] for i in elements)
    return _rounded(own), _rounded(values), laws, loads


def _rounded(values: Array | BoolArray) -> tuple[str, ...]:
    return tuple(f"{float(value) + 0.0:.{DIGITS}g}" for value in np.ravel(values))


def _load(load: NormalLoad | None, names: Sequence[str]) -> object:
    """A load with the places of what presses instead of their names."""
    if load is None:
        return None
    shares = tuple(sorted((names.index(name), share) for name, share in load.share_of.items()))
    return load.constant, load.centrifugal, load.level, shares
