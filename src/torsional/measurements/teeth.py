"""Which tooth a pulse is of: gaps of the wheel are found, lost pulses counted, pulses by fault taken out."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from torsional.errors import ModelError
from torsional.numerics.arrays import Array

Numbers = NDArray[np.int64]

MISFIT = 0.45
"""A pulse is one by fault where intervals fit whole teeth better without it, by this share of a tooth."""
NEAR = 7
"""Intervals about one that tell how long it should be."""
PASSES = 20
FAULTS = 0.05
"""Share of pulses that may be mended; with more, the wheel is another one or the level is wrong."""


class Teeth(NamedTuple):
    """``times`` [s] of pulses that are of a tooth, their ``number`` (0: first behind a gap), and ``extra`` pulses."""

    times: Array
    number: Numbers
    extra: Array


def numbered(times: Array, teeth: int, missing: int, name: str) -> Teeth:
    """The pulses of a wheel with so many ``teeth`` a turn, the ``missing`` ones of its gap counted.

    An interval is compared with those about it: what lasts as long as m of them is m teeth.  A pulse is
    taken out where the intervals beside it fit whole teeth only without it.  ModelError where more than one pulse in
    twenty is lost or too many, where pulses stop for half a turn, and where the gaps are not where the wheel has them.
    """
    kept, extra = _without_extra(times, name)
    spans = _spans(kept)
    _refuse_stops(kept, spans, teeth, missing, name)
    number = np.concatenate([[0], np.cumsum(spans)])
    if missing:
        number = number - _first_behind_gap(kept, number, spans, teeth, missing, name)
    else:
        _refuse_regular_gaps(number, spans, name)
    lost = int((spans - 1).sum()) - (missing * _turns(number, teeth) if missing else 0)
    _refuse_faults(times.size, lost, times.size - kept.size, name)
    return Teeth(kept, number, extra)


def _usual(intervals: Array, rank: int) -> Array:
    """How long a tooth takes at each interval: the middle one of its two neighbours and one of the seven about it.

    Neighbours follow a speed that swings within few teeth; where one of them is long or short itself, the seven hold:
    their fourth, or their fifth (``rank`` from zero) while pulses by fault make some of them short.
    """
    from scipy.ndimage import rank_filter

    around, near = np.pad(intervals, 1, mode="reflect"), min(NEAR, intervals.size)
    usual = rank_filter(intervals, min(rank, near - 1), size=near, mode="mirror")
    return np.asarray(np.median([around[:-2], around[2:], usual], axis=0))


def _spans(times: Array) -> Numbers:
    """Over how many teeth each interval goes."""
    intervals = np.diff(times)
    return np.maximum(np.rint(intervals / _usual(intervals, NEAR // 2)), 1).astype(np.int64)


def _misfit(spans: Array) -> Array:
    """By what an interval, in teeth, differs from the next whole number of them, one at least."""
    return np.abs(spans - np.maximum(np.rint(spans), 1.0))


def _without_extra(times: Array, name: str) -> tuple[Array, Array]:
    """The pulses that fit a wheel, and those that do not, taken out one neighbourhood at a time."""
    kept, extra = times, [np.empty(0)]
    for _ in range(PASSES):
        intervals = np.diff(kept)
        spans = intervals / _usual(intervals, NEAR // 2 + 1)
        gain = _misfit(spans[:-1]) + _misfit(spans[1:]) - _misfit(spans[:-1] + spans[1:])
        padded = np.concatenate([[-1.0], gain, [-1.0]])
        worst = (gain > MISFIT) & (gain >= padded[:-2]) & (gain > padded[2:])
        if not worst.any():
            return kept, np.sort(np.concatenate(extra))
        out = np.flatnonzero(worst) + 1
        extra.append(kept[out])
        kept = np.delete(kept, out)
        _refuse_faults(times.size, 0, times.size - kept.size, name)
    return kept, np.sort(np.concatenate(extra))


def _turns(number: Numbers, teeth: int) -> int:
    """How many gaps lie between the first pulse and the last."""
    return int(number[-1] // teeth - number[0] // teeth)


def _first_behind_gap(times: Array, number: Numbers, spans: Numbers, teeth: int, missing: int, name: str) -> int:
    """The number, modulo the teeth, of the first tooth behind the gap; ModelError where turns do not agree on it."""
    ends = number[1:][spans == missing + 1]
    turns = (number[-1] - number[0]) // teeth
    votes = np.bincount(ends % teeth, minlength=teeth)
    first = int(votes.argmax())
    if votes[first] < max(0.5 * turns, 1):
        _refuse_wheel(number, spans, teeth, missing, votes[first], turns, name)
    inside = (number - first) % teeth >= teeth - missing
    if inside.any():
        at = times[int(np.argmax(inside))]
        found = f"a tooth in the gap at {at:.6g} s, one turn being {teeth} teeth long"
        remedy = "cut the record there, or look at the tacho's level"
        raise ModelError(
            "the teeth between two gaps are not as many as the wheel has", where=name, found=found, remedy=remedy
        )
    return first


def _refuse_wheel(number: Numbers, spans: Numbers, teeth: int, missing: int, seen: int, turns: int, name: str) -> None:
    """ModelError for gaps that are not there, with the wheel that it looks like."""
    told = _looks_like(number, spans)
    found = f"{seen} in {turns} turns of {teeth} teeth"
    remedy = f"it looks like a wheel of {told}" if told else "a wheel without a gap has missing=0"
    raise ModelError(f"there are no gaps of {missing} in each turn", where=name, found=found, remedy=remedy)


def _refuse_regular_gaps(number: Numbers, spans: Numbers, name: str) -> None:
    told = _looks_like(number, spans)
    if told:
        remedy = f"it looks like a wheel of {told}: say so"
        raise ModelError("a gap comes back in every turn", where=name, found=told, remedy=remedy)


def _looks_like(number: Numbers, spans: Numbers) -> str:
    """The wheel that long intervals at even distances speak of, in words; "" where there are none."""
    long = np.flatnonzero(spans > 1)
    apart = np.diff(number[long])
    if apart.size < 3:
        return ""
    common, missing = int(np.median(apart)), int(np.median(spans[long])) - 1
    regular = (apart == common).mean() > 0.8 and (spans[long] == missing + 1).mean() > 0.8
    return f"{common} teeth, {missing} of them missing ({common}-{missing})" if regular else ""


def _refuse_stops(times: Array, spans: Numbers, teeth: int, missing: int, name: str) -> None:
    worst = int(spans.argmax())
    if spans[worst] > max(teeth // 2, missing + 2, 3):
        found = f"from {times[worst]:.6g} to {times[worst + 1]:.6g} s"
        remedy = "take the stretch before it or behind it"
        raise ModelError("the pulses stop for more than half a turn", where=name, found=found, remedy=remedy)


def _refuse_faults(pulses: int, lost: int, extra: int, name: str) -> None:
    if lost + extra > max(FAULTS * pulses, 3):
        found = f"{lost} lost and {extra} too many among {pulses}"
        remedy = "look at level and hysteresis of the tacho, and at the number of teeth"
        raise ModelError("too many pulses do not fit the wheel", where=name, found=found, remedy=remedy)
