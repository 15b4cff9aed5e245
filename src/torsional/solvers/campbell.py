"""Interference (Campbell) analysis: natural frequencies over speed in every gear, and where engine orders meet them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import dataset, of_model
from torsional.solvers.modal import modal_values, natural_frequencies
from torsional.solvers.operating import at_operating_point
from torsional.system import System


@checked
def campbell(
    model: Model,
    torque: float | None = None,
    gears: Sequence[str | int] | None = None,
    speeds: ArrayLike | None = None,
    orders: Sequence[float] | None = None,
) -> xr.Dataset:
    """Natural frequencies of a ``model`` over engine speed in every gear, and the speeds at which orders meet them.

    The system is linearised about the mean engine ``torque`` [Nm] (default: `Model.typical_torque`); ``speeds`` [rad/s]
    (default: up to the highest of the operating range); ``orders`` (default: `Model.engine_orders`).  ``frequency``
    [Hz] and ``damping_ratio`` (gear, speed, mode), ``elastic_share`` (gear, speed, mode, element); ``crossing``
    (gear, mode, order) [rad/s], the speed with n Ω = 2π f(Ω), NaN where there is none: for a mode that does not depend
    on speed wherever it lies, else the lowest among the speeds.  Raises ModelError as `equilibrium` does.

    >>> from torsional.components import Inertia, Shaft
    >>> from torsional.model import Landmarks
    >>> pair = {"a": Inertia(211.4), "b": Inertia(8.3), "s": Shaft("a", "b", 9.775e6)}
    >>> met = campbell(Model("pair", pair, Landmarks()), orders=[3.0]).crossing.isel(gear=0, mode=1, order=0)
    >>> round(float(met) * 30 / np.pi, 1)  # rpm: 20 f for the third order
    3521.5
    """
    mean = model.typical_torque() if torque is None else float(torque)
    names = model.chosen_gears(gears)
    at = _speeds(model) if speeds is None else np.atleast_1d(np.asarray(speeds, dtype=float))
    n = np.asarray(model.engine_orders() if orders is None else orders, dtype=float)
    lines = [_line(at_operating_point(model, mean, gear)[0], at, n) for gear in names]
    elements = list(dict.fromkeys(element for line in lines for element in line.elements))
    count = max(line.frequency.shape[1] for line in lines)
    found = dataset(
        {
            "frequency": (("gear", "speed", "mode"), _stacked([l.frequency for l in lines], count, 1), "frequency"),
            "damping_ratio": (
                ("gear", "speed", "mode"),
                _stacked([l.damping for l in lines], count, 1),
                "damping_ratio",
            ),
            "elastic_share": (("gear", "speed", "mode", "element"), _shares(lines, elements, count), "energy_share"),
            "crossing": (("gear", "mode", "order"), _stacked([l.crossing for l in lines], count, 0), "speed"),
        },
        {
            "gear": (np.array(names), ""),
            "speed": (at, "speed"),
            "mode": (np.arange(count), ""),
            "order": (n, "engine_order"),
            "element": (np.array(elements), ""),
        },
        analysis="campbell",
        mean_torque=mean,
    )
    return of_model(found, model)


@dataclass(frozen=True, eq=False)
class _Line:
    """One gear: frequency and damping (speed, mode), shares (speed, mode, element), crossings (mode, order)."""

    elements: tuple[str, ...]
    frequency: Array
    damping: Array
    shares: Array
    crossing: Array


def _speeds(model: Model) -> Array:
    highest = model.operation.speed[1]
    return np.linspace(highest / 40, highest, 40)


def _line(system: System, speeds: Array, orders: Array) -> _Line:
    """Speed matters only to pendulums and to switched inertias: without them one solution holds everywhere."""
    steady = not system.connections.centrifugal_stiffness.any() and not any(system.masses.switches)
    found = [modal_values(system, float(speed)) for speed in (speeds[:1] if steady else speeds)]
    repeats = (len(speeds) // len(found), 1)
    frequency = np.tile([m.frequency for m in found], repeats)
    damping = np.tile([m.damping_ratio for m in found], repeats)
    shares = np.tile([m.elastic_share for m in found], (*repeats, 1))
    return _Line(system.connections.names, frequency, damping, shares, _crossings(system, speeds, frequency, orders))


def _crossings(system: System, speeds: Array, frequency: Array, orders: Array) -> Array:
    met = np.full((frequency.shape[1], len(orders)), np.nan)
    at, found = _both_sides(system, speeds, frequency)
    for mode, over in enumerate(2 * np.pi * found.T):
        for i, order in enumerate(orders):
            if over.max() > 0:
                met[mode, i] = over[0] / order if np.ptp(over) == 0 else _met(system, at, over, mode, order)
    return met


def _both_sides(system: System, speeds: Array, frequency: Array) -> tuple[Array, Array]:
    """The speeds and frequencies [Hz] with two more of each switched inertia: just before and just after it switches.

    A frequency jumps there, and an order that it jumps over does not meet it.
    """
    low, high = speeds.min(), speeds.max()
    switches = [s.speed for s in system.masses.switches if s is not None and low < s.speed < high]
    more = np.array([side for speed in switches for side in (speed, np.nextafter(speed, np.inf))])
    if not more.size:
        return speeds, frequency
    rows = np.array([natural_frequencies(system, float(speed)) for speed in more]) / (2 * np.pi)
    both, first = np.unique(np.concatenate([speeds, more]), return_index=True)
    return both, np.concatenate([frequency, rows])[first]


def _met(system: System, speeds: Array, omega: Array, mode: int, order: float) -> float:
    """The lowest speed at which an order meets a mode whose frequency depends on speed."""
    from scipy.optimize import brentq  # imported where used: most analyses do without

    def gap(speed: float) -> float:
        return float(natural_frequencies(system, speed)[mode]) - order * speed

    over = omega - order * speeds
    jumps = np.nextafter(speeds[:-1], np.inf) == speeds[1:]
    turns = np.flatnonzero((np.sign(over[1:]) * np.sign(over[:-1]) < 0) & ~jumps)
    if not turns.size:
        return float("nan")
    low, high = float(speeds[turns[0]]), float(speeds[turns[0] + 1])
    try:
        return float(brentq(gap, low, high, xtol=1e-9 * high))
    except ValueError as error:  # the same modes by another count of rigid ones
        raise ModelError("the speed at which an order meets a mode was not found", found=str(error)) from None


def _stacked(values: Sequence[Array], count: int, axis: int) -> Array:
    """Gears together, padded with NaN where one has fewer modes."""
    padded = []
    for value in values:
        widths = [(0, count - value.shape[axis]) if i == axis else (0, 0) for i in range(value.ndim)]
        padded.append(np.pad(value, widths, constant_values=np.nan))
    return np.stack(padded)


def _shares(lines: Sequence[_Line], elements: Sequence[str], count: int) -> Array:
    """Energy shares of all gears over the union of their connections."""
    stacked = np.zeros((len(lines), len(lines[0].shares), count, len(elements)))
    for share, line in zip(stacked, lines, strict=True):
        columns = [elements.index(name) for name in line.elements]
        share[:, : line.shares.shape[1], columns] = line.shares
    return stacked
