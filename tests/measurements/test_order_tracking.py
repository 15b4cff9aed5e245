"""Orders of run-ups that are known: amplitude to 0.5 %, phase to 1°, and our own solver's orders."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest
import xarray as xr
from scipy.interpolate import CubicSpline
from tests.measurements.run_ups import RPM, Array, RunUp
from tests.shipped import shipped

import torsional as tv

CLOSE = {
    0.5: 1e-3 + 0j,
    1.5: 2e-3 * np.exp(0.4j),
    2.0: 1e-3 * np.exp(-1.0j),
    2.5: 0.8e-3j,
    3.0: 8e-3 * np.exp(2.5j),
    6.0: 2e-3 * np.exp(2.0j),
}
PITCH = 2 * np.pi / 60


def steady_wheel(run: RunUp, teeth: int = 60, missing: int = 0) -> xr.Dataset:
    """The shaft that a wheel tells of; without a gap its first tooth is the second of the turn."""
    index = 0.0 if missing else 2 * np.pi / teeth
    return tv.shaft_from_pulses(run.pulses(teeth, missing), teeth, missing=missing, index_angle=index)


def worst(found: xr.DataArray, wanted: Array) -> tuple[float, float]:
    """Largest error of amplitudes, relative, and of phases [deg]."""
    ratio = found.values / wanted
    return float(np.abs(np.abs(ratio) - 1).max()), float(np.degrees(np.abs(np.angle(ratio))).max())


def expected(run: RunUp, found: xr.Dataset) -> Mapping[float, Array]:
    alpha = run.crank_angle(found.time.values)
    return {n: value * run.size(alpha) for n, value in run.orders.items()}


@pytest.mark.parametrize("rate", [50.0, 200.0])
@pytest.mark.parametrize("missing", [0, 2])
@pytest.mark.parametrize("growth", [0.0, 0.003])
def test_close_orders_of_the_tachos_own_shaft(rate: float, missing: int, growth: float) -> None:
    """The reference vibrates itself by all of them; the largest is ten times the smallest beside it."""
    run = RunUp(600 * RPM, rate * RPM, 1400 / rate, CLOSE, growth=growth)
    shaft = steady_wheel(run, missing=missing)
    found = tv.track_orders(None, tv.mean_rotation(shaft), list(CLOSE), shafts={"crank": shaft})
    assert found.angle.dims == ("speed", "order", "node")
    for n, wanted in expected(run, found).items():
        size, phase = worst(found.angle.sel(order=n, node="crank"), wanted)
        assert size < 5e-3
        assert phase < 1.0
    assert found.speed.values == pytest.approx(run.speed(run.crank_angle(found.time.values)), rel=1e-4)


def test_orders_of_steady_size_without_a_window() -> None:
    run = RunUp(600 * RPM, 50 * RPM, 12.0, CLOSE)
    shaft = steady_wheel(run)
    rotation = tv.mean_rotation(shaft)
    found = tv.track_orders(None, rotation, list(CLOSE), shafts={"crank": shaft}, cycles=1, window="none")
    for n, wanted in expected(run, found).items():
        assert worst(found.angle.sel(order=n, node="crank"), wanted)[0] < 5e-4


@pytest.mark.parametrize("rate", [40.0, 160.0])
def test_a_signal_in_noise_beside_a_tacho_that_vibrates(rate: float) -> None:
    """0.4° of vibration at the tacho would make sidebands of 2 % at order 3 if its angle were taken for the crank's."""
    shaken = RunUp(700 * RPM, rate * RPM, 800 / rate, {3.0: np.radians(0.4) * np.exp(1j), 1.5: 3e-3})
    time = np.arange(0.0, shaken.duration, 1 / 5000)
    alpha = shaken.crank_angle(time)
    orders = {1.5: 2.0 * np.exp(0.3j), 2.0: 0.7j, 2.5: 1.5 + 0j, 3.0: 10.0 * np.exp(-2j), 12.0: 1.0 + 0j}
    waves = sum((value * np.exp(1j * n * alpha)).real for n, value in orders.items())
    chance = np.random.default_rng(2)
    signal = xr.DataArray(waves + 0.05 * chance.standard_normal(time.size), {"time": time}, name="torque")
    found = tv.track_orders(signal, tv.mean_rotation(steady_wheel(shaken)), list(orders))
    for n, wanted in orders.items():
        mean = (found.torque.sel(order=n) / wanted).mean()  # noise of 0.05 in some hundred samples a window: 0.5 %
        assert abs(mean) == pytest.approx(1.0, abs=2e-3)
        assert np.degrees(np.angle(mean)) == pytest.approx(0.0, abs=0.3)
    assert worst(found.torque.sel(order=3.0), orders[3.0] + np.zeros(found.speed.size))[0] < 5e-3
    assert found.torque.attrs["amplitude"] == "complex 0-peak"


