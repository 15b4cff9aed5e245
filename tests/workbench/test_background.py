"""What jobs find, against the functions that Python calls; and what they refuse."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import torsional
from torsional.errors import ModelError
from torsional.workbench.background import worked
from torsional.workbench.frames import decoded

Made = Callable[..., dict[str, Any]]
RPM = torsional.RPM


def found(design: dict[str, Any], kind: str, **settings: Any) -> tuple[Any, list[tuple[int, int, str]]]:
    """The frame of a job, and its progress."""
    told: list[tuple[int, int, str]] = []
    return decoded(worked(design, kind, settings, lambda *moved: told.append(moved))["frame"]), told


def test_branches_of_two_stages_turn_to_half_the_order(design: Made) -> None:
    """The two-stage flywheel at 1200 Nm: a period doubling, behind which a stable motion of order 1.5 begins."""
    span = (780 * RPM, 900 * RPM)
    got, _ = found(design("truck_dmf_two_stage"), "branches", torque=1200.0, speed=list(span))
    truck = torsional.load_model("examples/truck_dmf_two_stage.yaml")
    data = torsional.model_response(truck, span, torque=1200.0, at=np.linspace(*span, 201))
    assert (got["place"], got["quantity"], got["orders"]) == ("dmf", "torque", [3.0, 1.5])
    assert [point["kind"] for point in got["points"]] == [str(kind) for kind in data.bifurcation_type.values]
    assert [point["speed"] for point in got["points"]] == data.bifurcation_speed.values.tolist()
    half = [line for line in got["lines"] if line["period"] == 2 and line["stable"].all()]
    assert max(line["value"]["1.5"].max() for line in half) > 100
    alone = [line for line in got["lines"] if line["period"] == 1]
    assert max(line["value"]["1.5"].max() for line in alone) < 1e-6
    assert {float(line["stable"][0]) for line in alone} == {0.0, 1.0}
    every = {float(v) for line in got["lines"] for v in line["value"]["3"]}
    assert every == set(np.abs(data.torque.sel(element="dmf", order=3.0).values).tolist())


def test_the_linear_response_stands_beside_them(design: Made) -> None:
    """Within the first stage, well below its end, both are one."""
    got, _ = found(design("truck_dmf_two_stage"), "branches", torque=300.0, speed=[100.0, 120.0])
    (line,) = got["lines"]
    at = np.interp(line["speed"], got["linear"]["speed"], got["linear"]["value"]["3"])
    np.testing.assert_allclose(line["value"]["3"], at, rtol=2e-3)


def test_the_region_is_that_of_the_map(design: Made) -> None:
    asked = {"speed": [830 * RPM, 900 * RPM], "torque": [1000.0, 1400.0], "speeds": 6, "torques": 3}
    got, told = found(design("truck_dmf_two_stage"), "region", **asked)
    truck = torsional.load_model("examples/truck_dmf_two_stage.yaml")
    speeds, torques = np.linspace(*asked["speed"], 6), np.linspace(1000.0, 1400.0, 3)
    data = torsional.subharmonic_map(truck, speeds, torques)
    assert got["order"] == 1.5
    assert (got["amplitude"] == data.amplitude.transpose("mean_torque", "speed").values).all()
    assert got["amplitude"].max() > 100
    assert (got["boundary"]["speed"] == data.boundary_speed.values).all()
    assert told[:3] == [(1, 3, "mean torques"), (2, 3, "mean torques"), (3, 3, "mean torques")]


def test_a_scenario_is_told_with_its_peaks(design: Made) -> None:
    """Of more instants than are sent: extremes of every torque and speed are among those that are."""
    got, told = found(design("truck_dmf"), "scenario", scenario="tip_in", values={"duration": "1 s", "at": 0.1})
    truck = torsional.load_model("examples/truck_dmf.yaml")
    run = torsional.run_scenario(truck, torsional.load_scenario("tip_in", ["duration=1s", "at=0.1s"]))
    assert len(got["time"]) < run.sizes["time"]
    channels = {channel["name"]: channel for channel in got["channels"]}
    for name, channel in channels.items():
        assert len(channel["values"]) == len(got["time"])
        kind, _, place = name.partition(":")
        if kind in ("torque", "angular_velocity"):
            whole = run[kind].sel({"node" if kind == "angular_velocity" else "element": place})
            assert (channel["values"].min(), channel["values"].max()) == (float(whole.min()), float(whole.max()))
    moved = dict(zip(got["moved"]["nodes"], got["moved"]["angle"], strict=True))
    wound = moved[got["moved"]["crank"]] - moved["secondary"]
    np.testing.assert_allclose(wound, channels["twist:dmf"]["values"], rtol=0.0, atol=1e-12)
    assert got["moved"]["speed_ratio"].tolist() == run.speed_ratio.values.tolist()
    measures = {measure["name"]: measure["value"] for measure in got["measures"]}
    assert measures["torque_highest:clutch"] == float(run.torque_highest.sel(element="clutch"))
    assert got["events"][0]["time"] == pytest.approx(0.1, abs=1e-3)
    assert got["stops"]["dmf"] == [float(run[f"stop_{side}"].sel(element="dmf")) for side in ("below", "above")]
    schedule = json.loads(run.attrs["schedule_quantities"])
    assert channels["done:mean engine torque"]["quantity"] == schedule["mean engine torque"]
    assert told[-1][2] == "drawing" and 0 < told[0][1] == 1000


@pytest.mark.parametrize(
    ("kind", "settings", "where"),
    [
        ("branches", {}, ""),  # a truck of linear springs
        ("branches", {"speed": [100.0, 50.0]}, "settings.speed"),
        ("branches", {"speed": [100.0, 1e12]}, "settings.speed"),
        ("branches", {"gear": "13"}, "gear"),
        ("region", {"speeds": 10_000}, "settings.speeds"),
        ("region", {"unknown": 1}, "settings.unknown"),
        ("scenario", {"scenario": "tip_inn"}, "settings.scenario"),
        ("scenario", {"scenario": "tip_in", "values": {"duration": "1 kg"}}, "duration"),
        ("scenario", {"scenario": "tip_in", "values": {"scenario": "gear_shift"}}, "settings.values.scenario"),
        ("scenario", {"scenario": "tip_in", "values": {"model": {"nothing.here": 1}}}, ""),
    ],
)
def test_what_cannot_be_asked_is_told(design: Made, kind: str, settings: Any, where: str) -> None:
    with pytest.raises(ModelError) as caught:
        worked(design("truck_smf"), kind, settings, lambda *_: None)
    assert caught.value.where.startswith(where)
    assert str(caught.value)


def test_a_place_is_named_as_the_model_names_it(design: Made) -> None:
    asked = {"torque": 300.0, "speed": [100.0, 105.0]}
    got, _ = found(design("truck_dmf_two_stage"), "branches", place="gearbox_input", **asked)
    assert got["quantity"] == "acceleration"
    with pytest.raises(ModelError, match="did you mean 'gearbox_input'"):
        worked(design("truck_dmf_two_stage"), "branches", {**asked, "place": "gearbox_inptu"}, lambda *_: None)
