"""Every picture shows the values of its data, in the units its labels tell."""

from __future__ import annotations

from xml.etree import ElementTree

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from tests.shipped import shipped

from torsional import plots
from torsional.errors import ModelError
from torsional.laws import Hinges
from torsional.model import Model
from torsional.plots.maps import colour_limits
from torsional.quantities import order_sum, swing
from torsional.solvers.map import response_map
from torsional.solvers.modal import modal
from torsional.solvers.operating import at_operating_point
from torsional.units import RPM


def texts(figure: Figure) -> str:
    return " | ".join(t.get_text() for t in figure.findobj(mpl.text.Text))  # type: ignore[attr-defined]


def lines(figure: Figure, gid: str) -> list[mpl.lines.Line2D]:
    return [line for line in figure.axes[0].lines if line.get_gid() == gid]


def test_campbell(interference: xr.Dataset, names: dict[str, list[str]]) -> None:
    figure = plots.plot_campbell(interference, names, speed=(600 * RPM, 2000 * RPM), idle=600 * RPM)
    axes = figure.axes[0]
    assert axes.get_xlabel() == "engine speed [rpm]"
    assert axes.get_ylabel() == "natural frequency [Hz]"
    third = lines(figure, "order")[0]
    assert third.get_ydata()[1] / third.get_xdata()[1] == pytest.approx(3 / 60)  # type: ignore[index]
    below = interference.frequency.values[:, 0, 1:]
    assert len(lines(figure, "mode")) == int((below < 1.1 * 125.0).sum())
    (circles,) = [line for line in axes.lines if "meets a mode" in str(line.get_label())]
    met = interference.crossing.sel(order=3.0).values / RPM
    inside = np.sort(met[(met > 600) & (met < 2000)])
    assert np.sort(circles.get_xdata()) == pytest.approx(inside)
    assert "clutch mode" in texts(figure)


def test_resonance_speeds(interference: xr.Dataset, names: dict[str, list[str]]) -> None:
    axes = plots.plot_resonance_speeds(interference, names).axes[0]
    (clutch,) = [line for line in axes.lines if line.get_label() == "clutch mode"]
    expected = interference.crossing.isel(mode=4).sel(order=3.0).values / RPM
    assert clutch.get_xdata() == pytest.approx(expected)
    assert [t.get_text() for t in axes.get_yticklabels()] == ["gear 8", "gear 12"]
    assert "order 3" in axes.get_xlabel()


def test_mode_shapes_are_referred_to_engine_speed(truck: Model) -> None:
    modes = modal(at_operating_point(truck, 2500.0, "8")[0])
    figure = plots.plot_mode_shapes(modes, truck.powertrain("8"), chosen=[4])
    (line,) = [line for line in figure.axes[0].lines if "Hz" in str(line.get_label())]
    ticks = [t.get_text() for t in figure.axes[0].get_xticklabels()]
    drawn = dict(zip(ticks, line.get_ydata(), strict=True))  # type: ignore[arg-type]
    assert drawn["gearbox mesh"] == pytest.approx(drawn["gearbox output"], rel=1e-9)
    shape = modes["shape"].sel(mode=4)
    ratio = float(shape.sel(node="clutch_disc") / shape.sel(node="gearbox_input"))
    assert drawn["clutch disc"] / drawn["gearbox input"] == pytest.approx(ratio)
    assert max(np.abs(line.get_ydata())) == pytest.approx(1.0)  # type: ignore[arg-type]


def test_energy_shares_fill_the_bars(interference: xr.Dataset) -> None:
    axes = plots.plot_energy_shares(interference.sel(gear="12").isel(speed=0), chosen=[3, 4]).axes[0]
    right = [max(p.get_x() + p.get_width() for p in axes.patches if abs(p.get_y() + 0.4 - row) < 0.1) for row in (0, 1)]  # type: ignore[attr-defined]
    assert right == pytest.approx([100.0, 100.0])
    assert axes.get_xlabel() == "share of the mode's elastic energy [%]"
    dmf = axes.containers[[c.get_label() for c in axes.containers].index("dmf")]
    assert dmf[0].get_width() == pytest.approx(63.0, abs=1.0)  # the prototype's share of the absorber mode


def test_gears(orders: xr.DataArray) -> None:
    figure = plots.plot_gears(orders, 3.0, idle=600 * RPM)
    assert figure.axes[0].get_ylabel() == "order 3, acceleration [rad/s²], 0-peak"
    for line, gear in zip(lines(figure, "cut"), ["8", "12"], strict=True):
        assert line.get_ydata() == pytest.approx(np.abs(orders.sel(gear=gear, order=3.0).values))
        assert line.get_xdata() == pytest.approx(orders.speed.values / RPM)


