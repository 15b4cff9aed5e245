"""Studies that engineers run: on the shipped truck against the claims and closed forms, on another truck, refused."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any, get_type_hints

import numpy as np
import pytest
import xarray as xr
from tests.shipped import shipped

from torsional.errors import ModelError
from torsional.files import changed
from torsional.plots import save_png
from torsional.studies.advice import values_of
from torsional.studies.base import Outcome
from torsional.studies.motions import SPRING
from torsional.studies.power_split import Parts, cancelled
from torsional.studies.register import tools
from torsional.studies.strongest import Search
from torsional.studies.tools.psva_design import planets
from torsional.studies.tools.tva_design import needed_inertia
from torsional.studies.trucks import Trucks, replaced
from torsional.units import QUANTITIES, RPM

KINDS = {"float", "int", "str", "bool"}


@pytest.fixture(scope="module")
def car() -> Trucks:
    """A passenger car of four cylinders, six gears and 1000 to 4000 rpm."""
    return Trucks.of(shipped("passenger_car_dmf"))


def asked(name: str, trucks: Trucks, **options: Any) -> xr.Dataset:
    """A tool's answer, which says what an engineer must know and can be drawn."""
    found = tools()[name](trucks, **options)
    assert found.attrs["analysis"] == f"study {name}"
    assert found.attrs["condition"] and all(found.attrs["findings"].split("\n"))
    assert all("units" in found[each].attrs for each in found.data_vars if found[each].dtype.kind == "f")
    assert save_png(tools()[name].picture(found)).startswith(b"\x89PNG")
    return found


@pytest.mark.parametrize("name", list(tools()))
def test_every_option_is_described_and_has_a_default(name: str) -> None:
    tool = tools()[name]
    assert tool.about.endswith(".") and tool.varies
    hints = get_type_hints(tool.question, include_extras=True)
    for parameter in list(inspect.signature(tool.question).parameters.values())[1:]:
        assert parameter.kind is parameter.KEYWORD_ONLY and parameter.default is not parameter.empty
        *quantity, words = hints[parameter.name].__metadata__
        assert words and all(each in QUANTITIES for each in quantity)


# --- cylinder-deactivation ---


def test_cylinder_deactivation_tells_the_figures_of_the_claim(trucks: Trucks, outcomes: Mapping[str, Outcome]) -> None:
    found = asked("cylinder-deactivation", trucks)
    figures = outcomes["G4"].finding.figures
    for concept in found.concept.values:
        for engine in found.engine.values:
            largest = float(found.swing.sel(concept=concept, engine=engine).max())
            assert largest == figures[f"{concept}, {engine}: largest swing [rad/s²]"]
    assert "4825 rad/s² (9.6 times) at 825 rpm, order 1.5" in found.attrs["findings"]


def test_cylinder_deactivation_of_a_car(car: Trucks) -> None:
    found = asked("cylinder-deactivation", car, absorbers=("dmf",), off=(2, 3), cylinders=3)
    assert found.engine.values.tolist() == ["all cylinders", "some off", "shorter engine"]
    with pytest.raises(ModelError, match="no such choice"):
        asked("cylinder-deactivation", car, absorbers=("dmff",))


# --- psva-design ---


def test_psva_design_cancels_where_it_was_asked_to(trucks: Trucks) -> None:
    """The inertia by closed form, put into the truck, cancels at the wanted speed in its linear response."""
    found = asked("psva-design", trucks, cancellation=650 * RPM)
    inertia = planets(trucks.psva, 650 * RPM)
    assert f"{inertia:.3g} kgm² of planets cancel at 650 rpm" in found.attrs["findings"]
    changed = replaced(trucks.psva, Parts.of(trucks.psva).planets, inertia=inertia)
    assert cancelled(changed) == pytest.approx(650 * RPM, rel=1e-4)
    assert (np.diff(found.cancellation.values) < 0).all()


def test_psva_design_at_one_cancellation(trucks: Trucks) -> None:
    """A quotient further from 1 lets the planets be lighter, and more vibration through at high speed."""
    found = asked("psva-design", trucks, varied="gear-quotient", held=True, values=(0.6, 0.7, 0.8, 0.9))
    assert found.cancellation.values == pytest.approx(650 * RPM, rel=1e-4)
    assert (np.diff(found.planets.values) > 0).all() and (np.diff(found.high.values) < 0).all()


def test_psva_design_of_a_car_and_what_it_refuses(car: Trucks) -> None:
    found = asked("psva-design", car, varied="stiffness")
    assert (np.diff(found.cancellation.values) > 0).all()
    assert "no planet inertia" in asked("psva-design", car, cancellation=200.0).attrs["findings"]
    with pytest.raises(ModelError, match="no planet inertia"):
        asked("psva-design", car, cancellation=200.0, varied="stiffness", values=(1e3, 2e3), held=True)
    with pytest.raises(ModelError, match="no such quotient"):
        asked("psva-design", car, varied="gear-quotient", values=(0.9, 1.1))
    with pytest.raises(ModelError, match="cannot be varied as well"):
        asked("psva-design", car, held=True)


# --- tva-design ---