def test_sensors_on_different_shafts() -> None:
    """A gearbox shaft at 1.4 times the engine's speed, told at engine orders, with the tacho on the crank."""
    crank = RunUp(650 * RPM, 80 * RPM, 12.0, {3.0: 5e-3 * np.exp(0.2j), 1.5: 1e-3})
    shaft = RunUp(650 * RPM, 80 * RPM, 12.0, {3.0: 2e-3 * np.exp(-1.2j), 1.5: 4e-3j, 6.0: 1e-3 + 0j}, ratio=1.4)
    behind = tv.shaft_from_pulses(shaft.pulses(90), 90, name="gearbox")
    rotation = tv.mean_rotation(steady_wheel(crank))
    found = tv.track_orders(None, rotation, [1.5, 3.0, 6.0], shafts={"crank": steady_wheel(crank), "gearbox": behind})
    for node, run in (("crank", crank), ("gearbox", shaft)):
        for n, wanted in expected(run, found).items():
            size, phase = worst(found.angle.sel(order=n, node=node), wanted)
            assert size < 5e-3
            assert phase < 1.0


def test_a_tacho_on_the_camshaft() -> None:
    """One turn of it is a cycle of 720°, so that the gap itself tells half orders' phases."""
    cam = RunUp(700 * RPM, 60 * RPM, 10.0, {1.5: 1e-3j, 0.5: 2e-3 + 0j}, ratio=0.5)
    shaft = steady_wheel(cam, 60, 2)
    found = tv.track_orders(None, tv.mean_rotation(shaft, ratio=0.5), [0.5, 1.5], shafts={"cam": shaft})
    for n, wanted in expected(cam, found).items():
        size, phase = worst(found.angle.sel(order=n, node="cam"), wanted)
        assert size < 5e-3
        assert phase < 1.0


def test_the_gap_makes_no_orders() -> None:
    """Of a pure order 12 a cubic spline across the gap of a 60−2 wheel makes 1 % at others."""
    run = RunUp(600 * RPM, 100 * RPM, 5.0, {12.0: 2e-3 + 0j})
    shaft = steady_wheel(run, missing=2)
    found = tv.track_orders(None, tv.mean_rotation(shaft), np.arange(0.5, 14.1, 0.5), shafts={"c": shaft})
    sizes = abs(found.angle.sel(node="c")).max("speed") / 2e-3
    assert float(sizes.sel(order=12.0)) == pytest.approx(1.0, abs=1e-3)
    assert float(sizes.drop_sel(order=12.0).max()) < 1e-3


def test_marks_of_cylinder_1_put_the_zero_and_tell_the_turns_apart() -> None:
    run = RunUp(600 * RPM, 50 * RPM, 10.0, {1.5: 2e-3 * np.exp(0.4j), 3.0: 5e-3 + 0j})
    shaft = tv.shaft_from_pulses(run.pulses(60), 60, index_angle=1.234)
    firing = run.time(4 * np.pi * np.arange(5, 30) + 2 * np.pi)  # as if cylinder 1 fired one turn later
    found = tv.track_orders(None, tv.mean_rotation(shaft, marks=firing), [1.5, 3.0], shafts={"crank": shaft})
    turned = {n: wanted * np.exp(2j * np.pi * n) for n, wanted in expected(run, found).items()}
    for n, wanted in turned.items():
        assert worst(found.angle.sel(order=n, node="crank"), wanted)[1] < 1.0


def test_orders_lie_where_they_are() -> None:
    """A window with its end point twice has order 0.5 at 0.499; here neighbours of a lone order hold nothing."""
    run = RunUp(1000 * RPM, 0.0, 4.0, {1.5: 1e-2 + 0j})
    shaft = steady_wheel(run)
    orders = np.arange(0.5, 6.1, 0.5)
    found = tv.track_orders(None, tv.mean_rotation(shaft), orders, shafts={"c": shaft}, cycles=1, window="none")
    sizes = abs(found.angle).isel(speed=5, node=0).values
    assert sizes[2] == pytest.approx(1e-2, rel=1e-4)
    assert np.delete(sizes, 2).max() < 1e-4 * sizes[2]


