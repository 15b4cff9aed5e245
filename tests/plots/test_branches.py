"""Pictures of periodic motions show the values of their data; stable and unstable ones are told apart."""

from __future__ import annotations

import re

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from tests.synthetic_branches import FOLD, MEAN, branches, region

from torsional import plots
from torsional.laws import Hinges
from torsional.plots.branches import branch_colour, parameter_axis
from torsional.quantities.branches import solutions_at
from torsional.units import RPM

LAW = Hinges.staged([(1000.0, 8e3), (3500.0, 24e3)], stop_stiffness=1e6)


@pytest.fixture(scope="module")
def result() -> xr.Dataset:
    return branches()


def drawn(axes: Axes, gid: str) -> list[mpl.lines.Line2D]:
    return [line for line in axes.lines if line.get_gid() == gid]


def xy(lines: list[mpl.lines.Line2D]) -> np.ndarray:
    return np.concatenate([np.transpose(line.get_data()) for line in lines])


def texts(figure: Figure) -> str:
    return " | ".join(t.get_text() for t in figure.findobj(mpl.text.Text))  # type: ignore[attr-defined]


# --- branches ---


def test_every_point_is_drawn_in_the_line_of_its_stability(result: xr.Dataset) -> None:
    axes = plots.plot_branches(result, [3.0], element="dmf").axes[0]
    size, rpm = np.abs(result.torque.sel(order=3.0, element="dmf").values), result.speed.values / RPM
    wanted = {tuple(np.round(pair, 9)) for pair in zip(rpm[result.stable], size[result.stable], strict=True)}
    found = {tuple(np.round(pair, 9)) for pair in xy(drawn(axes, "stable"))}
    assert found == wanted
    unstable = {tuple(np.round(pair, 9)) for pair in xy(drawn(axes, "unstable"))}
    assert {tuple(np.round(p, 9)) for p in zip(rpm[~result.stable], size[~result.stable], strict=True)} <= unstable


def test_unstable_is_dashed_and_paler_in_the_branch_s_colour(result: xr.Dataset) -> None:
    axes = plots.plot_branches(result, [3.0], element="dmf").axes[0]
    solid, dashed = (drawn(axes, gid)[0] for gid in ("stable", "unstable"))
    assert solid.get_linestyle() == "-" and dashed.get_linestyle() == "--"
    assert solid.get_color() == branch_colour(0)
    light, dark = (np.array(mpl.colors.to_rgb(line.get_color())) for line in (dashed, solid))
    assert (light >= dark).all() and light.sum() > dark.sum() + 0.5
    assert {line.get_color() for line in drawn(axes, "stable")} == {branch_colour(n) for n in (0, 1, 2)}


def test_bifurcations_are_marked_on_their_branches(result: xr.Dataset) -> None:
    figure = plots.plot_branches(result, [3.0, 1.5], element="dmf")
    marks = drawn(figure.axes[0], "bifurcation")
    assert xy(marks)[:, 0] == pytest.approx(np.array([90, 110, 130 + FOLD, 130 - FOLD]) / RPM)
    assert xy(marks)[2:, 1] == pytest.approx([600 - 100 / np.sqrt(3), 600 + 100 / np.sqrt(3)], abs=5.0)
    assert marks[0].get_marker() == marks[1].get_marker() != marks[2].get_marker()
    assert xy(drawn(figure.axes[1], "bifurcation"))[:, 1] == pytest.approx(np.zeros(4), abs=1e-9)
    told = {t.get_text() for t in figure.axes[0].get_legend().texts}  # type: ignore[union-attr]
    assert {"fold", "period doubling", "unstable", "several stable motions", "0: main, base order 3"} <= told


def test_what_is_measured_is_told(result: xr.Dataset) -> None:
    figure = plots.plot_branches(result, [1.5, "mean", "swing"], element="dmf")
    labels = [axes.get_ylabel() for axes in figure.axes]
    assert labels == ["order 1.5, 0-peak\ntorque [Nm]", "mean\ntorque [Nm]", "half peak-to-peak\ntorque [Nm]"]
    assert [axes.get_xlabel() for axes in figure.axes] == ["", "", "engine speed [rpm]"]
    assert xy(drawn(figure.axes[1], "stable"))[:, 1] == pytest.approx(MEAN)
    first = drawn(figure.axes[2], "stable")[0]
    assert np.asarray(first.get_ydata())[0] == pytest.approx(400.0, rel=1e-3)
    node = plots.plot_branches(result, [3.0], node="input").axes[0]
    assert node.get_ylabel() == "order 3, 0-peak\nacceleration [rad/s²]"
    assert np.asarray(drawn(node, "stable")[0].get_ydata())[0] == pytest.approx(150.0**2 * 200e-5)
    twist = plots.plot_branches(result, [3.0], element="dmf", quantity="twist").axes[0]
    assert twist.get_ylabel() == "order 3, 0-peak\ntwist [deg]"
    assert np.asarray(drawn(twist, "stable")[0].get_ydata())[0] == pytest.approx(np.degrees(0.04))


