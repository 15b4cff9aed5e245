"""The mean rotation of a shaft: what is left of its angle when the vibration of a cycle is averaged away."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.engine.orders import CYCLE
from torsional.errors import ModelError
from torsional.measurements.signals import refuse_other
from torsional.numerics.arrays import Array
from torsional.results import Variable, dataset

STEPS = 72
"""Places a cycle at which the mean rotation is told: it has nothing quicker than the cycle itself."""


@checked
def mean_rotation(shaft: xr.Dataset, *, ratio: float = 1.0, cycle: float = CYCLE, marks: ArrayLike = ()) -> xr.Dataset:
    """The crank angle over time, as the mean rotation has it, from a ``shaft`` that may vibrate itself.

    ``shaft``: what `shaft_from_pulses` and its like tell; ``ratio``: its mean speed over the engine's.  ``marks`` [s]:
    times of firing top dead centres of cylinder 1, of some cycles or of one, which tell both turns of a cycle apart and
    put the crank angle's zero there; without them it is where the shaft's angle is.

    The time t(θ) at which the shaft meets an angle is averaged over whole cycles of the engine, B t = ∫ t dθ / span.
    That takes away every multiple of the half order, whatever its size; 2B − B² keeps a cubic course besides, so that
    a run-up has no lag.  ``crank_angle`` (time) [rad], ``speed`` (time) [rad/s]; a cycle is lost at either end.
    Raises ModelError for less than three cycles.

    >>> import torsional as tv
    >>> alpha = np.linspace(0.0, 200.0, 4000)
    >>> shaking = alpha + 0.01 * np.sin(3 * alpha) + 0.02 * np.cos(0.5 * alpha)  # at 100 rad/s
    >>> shaft = tv.shaft_from_encoder(xr.DataArray(shaking, {"time": alpha / 100.0}, attrs={"units": "rad"}))
    >>> found = mean_rotation(shaft)
    >>> bool(abs(found.speed - 100.0).max() < 1e-3)
    True
    """
    refuse_other(shaft, "shaft_angle", "shaft", "shaft_from_pulses")
    if not (ratio > 0 and cycle > 0):
        raise ModelError("ratio and cycle must be positive", where="mean_rotation", found=f"{ratio:g}, {cycle:g} rad")
    angle, time = shaft.shaft_angle.values, shaft.time.values
    half = 0.5 * cycle * ratio
    turned = (angle[-1] - angle[0]) / (2 * half)
    if turned < 3:
        found = f"{turned:.2f} cycles of {np.degrees(cycle):g}° crank angle"
        raise ModelError("a mean rotation takes three cycles", where=str(shaft.attrs.get("name", "shaft")), found=found)
    at, mean = _averaged(angle, time, half)
    crank = at / ratio
    over = _spline(mean, crank)
    crank = crank - _zero(over, mean, np.atleast_1d(np.asarray(marks, dtype=float)), cycle)
    variables: dict[str, Variable] = {
        "crank_angle": (("time",), crank, "crank_angle"),
        "speed": (("time",), over(mean, 1), "speed"),
    }
    told = {"ratio": ratio, "cycle": cycle, "shaft": str(shaft.attrs.get("name", ""))}
    return dataset(variables, {"time": (mean, "time")}, analysis="mean rotation", **told)


def _averaged(angle: Array, time: Array, half: float) -> tuple[Array, Array]:
    """Angles, and the mean times at which they are met: (2B − B²) t, B the mean from −half to half."""
    slope = (time[-1] - time[0]) / (angle[-1] - angle[0])
    steady = time[0] + slope * (angle - angle[0])  # taken out, lest integrals over long records lose digits
    step = 2 * half / STEPS
    once = np.arange(angle[0] + half, angle[-1] - half, step)
    first = _mean(angle, time - steady, once, half)
    twice = once[(once >= once[0] + half) & (once <= once[-1] - half)]
    second = _mean(once, first, twice, half)
    kept = np.isin(once, twice)
    return twice, time[0] + slope * (twice - angle[0]) + 2 * first[kept] - second


def _mean(x: Array, y: Array, at: Array, half: float) -> Array:
    integral = _spline(x, y).antiderivative()
    return np.asarray((integral(at + half) - integral(at - half)) / (2 * half))


def _spline(x: Array, y: Array) -> Any:
    from scipy.interpolate import CubicSpline

    return CubicSpline(x, y)


def _zero(over: Any, time: Array, marks: Array, cycle: float) -> float:
    """The crank angle at the marks, by the mean of their places on the circle of a cycle."""
    if not marks.size:
        return 0.0
    inside = marks[(marks >= time[0]) & (marks <= time[-1])]
    if not inside.size:
        found = f"{marks.size} from {marks.min():g} to {marks.max():g} s"
        allowed = f"{time[0]:g} to {time[-1]:g} s"
        raise ModelError("no mark lies where the rotation is known", where="marks", found=found, allowed=allowed)
    turns = np.exp(1j * 2 * np.pi * over(inside) / cycle)
    if abs(turns.mean()) < 0.9:
        remedy = "one mark a cycle is wanted, always at the same crank angle"
        raise ModelError("the marks stand at different crank angles", where="marks", remedy=remedy)
    return float(np.angle(turns.mean()) / (2 * np.pi) * cycle)


def crank_angle_at(rotation: xr.Dataset, times: Array) -> Array:
    """The crank angle [rad] of a mean rotation at times within it."""
    return np.asarray(_spline(rotation.time.values, rotation.crank_angle.values)(times))


def time_at(rotation: xr.Dataset, angles: Array) -> Array:
    """When [s] a mean rotation meets crank angles."""
    return np.asarray(_spline(rotation.crank_angle.values, rotation.time.values)(angles))


def deviation(shaft: xr.Dataset, rotation: xr.Dataset) -> xr.DataArray:
    """The angle [rad] of a shaft less its own mean rotation, at its own times, with the ``crank_angle`` of that.

    ``rotation``: the shaft's own `mean_rotation`.  Times outside of it are left out.
    """
    time = shaft.time.values
    inside = shaft.isel(time=(time >= float(rotation.time[0])) & (time <= float(rotation.time[-1])))
    crank = crank_angle_at(rotation, inside.time.values)
    off = inside.shaft_angle - float(rotation.attrs["ratio"]) * crank
    found: xr.DataArray = off - off.mean()
    return found.assign_coords(crank_angle=("time", crank), shaft_angle=inside.shaft_angle, pulse=inside.pulse)
