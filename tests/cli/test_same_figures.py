"""The command line gives the figures of the Python functions, to the last bit."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from torsional.files import changed, load_model
from torsional.numerics.arrays import Array
from torsional.quantities import acceleration, order_speed, order_sum, swing
from torsional.solvers.campbell import campbell
from torsional.solvers.harmonic import harmonic_response
from torsional.solvers.map import response_map
from torsional.solvers.modal import damped_modes, modal
from torsional.solvers.operating import at_operating_point
from torsional.units import RPM

Run = Callable[..., Any]


def result(torsional: Run, *arguments: object) -> dict[str, Any]:
    """The variables that a command tells as JSON, as arrays."""
    told = torsional(*arguments, "--json")
    assert told.code == 0, told.err
    variables = json.loads(told.out)["result"]["variables"]
    return {name: array(variable) for name, variable in variables.items()}


def array(told: dict[str, Any]) -> Array:
    if "real" in told:
        return np.array(told["real"]) + 1j * np.array(told["imaginary"])
    values = np.array(told["values"])
    return values if values.dtype != object else values.astype(float)


def test_modes(torsional: Run, truck: str) -> None:
    told = result(torsional, "modes", truck, "--gear", "11", "--torque", "1800 Nm", "--order", "6")
    system, _ = at_operating_point(load_model(truck), 1800.0, "11")
    expected, damped = modal(system, 900 * RPM), damped_modes(system, 900 * RPM)
    for name in ("frequency", "shape", "elastic_share", "kinetic_share", "damping_ratio"):
        np.testing.assert_array_equal(told[name][0], expected[name].values)
    np.testing.assert_array_equal(told["order_speed"][0], order_speed(expected.frequency, 6.0).values)
    # each mode is shown with one damped mode, all different, and lightly damped ones keep their frequencies
    assert len(set(told["damped_frequency"][0])) == expected.sizes["mode"]
    assert set(told["damped_frequency"][0]) <= set(damped.frequency.values)
    light = told["damped_ratio"][0] < 0.05
    assert light.sum() > 5
    np.testing.assert_allclose(told["damped_frequency"][0][light], told["frequency"][0][light], rtol=0.02)


@pytest.mark.parametrize("variant", ["truck_dmf", "truck_dmf_two_stage", "truck_dmf_pendulum"])
def test_respond_at_full_load(torsional: Run, truck: str, variant: str) -> None:
    path = Path(truck).with_name(f"{variant}.yaml")
    told = result(torsional, "respond", path, "--speed", "700:1900:200rpm", "--orders", "0.5:6:0.5")
    model, orders = load_model(path), np.arange(0.5, 6.5, 0.5)
    speeds = 700 * RPM + 200 * RPM * np.arange(7)
    for i, speed in enumerate(speeds):
        torque = float(model.engine.full_load_torque(speed))
        system, _ = at_operating_point(model, torque)
        alone = harmonic_response(system, model.engine.excitation(model.landmarks.throws, [speed], [torque], orders))
        nodes = [model.landmarks.crankshaft, model.landmarks.input]
        angle, twist = alone.angle.sel(node=nodes), alone.torque.sel(element=[*model.landmarks.springs, "clutch"])
        np.testing.assert_array_equal(told["angle"][i], angle.values[0])
        np.testing.assert_array_equal(told["torque"][i], twist.values[0])
        assert told["mean_torque"][i] == torque
        # a sum over orders, taken here in another order of addition
        np.testing.assert_allclose(told["acceleration_bound"][i], order_sum(acceleration(angle)).values[0], rtol=4e-15)


def test_respond_at_one_torque(torsional: Run, truck: str) -> None:
    told = result(
        torsional, "respond", truck, "--torque", "1200 Nm", "--node", "wheels", "--element", "tyres", "--order", "3"
    )
    model = load_model(truck)
    speeds, system = model.speeds(141), at_operating_point(model, 1200.0)[0]
    found = harmonic_response(
        system, model.engine.excitation(model.landmarks.throws, speeds, np.full(141, 1200.0), [3.0])
    )
    moved = acceleration(found.angle.sel(node=["wheels"]))
    np.testing.assert_array_equal(told["angle"], found.angle.sel(node=["wheels"]).values)
    np.testing.assert_array_equal(told["torque"], found.torque.sel(element=["tyres"]).values)
    np.testing.assert_array_equal(told["acceleration_swing"], swing(moved).values)
    np.testing.assert_array_equal(told["acceleration_bound"], order_sum(moved).values)


def test_map_in_json_netcdf_and_csv(torsional: Run, truck: str) -> None:
    grid = ["--speed", "700:1900:400rpm", "--torque", "500:1500:500Nm", "--gear", "10,12", "--orders", "0.5:6:0.5"]
    told = result(torsional, "map", truck, *grid, "-o", "m.csv")
    speeds, torques = 700 * RPM + 400 * RPM * np.arange(4), np.array([500.0, 1000.0, 1500.0])
    expected = response_map(load_model(truck), speeds, torques, ["10", "12"], np.arange(0.5, 6.5, 0.5))
    for i in range(2):
        one = expected.isel(gear=[i])
        np.testing.assert_array_equal(told["acceleration_swing"][[i]], swing(acceleration(one.angle)).values)
        np.testing.assert_array_equal(told["torque_bound"][[i]], order_sum(one.torque).values)
    np.testing.assert_array_equal(told["mean_twist"], expected.mean_twist.values)
    np.testing.assert_array_equal(told["within_full_load"], expected.within_full_load.values)
    with Path("m.csv").open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["gear"] for row in rows] == ["10"] * 12 + ["12"] * 12
    column = [float(row["acceleration_swing gearbox_input [rad/s²]"]) for row in rows]
    np.testing.assert_array_equal(column, told["acceleration_swing"][..., 1].ravel())
    np.testing.assert_allclose([float(row["speed [rpm]"]) for row in rows[:4]], [700, 1100, 1500, 1900], rtol=1e-14)


def test_campbell(torsional: Run, truck: str) -> None:
    path = Path(truck).with_name("truck_dmf_pendulum.yaml")
    told = result(
        torsional, "campbell", path, "--gear", "12", "--order", "3", "--order", "1.5", "--speed", "600:2000:350rpm"
    )
    expected = campbell(load_model(path), None, ["12"], 600 * RPM + 350 * RPM * np.arange(5), [1.5, 3.0])
    for name in ("frequency", "damping_ratio", "crossing", "elastic_share"):
        np.testing.assert_array_equal(told[name], expected[name].values)


def test_check(torsional: Run, truck: str) -> None:
    told = torsional("check", truck, "--set", "absorber.damping=30", "--gear", "11", "--torque", "900 Nm", "--json")
    document = json.loads(told.out)
    system, point = at_operating_point(changed(load_model(truck), {"absorber.damping": 30}), 900.0, "11")
    for row in document["equilibrium"]:
        i = point.names.index(row["connection"])
        assert row["travel"]["value"] == point.angle[i]
        assert row["stiffness"]["value"] == point.stiffness[i]
    frequencies = [mode["frequency"]["value"] for mode in document["modes"]]
    assert frequencies == [float(f) for f in modal(system).frequency.values if f > 0][:6]
