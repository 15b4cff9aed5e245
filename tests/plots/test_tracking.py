"""Pictures of measured run-ups show the values of their data."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from tests.measurements.run_ups import RPM, RunUp

import torsional as tv
from torsional import plots

RUN = RunUp(600 * RPM, 200 * RPM, 6.0, {1.5: 2e-3 * np.exp(0.4j), 3.0: 8e-3 + 0j})


@pytest.fixture(scope="module")
def shaft() -> xr.Dataset:
    times = np.delete(np.round(RUN.pulses(60) / 2e-6) * 2e-6, [700, 1900])
    spoilt = np.sort(np.append(times, times[1200] + 0.4 * (times[1201] - times[1200])))
    return tv.shaft_from_pulses(spoilt, 60, name="crank_$1$")


@pytest.fixture(scope="module")
def rotation(shaft: xr.Dataset) -> xr.Dataset:
    return tv.mean_rotation(shaft)


@pytest.fixture(scope="module")
def found(shaft: xr.Dataset, rotation: xr.Dataset) -> xr.Dataset:
    time = np.arange(0.0, 6.0, 1 / 2000)
    torque = 120 * np.cos(3 * RUN.crank_angle(time))
    signal = xr.DataArray(torque, {"time": time}, name="M", attrs={"units": "Nm", "long_name": "torque at the hub"})
    return tv.track_orders(signal, rotation, np.arange(0.5, 6.1, 0.5), shafts={"crank": shaft})


def test_speed_with_what_was_mended(shaft: xr.Dataset, rotation: xr.Dataset) -> None:
    (axes,) = plots.plot_rotation(shaft, rotation).axes
    marked = {line.get_gid(): line for line in axes.lines}
    assert marked["lost"].get_label() == "2 pulses lost"
    assert np.asarray(marked["too many"].get_xdata()) == pytest.approx(shaft.extra_pulse.values)
    assert np.asarray(marked["mean"].get_ydata()) * RPM == pytest.approx(rotation.speed.values)
    assert axes.get_title("left") == r"crank_\$1\$"
    floor = float(np.median(2 * shaft.speed_noise)) / RPM
    assert f"± 2 σ of the clock ({floor:.2g} rpm)" in [text.get_text() for text in axes.get_legend().get_texts()]


@pytest.mark.parametrize(("convention", "share"), [("0-peak", 1.0), ("RMS", np.sqrt(0.5)), ("peak-to-peak", 2.0)])
def test_order_cuts_name_their_convention_and_stand_on_the_noise(
    found: xr.Dataset, convention: plots.tracking.Convention, share: float
) -> None:
    orders, noise = found.angle.sel(node="crank", order=[1.5, 3.0]), found.noise.sel(node="crank")
    sizes, phases = plots.plot_tracked_orders(orders, noise, convention=convention, phases=True).axes
    cuts = [line for line in sizes.lines if line.get_gid() == "cut"]
    assert np.radians(cuts[1].get_ydata()) == pytest.approx(share * abs(orders.sel(order=3.0)).values)
    assert sizes.get_ylabel() == f"torsional angle [deg], {convention}"
    (floor,) = [each for each in sizes.collections if each.get_gid() == "floor"]
    top = floor.get_paths()[0].vertices[:, 1].max()
    assert np.radians(top) == pytest.approx(share * float(noise.max()))
    assert np.radians(phases.lines[0].get_ydata()) == pytest.approx(np.angle(orders.sel(order=1.5).values))


def test_a_channel_is_told_by_its_own_name_and_unit(found: xr.Dataset) -> None:
    (axes,) = plots.plot_tracked_orders(found.M.sel(order=[3.0]), convention="RMS").axes
    assert axes.get_ylabel() == "torque at the hub [Nm], RMS"
    assert np.asarray(axes.lines[0].get_ydata()) == pytest.approx(120 / np.sqrt(2), rel=1e-3)


def test_colours_over_order_and_speed(found: xr.Dataset) -> None:
    axes = plots.plot_spectrogram(found.M).axes[0]
    (mesh,) = axes.collections
    assert np.nanmax(mesh.get_array()) == pytest.approx(120.0, rel=1e-3)
    assert axes.get_xlabel() == "engine order"
    peak = np.asarray(mesh.get_array()).argmax(axis=1)
    assert (found.order.values[peak] == 3.0).all()


def test_colours_over_frequency_with_lines_of_orders(found: xr.Dataset, rotation: xr.Dataset) -> None:
    time = np.arange(0.0, 6.0, 1 / 2000)
    tone = xr.DataArray(np.sin(2 * np.pi * 80 * time), {"time": time}, name="a", attrs={"units": "g"})
    spectra = tv.speed_spectrogram(tone, rotation, 4.0, highest=200.0).spectrum
    axes = plots.plot_spectrogram(spectra, orders=[3.0]).axes[0]
    (line,) = [line for line in axes.lines if line.get_gid() == "order"]
    assert np.asarray(line.get_xdata()) == pytest.approx(3.0 * np.asarray(line.get_ydata()) / 60)
    assert axes.get_xlabel() == "frequency [Hz]"
    assert [text.get_text() for text in axes.texts] == ["3"]


def test_a_steady_record_is_drawn_over_time() -> None:
    steady = RunUp(900 * RPM, 0.0, 5.0, {3.0: 5e-3 + 0j})
    shaft = tv.shaft_from_pulses(steady.pulses(60), 60)
    found = tv.track_orders(None, tv.mean_rotation(shaft), [1.5, 3.0, 4.5], shafts={"c": shaft})
    assert plots.plot_spectrogram(found.angle.sel(node="c")).axes[0].get_ylabel() == "time [s]"
    assert plots.plot_waterfall(found.angle.sel(node="c")).axes[0].get_ylabel() == "time [s]"


def test_a_waterfall_has_a_line_for_each_spectrum_and_says_how_high(found: xr.Dataset) -> None:
    axes = plots.plot_waterfall(found.M).axes[0]
    lines = [line for line in axes.lines if line.get_gid() == "spectrum"]
    assert len(lines) == min(40, found.sizes["speed"])
    assert [text.get_text() for text in axes.texts] == ["100 of torque at the hub [Nm], 0-peak"]
    bar = next(line for line in axes.lines if line.get_gid() is None)
    size = np.ptp(np.asarray(bar.get_ydata())) / 100
    high = max(np.ptp(np.asarray(line.get_ydata())) for line in lines)
    assert high / size == pytest.approx(120.0, rel=2e-3)