def test_order_cuts_have_a_line_for_each_variant_and_order(orders: xr.DataArray) -> None:
    axes = plots.plot_order_cuts({"_one $x$": orders, "two": 2 * orders}, "12", [3.0, 1.5]).axes[0]
    assert len(axes.lines) == 4
    assert axes.lines[2].get_ydata() == pytest.approx(2 * np.asarray(axes.lines[0].get_ydata()))
    assert len(axes.get_legend().texts) == 4  # type: ignore[union-attr]
    assert axes.get_ylabel() == "acceleration [rad/s²], 0-peak"


def test_order_lines_tell_which_dimension_is_too_much(orders: xr.DataArray) -> None:
    one = orders.expand_dims(mean_torque=[1500.0])
    line = plots.plot_gears(one, 3.0).axes[0].lines[0]
    assert np.array_equal(line.get_ydata(), plots.plot_gears(orders, 3.0).axes[0].lines[0].get_ydata())
    two = orders.expand_dims(mean_torque=[1500.0, 2000.0])
    for picture in (lambda: plots.plot_gears(two, 3.0), lambda: plots.plot_order_cuts({"a": two}, "12", [3.0])):
        with pytest.raises(ModelError, match=r"2 values of 'mean_torque' as well; choose one: \.sel\(mean_torque=…\)"):
            picture()
    with pytest.raises(ModelError, match="order 4 was not computed"):
        plots.plot_gears(orders, 4.0)
    with pytest.raises(ModelError, match="no dimension 'gear'"):
        plots.plot_gears(orders.isel(gear=0), 3.0)


def test_cycle_lies_between_the_bounds(orders: xr.DataArray) -> None:
    here = orders.sel(gear="12").isel(speed=2)
    axes = plots.plot_cycle(here, shown=[3.0]).axes[0]
    signal = np.asarray(next(line for line in axes.lines if "half" in str(line.get_label())).get_ydata())
    assert 0.5 * np.ptp(signal) == pytest.approx(float(swing(here)), rel=1e-6)
    most = float(order_sum(here))
    assert np.abs(signal).max() <= most
    assert any(np.allclose(line.get_ydata(), most) for line in axes.lines)  # type: ignore[arg-type]
    assert axes.get_xlim() == (0, 720)


@pytest.fixture(scope="module")
def grid(truck: Model) -> xr.Dataset:
    return response_map(truck, truck.speeds(8), truck.torques(6), ["12"], [1.5, 3.0])


def amplitude(grid: xr.Dataset) -> xr.DataArray:
    size = abs(grid.angle.sel(gear="12", node="gearbox_input", order=3.0)) * (3.0 * grid.speed) ** 2
    told = {"quantity": "acceleration", "amplitude": "half peak-to-peak over the cycle"}
    return size.assign_attrs(told)


def test_map(grid: xr.Dataset) -> None:
    size = amplitude(grid)
    figure = plots.plot_map(size, within=grid.within_full_load, title="the <first> $variant")
    axes = figure.axes[0]
    drawn = np.ma.filled(axes.collections[0].get_array()).reshape(6, 8)
    assert drawn == pytest.approx(size.transpose("mean_torque", "speed").values)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("engine speed [rpm]", "mean engine torque [Nm]")
    assert "acceleration [rad/s²], half peak-to-peak" in texts(figure)
    assert axes.get_ylim() == (0.0, 2500.0)


def test_map_draws_full_load_and_hatches_above(grid: xr.Dataset, truck: Model) -> None:
    speeds = truck.speeds(30)
    assert truck.engine is not None
    told = {"quantity": "torque"}
    curve = xr.DataArray(truck.engine.full_load_torque(speeds), {"speed": speeds}, "speed", attrs=told)
    curve.speed.attrs["quantity"] = "speed"
    figure = plots.plot_ratio_map(amplitude(grid) / 2.0, within=grid.within_full_load, full_load=curve)
    (line,) = lines(figure, "full-load")
    assert line.get_ydata() == pytest.approx(curve.values)
    assert any(c.get_hatch() for c in figure.axes[0].collections)
    assert "ratio of the amplitudes [-]" in texts(figure)


def test_colours_of_compared_maps_have_common_limits() -> None:
    assert colour_limits(np.array([1.0, np.nan]), np.array([0.0, 40.0])) == (pytest.approx(0.999), 40.0)
    assert colour_limits(np.array([np.nan])) == (0.1, 1.0)


def travel(along: xr.Dataset) -> xr.Dataset:
    chosen = along.sel(gear="12", element="dmf")
    return xr.Dataset({"mean_twist": chosen.mean_twist, "swing": swing(chosen.twist), "mean_torque": along.mean_torque})


