"""How well computed orders agree with measured ones, order by order."""

from __future__ import annotations

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.results import Variable, labelled

LEAST = 3
"""Speeds at which an order must have been measured to be judged."""
SAME = 1e-6
GOOD, FAIR = 0.9, 0.7
"""Frequency response assurance from which on an order counts as reproduced, and as partly so."""


@checked
def correlation(measured: xr.DataArray, computed: xr.DataArray) -> xr.Dataset:
    """Deviations of ``computed`` orders from ``measured`` ones, both (order, speed), 0-peak, complex or amplitudes.

    At the measured speeds within the computed range, between whose points lines are drawn.  Of each order that both
    have, with m what was measured and c what was computed:
    ``amplitude_error`` rms|c|/rms|m| − 1; ``peak_error`` max|c|/max|m| − 1 and ``peak_shift``, the speed of the
    computed peak less that of the measured one; ``phase_difference`` arg Σ m* c, by what c leads; ``frac`` |Σ m* c|² /
    (Σ|m|² Σ|c|²), the frequency response assurance criterion: 1 where both have one shape, whatever their size (R.
    Allemang, Sound and Vibration 37(8), 2003, p. 14); ``rms_deviation`` of |c| − |m| and ``relative_deviation``, it
    over rms|m|; ``r_squared`` 1 − Σ(|c| − |m|)²/Σ(|m| − mean|m|)².  Phases are no numbers where one of both has
    amplitudes alone, and ``frac`` is that of the amplitudes.  Raises ModelError where the quantities differ, where no
    order is common, and where fewer than three speeds are.

    >>> speed = np.array([60.0, 80.0, 100.0, 120.0])
    >>> m = xr.DataArray([[1.0, 4.0, 2.0, 1.0]], coords={"order": [3.0], "speed": speed}, dims=("order", "speed"))
    >>> found = correlation(m, 1.1 * m)
    >>> round(found.amplitude_error.item(), 9), round(found.frac.item(), 9), round(found.relative_deviation.item(), 9)
    (0.1, 1.0, 0.1)
    """
    orders, speeds = _common(measured, computed)
    quantity = str(measured.attrs.get("quantity") or computed.attrs.get("quantity") or "number")
    pairs = [_pair(measured, computed, order, speeds) for order in orders]
    figures = [_figures(speeds, *pair) for pair in pairs]
    by_name = {name: np.array([each[name] for each in figures]) for name in figures[0]}
    over = ("order", "speed")
    values: dict[str, Variable] = {
        name: (("order",), array, _KINDS.get(name, quantity)) for name, array in by_name.items()
    }
    values |= {
        name: (over, np.array([p[i] for p in pairs]), quantity) for i, name in enumerate(("measured", "computed"))
    }
    axes = {"order": (np.array(orders), "engine_order"), "speed": (speeds, "speed")}
    return labelled(values, axes, analysis="correlation", quantity=quantity, amplitude="0-peak")


_KINDS = {
    "amplitude_error": "relative_difference",
    "peak_error": "relative_difference",
    "relative_deviation": "relative_difference",
    "peak_shift": "speed",
    "phase_difference": "angle",
    "frac": "ratio",
    "r_squared": "ratio",
    "speeds": "number",
}


def _common(measured: xr.DataArray, computed: xr.DataArray) -> tuple[list[float], Array]:
    """Orders that both have, and the measured speeds within the computed range."""
    for name, values in (("measured", measured), ("computed", computed)):
        if set(values.dims) != {"order", "speed"}:
            raise ModelError("orders over speed are wanted", where=name, found=", ".join(map(str, values.dims)))
    kinds = [str(values.attrs.get("quantity", "")) for values in (measured, computed)]
    if all(kinds) and kinds[0] != kinds[1]:
        raise ModelError("one quantity is wanted on both sides", found=f"{kinds[0]} measured, {kinds[1]} computed")
    orders = [float(n) for n in measured.order.values if np.abs(computed.order.values - n).min() < SAME]
    if not orders:
        told = ", ".join(f"{n:g}" for n in measured.order.values[:12])
        known = ", ".join(f"{n:g}" for n in computed.order.values[:12])
        raise ModelError("no measured order was computed", found=f"orders {told}", allowed=f"orders {known}")
    speeds, within = measured.speed.values, computed.speed.values
    inside = speeds[(speeds >= within.min() * (1 - SAME)) & (speeds <= within.max() * (1 + SAME))]
    if inside.size < LEAST:
        found = f"{inside.size} of {speeds.size} measured speeds within the computed range"
        raise ModelError("too few speeds are common", found=found, allowed=f"{LEAST} at least")
    return orders, inside


