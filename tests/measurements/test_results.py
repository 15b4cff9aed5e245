"""Results of analyses as files that other programs open."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from tests.measurements.test_other_programs import quiet_module
from tests.shipped import EXAMPLES

from torsional import (
    RPM,
    Excitation,
    Inertia,
    ModelError,
    Powertrain,
    Shaft,
    assemble,
    load_model,
    mean_rotation,
    modal,
    run_up_response,
    shaft_from_encoder,
    track_orders,
    transient,
)
from torsional.measurements import read_measurement, write_measurement
from torsional.results import save_results

LINE = assemble(Powertrain({"a": Inertia(2.0), "b": Inertia(1.0), "ab": Shaft("a", "b", 1e3, 1.0)}))


@pytest.fixture(scope="module")
def run() -> xr.Dataset:
    return transient(LINE, Excitation.unit("a", [1.0], [50.0]), 0.05)


@pytest.mark.parametrize("ending", [".mf4", ".uff", ".mat", ".parquet", ".csv", ".nc"])
def test_signals_of_a_run_in_time(tmp_path: Path, run: xr.Dataset, ending: str) -> None:
    write = save_results if ending == ".nc" else write_measurement
    back = read_measurement(write(run, tmp_path / f"run{ending}"))
    np.testing.assert_array_equal(back["torque ab"], run.torque.sel(element="ab"))
    np.testing.assert_array_equal(back["angular_velocity b"], run.angular_velocity.sel(node="b"))
    np.testing.assert_allclose(back.time, run.time, rtol=1e-15)
    assert [back[name].attrs["units"] for name in ("torque ab", "acceleration a", "speed")] == ["Nm", "rad/s²", "rad/s"]


@pytest.mark.parametrize("ending", [".uff", ".mat"])
def test_order_curves(tmp_path: Path, ending: str) -> None:
    truck = load_model(EXAMPLES / "truck_dmf.yaml")
    found = run_up_response(truck, np.linspace(600.0, 2000.0, 15) * RPM, orders=[3.0, 4.5])
    found = found.sel(node=["gearbox_input"], element=["clutch"])
    path = write_measurement(found, tmp_path / f"run{ending}")
    back = read_measurement(path)
    curve = found.torque.sel(element="clutch", order=4.5).values
    np.testing.assert_array_equal(back["torque order 4.5 clutch"], curve)
    unit, factor = ("rpm", RPM) if ending == ".uff" else ("rad/s", 1.0)
    assert back.speed.attrs["units"] == unit
    np.testing.assert_allclose(back.speed.values * factor, found.speed, rtol=1e-14)
    if ending == ".uff":
        sets = quiet_module("pyuff").UFF(str(path)).read_sets()
        one = next(each for each in sets if each["id1"].strip() == "torque order 4.5 clutch")
        np.testing.assert_array_equal(one["data"], curve)
        axes = [one[f"{axis}_spec_data_type"] for axis in ("abscissa", "z_axis")]
        assert (one["func_type"], axes, one["z_axis_value"]) == (12, [19, 20], 4.5)
        assert one["abscissa_axis_units_lab"].strip() == "rpm"


def test_a_result_along_no_axis_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"the result runs along no axis; found mode, node.*results over time"):
        write_measurement(modal(LINE), tmp_path / "modes.uff")


def test_tracked_orders_of_a_run_down(tmp_path: Path) -> None:
    """Speeds that fall are written from the lowest up, each with its own values."""
    time = np.arange(0.0, 4.0, 1e-3)
    alpha = 220.0 * time - 20.0 * time**2
    turning = mean_rotation(shaft_from_encoder(xr.DataArray(alpha, {"time": time}, attrs={"units": "rad"})))
    wave = xr.DataArray((1.0 + time) * np.cos(3 * alpha), {"time": time}, name="M", attrs={"units": "Nm"})
    found = track_orders(wave, turning, [3.0])
    assert (np.diff(found.speed) < 0).all()
    back = read_measurement(write_measurement(found, tmp_path / "orders.uff"))
    np.testing.assert_allclose(back.speed, found.speed.values[::-1] / RPM, rtol=1e-14)
    np.testing.assert_array_equal(back["M order 3"], found.M.sel(order=3.0).values[::-1])
    assert back["M order 3"].attrs["units"] == "Nm"


def test_a_dataset_by_hand_keeps_the_channels_of_every_raster(tmp_path: Path) -> None:
    """Nothing but names tells such a Dataset from a result."""
    data = xr.Dataset({"n": ("time", [1.0, 2.0, 3.0]), "M": ("time_2", [4.0, 5.0])})
    data = data.assign_coords(time=[0.0, 0.1, 0.2], time_2=[0.0, 0.15])
    again = read_measurement(write_measurement(data, tmp_path / "by_hand.csv"))
    assert again.n.values.tolist() == [1.0, 2.0, 3.0] and again.M.values.tolist() == [4.0, 5.0]
