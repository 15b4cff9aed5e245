"""Channels as quantities of nodes and elements: units, signs, delays, rasters, and what is refused."""

from __future__ import annotations

from pathlib import Path

import jsonschema
import numpy as np
import pytest
import xarray as xr
from ruamel.yaml import YAML
from tests.shipped import EXAMPLES

from torsional import ModelError, load_model
from torsional.measurements import load_mapping, mapped, read_measurement, write_measurement
from torsional.measurements.mapping_file import MappingFile, mapping_schema
from torsional.measurements.rasters import brought
from torsional.measurements.recording import Channel, Found, Raster, pulses, recording
from torsional.measurements.starting import starter
from torsional.results import load_results, save_results

FAST = Raster(np.arange(2001) / 1000.0)
SLOW = Raster(0.1 + np.arange(150) / 100.0)


def ramp(raster: Raster) -> np.ndarray:
    return 600.0 + 300.0 * raster.values


def measured() -> xr.Dataset:
    """Two speeds that rise by 300 rpm/s, a torque in kNm counted the other way, pulses."""
    channels = [
        Channel("n_mot", ramp(FAST), FAST, "1/min"),
        Channel("n gbx.in", ramp(SLOW) / 2.0, SLOW, "rpm"),
        Channel("M", -0.5 * np.ones(150), SLOW, "kNm"),
        Channel("volts", np.linspace(0.0, 5.0, 2001), FAST, "V"),
        Channel("holes", np.where(np.arange(2001) == 7, np.nan, 1.0), FAST, "Nm"),
        Channel("dead", np.full(2001, np.nan), FAST, "Nm"),
        pulses("tacho", np.array([0.1, 0.11, 0.12])),
    ]
    return recording(Found(channels, "made", "2026-11-23T05:42:11"), "rig.mf4")


def mapping(settings: str = "", **channels: str) -> MappingFile:
    text = "torsional_mapping: 1\n" + settings + "\nchannels:\n"
    text += "".join(f"  {key}: {{{block}}}\n" for key, block in channels.items())
    return MappingFile.model_validate(YAML(typ="safe").load(text))


SPEED = "quantity: angular_velocity, node: crankshaft"
BEHIND = "channel: n gbx.in, quantity: angular_velocity, node: gearbox_input"
TORQUE = "quantity: torque, element: clutch, sign: -1"


def test_values_become_si_at_nodes_and_elements_over_one_raster() -> None:
    found = mapped(measured(), mapping(n_mot=SPEED, b=BEHIND, M=TORQUE))
    assert found.angular_velocity.dims == ("time", "node") and found.torque.dims == ("time", "element")
    assert found.time.attrs["sampling_rate"] == 1000.0
    assert (found.time.values[0], found.time.values[-1]) == (0.1, pytest.approx(1.59, abs=1e-12))
    expected = (600.0 + 300.0 * found.time.values) * np.pi / 30.0
    np.testing.assert_allclose(found.angular_velocity.sel(node="crankshaft"), expected, rtol=1e-12)
    np.testing.assert_allclose(found.angular_velocity.sel(node="gearbox_input"), expected / 2, rtol=1e-12)
    np.testing.assert_array_equal(found.torque.sel(element="clutch"), 500.0)
    assert (found.torque.attrs["units"], found.angular_velocity.attrs["units"]) == ("Nm", "rad/s")
    assert found.attrs["source"] == "rig.mf4" and found.attrs["amplitude"] == "signal"


def test_units_factors_offsets_and_delays_of_the_mapping() -> None:
    plan = mapping(volts="quantity: torque, element: clutch, unit: Nm, factor: 200, offset: -500, delay: 0.5 s")
    found = mapped(measured(), plan)
    assert found.time.values[0] == -0.5
    np.testing.assert_allclose(found.torque.values[[0, 2000], 0], [-500.0, 500.0], rtol=1e-12)


