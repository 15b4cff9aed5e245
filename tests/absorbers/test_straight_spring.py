"""Dual mass flywheels with straight springs: the published numbers, the characteristic by statics, what is refused."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest
from tests.validation import dmf_lcp

from torsional.absorbers import (
    CentrifugalPendulum,
    CoilSpring,
    GuideFriction,
    StraightSprings,
    condensed_flywheel,
    spring_characteristic,
    straight_spring_flywheel,
    with_pendulum,
)
from torsional.components import Coupling, Damper, Inertia, Shaft
from torsional.errors import ModelError
from torsional.laws import Contacts
from torsional.powertrain import Powertrain
from torsional.solvers.equilibrium import equilibrium, linearize
from torsional.solvers.modal import modal
from torsional.stamps import Connection, Mass
from torsional.system import assemble

LOOSE = StraightSprings(
    primary_inertia=1.8,
    secondary_inertia=1.0,
    channels=2,
    radius=0.1,
    channel_arc=2.516,  # 16 mrad more than 6 springs of 30 mm, 5 shoes and 2 end shoes of 10 mm take
    play_factors=(1.0, 1.2),
    springs_per_row=6,
    spring=CoilSpring(rate=1.05e6, free_length=0.03, solid_length=0.02),
    shoe_mass=0.384,
    end_shoe_mass=0.3,
    shoe_width=0.01,
    end_shoe_width=0.01,
    secondary_clearance=(0.008, 0.008),
    stop_angle=0.75,
    grease_damping=0.3,
)
"""The flywheel of DMF-LCP-1 as it would be designed at a radius of 100 mm."""

NESTED = dataclasses.replace(
    LOOSE,
    inner_spring=CoilSpring(rate=2.1e6, free_length=0.026, solid_length=0.015),
    primary_clearance=(0.001, 0.004),
    secondary_clearance=(0.005, 0.02),
    stop_angle=0.5,
)
PRELOADED = dataclasses.replace(
    LOOSE, channel_arc=2.452, preloaded=True, play_factors=(1.0, 1.0), secondary_clearance=(0.02, 0.01)
)
"""Every spring pressed together by 8 mrad."""

RUBBING = dataclasses.replace(LOOSE, friction=GuideFriction(0.08, 0.1, viscous_coefficient=0.02))


def changed(**values: Any) -> StraightSprings:
    return dataclasses.replace(LOOSE, **values)


# --- DMF-LCP-1 ---


def node_numbers() -> dict[str, int]:
    named = {"primary": dmf_lcp.PRIMARY, "secondary": dmf_lcp.SECONDARY, "gearbox": dmf_lcp.GEARBOX}
    named["vehicle"] = dmf_lcp.VEHICLE
    shoes = [(channel, shoe) for channel in (1, 2) for shoe in range(1, 8)]
    return named | {f"shoe_{c}_{s}": dmf_lcp.FIRST_SHOE + i for i, (c, s) in enumerate(shoes)}


def benchmark_line() -> Powertrain:
    rest = {"gearbox": Inertia(0.3), "vehicle": Inertia(15.0)}
    rest["clutch"] = Shaft("secondary", "gearbox", 20e3, 5.0)
    rest["driveline"] = Shaft("gearbox", "vehicle", 3e3, 5.0)
    return Powertrain({**straight_spring_flywheel(LOOSE).components, **rest})


def test_stamps_are_the_numbers_of_the_benchmark() -> None:
    """Every inertia, damper and one-sided spring, one by one: plus, minus, gap, stiffness."""
    number, contacts, linear = node_numbers(), [], []
    inertia = np.zeros(dmf_lcp.NODES)
    for stamp in benchmark_line().stamps:
        if isinstance(stamp, Mass):
            (node,) = stamp.weights
            inertia[number[node]] += stamp.inertia
            continue
        assert isinstance(stamp, Connection)
        a, b = (number[next(n for n, w in stamp.weights.items() if w == sign)] for sign in (-1.0, 1.0))
        if stamp.law is None:
            linear.append((a, b, stamp.stiffness, stamp.damping))
            continue
        assert isinstance(stamp.law, Contacts) and set(stamp.law.contact_times) == {dmf_lcp.CONTACT_TIME}
        rows = zip(stamp.law.gaps, stamp.law.sides, stamp.law.stiffnesses, strict=True)
        contacts += [(a, b, gap, k) if side > 0 else (b, a, -gap, k) for gap, side, k in rows]  # (plus, minus, …)
    np.testing.assert_allclose(inertia, dmf_lcp.INERTIA, rtol=1e-14)
    table = zip(dmf_lcp.PLUS, dmf_lcp.MINUS, dmf_lcp.GAP, dmf_lcp.SPRING_STIFFNESS, strict=True)
    np.testing.assert_allclose(sorted(contacts), sorted(table), rtol=1e-12)
    ends = {(min(a, b), max(a, b), k, c) for a, b, k, c in linear}
    assert ends == {(min(a, b), max(a, b), k, c) for a, b, k, c in dmf_lcp.LINEAR}


def test_accelerations_are_those_of_the_benchmark() -> None:
    """The signs of all torques: accelerations at random states against the benchmark's own right-hand side."""
    number, rng, contacts = node_numbers(), np.random.default_rng(3), 0
    for amplitude in (0.01, 0.1, 1.0):
        angle, rate = amplitude * rng.standard_normal(dmf_lcp.NODES), rng.standard_normal(dmf_lcp.NODES)
        torque = np.zeros(dmf_lcp.NODES)
        torque[dmf_lcp.PRIMARY], torque[dmf_lcp.VEHICLE] = dmf_lcp.MEAN, -dmf_lcp.MEAN  # of the drive, at time zero
        for stamp in benchmark_line().stamps:
            if not isinstance(stamp, Connection):
                continue
            weights = np.zeros(dmf_lcp.NODES)
            for node, weight in stamp.weights.items():
                weights[number[node]] = weight
            force = stamp.stiffness * (weights @ angle) + stamp.damping * (weights @ rate)
            law = float(stamp.law.torque(weights @ angle, weights @ rate)) if stamp.law else 0.0
            contacts += law != 0
            torque -= weights * (force + law)
        expected = dmf_lcp.right_hand_side(0.0, np.append(angle, rate))[dmf_lcp.NODES :]
        np.testing.assert_allclose(torque / dmf_lcp.INERTIA, expected, rtol=1e-9, atol=1e-9 * abs(expected).max())
    assert contacts > 20


