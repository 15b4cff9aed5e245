"""Dual mass flywheels given by their springs in a model file: what is built, in which analysis, what is refused."""

from __future__ import annotations

import json
from typing import Any

import jsonschema
import numpy as np
import pytest
from tests.shipped import EXAMPLES, shipped

from torsional.absorbers import ArcSprings, CoilSpring, GuideFriction, StraightSprings, condensed_flywheel
from torsional.cli import main
from torsional.errors import ModelError
from torsional.files import changed, expanded, model_from_document, warnings_of
from torsional.files.schema.document import json_schema
from torsional.model import Model
from torsional.quantities import named_modes
from torsional.solvers.map import response_map
from torsional.solvers.modal import modal
from torsional.solvers.operating import at_operating_point
from torsional.system import assemble

STRAIGHT, ARC = (shipped(f"truck_dmf_{kind}_spring") for kind in ("straight", "arc"))
BOTH = pytest.mark.parametrize("model", [STRAIGHT, ARC], ids=["straight", "arc"])
DEGREE = np.pi / 180
MICRON = 1e-6

STRAIGHT_DESIGN = StraightSprings(
    primary_inertia=1.035,
    secondary_inertia=1.0,
    channels=3,
    radius=0.15,
    channel_arc=112.6 * DEGREE,
    springs_per_row=4,
    spring=CoilSpring(777e3, 0.060, 0.049, 0.45),
    shoe_mass=0.15,
    shoe_width=0.012,
    end_shoe_mass=0.10,
    end_shoe_width=0.009,
    secondary_clearance=(0.3 * DEGREE, 0.3 * DEGREE),
    stop_angle=15.98 * DEGREE,
    grease_damping=0.3,
    friction=GuideFriction(0.08, 0.10, presliding=50 * MICRON, bristle_time=0.05e-3, viscous_coefficient=0.02),
    rated_torque=3450.0,
    damping=20.0,
)
ARC_DESIGN = ArcSprings(
    primary_inertia=1.14,
    secondary_inertia=1.0,
    channels=4,
    radius=0.15,
    channel_arc=72.8 * DEGREE,
    spring=CoilSpring(89.2e3, 0.19, 0.10, 0.49),
    inner_spring=CoilSpring(179e3, 0.17125, 0.07, 0.17),
    secondary_clearance=(0.5 * DEGREE, 0.5 * DEGREE),
    stop_angle=13.75 * DEGREE,
    grease_damping=0.1,
    friction=GuideFriction(0.09, 0.11, presliding=50 * MICRON, bristle_time=0.05e-3, viscous_coefficient=0.02),
    inner_friction=GuideFriction(0.12, presliding=50 * MICRON),
    rated_torque=3450.0,
    damping=20.0,
)


def law(model: Model) -> Any:
    dmf: Any = model.components["dmf"]
    return dmf.law


@pytest.mark.parametrize(("model", "design"), [(STRAIGHT, STRAIGHT_DESIGN), (ARC, ARC_DESIGN)], ids=["straight", "arc"])
def test_a_file_says_what_a_design_says(model: Model, design: StraightSprings | ArcSprings) -> None:
    absorber = condensed_flywheel(design)
    assert {name: model.components[name] for name in absorber.components} == dict(absorber.components)
    whole = model.detailed().components
    assert {name: whole[name] for name in model.detail} == dict(absorber.detail)
    assert model.absorber == absorber and absorber.kind == design.kind and model.absorber_mode == "DMF mode"
    assert model.landmarks.springs == ("dmf",)


def test_shipped_designs_carry_what_their_files_say() -> None:
    """13 kNm/rad up to 3500 Nm; 8, then 24 kNm/rad from 1000 Nm up to 3500 Nm; within half a per cent."""
    straight, arc = law(STRAIGHT), law(ARC)
    assert float(straight.tangent(0.15)) == pytest.approx(13e3, rel=5e-3)
    assert arc.tangent([0.1, 0.2]).tolist() == pytest.approx([8e3, 24e3], rel=5e-3)
    assert float(arc.torque(arc.gaps[1])) == pytest.approx(1000.0, rel=5e-3)
    for found in (straight, arc):
        assert float(found.torque(found.stops[1])) == pytest.approx(3500.0, rel=5e-3)
    for model in (STRAIGHT, ARC):
        primary: Any = model.components["primary"]
        assert primary.inertia == pytest.approx(1.2, rel=5e-3)


