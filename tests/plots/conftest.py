"""Results of the shipped truck, computed once."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from tests.shipped import shipped

from torsional.model import Model
from torsional.quantities import acceleration, named_modes
from torsional.solvers.campbell import campbell
from torsional.solvers.run_up import full_load_response


@pytest.fixture(scope="session")
def truck() -> Model:
    return shipped("truck_dmf")


@pytest.fixture(scope="session")
def interference(truck: Model) -> xr.Dataset:
    return campbell(truck, gears=["8", "12"])


@pytest.fixture(scope="session")
def names(interference: xr.Dataset) -> dict[str, list[str]]:
    groups = {"DMF mode": ("dmf",)}
    return {str(g): named_modes(interference.sel(gear=g).isel(speed=0), groups) for g in interference.gear.values}


@pytest.fixture(scope="session")
def along(truck: Model) -> xr.Dataset:
    return full_load_response(truck, np.linspace(63.0, 205.0, 12), gears=["8", "12"], orders=[1.5, 3.0, 6.0])


@pytest.fixture(scope="session")
def orders(along: xr.Dataset) -> xr.DataArray:
    return acceleration(along.angle.sel(node="gearbox_input"))
