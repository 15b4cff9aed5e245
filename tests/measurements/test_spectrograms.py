"""Spectra over frequency along a run-up."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from tests.measurements.run_ups import RPM, RunUp

import torsional as tv

RUN = RunUp(600 * RPM, 50 * RPM, 10.0)
ROTATION = tv.mean_rotation(tv.shaft_from_pulses(RUN.pulses(60), 60))


def test_a_tone_keeps_its_frequency_and_an_order_follows_the_speed() -> None:
    time = np.arange(0.0, 10.0, 1e-3)
    values = 3.0 + 0.5 * np.cos(2 * np.pi * 120.0 * time) + 2.0 * np.cos(3 * RUN.crank_angle(time))
    found = tv.speed_spectrogram(
        xr.DataArray(values, {"time": time}, attrs={"units": "Nm"}), ROTATION, 4.0, highest=200
    )
    assert found.spectrum.sel(spectrum_frequency=120.0).values[:80] == pytest.approx(0.5, abs=0.01)
    order = found.spectrum.where(found.spectrum_frequency < 90)
    peak = order.spectrum_frequency.values[order.fillna(0.0).values[:80].argmax(axis=1)]
    assert peak == pytest.approx(3 * found.speed.values[:80] / (2 * np.pi), abs=4.0)
    assert float(order.max()) == pytest.approx(2.0, rel=0.15)
    assert found.spectrum.attrs["units"] == "Nm" and found.attrs["window"] == "hann"
    assert float(found.spectrum_frequency.max()) == 200.0


def test_teeth_are_no_even_raster() -> None:
    run = RunUp(600 * RPM, 50 * RPM, 10.0, {3.0: 4e-3 + 0j})
    shaft = tv.shaft_from_pulses(run.pulses(60), 60)
    rotation = tv.mean_rotation(shaft)
    found = tv.speed_spectrogram(tv.torsional_angle(shaft, rotation), rotation, 4.0, highest=100)
    assert float(found.spectrum.max()) == pytest.approx(4e-3, rel=0.05)


def test_refusals() -> None:
    time = np.arange(0.0, 10.0, 1e-3)
    with pytest.raises(tv.ModelError, match=r"resolution: no such window; found 0.01 Hz; allowed: 0.1\d* to 62.5 Hz"):
        tv.speed_spectrogram(xr.DataArray(time, {"time": time}), ROTATION, 0.01)
