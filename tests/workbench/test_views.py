"""Views: the figures of the commands, bit by bit."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import torsional
from torsional.errors import ModelError
from torsional.quantities import acceleration
from torsional.solvers.campbell import campbell
from torsional.stamps import Connection, Constraint, Mass
from torsional.workbench.answering import answer
from torsional.workbench.designs import design_of, model_of, saved
from torsional.workbench.frames import decoded
from torsional.workbench.views import ASKS, ask_of

Designed = Callable[..., dict[str, Any]]
RPM = torsional.RPM


def asked(design: dict[str, Any], view: str, **settings: Any) -> Any:
    return decoded(answer(design, [{"view": view, **settings}]))["answers"][0]


@pytest.fixture
def file(design: Designed, tmp_path: Path) -> Path:
    """A changed design, saved."""
    given = design_of(design(absorber__stiffness="11.5 kNm/rad", clutch__damping="33"))
    (tmp_path / "truck13_full_load.csv").write_text(given.files["truck13_full_load.csv"], encoding="utf-8")
    (tmp_path / "saved.yaml").write_text(saved(given), encoding="utf-8")
    return tmp_path / "saved.yaml"


def test_response_has_the_bits_of_the_saved_file(design: Designed, file: Path) -> None:
    ours = asked(
        design(absorber__stiffness="11.5 kNm/rad", clutch__damping="33"), "response", gear="10", orders=[1.5, 3.0]
    )
    model = torsional.load_model(file)
    theirs = torsional.run_up_response(model, model.speeds(300), None, "10", [1.5, 3.0])
    places = [place["name"] for place in ours["places"]]
    assert places == ["primary", "gearbox_input", "dmf", "clutch"] and ours["value"].shape == (4, 2, 300)
    moved = abs(acceleration(theirs.angle.sel(node=places[:2])).transpose("node", "order", "speed").values)
    twisted = abs(theirs.torque.sel(element=places[2:]).transpose("element", "order", "speed").values)
    assert (ours["value"] == np.concatenate([moved, twisted])).all()


def test_map_has_the_bits_of_the_saved_file(design: Designed, file: Path) -> None:
    ours = asked(design(absorber__stiffness="11.5 kNm/rad", clutch__damping="33"), "map", speeds=12, torques=5)
    model = torsional.load_model(file)
    theirs = torsional.response_map(model, model.speeds(12), model.torques(5), None, [3.0], nodes=["gearbox_input"])
    told = abs(acceleration(theirs.angle)).transpose("gear", "mean_torque", "speed", "order", "node").values
    assert (ours["value"] == told[..., 0, 0]).all() and ours["value"].shape == (12, 5, 12)
    assert (ours["within"] == theirs.within_full_load.values).all() and np.isfinite(ours["full_load"]).all()


def test_modes_and_crossings_are_those_of_the_commands(design: Designed) -> None:
    model = torsional.load_model("examples/truck_dmf.yaml")
    ours = asked(design(), "modes", gear="12", torque=1000.0)
    theirs = torsional.modal(torsional.at_operating_point(model, 1000.0, "12")[0], model.operation.idle)
    assert (ours["frequency"] == theirs.frequency.values).all() and (ours["shape"] == theirs["shape"].values).all()
    assert "DMF mode" in ours["name"] and ours["masses"][0] == "damper_ring"
    met = asked(design(), "interference", gears=["11", "12"])
    wanted = campbell(model, None, ["11", "12"])
    assert (met["frequency"] == wanted.frequency.transpose("gear", "mode", "speed").values).all()
    assert met["orders"] == wanted.order.values.tolist() and met["name"][1].count("DMF mode") == 1


def test_nodes_turn_up_where_their_speed_is_asked(design: Designed) -> None:
    angle, velocity = (
        asked(design(), "response", nodes=["wheels"], quantity=kind, orders=[3.0], speeds=5)
        for kind in ("angle", "angular_velocity")
    )
    assert velocity["value"] == pytest.approx(3 * angle["speed"] * angle["value"]) and len(angle["places"]) == 1


def test_a_part_is_made_of_the_values_that_change_it(design: Designed) -> None:
    parts = asked(design(), "parts")["parts"]
    assert parts["throw3"] == ["crankshaft.throw_inertia"] and parts["gear"] == ["gearbox.ratios.11"]
    assert {"absorber.stiffness", "absorber.stop_torque", "absorber.damping"} <= {*parts["dmf"]}
    assert parts["vehicle"] == ["vehicle.mass", "vehicle.rolling_radius"] and all(parts.values())
    assert asked(design(), "parts", gear="4")["parts"]["gear"] == ["gearbox.ratios.3"]
    pendulum = asked(design("truck_dmf_pendulum"), "parts")["parts"]
    assert any("pendulum" in path for paths in pendulum.values() for path in paths)


@pytest.mark.parametrize("name", ["truck_dmf", "truck_psva", "truck_dmf_tva", "marine_line", "rig_dmf", "mwm_engine"])
def test_the_chain_holds_every_disc_and_every_link(design: Designed, name: str) -> None:
    found = asked(design(name), "model")
    stamps = model_of(design_of(design(name))).powertrain().stamps
    links = {s.name for s in stamps if len([n for n in s.weights if n != "ground"]) > 1}
    assert {link["name"] for link in found["chain"]["links"]} == links
    assert {node["name"] for node in found["chain"]["nodes"]} == {*found["nodes"]}
    paths = {group["path"] for group in found["groups"]}
    assert all(part["path"] in paths or not part["path"] for kind in found["chain"].values() for part in kind)
    assert any(isinstance(s, Mass) for s in stamps) and any(isinstance(s, Connection | Constraint) for s in stamps)


def test_characteristic_goes_through_its_operating_point(design: Designed) -> None:
    found = asked(design("truck_dmf_two_stage"), "characteristic", torque=1800.0, speed=1000 * RPM)
    at = float(np.interp(found["point"]["angle"], found["angle"], found["torque"]))
    assert at == pytest.approx(1800, rel=1e-3) and found["point"]["swing"] > 0 and len(found["stages"]) == 2
    assert found["angle"][-1] > max(found["stops"]) and found["element"] == "dmf"
    kinks = np.gradient(found["torque"], found["angle"])
    assert kinks.max() == pytest.approx(1e6, rel=1e-3) and kinks.min() < 1.01 * found["stages"][0]["stiffness"]


def test_criteria_tell_what_they_are(design: Designed) -> None:
    told = {c["name"]: c for c in asked(design(), "criteria")["criteria"]}
    assert told["inertia"]["value"] == pytest.approx(2.2) and told["stop_dmf"]["better"] == "more"
    softer = {c["name"]: c for c in asked(design(absorber__stiffness="10 kNm/rad"), "criteria")["criteria"]}
    assert softer["absorber_resonance"]["value"] < told["absorber_resonance"]["value"]
    assert [c["name"] for c in asked(design("rig_dmf"), "criteria")["criteria"]] == ["inertia"]


@pytest.mark.parametrize("view", sorted(ASKS))
@pytest.mark.parametrize("name", ["mwm_engine", "rig_dmf", "marine_line"])
def test_a_machine_without_something_says_so(design: Designed, name: str, view: str) -> None:
    found = asked(design(name), view)
    for fault in found.get("errors", ()):
        assert fault["problem"] and "(" not in fault["where"]


def test_one_wrong_ask_leaves_the_others(design: Designed) -> None:
    wrong, unknown, right = decoded(
        answer(design(), [{"view": "modes", "gear": "13"}, {"view": "mdoes"}, {"view": "modes"}])
    )["answers"]
    assert "there is no gear '13'" in wrong["errors"][0]["problem"] and "frequency" in right
    assert unknown["errors"][0]["remedy"] == "did you mean 'modes'?"


@pytest.mark.parametrize(
    "ask",
    [
        {"view": "response", "speeds": 10**6},
        {"view": "response", "orders": []},
        {"view": "response", "orders": [3.0] * 100},
        {"view": "response", "torque": float("nan")},
        {"view": "response", "nodes": ["no such"]},
        {"view": "response", "quantity": "colour"},
        {"view": "map", "place": "nowhere"},
        {"view": "map", "order": -1.0},
        {"view": "characteristic", "element": "no such"},
        {"view": "modes", "colour": "red"},
        {"view": 3},
        ["modes"],
    ],
)
def test_a_question_that_cannot_be_is_refused(design: Designed, ask: Any) -> None:
    with pytest.raises(ModelError):
        ask_of(ask).answer(model_of(design_of(design())))


@pytest.mark.parametrize("asks", [[], None, [{"view": "modes"}] * 9, "modes"])
def test_a_message_holds_one_to_eight_questions(design: Designed, asks: Any) -> None:
    with pytest.raises(ModelError, match="a list of questions"):
        answer(design(), asks)