# --- the frictionless characteristic ---


@pytest.mark.parametrize("design", [LOOSE, NESTED, PRELOADED, RUBBING], ids=["loose", "nested", "preload", "rubbing"])
def test_characteristic_is_the_static_solution_of_the_rows(design: StraightSprings) -> None:
    """Newton's method on all shoes, tabs and stops against the closed form, from free play to the end stop."""
    system, law = assemble(Powertrain(straight_spring_flywheel(design).components)), spring_characteristic(design)
    torques = np.array([-9e3, -1500.0, -700.0, -60.0, 3.0, 90.0, 400.0, 1100.0, 2500.0, 2e4])
    point = equilibrium(system, {"primary": torques}, hold="secondary")
    travel = point.angle[:, point.names.index("dmf")]
    np.testing.assert_allclose(travel, law.angle(torques), rtol=1e-9)
    assert np.ptp(travel) > 0.9


def test_characteristic_by_hand() -> None:
    """One channel, drive side: free play, then six springs and two tabs one behind the other, solid coils, end stop."""
    law = spring_characteristic(changed(channels=1, play_factors=(), stop_angle=0.64))
    play, row = 0.002 + 6 * 0.002 + 0.008, 1 / (6 / 10500 + 2 / 1e6)
    solid = play + 10500 * 0.1 / row
    bound = 1 / (6 / (10500 + 5e5) + 2 / 1e6)
    np.testing.assert_allclose(law.gaps[:3], [play, solid, 0.64], rtol=1e-12)
    np.testing.assert_allclose(law.tangent([0.01, 0.3, 0.63, 0.7]), [0, row, bound, bound + 2e6], rtol=1e-9)
    assert law.stops == pytest.approx((-solid, solid))
    assert law.torque(-0.3) == -law.torque(0.3) == pytest.approx(-row * (0.3 - play))
    assert spring_characteristic(changed(stop_angle=0.3)).stops == (-0.3, 0.3)


