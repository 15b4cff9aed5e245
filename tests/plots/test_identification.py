"""Pictures of loops on a rig show the values of their data."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from torsional.plots.identification import plot_identified, plot_rig_friction
from torsional.plots.style import save_png
from torsional.results import labelled

PART = (np.arange(40) + 0.5) / 40


@pytest.fixture
def loops() -> xr.Dataset:
    """Two speeds, two sweeps, each slowly and fast, at one mean torque."""
    speed, sweep, pace = (grid.ravel() for grid in np.meshgrid([0.0, 100.0], [0.02, 0.1], [1.0, 20.0], indexing="ij"))
    angle = sweep[:, None] * np.sin(2 * np.pi * PART)
    torque = 1e3 * angle + 5.0 * np.cos(2 * np.pi * PART)
    over = ("loop", "part")
    values = {"angle": (over, angle, "relative_angle"), "measured": (over, torque + 1.0, "torque")}
    values |= {"fitted": (over, torque, "torque"), "coulomb": (over, 0.99 * torque, "torque")}
    values |= {f"{name}_misfit": (("loop",), miss, "ratio") for name, miss in (("fitted", pace**0), ("coulomb", pace))}
    values |= {name: (("parameter",), [0.01, 0.02], "ratio") for name in ("miss", "deviation")}
    grid = ("rotation", "swing", "pace")
    values |= {
        name: (grid, np.full((2, 2, 2), share), "energy_share") for name, share in (("unloaded", 0.6), ("loaded", 0.2))
    }
    axes = {"speed": (speed, "speed", "loop"), "sweep": (sweep, "relative_angle", "loop")}
    axes |= {"mean_torque": (0.0 * speed, "torque", "loop"), "frequency": (pace, "frequency", "loop")}
    axes |= {
        "rotation": ([0.0, 100.0], "speed"),
        "swing": ([0.02, 0.1], "relative_angle"),
        "pace": ([1.0, 20.0], "frequency"),
    }
    axes |= {"part": (PART, "ratio"), "parameter": (["spring.rate", "own"], "")}
    return labelled(values, axes, analysis="loops on a rig", load=1200.0)


def test_loops_by_speed_and_what_is_missed(loops: xr.Dataset) -> None:
    figure = plot_identified(loops)
    assert len(figure.axes) == 3 and save_png(figure)
    for axes, speed in zip(figure.axes, (0.0, 100.0), strict=False):
        drawn = [line for line in axes.lines if line.get_gid() == "fitted"]
        assert len(drawn) == 4 and axes.get_title(loc="left").startswith(f"{speed * 30 / np.pi:.0f} rpm")
        x, y = (np.asarray(values) for values in drawn[-1].get_data())
        assert (x[0], y[0]) == (x[-1], y[-1]) and np.ptp(x) == pytest.approx(np.degrees(0.2), rel=0.01)
    labels = [text.get_text() for text in figure.axes[-1].get_xticklabels()]
    assert labels == ["spring rate", "own"]


def test_friction_slowly_and_fast(loops: xr.Dataset) -> None:
    figure = plot_rig_friction(loops)
    slow, fast, misfits, shares = figure.axes
    assert "1 Hz" in slow.get_title(loc="left") and "20 Hz" in fast.get_title(loc="left") and save_png(figure)
    (line,) = (line for line in fast.lines if line.get_gid() == "fitted")
    assert np.abs(np.asarray(line.get_ydata())).max() == pytest.approx(5.0, rel=0.02)  # the straight line is gone
    heights = [bar.get_height() for bar in misfits.patches if bar.get_gid() == "coulomb"]
    assert heights == loops.frequency.values.tolist()
    assert [np.asarray(line.get_ydata()).tolist() for line in shares.lines[:2]] == [[60.0, 60.0], [20.0, 20.0]]
