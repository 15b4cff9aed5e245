"""Steps in time against harmonic balance on the shipped truck, and motions that coexist (claims B1 and B5).

Neither knows of the other: one has orders and no time, the other time and no orders.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import xarray as xr

from torsional.engine import Excitation
from torsional.files import changed, load_model
from torsional.model import Model
from torsional.solvers.periodic import model_response
from torsional.solvers.transient import engine_drive, steady_state, steady_sweep
from torsional.system import System, assemble
from torsional.units import RPM

SPEEDS = (700.0, 800.0, 880.0, 940.0, 1100.0)
TORQUES = (1000.0, 1200.0)
SPAN = (650 * RPM, 1400 * RPM)
HIGHEST = 36.0


@cache
def truck() -> tuple[Model, System]:
    model = load_model("examples/truck_dmf_two_stage.yaml")
    return model, assemble(model.powertrain())


@cache
def branches(torque: float) -> xr.Dataset:
    return model_response(truck()[0], SPAN, torque, at=np.array(SPEEDS) * RPM, highest_order=HIGHEST)


def stable_points(torque: float, speed: float) -> xr.Dataset:
    found = branches(torque)
    at = (np.abs(found.speed.values - speed) < 1e-9) & found.stable.values
    return found.isel(point=np.flatnonzero(at))


@pytest.mark.parametrize("torque", TORQUES)
@pytest.mark.parametrize("rpm", SPEEDS)
def test_ten_operating_points_of_the_two_stage_truck(rpm: float, torque: float) -> None:
    model, system = truck()
    point = stable_points(torque, rpm * RPM)
    assert point.sizes["point"] == 1
    point = point.isel(point=0)
    doubled = point.kind.values[int(point.branch)] == "period doubling"
    drive = engine_drive(model, rpm * RPM, torque, HIGHEST)
    found = steady_state(system, drive, hold="vehicle", highest_order=9.0, parts=2)
    assert found.attrs["periods"] == (2 if doubled else 1)
    orders = [0.0, 1.5, 3.0, 4.5, 6.0]
    for element, name in (("dmf", "twist"), ("dmf", "torque"), ("gearbox", "torque")):
        timed = abs(found[name].sel(element=element, order=orders)).values
        balanced = abs(point[name].sel(element=element)).reindex(order=orders, fill_value=0.0).values
        largest = np.abs(balanced[1:]).max()
        np.testing.assert_allclose(timed[1:] / largest, balanced[1:] / largest, atol=1e-3)
        np.testing.assert_allclose(timed[0], balanced[0], rtol=1e-3)
        # phases too, of the orders that the two copies of a doubled motion share
        shared = [
            point[name].sel(element=element, order=[3.0, 6.0]),
            found[name].sel(element=element, order=[3.0, 6.0]),
        ]
        assert float(abs(shared[0] - shared[1]).max()) < 1e-3 * largest


def test_the_difference_falls_with_the_square_of_the_step() -> None:
    model, system = truck()
    point = stable_points(1200.0, 940 * RPM).isel(point=0)
    balanced = abs(point.twist.sel(element="dmf", order=[1.5, 3.0])).values
    drive = engine_drive(model, 940 * RPM, 1200.0, HIGHEST)

    def difference(step: float) -> tuple[float, float]:
        settings = {"hold": "vehicle", "step": step, "parts": 2, "highest_order": 9.0, "tolerance": 1e-6}
        found = steady_state(system, drive, start=point, **settings)  # type: ignore[arg-type]
        told = abs(found.twist.sel(element="dmf", order=[1.5, 3.0])).values
        return float(np.abs(told - balanced).max() / balanced.max()), found.attrs["step"]  # one that fits the period

    (coarse, longer), (fine, shorter) = difference(2e-4), difference(5e-5)
    assert np.log(coarse / fine) / np.log(longer / shorter) == pytest.approx(2.0, abs=0.15)
    assert fine < 2e-4


# --- several motions at one speed and torque: the shipped truck with less damping in its flywheel ---


@cache
def light() -> tuple[Model, System]:
    model = changed(truck()[0], {"absorber.damping": 5.0})
    return model, assemble(model.powertrain())


SOUGHT = (880.0, 920.0, 940.0)


@cache
def light_branches() -> xr.Dataset:
    return model_response(light()[0], (800 * RPM, 1000 * RPM), 1400.0, at=np.array(SOUGHT) * RPM, highest_order=HIGHEST)


@pytest.mark.parametrize("rpm", SOUGHT)
def test_motions_that_coexist_are_kept_to_and_unstable_ones_left(rpm: float) -> None:
    model, system = light()
    found = light_branches()
    drive = engine_drive(model, rpm * RPM, 1400.0, HIGHEST)
    twist = abs(found.twist.sel(element="dmf", order=[1.5, 3.0])).values
    here = np.flatnonzero(np.abs(found.speed.values - rpm * RPM) < 1e-9)
    assert found.stable.values[here].sum() == 2 and len(here) == 4
    stable = twist[here][found.stable.values[here]]
    for i in here:
        told = steady_state(system, drive, start=found.isel(point=i), hold="vehicle", parts=2, highest_order=9.0)
        ends = abs(told.twist.sel(element="dmf", order=[1.5, 3.0])).values
        distance = np.abs(stable - ends).max(axis=1) / stable.max(axis=1)
        assert distance.min() < 2e-3
        if found.stable.values[i]:
            assert np.abs(ends - twist[i]).max() < 2e-3 * twist[i].max()
        else:
            assert np.abs(ends - twist[i]).max() > 0.05 * twist[i].max()


def test_ways_up_and_down_differ_between_the_folds() -> None:
    model, system = light()
    folds = np.sort(light_branches().bifurcation_speed.values[light_branches().bifurcation_type.values == "fold"]) / RPM
    assert len(folds) == 4  # 869.8, 889.4, 900.9 and 942.5 rpm
    speeds = np.arange(855.0, 956.0, 5.0)

    def drive(speed: float) -> Excitation:
        return engine_drive(model, speed, 1400.0, HIGHEST)

    both = steady_sweep(system, drive, speeds * RPM, hold="vehicle", highest_order=9.0)
    up, down = abs(both.twist.sel(element="dmf", order=1.5)).values
    between = ((folds[0] < speeds) & (speeds < folds[1])) | ((folds[2] < speeds) & (speeds < folds[3]))
    clear = np.abs(speeds[:, None] - folds).min(axis=1) > 3.0  # next to a fold a sweep's own step may fall off
    assert ((np.abs(up - down) > 0.02) == between)[clear].all() and between[clear].sum() == 10
    assert (both.periods.values == 2).all()
