"""Dual mass flywheels with arc springs: sections, loads, the characteristic by statics, what is refused."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

from torsional.absorbers import (
    ArcSprings,
    CoilSpring,
    GuideFriction,
    arc_spring_flywheel,
    condensed_flywheel,
    spring_characteristic,
)
from torsional.components import Coupling, Inertia
from torsional.errors import ModelError
from torsional.laws import Hinges
from torsional.powertrain import Powertrain
from torsional.solvers.equilibrium import equilibrium, linearize
from torsional.solvers.modal import modal
from torsional.system import assemble

PLAIN = ArcSprings(
    primary_inertia=1.14,
    secondary_inertia=1.0,
    channels=4,
    radius=0.15,
    channel_arc=1.28,  # the spring takes 1.2667 of it
    segments=8,
    spring=CoilSpring(rate=90e3, free_length=0.19, solid_length=0.1, mass=0.48),
    secondary_clearance=(0.01, 0.005),
    stop_angle=0.55,
    friction=GuideFriction(0.09, 0.11, viscous_coefficient=0.02),
    grease_damping=0.1,
)
STAGED = dataclasses.replace(
    PLAIN,
    inner_spring=CoilSpring(rate=180e3, free_length=0.16, solid_length=0.07, mass=0.16),
    inner_friction=GuideFriction(0.2),
)
PRELOADED = dataclasses.replace(
    STAGED, channel_arc=1.25, preloaded=True, end_mass=0.05, secondary_clearance=(0.005, 0.004)
)


def test_sections_make_the_spring() -> None:
    """Eight sections of 8 k each, solid after an eighth of the way; masses that add up to the spring's."""
    parts: dict[str, Any] = dict(arc_spring_flywheel(PLAIN).components)
    coils = [parts[f"arc_2_coil_{i}"] for i in range(1, 9)]
    section = 8 * 90e3 * 0.15**2
    for i, coil in enumerate(coils, 1):
        assert (coil.a, coil.b) == (f"arc_2_{i + 1}", f"arc_2_{i}")  # θ before − θ after: positive while driving
        assert isinstance(coil.law, Hinges)
        assert float(coil.law.tangent(-0.01)) == float(coil.law.tangent(0.01)) == pytest.approx(section)
        assert coil.law.gaps == pytest.approx((0.09 / 8 / 0.15,))
        assert float(coil.law.tangent(0.1)) == pytest.approx(section + 5e5)
    assert 1 / sum(1 / section for _ in coils) == pytest.approx(90e3 * 0.15**2)
    masses = [parts[f"arc_2_{i}"].inertia / 0.15**2 for i in range(1, 10)]
    assert masses == pytest.approx([0.03, *[0.06] * 7, 0.03])
    capped = dataclasses.replace(PLAIN, end_mass=0.05).rows[0].masses
    assert capped == pytest.approx((0.08, *[0.06] * 7, 0.08))
    assert len(arc_spring_flywheel(PLAIN).components) == 3 + 4 * (9 + 8 + 4 + 9)


@pytest.mark.parametrize("design", [PLAIN, STAGED, PRELOADED], ids=["plain", "staged", "preloaded"])
def test_characteristic_is_the_static_solution_of_the_rows(design: ArcSprings) -> None:
    system, law = assemble(Powertrain(arc_spring_flywheel(design).components)), spring_characteristic(design)
    torques = np.array([-2500.0, -400.0, 8.0, 700.0, 1500.0, 4000.0, 9000.0])
    point = equilibrium(system, {"primary": torques}, hold="secondary")
    travel = point.angle[:, point.names.index("dmf")]
    np.testing.assert_allclose(travel, law.angle(torques), rtol=1e-9)


def test_stages_by_hand() -> None:
    """Outer springs after their clearances, inner ones later by what they are shorter, tabs in series with each."""
    law = spring_characteristic(STAGED)
    tab = 0.5 * (1.28 - 0.19 / 0.15)
    outer, inner = (4 / (1 / (k * 0.15**2) + 2e-6) for k in (90e3, 180e3))
    assert law.gaps[:2] == pytest.approx((tab + 0.01, tab + 0.01 + 0.03 / 0.15), rel=1e-12)
    assert law.tangent([0.01, 0.1, 0.4]).tolist() == pytest.approx([0.0, outer, outer + inner], rel=1e-12)
    assert law.stops == (-0.55, 0.55)
    assert float(law.torque(-0.1)) == pytest.approx(-outer * (0.1 - tab - 0.005))


def test_surge_of_a_spring() -> None:
    """Waves along the spring between its tabs: 2 sqrt(nk/(m/n)) sin(πj/2n), near πj sqrt(k/m) of a uniform rod."""
    design = dataclasses.replace(PLAIN, channels=1, friction=None, grease_damping=0.0, tab_stiffness=1e10)
    system = assemble(Powertrain(arc_spring_flywheel(design).components))
    found = modal(linearize(system, equilibrium(system, {"primary": 300.0}, hold="secondary"))).frequency.values
    j = np.arange(1, 4)
    chain = 2 * np.sqrt(8 * 90e3 / (0.48 / 8)) * np.sin(np.pi * j / 16) / (2 * np.pi)
    np.testing.assert_allclose(found[2:5], chain, rtol=2e-3)
    assert chain[0] == pytest.approx(0.5 * math.sqrt(90e3 / 0.48), rel=1e-2)


