"""A10, A11, A14: the dual beside the single mass flywheel."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.solvers.operating import at_operating_point
from torsional.studies.answers import at_input
from torsional.studies.base import Outcome
from torsional.studies.claims.comparison import _resonant, behind_clutch, damped, resonances
from torsional.studies.trucks import Trucks, sprung
from torsional.units import RPM


def solved(model: Model, speed: float, torque: float, gear: str) -> float:
    """Third-order acceleration at the gearbox input, by the plain matrices."""
    system, _ = at_operating_point(model, torque, gear)
    assert model.engine is not None
    load = model.engine.harmonics(speed, torque, [3.0])[:, 0]
    onto: Array = np.array([system.T[system.node_index(node)] for node in model.landmarks.throws])
    w = 3 * speed
    q = np.linalg.solve(system.K + 1j * w * system.C - w**2 * system.M, onto.T @ load)
    return float(w**2 * abs(system.T[system.node_index("gearbox_input")] @ q))


@pytest.mark.parametrize(("gear", "rpm", "place"), [("12", 800, 2), ("5", 1300, 4), ("1", 700, 0)])
def test_a10_cells_by_plain_matrices(
    trucks: Trucks, outcomes: dict[str, Outcome], gear: str, rpm: float, place: int
) -> None:
    data = outcomes["A10"].finding.dataset
    assert data is not None
    torque = float(data.mean_torque[place])
    cell = data.ratio.sel(gear=gear, mean_torque=torque).sel(speed=rpm * RPM, method="nearest")
    expected = solved(trucks.dmf, rpm * RPM, torque, gear) / solved(trucks.smf, rpm * RPM, torque, gear)
    assert float(cell) == pytest.approx(expected, rel=1e-8)


def test_a10_figures(outcomes: dict[str, Outcome]) -> None:
    figures = outcomes["A10"].finding.figures
    assert figures["median ratio, firing order [-]"] < 0.25
    assert figures["largest ratio, firing order [-]"] < 1
    light = figures["clutch damping × 0.2: cells above 1"]
    assert isinstance(light, tuple) and {text.split(":")[0] for text in light} >= {"gear 11", "gear 12"}


def test_a10_a_bump_is_no_resonance(outcomes: dict[str, Outcome]) -> None:
    """Maxima of no height do not count: at the shipped damping the amplitude falls from idle on in every gear."""
    outcome = outcomes["A10"]
    assert outcome.verdict == "reproduced with a condition" and "little damping" in outcome.finding.proviso
    assert outcome.finding.figures["DMF: gears with a resonance above idle"] == ()
    assert len(outcome.finding.figures["clutch damping × 0.2: DMF: gears with a resonance above idle"]) == 12  # type: ignore[arg-type]


@pytest.mark.parametrize(("height", "kept"), [(0.08, ()), (0.13, ("gear 1: 30 rpm",))])
def test_a10_a_peak_stands_out(height: float, kept: tuple[str, ...]) -> None:
    """Out of the higher of the valleys beside it."""
    values = np.array([3.0, 1.0, 1.0 + height, 0.4, 0.2, np.nan])[None, None]
    coordinates = {"gear": ["1"], "mean_torque": [1.0], "speed": np.arange(1.0, 7.0) * 10 * RPM}
    assert _resonant(xr.DataArray(values, coordinates, ("gear", "mean_torque", "speed"))) == kept


def test_a11_without_a_mode_is_refused(trucks: Trucks) -> None:
    """Springs and a clutch so stiff that their modes lie beyond the range."""
    with pytest.raises(ModelError, match="no mode of springs and clutch"):
        resonances(sprung(sprung(trucks.dmf, "dmf", 1e9), "clutch", 1e9), "dmf")


def test_a11_far_above_resonance_the_springs_pass_on_their_force(trucks: Trucks) -> None:
    """Amplitude goes with |k + iωc|, the dynamic stiffness of the springs alone."""
    speed = np.array([1900 * RPM])
    k = np.array([8e3, 13e3, 20e3])
    found = np.array([at_input(sprung(trucks.dmf, "dmf", float(value)), speed)[0] for value in k])
    passed = np.abs(k + 1j * 3 * speed[0] * 20.0)
    assert found / passed == pytest.approx(np.full(3, found[1] / passed[1]), rel=0.05)


def test_a11_bottoming_torque(outcomes: dict[str, Outcome]) -> None:
    figures = outcomes["A11"].finding.figures
    bottoming, k = np.asarray(figures["bottoming torque [Nm]"]), np.asarray(figures["stiffness [Nm/rad]"])
    assert bottoming / k == pytest.approx(np.full(k.size, figures["travel of the fixed design [rad]"]))
    assert bottoming[0] == pytest.approx(0.8 * 2500.0)


def test_a14_what_lies_behind_the_clutch(trucks: Trucks) -> None:
    behind = behind_clutch(trucks.smf, "12")
    assert {"tyres", "half_shafts", "propeller_shaft"} <= behind
    assert not behind & {"clutch", "clutch_hub_x", "crank1", "damper"}
    half = damped(trucks.smf, 0.5)
    assert half.components["tyres"].damping == pytest.approx(0.5 * trucks.smf.components["tyres"].damping)
    assert half.components["clutch"] is trucks.smf.components["clutch"]
    assert half.components["damper"] is trucks.smf.components["damper"]


def test_a14_figures(outcomes: dict[str, Outcome]) -> None:
    figures = outcomes["A14"].finding.figures
    assert min(figures["SMF: cells under 5 % [%]"], figures["DMF: cells under 5 % [%]"]) > 99
