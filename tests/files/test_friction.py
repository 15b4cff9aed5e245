"""Friction washers in a model file: where they stand, what they do to linear analyses, what is refused."""

from __future__ import annotations

import copy
import json
from typing import Any

import jsonschema
import numpy as np
import pytest
from tests.shipped import EXAMPLES, shipped

from torsional.components import Coupling
from torsional.errors import ModelError
from torsional.files import changed, expanded, model_from_document
from torsional.files.reader import read_tree
from torsional.files.schema.document import json_schema
from torsional.laws import Jenkins
from torsional.model import Model
from torsional.quantities import named_modes, swing
from torsional.solvers.equilibrium import linearize
from torsional.solvers.map import response_map
from torsional.solvers.modal import modal
from torsional.solvers.operating import at_operating_point, mean_state
from torsional.solvers.run_up import run_up_response
from torsional.system import assemble
from torsional.units import RPM

TRUCK = shipped("truck_dmf")
STUCK = 60.0 / np.radians(0.1)
RUBBING = changed(TRUCK, "clutch.friction_torque=60 Nm", "absorber.friction_torque=40 Nm")


def only(model: Model, path: str, **keys: Any) -> Model:
    """A model with a friction washer in one block."""
    return changed(model, {f"{path}.{key}": value for key, value in keys.items()})


def test_washers_stand_beside_the_springs() -> None:
    parts = only(RUBBING, "absorber", friction_stiffness="20 kNm/rad").components
    assert parts["clutch_friction"] == Coupling("clutch_disc", "secondary", Jenkins(60.0, STUCK))
    assert parts["dmf_friction"] == Coupling("secondary", "primary", Jenkins(40.0, 20e3))
    for name in ("clutch", "dmf"):
        assert parts[name] == TRUCK.components[name]
    assert RUBBING.landmarks == TRUCK.landmarks
    assert only(TRUCK, "clutch", friction_torque=0, friction_stiffness=1e4).components == TRUCK.components


@pytest.mark.parametrize(
    ("name", "washer"),
    [
        ("truck_psva", "springs_friction"),
        ("truck_planetary_dmf", "dmf_friction"),
        ("truck_dmf_two_stage", "dmf_friction"),
        ("truck_dmf_pendulum", "dmf_friction"),
    ],
)
def test_every_absorber_with_one_row_of_springs_may_rub(name: str, washer: str) -> None:
    model = only(shipped(name), "absorber", friction_torque="30 Nm")
    spring, beside = model.components[washer.removesuffix("_friction")], model.components[washer]
    assert isinstance(spring, Coupling) and isinstance(beside, Coupling)
    assert (beside.a, beside.b) == (spring.a, spring.b)


def test_refused() -> None:
    with pytest.raises(ModelError, match=r"clutch.friction_stiffness.*goes with friction_torque"):
        only(TRUCK, "clutch", friction_stiffness=1e4)
    with pytest.raises(ModelError, match=r"absorber.friction_torque.*must not be negative"):
        only(TRUCK, "absorber", friction_torque=-1.0)
    with pytest.raises(ModelError, match=r"absorber.friction_torque.*two rows of springs.*friction_washer"):
        only(shipped("truck_dmf_tva"), "absorber", friction_torque=10.0)
    with pytest.raises(ModelError, match=r"absorber.friction_torque.*unknown"):
        only(shipped("truck_smf"), "absorber", friction_torque=10.0)


def test_washer_between_any_two_nodes() -> None:
    row = shipped("truck_dmf_tva")
    document = copy.deepcopy(dict(row.document))
    document["components"] = {
        "ring": {"type": "friction_washer", "a": "flange", "b": "primary", "friction_torque": "25 Nm", "damping": 2.0}
    }
    assert model_from_document(document).components["ring"] == Coupling(
        "flange", "primary", Jenkins(25.0, 25.0 / np.radians(0.1)), 2.0
    )
    document["components"]["ring"]["friction_torque"] = 0
    with pytest.raises(ModelError, match=r"components.ring.friction_torque.*must be positive"):
        model_from_document(document)