def test_loads_of_the_sections() -> None:
    """m R Ω² + (F_left + F_right) sin(Δα/2); the guide carries what rides inside as well."""
    parts: dict[str, Any] = dict(arc_spring_flywheel(STAGED).components)
    outer, inner = (math.sin(0.5 * length / 0.15 / 8) / 0.15 for length in (0.19, 0.16))
    names = [f"{row}_1_coil_{i}" for row in ("arc", "inner") for i in (4, 5)]
    torque = dict(zip(names, (100.0, 80.0, 60.0, 50.0), strict=True))
    within = 0.02 * 0.15 * 200**2 + (60 + 50) * inner
    middle = parts["inner_1_5_guide"]
    assert (middle.a, middle.b) == ("arc_1_5", "inner_1_5")
    assert middle.load.at(200.0, torque) == pytest.approx(within)
    assert middle.law.sliding_torque == pytest.approx(0.2 * 0.15)
    guide = parts["arc_1_5_guide"]
    assert (guide.a, guide.b, guide.damping) == ("primary", "arc_1_5", 0.1)
    assert guide.load.at(200.0, torque) == pytest.approx(0.06 * 0.15 * 200**2 + 180 * outer + within)


def test_loads_add_up_to_the_whole_springs() -> None:
    """The masses of both springs press outwards at their radius, whatever lies on which section."""
    parts: dict[str, Any] = dict(arc_spring_flywheel(STAGED).components)
    guides = [parts[f"arc_3_{i}_guide"].load for i in range(1, 10)]
    assert sum(load.centrifugal for load in guides) == pytest.approx((0.48 + 0.16) * 0.15)
    inner = [parts[f"inner_3_{i}_guide"].load for i in range(1, 10)]
    assert sum(load.centrifugal for load in inner) == pytest.approx(0.16 * 0.15)
    shares = [load.share_of.get("inner_3_coil_1", 0.0) for load in guides]
    assert sum(shares) == pytest.approx(2 * math.sin(0.5 * 0.16 / 0.15 / 8) / 0.15)


def test_short_inner_springs_lie_in_the_middle() -> None:
    half = dataclasses.replace(STAGED, inner_spring=CoilSpring(180e3, 0.095, 0.05, 0.1))
    beside = [int(guide.removeprefix("arc_1_")) for guide in half.rows[1].guides]
    assert (beside[0], beside[4], beside[8]) == (3, 5, 7) and beside == sorted(beside)
    assert set(arc_spring_flywheel(half).components) >= {"inner_1_9_guide", "inner_4_coil_8"}


def test_friction_without_a_friction_of_its_own() -> None:
    same = dataclasses.replace(STAGED, inner_friction=None)
    parts: dict[str, Any] = dict(arc_spring_flywheel(same).components)
    assert parts["inner_1_5_guide"].law == parts["arc_1_5_guide"].law


def test_condensed_flywheel() -> None:
    absorber = condensed_flywheel(STAGED)
    primary, dmf = absorber.components["primary"], absorber.components["dmf"]
    assert isinstance(primary, Inertia) and isinstance(dmf, Coupling)
    assert primary.inertia == pytest.approx(1.14 + 4 * (0.48 + 0.16) * 0.15**2)
    assert dmf.law == spring_characteristic(STAGED)
    assert dmf.damping == pytest.approx(4 * 0.1 * sum((i / 8) ** 2 for i in range(9)))
    assert absorber.kind.startswith("dual mass flywheel")
    assert {**absorber.components, **absorber.detail} == dict(arc_spring_flywheel(STAGED).components)


@pytest.mark.parametrize(
    ("values", "where", "problem"),
    [
        ({"segments": 5}, "segments", "whole number"),
        ({"secondary_clearance": (-0.1, 0.0)}, "secondary_clearance", "must not be negative"),
        ({"channel_arc": 1.2}, "spring.free_length", "longer than their channel"),
        ({"channel_arc": 0.6}, "spring.solid_length", "solid before they carry torque"),
        ({"channel_arc": 1.6}, "channel_arc", "do not fit on the circle"),
        ({"preloaded": True}, "preloaded", "they fit"),
        ({"spring": CoilSpring(9e4, 0.19, 0.1)}, "spring.mass", "must be positive"),
        ({"inner_spring": CoilSpring(9e4, 0.15, 0.1)}, "inner_spring.mass", "must be positive"),
        ({"inner_spring": CoilSpring(9e4, 0.2, 0.1, 0.1)}, "inner_spring.free_length", "longer one"),
        ({"inner_friction": GuideFriction(0.1)}, "inner_friction", "goes with inner_spring"),
        ({"stop_angle": 0.01}, "stop_angle", "met before the springs"),
        ({"rated_torque": 5e3}, "rated_torque", "meet the end stop before the rated torque"),
        ({"rated_torque": 6e3, "stop_angle": 2.0}, "rated_torque", "are solid before the rated torque"),
        ({"radius": 0.0}, "radius", "must be positive"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_what_cannot_be_built_is_refused(values: dict[str, Any], where: str, problem: str) -> None:
    with pytest.raises(ModelError, match=problem) as told:
        dataclasses.replace(PLAIN, **values)
    assert told.value.where == where