def test_preload_holds_until_its_torque() -> None:
    """48 mrad too much in each channel: held by both tabs at rest, by one of them when the row leaves the other."""
    law = spring_characteristic(PRELOADED)
    rest, left = (2 * 0.048 / (6 / 10500 + tabs * 1e-6) for tabs in (2, 1))
    start, end = 0.02 - rest / 2e6, 0.02 + left / 2e6
    assert law.gaps[:2] == pytest.approx((start, end), rel=1e-12)
    assert law.torque([start, end]).tolist() == pytest.approx([0.0, left], abs=1e-9)
    assert float(law.tangent(0.1)) == pytest.approx(float(spring_characteristic(LOOSE).tangent(0.1)), rel=1e-12)
    assert float(law.tangent(start + 1e-5)) > 100 * float(law.tangent(0.1))


def test_inner_springs_are_a_stage() -> None:
    law = spring_characteristic(dataclasses.replace(NESTED, play_factors=()))
    soft, stiff = (2 / (6 / k + 2 / 1e6) for k in (10500.0, 31500.0))
    assert [float(law.tangent(x)) for x in (0.2, 0.4)] == pytest.approx([soft, stiff], rel=1e-9)
    assert law.stage_name(0.2) == "stage 1" and law.stage_name(0.4) == "stage 2"


# --- shoes ---


def test_shoes_swing_between_their_springs() -> None:
    """A row on its tabs under torque: 2 sqrt(k/J) sin(πj/12), the tabs next to rigid beside the springs."""
    design = changed(end_shoe_mass=1e-4, tab_stiffness=1e10, stop_angle=0.6)
    system = assemble(Powertrain(straight_spring_flywheel(design).components))
    found = modal(linearize(system, equilibrium(system, {"primary": 500.0}, hold="secondary")))
    expected = 2 * np.sqrt(10500 / 0.00384) * np.sin(np.pi * np.arange(1, 6) / 12) / (2 * np.pi)
    inner = found.frequency.values[2:12:2]  # rigid and flywheels before, each twice: one a channel
    np.testing.assert_allclose(inner, expected, rtol=2e-3)


def test_normal_load_of_a_shoe() -> None:
    """m R Ω² and the sine share of both springs that meet at the pitch of 0.4 rad; an end shoe has one spring."""
    parts: dict[str, Any] = dict(straight_spring_flywheel(RUBBING).components)
    pull = 100.0 / 0.1 * math.sin(0.2)  # 100 Nm at 100 mm
    torque = {"spring_1_3": -100.0, "spring_1_4": -50.0, "spring_1_1": -100.0}
    assert parts["shoe_1_4_guide"].load.at(200.0, torque) == pytest.approx(0.384 * 0.1 * 200**2 + 1.5 * pull)
    assert parts["shoe_1_1_guide"].load.at(200.0, torque) == pytest.approx(0.3 * 0.1 * 200**2 + pull)
    assert parts["shoe_1_4_guide"].load.carrier == "primary"
    guide = parts["shoe_2_7_guide"]
    assert isinstance(guide, Coupling) and (guide.a, guide.b, guide.damping) == ("primary", "shoe_2_7", 0.3)


def test_friction_at_the_radius() -> None:
    """Force over sliding velocity, turned into torque over rate: µ R, Stribeck's width v/R, sticking way over R."""
    law = GuideFriction(0.08, 0.1, 0.02, presliding=2e-5, viscous_coefficient=0.02).law(0.15)
    for velocity in (0.004, 0.02, 0.5):
        force = 0.08 + 0.02 * math.exp(-((velocity / 0.02) ** 2)) + 0.02 * velocity
        assert float(law.steady(velocity / 0.15)) == pytest.approx(force * 0.15, rel=1e-12)
    stuck = law.march(np.linspace(0, 1e-3 * 2e-5 / 0.15, 5), 1e-2)[0][-1]
    assert stuck == pytest.approx(0.08 * 0.15 * 1e-3, rel=2e-3)


def test_spring_masses_ride_with_their_shoes() -> None:
    spring = dataclasses.replace(LOOSE.spring, mass=0.1)
    masses = changed(spring=spring).rows[0].masses
    assert masses == pytest.approx((0.35, *[0.484] * 5, 0.35))
    assert sum(masses) == pytest.approx(sum(LOOSE.rows[0].masses) + 6 * 0.1)


