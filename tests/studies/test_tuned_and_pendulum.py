"""D1 to D4 and G1 against closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from torsional.absorbers import CentrifugalPendulum
from torsional.studies.answers import at_input
from torsional.studies.base import Outcome
from torsional.studies.claims.pendulum import on, on_single, quiet_order, share_of_way, way
from torsional.studies.trucks import Trucks, only, replaced, without
from torsional.studies.tuned_absorber import added, flywheel_alone, order_speeds, sized, tuning, tunings_above
from torsional.units import RPM


def test_tuned_to_650_rpm(trucks: Trucks) -> None:
    assert tuning(trucks.tva) == pytest.approx(650 * RPM, rel=1e-12)


def test_d1_undamped_absorber_stills_the_input(trucks: Trucks) -> None:
    at = np.array([tuning(trucks.tva)])
    bare = replaced(trucks.tva, "tva_spring", damping=0.0)
    assert at_input(bare, at)[0] < 1e-9 * at_input(without(trucks.tva, "tva", "tva_spring"), at)[0]


def test_d1_modes_interlace(trucks: Trucks) -> None:
    """Rayleigh: one more spring and mass pushes what lies below the tuning down and what lies above up."""
    plain, own = order_speeds(without(trucks.tva, "tva", "tva_spring")), order_speeds(trucks.tva)
    below = int((plain < tuning(trucks.tva)).sum())
    assert (own[:below] < plain[:below]).all()
    assert (own[below + 1 :] >= plain[below:] * (1 - 1e-12)).all()


def test_d2_starts_at_the_tuning(trucks: Trucks) -> None:
    tiny = sized(trucks.tva, 1e-7)
    assert tuning(tiny) == pytest.approx(tuning(trucks.tva), rel=1e-12)
    assert added(tiny) == pytest.approx(tuning(trucks.tva), rel=1e-6)


def test_d2_heavy_flywheels_and_light_flange(trucks: Trucks) -> None:
    """Near ω_t sqrt((k1 + k2)/(k1 + k2 + ka)) while the absorber is small."""
    k = 52e3
    for inertia in (0.05, 0.2):
        ka = inertia * (3 * tuning(trucks.tva)) ** 2
        expected = tuning(trucks.tva) * np.sqrt(k / (k + ka))
        assert added(sized(trucks.tva, inertia)) == pytest.approx(expected, rel=0.015)


def test_d2_open_clutch_separates_the_carriers(trucks: Trucks) -> None:
    flange, secondary = (sized(trucks.tva, 0.2, carrier) for carrier in ("", "secondary"))
    assert added(flange, flywheel_alone) < tuning(flange) < added(secondary, flywheel_alone)


@pytest.mark.parametrize("carrier", ["", "secondary"])
def test_d2_where_the_added_resonance_lies_above(trucks: Trucks, carrier: str) -> None:
    """Tunings by the line with the carrier held still, against the modes of the line with absorbers so tuned."""
    ends = tunings_above(trucks.tva, carrier)
    assert len(ends) > 0
    for inertia in (0.02, 2.0):
        for rpm in (610.0, 650.0, 760.0, 780.0, 800.0, 820.0, 1000.0):
            speed = rpm * RPM
            k = inertia * (3 * speed) ** 2
            own = replaced(replaced(trucks.tva, "tva", inertia=inertia), "tva_spring", stiffness=k)
            own = replaced(own, "tva_spring", a=carrier) if carrier else own
            assert (added(own) > speed) == any(low < speed < high for low, high in ends), (inertia, rpm)


def test_d2_holds_for_some_tunings_only(outcomes: dict[str, Outcome]) -> None:
    """Between the clutch mode at 765 rpm and 808 rpm the added resonance lies above."""
    outcome = outcomes["D2"]
    assert outcome.finding.figures["on the flange: added resonance above tunings of [rpm]"] == ("765–808",)
    assert outcome.verdict == "reproduced with a condition" and "765–808 rpm" in outcome.finding.proviso


def test_d3_figures(outcomes: dict[str, Outcome]) -> None:
    figures = outcomes["D3"].finding.figures
    needed = np.asarray(figures["absorber inertia needed [kgm²]"])
    apart = np.asarray(figures["separations of the tuning speed [%]"])
    assert (np.diff(np.log(needed)) > np.diff(np.log(apart))).all()  # grows faster than the separation
    assert needed[-1] > figures["dual mass flywheel without absorber [kgm²]"] == pytest.approx(2.3)


def test_d4_figures(outcomes: dict[str, Outcome]) -> None:
    figures = outcomes["D4"].finding.figures
    notch = np.asarray(figures["amplitude at the tuning speed [rad/s²]"])
    assert notch[1] / notch[0] == pytest.approx(2.0, rel=0.1)  # little damping: in proportion
    assert notch[-1] < figures["without absorber at the tuning speed [rad/s²]"]


def test_g1_the_pendulum_has_but_so_much_way(outcomes: dict[str, Outcome], trucks: Trucks) -> None:
    """A tautochrone's cusp lies c/(n sqrt(1 + n²)) from rest; beyond it the linear swing is no motion."""
    pendulum = trucks.pendulum.components["pendulum"]
    assert way(pendulum) == pytest.approx(0.15 / (3 * np.sqrt(10)))
    assert way(replace(pendulum, stop=0.01)) == 0.01
    at = np.array([600.0, 700.0, 900.0, 1300.0, 1900.0]) * RPM
    assert share_of_way(on_single(trucks), at) == pytest.approx([6.5, 6.0, 3.9, 1.9, 1.1], abs=0.05)
    assert share_of_way(trucks.pendulum, at[:3]) == pytest.approx([1.36, 0.83, 0.31], abs=0.01)
    outcome = outcomes["G1"]
    assert outcome.verdict == "reproduced with a condition" and "on the SMF at 600–2000 rpm" in outcome.finding.proviso
    heavy = outcome.finding.figures["SMF: mass whose swing fits at every speed [kg]"]
    assert share_of_way(on(trucks, "smf", heavy / 4.0), at).max() < 1 < share_of_way(on(trucks, "smf", 6.0), at).max()


@pytest.mark.parametrize("rpm", [600.0, 1234.5, 2000.0])
def test_g1_rests_at_the_third_order(trucks: Trucks, rpm: float) -> None:
    assert quiet_order(trucks.pendulum, rpm * RPM) == pytest.approx(3.0, rel=1e-6)


def test_g1_another_order(trucks: Trucks) -> None:
    name = only(trucks.pendulum, CentrifugalPendulum)
    assert quiet_order(replaced(trucks.pendulum, name, order=2.5), 100.0) == pytest.approx(2.5, rel=1e-6)


def test_g1_undamped_pendulum_stills_the_input(trucks: Trucks) -> None:
    speed = np.array([600.0, 900.0, 1800.0]) * RPM
    for model in (trucks.pendulum, on_single(trucks)):
        name = only(model, CentrifugalPendulum)
        still = at_input(replaced(model, name, damping=0.0), speed)
        assert (still < 1e-9 * at_input(without(model, name), speed)).all()
