"""Measured orders beside computed ones, out of tables and results."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.measurements.run_ups import RunUp

import torsional as tv
from torsional.errors import ModelError
from torsional.studies.correlation import correlation, in_words
from torsional.studies.order_curves import curves, curves_of_result, curves_of_table

SPEED = np.linspace(60.0, 180.0, 25)


def resonance(centre: float, damping: float = 0.1) -> np.ndarray:
    ratio = SPEED / centre
    return ratio**2 / (1.0 - ratio**2 + 2j * damping * ratio)


def test_deviations_by_hand() -> None:
    """Computed 20 % too large and 30° ahead: FRAC knows neither, amplitude and phase tell both."""
    m = curves(resonance(100.0)[None], np.array([3.0]), SPEED, "acceleration")
    c = curves(1.2 * np.exp(1j * np.pi / 6) * m.values, m.order.values, SPEED, "acceleration")
    found = correlation(m, c).isel(order=0)
    assert float(found.amplitude_error) == pytest.approx(0.2) and float(found.peak_error) == pytest.approx(0.2)
    assert float(found.phase_difference) == pytest.approx(np.pi / 6) and float(found.frac) == pytest.approx(1.0)
    size = np.abs(m.values[0])
    assert float(found.rms_deviation) == pytest.approx(0.2 * np.sqrt(np.mean(size**2)))
    assert float(found.r_squared) == pytest.approx(1 - np.sum((0.2 * size) ** 2) / np.sum((size - size.mean()) ** 2))


def test_a_peak_elsewhere_is_another_shape() -> None:
    orders = np.array([1.5, 3.0])
    m = curves(np.array([resonance(100.0), 5 * resonance(100.0)]), orders, SPEED, "acceleration")
    c = curves(np.array([resonance(100.0), 5 * resonance(140.0)]), orders, SPEED, "acceleration")
    found = correlation(m, c)
    assert found.frac.values[0] == pytest.approx(1.0) and found.frac.values[1] < 0.5
    assert found.peak_shift.values[1] == pytest.approx(SPEED[np.abs(resonance(140.0)).argmax()] - 100.0, abs=0.5)
    words = in_words(found)
    assert words[0].startswith("Order 3: the course over speed is not reproduced") and "Order 1.5" in words[1]


def test_amplitudes_alone_tell_no_phase_and_gaps_are_left_out() -> None:
    own = np.abs(resonance(100.0))
    own[3] = np.nan
    m = curves(own[None], np.array([3.0]), SPEED, "acceleration")
    c = curves(resonance(100.0)[None], np.array([3.0]), SPEED, "acceleration")
    found = correlation(m, c).isel(order=0)
    assert np.isnan(found.phase_difference) and int(found.speeds) == 24
    assert float(found.frac) == pytest.approx(1.0) and float(found.relative_deviation) == pytest.approx(0.0, abs=1e-12)


def test_computed_speeds_elsewhere_are_met_by_lines() -> None:
    m = curves((2.0 * SPEED)[None], np.array([3.0]), SPEED, "torque")
    fine = np.array([50.0, 100.0, 150.0])
    c = curves((2.0 * fine)[None], np.array([3.0]), fine, "torque")
    found = correlation(m, c)
    assert found.speed.values.max() <= 150.0 and float(found.rms_deviation[0]) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("orders", "speeds", "kind", "told"),
    [
        ([4.5], SPEED, "acceleration", "no measured order was computed"),
        ([3.0], SPEED + 115.0, "acceleration", "too few speeds are common"),
        ([3.0], SPEED, "torque", "one quantity is wanted on both sides"),
    ],
)
def test_what_cannot_be_compared(orders: list[float], speeds: np.ndarray, kind: str, told: str) -> None:
    m = curves(resonance(100.0)[None], np.array([3.0]), SPEED, "acceleration")
    with pytest.raises(ModelError, match=told):
        correlation(m, curves(resonance(100.0)[None], np.array(orders), speeds, kind))


TABLE = "order,speed [rpm],acceleration [rad/s²],phase [deg]\n3,600,10,90\n3,700,20,0\n6,600,1,180\n"


def test_a_table_of_orders(tmp_path: Path) -> None:
    path = tmp_path / "orders.csv"
    path.write_text(TABLE, encoding="utf-8")
    found = curves_of_table(path, "RMS")
    assert found.sel(order=3.0).values == pytest.approx(np.sqrt(2.0) * np.array([10j, 20.0]))
    assert found.speed.values == pytest.approx(np.array([600.0, 700.0]) * tv.RPM)
    assert np.isnan(found.sel(order=6.0).values[1]) and found.attrs["quantity"] == "acceleration"
    half = curves_of_table(path, "peak-to-peak")
    assert abs(half.sel(order=3.0).values[1]) == pytest.approx(10.0)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("order,speed [rpm],amplitude\n3,600,1\n3,700,1\n", "one column must name the quantity"),
        ("order,speed [rpm],acceleration [rad/s²],torque [Nm]\n3,600,1,1\n3,700,1,1\n", "one column must name"),
        ("order,speed [rpm],torque [rpm]\n3,600,1\n3,700,1\n", "torque"),
        ("order,speed [rpm],torque [Nm]\n3,600,1\n3,600,1\n", "stands twice"),
    ],
)
def test_tables_that_are_none(text: str, told: str, tmp_path: Path) -> None:
    path = tmp_path / "orders.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError, match=told) as caught:
        curves_of_table(path)
    assert "orders.csv" in str(caught.value)


def test_orders_of_a_result(tmp_path: Path) -> None:
    truck = tv.load_model("examples/truck_dmf.yaml")
    speeds = np.array([800.0, 900.0, 1000.0]) * tv.RPM
    result = tv.full_load_response(truck, speeds, gears=["11", "12"], orders=[3.0, 6.0])
    known = tv.acceleration(result.angle.sel(gear="12", node="gearbox_input", order=3.0))
    path = tv.save_results(result, tmp_path / "r.nc")
    found = curves_of_result(path, "gearbox_input", selection={"gear": "12"})
    assert found.sel(order=3.0).values == pytest.approx(known.values)
    twist = curves_of_result(path, "dmf", "relative_angle", {"gear": "12"})
    assert twist.sel(order=6.0).values == pytest.approx(result.twist.sel(gear="12", element="dmf", order=6.0).values)
    for place, kind, selected, told in (
        ("gearbox", "", None, "no such place"),
        ("dmf", "acceleration", None, "no such quantity"),
        ("dmf", "", None, "2 values of 'gear'"),
        ("dmf", "", {"gear": "13"}, "no such gear"),
    ):
        with pytest.raises(ModelError, match=told):
            curves_of_result(path, place, kind, selected)  # type: ignore[arg-type]


def test_measured_orders_of_a_shaft_are_curves_of_its_node(tmp_path: Path) -> None:
    """What order tracking saves is read as what analyses save: 0.5° at order 3, 0.05 rad ahead."""
    run = RunUp(70.0, 10.0, 8.0, {3.0: 0.5 * np.pi / 180 * np.exp(0.05j)})
    crank = tv.shaft_from_pulses(run.pulses(60, 2), 60, missing=2, index_angle=2 * np.pi / 60, name="secondary")
    tracked = tv.track_orders(None, tv.mean_rotation(crank), [3.0], shafts={"secondary": crank})
    found = curves_of_result(tv.save_results(tracked, tmp_path / "tracked.nc"), "secondary", "angle")
    assert found.order.values.tolist() == [3.0] and found.speed.size > 20
    assert np.degrees(np.abs(found.values)) == pytest.approx(0.5, rel=0.01)
