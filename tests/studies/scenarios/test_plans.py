"""From a scenario to what is stepped: schedules, starter, governor, linings and lines, without a time step."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.shipped import ROOT, shipped

from torsional import ModelError, assemble
from torsional.components.slip_clutch import SlipClutch
from torsional.files.scenario import load_scenario
from torsional.files.scenario_blocks import Starter
from torsional.files.scenario_schema import KINDS
from torsional.model import Model
from torsional.solvers.transient.drives import Governor
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.studies.scenarios import lines as line
from torsional.studies.scenarios import planned
from torsional.studies.scenarios.figures import contacts
from torsional.studies.scenarios.schedule import heat_for, pulse, ramp, starter_motor
from torsional.studies.scenarios.starting import resting
from torsional.units import RPM


@pytest.fixture(scope="module")
def truck() -> Model:
    return shipped("truck_dmf")


def torque_of(governor: Governor, speed: float, time: float) -> float:
    """What a governor without memory gives at a speed [rad/s], by its definition."""
    wanted = governor.wanted if isinstance(governor.wanted, SpeedProfile) else SpeedProfile.constant(governor.wanted)
    asked = governor.proportional * (float(wanted.at(time)) - speed)
    return min(max(asked, governor.low), governor.high)


def test_the_starter_falls_with_speed_never_brakes_and_is_switched_off(truck: Model) -> None:
    block = Starter.model_validate({"speed": 25.0, "until": 1.0})
    starter = starter_motor(block, "primary", 1200.0)
    at = [torque_of(starter, speed, 0.5) for speed in (-5.0, 0.0, 10.0, 25.0, 60.0)]
    # 1200 (1 − 10/25) = 720
    assert at == pytest.approx([1200.0, 1200.0, 720.0, 0.0, 0.0])
    assert [torque_of(starter, speed, 1.01) for speed in (-5.0, 0.0, 20.0)] == [0.0, 0.0, 0.0]


def test_schedules_are_knots() -> None:
    times, values = pulse(1.0, 0.5, 7.0)
    assert np.interp([0.9, 1.2, 1.6], times, values).tolist() == [0.0, 7.0, 0.0]
    assert np.interp([0.0, 0.325, 1.0], *ramp(0.3, 0.05, -1.0, 1.0)).round(12).tolist() == [-1.0, 0.0, 1.0]


def test_heat_in_proportion_gives_the_torque(truck: Model) -> None:
    assert truck.engine is not None
    motored = float(truck.engine.motored_torque(100.0))
    most, (none, half, all_) = heat_for(truck, 100.0, [motored, 0.5 * (1000.0 + motored), 1000.0])
    assert (most, none, half, all_) == pytest.approx((1000.0, 0.0, 0.5, 1.0))
    with pytest.raises(ModelError, match="no engine brakes so much"):
        heat_for(truck, 100.0, [1.5 * motored])


def test_an_engine_rests_where_compression_pushes_it_back(truck: Model) -> None:
    motor = planned(load_scenario("engine_start"), truck).drives[0]
    at, gas = resting(motor), motor.profiles()[0]  # type: ignore[arg-type,attr-defined]
    torque = [sum(float(p.at(at + d) - p.mean) for p in gas) for d in (-0.05, 0.0, 0.05)]
    assert torque[0] > 10 > abs(torque[1]) > -10 > torque[2]
    # six cylinders evenly fired: half way between two compressions, 60 degrees after one
    assert np.rad2deg(at) % 120 == pytest.approx(60.0, abs=6.0)


def test_neutral_leaves_out_all_behind_the_gears(truck: Model) -> None:
    nodes = set(line.in_neutral(truck).nodes)
    assert {"gearbox_mesh", "gearbox_input", "throw1", "secondary"} <= nodes
    assert not {"gearbox_output", "wheels", "vehicle"} & nodes


@pytest.mark.parametrize("kind", KINDS)
def test_plans_keep_every_inertia_of_the_line(truck: Model, kind: str) -> None:
    """What a scenario adds is small: the rest is the model's own line."""
    plan = planned(load_scenario(kind), truck)
    names = set(plan.line.components)
    whole = set(
        line.in_neutral(truck).components
        if plan.gear == "neutral"
        else truck.powertrain(plan.gear.split()[0]).components
    )
    added = names - whole
    assert whole <= names
    assert added <= {line.LINING, line.LININGS, line.BRAKE, line.PATCH, line.ROAD, line.RESISTANCE}
    assert plan.springs == ("dmf",)


