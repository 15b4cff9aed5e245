"""Pulses, counters and encoders become angles: faults mended and told, noise as Monte Carlo has it."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from tests.measurements.run_ups import RPM, Array, RunUp

import torsional as tv

RUN = RunUp(700 * RPM, 100 * RPM, 5.0, {3.0: 8e-3 + 0j, 1.5: 3e-3j})


def angle_error(shaft: xr.Dataset, run: RunUp) -> float:
    """By what the angle [rad] differs from the shaft's own, whole turns and a tooth at the beginning aside."""
    alpha = run.crank_angle(shaft.time.values)
    off = shaft.shaft_angle.values - run.ratio * alpha - run.vibration(alpha)
    return float(np.abs(off - np.median(off)).max())


def test_teeth_of_the_gap_are_put_in() -> None:
    shaft = tv.shaft_from_pulses(RUN.pulses(60, 2), 60, missing=2)
    assert (shaft.pulse == "gap").mean() == pytest.approx(2 / 60, abs=1e-3)
    assert angle_error(shaft, RUN) < 5e-5  # of 8e-3
    assert not (shaft.pulse == "lost").any()
    behind = shaft.isel(time=slice(3, None)).shaft_angle.where(shaft.pulse == "gap", drop=True)
    assert np.unique(np.rint(behind / (2 * np.pi / 60)) % 60).tolist() == [58, 59]


@pytest.mark.parametrize(("teeth", "missing"), [(60, 2), (36, 1), (12, 1), (60, 0), (4, 0)])
def test_a_record_may_begin_and_end_anywhere(teeth: int, missing: int) -> None:
    """In a gap or beside one: the same angles, but for whole turns where the gap tells them."""
    times = RUN.pulses(teeth, missing)
    whole = tv.shaft_from_pulses(times, teeth, missing=missing)
    for cut in range(1, 2 * teeth):
        part = tv.shaft_from_pulses(times[cut : times.size - cut], teeth, missing=missing)
        there = whole.sel(time=part.time[part.pulse == "measured"].values)
        off = part.shaft_angle.sel(time=there.time).values - there.shaft_angle.values
        assert np.ptp(off) < 1e-9
        assert not missing or off.mean() / (2 * np.pi) == pytest.approx(round(off.mean() / (2 * np.pi)), abs=1e-9)
        assert not (part.pulse == "lost").any() and not part.sizes["extra_pulse"]


def faulty(times: Array, seed: int) -> tuple[Array, int, int]:
    """Some pulses lost, some put in between: at random, in runs of two as well."""
    chance = np.random.default_rng(seed)
    lost = np.unique(np.concatenate([chance.choice(np.arange(20, times.size - 20), 25, replace=False), [300, 301]]))
    places = chance.choice(np.arange(20, times.size - 20), 20, replace=False)
    between = times[places] + chance.uniform(0.02, 0.9, places.size) * np.diff(times)[places]
    return np.sort(np.concatenate([np.delete(times, lost), between])), lost.size, places.size


@pytest.mark.parametrize("missing", [0, 2])
@pytest.mark.parametrize("seed", range(5))
def test_lost_and_false_pulses_are_mended_and_told(missing: int, seed: int) -> None:
    times = RUN.pulses(60, missing)
    spoilt, lost, added = faulty(times, seed)
    shaft = tv.shaft_from_pulses(spoilt, 60, missing=missing)
    whole = tv.shaft_from_pulses(times, 60, missing=missing)
    assert shaft.sizes["time"] == whole.sizes["time"]
    assert shaft.shaft_angle.values == pytest.approx(whole.shaft_angle.values, abs=1e-9)
    assert int((shaft.pulse == "lost").sum()) >= lost
    assert shaft.sizes["extra_pulse"] >= added - 2  # one beside a lost pulse may take its place
    assert np.abs(shaft.time.values - whole.time.values).max() < 0.5 * np.diff(whole.time.values).max()
    assert np.median(np.abs(shaft.time.values - whole.time.values)) == 0.0


def test_a_wheel_that_is_another_one_is_named() -> None:
    gapped = RUN.pulses(60, 2)
    with pytest.raises(tv.ModelError, match=r"looks like a wheel of 60 teeth, 2 of them missing \(60-2\)"):
        tv.shaft_from_pulses(gapped, 60)
    with pytest.raises(tv.ModelError, match=r"no gaps of 1 in each turn.*looks like a wheel of 60 teeth, 2"):
        tv.shaft_from_pulses(gapped, 60, missing=1)
    with pytest.raises(tv.ModelError, match=r"no gaps of 2.*missing=0"):
        tv.shaft_from_pulses(RUN.pulses(60), 60, missing=2)
    with pytest.raises(tv.ModelError, match=r"no gaps of 2.*\(60-2\)"):
        tv.shaft_from_pulses(gapped, 58, missing=2)


