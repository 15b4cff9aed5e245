"""A measured run-up as pictures, and as a page: speed, orders, and spectra of every shaft and signal."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.errors import ModelError
from torsional.measurements.orders import torsional_angle, track_orders
from torsional.measurements.spectrograms import speed_spectrogram
from torsional.plots import panels, plot_rotation, plot_spectrogram, plot_tracked_orders, plot_waterfall
from torsional.plots.style import figure_of
from torsional.plots.tracking import WORDS, Convention
from torsional.quantities import acceleration, angular_velocity
from torsional.report.blocks import Block, Section, Text, picture
from torsional.report.page import html_page
from torsional.units import QUANTITIES

MOST_ORDERS = 200
TURN = 2 * np.pi
POWERS = {"angle": 0, "velocity": 1, "acceleration": 2}
"""By which power of nΩ angles are multiplied."""


@dataclass(frozen=True, eq=False)
class Place:
    """A shaft or a signal: its name, a title, its ``orders`` (speed, order) and their ``noise``, 0-peak, alike."""

    name: str
    title: str
    orders: xr.DataArray
    noise: xr.DataArray | None = None


@dataclass(frozen=True, eq=False)
class RunUp:
    """A run-up by its ``source``: mean rotation, shafts and signals, the orders found in them, how they are told."""

    source: str
    rotation: xr.Dataset
    shafts: Mapping[str, xr.Dataset]
    signals: xr.Dataset
    found: xr.Dataset
    convention: Convention
    shown_as: str
    settings: Mapping[str, Any]

    def places(self, fine: bool = False) -> list[Place]:
        """Shafts and signals with the orders asked for, or with all those the windows tell apart."""
        data = self.spectra if fine else self.found
        shafts = [self._shaft(data, name) for name in self.shafts]
        names = [str(name) for name in data.data_vars if "node" not in data[name].dims]
        return shafts + [Place(name, name, data[name]) for name in names]

    def _shaft(self, data: xr.Dataset, name: str) -> Place:
        angle, noise = data.angle.sel(node=name, drop=True), data.noise.sel(node=name, drop=True)
        turn: Callable[[xr.DataArray], xr.DataArray] | None
        turn = {"angle": None, "velocity": angular_velocity, "acceleration": acceleration}[self.shown_as]
        values = angle if turn is None else turn(angle)
        power = POWERS[self.shown_as]
        floor = (noise * (data.order * data.speed) ** power).transpose("speed", "order")
        return Place(name, f"{name}, {WORDS[str(values.attrs['quantity'])]} [{_unit(values)}]", values, floor)

    @cached_property
    def spectra(self) -> xr.Dataset:
        """Every order up to the highest asked for that the windows tell apart."""
        step = 0.5 / self.settings["cycles"]
        highest = float(self.found.order.max())
        step *= int(np.ceil(highest / step / MOST_ORDERS))
        order = step * np.arange(1, int(highest / step * (1 + 1e-9)) + 1)
        return track_orders(self.signals, self.rotation, order, shafts=self.shafts, **self.settings)

    def frequencies(self) -> dict[str, xr.DataArray]:
        """Spectra over frequency of shafts and signals, as finely as windows of a cycle's length at the mean speed."""
        highest = float(self.found.order.max()) * float(self.rotation.speed.max()) / TURN
        line = float(self.rotation.speed.mean()) / TURN / self.settings["cycles"]
        each = {name: torsional_angle(shaft, self.rotation) for name, shaft in self.shafts.items()}
        each |= {str(name): self.signals[name] for name in self.signals.data_vars}
        return {
            name: speed_spectrogram(signal, self.rotation, line, highest=highest).spectrum
            for name, signal in each.items()
            if signal.ndim == 1
        }


def _unit(values: xr.DataArray) -> str:
    return QUANTITIES[str(values.attrs["quantity"])].shown


def draw_orders(run_up: RunUp) -> Figure:
    """Order cuts of every shaft and signal, below each other."""
    places = run_up.places()
    drawn = panels(len(places), 1, (7.4, 3.0))
    for axes, place in zip(drawn, places, strict=True):
        _cuts(run_up, place, axes)
    return figure_of(drawn[0])


def _cuts(run_up: RunUp, place: Place, axes: Axes | None = None) -> Figure:
    settings: Any = {"convention": run_up.convention, "title": place.name, "axes": axes, "phases": axes is None}
    return plot_tracked_orders(place.orders, place.noise, **settings)


