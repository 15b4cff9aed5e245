"""The trucks that studies ask: the shipped one, and a user's own with the shipped absorbers scaled to it."""

from __future__ import annotations

import math

import pytest
from tests.shipped import shipped

from torsional.errors import ModelError
from torsional.files import changed, model_from_document
from torsional.model import Model
from torsional.powertrain import Powertrain
from torsional.solvers.equilibrium import equilibrium, linearize
from torsional.solvers.modal import modal
from torsional.studies import concepts
from torsional.studies.concepts import Scale
from torsional.studies.trucks import Trucks, stiffness
from torsional.system import assemble

FILES = {
    "smf": "smf",
    "dmf": "dmf",
    "psva": "psva",
    "tva": "dmf_tva",
    "planetary": "planetary_dmf",
    "pendulum": "dmf_pendulum",
    "two_stage": "dmf_two_stage",
    "arc_spring": "dmf_arc_spring",
}
CAR = shipped("passenger_car_dmf")


def absorber_speed(model: Model) -> float:
    """Order speed of a free absorber's lowest elastic mode over idle."""
    assert model.absorber is not None
    system = assemble(Powertrain(model.absorber.components))
    torque = {model.absorber.input: 0.3 * model.full_load_peak()}
    found = modal(linearize(system, equilibrium(system, torque, hold=model.absorber.output)))
    frequency = float(found.frequency.values[found.frequency.values > 1e-3].min())
    return 2 * math.pi * frequency / (model.running_engine.layout.cylinders / 2) / model.operation.idle


@pytest.mark.parametrize("concept", FILES)
def test_the_shipped_trucks_are_the_example_files(concept: str) -> None:
    truck, file = Trucks.shipped().models[concept], shipped(f"truck_{FILES[concept]}")
    assert (truck.name, truck.landmarks, truck.operation) == (file.name, file.landmarks, file.operation)
    assert repr(truck.components) == repr(file.components) and repr(truck.gears) == repr(file.gears)
    assert repr(truck.detail) == repr(file.detail)
    assert truck.running_engine == file.running_engine


def test_the_shipped_trucks_share_one_engine() -> None:
    assert len({id(model.engine) for model in Trucks.shipped().models.values()}) == 1


def test_the_scale_of_the_shipped_truck_is_one_to_the_bit() -> None:
    assert set(Scale.of(Trucks.shipped().smf).factors.values()) == {1.0}


def test_a_shipped_truck_as_a_users_gives_the_shipped_absorbers_again() -> None:
    trucks = Trucks.of(shipped("truck_psva"))
    for concept, model in Trucks.shipped().models.items():
        assert repr(trucks.models[concept].components) == repr(model.components), concept
    assert trucks.psva is shipped("truck_psva")
    assert trucks.origins["psva"] == concepts.OWN and "scaled" in trucks.origins["dmf"]


# Of the arc springs the tabs' stiffness is the file format's, whatever the size of the springs in series with it.
CLOSE = {"psva": 1e-9, "tva": 1e-9, "planetary": 1e-9, "pendulum": 1e-9, "arc_spring": 2e-3}


@pytest.mark.parametrize("concept", CLOSE)
def test_scaled_absorbers_meet_the_firing_order_at_the_same_multiples_of_idle(concept: str) -> None:
    car, truck = Trucks.of(CAR), Trucks.shipped()
    assert CAR.running_engine.layout.cylinders == 4 and CAR.full_load_peak() < 500.0
    speed = absorber_speed(truck.models[concept])
    assert absorber_speed(car.models[concept]) == pytest.approx(speed, rel=CLOSE[concept])


def test_scaled_damping_keeps_the_damping_ratio() -> None:
    def ratio(model: Model) -> float:
        block = model.document["absorber"]
        return block["damping"] / math.sqrt(block["secondary_inertia"] * block["primary_springs"]["stiffness"])

    assert ratio(Trucks.of(CAR).tva) == pytest.approx(40 / math.sqrt(26e3), rel=1e-9)


