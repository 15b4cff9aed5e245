"""What the findings say are the figures of the datasets, worked out here a second way."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from tests.report.conftest import example

from torsional.files import changed
from torsional.report.analysis import Comparison, analysed, continued, usable_speeds
from torsional.report.finding import Finding
from torsional.report.findings import findings
from torsional.report.labels import rounded, told
from torsional.units import RPM


@pytest.fixture(scope="module")
def groups(trucks: Comparison) -> dict[str, list[Finding]]:
    return dict(findings(trucks))


def one(found: list[Finding], kind: str) -> Finding:
    return next(finding for finding in found if finding.kind == kind)


def half_peak_to_peak(trucks: Comparison, which: int) -> np.ndarray:
    """Half peak-to-peak of the input's acceleration (gear, torque, speed), put together degree by degree."""
    response = trucks.variants[which].response
    assert response is not None
    grid = response.grid
    angle = grid.angle.sel(node="gearbox_input").transpose("gear", "mean_torque", "speed", "order").values
    order, speed = grid.order.values, grid.speed.values
    alpha = np.radians(np.arange(720.0))
    size = -angle * (order * speed[:, None]) ** 2
    low = high = 0.0
    for a in np.array_split(alpha, 30):
        part = (size @ np.exp(1j * np.outer(order, a))).real
        low, high = np.minimum(low, part.min(axis=-1)), np.maximum(high, part.max(axis=-1))
    return np.asarray(0.5 * (high - low))


def test_headings(groups: dict[str, list[Finding]]) -> None:
    two, single = "two-stage dual mass flywheel", "single mass flywheel"
    assert list(groups) == [two, single, f"{two} against {single}"]


def test_largest_acceleration(trucks: Comparison, groups: dict[str, list[Finding]]) -> None:
    response = trucks.first.response
    assert response is not None
    size = half_peak_to_peak(trucks, 0)
    within = response.grid.within_full_load.values
    expected = size[:, within].max()
    found = one(groups["two-stage dual mass flywheel"], "largest")
    assert found.values["acceleration"] == pytest.approx(expected, rel=1e-6)
    gear, torque, speed = np.argwhere(np.where(within, size, 0.0) == np.where(within, size, 0.0).max())[0]
    assert found.values["mean_torque"] == response.grid.mean_torque.values[torque]
    assert found.values["speed"] == response.grid.speed.values[speed]
    place = f"{told(response.grid.speed.values[speed], 'speed')} and {told(found.values['mean_torque'], 'torque')}"
    assert f"is {rounded(expected)} rad/s² (half peak-to-peak) at {place} in gear {gear + 1}" in found.text


def test_ratio(trucks: Comparison, groups: dict[str, list[Finding]]) -> None:
    response = trucks.first.response
    assert response is not None
    within = response.grid.within_full_load.values
    ratio = (half_peak_to_peak(trucks, 0) / half_peak_to_peak(trucks, 1))[:, within]
    found = one(groups["two-stage dual mass flywheel against single mass flywheel"], "ratio")
    assert found.values["median"] == pytest.approx(np.median(ratio), rel=1e-6)
    assert found.values["largest"] == pytest.approx(ratio.max(), rel=1e-6)
    assert found.values["share above 1"] == pytest.approx((ratio > 1).mean())
    assert f"full load is {rounded(float(np.median(ratio)))}, the largest {rounded(float(ratio.max()))}" in found.text


def test_cells_above_one_are_named(trucks: Comparison, groups: dict[str, list[Finding]]) -> None:
    response = trucks.first.response
    assert response is not None
    within = response.grid.within_full_load.values
    ratio = np.where(within, half_peak_to_peak(trucks, 0) / half_peak_to_peak(trucks, 1), 0.0)
    louder = {str(i + 1): float(r.max()) for i, r in enumerate(ratio) if r.max() > 1}
    found = one(groups["two-stage dual mass flywheel against single mass flywheel"], "louder")
    assert dict(found.values) == pytest.approx(louder)
    lowest = min(response.grid.speed.values[(r > 1).any(axis=0)].min() for r in ratio if r.max() > 1)
    assert f"{lowest / RPM:.0f}" in found.text


def test_resonances_of_the_shipped_trucks() -> None:
    """The speeds that an independent prototype found for the same trucks."""
    comparison = analysed([example("truck_dmf"), example("truck_smf")], [], 6, 3, lambda a, b: None)
    dual, single, _ = [found for _, found in findings(comparison)]
    assert "at 769 rpm in gear 12" in one(dual, "resonance").text
    assert "all 12 gears" in one(dual, "resonance").text
    assert one(dual, "absorber mode").values["speed"] / RPM == pytest.approx(414, abs=0.6)
    assert "0.69 times the idle speed of 600 rpm" in one(dual, "absorber mode").text
    assert "at 654 rpm in gear 12" in one(single, "resonance").text