@BOTH
def test_detail_is_a_machine_of_the_same_inertia(model: Model) -> None:
    """Kinetic energy of rigid rotation, every node in one part, gears and landmarks as before."""
    whole = model.detailed()
    assert whole.detail == {} and whole.detailed() is whole
    assert (whole.landmarks, whole.gear_names, whole.document) == (model.landmarks, model.gear_names, model.document)
    for gear in ("1", "12"):
        plain, fine = assemble(model.powertrain(gear)), assemble(whole.powertrain(gear))
        assert fine.M.sum() == pytest.approx(plain.M.sum(), rel=1e-12)
        assert len(fine.coordinates) == len(plain.coordinates) + len([n for n in fine.nodes if n not in plain.nodes])
    assert shipped("truck_dmf").detailed().components["dmf"] is not None


@pytest.mark.parametrize(
    ("model", "name", "torque"), [(STRAIGHT, "truck_dmf", 1500.0), (ARC, "truck_dmf_two_stage", 1500.0)]
)
def test_linear_analyses_see_two_flywheels(model: Model, name: str, torque: float) -> None:
    """The truck whose flywheel is given by its law has, within the law's half per cent, the same modes and answer."""
    plain = shipped(name)
    found, expected = (modal(at_operating_point(m, torque)[0], 100.0) for m in (model, plain))
    assert found.frequency.size == expected.frequency.size
    np.testing.assert_allclose(found.frequency, expected.frequency, rtol=2e-3, atol=1e-6)
    names = named_modes(found, model.mode_groups)
    assert names == named_modes(expected, plain.mode_groups) and "DMF mode" in names
    ours, theirs = (response_map(m, [80.0, 150.0], [torque]).angle.sel(node="gearbox_input") for m in (model, plain))
    assert abs(ours - theirs).max() < 0.02 * abs(theirs).max()


@BOTH
def test_without_load_they_are_loose(model: Model) -> None:
    system, point = at_operating_point(model, 0.0)
    assert point.stage("dmf") == "free play"
    assert point.stiffness[point.names.index("dmf")] == 0.0
    assert (modal(system, 100.0).frequency < 1e-6).sum() == 2


@BOTH
def test_files_are_valid_and_expand_to_the_condensed_model(model: Model) -> None:
    validator = jsonschema.Draft202012Validator(json_schema())
    document = json.loads(json.dumps(expanded(model)))
    assert [error.message for error in validator.iter_errors(document)] == []
    again = model_from_document(document)
    np.testing.assert_array_equal(assemble(again.powertrain()).M, assemble(model.powertrain()).M)
    assert law(again) == law(model) and again.detail == {}


def test_one_clearance_or_two() -> None:
    model = changed(STRAIGHT, {"absorber.rated_torque": None})
    pair = changed(model, {"absorber.secondary_clearance": ["0.3 deg", "0.6 deg"]})
    assert sorted(g for g in law(pair).gaps if abs(g) < 0.03) == pytest.approx(
        [-0.85022679 * DEGREE, 0.55022679 * DEGREE], rel=1e-6
    )
    tabs = changed(model, {"absorber.primary_clearance": 0.0, "absorber.play_factors": [1, 2, 3]})
    gaps: list[Any] = [tabs.detail[f"shoe_{c}_primary_drive"] for c in (1, 2, 3)]
    assert [gap.law.gaps for gap in gaps] == [(0.0,)] * 3
    seats: list[Any] = [tabs.detail[f"spring_{c}_1"] for c in (1, 2, 3)]
    play = 112.6 * DEGREE - 0.294 / 0.15
    assert [seat.law.gaps[0] for seat in seats] == pytest.approx([play / 4, 2 * play / 4, 3 * play / 4])