def test_an_order_that_is_not_there_is_no_noise_drawn_large(result: xr.Dataset) -> None:
    calm = result.assign(torque=result.torque.where(result.order != 1.5, 1e-12))
    axes = plots.plot_branches(calm, [1.5], element="dmf").axes[0]
    assert axes.get_ylim()[1] == 1.0
    assert "none" in {t.get_text() for t in axes.texts}


def test_motions_chosen_have_letters(result: xr.Dataset) -> None:
    chosen = solutions_at(result, 100.0)
    axes = plots.plot_branches(result, [1.5], element="dmf", solutions=chosen).axes[0]
    assert xy(drawn(axes, "solution")) == pytest.approx(np.array([[100 / RPM, 0], [100 / RPM, 600]]))
    assert {"A", "B"} <= {t.get_text() for t in axes.texts}
    outside = solutions_at(result, 200.0)
    assert drawn(plots.plot_branches(result, [1.5], element="dmf", solutions=outside).axes[0], "solution") == []


@pytest.mark.parametrize(
    ("parameter", "unit", "label", "scale"),
    [
        ("speed", "rad/s", "engine speed [rpm]", 1 / RPM),
        ("mean_torque", "Nm", "mean engine torque [Nm]", 1.0),
        ("absorber.stages.1.stiffness", "Nm/rad", "absorber.stages.1.stiffness [kNm/rad]", 1e-3),
        ("absorber.damping", "Nm s/rad", "absorber.damping [Nm s/rad]", 1.0),
        ("clutch.loss_factor", "-", "clutch.loss_factor", 1.0),
    ],
)
def test_parameters_are_shown_in_their_unit(
    result: xr.Dataset, parameter: str, unit: str, label: str, scale: float
) -> None:
    plain = result.assign_attrs(parameter=parameter, parameter_unit=unit)
    plain["value"] = plain.value.assign_attrs(quantity="")
    assert parameter_axis(plain) == (label, pytest.approx(scale))


def test_one_stable_branch_alone(result: xr.Dataset) -> None:
    """No bifurcation, no instability: no word of either."""
    alone = result.isel(point=result.branch.values == 1, bifurcation=[])
    figure = plots.plot_branches(alone, [3.0], element="dmf")
    assert [t.get_text() for t in figure.axes[0].get_legend().texts] == ["1: period doubling, base order 1.5"]  # type: ignore[union-attr]


# --- motions ---


def signal(result: xr.Dataset, name: str, point: int, alpha: np.ndarray) -> np.ndarray:
    x = result[name].sel(element="dmf").isel(point=point).values
    return np.asarray((x[0] + x[1] * np.exp(1.5j * alpha) + x[2] * np.exp(3j * alpha)).real)


def test_signals_stages_and_loops(result: xr.Dataset) -> None:
    chosen = solutions_at(result, 100.0)
    figure = plots.plot_solutions(chosen, "dmf", LAW, title="at 955 rpm")
    twist, stages, torque, loop = figure.axes
    alpha = np.radians(np.asarray(drawn(twist, "signal")[1].get_xdata()))
    assert (alpha[0], alpha.size) == (0.0, 720)
    assert np.radians(drawn(twist, "signal")[1].get_ydata()) == pytest.approx(signal(chosen, "twist", 1, alpha))
    assert drawn(torque, "signal")[1].get_ydata() == pytest.approx(signal(chosen, "torque", 1, alpha))
    closed = xy([drawn(loop, "loop")[1]])
    assert closed[0] == pytest.approx(closed[-1])
    assert np.radians(closed[:-1, 0]) == pytest.approx(signal(chosen, "twist", 1, alpha))
    (spring,) = [line for line in loop.lines if line.get_label() == "spring"]
    assert spring.get_ydata() == pytest.approx(LAW.torque(np.radians(spring.get_xdata())))
    edges = [float(line.get_ydata()[0]) for line in drawn(twist, "boundary")]  # type: ignore[index]
    assert edges == pytest.approx(np.degrees([0.125]))
    assert [axes.get_ylabel() for axes in (twist, torque)] == ["twist [deg]", "torque [Nm]"]
    assert stages.get_xlim() == (0, 720)
    told = {t.get_text() for t in loop.get_legend().texts}  # type: ignore[union-attr]
    assert told == {"spring", "A: branch 0, main, unstable", "B: branch 1, period doubling"}