# --- two bodies for linear and periodic analyses ---


def test_condensed_flywheel_keeps_inertia_law_and_grease() -> None:
    absorber = condensed_flywheel(LOOSE)
    dmf: Any = absorber.components["dmf"]
    assert sorted(absorber.components) == ["dmf", "primary", "secondary"]
    assert dmf.law == spring_characteristic(LOOSE) and (dmf.a, dmf.b) == ("secondary", "primary")
    primary: Any = absorber.components["primary"]
    assert primary.inertia == pytest.approx(1.8 + 2 * (2 * 0.003 + 5 * 0.00384))
    sliding = 2 * sum(0.3 * (i / 6) ** 2 for i in range(7))  # each shoe with its share of the way
    assert dmf.damping == pytest.approx(sliding)
    assert condensed_flywheel(changed(damping=20.0)).components["dmf"] == dataclasses.replace(dmf, damping=20.0)


def test_detail_takes_the_place_of_the_condensed_parts() -> None:
    absorber = condensed_flywheel(LOOSE)
    whole = {**absorber.components, **absorber.detail}
    assert whole == dict(straight_spring_flywheel(LOOSE).components)
    assert "secondary" not in absorber.detail and isinstance(whole["shoe_1_1_guide"], Damper)
    hung = with_pendulum(absorber, CentrifugalPendulum("secondary", 3.0, 0.12, 3.0))
    assert hung.detail == absorber.detail
    with pytest.raises(ModelError, match="taken"):
        absorber.joined({"shoe_1_1": Inertia(1.0)})


# --- what is refused ---


@pytest.mark.parametrize(
    ("values", "where", "problem"),
    [
        ({"secondary_clearance": (-0.01, 0.0)}, "secondary_clearance", "must not be negative"),
        ({"primary_clearance": (0.0, -0.001)}, "primary_clearance", "must not be negative"),
        ({"primary_clearance": (0.01, 0.01)}, "primary_clearance", "less play"),
        ({"channel_arc": 2.4}, "spring.free_length", "longer than their channel"),
        ({"channel_arc": 1.8}, "spring.solid_length", "solid before they carry torque"),
        ({"springs_per_row": 30}, "springs_per_row", "shoes alone fill the channel"),
        ({"channels": 3, "play_factors": ()}, "channel_arc", "do not fit on the circle"),
        ({"preloaded": True}, "preloaded", "they fit"),
        ({"play_factors": (1.0,)}, "play_factors", "one factor a channel"),
        ({"play_factors": (1.0, 0.0)}, "play_factors", "must be positive"),
        ({"stop_angle": 0.02}, "stop_angle", "met before the springs"),
        ({"rated_torque": 2500.0}, "rated_torque", "are solid before the rated torque"),
        ({"rated_torque": 2000.0, "stop_angle": 0.5}, "rated_torque", "meet the end stop before the rated torque"),
        ({"springs_per_row": 0}, "springs_per_row", "whole number"),
        ({"shoe_mass": 0.0}, "shoe_mass", "must be positive"),
        ({"tab_stiffness": 0.0}, "tab_stiffness", "must be positive"),
        ({"inner_spring": CoilSpring(1e5, 0.031, 0.01)}, "inner_spring.free_length", "longer one"),
        ({"channel_arc": 2.452, "preloaded": True, "secondary_clearance": (0.0, 0.0)}, "secondary_clearance", "both"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_what_cannot_be_built_is_refused(values: dict[str, Any], where: str, problem: str) -> None:
    with pytest.raises(ModelError, match=problem) as told:
        changed(**values)
    assert told.value.where == where


def test_parts_that_cannot_be_built_are_refused() -> None:
    with pytest.raises(ModelError, match="solid at its free length"):
        CoilSpring(1e5, 0.03, 0.03)
    with pytest.raises(ModelError, match="must not be below sliding"):
        GuideFriction(0.1, 0.05)
    with pytest.raises(ModelError, match=r"give off energy.*>= 0\.02 s/m"):
        GuideFriction(0.1, 0.15)


def test_a_rated_torque_that_is_carried_is_accepted() -> None:
    law = spring_characteristic(changed(rated_torque=2092.0))
    assert float(law.torque(law.stops[1])) == pytest.approx(2092.33, abs=0.01)
