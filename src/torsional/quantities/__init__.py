"""What an engineer reads off a result: functions from a Dataset or DataArray to a DataArray with its unit.

Orders are complex 0-peak amplitudes X_n, the signal being x(t) = Re Σ_n X_n exp(i n Ω t).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray
from torsional.units import QUANTITIES

SAMPLES = 720
"""Points over one cycle of 720° for signals put together from orders: the peak of order n is met to 3.8e-5 n²."""


def _as(values: xr.DataArray, quantity: str, **attrs: str) -> xr.DataArray:
    entry = QUANTITIES[quantity]
    told = {"units": entry.unit, "long_name": entry.long_name, "quantity": quantity, **attrs}
    return values.rename(quantity).assign_attrs(told)


@checked
def acceleration(angle: xr.DataArray) -> xr.DataArray:
    """Angular acceleration orders −(nΩ)² θ_n [rad/s²], complex 0-peak, from angle orders over speed.

    >>> theta = xr.DataArray([[1e-3 + 0j]], coords={"speed": [100.0], "order": [3.0]})
    >>> acceleration(theta).values.real.tolist()
    [[-90.0]]
    """
    found = -((angle.order * angle.speed) ** 2) * angle
    return _as(found.transpose(*angle.dims), "acceleration", amplitude="complex 0-peak")


@checked
def angular_velocity(angle: xr.DataArray) -> xr.DataArray:
    """Speed fluctuation orders i nΩ θ_n [rad/s], complex 0-peak, from angle orders [rad] over speed.

    >>> theta = xr.DataArray([[1e-3 + 0j]], coords={"speed": [100.0], "order": [3.0]})
    >>> round(float(abs(angular_velocity(theta)).max()), 9)
    0.3
    """
    found = 1j * angle.order * angle.speed * angle
    return _as(found.transpose(*angle.dims), "angular_velocity", amplitude="complex 0-peak")


def cycles(orders: xr.DataArray) -> int:
    """How many cycles of 720° a signal takes to repeat itself: one for half orders, two for order 0.75 and so on."""
    counts = (1, 2, 4, 8, 16)
    halves = 2 * np.asarray(orders.order, dtype=float)
    return next((n for n in counts if np.allclose(n * halves, np.round(n * halves), rtol=0.0, atol=1e-9)), 1)


@checked
def waveform(orders: xr.DataArray, samples: int = SAMPLES) -> xr.DataArray:
    """The signal over one cycle of 720°, phase-true: Re Σ_n X_n exp(i n α); ``order`` becomes ``crank_angle``.

    Orders that are no multiples of one half take several `cycles` to repeat themselves, which are then all told.

    >>> orders = xr.DataArray([3.0, 4.0j], coords={"order": [3.0, 6.0]})
    >>> waveform(orders, samples=720).values[:3].round(3).tolist()  # every degree
    [3.0, 2.578, 2.152]
    """
    alpha = np.arange(samples * cycles(orders)) * (4 * np.pi / samples)
    rest = [dim for dim in orders.dims if dim != "order"]
    values = orders.transpose(*rest, "order")
    signal = _synthesized(values.values, np.outer(values.order.values, alpha))
    coords = {name: c for name, c in orders.coords.items() if "order" not in c.dims} | {"crank_angle": alpha}
    attrs = {**orders.attrs, "amplitude": "signal"}
    return xr.DataArray(signal, dims=(*rest, "crank_angle"), coords=coords, name=orders.name, attrs=attrs)


def _synthesized(values: ComplexArray, phase: Array) -> Array:
    """Re (values @ exp(i phase)) in real arithmetic."""
    return np.asarray(values.real @ np.cos(phase) - values.imag @ np.sin(phase))


@checked
def swing(orders: xr.DataArray, samples: int = SAMPLES) -> xr.DataArray:
    """Half the peak-to-peak swing of the signal over one cycle, phases kept, in the unit of ``orders``.

    >>> round(float(swing(xr.DataArray([3.0, 4.0j], coords={"order": [3.0, 6.0]}))), 3)
    6.244
    """
    rest = [dim for dim in orders.dims if dim != "order"]
    values = orders.transpose(*rest, "order")
    phase = np.outer(values.order.values, np.arange(samples * cycles(orders)) * (4 * np.pi / samples))
    flat = values.values.reshape(-1, values.sizes["order"])
    parts = [np.ptp(_synthesized(flat[i : i + 1024], phase), axis=1) for i in range(0, max(len(flat), 1), 1024)]
    half = 0.5 * np.concatenate(parts).reshape([values.sizes[dim] for dim in rest])
    coords = {name: c for name, c in orders.coords.items() if "order" not in c.dims}
    attrs = {**orders.attrs, "amplitude": "half peak-to-peak over the cycle"}
    return xr.DataArray(half, dims=rest, coords=coords, name=orders.name, attrs=attrs)


@checked
def order_sum(orders: xr.DataArray) -> xr.DataArray:
    """Σ_n |X_n|: no signal with these orders swings further; it is a bound and not the swing.

    >>> float(order_sum(xr.DataArray([3.0, 4.0j], coords={"order": [3.0, 6.0]})))
    7.0
    """
    return abs(orders).sum("order").assign_attrs({**orders.attrs, "amplitude": "bound, sum of 0-peak orders"})


@checked
def amplitude(orders: xr.DataArray, order: float) -> xr.DataArray:
    """|X_n| of one order, 0-peak; raises ModelError for an order that was not computed.

    >>> float(amplitude(xr.DataArray([3.0, 4.0j], coords={"order": [3.0, 6.0]}), 6.0))
    4.0
    """
    if float(order) not in orders.order.values:
        known = ", ".join(f"{n:g}" for n in orders.order.values)
        raise ModelError(f"order {order:g} was not computed", where="order", allowed=known)
    return abs(orders.sel(order=float(order))).assign_attrs({**orders.attrs, "amplitude": "0-peak"})


@checked
def irregularity(angle: xr.DataArray) -> xr.DataArray:
    """Cyclic irregularity (ω_max − ω_min)/ω_mean [-] of each node, by its own mean speed.

    A coordinate ``speed_ratio`` (node), as results carry it, gives that speed; without it nodes turn at engine speed.

    >>> theta = xr.DataArray([[2e-3 + 0j]], coords={"speed": [100.0], "order": [3.0]})
    >>> irregularity(theta).values.round(9).tolist()  # 2 n |θ_n| of a single order
    [0.012]
    """
    mean = angle.speed * abs(angle.speed_ratio) if "speed_ratio" in angle.coords else angle.speed
    found = 2 * swing(angular_velocity(angle)) / mean.where(mean > 0)
    return _as(found, "irregularity", amplitude="peak-to-peak over mean")


@checked
def order_share(orders: xr.DataArray, order: float) -> xr.DataArray:
    """Share [-] of one order in the oscillation's mean square, |X_n|² / Σ|X|².

    >>> float(order_share(xr.DataArray([3.0, 4.0j], coords={"order": [3.0, 6.0]}), 6.0))
    0.64
    """
    power = abs(orders) ** 2
    return _as(power.sel(order=float(order)) / power.sum("order"), "energy_share")


@checked
def dominant_element(modes: xr.Dataset) -> xr.DataArray:
    """The connection with the largest share of each mode's elastic energy, by name ("" for rigid rotation).

    >>> share = xr.DataArray([[0.8, 0.2]], coords={"mode": [1], "element": ["dmf", "clutch"]})
    >>> modes = xr.Dataset({"elastic_share": share, "frequency": ("mode", [9.0])})
    >>> dominant_element(modes).values.tolist(), named_modes(modes, {"DMF mode": ("dmf",)})
    (['dmf'], ['DMF mode'])
    """
    share = modes.elastic_share
    axis = share.get_axis_num("element")
    names = share.element.values[share.values.argmax(axis)] if share.sizes["element"] else ""
    return xr.DataArray(np.where(modes.frequency.values > 0, names, ""), dims="mode", coords={"mode": modes.mode})


@checked
def named_modes(modes: xr.Dataset, groups: Mapping[str, Sequence[str]]) -> list[str]:
    """A name for each mode by where its elastic energy is: the group with the largest share, else the connection.

    ``groups``: {"DMF mode": ("dmf",), "clutch mode": ("clutch",)}; a mode is named after a group when the group's share
    is the largest of all connections'.  Of modes of frequency zero, one that moves a single node is that node's alone:
    a pendulum that nothing spins.

    >>> share = xr.DataArray([[0.1, 0.9]], coords={"mode": [1], "element": ["dmf", "clutch"]})
    >>> named_modes(xr.Dataset({"elastic_share": share, "frequency": ("mode", [24.0])}), {"DMF mode": ("dmf",)})
    ['clutch mode']
    """
    dominant = dominant_element(modes).values
    share = modes.elastic_share.transpose("mode", "element").values
    column = {str(name): i for i, name in enumerate(modes.element.values)}
    together = {name: share[:, [column[part] for part in parts]].sum(axis=1) for name, parts in groups.items() if parts}
    names = []
    for mode, element in enumerate(dominant):
        known = [name for name, members in groups.items() if element in members]
        largest = max(together, key=lambda name: together[name][mode], default="")
        if element and largest and together[largest][mode] > share[mode].max():
            known = [largest]
        names.append(known[0] if known else f"{element} mode" if element else _unsprung(modes.isel(mode=mode)))
    return names


def _unsprung(mode: xr.Dataset) -> str:
    """What moves without any spring being twisted: the whole, a part, or one node alone."""
    moved = mode.node.values[mode["shape"].values != 0].tolist() if "shape" in mode else []
    return f"free {moved[0]}" if len(moved) == 1 < mode.sizes["node"] else "rigid rotation"


@checked
def order_speed(frequency: xr.DataArray, order: float) -> xr.DataArray:
    """The engine speed [rad/s] at which an engine order meets a frequency [Hz]: Ω = 2π f/n (20 f rpm for the third).

    >>> order_speed(xr.DataArray([50.0]), 3.0).values.round(3).tolist()  # 1000 rpm
    [104.72]
    """
    return _as(2 * np.pi * frequency / order, "speed")
