"""What a row of points settled in one compiled loop is presented as: the same as points settled one by one."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr

from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.stepping.batch import LEFT_OVER, PERIODS
from torsional.numerics.stepping.state import MADE
from torsional.results import dataset
from torsional.solvers.transient.batches import Row
from torsional.solvers.transient.character import named
from torsional.solvers.transient.honesty import honest, said
from torsional.solvers.transient.marching import method_share

ALONE = "{}; settled by itself, which the batch did not see repeat itself at its step"
_ORDERS = ("angle", "twist", "torque")
_ENDS = ("end_angle", "end_speed", "end_memory", "end_integral")


def row_dataset(row: Row) -> xr.Dataset:
    """Orders, ends and what is said of each point, over ``value`` [rad/s], as `steady_sweep` has them one way."""
    system, values = row.batch.system, row.speeds
    points = [_alone(row, place) if place in row.others else _point(row, place) for place in range(len(values))]
    told = {name: np.array([point[name] for point in points]) for name in points[0]}
    variables = {
        "angle": (("value", "order", "node"), told["angle"], "angle"),
        "twist": (("value", "order", "element"), told["twist"], "relative_angle"),
        "torque": (("value", "order", "element"), told["torque"], "torque"),
        "end_angle": (("value", "coordinate"), told["end_angle"], "angle"),
        "end_speed": (("value", "coordinate"), told["end_speed"], "angular_velocity"),
        "end_memory": (("value", "connection"), told["end_memory"], "relative_angle"),
        "end_integral": (("value", "governor"), told["end_integral"], ""),
    }
    scalars = {name: (("value",), found, "") for name, found in told.items() if name not in variables}
    coordinates: dict[str, tuple[Any, str] | tuple[Any, str, str]] = {
        "value": (np.array(values), ""),
        "order": (row.batch.orders, "engine_order"),
        "node": (np.array(system.nodes), ""),
        "element": (np.array(system.connections.names), ""),
        "speed_ratio": (system.speed_ratio, "gear_ratio", "node"),
    }
    facts: dict[str, Any] = {"base_order": row.batch.first.base_order, "system_hash": row.batch.first.line_hash}
    amplitude = "complex 0-peak; order 0 is the mean"
    return dataset(variables | scalars, coordinates, analysis="sweep in time", amplitude=amplitude, **facts)


def _alone(row: Row, place: int) -> dict[str, Any]:
    """A point that was settled by itself."""
    found = row.others[place]
    told = {name: found[name].values for name in (*_ORDERS, *_ENDS)}
    facts = {name: found.attrs[name] for name in ("kind", "periods", "exponent", "method_share")}
    return told | facts | {"status": ALONE.format(found.attrs["status"]), "notes": said(found.attrs)}


def _point(row: Row, place: int) -> dict[str, Any]:
    """A point that the compiled loop settled."""
    system, end, told = row.batch.system, row.end(place), row.told
    both = _harmonics(row, place)
    count = len(end.angle)
    standing = row.standing._replace(ledger=told.ledger[place], connection=np.zeros((MADE + 4, told.passed.shape[2])))
    standing.connection[MADE:] = told.passed[place]
    periods, nothing = int(told.counts[place, PERIODS]), float("nan")
    character = named(periods, float(told.figures[place, LEFT_OVER]), nothing, nothing, True)
    return {
        "angle": both[:, :count] @ system.T.T,
        "twist": both[:, :count] @ system.connections.weights.T,
        "torque": both[:, count:],
        "end_angle": end.angle,
        "end_speed": end.speed,
        "end_memory": end.memory,
        "end_integral": end.integral,
        "kind": character.kind,
        "status": character.words,
        "periods": periods,
        "exponent": nothing,
        "method_share": method_share(standing),
        "notes": said(honest(row.batch.first, standing, row.accuracy(place))),
    }


def _harmonics(row: Row, place: int) -> ComplexArray:
    """Complex 0-peak harmonics (orders, n + E) from the sums, what the samples have drifted by taken off."""
    told, parts = row.told, row.batch.asked.parts
    count = math.lcm(parts, int(told.counts[place, PERIODS]))
    samples = count * int(row.points.steps[place])
    ramp: Array = np.arange(samples) / samples - 0.5
    sloped = np.fft.rfft(ramp)[np.arange(len(row.batch.orders)) * (count // parts)]
    sums = told.sums[place, 0] + 1j * told.sums[place, 1]
    series = (sums - np.multiply.outer(sloped, told.edges[place, 1] - told.edges[place, 0])) * (2.0 / samples)
    series[0] /= 2.0
    return np.asarray(series)
