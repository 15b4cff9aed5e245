"""A rig with flywheels on it: what its sensors tell, and loops and stiffness out of raw channels."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import firwin, lfilter

import torsional as tv
from torsional.errors import ModelError
from torsional.plots.reach import plot_sensor_reach
from torsional.quantities.frequency_response import frequency_response
from torsional.studies.rig_model import Instruments, held_inertia, mounted_on_rig, sensor_reach
from torsional.studies.rig_run import Encoder, RigSensors, dynamic_stiffness, loop_of_run, measured_run

RIG = tv.load_model("examples/rig_dmf.yaml")
STIFFNESS, DAMPING = 13e3, 20.0


@pytest.fixture(scope="module")
def linear() -> tv.Model:
    """The shipped dual mass flywheel, a spring of 13 kNm/rad and a damper of 20 Nms/rad."""
    return mounted_on_rig(RIG, tv.load_model("examples/truck_dmf.yaml"))


@pytest.mark.parametrize("name", ["dmf", "dmf_two_stage", "dmf_arc_spring", "dmf_pendulum", "psva", "planetary_dmf"])
def test_any_absorber_is_mounted(name: str) -> None:
    truck = tv.load_model(f"examples/truck_{name}.yaml")
    mounted = mounted_on_rig(RIG, truck)
    assert mounted.absorber is not None and truck.absorber is not None
    assert mounted.absorber.kind == truck.absorber.kind and mounted.landmarks.springs == truck.landmarks.springs
    system, _ = tv.at_operating_point(mounted, 300.0)
    assert tv.modal(system).frequency.size >= 7


def test_the_sensor_by_hand() -> None:
    """Brake, brake shaft and clamp all but rigid: T_sensor/T = 1/(1 − ω² J/k), right to 5 % up to √(0.05/1.05) f₀."""
    rigid = {"components.brake.inertia": 1e9, "components.brake_shaft.stiffness": 1e12}
    rigid |= {"components.held_clamp.stiffness": 1e12, "components.brake_shaft.damping": 0.0}
    rigid |= {"components.torque_sensor.damping": 0.0, "components.brake_flange.inertia": 1e-9}
    rig = tv.changed(mounted_on_rig(RIG, tv.load_model("examples/truck_dmf.yaml")), rigid)
    inertia = held_inertia(rig)
    assert inertia == pytest.approx(rig.components["secondary"].inertia + 0.08)  # type: ignore[attr-defined]
    at = np.linspace(5.0, 60.0, 111)
    found = sensor_reach(rig, 0.05, frequency=at)
    squared = (2 * np.pi * at) ** 2 * inertia / 1.5e6
    np.testing.assert_allclose(found.sensed.values, 1 / (1 - squared), rtol=1e-5)
    np.testing.assert_allclose(found.corrected.values, 1.0, rtol=1e-5)
    exact = np.sqrt(0.05 / 1.05 * 1.5e6 / inertia) / (2 * np.pi)
    assert 0 <= exact - float(found.reach.sel(told="sensed")) <= 0.5
    assert float(found.reach.sel(told="corrected")) == 60.0


def test_a_brake_that_is_free_moves_too(linear: tv.Model) -> None:
    """At low frequencies the sensor feels the brake's share of all inertia behind the springs: right to 5 % nowhere as
    it stands, and far up once the inertia before it is corrected for."""
    found, behind = sensor_reach(linear, 0.05), 8.0 + 0.05
    share = behind / (behind + held_inertia(linear))
    assert abs(found.sensed.values[0]) == pytest.approx(share, rel=1e-3)
    assert np.isnan(found.reach.sel(told="sensed")) and float(found.reach.sel(told="corrected")) > 60
    assert sensor_reach(linear, 0.01).reach.values[1] < float(found.reach.sel(told="corrected"))


def test_the_reach_as_a_picture(linear: tv.Model) -> None:
    """The line of the torque as sensed is its ratio; a dot for what reaches anywhere, none for what does not."""
    found = sensor_reach(linear, 0.05)
    size, angle = plot_sensor_reach(found).axes
    lines = {str(line.get_gid()): np.asarray(line.get_ydata()) for line in size.lines}
    np.testing.assert_allclose(lines["sensed"], np.abs(found.sensed.values))
    dots = [float(np.asarray(line.get_xdata())[0]) for line in size.lines if len(np.atleast_1d(line.get_xdata())) == 1]
    assert sorted(dots) == sorted(found.reach.values[np.isfinite(found.reach.values)].tolist()) and len(dots) == 2
    assert np.abs(np.asarray(angle.lines[0].get_ydata())).max() > 170  # beyond the brake's resonance


def test_names_that_the_rig_does_not_have(linear: tv.Model) -> None:
    with pytest.raises(ModelError, match="did you mean 'torque_sensor'"):
        sensor_reach(linear, instruments=Instruments(sensor="torque_senser"))
    with pytest.raises(ModelError, match="no absorber"):
        mounted_on_rig(RIG, tv.load_model("examples/marine_line.yaml"))


def test_an_encoders_faults_by_hand() -> None:
    """Counts are floored, so that a count is at most one off; the turn's error is a sine of the whole angle."""
    angle = np.linspace(0.0, 40.0, 4001)
    draw = np.random.default_rng(0)
    off = angle - Encoder(counts=3600).read(angle, draw)
    assert off.min() >= -1e-12 and off.max() <= 2 * np.pi / 3600 + 1e-12
    told = Encoder(turn_error=1e-3, phase=0.5, zero=0.01).read(angle, draw)
    np.testing.assert_allclose(told - angle, 0.01 + 1e-3 * np.sin(angle + 0.5), atol=1e-12)
    assert np.std(Encoder(noise=2e-4).read(angle, draw) - angle) == pytest.approx(2e-4, rel=0.05)