@pytest.mark.parametrize(
    ("settings", "rate"), [("raster: coarsest", 100.0), ("raster: n_mot", 1000.0), ("rate: 2 kHz", 2000.0)]
)
def test_rasters_are_chosen_by_name(settings: str, rate: float) -> None:
    found = mapped(measured(), mapping(settings, n_mot=SPEED, b=BEHIND))
    assert found.time.attrs["sampling_rate"] == rate
    np.testing.assert_allclose(np.diff(found.time), 1.0 / rate, rtol=1e-9)


def test_mean_over_a_step_is_the_integral_and_keeps_what_is_faster_out() -> None:
    time = np.arange(10_001) / 1000.0
    wave = 3.0 + np.cos(2 * np.pi * 95.0 * time)  # at 100 Hz it would show up as 5 Hz
    to = 0.5 + np.arange(900) / 100.0
    slow = brought(time, wave, to, "mean")
    ratio = np.sin(np.pi * 0.95) / (np.pi * 0.95)  # a moving mean over one step, in closed form
    np.testing.assert_allclose(slow - 3.0, ratio * np.cos(2 * np.pi * 95.0 * to), atol=0.012)
    assert np.ptp(brought(time, wave, to, "linear")) > 1.9
    uneven = np.array([0.0, 1.0, 4.0])
    np.testing.assert_allclose(brought(uneven, uneven**1, np.array([1.0, 2.0, 3.0]), "mean"), [1.0, 2.0, 3.0])


def test_pulses_keep_their_own_times_and_tell_the_wheel() -> None:
    found = mapped(
        measured(), mapping(n_mot=SPEED, tacho="quantity: pulses, node: crankshaft, pulses_per_turn: 60, missing: 2")
    )
    assert found.tacho.values.tolist() == [0.1, 0.11, 0.12]
    assert (found.tacho.attrs["node"], found.tacho.attrs["pulses_per_turn"], found.tacho.attrs["missing"]) == (
        "crankshaft",
        60,
        2,
    )


def test_it_is_a_result_that_is_saved_and_written(tmp_path: Path) -> None:
    truck = load_model(EXAMPLES / "truck_dmf.yaml")
    found = mapped(measured(), mapping(n_mot=SPEED.replace("crankshaft", "primary"), M=TORQUE), truck)
    assert found.attrs["model_hash"] == truck.hash
    back = load_results(save_results(found, tmp_path / "run.nc"))
    np.testing.assert_array_equal(back.torque, found.torque)
    again = read_measurement(write_measurement(back, tmp_path / "run.mf4"))
    np.testing.assert_array_equal(again["torque clutch"], found.torque.sel(element="clutch"))
    assert again["torque clutch"].attrs["units"] == "Nm"


@pytest.mark.parametrize(
    ("settings", "channels", "told"),
    [
        (
            "",
            {"n_mott": SPEED},
            r"channels\.n_mott: the measurement has no such channel; found 'n_mott'; did you mean 'n_mot'",
        ),
        (
            "",
            {"volts": SPEED},
            r"channels\.volts: the channel's unit is no unit of angular velocity of a node; found 'V'; say",
        ),
        (
            "",
            {"n_mot": SPEED + ", unit: furlong"},
            r"channels\.n_mot\.unit: .*found 'furlong'; say which it is, as 'unit: rpm'",
        ),
        ("", {"holes": TORQUE}, r"channels\.holes: values are missing; found 1 of 2001 samples, the first at 0\.007 s"),
        ("", {"dead": TORQUE}, r"channels\.dead: the channel has no value; found 2001 samples of NaN"),
        (
            "",
            {"n_mot": SPEED, "b": BEHIND.replace("gearbox_input", "crankshaft")},
            r"channels\.b: another channel is the same",
        ),
        ("raster: fnest", {"n_mot": SPEED}, r"raster: there is no such raster; found 'fnest'; did you mean 'finest'"),
        (
            "",
            {"n_mot": SPEED + ", delay: 1 h", "M": TORQUE},
            "the channels have no time in common; found -3600 to -3598 s",
        ),
        ("rate: 100 GHz", {"n_mot": SPEED}, "the unit 'GHz' is unknown"),
        ("rate: 1e12", {"n_mot": SPEED}, "the recording is too large"),
    ],
)
def test_what_cannot_be_mapped(settings: str, channels: dict[str, str], told: str) -> None:
    with pytest.raises((ModelError, ValueError), match=told):
        mapped(measured(), mapping(settings, **channels))


