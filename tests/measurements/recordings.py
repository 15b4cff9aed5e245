"""Recordings to write and read: two rasters, events, a gap, names as measuring systems have them."""

from __future__ import annotations

import numpy as np
import xarray as xr

from torsional.measurements.recording import Channel, Found, Raster, pulses, recording

START = "2026-11-23T05:42:11.250000"


def rig() -> xr.Dataset:
    """Speed and torque at 2 kHz, a temperature at uneven times, pulses of a tacho."""
    noise = np.random.default_rng(4)
    fast = Raster(np.arange(400) / 2000.0)
    slow = Raster(np.cumsum(noise.uniform(0.01, 0.02, 9)))
    speed = 1500.0 + 3.0 * np.sin(2 * np.pi * 75.0 * fast.values) + 0.01 * noise.normal(size=400)
    torque = 400.0 * noise.normal(size=400)
    torque[7] = np.nan
    channels = [
        Channel("n_mot", speed, fast, "1/min", "engine", "crank, 60-2 teeth"),
        Channel("M_gbx µ²", torque, fast, "Nm", "gearbox"),
        Channel("T oil", 90.0 + noise.normal(size=9), slow, "°C", "engine"),
        pulses("tacho", np.cumsum(noise.uniform(0.001, 0.002, 50)), "tacho"),
    ]
    return recording(Found(channels, "made", START), "rig")
