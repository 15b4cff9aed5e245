"""Pictures of hysteresis loops show the values of their data."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from matplotlib.text import Text

from torsional import plots
from torsional.components import Component, Coupling, Inertia, Shaft
from torsional.laws import LuGre
from torsional.powertrain import Powertrain
from torsional.solvers.hysteresis import hysteresis
from torsional.stamps import NormalLoad
from torsional.system import assemble
from torsional.units import RPM


@pytest.fixture(scope="module")
def loops() -> xr.Dataset:
    parts: dict[str, Component] = {"disc_a": Inertia(1.0), "disc_b": Inertia(1.0)}
    parts["spring"] = Shaft("disc_b", "disc_a", 1e4)
    washer = LuGre(1e3, 0.0, 1.0, 1.0, 0.1)
    parts["washer"] = Coupling("disc_b", "disc_a", washer, load=NormalLoad(centrifugal=1e-3))
    speeds, sweeps = np.array([0.0, 1000.0, 3000.0]) * RPM, np.radians([2.0, 30.0])
    return hysteresis(assemble(Powertrain(parts)), "disc_a", "disc_b", speeds, sweeps)


def test_a_loop_for_every_speed(loops: xr.Dataset) -> None:
    figure = plots.plot_hysteresis(loops, title="two discs")
    axes = figure.axes[0]
    drawn = [line for line in axes.lines if line.get_gid() == "loop"]
    assert [line.get_label() for line in drawn] == ["0 rpm", "1000 rpm", "3000 rpm"]
    assert len({line.get_color() for line in drawn}) == 3
    legend = axes.get_legend()
    assert legend is not None and legend.get_texts()[-1].get_text() == "first loading"
    for line, speed in zip(drawn, loops.speed, strict=True):
        x, y = (np.asarray(values) for values in line.get_data())
        assert (x[0], y[0]) == (x[-1], y[-1])
        assert np.radians(x[:-1]) == pytest.approx(loops.drive_angle.isel(sweep=1).values)
        assert y[:-1] == pytest.approx(loops.drive_torque.sel(speed=speed, cycle="closed").isel(sweep=1).values)
    assert axes.get_xlabel() == "angle of disc a against disc b [deg]"
    assert axes.get_ylabel() == "torque [Nm]"


def test_figures_beside_it(loops: xr.Dataset) -> None:
    axes = plots.plot_hysteresis(loops).axes[1:]
    assert [a.get_ylabel() for a in axes] == ["stiffness [kNm/rad]", "loss factor", "sliding elements"]
    assert np.array([line.get_ydata() for line in axes[1].lines]) == pytest.approx(loops.loss_factor.values)
    assert axes[-1].get_xlabel() == "sweep to either side [deg]"
    one = plots.plot_hysteresis(loops.isel(sweep=[1])).axes[1:]
    assert one[-1].get_xlabel() == "mean engine speed [rpm]"
    assert np.asarray(one[0].lines[0].get_ydata()) == pytest.approx(loops.stiffness.values[:, 1] / 1e3)


def test_one_loop_alone_fills_the_picture(loops: xr.Dataset) -> None:
    figure = plots.plot_hysteresis(loops.isel(speed=[1], sweep=[1]), title="a_b $x$")
    assert len(figure.axes) == 1
    assert "a_b \\$x\\$" in " ".join(t.get_text() for t in figure.findobj(Text))  # type: ignore[attr-defined]
    assert plots.save_png(figure).startswith(b"\x89PNG")