def test_pulses_that_cannot_be_a_wheels() -> None:
    times = RUN.pulses(60)
    chance = np.random.default_rng(1)
    with pytest.raises(tv.ModelError, match="too many pulses do not fit"):
        tv.shaft_from_pulses(np.sort(chance.uniform(0, 5, 3000)), 60)
    with pytest.raises(tv.ModelError, match=r"pulses stop for more than half a turn; found from 1\.\d+ to 2\.\d+ s"):
        tv.shaft_from_pulses(times[(times < 1.5) | (times > 2.5)], 60)
    with pytest.raises(tv.ModelError, match="turn twice at least; found 50 pulses"):
        tv.shaft_from_pulses(times[:50], 60)
    with pytest.raises(tv.ModelError, match="times must rise"):
        tv.shaft_from_pulses(times[::-1], 60)
    with pytest.raises(tv.ModelError, match="three teeth at least"):
        tv.shaft_from_pulses(times, 4, missing=2)


def test_a_wheel_of_one_tooth() -> None:
    """Once a turn is enough for a mean speed."""
    run = RunUp(700 * RPM, 100 * RPM, 5.0)
    shaft = tv.shaft_from_pulses(run.pulses(1), 1)
    rotation = tv.mean_rotation(shaft)
    wanted = run.speed(run.crank_angle(rotation.time.values))
    assert rotation.speed.values == pytest.approx(wanted, rel=1e-4)


@pytest.mark.parametrize("teeth", [60, 120])
def test_noise_of_speed_as_chance_has_it(teeth: int) -> None:
    """ω² Δt z/(4π√6) for the two intervals at a tooth; times are rounded with a phase that wanders."""
    chance = np.random.default_rng(3)
    tick, omega = 2e-6, 100.0
    angle = 2 * np.pi / teeth * np.arange(40_000)
    times = angle / omega + 1e-4 * np.cumsum(chance.standard_normal(angle.size)) / 100
    seen = tv.shaft_from_pulses(np.round(times / tick) * tick, teeth)
    true = tv.shaft_from_pulses(times, teeth)
    spread = float((seen.angular_velocity - true.angular_velocity.values)[5:-5].std())
    formula = omega**2 * tick * teeth / (4 * np.pi * np.sqrt(6))
    assert float(seen.speed_noise[5:-5].mean()) == pytest.approx(formula, rel=5e-3)
    assert spread == pytest.approx(formula, rel=0.03)


def test_pulses_of_a_voltage_with_noise() -> None:
    """An inductive sensor: a sine that grows with speed, noise, and an offset."""
    run = RunUp(700 * RPM, 100 * RPM, 2.0, {3.0: 5e-3 + 0j})
    time = np.arange(0.0, 2.0, 1e-5)
    angle = run.crank_angle(time) + run.vibration(run.crank_angle(time))
    chance = np.random.default_rng(5)
    volts = 0.4 + run.speed(run.crank_angle(time)) / 100 * np.sin(60 * angle) + 0.01 * chance.standard_normal(time.size)
    found = tv.pulse_times(xr.DataArray(volts, {"time": time}, name="tacho"), level=0.4)
    wanted = run.passing(2 * np.pi / 60 * np.arange(1, found.size + 1))
    at = found.values if found.values[0] > 1e-4 else found.values[1:]
    assert np.abs(at - wanted[: at.size]).max() < 2e-5
    assert found.attrs["resolution"] == 0.0


def test_pulses_of_steep_edges_are_known_to_a_sample() -> None:
    time = np.arange(0.0, 1.0, 1e-5)
    volts = 5.0 * (np.sin(2 * np.pi * 777.7 * time) > 0.3)
    for falling in (False, True):
        found = tv.pulse_times(xr.DataArray(volts, {"time": time}), falling=falling)
        assert found.size == pytest.approx(777, abs=1)
        assert np.diff(found) == pytest.approx(1 / 777.7, abs=1.01e-5)
        assert found.attrs["resolution"] == pytest.approx(1e-5)


