"""A1, A13, A15: what the engine model does to the line."""

from __future__ import annotations

import numpy as np
import pytest

from torsional.components import Inertia
from torsional.engine.orders import HALF_ORDERS
from torsional.solvers.operating import at_operating_point
from torsional.studies.answers import input_shaft, main_order, responded
from torsional.studies.base import Outcome
from torsional.studies.claims.excitation import crossing
from torsional.studies.trucks import Trucks, lumped
from torsional.units import RPM


def test_the_input_shaft(trucks: Trucks) -> None:
    assert input_shaft(trucks.smf) == "clutch_hub"
    assert main_order(trucks.smf) == 3.0


def test_a1_a_rigid_crankshaft_leaves_multiples_of_the_firing_order(trucks: Trucks) -> None:
    speed = np.array([1600 * RPM])
    found = responded(lumped(trucks.smf), speed, 2000.0, orders=HALF_ORDERS).torque.sel(element="clutch_hub")
    power = np.abs(found.values[0])
    others = HALF_ORDERS % 3 != 0
    assert power[others].max() < 1e-9 * power.max()


def test_a1_figures(outcomes: dict[str, Outcome]) -> None:
    figures = outcomes["A1"].finding.figures
    assert figures["rigid crankshaft: lowest share [-]"] > 0.8
    assert figures["lowest share away from crossings [-]"] < 0.8
    assert figures["share of the whole range's mean square [-]"] > 0.98


def test_a1_crossing_is_where_the_load_runs_out(trucks: Trucks) -> None:
    speed = np.linspace(600, 2000, 57) * RPM
    assert speed[crossing(trucks.smf, speed)].min() > 1900 * RPM
    assert trucks.smf.full_load(speed)[0] == pytest.approx(1300.0)


def test_a13_the_lumped_engine_keeps_its_inertia(trucks: Trucks) -> None:
    """0.30 + 0.10 damper, six throws of 0.11 and the flywheel."""
    for model, flywheel in ((trucks.smf, 1.9), (trucks.dmf, 1.2)):
        body = lumped(model).components["engine_body"]
        assert isinstance(body, Inertia)
        assert body.inertia == pytest.approx(0.40 + 6 * 0.11 + flywheel, rel=1e-12)
        assert lumped(model).components["engine_drag"].damping == pytest.approx(6 * 0.8)


def test_a13_both_models_meet_at_low_frequency(trucks: Trucks) -> None:
    """The crankshaft's twist fades with the square of frequency."""
    pair = (trucks.smf, lumped(trucks.smf))
    at = np.array([60.0, 120.0]) * RPM
    low, high = (responded(m, at, 500.0).angle.sel(node="gearbox_input").isel(order=0).values for m in pair)
    error = np.abs(high / low - 1)
    assert error[0] < 5e-4


def test_a13_figures(outcomes: dict[str, Outcome]) -> None:
    figures = outcomes["A13"].finding.figures
    assert figures["SMF: order, near [%]"] < 5 < figures["SMF: order, away, largest [%]"]
    assert figures["SMF: swing, largest [%]"] > 50
    assert figures["SMF: first crankshaft mode over clutch mode [-]"] > 3
    low, light = (figures[f"SMF: {name}: order, near [%]"] for name in ("lowest gear", "clutch damping × 0.05"))
    assert figures["SMF: order, near [%]"] < low < 5 < 10 < light
    reason = outcomes["A13"].finding.reason
    assert f"{low:.1f} % in the lowest gear" in reason and f"{light:.1f} % with × 0.05" in reason


@pytest.mark.parametrize(("name", "figure"), [("smf", "SMF, solid"), ("dmf", "DMF, solid")])
def test_a15_by_plain_matrices(outcomes: dict[str, Outcome], trucks: Trucks, name: str, figure: str) -> None:
    """All orders solved with the matrices, their speeds added up over a cycle."""
    model, idle = getattr(trucks, name), 600 * RPM
    system, _ = at_operating_point(model, 1300.0)
    onto = np.array([system.T[system.node_index(node)] for node in model.landmarks.throws])
    row, alpha = system.T[system.node_index(model.landmarks.crankshaft)], np.linspace(0, 4 * np.pi, 721)
    velocity = np.zeros(alpha.size)
    for n in HALF_ORDERS:
        w, load = n * idle, onto.T @ model.engine.harmonics(idle, 1300.0, [n])[:, 0]
        theta = row @ np.linalg.solve(system.K + 1j * w * system.C - w**2 * system.M, load)
        velocity += (1j * w * theta * np.exp(1j * n * alpha)).real
    found = next(np.asarray(v) for key, v in outcomes["A15"].finding.figures.items() if key.startswith(figure))
    assert found[1] == pytest.approx(100 * np.ptp(velocity) / idle, rel=1e-4)
    assert found[0] == pytest.approx(found[1], rel=0.15)
