"""Pictures of sensitivities and of bands: values as they are, in the units that their labels tell."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from torsional.errors import ModelError
from torsional.plots import plot_bands, plot_sensitivities
from torsional.studies.sweeps import bands, sampled, sensitivities, sweep
from torsional.units import RPM

ENDS = {"stiff": (0.0, 1.0), "light_": (0.0, 3.0), "idle": (0.0, 1.0)}
SPEEDS = np.linspace(600.0, 1200.0, 7) * RPM


def itself(**told: float) -> dict[str, float]:
    """Stands for a model."""
    return told


def answered(told: dict[str, float]) -> xr.Dataset:
    """A figure that follows two parameters, one that follows none, and curves of two orders."""
    size = told["stiff"] + told["light_"]
    curves = np.outer(1.0 + np.arange(7.0), [size, 2.0 * size])
    found = xr.Dataset(
        {
            "order_speed": size * RPM,
            "same": 1.0,
            "curves": (("speed", "order"), curves),
            "gears": ("gear", [size, 1.0]),
        },
        {"speed": ("speed", SPEEDS, {"quantity": "speed"}), "order": [3.0, 6.0], "gear": ["first", "last"]},
    )
    found.order_speed.attrs["quantity"] = "speed"
    found.curves.attrs |= {"quantity": "acceleration", "amplitude": "0-peak"}
    return found


def test_bars_of_shares_of_the_variance() -> None:
    found = sensitivities(sweep(itself, sampled("saltelli", ENDS, 64), answered), ["order_speed", "same", "curves"])
    speed, same, curves = plot_sensitivities(found).axes
    assert [t.get_text() for t in speed.get_yticklabels()] == ["light_", "stiff", "idle"]
    total, alone = speed.containers[1], speed.containers[3]
    here = found.sel(figure="order_speed", parameter=["light_", "stiff", "idle"])
    assert [bar.get_width() for bar in total] == here.total.values.tolist()
    assert [bar.get_width() for bar in alone] == here.first_order.values.tolist()
    assert "95 % interval" in speed.get_xlabel() and speed.get_ylim()[0] > speed.get_ylim()[1]
    assert [t.get_text() for t in same.texts] == ["no parameter moves it"]
    assert curves.get_title("left") == "curves, largest absolute value over speed and order"


def test_the_plane_of_elementary_effects() -> None:
    found = sensitivities(sweep(itself, sampled("morris", ENDS, 6), answered), ["order_speed"])
    (axes,) = plot_sensitivities(found).axes
    assert axes.get_xlabel() == "mean size of effects µ* [rpm], with 95 % interval"
    assert [t.get_text() for t in axes.get_legend().get_texts()] == ["1  light_", "2  stiff", "3  idle", "σ = µ*"]
    places = {t.get_text(): t.xy for t in axes.texts}  # type: ignore[attr-defined]
    assert places["1"][0] == pytest.approx(3.0) and places["2"][0] == pytest.approx(1.0) and places["3"] == (0.0, 0.0)


def test_bands_of_curves_and_of_single_figures() -> None:
    found = sweep(itself, sampled("latin_hypercube", ENDS, 50), answered)
    data = bands(found, answered({"stiff": 0.5, "light_": 1.5, "idle": 0.0}))
    drawn = {axes.get_title("left"): axes for axes in plot_bands(data).axes}
    assert set(drawn) == {"curves, order 3", "curves, order 6", "gears", "order speed", "same"}
    axes = drawn["curves, order 6"]
    assert axes.get_xlabel() == "engine speed [rpm]" and axes.get_ylabel() == "acceleration [rad/s²], 0-peak"
    median, nominal = axes.lines
    assert median.get_xdata() == pytest.approx(SPEEDS / RPM)
    assert median.get_ydata() == pytest.approx(data.curves.sel(percentile=50.0, order=6.0).values)
    assert nominal.get_ydata() == pytest.approx(4.0 * (1.0 + np.arange(7.0)))
    shaded = axes.collections[0].get_paths()[0].vertices[:, 1]
    assert shaded.max() == pytest.approx(float(data.curves.sel(percentile=95.0, order=6.0).max()))
    bars = drawn["order speed"].patches
    assert bars[0].get_y() == pytest.approx(float(data.order_speed.sel(percentile=5.0)) / RPM)
    assert [t.get_text() for t in drawn["gears"].get_xticklabels()] == ["first", "last"]


def test_many_curves_are_chosen_from() -> None:
    curves = np.arange(20.0)[:, None] * np.ones(7)
    data = xr.Dataset(
        {"level": (("percentile", "order", "speed"), np.stack([0.5 * curves, curves, 2.0 * curves]))},
        {"percentile": [5.0, 50.0, 95.0], "order": np.arange(20.0), "speed": SPEEDS},
    )
    data.level.attrs["along"] = "speed"
    assert [axes.get_title("left") for axes in plot_bands(data).axes] == [f"level, order {n}" for n in range(12, 20)]


def test_pictures_of_something_else_are_refused() -> None:
    with pytest.raises(ModelError, match="drawn from their indices"):
        plot_sensitivities(xr.Dataset())
    with pytest.raises(ModelError, match="drawn from percentiles"):
        plot_bands(xr.Dataset())