def test_voltages_that_are_none() -> None:
    time = np.arange(0.0, 1.0, 1e-3)
    with pytest.raises(tv.ModelError, match=r"n: the voltage does not change.*2 throughout"):
        tv.pulse_times(xr.DataArray(np.full(1000, 2.0), {"time": time}, name="n"))
    with pytest.raises(tv.ModelError, match=r"level is beyond the voltage; found 7; allowed: between -1 and 1"):
        tv.pulse_times(xr.DataArray(np.sign(np.sin(50 * time + 0.1)), {"time": time}), level=7.0)
    with pytest.raises(tv.ModelError, match="no two pulses"):
        tv.pulse_times(xr.DataArray(np.arange(1000.0), {"time": time}))
    with pytest.raises(tv.ModelError, match=r"over one raster of times; found dimensions \(a, b\)"):
        tv.pulse_times(xr.DataArray(np.zeros((2, 2)), dims=("a", "b")))


@pytest.mark.parametrize(("bits", "counts"), [(8, 200), (16, 1024), (32, 4096)])
@pytest.mark.parametrize("begins", [0, -300])
def test_counters_wrap(bits: int, counts: int, begins: int) -> None:
    time = np.arange(0.0, 5.0, 1e-4)
    alpha = RUN.crank_angle(time)
    count = np.floor((alpha + RUN.vibration(alpha)) * counts / (2 * np.pi)) + 2.0**bits + begins
    shaft = tv.shaft_from_counter(xr.DataArray(count % 2**bits, {"time": time}), counts, bits=bits)
    assert angle_error(shaft, RUN) < 1.1 * max(2 * np.pi / counts, 1e-4 * 170)
    rotation = tv.mean_rotation(shaft)
    assert rotation.speed.values == pytest.approx(RUN.speed(RUN.crank_angle(rotation.time.values)), rel=3e-3)
    found = tv.track_orders(None, rotation, [1.5, 3.0], shafts={"c": shaft})
    noise = float(found.noise.max())
    assert abs(abs(found.angle.sel(order=3.0)) - 8e-3).max() < 0.004 * 8e-3 + 4 * noise


def test_counters_that_are_none() -> None:
    time = np.arange(0.0, 1.0, 1e-3)
    with pytest.raises(tv.ModelError, match="turns back; found"):
        tv.shaft_from_counter(xr.DataArray(np.round(1000 + 100 * np.sin(5 * time)), {"time": time}), 60)
    with pytest.raises(tv.ModelError, match="nearly half its range"):
        tv.shaft_from_counter(xr.DataArray((120.0 * np.arange(1000)) % 256, {"time": time}), 60)
    with pytest.raises(tv.ModelError, match="whole numbers"):
        tv.shaft_from_counter(xr.DataArray(time, {"time": time}), 60)
    with pytest.raises(tv.ModelError, match="does not count"):
        tv.shaft_from_counter(xr.DataArray(np.zeros(1000), {"time": time}), 60)
    with pytest.raises(tv.ModelError, match="more than its bits"):
        tv.shaft_from_counter(xr.DataArray(np.arange(1000), {"time": time}), 60, bits=8)


@pytest.mark.parametrize("unit", ["deg", "rad"])
@pytest.mark.parametrize("wraps", [True, False])
def test_encoders(unit: str, wraps: bool) -> None:
    time = np.arange(0.0, 5.0, 2e-4)
    alpha = RUN.crank_angle(time)
    angle = alpha + RUN.vibration(alpha)
    angle = angle % (2 * np.pi) if wraps else -angle
    shown = np.degrees(angle) if unit == "deg" else angle
    shaft = tv.shaft_from_encoder(xr.DataArray(shown, {"time": time}, attrs={"units": unit}))
    found = tv.track_orders(None, tv.mean_rotation(shaft), [1.5, 3.0], shafts={"c": shaft})
    assert abs(found.angle.sel(order=3.0)).values == pytest.approx(8e-3, rel=2e-3)
    assert float(found.noise.max()) == 0.0


def test_an_encoder_of_few_bits_and_one_in_noise() -> None:
    time = np.arange(0.0, 5.0, 2e-5)
    alpha = RUN.crank_angle(time)
    angle = alpha + RUN.vibration(alpha)
    steps = np.floor(angle * 512 / (2 * np.pi)) * 2 * np.pi / 512
    chance = np.random.default_rng(4)
    for shown in (steps, angle + 1e-3 * chance.standard_normal(time.size)):
        shaft = tv.shaft_from_encoder(xr.DataArray(shown % (2 * np.pi), {"time": time}, attrs={"units": "rad"}))
        found = tv.track_orders(None, tv.mean_rotation(shaft), [1.5, 3.0], shafts={"c": shaft})
        assert abs(found.angle.sel(order=3.0)).values == pytest.approx(
            8e-3, rel=4e-3, abs=4 * float(found.noise.max()) + 3e-5
        )