def test_files_with_washers_are_valid_and_expand_to_the_same_model() -> None:
    data = read_tree(EXAMPLES / "truck_dmf.yaml").data
    data = {**data, "clutch": {**data["clutch"], "friction_torque": "60 Nm", "friction_stiffness": 3e4}}
    validator = jsonschema.Draft202012Validator(json_schema())
    assert [error.message for error in validator.iter_errors(data)] == []
    assert list(validator.iter_errors({**data, "clutch": {**data["clutch"], "friction_torque": -1}}))
    document = expanded(RUBBING)
    assert [error.message for error in validator.iter_errors(document)] == []
    again = model_from_document(json.loads(json.dumps(document)))
    one, two = assemble(RUBBING.powertrain(12)), assemble(again.powertrain(12))
    assert one.connections.laws == two.connections.laws
    assert expanded(again) == document


@pytest.mark.parametrize("gear", ["1", "12"])
def test_stuck_washers_are_springs_in_linear_analyses(gear: str) -> None:
    """Against the truck whose springs are stiffer by as much: the same modes and vibration, the twist of its own."""
    stiffer = changed(TRUCK, {"clutch.stiffness": 25e3 + STUCK, "absorber.stiffness": 13e3 + 40.0 / np.radians(0.1)})
    stiffer = changed(stiffer, {"absorber.stop_torque": None, "absorber.stop_stiffness": None})
    rubbing = changed(RUBBING, {"absorber.stop_torque": None, "absorber.stop_stiffness": None})
    (system, point), (other, _) = at_operating_point(rubbing, 1800.0, gear), at_operating_point(stiffer, 1800.0, gear)
    twist = dict(zip(point.names, point.angle, strict=True))
    for spring, stiffness in (("clutch", 25e3), ("dmf", 13e3)):
        assert [twist[spring], twist[f"{spring}_friction"]] == pytest.approx([1800.0 / stiffness] * 2, rel=1e-12)
    assert point.torque[point.names.index("clutch_friction")] == 0.0
    found, expected = modal(system, 100.0), modal(other, 100.0)
    np.testing.assert_allclose(found.frequency, expected.frequency, rtol=1e-12)
    names = named_modes(found, rubbing.mode_groups)
    assert names == named_modes(expected, stiffer.mode_groups) and {"DMF mode", "clutch mode"} <= set(names)
    ways = [run_up_response(model, [70.0, 130.0], 1800.0, gear).angle for model in (rubbing, stiffer)]
    np.testing.assert_allclose(ways[0], ways[1], rtol=1e-9)
    grids = [response_map(model, [70.0, 130.0], [1800.0], [gear]).angle for model in (rubbing, stiffer)]
    np.testing.assert_allclose(grids[0], grids[1], rtol=1e-9)
    np.testing.assert_allclose(
        grids[0].squeeze("mean_torque").isel(gear=0).sel(node="primary"), ways[0].sel(node="primary")
    )


def test_lash_and_stages_of_the_clutch_beside_a_washer() -> None:
    """In the free play of a clutch without load the washer is all that holds the disc."""
    stages = [{"up_to": "150 Nm", "stiffness": 2e3}, {"stiffness": 25e3}]
    model = changed(RUBBING, {"clutch.stiffness": None, "clutch.stages": stages, "clutch.lash": "1 deg"})
    system = assemble(model.powertrain(12))
    for torque, twist, stiffness, stage in (
        (0.0, 0.0, 0.0, "free play"),
        (100.0, np.radians(0.5) + 0.05, 2e3, "stage 1"),
        (400.0, np.radians(0.5) + 0.075 + 0.01, 25e3, "stage 2"),
    ):
        point = mean_state(model, system, torque)
        at = point.names.index("clutch")
        assert (point.angle[at], point.stiffness[at]) == pytest.approx((twist, stiffness))
        assert (point.stage("clutch"), point.stage("clutch_friction")) == (stage, "sticks")
        linear = linearize(system, point).connections
        assert linear.stiffness[linear.names.index("clutch_friction")] == pytest.approx(STUCK)


def test_swing_at_which_a_washer_slips() -> None:
    """0.1° of half swing, from the angles of the bodies on either side."""
    found = run_up_response(RUBBING, np.linspace(600, 2000, 29) * RPM, None, 12)
    twist = found.angle.sel(node="secondary", drop=True) - found.angle.sel(node="clutch_disc", drop=True)
    half = swing(twist.assign_attrs(found.twist.attrs)).values
    mean = found.mean_twist.sel(element="clutch_friction").values
    law = RUBBING.components["clutch_friction"].law  # type: ignore[attr-defined]
    slips = law.changes_within(mean - half, mean + half)
    assert slips.tolist() == (half > np.radians(0.1)).tolist()
    assert slips.any() and not slips.all()
