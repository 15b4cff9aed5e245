"""What an engineer reads off branches of periodic motions: stable ranges, coexisting motions, the motion at a speed."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.laws import Law, hinge_rows
from torsional.numerics.arrays import Array, IntArray
from torsional.units import QUANTITIES

Range = tuple[float, float]

SHARE_SAMPLES = 7200
"""Instants of a cycle at which the stage is looked up: shares of time are met to a few hundredths of a per cent."""

NARROW = 2e-4
"""Stable ranges and overlaps narrower than this share of the whole range come from where branches were cut off."""


@dataclass(frozen=True, eq=False)
class Piece:
    """Consecutive ``points`` of one ``branch`` that are all stable or all unstable, joined to their neighbours."""

    branch: int
    points: IntArray
    stable: bool


def parameter_quantity(result: xr.Dataset) -> str:
    """The continued parameter's name in the nomenclature, by its unit; "ratio" where it has none."""
    told = str(result.value.attrs.get("quantity", ""))
    name, unit = str(result.attrs["parameter"]), str(result.attrs.get("parameter_unit", "-"))
    known = [q.name for q in QUANTITIES.values() if q.unit == unit and unit != "-"]
    named = [q for q in known if name.rsplit(".", 1)[-1].endswith(q)]
    return told or next(iter([*named, *known]), "ratio")


def letter(number: int) -> str:
    """The name of a motion among those at one value of the parameter.

    >>> letter(0), letter(30)
    ('A', '(31)')
    """
    return chr(ord("A") + number) if number < 26 else f"({number + 1})"


def branch_numbers(result: xr.Dataset) -> list[int]:
    """Numbers of the branches that have points, the main one first."""
    return [int(number) for number in np.unique(result.branch.values)]


def pieces(result: xr.Dataset) -> list[Piece]:
    """Every branch of a periodic response cut where its stability changes.

    A step from a stable point to an unstable one belongs to the unstable piece, so that pieces drawn one after the
    other leave no gap and a stable piece promises nothing that was not found.  A branch that leaves another begins at
    the bifurcation there.
    """
    found: list[Piece] = []
    for number in branch_numbers(result):
        points = np.flatnonzero(result.branch.values == number)
        stable = result.stable.values[points]
        origin = _origin(result, number, points[0])
        points, stable = np.append(origin, points), np.append(stable[:1].repeat(len(origin)), stable)
        steps = stable[1:] & stable[:-1]
        edges = [0, *(1 + np.flatnonzero(steps[1:] != steps[:-1])), max(len(steps), 1)]
        for first, last in pairwise(edges):
            held = bool(steps[first]) if len(steps) else bool(stable[0])
            found.append(Piece(number, points[first : last + 1], held))
    return found


def _origin(result: xr.Dataset, number: int, first: int) -> IntArray:
    """The bifurcation on its parent at which a branch begins, as a point; none for a branch without a parent."""
    known = bifurcation_points(result)
    on = np.flatnonzero(result.on_branch.values == int(result.parent[number]))
    if not on.size:
        return np.zeros(0, dtype=int)
    distance = np.abs(result.bifurcation_value.values[on] - float(result.value[first]))
    return np.array([known[int(on[np.argmin(distance)])]])


def stable_ranges(result: xr.Dataset, branch: int) -> list[Range]:
    """Ranges of the continued parameter [its unit] in which one branch has a stable motion, in the order of the branch.

    A range ends at the bifurcation that ends it, where one is told, and at a turn of the branch.
    """
    value = result.value.values
    told = zip(bifurcation_points(result), result.bifurcation_value.values, result.on_branch.values, strict=True)
    known = {point: at for point, at, on in told if on == branch}
    found = []
    for piece in pieces(result):
        if piece.branch == branch and piece.stable:
            for run in _monotone(piece.points, value):
                ends = [
                    float(known.get(i, known.get(j, value[i])))
                    for i, j in ((run[0], run[0] - 1), (run[-1], run[-1] + 1))
                ]
                found.append((min(ends), max(ends)))
    least = NARROW * float(np.ptp(value))
    return [span for span in found if span[1] - span[0] > least] or found[:1]


def _monotone(points: IntArray, value: Array) -> Iterator[IntArray]:
    """The points of a piece cut where the parameter turns."""
    if len(points) < 3:
        yield points
        return
    way = np.sign(np.diff(value[points]))
    way = way[np.maximum.accumulate(np.where(way != 0, np.arange(len(way)), 0))]  # resting is no turn
    turns = 1 + np.flatnonzero(way[1:] * way[:-1] < 0)
    edges = [0, *turns, len(points) - 1]
    yield from (points[first : last + 1] for first, last in pairwise(edges))


@checked
def coexisting(result: xr.Dataset) -> list[tuple[Range, list[int]]]:
    """Ranges of the parameter in which more than one motion is stable, with the branches they belong to.

    A branch that turns back and is stable twice at one value is named twice.
    """
    spans = [(span, n) for n in branch_numbers(result) for span in stable_ranges(result, n) if span[1] > span[0]]
    edges = sorted({edge for span, _ in spans for edge in span})
    found: list[tuple[Range, list[int]]] = []
    for low, high in pairwise(edges):
        here = [n for (first, last), n in spans if first <= low and last >= high]
        if found and found[-1][0][1] == low and found[-1][1] == here:
            found[-1] = ((found[-1][0][0], high), here)
        else:
            found.append(((low, high), here))
    least = NARROW * float(np.ptp(result.value.values))
    return [(span, here) for span, here in found if len(here) > 1 and span[1] - span[0] > least]