def test_a_pendulum_may_hang_on_one() -> None:
    hung = changed(ARC, {"absorber.pendulum": {"mass": "3 kg", "distance": "0.12 m", "order": 3}})
    assert hung.detail == ARC.detail
    assert "pendulum" in hung.detailed().powertrain().nodes


def test_names_of_inner_parts_are_taken() -> None:
    part = {"type": "inertia", "inertia": 1.0}
    with pytest.raises(ModelError, match="'shoe_1_1' is taken by absorber") as told:
        changed(STRAIGHT, {"components": {"shoe_1_1": part}})
    assert told.value.where.startswith("components.shoe_1_1")


def test_a_stop_below_full_load_is_told() -> None:
    soft = changed(STRAIGHT, {"absorber.stop_angle": "11 deg", "absorber.rated_torque": None})
    (told,) = warnings_of(soft)
    assert "absorber: the springs meet their stop at 2370.7 Nm" in told and "2500 Nm" in told


@pytest.mark.parametrize(
    ("model", "key", "value", "told"),
    [
        (STRAIGHT, "secondary_clearance", "-0.1 deg", "secondary_clearance: must not be negative"),
        (STRAIGHT, "secondary_clearance", [0.0, 0.0, 0.0], "secondary_clearance: the list has the wrong length"),
        (STRAIGHT, "primary_clearance", "-0.1 deg", "primary_clearance: must not be negative"),
        (STRAIGHT, "springs_per_row", 5, "spring.solid_length: the springs are solid before they carry torque"),
        (STRAIGHT, "springs_per_row", 40, "springs_per_row: the shoes alone fill the channel"),
        (STRAIGHT, "shoe_width", "20 mm", "say preloaded: true"),
        (STRAIGHT, "stop_angle", "0.5 deg", "stop_angle: the end stop is met before the springs"),
        (STRAIGHT, "rated_torque", "4 kNm", "rated_torque: the springs meet the end stop before the rated torque"),
        (STRAIGHT, "stop_angle", "40 deg", None),
        (STRAIGHT, "spring.solid_length", "61 mm", "spring.solid_length: solid at its free length"),
        (STRAIGHT, "spring.solid_length", "52 mm", "rated_torque: the springs are solid before the rated torque"),
        (STRAIGHT, "friction.static_coefficient", 0.05, "friction.static_coefficient: must not be below sliding"),
        (STRAIGHT, "friction.bristle_time", 1e-3, "friction.viscous_coefficient: with these values friction would"),
        (STRAIGHT, "play_factors", [1.0, 2.0], "play_factors: there is one factor a channel"),
        (STRAIGHT, "preloaded", "yes", "preloaded: true or false is wanted"),
        (ARC, "segments", 5, "segments: a whole number is wanted; found 5; allowed: at least 6"),
        (ARC, "channel_arc", "70 deg", "spring.free_length: the springs are longer than their channel"),
        (ARC, "inner_spring.free_length", "200 mm", "inner_spring.free_length: the inner spring is the longer one"),
        (ARC, "spring.mass", 0, "spring.mass: must be positive"),
        (ARC, "rated_torque", "3.6 kNm", "rated_torque: the springs meet the end stop before the rated torque"),
        (ARC, "springs_per_row", 3, "the key is unknown"),
    ],
)
def test_what_cannot_be_built_is_refused_with_its_key(model: Model, key: str, value: Any, told: str | None) -> None:
    if told is None:
        changed(model, {f"absorber.{key}": value})
        return
    with pytest.raises(ModelError) as found:
        changed(model, {f"absorber.{key}": value})
    assert told in str(found.value) and found.value.where.startswith("absorber")


def test_the_command_line_refuses_with_code_two(capsys: pytest.CaptureFixture[str]) -> None:
    path = str(EXAMPLES / "truck_dmf_straight_spring.yaml")
    assert main(["check", path, "--set", "absorber.channel_arc=110 deg"]) == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1 and "absorber.spring.free_length" in told and "294 mm in a channel of 288 mm" in told