def test_travel_and_stop(groups: dict[str, list[Finding]]) -> None:
    """Two stages of 8 and 24 kNm/rad with the transition at 1000 Nm and the stop at 3500 Nm."""
    found = one(groups["two-stage dual mass flywheel"], "travel")
    assert found.values["stop"] == pytest.approx(1000 / 8e3 + 2500 / 24e3)
    assert found.values["mean"] == pytest.approx(1000 / 8e3 + 1500 / 24e3)
    assert found.values["extent"] > found.values["stop"]
    assert "beyond its stop at 13.1°" in found.text
    assert one(groups["two-stage dual mass flywheel"], "stages").values["from"] == pytest.approx(600 * RPM)


def test_stages_have_modes_of_their_own(groups: dict[str, list[Finding]]) -> None:
    found = one(groups["two-stage dual mass flywheel"], "stage modes")
    low, high = found.values.values()
    assert list(found.values) == ["500 Nm", "2250 Nm"]
    assert low < high
    assert told(low, "speed") in found.text


def test_irregularity_at_idle(trucks: Comparison, groups: dict[str, list[Finding]]) -> None:
    """Largest less smallest speed over a cycle, by the crankshaft's order angles at 600 rpm and 1300 Nm."""
    response = trucks.first.response
    assert response is not None
    full = response.full.sel(gear="12", node="primary")
    first = full.isel(speed=0)
    omega = 1j * first.order.values * float(first.speed) * first.angle.values
    alpha = np.radians(np.arange(720.0))
    speed = (np.exp(1j * np.outer(alpha, first.order.values)) @ omega).real
    found = one(groups["two-stage dual mass flywheel"], "irregularity")
    assert found.values["full load"] == pytest.approx(np.ptp(speed) / float(first.speed), rel=1e-6)
    assert f"{100 * np.ptp(speed) / float(first.speed):.2g} % at 1300 Nm" in found.text


def test_a_model_without_an_engine_tells_modes_only() -> None:
    ((_, found),) = findings(analysed([example("mwm_engine")], [], 5, 5, lambda a, b: None))
    assert found[0].text == "The lowest natural frequencies are 216.6 Hz, 592.7 Hz and 984.9 Hz."
    assert "no engine" in found[1].text


def test_a_model_without_places_tells_why_there_is_no_response() -> None:
    marine = example("marine_line")
    blind = marine.replaced(landmarks=dataclasses.replace(marine.landmarks, input="", crankshaft=""))
    ((_, found),) = findings(analysed([blind], [], 5, 5, lambda a, b: None))
    assert "landmarks.input" in one(found, "missing").text


def test_machines_of_different_kinds_have_no_ratio() -> None:
    comparison = analysed([example("marine_line"), example("truck_smf")], [], 6, 4, lambda a, b: None)
    assert comparison.ratio(comparison.variants[1]) is None
    assert "No ratio is told" in findings(comparison)[-1][1][0].text


def test_each_variant_is_analysed_over_its_own_range() -> None:
    """A grid that another model starts is cut or continued, and its points are kept bit by bit."""
    first = np.linspace(600.0, 2000.0, 57) * RPM
    taken = continued(first, np.linspace(700.0, 2300.0, 57) * RPM)
    assert np.isin(first[4:], taken).all()
    assert taken[[0, -1]] / RPM == pytest.approx([700.0, 2300.0])
    assert continued(first, np.linspace(4000.0, 6000.0, 5) * RPM)[0] == 4000.0 * RPM


def test_speeds_stay_on_the_full_load_curve() -> None:
    truck = example("truck_dmf")
    wide = truck.replaced(operation=dataclasses.replace(truck.operation, speed=(400 * RPM, 2400 * RPM)))
    assert np.array(usable_speeds(wide)) / RPM == pytest.approx([600.0, 2000.0])


def test_friction_that_slips_and_friction_that_sticks() -> None:
    """A washer of 60 Nm sticks within ±0.1°; one of 60 kNm whatever the swing."""
    pair = [changed(example("truck_dmf"), f"clutch.friction_torque={torque}") for torque in ("60 Nm", "60 kNm")]
    (_, weak), (_, strong), _ = findings(analysed(pair, ["12"], 8, 4, lambda a, b: None))
    slips = one(weak, "friction")
    assert slips.values["from"] == pytest.approx(600 * RPM) and 1000 * RPM < slips.values["to"] < 2000 * RPM
    assert "friction beside clutch slips at speeds between 600 rpm and" in slips.text
    assert one(strong, "friction").values == {}