def _pair(measured: xr.DataArray, computed: xr.DataArray, order: float, speeds: Array) -> tuple[Array, Array]:
    """Both curves of an order at the speeds, complex where both are."""
    own = measured.sel(order=order, method="nearest").sel(speed=speeds).values
    other = computed.sel(order=order, method="nearest").sortby("speed")
    line = np.interp(speeds, other.speed.values, other.values)
    if np.iscomplexobj(own) and np.iscomplexobj(line):
        return own, line
    size = np.interp(speeds, other.speed.values, np.abs(other.values))
    return np.abs(own), np.where(np.isnan(own), np.nan, size)


def _figures(speeds: Array, measured: Array, computed: Array) -> dict[str, float]:
    there = np.isfinite(measured) & np.isfinite(computed)
    m, c, at = measured[there], computed[there], speeds[there]
    size, told = np.abs(m), np.abs(c)
    if m.size < LEAST or not size.any():
        return {**dict.fromkeys(_NAMES, np.nan), "speeds": float(m.size)}
    rms, off = float(np.sqrt(np.mean(size**2))), float(np.sqrt(np.mean((told - size) ** 2)))
    together, spread = np.vdot(m, c), float(np.sum((size - size.mean()) ** 2))
    energy = float(np.sum(told**2))
    return {
        "amplitude_error": float(np.sqrt(np.mean(told**2))) / rms - 1.0,
        "peak_error": float(told.max() / size.max()) - 1.0,
        "peak_shift": float(at[told.argmax()] - at[size.argmax()]),
        "phase_difference": float(np.angle(together)) if np.iscomplexobj(m) else np.nan,
        "frac": float(np.abs(together) ** 2 / (np.sum(size**2) * energy)) if energy else 0.0,
        "rms_deviation": off,
        "relative_deviation": off / rms,
        "r_squared": 1.0 - off**2 * m.size / spread if spread else np.nan,
        "speeds": float(m.size),
    }


_NAMES = (
    "amplitude_error",
    "peak_error",
    "peak_shift",
    "phase_difference",
    "frac",
    "rms_deviation",
    "relative_deviation",
    "r_squared",
)


def in_words(found: xr.Dataset) -> list[str]:
    """What the deviations mean, a sentence an order, the largest measured order first."""
    size = np.nan_to_num(np.sqrt(np.mean(np.abs(found.measured.fillna(0.0).values) ** 2, axis=1)))
    told = []
    for place in np.argsort(-size, kind="stable"):
        one = found.isel(order=int(place))
        name = f"Order {float(one.order):g}"
        if not np.isfinite(one.frac):
            told.append(f"{name}: measured at {int(one.speeds)} speeds within the computed range, too few to judge.")
            continue
        frac = float(one.frac)
        verdict = "reproduced" if frac >= GOOD else "partly reproduced" if frac >= FAIR else "not reproduced"
        shift = float(one.peak_shift) * 30.0 / np.pi
        told.append(
            f"{name}: the course over speed is {verdict} (FRAC {frac:.2f}); amplitudes are "
            f"{100 * float(one.amplitude_error):+.1f} % off in the mean of squares, the peak "
            f"{100 * float(one.peak_error):+.1f} %, {shift:+.0f} rpm away."
        )
    return told
