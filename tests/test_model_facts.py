"""What a model says of itself: its gears, its engine and how far full load reaches."""

from __future__ import annotations

import numpy as np
import pytest

import torsional as tv
from tests.shipped import shipped
from torsional.errors import ModelError
from torsional.studies.subharmonic import full_load_curve
from torsional.units import RPM


@pytest.fixture(scope="module")
def truck() -> tv.Model:
    return shipped("truck_dmf")


def test_gears_by_name(truck: tv.Model) -> None:
    assert truck.gear_name() == truck.gear_name("") == truck.gear_name(12) == "12"
    assert truck.chosen_gears() == [str(n) for n in range(1, 13)]
    assert truck.chosen_gears([3, "11"]) == ["3", "11"]
    assert truck.powertrain("").speed_ratio("vehicle") == truck.powertrain(12).speed_ratio("vehicle")
    for asked in (lambda: truck.chosen_gears([13]), lambda: tv.steady_map(truck, [100.0], [500.0], [13])):
        with pytest.raises(ModelError, match="no gear '13'"):
            asked()


def test_below_the_full_load_curve(truck: tv.Model) -> None:
    """Resonances below idle are computed as any others; what the engine cannot do there is told and not refused."""
    speeds, torques = np.array([250, 600, 900]) * RPM, np.array([0.0, 1500.0])
    found = tv.response_map(truck, speeds, torques, ["12"], [3.0])
    assert found.within_full_load.values.tolist() == [[False, True, True], [False, False, True]]
    alone = tv.run_up_response(truck, speeds[:1], 1500.0, "12", [3.0])
    node = truck.landmarks.input
    both = [data.angle.sel(node=node).values.ravel() for data in (found.isel(gear=0)[{"speed": 0}], alone)]
    assert abs(both[0][1] - both[1][0]) < 1e-12 * abs(both[1][0])
    with pytest.raises(ModelError, match="does not reach this speed"):
        tv.run_up_response(truck, speeds[:1], None, "12", [3.0])


def test_the_curve_is_drawn_as_far_as_it_reaches(truck: tv.Model) -> None:
    drawn = full_load_curve(truck, 300 * RPM, 3000 * RPM)
    assert drawn is not None and drawn.name == "mean_torque"
    assert drawn.speed.values[[0, -1]] / RPM == pytest.approx([600.0, 2000.0])
    assert full_load_curve(truck, 2200 * RPM, 3000 * RPM) is None


def test_what_takes_an_engine(truck: tv.Model) -> None:
    bare = truck.replaced(engine=None)
    assert truck.running_engine is truck.engine
    assert bare.engine_orders() == ()
    assert bare.full_load_curve is None
    assert bare.full_load(np.array([100.0, 200.0])).tolist() == [bare.typical_torque()] * 2
    for asked in (lambda: bare.running_engine, lambda: tv.response_map(bare), lambda: tv.run_up_response(bare)):
        with pytest.raises(ModelError, match="no engine, so nothing excites it"):
            asked()