def test_the_floor_is_what_a_clock_makes_of_a_steady_shaft() -> None:
    """Random phases of the clock: mean squares of orders that are not there, against 4 σ² b/M."""
    chance = np.random.default_rng(7)
    tick, omega = 1e-6, 150.0
    times = np.cumsum(PITCH / (omega * (1 + 1e-3 * chance.standard_normal(60 * 1200).cumsum() / 60)))
    true = tv.shaft_from_pulses(times, 60, resolution=tick)
    seen = tv.shaft_from_pulses(np.round(times / tick) * tick, 60)
    assert seen.attrs["resolution"] == pytest.approx(tick, rel=1e-6)
    orders = [2.5, 5.0, 7.5, 10.0]
    settings = {"orders": orders, "cycles": 2, "overlap": 0.0}
    rotation = tv.mean_rotation(true)
    both = [tv.track_orders(None, rotation, shafts={"c": shaft}, **settings) for shaft in (true, seen)]
    made = abs(both[1].angle - both[0].angle) ** 2
    floor = float((both[1].noise ** 2).mean())
    assert made.size > 1000
    assert np.sqrt(float(made.mean()) / floor) == pytest.approx(1.0, abs=0.05)


def test_the_truck_run_up_against_its_linear_response() -> None:
    """120 rpm/s is quasi-steady off the resonances; wheels of 60 and 90 teeth see the orders of the linear response."""
    truck, orders = shipped("truck_dmf"), [3.0, 6.0]
    system, _ = tv.at_operating_point(truck, 1500.0, "12")
    throws = truck.landmarks.throws
    drive = truck.engine.excitation(throws, np.linspace(700, 1500, 41) * RPM, 1500.0, orders=orders)
    ramp = tv.SpeedProfile.ramp(800 * RPM, 1400 * RPM, 5.0)
    run = tv.transient(system, drive, 5.0, speed=ramp, start="vibrating", output=5e-4)
    shafts = {node: wheel_of(run, node, teeth) for node, teeth in (("primary", 60), ("gearbox_input", 90))}
    torque = run.torque.sel(element="clutch", drop=True).rename("clutch")
    found = tv.track_orders(torque, tv.mean_rotation(shafts["primary"]), orders, shafts=shafts)
    wanted = tv.run_up_response(truck, found.speed.values, 1500.0, "12", orders)
    late = found.speed > 1150 * RPM
    for node in shafts:
        ratio = abs(found.angle / wanted.angle).sel(order=3.0, node=node)
        assert abs(ratio - 1).max() < (0.006 if node == "primary" else 0.06)  # the clutch's mode is near 800 rpm
        assert abs(ratio.where(late, drop=True) - 1).max() < 0.003
    ratio = abs(found.clutch / wanted.torque.sel(element="clutch")).sel(order=3.0)
    assert abs(ratio.where(late, drop=True) - 1).max() < 0.003


def wheel_of(run: xr.Dataset, node: str, teeth: int) -> xr.Dataset:
    """What a wheel on a node of a run in time tells of it."""
    turned = run.crank_angle.values + run.angle.sel(node=node).values
    pitch = 2 * np.pi / teeth
    number = np.arange(np.ceil(turned[0] / pitch), np.floor(turned[-1] / pitch))
    times = CubicSpline(turned, run.time.values)(number * pitch)
    return tv.shaft_from_pulses(times, teeth, index_angle=float(number[0] * pitch), name=node)


def test_channels_of_several_places_and_rasters() -> None:
    run = RunUp(900 * RPM, 30 * RPM, 6.0)
    quick, slow = np.arange(0.0, 6.0, 5e-4), np.arange(0.1, 5.9, 2e-3)
    both = np.stack([np.cos(3 * run.crank_angle(quick)), 2 * np.cos(1.5 * run.crank_angle(quick))], axis=1)
    signals = xr.Dataset(
        {
            "torque": (("time", "element"), both, {"quantity": "torque", "units": "Nm"}),
            "speed": (("time_2",), np.sin(1.5 * run.crank_angle(slow)), {"units": "V"}),
        },
        {"time": quick, "time_2": slow, "element": ["clutch", "shaft"]},
    )
    found = tv.track_orders(signals, tv.mean_rotation(steady_wheel(run)), [1.5, 3.0])
    assert found.torque.dims == ("speed", "order", "element")
    assert abs(found.torque).isel(speed=3).values == pytest.approx(np.array([[0.0, 2.0], [1.0, 0.0]]), abs=2e-4)
    assert found.speed_signal.isel(speed=3).values == pytest.approx(np.array([-1j, 0.0]), abs=2e-3)
    assert found.torque.attrs["units"] == "Nm" and found.speed_signal.attrs["units"] == "V"