def test_linings_stand_between_flywheel_and_damper(truck: Model) -> None:
    block = load_scenario("clutch_engagement", ["clutch.capacity=3000 Nm"])
    plan = planned(block, truck)
    clutch, linings = plan.line["clutch"], plan.line[line.LININGS]
    assert (clutch.b, linings.a, linings.b) == (line.LINING, line.LINING, "secondary")
    assert linings.capacity == pytest.approx(3000.0)
    assert {"primary", "secondary", "throw1"}.isdisjoint(plan.lagging)
    assert {"clutch_lining", "gearbox_input", "vehicle"} <= plan.lagging


def test_a_shift_starts_with_the_speeds_of_the_old_gear(truck: Model) -> None:
    plan = planned(load_scenario("gear_shift", ["from_gear=11", "to_gear=12", "speed=1400 rpm"]), truck)
    system = assemble(plan.line)
    vehicle = system.T[system.node_index("vehicle")]
    # the vehicle turns by 1.27 and 2.85 slower than the engine, vibration of a hundredth of a per cent on top
    assert vehicle @ (plan.started(system).speed + plan.speed) == pytest.approx(1400 * RPM / 1.27 / 2.85, rel=1e-4)
    assert [span.at for span in plan.later] == pytest.approx([0.55, 0.8])
    neutral, new = (span.line for span in plan.later)
    assert neutral["synchroniser"].ratio == new["gear"].ratio == 1.0  # type: ignore[attr-defined]
    assert plan.line["gear"].ratio == pytest.approx(1.27)  # type: ignore[attr-defined]


def test_linings_that_stick_carry_the_mean_torque_from_the_start(truck: Model) -> None:
    plan = planned(load_scenario("traction_loss", ["gear=7", "torque=1500 Nm"]), truck)
    system = assemble(plan.line)
    state = plan.started(system)
    assert not isinstance(state, str)
    place = system.connections.names.index(line.ROAD)
    carried = state.memory[place] * plan.line[line.ROAD].stiffness
    # 1500 Nm through gear 7 (3.44) and the axle (2.85), vibration of a few per cent on top
    assert carried == pytest.approx(1500 * 3.44 * 2.85, rel=0.05)


BAD = [
    ("tip_in", "after=-100 Nm", ["after", "the other way", "tip_out"]),
    ("tip_out", "after=2000 Nm", ["after", "less than before", "tip_in"]),
    ("tip_in", "gear=13", ["gear", "there is no gear '13'", "allowed: 1, 2"]),
    ("tip_in", "after=4000 Nm", ["after", "would rest on its stop", "4000 Nm", "up to 3500 Nm"]),
    ("clutch_engagement", "torque=3600 Nm", ["torque", "stop", "3600 Nm"]),
    ("tip_out", "after=-3000 Nm", ["no engine brakes so much", "-3000 Nm"]),
    ("gear_shift", "to_gear=11", ["to_gear", "stays the same"]),
    ("gear_shift", "from_gear=13", ["from_gear", "there is no gear '13'", "allowed: 1, 2"]),
    ("gear_shift", "from_gear=1", ["to_gear", "too slowly in gear '12'", "93.7", "600 rpm to 2000 rpm"]),
    ("gear_shift", "to_gear=9", ["to_gear", "too fast in gear '9'", "to 2000 rpm"]),
    ("gear_shift", "clutch.capacity=900 Nm", ["before", "clutch would slip", "1000 Nm", "up to 900 Nm"]),
    ("stall", "node=whels", ["node", "did you mean 'wheels'?"]),
    ("traction_loss", "tyres=tires", ["tyres", "did you mean 'tyres'?"]),
    ("clutch_engagement", "vehicle_at=1500 rpm", ["vehicle_at", "1500 rpm", "up to 1000 rpm"]),
    ("idle_pulse", "node=vehicle", ["node", "neutral"]),
]


