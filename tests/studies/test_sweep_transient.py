"""Scenarios of many designs: each as it runs by itself, whatever stands beside it in a chunk."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

import torsional as tv
from torsional.files.edit import changed
from torsional.files.scenario import load_scenario
from torsional.solvers.transient.cylinders import CylinderTorques
from torsional.studies.scenarios.running import run_scenario
from torsional.studies.sweeps import sweep
from torsional.studies.sweeps.analyses import TransientRun

TRUCK = tv.load_model("examples/truck_dmf.yaml")
SHORT = load_scenario("tip_in", ["duration=0.5 s"])
RUN = TransientRun.model_validate({"analysis": "transient", "scenario": "tip_in"}).with_scenario(SHORT)
OVER = {"absorber.stiffness": [9e3, 13e3], "engine.bore": [0.128, 0.131]}


def test_designs_have_what_each_has_by_itself() -> None:
    """Engines that differ are not taken for each other."""
    found = sweep(TRUCK, OVER, RUN, chunk=4)
    xr.testing.assert_identical(found, sweep(TRUCK, OVER, RUN, chunk=1))
    for stiffness in OVER["absorber.stiffness"]:
        for bore in OVER["engine.bore"]:
            place = {"absorber.stiffness": stiffness, "engine.bore": bore}
            alone = run_scenario(changed(TRUCK, place), SHORT).sel(element="dmf")
            for name in RUN.gives:
                assert float(found[name].sel(place).sel(element="dmf")) == pytest.approx(float(alone[name]), rel=1e-12)
    assert np.unique(found.torque_highest).size == 4


def test_figures_carry_their_units() -> None:
    found = RUN(TRUCK)
    assert [found[name].attrs["units"] for name in RUN.gives] == ["Nm", "Nm", "rad", "rad"]


def test_designs_that_share_an_engine_share_what_it_comes_to() -> None:
    """Worked out once for one operating point, anew for another one and for another engine."""
    other = changed(TRUCK, {"engine.bore": 0.128})
    softer = changed(TRUCK, {"absorber.stiffness": 9e3})
    first, again, more, narrow = (
        CylinderTorques.of(model, 100.0, torque).profiles()[1][0]
        for model, torque in ((TRUCK, 1000.0), (softer, 1000.0), (TRUCK, 1200.0), (other, 1000.0))
    )
    assert first is again
    assert abs(first.coefficients - more.coefficients).max() > 1.0
    assert abs(first.coefficients - narrow.coefficients).max() > 1.0