def test_what_is_too_quick_for_the_angles_is_not_folded() -> None:
    """A tone at 4 kHz beside order 3, which a raster of 48 angles a turn alone would put anywhere."""
    run = RunUp(600 * RPM, 100 * RPM, 6.0)
    time = np.arange(0.0, 6.0, 1e-4)
    signal = xr.DataArray(np.cos(3 * run.crank_angle(time)) + 5 * np.cos(2 * np.pi * 4e3 * time), {"time": time})
    found = tv.track_orders(signal, tv.mean_rotation(steady_wheel(run)), [1.5, 3.0])
    assert worst(found.signal.sel(order=3.0), np.ones(found.speed.size))[0] < 1e-3
    assert abs(found.signal.sel(order=1.5)).max() < 1e-3


def test_refusals() -> None:
    run = RunUp(900 * RPM, 30 * RPM, 3.0)
    rotation = tv.mean_rotation(steady_wheel(run))
    slow = np.arange(0.0, 3.0, 0.01)
    with pytest.raises(
        tv.ModelError,
        match=r"brake: .*too seldom; found 6\.\d+ samples a turn.*7\.68 and more for order 3; lower orders, up to 2",
    ):
        tv.track_orders(xr.DataArray(slow, {"time": slow}, name="brake"), rotation, [3.0])
    with pytest.raises(tv.ModelError, match="neither signals nor shafts"):
        tv.track_orders(None, rotation, [3.0])
    elsewhere = xr.DataArray(slow, {"time": slow + 10}, name="late")
    with pytest.raises(tv.ModelError, match="holds no whole cycle"):
        tv.track_orders(elsewhere, rotation, [0.5])
    with pytest.raises(tv.ModelError, match=r"torque: .* no numbers; found 1 of 300 values, the first at 0 s"):
        tv.track_orders(xr.DataArray(np.where(slow, 1.0, np.nan), {"time": slow}, name="torque"), rotation, [0.5])
    with pytest.raises(tv.ModelError, match="three cycles; found"):
        tv.mean_rotation(steady_wheel(RunUp(900 * RPM, 0.0, 0.3)))
    with pytest.raises(tv.ModelError, match="marks: no mark lies where"):
        tv.mean_rotation(steady_wheel(run), marks=[17.0])
    with pytest.raises(tv.ModelError, match="marks stand at different crank angles"):
        tv.mean_rotation(steady_wheel(run), marks=[1.0, 1.03, 1.05])


def test_what_is_of_another_kind_is_told_what_makes_it() -> None:
    shaft = steady_wheel(RunUp(900 * RPM, 30 * RPM, 3.0))
    rotation = tv.mean_rotation(shaft)
    with pytest.raises(
        tv.ModelError, match=r"shaft: .*'shaft_angle' is wanted; found mean rotation; shaft_from_pulses"
    ):
        tv.mean_rotation(rotation)
    with pytest.raises(tv.ModelError, match=r"rotation: .*'crank_angle' is wanted; found shaft angle; mean_rotation"):
        tv.track_orders(None, shaft, [3.0], shafts={"c": shaft})
    with pytest.raises(tv.ModelError, match=r"convention: .*found 'peak'; allowed: 0-peak, RMS, peak-to-peak"):
        tv.in_convention(xr.DataArray([1.0]), "peak")  # type: ignore[arg-type]


def test_conventions() -> None:
    size = xr.DataArray([3.0 + 4.0j])
    told = [tv.in_convention(size, name) for name in ("0-peak", "RMS", "peak-to-peak")]
    assert [float(each[0]) for each in told] == pytest.approx([5.0, 5 / np.sqrt(2), 10.0])
    assert told[1].attrs["amplitude"] == "RMS"