def test_tva_design_tells_the_figures_of_the_claims(trucks: Trucks, outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["D3"].finding.figures
    found = asked("tva-design", trucks, values=tuple(np.geomspace(0.02, 6.0, 24)))
    told = [needed_inertia(found, apart) for apart in (0.05, 0.1, 0.2)]
    assert told == pytest.approx(figures["absorber inertia needed [kgm²]"][:3], rel=1e-12)  # type: ignore[index]
    own = asked("tva-design", trucks, varied="damping", values=(0.5, 1.0, 2.0, 4.0, 8.0, 16.0))
    notch = np.array(outcomes["D4"].finding.figures["amplitude at the tuning speed [rad/s²]"])
    plain = float(outcomes["D4"].finding.figures["without absorber at the tuning speed [rad/s²]"])  # type: ignore[arg-type]
    assert own.at_tuning.values == pytest.approx(notch / plain, rel=1e-9)


def test_tva_design_of_a_car(car: Trucks) -> None:
    found = asked("tva-design", car, carrier="secondary", tuned=1500 * RPM, gear="4")
    assert "tuned to 1500 rpm" in found.attrs["condition"] and "gear 4" in found.attrs["condition"]
    order = found.stiffness.values / found.inertia.values  # (2 · 1500 rpm)² of four cylinders
    assert order == pytest.approx((2 * 1500 * RPM) ** 2)
    with pytest.raises(ModelError, match="no such choice"):
        asked("tva-design", car, carrier="primary")
    with pytest.raises(ModelError, match="above zero"):
        asked("tva-design", car, tuned=-1.0)


# --- clutch-friction ---


def test_clutch_friction_tells_the_figures_of_the_claim(trucks: Trucks, outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["A5"].finding.figures
    found = asked("clutch-friction", trucks, far=1500 * RPM)
    assert found.friction_torque.values.tolist() == list(figures["friction torque [Nm]"])  # type: ignore[arg-type]
    assert found.peak.values == pytest.approx(figures["largest amplitude [rad/s²]"], rel=1e-9)
    assert found.power.values == pytest.approx(figures["friction power at the resonance [W]"], rel=1e-9)


def test_clutch_friction_of_a_car(car: Trucks) -> None:
    found = asked("clutch-friction", car, torques=(10.0, 40.0), limit=6000.0)
    assert (np.diff(found.peak.values) < 0).all()
    assert "Nm of friction bring the largest amplitude to 6000 rad/s²" in found.attrs["findings"]
    with pytest.raises(ModelError, match="far speed"):
        asked("clutch-friction", car, far=50.0)
    with pytest.raises(ModelError, match="cannot be asked"):
        values_of((1.0, -1.0), 0.0, "torques")


# --- start-up ---


def test_start_up_tells_the_figures_of_the_claim(trucks: Trucks, outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["G2"].finding.figures
    found = asked("start-up", trucks, varied="run-up-time", values=(0.1, 0.2, 0.8, 3.2))
    told = figures["largest angle [deg], time from a third of idle to idle"]
    assert np.degrees(found.angle.values)[::-1].tolist() == list(told)  # type: ignore[arg-type]
    by_starter = asked("start-up", trucks, values=(150 * RPM, 350 * RPM))
    told = figures["largest angle [deg], starter speed"]
    assert np.degrees(by_starter.angle.values) == pytest.approx([told[0], told[-1]], rel=1e-6)  # type: ignore[index]


def test_start_up_of_a_car(car: Trucks) -> None:
    found = asked("start-up", car, varied="damping", values=(0.5, 8.0))
    assert np.diff(found.angle.values) < 0
    assert "yours, as it is" in found.attrs["condition"] or "scaled to yours" in found.attrs["condition"]
    with pytest.raises(ModelError, match="no springs"):
        asked("start-up", car, absorber="smf")
    with pytest.raises(ModelError, match="no such choice"):
        asked("start-up", car, varied="starter-torque")


# --- stiffness-step ---


def test_stiffness_step_finds_the_peaks_of_the_claims(trucks: Trucks) -> None:
    """The same peak as a search that climbs from other speeds, and none for a small step."""
    found = asked("stiffness-step", trucks, differences=(2e3, 16e3))
    assert found.spring_torque.values[0] == 0 and np.isnan(found.strongest_at.values[0])
    looks = np.arange(720.0, 1121.0, 40.0) * RPM
    peak = Search(trucks.two_stage, 1.5, (700.0, 2300.0), looks).peak(SPRING)  # 8 and 24 kNm/rad as shipped
    assert found.spring_torque.values[1] == pytest.approx(peak.amplitude, rel=1e-3)
    assert found.strongest_at.values[1] == pytest.approx(peak.torque, rel=5e-3)
    assert found.lowest_speed.values[1] < peak.speed < found.highest_speed.values[1]
    assert "no vibration of order 1.5 up to a difference of 2 kNm/rad" in found.attrs["findings"]


def test_stiffness_step_of_another_truck(car: Trucks) -> None:
    """With four cylinders it is order 1, about twice the mode's order speeds."""
    truck = Trucks.of(changed(shipped("truck_dmf"), "engine.layout=inline-4", "engine.firing_order=[1, 3, 4, 2]"))
    found = asked("stiffness-step", truck, differences=(16e3, 20e3))
    assert "order 1 has" in found.attrs["findings"]
    assert (found.strongest_at.values > 1000.0).all()
    with pytest.raises(ModelError, match="carries no torque"):
        asked("stiffness-step", car)