def test_strips_last_as_long_as_the_signal_is_in_the_stage(result: xr.Dataset) -> None:
    chosen = solutions_at(result, 100.0)
    figure = plots.plot_solutions(chosen, "dmf", LAW)
    strips = figure.axes[1]
    alpha = np.linspace(0, 4 * np.pi, 100_000, endpoint=False)
    for row in (0, 1):
        bars = [p for p in strips.patches if abs(p.get_y() + 0.4 - row) < 0.1]  # type: ignore[attr-defined]
        assert sum(p.get_width() for p in bars) == pytest.approx(720.0)  # type: ignore[attr-defined]
        share = float(np.mean(signal(chosen, "twist", row, alpha) > 0.125))
        told = re.findall(r"stage 2 ([0-9.]+) %", texts(figure))[row]
        assert float(told) == pytest.approx(100 * share, abs=0.06)


def test_longer_cycles_are_drawn_whole(result: xr.Dataset) -> None:
    slow = result.assign_coords(order=[0.0, 0.75, 1.5])
    figure = plots.plot_solutions(slow.isel(point=[60]), "dmf")
    assert figure.axes[0].get_xlim() == (0, 1440)
    y = np.asarray(drawn(figure.axes[0], "signal")[0].get_ydata())
    assert not np.allclose(y[:720], y[720:])


def test_two_motions_of_one_branch_have_two_colours(result: xr.Dataset) -> None:
    chosen = solutions_at(result, 130.0)
    loops = drawn(plots.plot_solutions(chosen, "dmf", LAW).axes[3], "loop")
    assert len({line.get_color() for line in loops}) == len(loops) == 4


# --- the region ---


def test_region() -> None:
    found = region()
    speeds = np.array([60.0, 130.0])
    curve = xr.DataArray([900.0, 1600.0], {"speed": ("speed", speeds, {"quantity": "speed"})}, "speed")
    figure = plots.plot_region(found, full_load=curve.assign_attrs(quantity="torque"), title="gear 12")
    axes = figure.axes[0]
    cells = axes.collections[0].get_array()
    assert isinstance(cells, np.ma.MaskedArray)
    assert cells.mask.reshape(17, 29).tolist() == (found.amplitude.values == 0).tolist()
    assert cells.compressed() == pytest.approx(found.amplitude.values[found.amplitude.values > 0])
    bounds = [line for line in axes.lines if line.get_gid() == "boundary"]
    assert {line.get_label() for line in bounds} == {"fold", "period doubling"}
    assert len({(line.get_color(), line.get_linestyle()) for line in bounds}) == 2
    assert xy(bounds)[[0, -1], 0] == pytest.approx(115.0 / RPM)
    (best,) = drawn(axes, "largest")
    assert xy([best])[0] == pytest.approx([95.0 / RPM, 1100.0])
    assert drawn(axes, "full-load")
    assert "order 1.5: torque in dmf [Nm], 0-peak" in texts(figure)
    assert any(c.get_hatch() == "..." for c in axes.collections)


def test_region_of_acceleration_and_of_nothing() -> None:
    assert "order 1.5: acceleration [rad/s²], 0-peak" in texts(plots.plot_region(region(), "acceleration"))
    calm = region().map(lambda values: 0 * values if values.name == "amplitude" else values, keep_attrs=True)
    figure = plots.plot_region(calm.drop_dims("boundary_point"))
    assert "no such motion found" in texts(figure)
    assert drawn(figure.axes[0], "largest") == []


@pytest.mark.parametrize("save", [plots.save_png, plots.save_svg])
def test_pictures_are_saved(result: xr.Dataset, save: object) -> None:
    figures = [
        plots.plot_branches(result, [3.0], element="dmf"),
        plots.plot_solutions(solutions_at(result, 100.0), "dmf", LAW),
        plots.plot_region(region()),
    ]
    assert all(len(save(figure)) > 5000 for figure in figures)  # type: ignore[operator]
