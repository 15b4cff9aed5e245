"""Orders of measured signals over the speed of a run-up: amplitudes and phases against the crank angle."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.engine.orders import HALF_ORDERS
from torsional.errors import ModelError
from torsional.measurements.resampling import common_span, resampled
from torsional.measurements.rotation import crank_angle_at, deviation, mean_rotation
from torsional.measurements.signals import raster, refuse_other
from torsional.numerics.arrays import Array, ComplexArray
from torsional.results import Variable, dataset
from torsional.solvers.transient.orders import order_tracking, samples_a_window
from torsional.units import QUANTITIES

BANDWIDTH = {"none": 1.0, "hann": 1.5}
"""Noise bandwidths of the windows, over that of a window of the same length that weighs all alike."""
CONVENTIONS = {"0-peak": 1.0, "RMS": 1 / np.sqrt(2), "peak-to-peak": 2.0}


@checked
def torsional_angle(shaft: xr.Dataset, rotation: xr.Dataset) -> xr.DataArray:
    """The vibration of a ``shaft`` [rad] at its own times: its angle less its own mean rotation.

    ``rotation`` is the engine's; how many times as fast the shaft turns on the mean is found from both.

    >>> import torsional as tv
    >>> alpha = np.linspace(0.0, 200.0, 4000)
    >>> shaking = xr.DataArray(2 * alpha + 0.01 * np.sin(3 * alpha), {"time": alpha / 100.0}, attrs={"units": "rad"})
    >>> engine = xr.DataArray(alpha, {"time": alpha / 100.0}, attrs={"units": "rad"})
    >>> turning = mean_rotation(tv.shaft_from_encoder(engine))
    >>> found = torsional_angle(tv.shaft_from_encoder(shaking), turning)
    >>> float(abs(found).max().round(4))
    0.01
    """
    refuse_other(shaft, "shaft_angle", "shaft", "shaft_from_pulses")
    refuse_other(rotation, "crank_angle", "rotation", "mean_rotation")
    time = shaft.time.values
    ends = np.clip([rotation.time.values[0], rotation.time.values[-1]], time[0], time[-1])
    turned = float(np.ptp(crank_angle_at(rotation, ends)))
    if not turned > 0:
        raise ModelError("shaft and rotation have no time in common", where=str(shaft.attrs.get("name", "shaft")))
    ratio = float(np.ptp(np.interp(ends, time, shaft.shaft_angle.values))) / turned
    own = mean_rotation(shaft, ratio=ratio, cycle=float(rotation.attrs["cycle"]))
    off = deviation(shaft, own).drop_vars(["crank_angle", "shaft_angle", "pulse"]).rename("angle")
    return off.assign_attrs(units="rad", quantity="angle", teeth=int(shaft.attrs["teeth"]), ratio=ratio)


@checked
def track_orders(
    signals: xr.Dataset | xr.DataArray | None,
    rotation: xr.Dataset,
    orders: ArrayLike = HALF_ORDERS,
    *,
    shafts: Mapping[str, xr.Dataset] | None = None,
    cycles: int = 4,
    window: Literal["none", "hann"] = "hann",
    overlap: float = 0.75,
) -> xr.Dataset:
    """Orders of measured ``signals`` and of the vibration of ``shafts``, by name, in windows along a run-up.

    ``rotation``: the crank angle over time, of `mean_rotation`.  Each of the signals over a raster of times is brought
    to even crank angles (`resampled`) and told in windows of whole ``cycles`` of 720° by `order_tracking`: complex
    0-peak, x(α) = Re Σ X_n exp(i n α), orders being multiples of 0.5/cycles.  ``window`` "hann", of two cycles or more,
    keeps orders apart that grow or fade on the way, its amplitude corrected by two; "none" those of steady size alone.

    Dimensions (speed, order), speeds [rad/s] being those in the middle of each window in the sequence of the record,
    with ``time`` [s] beside them.  A signal keeps its name and unit; ``angle`` (speed, order, node) [rad] are the
    shafts, and ``noise`` (speed, node) [rad] what clocks and counts make of nothing: root mean square over many
    windows of the 0-peak amplitude at any order,

        |Φ|_rms = 2 σ √(b/M),  σ² = ((ω Δt)² + δ²)/12

    of M pulses in a window of noise bandwidth b, times known to Δt, angles to δ.  Raises ModelError as these functions
    do, and where nothing is asked for.

    >>> import torsional as tv
    >>> t = np.arange(0.0, 4.0, 1e-3)
    >>> alpha = 60.0 * t + 20.0 * t**2
    >>> turning = mean_rotation(tv.shaft_from_encoder(xr.DataArray(alpha, {"time": t}, attrs={"units": "rad"})))
    >>> shaken = xr.DataArray(0.3 * np.cos(3 * alpha - 0.5), {"time": t}, name="mount", attrs={"units": "mm"})
    >>> found = track_orders(shaken, turning, [1.5, 3.0])
    >>> found.mount.dims, abs(found.mount).isel(speed=5).values.round(3).tolist(), found.mount.attrs["units"]
    (('speed', 'order'), [0.0, 0.3], 'mm')
    """
    refuse_other(rotation, "crank_angle", "rotation", "mean_rotation")
    given, around = _given(signals, bool(shafts)), shafts or {}
    turning = {name: torsional_angle(shaft, rotation).rename(name) for name, shaft in around.items()}
    columns = [column for signal in given.values() for column in _columns(signal)]
    order = np.atleast_1d(np.asarray(orders, dtype=float))
    even = _at_even_angles([*columns, *turning.values()], rotation, order, cycles)
    found = [_tracked(each, order, cycles, window, overlap) for each in even]
    middle = found[0].time.values
    speed = np.interp(middle, rotation.time.values, rotation.speed.values)
    at: dict[str, Any] = {
        "speed": (speed, "speed"),
        "order": (order, "engine_order"),
        "time": (middle, "time", "speed"),
    }
    parts = iter([each.values for each in found])
    variables = {name: _laid(signal, [next(parts) for _ in _columns(signal)]) for name, signal in given.items()}
    at |= {dim: (signal[dim].values, "") for signal in given.values() for dim in _places(signal)}
    if around:
        noise = [_noise(shaft, turning[name], speed, cycles, window) for name, shaft in around.items()]
        variables["angle"] = (("speed", "order", "node"), np.stack(list(parts), axis=-1), "angle")
        variables["noise"] = (("speed", "node"), np.stack(noise, axis=-1), "angle")
        at["node"] = (np.array(list(around)), "")
    settings: dict[str, Any] = {"cycles": cycles, "window": window, "overlap": overlap, "amplitude": "complex 0-peak"}
    settings["interpolation_error"] = max(float(each.attrs["interpolation_error"]) for each in even)
    settings["reference"] = str(rotation.attrs.get("shaft", ""))
    words = {name: str(signal.attrs.get("long_name", name)) for name, signal in given.items()}
    return _with_units(dataset(variables, at, words, analysis="order tracking", **settings), given)


def _at_even_angles(
    signals: Sequence[xr.DataArray], rotation: xr.Dataset, order: Array, cycles: int
) -> list[xr.DataArray]:
    """All signals at the same even angles, fine enough for the highest order."""
    if not signals:
        raise ModelError("neither signals nor shafts were given", where="track_orders")
    per_turn = int(np.ceil(samples_a_window(float(order.max()), cycles) / (2 * cycles)))
    span = common_span(rotation, [raster(signal)[0] for signal in signals], per_turn)
    return [resampled(signal, rotation, per_turn, span=span) for signal in signals]


def _given(signals: xr.Dataset | xr.DataArray | None, shafts: bool) -> dict[str, xr.DataArray]:
    """The numeric channels by name; one whose name has a meaning here already is told apart."""
    if signals is None:
        return {}
    held = signals.to_dataset(name=signals.name or "signal") if isinstance(signals, xr.DataArray) else signals
    taken = {"speed", "order", "time", "noise", "node", *(["angle"] if shafts else [])}
    numeric = {str(name): held[name] for name in held.data_vars if held[name].dtype.kind in "iuf"}
    return {f"{name}_signal" if name in taken else name: signal.rename(name) for name, signal in numeric.items()}


def _places(signal: xr.DataArray) -> list[str]:
    """Dimensions of a signal other than its raster of times."""
    return [str(dim) for dim in signal.dims if not str(dim).startswith("time")]


def _columns(signal: xr.DataArray) -> list[xr.DataArray]:
    """The signal at each of its places, by itself."""
    places = _places(signal)
    if not places:
        return [signal]
    return [signal.isel({places[0]: i}, drop=True) for i in range(signal.sizes[places[0]])]


def _laid(signal: xr.DataArray, parts: list[ComplexArray]) -> Variable:
    """Orders of a signal's places side by side, as results have them: over speed, order and place."""
    quantity = str(signal.attrs.get("quantity", ""))
    known = quantity if quantity in QUANTITIES else ""
    places = _places(signal)
    return (("speed", "order", *places), np.stack(parts, axis=-1) if places else parts[0], known)


