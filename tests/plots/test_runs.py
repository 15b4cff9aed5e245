"""Pictures of runs in time show the values of their data."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from tests.shipped import shipped

from torsional import load_scenario, plots, run_scenario
from torsional.plots.transient import envelope


@pytest.fixture(scope="module")
def run() -> xr.Dataset:
    shift = ["duration=0.8 s", "clutch.within=0.02 s", "clutch.capacity=6 kNm", "torque_from=0.7 s"]
    shift += ["torque_off=20 ms", "off_within=40 ms", "clutch.opens=60 ms", "clutch.opens_within=20 ms"]
    shift += [
        "synchroniser.begins=80 ms",
        "synchroniser.within=100 ms",
        "clutch.engages=0.2 s",
        "before=0 Nm",
        "torque_within=50 ms",
    ]
    overriding = load_scenario(
        "gear_shift", [*shift, "from_gear=9", "model.absorber.stop_torque=1500 Nm", "torque=500"]
    )
    return run_scenario(shipped("truck_dmf"), overriding)


def test_a_scenario_shows_what_was_done_and_what_it_did(run: xr.Dataset) -> None:
    figure = plots.plot_scenario(run)
    torques, events, speeds, twists = figure.axes
    assert [text.get_text() for text in events.texts] == [
        "engine torque asked for, up to 500 Nm",
        "clutch capacity, up to 6000 Nm",
        f"synchroniser, up to {float(run.schedule.sel(event='synchroniser').max()):.5g} Nm",
        *("gear 9", "torque off", "clutch opens", "neutral", "clutch open", "clutch closes", "gear 12"),
    ]
    marked = [float(np.asarray(line.get_xdata())[0]) for line in speeds.lines if line.get_gid() == "phase"]
    assert marked == pytest.approx([0.02, 0.06, 0.08, 0.18, 0.2, 0.7])
    labels = [line.get_label() for line in speeds.lines if line.get_gid() == "signal"]
    assert labels == ["primary", "gearbox input", "vehicle, as at the engine"]
    drawn = [line for line in twists.lines if line.get_gid() == "signal"]
    assert np.radians(drawn[0].get_ydata()) == pytest.approx(run.twist.sel(element="dmf").values)
    shown = [line.get_label() for line in torques.lines if line.get_gid() != "phase"]
    assert shown == ["dmf", "clutch linings", "clutch capacity"]
    speed = np.asarray(speeds.lines[1].get_ydata()) * np.pi / 30
    assert speed == pytest.approx(run.angular_velocity.sel(node="gearbox_input").values)


def test_stops_are_lines_and_contacts_are_marked(run: xr.Dataset) -> None:
    twists = plots.plot_scenario(run).axes[3]
    dashed = [line for line in twists.lines if line.get_gid() is None and line.get_label() != "on the stop"]
    stops = sorted(float(np.asarray(line.get_ydata())[0]) for line in dashed)
    # 1500 Nm over 13 kNm/rad
    assert np.degrees(1500 / 13e3) == pytest.approx(stops[-1])
    marked = next(line for line in twists.lines if line.get_label() == "on the stop")
    assert int(run.stop_contacts.sel(element="dmf")) > 0
    assert np.abs(np.asarray(marked.get_ydata())).min() > np.degrees(1500 / 13e3)


def test_a_run_alone(run: xr.Dataset) -> None:
    figure = plots.plot_transient(run, nodes=["primary", "vehicle"], springs=["dmf"], title="a run")
    assert [line.get_label() for line in figure.axes[0].lines] == ["primary", "vehicle, as at the engine"]
    assert figure.axes[0].get_title("left") == "a run"


def test_no_peak_is_lost_in_a_long_run() -> None:
    time = np.linspace(0.0, 1.0, 100_001)
    values = np.sin(900 * time)
    values[77_777], values[12_345] = 5.0, -7.0
    at, thin = envelope(time, values, 2000)
    assert len(at) <= 2000
    assert (thin.max(), thin.min()) == (5.0, -7.0)
    assert (np.diff(at) >= 0).all()
