"""C1 to C6 against closed forms, equilibrium and plain matrices."""

from __future__ import annotations

import numpy as np
import pytest

from torsional.absorbers import cancellation_frequency
from torsional.components import PlanetSpin
from torsional.solvers.operating import at_operating_point
from torsional.studies.answers import at_input, mean_torque, responded
from torsional.studies.base import Outcome
from torsional.studies.claims.planetary import at_quotient_one
from torsional.studies.claims.power_split import paths
from torsional.studies.power_split import Parts, cancelled, damped
from torsional.studies.trucks import Trucks, merged, only, replaced
from torsional.units import RPM


def test_c1_found_where_the_closed_form_says(trucks: Trucks) -> None:
    """k = 13 kNm/rad, J2 = 0.6, J3 = 0.010 kgm², g = 2, r = 1/1.3."""
    r = 1 / 1.3
    expected = np.sqrt(13e3 / (0.6 * (1 - r) + 0.010 * 2 * (2 - r))) / 3
    assert cancelled(trucks.psva) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("rpm", [700, 898, 1500])
def test_c1_paths_are_the_torque_on_the_output(trucks: Trucks, rpm: float) -> None:
    """Both paths together accelerate the output body and load the clutch."""
    spring, gear, _ = paths(trucks.psva, rpm * RPM)
    found = responded(trucks.psva, np.array([rpm * RPM])).isel(speed=0, order=0)
    inertial = -((3 * rpm * RPM) ** 2) * 0.6 * complex(found.angle.sel(node="output"))
    assert spring + gear == pytest.approx(inertial + complex(found.torque.sel(element="clutch")), rel=1e-9)


def test_c1_paths_cancel_without_damping(trucks: Trucks) -> None:
    bare = damped(trucks.psva, 0.0)
    spring, gear, _ = paths(bare, cancelled(bare))
    assert abs(spring + gear) < 1e-5 * abs(spring)


def test_c1_corresponding_flywheel(trucks: Trucks) -> None:
    """Secondary and output turn as one and nothing spins: the amplitude of a flywheel built from scratch."""
    same = replaced(trucks.dmf, "secondary", inertia=1.2)
    same = replaced(replaced(same, "primary", inertia=1.2), "dmf", damping=trucks.psva.components["springs"].damping)
    speed = np.array([700.0, 1000.0, 1800.0]) * RPM
    assert at_input(merged(trucks.psva), speed) == pytest.approx(at_input(same, speed), rel=1e-9)


def test_c2_every_point_of_the_sweeps(outcomes: dict[str, Outcome], trucks: Trucks) -> None:
    p, factors = Parts.of(trucks.psva), np.geomspace(0.5, 2.0, 5)
    expected = {
        "secondary inertia": [cancellation_frequency(p.k, f * p.J2, p.J3, p.g, p.r) for f in factors],
        "planet inertia": [cancellation_frequency(p.k, p.J2, f * p.J3, p.g, p.r) for f in factors],
        "stiffness": [cancellation_frequency(f * p.k, p.J2, p.J3, p.g, p.r) for f in factors],
        "output inertia": [p.cancellation()] * 5,
    }
    for name, omega in expected.items():
        found = np.asarray(outcomes["C2"].finding.figures[f"over {name} × 0.5 to 2 [rpm]"])
        assert found == pytest.approx(np.array(omega) / 3 / RPM, rel=1e-5)


def test_c3_both_ends(outcomes: dict[str, Outcome], trucks: Trucks) -> None:
    figures = outcomes["C3"].finding.figures
    r, inverse = (np.asarray(figures[name]) for name in list(figures)[:2])
    assert r * inverse == pytest.approx(np.ones(r.size))
    p = Parts.of(trucks.psva)
    expected = [cancellation_frequency(p.k, p.J2, p.J3, p.g, float(x)) / 3 / RPM for x in r]
    assert np.asarray(figures["cancellation [rpm]"]) == pytest.approx(expected, rel=1e-5)
    assert (np.diff(np.asarray(figures["mean amplitude there [rad/s²]"])) > 0).all()


def test_c4_by_plain_matrices(trucks: Trucks) -> None:
    """Equal energies for equal motions; the planetary flywheel's own 2 by 2 inertia matrix written out."""
    split, planetary = at_quotient_one(trucks)
    systems = [at_operating_point(model, mean_torque(model))[0] for model in (split, planetary)]
    nodes = systems[1].nodes
    rows = [system.T[[system.node_index(node) for node in nodes]] for system in systems]
    rng = np.random.default_rng(4)
    for q in rng.standard_normal((5, rows[1].shape[1])):
        moved = np.linalg.lstsq(rows[0], rows[1] @ q, rcond=None)[0]
        assert rows[0] @ moved == pytest.approx(rows[1] @ q, abs=1e-12)
        assert moved @ systems[0].M @ moved == pytest.approx(q @ systems[1].M @ q, rel=1e-12)
        assert moved @ systems[0].K @ moved == pytest.approx(q @ systems[1].K @ q, rel=1e-10)
    J3, g = 0.010, 2.0
    places = [systems[1].coordinates.index(node) for node in ("primary", "secondary")]
    spin = J3 * np.outer([1 - g, g], [1 - g, g]) + np.diag([1.2, 1.2])
    assert systems[1].M[np.ix_(places, places)] == pytest.approx(spin, rel=1e-12)


def test_c4_planets_for_650_rpm(outcomes: dict[str, Outcome]) -> None:
    figures = outcomes["C4"].finding.figures
    omega = 2 * np.pi * 32.5
    assert figures["planet inertia for 650 rpm, planetary [kgm²]"] == pytest.approx(13e3 / omega**2 / 2)
    assert figures["over the shipped power split absorber's [-]"] > 5
    over = figures["planetary's over those in the model [-]"]
    assert over == pytest.approx(figures["planet inertia for 650 rpm, planetary [kgm²]"] / 0.010) and over > 15


def test_c5_two_cancellations(trucks: Trucks, outcomes: dict[str, Outcome]) -> None:
    """Without damping each inertia alone cancels at ω² = k/(J3 g (g − 1))."""
    name, spring = only(trucks.planetary, PlanetSpin), trucks.planetary.landmarks.springs[0]
    bare = replaced(trucks.planetary, spring, damping=0.0)
    plain = at_input(replaced(bare, name, inertia=0.0, switch=None), np.array([810.0]) * RPM)
    for J in (0.10, 0.05):
        at = np.array([np.sqrt(13e3 / (J * 2.0)) / 3])
        assert at_input(replaced(bare, name, inertia=J, switch=None), at)[0] < 1e-9 * plain[0]
    figures = outcomes["C5"].finding.figures
    assert figures["useful part of the range: better of both [%]"] > 50


def test_c5_the_switch_takes_one_or_the_other(trucks: Trucks, outcomes: dict[str, Outcome]) -> None:
    data = outcomes["C5"].finding.dataset
    assert data is not None
    high = data.speed.values > 1000 * RPM + 1e-9
    assert data.switched.values[high] == pytest.approx(data.smaller.values[high], rel=1e-12)
    assert data.switched.values[~high] == pytest.approx(data.larger.values[~high], rel=1e-12)


def test_c6_no_damping_no_motion(outcomes: dict[str, Outcome]) -> None:
    depth = np.asarray(outcomes["C6"].finding.figures["lowest ratio to the DMF [-]"])
    assert depth[0] < 1e-6 and depth[-1] > 0.8
    # little damping: the remaining motion grows with it
    assert depth[2] / depth[1] == pytest.approx(2.0, rel=0.05)
