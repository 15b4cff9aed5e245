"""A16 and the tool down-speeding: the move at equal power, the worst case, the match and the attainable speed."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from tests.shipped import shipped

from torsional.components import Inertia, Shaft
from torsional.engine.orders import HALF_ORDERS
from torsional.errors import ModelError
from torsional.model import Model
from torsional.plots.style import save_png
from torsional.quantities import acceleration, swing
from torsional.solvers.map import response_map
from torsional.studies.attaining import as_it_is, attained
from torsional.studies.base import Outcome
from torsional.studies.claims.down_speeding import a16
from torsional.studies.down_speeding import Bench, Worst, cruise_speed, final_drive, moved, worst
from torsional.studies.matching import COARSE, concepts, matched, one_stage, turned
from torsional.studies.tools.down_speeding import down_speeding
from torsional.studies.trucks import Trucks, joined, replaced, stiffness
from torsional.system import assemble
from torsional.units import RPM

BY = 100 * RPM


@pytest.fixture(scope="module")
def car() -> Trucks:
    return Trucks.of(shipped("passenger_car_dmf"))


def vehicle_speed(model: Model, gear: str, engine: float) -> float:
    system = assemble(model.powertrain(gear))
    return float(engine * system.speed_ratio[system.node_index(model.landmarks.load)])


# the move


@pytest.mark.parametrize("by", [37.0, 100.0, 200.0])
def test_power_is_equal_at_every_speed(trucks: Trucks, by: float) -> None:
    down = moved(trucks.dmf, by * RPM)
    points = np.array([650.0, 800, 900, 1300, 1500, 1700, 1900, 1999]) * RPM
    n = np.concatenate([points, np.linspace(600 + by, 2000, 333) * RPM])
    power = trucks.dmf.full_load(n) * n
    assert down.full_load(n - by * RPM) * (n - by * RPM) == pytest.approx(power, abs=5e-6 * power.max())
    corners = np.asarray(trucks.dmf.full_load_curve.speeds)[:-1]  # the last has no power
    found = down.full_load(corners - by * RPM) * (corners - by * RPM)
    assert found == pytest.approx(trucks.dmf.full_load(corners) * corners, rel=1e-12)


def test_the_peak_by_hand(trucks: Trucks) -> None:
    """2500 Nm from 900 rpm on: 100 rpm down 2500 · 900/800 at 800 rpm."""
    assert moved(trucks.dmf, BY).full_load_peak() == pytest.approx(2812.5, rel=1e-12)
    assert float(moved(trucks.dmf, BY).full_load(600 * RPM)) == pytest.approx(1600 * 700 / 600, rel=1e-9)


@pytest.mark.parametrize("gear", ["1", "7", "12"])
def test_the_vehicle_goes_as_fast_at_cruise(trucks: Trucks, gear: str) -> None:
    at = cruise_speed(trucks.smf)
    assert at == pytest.approx(1300 * RPM, rel=1e-12)
    before, after = vehicle_speed(trucks.smf, gear, at), vehicle_speed(moved(trucks.smf, BY), gear, at - BY)
    assert after == pytest.approx(before, rel=1e-12)
    other = vehicle_speed(moved(trucks.smf, BY, 1100 * RPM), gear, 1000 * RPM)
    assert other == pytest.approx(vehicle_speed(trucks.smf, gear, 1100 * RPM), rel=1e-12)


def test_top_gear_cruises_at_the_usual_speed(trucks: Trucks) -> None:
    assert 3.6 * 0.5 * vehicle_speed(trucks.smf, "12", cruise_speed(trucks.smf)) == pytest.approx(86.0, abs=0.5)


def test_the_range_moves_and_idle_stays(trucks: Trucks) -> None:
    down = moved(trucks.dmf, BY)
    assert down.operation.idle == trucks.dmf.operation.idle
    assert down.operation.speed == pytest.approx((600 * RPM, 1900 * RPM), rel=1e-12)


def test_no_move_is_the_same_truck_to_the_bit(trucks: Trucks) -> None:
    assert moved(trucks.psva, 0.0) is trucks.psva
    assert (Bench(moved(trucks.psva, 0.0)).worst().by_gear == worst(trucks.psva).by_gear).all()


def test_final_drives(trucks: Trucks) -> None:
    assert final_drive(trucks.dmf) == "final_drive"
    with pytest.raises(ModelError, match="no final drive"):
        shaft = replaced(trucks.dmf, "final_drive", Shaft("axle", "differential", 1e6))
        final_drive(joined(shaft, differential=Inertia(0.1)))


@pytest.mark.parametrize("by", [-10.0, 701.0, 5000.0])
def test_moves_that_cannot_be(trucks: Trucks, by: float) -> None:
    with pytest.raises(ModelError, match="cannot move down so far"):
        moved(trucks.dmf, by * RPM)


# the worst


@pytest.mark.parametrize("concept", ["smf", "dmf", "psva", "tva", "two_stage", "planetary", "pendulum"])
def test_accelerations_against_the_map(trucks: Trucks, concept: str) -> None:
    """Reciprocity and shared tangents against a forward solution at each operating point, from idle into the stops."""
    model = moved(trucks.models[concept], 300 * RPM)
    bench = Bench(model, 50 * RPM)
    found = bench.accelerations()[0][0, ..., 0]
    for load, place in itertools.product(range(5), (0, 3, 11, len(bench.speed) - 1)):
        speed, torque = bench.speed[place], bench.torque[load, place]
        there = response_map(model, [speed], [torque], orders=[3.0], nodes=[model.landmarks.input], elements=[])
        expected = acceleration(there.angle).values.ravel()
        assert found[:, load, place] == pytest.approx(expected, rel=1e-8)


def test_worst_against_brute_force(trucks: Trucks) -> None:
    """No cell of a fine map within full load is above the worst, and one is right at it."""
    model = moved(trucks.dmf, BY)
    speed = np.arange(600, 1901, 10) * RPM
    found = response_map(model, speed, model.torques(60), orders=[3.0], nodes=[model.landmarks.input], elements=[])
    inside = found.within_full_load.astype(bool)
    cells = abs(acceleration(found.angle.isel(node=0, order=0))).where(inside).max(("mean_torque", "speed")).values
    own = worst(model)
    assert (cells <= own.by_gear * (1 + 1e-9)).all()
    assert cells == pytest.approx(own.by_gear, rel=0.03)
    assert own.acceleration == own.by_gear.max() and own.gear == model.gear_names[int(own.by_gear.argmax())]


def test_swing_of_all_half_orders(trucks: Trucks) -> None:
    bench = Bench(trucks.dmf, 400 * RPM, (1.0,), orders=HALF_ORDERS.tolist())
    speed, torque = bench.speed[1], bench.torque[0, 1]
    there = response_map(trucks.dmf, [speed], [torque], nodes=["gearbox_input"], elements=[])
    expected = float(swing(acceleration(there.angle), 180).sel(gear="5").item())
    one = bench.accelerations()[0][0, 4, 0, 1]
    phase = np.exp(1j * np.outer(np.linspace(0, 4 * np.pi, 180, endpoint=False), HALF_ORDERS))
    assert 0.5 * np.ptp((phase @ one).real) == pytest.approx(expected, rel=1e-6)


def test_reach_by_twist_of_the_map(trucks: Trucks) -> None:
    """Mean twist and its swing over the way to the stop, from the angles of both flywheels."""
    bench = Bench(trucks.dmf, 50 * RPM, (1.0,))
    stop, highest = 3500 / 13e3, 0.0
    for speed, torque in zip(bench.speed, bench.torque[0], strict=True):
        there = response_map(
            trucks.dmf, [speed], [torque], gears=["12"], orders=[3.0], nodes=["primary", "secondary"], elements=["dmf"]
        )
        angle = there.angle.values.ravel()
        highest = max(highest, (abs(float(there.mean_twist.item())) + abs(angle[0] - angle[1])) / stop)
    assert Bench(trucks.dmf, 50 * RPM, (1.0,), gears=["12"]).worst().reach == pytest.approx(highest, rel=1e-8)


@pytest.mark.parametrize("name", ["SMF", "DMF", "PSVA", "DMF with TVA"])
def test_designs_are_the_trucks_that_they_describe(trucks: Trucks, name: str) -> None:
    concept = concepts(trucks)[name]
    places = [place for knob in concept.knobs for place in knob.places]
    factors = {place: np.array([1.0, 0.9 + 0.05 * i]) for i, place in enumerate(places)}
    found, reach = Bench(concept.model, 100 * RPM).accelerations(factors)
    other = Bench(turned(concept.model, {place: value[1] for place, value in factors.items()}), 100 * RPM)
    expected, far = other.accelerations()
    assert found[1] == pytest.approx(expected[0], rel=1e-9)
    assert reach[1] == pytest.approx(far[0], rel=1e-9)


def test_moving_down_costs_vibration(trucks: Trucks) -> None:
    """More torque at each speed, and lower speeds: the worst rises with every step while no spring is at its stop."""
    for model in (trucks.smf, trucks.dmf, trucks.psva):
        sizes = [worst(moved(model, by * RPM)).acceleration for by in (0, 30, 60, 100)]
        assert (np.diff(sizes) > 0).all()


# the match


def test_inertias_of_concepts(trucks: Trucks) -> None:
    known = concepts(trucks)
    assert [known[name].inertia for name in known] == pytest.approx([1.9, 2.2, 2.41, 2.5])
    for concept in known.values():
        assert concept.sized(3.3).inertia == pytest.approx(3.3, rel=1e-12)
    tva = known["DMF with TVA"]
    ring, spring = (tva.sized(4.0).model.components[name] for name in ("tva", "tva_spring"))
    assert spring.stiffness / ring.inertia == pytest.approx((3 * 650 * RPM) ** 2, rel=1e-9)


def test_one_stage_on_the_same_way(trucks: Trucks) -> None:
    """1000 Nm on 8 kNm/rad and 2500 Nm on 24 kNm/rad: 3500 Nm on 1/8 + 2.5/24 rad."""
    model = one_stage(trucks.two_stage, "dmf")
    assert stiffness(model, "dmf") == pytest.approx(3500 / (1 / 8 + 2.5 / 24), rel=1e-9)
    assert max(model.components["dmf"].law.stops) == pytest.approx(1 / 8 + 2.5 / 24, rel=1e-9)


@pytest.mark.parametrize(("name", "by", "count"), [("SMF", 100, 21), ("DMF", 100, 15), ("PSVA", 100, 9)])
def test_match_against_a_brute_grid(trucks: Trucks, name: str, by: float, count: int) -> None:
    """No design on an even grid between the limits, its springs off their stops, is better than the match."""
    concept = concepts(trucks)[name]
    found = matched(concept, by * RPM)
    own = Bench(found.model, COARSE).worst()
    assert own.reach < 1.002
    truck = moved(concept.model, by * RPM)
    rise = truck.full_load_peak() / concept.model.full_load_peak()
    lows = [knob.low * (rise if knob.name == "clutch stiffness" else 1.0) for knob in concept.knobs]
    ends = [
        (0.5, 1.5) if knob.name == "springs" else (low, knob.high)
        for low, knob in zip(lows, concept.knobs, strict=True)
    ]
    axes = [np.geomspace(*pair, count) for pair in ends]
    grid = np.array(list(itertools.product(*axes)))
    spots = {place: grid[:, i] for i, knob in enumerate(concept.knobs) for place in knob.places}
    sizes, reach = Bench(truck, COARSE, (1.0,)).accelerations(spots)
    best = np.abs(sizes[..., 0]).max(axis=(1, 2, 3))[reach < 1.0].min()
    assert own.acceleration < 1.005 * best
    assert own.acceleration > 0.75 * best  # the grid is coarse, not blind
    for knob, low in zip(concept.knobs, lows, strict=True):
        assert low * (1 - 1e-9) <= found.factors[knob.name] <= knob.high * (1 + 1e-9)


def test_the_matched_spring_is_as_soft_as_its_way_allows(trucks: Trucks) -> None:
    model = matched(concepts(trucks)["DMF"], BY).model
    assert worst(model).reach == pytest.approx(1.0, abs=0.01)
    assert stiffness(model, "dmf") > 2812.5 / (3500 / 13e3)


def test_a_match_is_the_same_again(trucks: Trucks) -> None:
    concept = concepts(trucks)["SMF"]
    assert matched(concept, BY).factors == matched(concept, BY).factors


# what is attainable


def of(size: float, reach: float = 0.0) -> Worst:
    return Worst(size, "1", 0.0, 0.0, np.array([size]), np.array([0.0]), reach)


def test_attained_by_closed_form() -> None:
    rises = attained(lambda by: of(100.0 + by), 120.0, 30.0)
    assert rises == pytest.approx(20.0, abs=2.0 * RPM)
    assert np.isnan(attained(lambda by: of(100.0 + by), 99.0, 30.0))
    assert attained(lambda by: of(100.0 + by), 200.0, 30.0) == 30.0
    assert attained(lambda by: of(100.0 + by), 100.0, 30.0) == pytest.approx(0.0, abs=1e-6)


def test_attained_until_the_springs_meet_their_stop() -> None:
    assert attained(lambda by: of(100.0, 0.9 + 0.01 * by), 120.0, 30.0) == pytest.approx(10.5, abs=2.1 * RPM)


def test_attained_keeps_the_limit(trucks: Trucks) -> None:
    limit = worst(trucks.dmf).acceleration
    look = as_it_is(concepts(trucks)["PSVA"])
    found = attained(look, limit, 300 * RPM)
    assert found / RPM == pytest.approx(108, abs=3)
    assert look(found - 3 * RPM).acceleration < limit < look(found + 3 * RPM).acceleration


# claim and tool


def test_a16_figures(outcomes: dict[str, Outcome]) -> None:
    outcome = outcomes["A16"]
    figures = outcome.finding.figures
    assert figures["SMF, moved, over range of today [-]"] == pytest.approx(1.295, abs=0.01)
    assert figures["matched DMF, moved, over SMF in the range of today [-]"] == pytest.approx(0.19, abs=0.01)
    assert figures["matched DMF, moved, over DMF as it is in the range of today [-]"] < 0.92
    assert figures["matched DMF, moved: worst in"] == "gear 1, 600 rpm, 1867 Nm"
    by_gear = np.asarray(figures["matched DMF, moved, over SMF in the range of today, by gear [-]"])
    assert by_gear.size == 12 and by_gear.max() < 0.25
    ratio = figures["swing over the cycle: matched DMF, moved, over SMF in the range of today [-]"]
    assert ratio == pytest.approx(figures["matched DMF, moved, over SMF in the range of today [-]"], rel=0.05)
    data = outcome.finding.dataset
    assert data is not None and a16.picture is not None
    assert len(save_png(a16.picture(data))) > 10_000


def test_four_cylinders_and_six_gears(car: Trucks) -> None:
    outcome = a16(car)
    assert (
        len(np.ravel(outcome.finding.figures["matched DMF, moved, over SMF in the range of today, by gear [-]"])) == 6
    )
    assert outcome.finding.reproduced
    model = car.dmf
    bench = Bench(moved(model, BY), 200 * RPM, (1.0,))
    there = response_map(
        bench.model, [bench.speed[1]], [bench.torque[0, 1]], orders=[2.0], nodes=[model.landmarks.input], elements=[]
    )
    expected = acceleration(there.angle).values.ravel()
    assert bench.accelerations()[0][0, :, 0, 1, 0] == pytest.approx(expected, rel=1e-8)


def test_tool(trucks: Trucks) -> None:
    data = down_speeding(trucks, by=(BY,), cap=150 * RPM, inertias=(5.5,))
    at = {"concept": "DMF", "design": "as it is"}
    assert float(data.worst.sel(at).isel(by=0)) == data.attrs["limit"] == worst(trucks.dmf).acceleration
    assert float(data.attainable.sel(at)) == pytest.approx(0.0, abs=1e-6)
    assert np.isnan(data.attainable.sel(concept="SMF").values).all()
    assert float(data.attainable.sel(concept="PSVA", design="matched")) == 150 * RPM
    assert data.worst_gear.sel(concept="SMF", design="as it is").values.tolist() == ["1", "8"]
    assert (data.worst.sel(design="matched") < data.worst.sel(design="as it is")).all()
    chart = data.attainable_by_inertia.isel(inertia=0)
    assert float(chart.sel(concept="SMF")) / RPM == pytest.approx(105, abs=3)
    assert "above the limit even in the range of today" in data.attrs["findings"]
    assert "150 rpm and more" in data.attrs["findings"] and "28 bar" in data.attrs["findings"]
    assert len(save_png(down_speeding.picture(data))) > 10_000


def test_tool_without_chart(car: Trucks) -> None:
    data = down_speeding(car, by=(BY,), no_chart=True, cap=BY)
    assert data.inertia.size == 0 and data.gear.size == 6
    assert len(save_png(down_speeding.picture(data))) > 10_000
