"""Pictures of fits and of orders beside each other show the values of their data."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from torsional.plots.correlation import plot_correlation
from torsional.plots.fit import plot_certainty, plot_fits, plot_residuals
from torsional.plots.style import save_png
from torsional.results import labelled
from torsional.studies.correlation import correlation
from torsional.studies.order_curves import curves


@pytest.fixture
def fits() -> xr.Dataset:
    """Fourteen points of eight samples, two models, two parameters; one point held back."""
    points, samples = 14, 8
    axis = np.tile(np.linspace(60.0, 120.0, samples), points)
    seen = np.arange(points * samples, dtype=float)
    names = np.array(["clutch.stiffness", "clutch.damping"])
    step = ("parameter", "step")
    values = {
        "estimate": (("parameter",), [2.0, 0.0], ""),
        "deviation": (("parameter",), [0.1, 0.2], ""),
        "interval_low": (("parameter",), [1.8, -0.4], ""),
        "interval_high": (("parameter",), [2.2, 0.4], ""),
        "correlation": (("parameter", "other"), [[1.0, -0.8], [-0.8, 1.0]], "number"),
        "point_misfit": (("model", "point"), np.ones((2, points)), "ratio"),
        "measured": (("sample",), seen, ""),
        "fitted": (("model", "sample"), np.array([seen + 1.0, seen + 2.0]), ""),
        "noise": (("point",), np.full(points, 0.5), ""),
        "profile_value": (step, np.array([[1.9, 2.0, 2.1], [-0.2, 0.0, 0.2]]), ""),
        "profile_rise": (step, np.array([[1.0, 0.0, 1.0], [1.0, 0.0, 1.0]]), "number"),
    }
    axes = {
        "parameter": (names, ""),
        "other": (names, ""),
        "model": (np.array(["own", "other"]), ""),
        "point": (np.array([f"order {n}" for n in range(points)]), ""),
        "held": (np.array([1] + [0] * (points - 1)), "", "point"),
        "axis": (axis, "", "sample"),
        "sample_point": (np.repeat(np.arange(points), samples), "", "sample"),
        "along": (np.array(["speed"] * points), "", "point"),
        "quantity": (np.array(["acceleration"] * points), "", "point"),
    }
    return labelled(values, axes, analysis="identification", level=0.95)  # type: ignore[arg-type]


def test_twelve_points_with_what_was_held_back(fits: xr.Dataset) -> None:
    figure = plot_fits(fits)
    assert len(figure.axes) == 12 and "(held back)" in figure.axes[0].get_title(loc="left")
    drawn = {line.get_gid(): line for line in figure.axes[0].lines}
    assert np.asarray(drawn["measured"].get_ydata()).tolist() == list(range(8))
    assert np.asarray(drawn["fitted"].get_ydata()).tolist() == [n + 2.0 for n in range(8)]  # the last model drawn
    assert np.asarray(drawn["measured"].get_xdata())[0] == pytest.approx(60.0 * 30 / np.pi)
    assert save_png(figure).startswith(b"\x89PNG")


def test_residuals_over_the_noise(fits: xr.Dataset) -> None:
    left, right = plot_residuals(fits).axes
    assert np.asarray(left.lines[0].get_ydata()) == pytest.approx(-2.0)
    assert len([bar for bar in right.patches if bar.get_gid() == "misfit"]) == 28


def test_intervals_correlations_and_profiles(fits: xr.Dataset) -> None:
    matrix, widths, profiles = plot_certainty(fits).axes
    assert np.asarray(matrix.images[0].get_array()).tolist() == [[1.0, -0.8], [-0.8, 1.0]]
    assert [text.get_text() for text in widths.texts] == [" 10 %", " not told by the data"]
    drawn = [line for line in profiles.lines if line.get_gid() == "profile"]
    assert np.asarray(drawn[0].get_xdata()) == pytest.approx([-1.0, 0.0, 1.0])
    assert np.asarray(drawn[0].get_ydata()) == pytest.approx([-1.0, 0.0, 1.0])
    alone = plot_certainty(fits.drop_vars(["profile_value", "profile_rise"]))
    assert len(alone.axes) == 2


def test_orders_measured_and_computed() -> None:
    speed = np.linspace(60.0, 120.0, 7)
    m = curves(np.arange(14.0).reshape(2, 7), np.array([3.0, 6.0]), speed, "acceleration")
    figure = plot_correlation(correlation(m, 1.5 * m))
    panel = {line.get_gid(): np.asarray(line.get_ydata()) for line in figure.axes[1].lines}
    assert panel["computed"] == pytest.approx(1.5 * panel["measured"]) and panel["measured"][0] == 7.0
    assert figure.axes[0].get_title(loc="left").startswith("order 3: FRAC 1.00")
