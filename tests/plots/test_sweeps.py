"""The picture of a sweep: values in shown units, panels by quantity, limits, ranges, names, what lies beyond."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes

from torsional.errors import ModelError
from torsional.model import Model
from torsional.plots import plot_sweep, save_png, style
from torsional.plots.sweeps import LIMIT
from torsional.studies.swept import Along, Curve, over_gears, over_speed, swept
from torsional.units import RPM

RPMS = np.array([500.0, 1000.0, 2500.0])


def drawn(axes: Axes, gid: str) -> list:
    return [artist for artist in axes.get_children() if artist.get_gid() == gid]


def legend(axes: Axes) -> list[str]:
    return [text.get_text() for text in axes.get_legend().get_texts()] if axes.get_legend() else []


@pytest.fixture
def found(truck: Model) -> xr.Dataset:
    told = {
        "smf": Curve([3.0, 2.0, 1.0], "acceleration", "SMF", "input, acceleration", "0-peak"),
        "dmf": Curve([2.0, np.nan, 0.5], "acceleration", "DMF", "input, acceleration", "0-peak"),
        "share": Curve([0.2, 0.9, 0.8], "energy_share", panel="share", limit=0.5, limit_words="above 50 %"),
    }
    return swept("X", over_speed(RPMS * RPM), told, truck)


def test_curves_and_units(found: xr.Dataset) -> None:
    first, second = plot_sweep(found).axes
    smf, dmf = drawn(first, "curve")
    assert smf.get_xdata() == pytest.approx(RPMS) and smf.get_ydata() == pytest.approx([3.0, 2.0, 1.0])
    assert np.isnan(dmf.get_ydata()[1]) and legend(first)[:2] == ["SMF", "DMF"]
    assert first.get_ylabel().replace("\n", " ") == "input, acceleration [rad/s²], 0-peak"
    assert second.get_ylabel() == "share [%]" and second.get_xlabel() == "engine speed [rpm]"
    assert drawn(second, "curve")[0].get_ydata() == pytest.approx([20.0, 90.0, 80.0])
    assert "share" not in legend(second)  # the axis says it already


def test_a_limit_is_a_line_that_is_named(found: xr.Dataset) -> None:
    first, second = plot_sweep(found).axes
    (limit,) = drawn(second, "limit")
    assert list(limit.get_ydata()) == pytest.approx([50.0, 50.0]) and limit.get_color() == LIMIT
    assert "above 50 %" in legend(second) and not drawn(first, "limit")


def test_limits_of_several_curves_have_their_colours() -> None:
    told = {n: Curve([1.0, 2.0], "ratio", n, limit=at, limit_words=f"{n} limit") for n, at in (("a", 5.0), ("b", 0.1))}
    (axes,) = plot_sweep(swept("X", Along("factor", [1.0, 2.0], "ratio", "factor"), told)).axes
    curves, limits = drawn(axes, "curve"), drawn(axes, "limit")
    assert [line.get_color() for line in limits] == [line.get_color() for line in curves]
    low, high = axes.get_ylim()
    assert low < 0.1 and high > 5.0
    assert axes.get_xlabel() == "factor [-]"


def test_the_operating_range_is_shaded_along_the_speed(found: xr.Dataset, truck: Model) -> None:
    shade = drawn(plot_sweep(found).axes[0], "range")[0]
    assert shade.get_x() == pytest.approx(600.0) and shade.get_width() == pytest.approx(1400.0)
    told = {"order_speed": Curve(np.linspace(400, 700, len(truck.gear_names)) * RPM, "speed", panel="order speed")}
    (axes,) = plot_sweep(swept("X", over_gears(truck), told, truck)).axes
    (shade,) = drawn(axes, "range")
    assert shade.get_y() == pytest.approx(600.0) and "operating range 600–2000 rpm" in legend(axes)
    assert [tick.get_text() for tick in axes.get_xticklabels()] == list(truck.gear_names)


def test_what_is_infinite_lies_beyond_and_is_no_point() -> None:
    told = {"needed": Curve([1.0, np.inf, 2.0], "torque", panel="friction needed")}
    (axes,) = plot_sweep(swept("X", Along("limit", [1.0, 2.0, 3.0], "acceleration", "limit"), told)).axes
    (arrow,) = drawn(axes, "beyond")
    assert list(arrow.get_xdata()) == [2.0]
    assert np.isnan(drawn(axes, "curve")[0].get_ydata()[1])


def test_names_are_bars_and_points_are_marks() -> None:
    told = {"energy": Curve([0.5, 0.25], "energy_share", panel="energy")}
    (axes,) = plot_sweep(swept("X", Along("element", ["a_b", "c"], "", "connection"), told)).axes
    assert [patch.get_height() for patch in axes.patches] == pytest.approx([50.0, 25.0])
    assert [tick.get_text() for tick in axes.get_xticklabels()] == ["a b", "c"]
    marks = {"at": Curve([1.0, np.nan], "ratio", points=True)}
    (axes,) = plot_sweep(swept("X", Along("factor", [1.0, 2.0], "ratio"), marks)).axes
    assert drawn(axes, "curve")[0].get_linestyle() == "None"


def test_logarithmic_axes_and_the_inverse() -> None:
    told = {"error": Curve([1e-3, 1e-1], "ratio", panel="error", scale="log")}
    along = Along("step", [1e-4, 1e-3], "time", "step", "log")
    (axes,) = plot_sweep(swept("X", along, told)).axes
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    inverse = Along("r", [0.5, 0.8], "ratio", "r", inverse="1/r")
    figure = plot_sweep(swept("X", inverse, {"error": Curve([1.0, 2.0], "ratio")}))
    assert save_png(figure).startswith(b"\x89PNG")
    (upper,) = figure.axes[0].child_axes
    assert upper.get_xlabel() == "1/r [-]" and list(upper.get_xticks()) == pytest.approx([2.0, 1.25])


def test_what_is_no_sweep_is_refused() -> None:
    with pytest.raises(ModelError, match="one dimension"):
        plot_sweep(xr.Dataset({"a": (("x", "y"), np.zeros((2, 2)))}))


def test_points_bear_the_colour_of_their_curve_and_are_named_once() -> None:
    told = {name: Curve([1.0, 2.0, 3.0], "ratio", name) for name in "ab"}
    told |= {f"{n}_at": Curve([np.nan, 2.1, np.nan], "ratio", "in time", points=True, like=n) for n in "ba"}
    (axes,) = plot_sweep(swept("X", Along("factor", [1.0, 2.0, 3.0], "ratio", "factor"), told)).axes
    a, b, b_at, a_at = drawn(axes, "curve")
    assert (a_at.get_color(), b_at.get_color()) == (a.get_color(), b.get_color()) and a.get_color() != b.get_color()
    assert legend(axes) == ["a", "b", "in time"]
    assert axes.get_legend().legend_handles[2].get_color() == style.INK