def _tracked(even: xr.DataArray, order: Array, cycles: int, window: str, overlap: float) -> xr.DataArray:
    angle = xr.DataArray(even.crank_angle.values, {"time": even.time.values}, ("time",))
    signal = even.swap_dims(crank_angle="time").drop_vars("crank_angle")
    return order_tracking(signal, angle, order, cycles=cycles, window=window, overlap=overlap)


def _noise(shaft: xr.Dataset, angle: xr.DataArray, speed: Array, cycles: int, window: str) -> Array:
    """Amplitude [rad] at any order that clock and counts make of nothing."""
    ratio, teeth = float(angle.attrs["ratio"]), int(shaft.attrs["teeth"]) - int(shaft.attrs["missing"])
    ticks = np.hypot(speed * ratio * float(shaft.attrs["resolution"]), float(shaft.attrs["angle_resolution"]))
    return np.asarray(ticks / np.sqrt(12) * 2 * np.sqrt(BANDWIDTH[window] / (teeth * ratio * 2 * cycles)))


def _with_units(data: xr.Dataset, given: Mapping[str, xr.DataArray]) -> xr.Dataset:
    """The variables with the units of the channels, and the convention of their amplitudes."""
    told = {
        name: {key: signal.attrs[key] for key in ("units", "long_name") if key in signal.attrs}
        for name, signal in given.items()
    }
    for name in data.data_vars:
        own = "0-peak, root mean square" if name == "noise" else "complex 0-peak"
        data[name].attrs.update(told.get(str(name), {}), amplitude=own)
    return data


@checked
def in_convention(orders: xr.DataArray, convention: Literal["0-peak", "RMS", "peak-to-peak"]) -> xr.DataArray:
    """Sizes of single orders as "0-peak", "RMS" (over √2) or "peak-to-peak" (twice), told in the attributes.

    >>> in_convention(xr.DataArray([3.0 + 4.0j]), "peak-to-peak").values.tolist()
    [10.0]
    """
    if convention not in CONVENTIONS:
        told = {"found": repr(convention), "allowed": ", ".join(CONVENTIONS)}
        raise ModelError("there is no such convention of amplitudes", where="convention", **told)
    found: xr.DataArray = abs(orders) * CONVENTIONS[convention]
    return found.assign_attrs({**orders.attrs, "amplitude": convention})
