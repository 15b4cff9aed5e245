"""Units of absorbers in the place of the absorbers themselves: the whole line's own run, to second order."""

from __future__ import annotations

import dataclasses
import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from tests.exchange.compiled import needs_compiler
from tests.shipped import shipped

import torsional as tv
from torsional.errors import ModelError
from torsional.exchange.fmu.coupling import Sensed

pytest.importorskip("fmpy")
SPEED, STEP = 1000 * tv.RPM, 2e-5


@pytest.fixture(scope="module")
def spring(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A unit of the truck's two-stage dual mass flywheel."""
    path = tmp_path_factory.mktemp("units") / "dmf.fmu"
    absorber = shipped("truck_dmf_two_stage").absorber
    assert absorber is not None
    tv.export_fmu(absorber, path, step=STEP)
    return path


def without(model: tv.Model, *names: str) -> tv.System:
    """The line cut in two."""
    whole = model.powertrain()
    left = {name: part for name, part in whole.components.items() if name not in names}
    return tv.assemble(tv.Powertrain(left, parts=2, reference=whole.reference))


def off(found: xr.Dataset, own: xr.Dataset, node: str) -> float:
    """Largest difference of an angle over the largest angle, at common moments."""
    a, b = found.angle.sel(node=node), own.angle.sel(node=node)
    both = np.intersect1d(a.time.round(9), b.time.round(9))
    values = [x.sel(time=both, method="nearest").values for x in (a, b)]
    return float(np.abs(values[0] - values[1]).max() / np.abs(values[1]).max())


@needs_compiler
def test_the_coupling_is_of_second_order(spring: Path) -> None:
    model = shipped("truck_dmf_two_stage")
    drive = tv.engine_drive(model, SPEED, 1200.0)
    asked: dict[str, Any] = {"speed": SPEED, "hold": model.landmarks.load, "step": STEP}
    own = tv.transient(tv.assemble(model.powertrain()), drive, 0.06, "rest", output=4e-4, **asked)
    line, part = without(model, "dmf"), tv.FmuPart.absorber(spring, "primary", "secondary")
    steps = (4e-4, 2e-4, 1e-4)
    errors = [
        off(tv.co_simulation(line, drive, 0.06, part, communication_step=h, **asked), own, "gearbox_input")
        for h in steps
    ]
    assert errors[-1] < 5e-6
    assert all(coarse > 3.0 * fine for coarse, fine in itertools.pairwise(errors))


@needs_compiler
@pytest.mark.full
@pytest.mark.usefixtures("as_shipped")
def test_a_unit_with_bodies_and_friction_within(tmp_path: Path) -> None:
    model = shipped("truck_dmf_straight_spring")
    absorber = model.absorber
    assert absorber is not None
    tv.export_fmu(absorber, tmp_path / "a.fmu", step=STEP)
    drive = tv.engine_drive(model, SPEED, 600.0)
    asked: dict[str, Any] = {"speed": SPEED, "hold": model.landmarks.load, "step": STEP}
    whole = tv.assemble(model.detailed().powertrain())
    own = tv.transient(whole, drive, 0.03, "rest", output=1e-4, **asked)
    inner = {*model.detail, *absorber.components} - {"primary", "secondary"}
    part = tv.FmuPart.absorber(tmp_path / "a.fmu", "primary", "secondary")
    line = without(model.detailed(), *inner)
    errors = [
        off(tv.co_simulation(line, drive, 0.03, part, communication_step=h, **asked), own, "gearbox_input")
        for h in (1e-4, 2e-5)
    ]
    assert errors[1] < 0.5 * errors[0]  # shoes that stick and slide are no smooth springs
    assert errors[1] < 3e-4


@needs_compiler
def test_one_unit_as_a_spring_between_nodes_and_on_a_node(spring: Path) -> None:
    law = shipped("truck_dmf_two_stage").components["dmf"].law  # type: ignore[attr-defined]
    discs = {"a": tv.Inertia(1.0), "b": tv.Inertia(2.0), "c": tv.Inertia(0.7), "free": tv.Shaft("b", "c", 3e3)}
    load = tv.TorqueHistory("a", (0.0, 0.01), (0.0, 1500.0))
    asked: dict[str, Any] = {"speed": 0.0, "step": 5e-5}
    sensed = {"angle": "primary.angle", "speed": "primary.speed", "acceleration": "primary.acceleration"}
    between = tv.FmuPart.between(spring, "a", "b", torque="secondary.torque", **sensed)
    cut = tv.assemble(tv.Powertrain(discs, parts=2))
    found = tv.co_simulation(cut, load, 0.1, between, communication_step=5e-5, **asked)
    whole = tv.assemble(tv.Powertrain({**discs, "dmf": tv.Coupling("a", "b", law, 20.0)}))
    own = tv.transient(whole, load, 0.1, "rest", **asked)
    assert off(found, own, "b") < 1e-5
    assert found.attrs["units_coupled"] == str(spring)
    grounded = tv.FmuPart.on(spring, "a", torque="primary.torque", **sensed, parameters={"dmf.damping": 35.0})
    found = tv.co_simulation(cut, load, 0.1, grounded, communication_step=5e-5, keep=["a"], **asked)
    held = tv.assemble(tv.Powertrain({**discs, "dmf": tv.Coupling("ground", "a", law, 35.0)}, parts=2))
    own = tv.transient(held, load, 0.1, "rest", **asked)
    assert off(found, own, "a") < 1e-5
    assert found.node.values.tolist() == ["a"]


@pytest.mark.parametrize(
    ("part", "words"),
    [
        ({"inputs": {"primary.angel": Sensed("angle", {"a": 1.0})}}, r"no such variable.*did you mean 'primary.angle'"),
        ({"inputs": {"primary.torque": Sensed("angle", {"a": 1.0})}}, r"the variable is no real input; found output"),
        ({"torques": {"primary.torqe": {"a": 1.0}}}, r"no such variable.*did you mean 'primary.torque'"),
        ({"torques": {"primary.torque": {"A1": 1.0}}}, r"there is no node 'A1'"),
        ({"parameters": {"damping": 1.0}}, r"no such variable.*did you mean 'dmf.damping'"),
    ],
)
@needs_compiler
def test_names_that_do_not_fit_are_told(spring: Path, part: dict[str, Any], words: str) -> None:
    given: dict[str, Any] = {"inputs": {}, "torques": {"primary.torque": {"a": 1.0}}, "parameters": {}, **part}
    line = tv.assemble(tv.Powertrain({"a": tv.Inertia(1.0)}))
    with pytest.raises(ModelError, match=words):
        tv.co_simulation(line, (), 0.01, tv.FmuPart(spring, **given), speed=0.0)


@needs_compiler
def test_what_goes_wrong_is_told_in_the_units_words(spring: Path, capsys: pytest.CaptureFixture[str]) -> None:
    line = tv.assemble(tv.Powertrain({"a": tv.Inertia(1e-9)}))
    part = tv.FmuPart.on(spring, "a", torque="secondary.torque", angle="primary.angle", speed="primary.speed")
    load = tv.TorqueHistory("a", (0.0,), (1.0,))
    with pytest.raises(ModelError, match=r"time 0.0\d+ s: the line and its units lose the motion"):
        tv.co_simulation(line, load, 1.0, part, speed=0.0, communication_step=1e-3)
    part = dataclasses.replace(part, parameters={"step": -1.0})
    with pytest.raises(
        ModelError, match=r"dmf.fmu: the unit does not take its parameters; found .*a number that it cannot have"
    ):
        tv.co_simulation(line, load, 1.0, part, speed=0.0, communication_step=1e-3)
    assert capsys.readouterr().out == ""


def test_what_is_not_asked_rightly_is_refused() -> None:
    line = tv.assemble(tv.Powertrain({"a": tv.Inertia(1.0)}))
    part = tv.FmuPart.on("x.fmu", "a", torque="t")
    with pytest.raises(ModelError, match="units are wanted"):
        tv.co_simulation(line, (), 0.01, [], speed=0.0)
    with pytest.raises(ModelError, match="steps of communication divide the time"):
        tv.co_simulation(line, (), 0.01, part, speed=0.0, communication_step=1.0)
    with pytest.raises(ModelError, match=r"a unit is not told this; found jerk; allowed: angle, speed, acceleration"):
        tv.FmuPart("x.fmu", {"x": Sensed("jerk", {"a": 1.0})}, {"t": {"a": 1.0}})
    with pytest.raises(ModelError, match="the unit gives no torque"):
        tv.FmuPart("x.fmu", {}, {})
