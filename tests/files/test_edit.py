"""Changes by key path: what --set and sweeps do."""

from __future__ import annotations

import pytest
from tests.shipped import shipped

from torsional.errors import ModelError
from torsional.files import changed, document_paths
from torsional.files.edit import parsed_edit
from torsional.model import Landmarks, Model

TRUCK = shipped("truck_dmf_two_stage")


def test_a_stage_by_its_path() -> None:
    softer = changed(TRUCK, "absorber.stages.0.stiffness=10kNm/rad")
    assert softer.components["dmf"].law.torque(0.1) == pytest.approx(1000.0)  # type: ignore[attr-defined]
    assert TRUCK.components["dmf"].law.torque(0.1) == pytest.approx(800.0)  # type: ignore[attr-defined]
    assert softer.hash != TRUCK.hash
    assert softer.document["absorber"]["stages"][0]["stiffness"] == "10kNm/rad"


def test_an_unchanged_engine_is_kept_with_what_it_has_worked_out() -> None:
    assert changed(TRUCK, "clutch.damping=40").engine is TRUCK.engine
    assert changed(TRUCK, "engine.stroke=150 mm").engine is not TRUCK.engine


def test_the_same_change_gives_the_same_hash() -> None:
    one, two = changed(TRUCK, "clutch.damping=40"), changed(TRUCK, {"clutch.damping": 40})
    assert one.hash == two.hash
    assert changed(one, "clutch.damping=30").hash == TRUCK.hash


def test_several_changes_at_once_are_checked_together() -> None:
    stop = ["absorber.stages=null", "absorber.stiffness=13 kNm/rad", "absorber.stop_torque=3500 Nm"]
    assert changed(TRUCK, *stop).components["dmf"].law.tangent(0.1) == 13e3  # type: ignore[attr-defined]
    with pytest.raises(ModelError, match="absorber: a spring has a stiffness or stages; found both"):
        changed(TRUCK, stop[1])


def test_keys_and_blocks_the_file_leaves_out() -> None:
    assert changed(TRUCK, "clutch.lash=2 deg").components["clutch"].law.stiffness == 0  # type: ignore[attr-defined]
    friction = changed(TRUCK, "engine.friction.constant=0.5 bar").engine.friction  # type: ignore[union-attr]
    assert (friction.constant, friction.linear) == (0.5e5, 0.08e5)
    assert changed(TRUCK, "clutch.damping=null").components["clutch"].damping == 0  # type: ignore[attr-defined]


def test_a_whole_block() -> None:
    lumped = changed(TRUCK, {"crankshaft": {"lumped_inertia": 0.86}})
    assert lumped.landmarks.throws == ("crankshaft",)
    assert lumped.powertrain(12).speed_ratio("primary") == 1.0
    assert lumped.powertrain(12)["crank_flange"].ratio == 1.0
    line = changed(TRUCK, "components={ballast: {type: inertia, inertia: 0.1, node: axle}}")
    assert line.powertrain(1)["ballast"].node == "axle"


def test_an_edit_of_a_list_item() -> None:
    assert changed(TRUCK, "gearbox.ratios.11=0.98").gears["12"].ratio == 0.98


@pytest.mark.parametrize(
    ("edit", "message"),
    [
        ("absorber.stages.0.stifness=3", "absorber.stages.0.stifness: the key is unknown; did you mean 'stiffness'?"),
        ("absorbr.stiffness=3", "absorbr: the key is unknown; did you mean 'absorber'?"),
        ("absorber.stages.2.stiffness=3", "absorber.stages: the list has no such item; found '2'; allowed: 0 to 1"),
        ("absorber.stages.-1.up_to=3", "absorber.stages: the list has no such item; found '-1'; allowed: 0 to 1"),
        ("vehicle.mass.of=3", "vehicle.mass: this is a single value and holds no keys; found '40 t'"),
        ("clutch.damping=-3", "clutch.damping: must not be negative; found -3; allowed: >= 0 Nm s/rad"),
        ("clutch.damping=0x10", "clutch.damping: numbers are decimal; found '0x10'"),
        ("clutch.damping", "a change is written path=value; found 'clutch.damping'; e.g. absorber.stages"),
        ("=3", "a change is written path=value; found '=3'"),
        ("clutch=", "a change is written path=value; found 'clutch='"),
        ("clutch.stages=[{up_to: 3", "clutch.stages: this is not YAML"),
        ("engine.full_load=other.csv", "engine.full_load: the file is not at hand; found 'other.csv'"),
        ("clutch..damping=1", "a key path has no empty steps; found 'clutch..damping'"),
        ("gearbox=null", "driveline: a driveline needs a block 'gearbox' to hang on; or write it as components"),
    ],
)
def test_a_change_that_cannot_be_is_refused(edit: str, message: str) -> None:
    before = TRUCK.hash
    with pytest.raises(ModelError) as caught:
        changed(TRUCK, edit)
    assert str(caught.value).startswith(message)
    assert TRUCK.hash == before


def test_a_model_without_a_file_cannot_be_changed_by_paths() -> None:
    with pytest.raises(ModelError, match="no model file describes this model"):
        changed(Model("m", {}, Landmarks()), "a=1")


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("a=1e4", 1e4),
        ("a = x=y", "x=y"),
        ("a=[1, 2]", [1, 2]),
        ("a='1'", "1"),
        ("a=true", True),
        ("a=no", "no"),
        ("a=null", None),
    ],
)
def test_values_are_read_as_in_a_file(text: str, value: object) -> None:
    assert parsed_edit(text) == ("a", value)


def test_paths_of_a_document() -> None:
    paths = document_paths(TRUCK)
    assert {"absorber.stages.1.up_to", "gearbox.ratios.0", "vehicle.mass", "engine.full_load.file"} <= set(paths)
    assert "engine.full_load.text" not in paths
    assert len(set(paths)) == len(paths)