def test_characteristic(along: xr.Dataset, truck: Model) -> None:
    law = Hinges.staged([(1000.0, 8e3), (3500.0, 24e3)], stop_stiffness=1e6)
    axes = plots.plot_characteristic(travel(along), law).axes[0]
    curve = next(line for line in axes.lines if line.get_label() == "spring")
    x, y = np.radians(np.asarray(curve.get_xdata())), np.asarray(curve.get_ydata())
    assert y == pytest.approx(law.torque(x))
    stop = next(line for line in axes.lines if line.get_label() == "stop")
    assert np.radians(stop.get_xdata()[0]) == pytest.approx(0.125 + 2500 / 24e3)  # type: ignore[index]
    assert {"stage 1", "stage 2"} <= {t.get_text() for t in axes.texts}
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("twist [deg]", "torque [Nm]")


def test_travel(along: xr.Dataset) -> None:
    axes = plots.plot_travel(travel(along), stop=0.27).axes[0]
    assert axes.lines[0].get_ydata() == pytest.approx(np.degrees(along.mean_torque.values / 13e3))
    assert axes.lines[1].get_ydata()[0] == pytest.approx(np.degrees(0.27))  # type: ignore[index]


def test_full_load_and_its_power(truck: Model) -> None:
    speeds = np.array([900.0, 1300.0]) * RPM
    curve = xr.DataArray([2500.0, 2500.0], {"speed": speeds}, "speed", attrs={"quantity": "torque"})
    curve.speed.attrs["quantity"] = "speed"
    torque, power = plots.plot_full_load(curve).axes
    assert torque.lines[0].get_ydata() == pytest.approx([2500.0, 2500.0])
    assert power.lines[0].get_ydata() == pytest.approx([235.62, 340.34], abs=0.01)
    assert power.get_ylabel() == "power [kW]"


def test_engine_orders() -> None:
    size = xr.DataArray([[3.0 + 4.0j, 1.0]], {"speed": [100.0], "order": [3.0, 6.0]}, ("speed", "order"))
    size = size.assign_attrs(quantity="torque")
    axes = plots.plot_engine_orders(size).axes[0]
    assert [p.get_height() for p in axes.patches] == pytest.approx([5.0, 1.0])  # type: ignore[attr-defined]
    assert "0-peak" in axes.get_ylabel()


@pytest.mark.parametrize("name", ["truck_dmf", "truck_psva", "truck_dmf_tva", "truck_dmf_pendulum", "marine_line"])
def test_chain_shows_every_node_and_spring(name: str) -> None:
    model = shipped(name)
    powertrain = model.powertrain()
    figure = plots.plot_chain(powertrain, absorber=model.landmarks.springs, clutch=model.landmarks.clutch)
    assert len(figure.axes[0].patches) == len(powertrain.nodes)
    told = texts(figure)
    assert all(node.replace("_", " ") in told for node in powertrain.nodes)
    coloured = [line for line in lines(figure, "link-spring") if line.get_color() == plots.style.COLOURS[1]]
    assert len(coloured) == len(model.landmarks.springs)


def test_discs_are_to_scale(truck: Model) -> None:
    """Heights go with the fourth root of the inertia referred to engine speed."""
    axes = plots.plot_chain(truck.powertrain("12")).axes[0]
    height = dict(zip(truck.powertrain("12").nodes, sorted_heights(axes, truck), strict=True))
    assert height["vehicle"] / height["primary"] == pytest.approx((10000 / 2.85**2 / 1.2) ** 0.25)
    assert height["wheels"] / height["primary"] == pytest.approx((70 / 2.85**2 / 1.2) ** 0.25)


def sorted_heights(axes: mpl.axes.Axes, truck: Model) -> list[float]:
    places = plots.chain.chain(truck.powertrain("12")).places  # type: ignore[attr-defined]
    found = {round(p.get_x() + p.get_width() / 2, 6): p.get_height() for p in axes.patches}  # type: ignore[attr-defined]
    return [found[round(places[node][0], 6)] for node in truck.powertrain("12").nodes]


# --- files ---


def test_pictures_are_saved_the_same_twice(orders: xr.DataArray) -> None:
    first, second = (plots.save_svg(plots.plot_gears(orders, 3.0)) for _ in range(2))
    assert first == second
    root = ElementTree.fromstring(first)
    assert root.tag.endswith("svg")
    assert plots.save_png(plots.plot_gears(orders, 3.0)).startswith(b"\x89PNG")


def test_paths_are_told_to_a_hundredth_of_a_point() -> None:
    path = ' d="M 1.23456 -7.0049 \nL 300.000001 4.5 \nz"'
    assert plots.style._shortened(path) == ' d="M 1.23 -7 L 300 4.5 z"'


def test_settings_of_matplotlib_are_left_alone(orders: xr.DataArray) -> None:
    before = dict(mpl.rcParams)
    plots.save_svg(plots.plot_gears(orders, 3.0))
    assert dict(mpl.rcParams) == before


def test_names_in_any_script_are_drawn(orders: xr.DataArray) -> None:
    figure = plots.plot_order_cuts({"双质量飞轮 $\\frac": orders}, "12", [3.0])
    assert plots.save_svg(figure).startswith(b"<?xml")
