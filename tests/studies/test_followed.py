"""What claims ask follows the truck: torques its peak or its own springs, speeds its idle; on the shipped truck nothing
moves."""

from __future__ import annotations

import numpy as np
import pytest
from tests.shipped import shipped

from torsional.errors import ModelError
from torsional.files import changed
from torsional.laws import Jenkins
from torsional.studies.claims.friction import HIGHER, LIMITS, apart, condition, far, limits_of, names, rubbed
from torsional.studies.claims.idle import _reason, roomy
from torsional.studies.claims.longer_steps import _why
from torsional.studies.concepts import Scale
from torsional.studies.friction import AROUND, STICKING, WASHER, around, clutch_speed
from torsional.studies.stiffness_step import attained, carrying
from torsional.studies.trucks import Trucks, replaced
from torsional.units import RPM

LOUDER = 1.3
"""Peak of the other truck's full load over the shipped one's."""


@pytest.fixture(scope="module")
def heavy() -> Trucks:
    """Idle at 700 rpm, a peak of 3250 Nm, a clutch damper that keeps its mode at the same multiple of idle."""
    speeds = "speed: [700 rpm, 1050 rpm, 1400 rpm, 2200 rpm]"
    given = f"{{{speeds}, torque: [{1300 * LOUDER}, {2500 * LOUDER}, {2500 * LOUDER}, {1600 * LOUDER}]}}"
    moved = ("operation.idle=700 rpm", "operation.speed=700:2200 rpm", f"engine.full_load={given}")
    return Trucks.of(changed(shipped("truck_dmf"), *moved, "clutch.stiffness=33 kNm/rad"))


def test_friction_follows_peak_and_idle(trucks: Trucks, heavy: Trucks) -> None:
    """Torques and the washer's stiffness × 1.3, speeds × 7/6, limits of acceleration × (7/6)²."""
    assert limits_of(trucks.smf, LIMITS + HIGHER) == LIMITS + HIGHER
    assert limits_of(heavy.smf, LIMITS) == pytest.approx(np.array(LIMITS) * (7 / 6) ** 2)
    assert Scale.of(heavy.smf).acceleration == pytest.approx((7 / 6) ** 2)
    assert around(trucks.smf) == around(trucks.dmf) == AROUND
    assert around(heavy.dmf) == pytest.approx(np.array(AROUND) * 7 / 6)
    assert far(trucks.smf) == 1500 * RPM and far(heavy.smf) == pytest.approx(1750 * RPM)
    assert names(trucks.smf)[1] == "amplitude at 1500 rpm [rad/s²]"
    assert names(heavy.smf)[3] == "friction power at 1750 rpm [W]"
    assert "washer of 100 kNm/rad" in condition(trucks.smf) and "washer of 130 kNm/rad" in condition(heavy.smf)
    laws = [rubbed(each.smf, 60.0).components[WASHER].law for each in (trucks, heavy)]  # type: ignore[attr-defined]
    assert laws[0] == Jenkins(60.0, STICKING) and laws[1] == Jenkins(60.0, LOUDER * STICKING)


def test_a_resonance_elsewhere_is_looked_for_there(trucks: Trucks) -> None:
    """With a softer clutch the mode lies below idle, and the window with it."""
    clutch = trucks.smf.components["clutch"]
    soft = replaced(trucks.smf, "clutch", law=type(clutch.law)(12e3))  # type: ignore[attr-defined]
    low, high = around(soft)
    assert low < clutch_speed(soft) < 600 * RPM and low == pytest.approx(0.92 * clutch_speed(soft))
    assert high == 1000 * RPM


def test_a_clutch_without_resonance_is_refused() -> None:
    with pytest.raises(ModelError, match="no resonance in the range twists the clutch"):
        clutch_speed(Trucks.of(shipped("passenger_car_dmf")).smf)


def test_next_to_no_power_is_compared_with_the_largest() -> None:
    told = np.array([[100.0], [1e-9], [50.0]])
    assert apart(told, np.array([[101.0], [1e-3], [49.0]])).ravel() == pytest.approx([0.01, 1e-5, 0.02])


def test_mean_torques_end_where_the_engine_does(trucks: Trucks) -> None:
    assert attained(trucks.two_stage).torques == (700.0, 2300.0)
    stages = "[{up_to: 1400 Nm, stiffness: 10 kNm/rad}, {up_to: 3500 Nm, stiffness: 24 kNm/rad}]"
    moved = changed(shipped("truck_dmf_two_stage"), f"absorber.stages={stages}")
    assert attained(moved).torques == pytest.approx((980.0, 2375.0))
    with pytest.raises(ModelError, match="carries no torque"):
        carrying(Trucks.of(shipped("passenger_car_dmf")).two_stage)


def test_idle_takes_a_lash_that_the_free_motion_fits_into(trucks: Trucks) -> None:
    """2° as on the shipped truck, 3° with a light primary flywheel, which swings more."""
    own, wide = roomy(trucks.dmf, 20.0), roomy(replaced(trucks.dmf, "primary", inertia=0.2), 20.0)
    assert np.rad2deg(own.lash) == pytest.approx(2.0) and 1.2 * own.free < own.lash
    assert np.rad2deg(wide.lash) == pytest.approx(3.0) and 1.2 * wide.free > own.lash


def test_what_is_said_of_the_lashes_is_what_was_found(trucks: Trucks) -> None:
    """The reason of damping is given where the more there is of it the smaller a lash must be, and not otherwise."""
    none, some = np.inf, 250.0
    assert _reason(trucks.dmf, {20.0: [some] * 5, 10.0: [some] * 5}) == ""
    assert "acts within the lash" in _reason(trucks.dmf, {20.0: [some, some, none, none, none], 10.0: [some] * 5})
    odd = _reason(trucks.dmf, {20.0: [none] * 5, 10.0: [none, some, none, some, none]})
    assert odd == "pulses of up to 1000 Nm leave no lasting vibration but with lashes of 2, 4° with 10 Nms/rad"
    assert "at any lash" in _reason(trucks.dmf, {20.0: [none] * 5})


def test_the_mechanism_of_longer_steps_is_told_where_it_shows() -> None:
    """Lost runs with radius 1 and 0.8, none with 0.5, more error with 0 than with 0.5, nothing gained when closed."""
    fine, lost = np.full(6, 0.01), np.array([0.01, 0.01, 0.01, 0.01, 1.0, 1.0])
    table = {1.0: lost, 0.8: lost, 0.5: fine, 0.0: 2.0 * fine}
    assert "from 0.5 ms on" in _why([table], closed=True)
    assert _why([table], closed=False) == ""
    for radius, other in ((1.0, fine), (0.8, fine), (0.5, lost), (0.0, fine)):
        assert _why([{**table, radius: other}], closed=True) == ""