def test_encoders_that_are_none() -> None:
    time = np.arange(0.0, 1.0, 1e-3)
    with pytest.raises(tv.ModelError, match=r"needs a unit of angle; found 'V'.*unit='deg'"):
        tv.shaft_from_encoder(xr.DataArray(time, {"time": time}, attrs={"units": "V"}))
    with pytest.raises(tv.ModelError, match=r"turns less than once; found 0.3"):
        tv.shaft_from_encoder(xr.DataArray(2 * time, {"time": time}), unit="rad")
    with pytest.raises(tv.ModelError, match="sampled too seldom"):
        tv.shaft_from_encoder(xr.DataArray(3000 * time, {"time": time}), unit="rad")
    with pytest.raises(tv.ModelError, match="turns back"):
        tv.shaft_from_encoder(xr.DataArray(10 * time + 5 * np.sin(9 * time), {"time": time}), unit="rad")
    with pytest.raises(tv.ModelError, match="does not turn throughout"):
        tv.shaft_from_speed(xr.DataArray(np.sin(5 * time), {"time": time}), unit="rpm")


def test_a_speed_in_rpm() -> None:
    time = np.linspace(0.0, 5.0, 501)
    speed = xr.DataArray(RUN.speed(RUN.crank_angle(time)) / RPM, {"time": time}, attrs={"units": "1/min"})
    rotation = tv.mean_rotation(tv.shaft_from_speed(speed))
    assert rotation.crank_angle.values == pytest.approx(RUN.crank_angle(rotation.time.values), abs=1e-3)


def test_pitch_errors_are_learnt_and_taken_out() -> None:
    chance = np.random.default_rng(8)
    pitch = np.radians(0.05) * chance.standard_normal(60)
    steady, run = RunUp(900 * RPM, 0.0, 4.0), RunUp(700 * RPM, 100 * RPM, 5.0, {3.0: 2e-3 + 0j})

    def pulses(of: RunUp) -> Array:
        number = np.arange(0, int(of.crank_angle(np.array([of.duration]))[0] * 60 / (2 * np.pi)))
        return of.passing((number * (2 * np.pi / 60) + pitch[number % 60])[1:])

    index = 2 * np.pi / 60
    learnt = tv.tooth_pitch(tv.shaft_from_pulses(pulses(steady), 60, index_angle=index), 0.5, 3.5)
    assert learnt == pytest.approx(np.roll(pitch - pitch.mean(), -1), abs=1e-6)
    found = {}
    for name, off in (("plain", ()), ("mended", learnt)):
        shaft = tv.shaft_from_pulses(pulses(run), 60, index_angle=index, pitch=off)
        found[name] = tv.track_orders(None, tv.mean_rotation(shaft), [1.0, 2.0, 3.0], shafts={"c": shaft}).angle
    assert float(abs(found["plain"].sel(order=1.0)).mean()) > 5e-5
    assert float(abs(found["mended"].sel(order=1.0)).max()) < 4e-6
    assert abs(found["mended"].sel(order=3.0)).values == pytest.approx(2e-3, rel=4e-3)
    with pytest.raises(tv.ModelError, match="three turns at least"):
        tv.tooth_pitch(tv.shaft_from_pulses(pulses(steady), 60), 0.5, 0.75)
    with pytest.raises(tv.ModelError, match="pitch error is wanted for each tooth; found 3; allowed: 60"):
        tv.shaft_from_pulses(pulses(run), 60, pitch=[0.0, 0.1, 0.2])


@pytest.mark.parametrize("missing", [0, 2])
def test_a_speed_that_swings_by_half_within_a_turn(missing: int) -> None:
    """Cranking: 30 % at order 3 and 15 % at order 1.5, pulses lost and doubled; none is counted wrongly."""
    cranking = RunUp(200 * RPM, 60 * RPM, 4.0, {3.0: 0.1 + 0j, 1.5: 0.1j})
    times = cranking.pulses(60, missing)
    spoilt = np.sort(np.append(np.delete(times, [150, 333, 500]), times[401] + 0.4 * (times[402] - times[401])))
    shaft = tv.shaft_from_pulses(spoilt, 60, missing=missing)
    assert angle_error(shaft, cranking) < 0.2 * 2 * np.pi / 60
    assert shaft.sizes["extra_pulse"] == 1