def test_torques_follow_the_peak_of_full_load() -> None:
    doubled = changed(shipped("truck_smf"), {"engine.full_load": {"speed": [60.0, 210.0], "torque": [5000.0, 5000.0]}})
    block = Trucks.of(doubled).two_stage.document["absorber"]
    assert [stage["up_to"] for stage in block["stages"]] == [2000.0, 7000.0]
    assert block["primary_inertia"] == 2.4 and block["damping"] == 40.0


OWN_BLOCKS = [
    ({"type": "single_mass_flywheel", "inertia": 1.5}, {"smf"}),
    ({"type": "dual_mass_flywheel", "primary_inertia": 1.5, "secondary_inertia": 0.8, "stiffness": 1e4}, {"dmf"}),
]


@pytest.mark.parametrize(("block", "own"), OWN_BLOCKS)
def test_the_users_own_absorber_is_kept(block: dict[str, object], own: set[str]) -> None:
    model = changed(shipped("truck_smf"), {"absorber": block})
    trucks = Trucks.of(model)
    assert {concept for concept, told in trucks.origins.items() if told == concepts.OWN} == own
    assert all(trucks.models[concept] is model for concept in own)


def test_a_pendulum_of_the_users_own_is_a_flywheel_without_it_too() -> None:
    model = shipped("truck_dmf_pendulum")
    trucks = Trucks.of(model)
    assert trucks.pendulum is model and repr(trucks.dmf.components) == repr(shipped("truck_dmf").components)
    assert trucks.origins["dmf"] == "yours without its pendulum"


def test_stages_of_the_users_own_are_the_two_stage_flywheel() -> None:
    model = changed(shipped("truck_dmf_two_stage"), "absorber.stages.0.stiffness=5 kNm/rad")
    trucks = Trucks.of(model)
    assert trucks.two_stage is model and stiffness(trucks.dmf, "dmf") == 13e3


def test_a_tuned_absorber_on_the_secondary_flywheel_is_no_flange_absorber() -> None:
    block = {"type": "dual_mass_flywheel_with_tuned_absorber", "on": "secondary", "primary_inertia": 1.0}
    block |= {"secondary_inertia": 1.0, "stiffness": 9e3, "tva": {"inertia": 0.2, "stiffness": 1e4}}
    trucks = Trucks.of(changed(shipped("truck_smf"), {"absorber": block}))
    assert stiffness(trucks.dmf, "dmf") == 9e3 and "tva" in trucks.tva.components
    assert "scaled" in trucks.origins["tva"]


def test_what_a_users_file_lacks_is_named() -> None:
    truck = shipped("truck_smf").document
    alone = {key: truck[key] for key in ("torsional", "name", "engine", "crankshaft", "absorber")}
    with pytest.raises(ModelError, match="studies of absorbers need a clutch block") as caught:
        Trucks.of(model_from_document(alone))
    assert caught.value.where == "clutch" and "'clutch'" in caught.value.remedy
    crankshaft = {**truck["crankshaft"], "throws": 6}
    document = {key: block for key, block in truck.items() if key != "engine"} | {"crankshaft": crankshaft}
    with pytest.raises(ModelError, match="studies of absorbers need an engine block") as caught:
        Trucks.of(model_from_document(document))
    assert caught.value.where == "engine"
    bare = {"torsional": 1, "name": "disc", "components": {"disc": {"type": "inertia", "inertia": 1.0}}}
    with pytest.raises(ModelError, match="studies of absorbers need an absorber block"):
        Trucks.of(model_from_document(bare))


def test_a_truck_without_full_load_or_file_is_refused() -> None:
    with pytest.raises(ModelError, match="full-load curve") as caught:
        Trucks.of(changed(shipped("truck_smf"), {"engine.full_load": None}))
    assert caught.value.where == "engine.full_load"
    with pytest.raises(ModelError, match="need the model's file"):
        Trucks.of(shipped("truck_smf").replaced("clutch", damping=1.0))


def test_what_hangs_on_the_users_own_absorber_is_told() -> None:
    ring = {"ring": {"type": "inertia", "inertia": 0.1}}
    ring |= {"spring": {"type": "shaft", "a": "secondary", "b": "ring", "stiffness": 1e4}}
    with pytest.raises(ModelError, match="secondary") as caught:
        Trucks.of(changed(shipped("truck_dmf"), {"components": ring}))
    assert "a single mass flywheel in its place" in caught.value.remedy
