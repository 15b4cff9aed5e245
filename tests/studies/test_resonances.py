"""Resonances of the shipped truck against another program's figures, and the criteria of A2 to A8 on the figures.

The speeds in rpm and shares were found by a separate prototype of the same lumped data.
"""

from __future__ import annotations

import numpy as np
import pytest

from torsional.studies.answers import mode_of, modes, tracked
from torsional.studies.base import Outcome
from torsional.studies.claims.resonances import behind_gears, stiffened, without_damper
from torsional.studies.trucks import Trucks, replaced, sprung
from torsional.units import RPM

GEARS = {"12": 11, "10": 9, "8": 7, "4": 3}


def figure(outcomes: dict[str, Outcome], id: str, name: str) -> np.ndarray:
    return np.asarray(outcomes[id].finding.figures[name])


def test_a2_one_mode_at_low_speed(outcomes: dict[str, Outcome]) -> None:
    assert figure(outcomes, "A2", "order speeds [rpm]") == pytest.approx([654.0], abs=0.6)
    assert figure(outcomes, "A2", "energy in the clutch [-]") == pytest.approx([0.58], abs=0.005)


@pytest.mark.parametrize(("gear", "rpm"), [("12", 654), ("10", 733), ("8", 790), ("4", 832)])
def test_a3_by_gear(outcomes: dict[str, Outcome], gear: str, rpm: float) -> None:
    assert figure(outcomes, "A3", "order speed by gear [rpm]")[GEARS[gear]] == pytest.approx(rpm, abs=0.6)


def test_a3_the_driveline_matters_in_high_gears_alone(outcomes: dict[str, Outcome], trucks: Trucks) -> None:
    """Half-shafts take a share p of the mode's energy and move it by p/2 of their own change, for small changes."""
    outcome = outcomes["A3"]
    moved = figure(outcomes, "A3", "by gear: change by half_shafts ± 50 % [%]")
    assert outcome.verdict == "reproduced with a condition" and "half_shafts" in outcome.finding.proviso
    assert moved[-1] == pytest.approx(8.2, abs=0.1) and moved[0] < 0.1 < 5 < moved[-1]
    assert set(behind_gears(trucks.smf)) == {"propeller_shaft", "half_shafts", "tyres"}
    found = modes(trucks.smf)
    place = mode_of(found, "clutch")
    share = float(found.elastic_share.isel(mode=place).sel(element="half_shafts"))
    other = replaced(trucks.smf, "half_shafts", stiffness=1.001 * behind_gears(trucks.smf)["half_shafts"])
    raised = tracked(other, trucks.smf.top_gear, place) / (float(found.order_speed[place]) / RPM)
    assert np.log(raised) / np.log(1.001) == pytest.approx(share / 2, rel=1e-3)


def test_a4_stays_inside(outcomes: dict[str, Outcome], trucks: Trucks) -> None:
    top = figure(outcomes, "A4", "top gear's order speed [rpm]")
    assert (np.diff(top) > 0).all() and top[0] < 600 < top[-1]
    soft = outcomes["A4"].finding.figures["gears inside at the softest"]
    assert isinstance(soft, tuple) and "1" in soft and "12" not in soft
    # Rayleigh's quotient: a mode rises with a spring by its share of the elastic energy, d ln f / d ln k = p/2
    low, high = stiffened(trucks.smf, np.array([1 / 1.001, 1.001]), "12")
    share = figure(outcomes, "A2", "energy in the clutch [-]")[0]
    assert np.log(high / low) / np.log(1.001**2) == pytest.approx(share / 2, rel=1e-4)


@pytest.mark.parametrize(("gear", "dmf", "clutch"), [("12", 414, 769), ("8", 390, 901)])
def test_a6_a7_by_gear(outcomes: dict[str, Outcome], gear: str, dmf: float, clutch: float) -> None:
    assert figure(outcomes, "A6", "order speed by gear [rpm]")[GEARS[gear]] == pytest.approx(dmf, abs=0.6)
    assert figure(outcomes, "A7", "order speed by gear [rpm]")[GEARS[gear]] == pytest.approx(clutch, abs=0.6)


def test_a6_a7_energies(outcomes: dict[str, Outcome]) -> None:
    assert figure(outcomes, "A6", "energy in the DMF by gear [-]")[-1] == pytest.approx(0.63, abs=0.005)
    assert figure(outcomes, "A7", "energy in the clutch by gear [-]")[-1] == pytest.approx(0.61, abs=0.005)
    assert figure(outcomes, "A6", "highest over idle [-]") < 0.8


@pytest.mark.parametrize(("gear", "rpm"), [("12", 1401), ("8", 1849)])
def test_a8_nearly_rigid(trucks: Trucks, gear: str, rpm: float) -> None:
    """1e6 Nm/rad is nearly rigid; a truly rigid clutch lies a little above."""
    place = mode_of(modes(trucks.dmf, gear), "clutch")
    assert tracked(sprung(trucks.dmf, "clutch", 1e6), gear, place) == pytest.approx(rpm, abs=0.6)
    assert rpm < tracked(without_damper(trucks.dmf), gear, place) < 1.05 * rpm
    assert tracked(sprung(trucks.dmf, "clutch", 1e10), gear, place) == pytest.approx(
        tracked(without_damper(trucks.dmf), gear, place), rel=1e-4
    )


def test_a8_weakest_part_behind_the_clutch(outcomes: dict[str, Outcome]) -> None:
    inside = outcomes["A8"].finding.figures["gears inside with a rigid clutch"]
    assert inside == ("7", "8", "9", "10", "11", "12")
    assert outcomes["A8"].finding.figures["top gear's weakest part"] == "clutch_hub"