def _map(run_up: RunUp, place: Place, axes: Axes | None = None) -> Figure:
    return plot_spectrogram(place.orders, convention=run_up.convention, title=place.name, axes=axes)


def _lines(run_up: RunUp, place: Place, axes: Axes | None = None) -> Figure:
    return plot_waterfall(place.orders, convention=run_up.convention, title=place.name, axes=axes)


def draw_map(run_up: RunUp) -> Figure:
    """Sizes over order and speed of every shaft and signal."""
    return _together(run_up, _map, 3.6)


def draw_waterfall(run_up: RunUp) -> Figure:
    """Spectra over order, stacked by speed, of every shaft and signal."""
    return _together(run_up, _lines, 5.0)


def _together(run_up: RunUp, draw: Callable[[RunUp, Place, Axes], Figure], height: float) -> Figure:
    places = run_up.places(fine=True)
    drawn = panels(len(places), 1, (7.4, height))
    for axes, place in zip(drawn, places, strict=True):
        draw(run_up, place, axes)
    return figure_of(drawn[0])


def draw_frequencies(run_up: RunUp) -> Figure:
    """Sizes over frequency and speed of every shaft and signal, with lines of the orders asked for."""
    spectra = run_up.frequencies()
    drawn = panels(len(spectra), 1, (7.4, 3.6))
    for axes, (name, values) in zip(drawn, spectra.items(), strict=True):
        plot_spectrogram(values, convention=run_up.convention, orders=_few(run_up), title=name, axes=axes)
    return figure_of(drawn[0])


def _few(run_up: RunUp) -> list[float]:
    orders = run_up.found.order.values.tolist()
    return orders if len(orders) <= 8 else [n for n in orders if n % 3 == 0]


def draw_speed(run_up: RunUp) -> Figure:
    """Speed of every shaft over time, with the pulses that were mended."""
    drawn = panels(len(run_up.shafts), 1, (8.4, 3.2))
    for axes, shaft in zip(drawn, run_up.shafts.values(), strict=True):
        plot_rotation(shaft, run_up.rotation, axes=axes)
    return figure_of(drawn[0])


PICTURES: Mapping[str, Callable[[RunUp], Figure]] = {
    "orders": draw_orders,
    "map": draw_map,
    "waterfall": draw_waterfall,
    "frequencies": draw_frequencies,
    "speed": draw_speed,
}
"""The pictures of a run-up by name."""


def write_run_up(run_up: RunUp, path: Path) -> Path:
    """Write one self-contained HTML page about a run-up."""
    parts = [_speeds(run_up), _orders(run_up), _maps(run_up), _frequencies(run_up)]
    page = html_page(run_up.source, "orders of a measurement", f"Orders of {run_up.source}", parts, [])
    path.write_text(page, encoding="utf-8")
    return path


def _speeds(run_up: RunUp) -> Section:
    drawn = picture(draw_speed(run_up), "Speed over time, from tooth to tooth and on the mean.", "Speed over time.")
    return Section("speed", "The shafts", (drawn,))


def _orders(run_up: RunUp) -> Section:
    window, cycles = run_up.settings["window"], run_up.settings["cycles"]
    shape = "weighed by Hann's window" if window == "hann" else "all of it weighing alike"
    words = f"Windows of {cycles} cycles of 720°, {shape}; amplitudes are {run_up.convention}."
    drawn: list[Block] = [Text(words)]
    for place in run_up.places():
        told = f"{place.title}: orders over speed, and their phases."
        drawn.append(picture(_cuts(run_up, place), told, f"Orders of {place.name} over speed."))
    return Section("orders", "Orders over speed", tuple(drawn))


def _maps(run_up: RunUp) -> Section:
    drawn: list[Block] = []
    for place in run_up.places(fine=True):
        for draw, what in ((_map, "in colours"), (_lines, "one spectrum above the other")):
            told = f"{place.title}: over order and speed, {what}."
            drawn.append(picture(draw(run_up, place), told, f"{place.name} over order and speed."))
    return Section("spectra", "Spectra over order", tuple(drawn))


def _frequencies(run_up: RunUp) -> Section:
    title = "Spectra over frequency"
    try:
        drawn = picture(draw_frequencies(run_up), "Over frequency and speed, with lines of orders.", "Spectra.")
    except ModelError as error:
        return Section("frequencies", title, (Text(f"None: {error}.", "note"),))
    return Section("frequencies", title, (drawn,))
