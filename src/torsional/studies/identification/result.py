"""Fits as one Dataset: estimates with intervals, what the data tell, models compared, curves and what was held back."""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.numerics.arrays import Array
from torsional.results import Variable, labelled
from torsional.studies.estimates import Identified
from torsional.studies.identification.task import Fit, Task, fits_of, profile
from torsional.studies.identification.words import findings
from torsional.units import QUANTITIES


@checked
def identify(task: Task, moved: Callable[[int, int], None] | None = None) -> xr.Dataset:
    """What an identification finds: parameters with their intervals, models compared, points held back predicted.

    Over ``parameter`` of the plan's own model ``estimate``, ``deviation``, the ends of the interval ``interval_low``
    and ``interval_high`` and ``correlation``, in SI of their ``unit``; over ``way`` the combinations that the data
    tell, ``way_share`` of each parameter and ``way_deviation`` in the parameters' scales; over ``model`` the ``misfit``
    (RMS of residuals over the noise), ``held_misfit`` of the points held back, ``aicc`` and ``bic``; over ``model`` and
    ``point`` the ``point_misfit``; and along ``sample`` what was measured and predicted, as pictures show it.
    ``moved`` is told (models done, all).
    Raises ModelError where a model has no answer within the bounds.
    """
    return told(task, fits_of(task, moved))


def told(task: Task, fits: Sequence[Fit]) -> xr.Dataset:
    """The Dataset of fits."""
    own = fits[0].found
    curves, places = _curves(task, fits)
    values = {**_estimates(own, task.level), **_appraisals(task, fits), **curves}
    if task.profiles:
        values |= _profiles(task, fits[0])
    axes = {**_parameters(fits[0]), **_points(task, fits), **places}
    data = labelled(values, axes, analysis="identification", plan=task.name, level=task.level)
    return data.assign_attrs(
        estimates=json.dumps({fit.candidate.name: fit.found.values for fit in fits}),
        evaluations=sum(fit.found.evaluations for fit in fits),
        findings="\n".join(findings(task, fits)),
        samples=own.samples,
    )


def _estimates(own: Identified, level: float) -> dict[str, Variable]:
    names, ways = [unknown.name for unknown in own.unknowns], own.ways
    low, high = own.intervals(level).T
    return {
        "estimate": (("parameter",), own.estimates, ""),
        "deviation": (("parameter",), own.deviations, ""),
        "interval_low": (("parameter",), low, ""),
        "interval_high": (("parameter",), high, ""),
        "correlation": (("parameter", "other"), own.correlation, "number"),
        "way_deviation": (("way",), [way.deviation for way in ways], "ratio"),
        "way_share": (("way", "parameter"), [[way.share[name] for name in names] for way in ways], "number"),
    }


def _appraisals(task: Task, fits: Sequence[Fit]) -> dict[str, Variable]:
    """What each model leaves, and its criteria."""
    by_point = np.array([_misfits(task, fit) for fit in fits])
    return {
        "misfit": (("model",), [fit.found.misfit for fit in fits], "ratio"),
        "held_misfit": (("model",), [fit.held_misfit for fit in fits], "ratio"),
        "aicc": (("model",), [fit.found.aicc for fit in fits], "number"),
        "bic": (("model",), [fit.found.bic for fit in fits], "number"),
        "parameters": (("model",), [len(fit.found.unknowns) for fit in fits], "number"),
        "point_misfit": (("model", "point"), by_point, "ratio"),
    }


def _parameters(fit: Fit) -> dict[str, Any]:
    unknowns = fit.candidate.unknowns
    names = np.array([unknown.name for unknown in unknowns])
    return {
        "parameter": (names, ""),
        "other": (names, ""),
        "unit": (np.array([QUANTITIES[unknown.quantity].unit for unknown in unknowns]), "", "parameter"),
        "kind": (np.array([unknown.quantity for unknown in unknowns]), "", "parameter"),
        "begun": (np.array([unknown.start for unknown in unknowns]), "", "parameter"),
        "way": (np.arange(len(unknowns)), ""),
    }


def _points(task: Task, fits: Sequence[Fit]) -> dict[str, Any]:
    return {
        "model": (np.array([fit.candidate.name for fit in fits]), ""),
        "point": (np.array(task.names), ""),
        "held": (np.array([name in task.held for name in task.names], dtype=np.int8), "", "point"),
    }


def _misfits(task: Task, fit: Fit) -> list[float]:
    points = (point for source in task.sources for point in source.points)
    pairs = zip(points, fit.predictions, strict=True)
    return [float(np.sqrt(np.mean(np.square((point.values - each) / point.noise)))) for point, each in pairs]


def _curves(task: Task, fits: Sequence[Fit]) -> tuple[dict[str, Variable], dict[str, tuple[Array, str, str]]]:
    """All points as pictures show them, one after the other along ``sample``."""
    axis: list[Array] = []
    seen: list[Array] = []
    fitted: list[list[Array]] = [[] for _ in fits]
    noise: list[float] = []
    along, of, which = [], [], []
    place = 0
    for source in task.sources:
        for number, point in enumerate(source.points):
            shown = source.shown(number, point.values)
            axis.append(shown.axis)
            seen.append(shown.values)
            noise.append(point.noise)
            for fit, own in zip(fits, fitted, strict=True):
                own.append(source.shown(number, fit.predictions[place]).values)
            along.append(shown.along)
            of.append(shown.quantity)
            which.append(np.full(shown.axis.size, place))
            place += 1
    values: dict[str, Variable] = {
        "measured": (("sample",), np.concatenate(seen), ""),
        "fitted": (("model", "sample"), np.array([np.concatenate(own) for own in fitted]), ""),
        "noise": (("point",), noise, ""),
    }
    places: dict[str, tuple[Array, str, str]] = {
        "axis": (np.concatenate(axis), "", "sample"),
        "sample_point": (np.concatenate(which), "", "sample"),
        "along": (np.array(along), "", "point"),
        "quantity": (np.array(of), "", "point"),
    }
    return values, places


def _profiles(task: Task, fit: Fit) -> dict[str, Variable]:
    found = [profile(task, fit, unknown.name) for unknown in fit.found.unknowns]
    over = ("parameter", "step")
    # the rise in squares over that of one degree of freedom: its root is Student's t where the model is linear
    rise = np.array([(squares - 1.0) * fit.found.freedom for _, squares in found])
    return {
        "profile_value": (over, np.array([values for values, _ in found]), ""),
        "profile_rise": (over, rise, "number"),
    }