def test_dynamic_stiffness_out_of_raw_channels(linear: tv.Model) -> None:
    """K = k + iωc of the flywheel through encoders of 20 000 counts and a noisy sensor, inertia corrected."""
    time = np.arange(0.0, 6.0, 1e-3)
    white = np.random.default_rng(1).standard_normal(time.size)
    push = 400.0 * lfilter(firwin(401, [4.0, 40.0], pass_zero=False, fs=1000.0), 1.0, white)
    drive, held = Encoder(counts=20_000, turn_error=5e-5), Encoder(counts=20_000)
    sensors = RigSensors(drive, held, torque_noise=1.0, torque_zero=5.0)
    run = measured_run(linear, time, push, 60.0, sensors, step=5e-4)
    told = dynamic_stiffness(run, 1.0, held_inertia(linear)).sel(frequency=slice(8.0, 30.0))
    omega = 2 * np.pi * told.frequency.values
    exact = STIFFNESS + 1j * omega * DAMPING
    assert told.coherence.values.min() > 0.9
    assert np.median(np.abs(told.dynamic_stiffness.values / np.abs(exact) - 1)) < 0.03
    assert np.median(np.abs(told.loss_angle.values - np.angle(exact))) < 0.03
    raw = dynamic_stiffness(run, 1.0).sel(frequency=slice(8.0, 30.0))
    assert np.median(np.abs(raw.dynamic_stiffness.values / np.abs(exact) - 1)) > 0.03


def test_a_loop_out_of_raw_channels(linear: tv.Model) -> None:
    """At 10 Hz: the torque over the angle is k φ + c φ̇ once the inertia is taken out, and some per cent off before."""
    time = np.arange(0.0, 4.0, 1e-3)
    run = measured_run(linear, time, 300.0 * np.sin(2 * np.pi * 10.0 * time) * np.clip(time, 0, 1), 60.0, mean=100.0)
    loop = loop_of_run(run, "10 Hz", held_inertia(linear), settled=2.5)
    waves = np.column_stack([np.ones(loop.time.size), loop.angle, np.gradient(loop.angle, loop.time)])
    told = np.linalg.lstsq(waves, loop.torque, rcond=None)[0]
    assert told[1] == pytest.approx(STIFFNESS, rel=0.01) and told[2] == pytest.approx(DAMPING, rel=0.03)
    plain = loop_of_run(run, "10 Hz", settled=2.5)
    share = 8.05 / (8.05 + held_inertia(linear))  # what the free brake has of all inertia behind the springs
    assert np.linalg.lstsq(waves, plain.torque, rcond=None)[0][1] == pytest.approx(share * STIFFNESS, rel=0.01)


def test_noise_of_the_output_leaves_h1_alone_and_that_of_the_input_does_not() -> None:
    draw, time = np.random.default_rng(2), np.arange(60_000) / 1000.0
    given = draw.standard_normal(time.size)
    clean, noisy = 2.0 * given, draw.standard_normal(time.size)
    out = frequency_response(time, given, clean + noisy, 0.5)
    assert np.mean(out.response.real[5:-5]) == pytest.approx(2.0, rel=0.01)
    assert np.mean(out.coherence[5:-5]) == pytest.approx(4 / 5, abs=0.01)
    into = frequency_response(time, given + noisy, clean, 0.5)
    assert np.mean(into.response.real[5:-5]) == pytest.approx(1.0, rel=0.02)
    with pytest.raises(ModelError, match="too few samples"):
        frequency_response(time[:100], given[:100], clean[:100], 0.09)
    with pytest.raises(ModelError, match="even times"):
        frequency_response(time**1.1, given, clean, 0.5)