def test_places_must_be_the_models() -> None:
    truck = load_model(EXAMPLES / "truck_dmf.yaml")
    plan = mapping(n_mot=SPEED.replace("crankshaft", "primry"))
    with pytest.raises(ModelError, match=r"channels\.n_mot\.node: the model has no such node; found 'primry'; did you"):
        mapped(measured(), plan, truck)
    with pytest.raises(
        ModelError, match=r"channels\.M\.element: the model has no such element; found 'clutsch'; did you"
    ):
        mapped(measured(), mapping(M=TORQUE.replace("clutch", "clutsch")), truck)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("torsional: 1\nname: truck\n", "the key 'torsional_mapping' is missing; is this a model file?"),
        ("torsional_mapping: 2\nchannels: {}\n", "the file is written for a later torsional than this one"),
        ("torsional_mapping: 1\n", "the key 'channels' is missing"),
        (
            "torsional_mapping: 1\nchannels:\n  n: {quantity: torqe, element: a}\n",
            r"channels\.n\.quantity \(line 3\): is none of",
        ),
        (
            "torsional_mapping: 1\nchannels:\n  n: {quantity: torque, node: a}\n",
            r"channels\.n\.node \(line 3\): the key does not fit",
        ),
        (
            "torsional_mapping: 1\nchannels:\n  n: {quantity: torque}\n",
            r"channels\.n \(line 3\): the key 'element' is missing",
        ),
        (
            "torsional_mapping: 1\nchannels:\n  n: {quantity: pulses, node: a}\n",
            r"the key 'pulses_per_turn' is missing",
        ),
        (
            "torsional_mapping: 1\nchannels:\n  n: {quantity: torque, elment: a}\n",
            "the key is unknown; did you mean 'element'",
        ),
        (
            "torsional_mapping: 1\nchannels:\n  n: {quantity: torque, element: a, factor: 0}\n",
            r"n\.factor \(line 3\): must not be zero",
        ),
    ],
)
def test_mapping_files_are_read_strictly(tmp_path: Path, text: str, told: str) -> None:
    path = tmp_path / "rig.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError, match=told) as caught:
        load_mapping(path)
    assert str(caught.value).startswith(str(path))


def test_the_schema_takes_what_the_reader_takes() -> None:
    schema = mapping_schema()
    good = {
        "torsional_mapping": 1,
        "rate": "1 kHz",
        "channels": {"n": {"quantity": "angle", "node": "a", "delay": "2 ms"}},
    }
    jsonschema.validate(good, schema)
    for bad in ({"channels": {}}, {"torsional_mapping": 1, "channels": {"n": {"quantity": "weight"}}}):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(bad, schema)


def test_the_mapping_to_begin_with_is_one_once_places_are_filled_in(tmp_path: Path) -> None:
    path = tmp_path / "rig.yaml"
    path.write_text(starter(measured()).replace("NAME", "crankshaft"), encoding="utf-8")
    plan = load_mapping(path)
    assert {key: block.quantity for key, block in plan.channels.items()} == {
        "n_mot": "angular_velocity",
        "channel_2": "angular_velocity",
        "M": "torque",
        "holes": "torque",
        "dead": "torque",
        "tacho": "pulses",
    }
    assert plan.channels["channel_2"].channel == "n gbx.in"
