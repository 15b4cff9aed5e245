"""The whole of a gear shift against momentum, energy and ratios worked out by hand."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from tests.shipped import shipped

from torsional import load_scenario, run_scenario
from torsional.model import Model
from torsional.units import RPM

ROAD, AXLE = 8000.0, 2.85
"""Resistance [Nm] at the vehicle, an uphill of 4 %, and ratio of the axle."""
INPUT = {"clutch_lining": 0.03, "clutch_disc": 0.09, "gearbox_input": 0.12, "gearbox_mesh": 0.15}
OUTPUT = {"gearbox_output": 0.25, "axle": 0.3}
WHEELS = {"wheels": 70.0, "vehicle": 40e3 * 0.5**2}
ENGINE = {
    "damper_ring": 0.3,
    "damper_hub": 0.1,
    **{f"throw{i}": 0.11 for i in range(1, 7)},
    "primary": 1.2,
    "secondary": 1.0,
}
"""Inertias of the model file [kgm²]."""


@pytest.fixture(scope="module")
def truck() -> Model:
    return shipped("truck_dmf")


@pytest.fixture(scope="module")
def up(truck: Model) -> xr.Dataset:
    """Gear 11, 1.27, to gear 12, direct."""
    return run_scenario(truck, load_scenario("gear_shift", [f"road_load={ROAD} Nm"]))


@pytest.fixture(scope="module")
def down(truck: Model) -> xr.Dataset:
    """The other way."""
    return run_scenario(truck, load_scenario("gear_shift", ["from_gear=12", "to_gear=11"]))


def momentum(run: xr.Dataset, inertias: dict[str, float], time: float) -> float:
    """Σ J ω [Nms]."""
    at = run.angular_velocity.sel(time=time, method="nearest")
    return float(sum(inertia * at.sel(node=node) for node, inertia in inertias.items()))


def behind(run: xr.Dataset, time: float, gear: float) -> float:
    """Momentum of all behind the linings as at the wheels [Nms], the gearbox input through a gear."""
    at_wheels = AXLE * (gear * momentum(run, INPUT, time) + momentum(run, OUTPUT, time))
    return at_wheels + momentum(run, WHEELS, time)


def mean_speed(run: xr.Dataset, node: str, begin: float, end: float) -> float:
    return float(run.angular_velocity.sel(node=node, time=slice(begin, end)).mean())


def test_the_vehicle_neither_jumps_nor_gains(up: xr.Dataset, down: xr.Dataset) -> None:
    for run in (up, down):
        vehicle = run.angular_velocity.sel(node="vehicle")
        highest = float(np.abs(run.acceleration.sel(node="vehicle")).max())
        assert float(np.abs(np.diff(vehicle)).max()) <= 1.01 * highest * 2e-4
        assert (np.diff(run.time.values) > 0).all()


def test_the_road_slows_what_the_open_clutch_leaves_alone(up: xr.Dataset) -> None:
    """Momentum of all behind the linings falls by road load times time; of the vehicle alone nearly so."""
    lost = behind(up, 1.19, 1.0) - behind(up, 0.82, 1.0)
    assert lost == pytest.approx(-ROAD * 0.37, rel=1e-3)
    equivalent = sum(WHEELS.values()) + AXLE**2 * (sum(OUTPUT.values()) + sum(INPUT.values()))
    slower = mean_speed(up, "vehicle", 1.0, 1.2) - mean_speed(up, "vehicle", 0.8, 1.0)
    assert slower == pytest.approx(-ROAD * 0.2 / equivalent, rel=0.03)


def test_momentum_goes_through_the_cones(up: xr.Dataset) -> None:
    """What the input loses over the ratio the wheels gain, but for the road."""
    assert behind(up, 0.799, 1.0) - behind(up, 0.551, 1.0) == pytest.approx(-ROAD * 0.248, rel=1e-3)
    cones = up.torque.sel(element="synchroniser", time=slice(0.551, 0.799))
    given = momentum(up, INPUT, 0.799) - momentum(up, INPUT, 0.551)
    assert given == pytest.approx(-float(cones.integrate("time")), rel=1e-3)
    slip = up.angular_velocity.sel(node="gearbox_mesh") - up.angular_velocity.sel(node="gearbox_output")
    before = float(slip.sel(time=0.55, method="nearest"))
    assert before == pytest.approx(1400 * RPM * (1 - 1 / 1.27), rel=0.02)
    # ½ J Δω² of the input, all but all of it being lost beside a vehicle of a thousand times its inertia
    rubbed = float(up.friction_loss.sel(rubbing="synchroniser")[-1])
    assert rubbed == pytest.approx(0.5 * sum(INPUT.values()) * before**2, rel=0.03)


@pytest.mark.parametrize("kind", ["up", "down"])
def test_speeds_keep_to_the_gears(kind: str, request: pytest.FixtureRequest) -> None:
    run, gears = request.getfixturevalue(kind), (1.27, 1.0) if kind == "up" else (1.0, 1.27)
    for gear, begin, end in ((gears[0], 0.0, 0.171), (gears[1], 2.28, 2.5)):
        engine, vehicle = (mean_speed(run, node, begin, end) for node in ("primary", "vehicle"))
        assert engine / vehicle == pytest.approx(gear * AXLE, rel=3e-3)
    synchronised = mean_speed(run, "gearbox_input", 1.0, 1.2) / mean_speed(run, "vehicle", 1.0, 1.2)
    assert synchronised == pytest.approx(gears[1] * AXLE, rel=3e-3)
    late = run.phase_speed.sel(phase="clutch open", node=["primary", "vehicle"]).values
    if kind == "down":  # the governor has brought the engine there; up it waits for its friction
        assert late[0] / late[1] == pytest.approx(1.27 * AXLE, rel=0.01)


def kinetic(run: xr.Dataset) -> np.ndarray:
    """½ Σ J ω² [J] of all that turns, from the model file."""
    parts = ENGINE | INPUT | OUTPUT | WHEELS
    # the linings have a third of the disc's inertia and are beside it
    found = sum(0.5 * j * run.angular_velocity.sel(node=node).values ** 2 for node, j in parts.items())
    return np.asarray(found - found[0])


@pytest.mark.parametrize("kind", ["up", "down"])
def test_the_ledger_closes_over_the_whole_shift(kind: str, request: pytest.FixtureRequest) -> None:
    run = request.getfixturevalue(kind)
    share = {str(name): run.energy.sel(share=name).values for name in run.share.values}
    gone = sum(share[name] for name in ("dampers", "contacts", "friction", "engaging"))
    gained = kinetic(run) + share["strain"] - share["strain"][0]
    np.testing.assert_allclose(gained, share["sources"] - gone + share["method"], atol=1e-6 * np.abs(gained).max())
    parts = run.friction_loss.isel(time=-1)
    assert {"clutch_linings", "synchroniser"} <= set(parts.rubbing.values)
    assert float(parts.sum()) == pytest.approx(share["friction"][-1], rel=1e-9)
    assert 0 <= share["engaging"][-1] < 1e-3 * float(parts.sel(rubbing="synchroniser"))
    assert "unsynchronised" not in run.attrs


def test_work_of_the_road_is_in_the_sources(truck: Model) -> None:
    """Two runs that differ by the road alone: it took its torque over the angle of the vehicle."""
    roads, gave, took = (1.0, ROAD), [], []
    for road in roads:
        run = run_scenario(truck, load_scenario("gear_shift", ["before=0 Nm", "torque=0 Nm", f"road_load={road} Nm"]))
        gave.append(float(run.energy.sel(share="sources")[-1]))
        took.append(road * float(run.angular_velocity.sel(node="vehicle").integrate("time")))
    assert gave[0] - gave[1] == pytest.approx(took[1] - took[0], rel=0.01)


def test_weak_cones_leave_an_impact(truck: Model) -> None:
    """Mesh and output meet as in a plastic impact: ½ J₁ J₂/(J₁ + J₂) Δω² is lost at once, no momentum is."""
    run = run_scenario(truck, load_scenario("gear_shift", ["synchroniser.torque=20 Nm"]))
    assert "before its synchroniser was done" in run.attrs["unsynchronised"]
    speeds = run.angular_velocity.sel(node=["gearbox_mesh", "gearbox_output"])
    earlier, later = (speeds.isel(time=int(np.searchsorted(run.time, 0.8 - 1e-6)) + k).values for k in (0, 1))
    lost = float(run.energy.sel(share="engaging")[-1])
    before = earlier[0] - earlier[1]
    assert before > 10.0
    assert lost == pytest.approx(0.5 * 0.15 * 0.25 / 0.40 * before**2, rel=0.02)
    assert later[0] == pytest.approx(later[1])
    assert 0.15 * earlier[0] + 0.25 * earlier[1] == pytest.approx(0.40 * later[0], rel=2e-3)


def test_the_line_is_let_go_without_a_jerk(up: xr.Dataset) -> None:
    """While it accelerates the linings carry the engine's torque less what its own inertia takes."""
    gear = 1.27
    at_engine = (
        sum(ENGINE.values()) + sum(INPUT.values()) + (sum(OUTPUT.values()) + sum(WHEELS.values()) / AXLE**2) / gear**2
    )
    gains = (1000 - ROAD / gear / AXLE) / at_engine
    carried = up.torque.sel(element="clutch_linings", time=slice(0.0, 0.171)).values
    assert carried.mean() == pytest.approx(1000 - sum(ENGINE.values()) * gains, rel=3e-3)
    assert np.ptp(carried) < 60
    vehicle = up.angular_velocity.sel(node="vehicle", time=slice(0.0, 0.171))
    assert float(vehicle[-1] - vehicle[0]) == pytest.approx(gains * 0.171 / gear / AXLE, rel=0.05)