@pytest.mark.parametrize(("kind", "change", "told"), BAD, ids=[change for _, change, _ in BAD])
def test_what_the_model_has_not_is_refused(truck: Model, kind: str, change: str, told: list[str]) -> None:
    with pytest.raises(ModelError) as caught:
        planned(load_scenario(kind, [change]), truck)
    assert [part for part in told if part not in str(caught.value)] == []


def test_a_machine_without_clutch_or_engine_says_so(truck: Model) -> None:
    bare = truck.replaced(engine=None)
    with pytest.raises(ModelError, match="no engine"):
        planned(load_scenario("engine_start"), bare)
    marine = shipped("marine_line")
    with pytest.raises(ModelError, match="gears: a shift needs two gears"):
        planned(load_scenario("gear_shift"), marine)
    with pytest.raises(ModelError, match="name the one between wheels and vehicle by the key 'tyres'"):
        planned(load_scenario("stall", ["brake=5 kNm"]), marine)
    with pytest.raises(ModelError):
        planned(load_scenario("clutch_engagement"), marine)


def test_linings_carry_their_capacity_while_they_slide() -> None:
    linings = SlipClutch("disc", "cover", clamp_force=20e3, radius=0.18, friction=0.35, surfaces=2, breakaway=1.2)
    assert linings.capacity == pytest.approx(0.35 * 20e3 * 2 * 0.18)
    fast = float(linings.law.loaded(linings.clamp_force).steady(50.0))
    assert fast == pytest.approx(linings.capacity)
    slow = float(linings.law.loaded(linings.clamp_force).steady(1e-6))
    assert slow == pytest.approx(1.2 * linings.capacity)


@pytest.mark.parametrize("path", sorted((ROOT / "examples" / "scenarios").glob("*.yaml")), ids=lambda path: path.stem)
def test_examples_are_what_holds_for_the_truck_without_them(truck: Model, path: Path) -> None:
    """Torques that are left out follow from the model: for the shipped truck they are those of the examples."""
    shown, usual = planned(load_scenario(path), truck), planned(load_scenario(path.stem), truck)
    assert (shown.speed, shown.duration, shown.lag) == pytest.approx((usual.speed, usual.duration, usual.lag))
    assert shown.levels == usual.levels
    for name, (knots, _) in shown.shown.items():
        assert np.array(knots[1]) == pytest.approx(np.array(usual.shown[name][0][1])), name
    for mine, other in zip(shown.drives, usual.drives, strict=True):
        assert getattr(mine, "torque", 0.0) == pytest.approx(getattr(other, "torque", 0.0))
        assert getattr(mine, "high", 0.0) == pytest.approx(getattr(other, "high", 0.0))
    for part in ("brake", "road", "clutch_linings", "clutch_lining"):
        if part in shown.line.components:
            pairs = zip(vars(shown.line[part]).values(), vars(usual.line[part]).values(), strict=True)
            assert all(a == (pytest.approx(b) if isinstance(b, float) else b) for a, b in pairs), part


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_suits_a_car_as_well(kind: str) -> None:
    """Usual torques are shares of full load: none rests on the stop of a car's flywheel."""
    car = shipped("passenger_car_dmf")
    plan = planned(load_scenario(kind), car)
    assert plan.duration > 0
    if "clutch_linings" in plan.line.components:
        assert plan.line["clutch_linings"].capacity == pytest.approx(1.4 * 380)


def test_contacts_count_every_arrival_on_either_side() -> None:
    swing = np.array([[0.0], [0.2], [0.3], [0.0], [-0.2], [0.0], [0.11]])
    assert contacts(swing, np.array([[-0.1, 0.1]])).tolist() == [3]
    assert contacts(swing, np.array([[np.nan, np.nan]])).tolist() == [0]