@checked
def without_stable(result: xr.Dataset) -> list[Range]:
    """Ranges of the parameter in which no stable motion was found: what happens there is on no branch that is known."""
    value = result.value.values
    least, reached = NARROW * float(np.ptp(value)), float(value.min())
    found = []
    for low, high in sorted(span for n in branch_numbers(result) for span in stable_ranges(result, n)):
        if low - reached > least:
            found.append((reached, low))
        reached = max(reached, high)
    return [*found, (reached, float(value.max()))] if value.max() - reached > least else found


@checked
def solutions_at(result: xr.Dataset, value: float) -> xr.Dataset:
    """Every motion at one ``value`` of the continued parameter: the points of the branches there, along ``point``.

    Between two computed points everything is taken as linear; a motion is stable where both of them are.
    """
    at = result.value.values
    branch = result.branch.values
    same = branch[1:] == branch[:-1]
    near = 1e-9 * max(abs(value), float(np.abs(at).max()))
    low, high = np.minimum(at[1:], at[:-1]), np.maximum(at[1:], at[:-1])
    met = np.flatnonzero(same & (low <= value + near) & (value - near <= high))
    share = np.array([_share(at[i], at[i + 1], value) for i in met])
    first = [i for n, i in enumerate(met) if not (n and met[n - 1] == i - 1 and share[n] == 0 and share[n - 1] == 1)]
    kept = np.array(first, dtype=int)
    weight = (
        xr.DataArray(share[np.searchsorted(met, kept)], dims="point") if len(kept) else xr.DataArray([], dims="point")
    )
    return _between(result.isel(point=kept), result.isel(point=kept + 1), weight)


def _share(start: float, end: float, value: float) -> float:
    return 0.0 if end == start else min(max((value - start) / (end - start), 0.0), 1.0)


def _between(one: xr.Dataset, other: xr.Dataset, weight: xr.DataArray) -> xr.Dataset:
    """The points between those of ``one`` and of ``other``."""
    mixed: dict[str, xr.Variable] = {}
    for name, variable in {**one.coords, **one.data_vars}.items():
        if "point" not in variable.dims or name == "point":
            continue
        a, b = variable.variable, other[name].variable
        if a.dtype.kind in "fc":
            mixed[str(name)] = ((1 - weight.variable) * a + weight.variable * b).transpose(*a.dims)
            mixed[str(name)].attrs = dict(a.attrs)
        elif a.dtype.kind == "b":
            mixed[str(name)] = a & b
    return one.assign({name: v for name, v in mixed.items() if name in one.data_vars}).assign_coords(
        {name: v for name, v in mixed.items() if name in one.coords}
    )


def bifurcation_points(result: xr.Dataset) -> list[int]:
    """For each bifurcation the point of its branch that is nearest to it: the one that is named after it, if any is.

    Else, where a branch passes the same value of the parameter several times, it is the passage at which the stability
    changes, or at which the branch turns.
    """
    if "event" in result:
        named = np.flatnonzero(np.isin(result.event.values, result.bifurcation_type.values))
        if len(named) == result.sizes["bifurcation"]:
            return [int(point) for point in named]
    return [_nearest(result, number) for number in range(result.sizes["bifurcation"])]


def _nearest(result: xr.Dataset, number: int) -> int:
    at = np.flatnonzero(result.branch.values == int(result.on_branch[number]))
    value, stable = result.value.values[at], result.stable.values[at]
    distance = np.abs(value - float(result.bifurcation_value[number]))
    changes = np.zeros(len(at), dtype=bool)
    changes[:-1] |= stable[1:] != stable[:-1]
    changes[1:] |= stable[1:] != stable[:-1]
    turns = np.zeros(len(at), dtype=bool)
    turns[1:-1] = np.diff(value)[1:] * np.diff(value)[:-1] < 0
    step = float(np.abs(np.diff(value)).max(initial=0.0))
    wanted = turns if str(result.bifurcation_type.values[number]) == "fold" else changes
    return int(at[np.lexsort((distance, ~(wanted & (distance <= step))))[0]])


def stage_parts(law: Law | None, angle: Array) -> list[str]:
    """The stage of a law, in words, at each relative angle [rad]; one with a negative angle is told as coasting."""
    if law is None or hinge_rows(law) is None:
        return ["linear" if law is None else "smooth"] * len(angle)
    names = {
        int(n): _part(law, float(angle[np.argmax(law.stage(angle) == n)]), int(n)) for n in np.unique(law.stage(angle))
    }
    return [names[int(n)] for n in law.stage(angle)]


def _part(law: Law, angle: float, number: int) -> str:
    name = law.stage_name(angle)
    return f"{name}, coast" if number < 0 else name


def stage_shares(law: Law | None, angle: Array) -> dict[str, float]:
    """Share of the time [-] that a signal of relative angles [rad], evenly sampled, spends in each stage of a law.

    From coasting to driving; shares sum to one.

    >>> from torsional.laws import Hinges
    >>> law = Hinges.staged([(100.0, 1e3), (300.0, 4e3)])
    >>> stage_shares(law, np.array([-0.05, 0.05, 0.05, 0.12]))
    {'stage 1': 0.75, 'stage 2': 0.25}
    """
    told = stage_parts(law, np.sort(angle))
    return {name: told.count(name) / len(told) for name in dict.fromkeys(told)}
