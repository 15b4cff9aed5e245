"""Units as other tools meet them: valid, and with the figures of the package's own runs."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import zipfile
from pathlib import Path
from typing import Any

import numba
import numpy as np
import pytest
from tests.exchange.compiled import COMPILER, needs_compiler
from tests.shipped import shipped

import torsional as tv
from torsional.errors import ModelError
from torsional.exchange.fmu.packing import Packed
from torsional.laws import Hinges, Law, plain

fmpy = pytest.importorskip("fmpy")
SPEED, TORQUE = 900 * tv.RPM, 1200.0
VERSIONS = ["2.0", "3.0"]
BOTH = ["2.0", pytest.param("3.0", marks=pytest.mark.full)]


def problems(path: Path) -> list[str]:
    from fmpy.validation import validate_fmu

    found: list[str] = validate_fmu(str(path))
    return found


def simulated(path: Path, time: float, step: float = 1e-4, **more: Any) -> Any:
    return fmpy.simulate_fmu(str(path), stop_time=time, step_size=step, output_interval=step, **more)


def written_line(path: Path, name: str = "truck_dmf_two_stage", **more: Any) -> tuple[Packed, Any, Any]:
    """A truck with its engine within, and what a run of its own is asked with."""
    model = shipped(name)
    drive = tv.engine_drive(model, SPEED, TORQUE)
    asked = {"speed": SPEED, "hold": model.landmarks.load}
    told = tv.export_fmu(model, path, drives=drive, inputs=more.pop("inputs", ()), **asked, **more)
    return told, tv.assemble(model.detailed().powertrain()), {"drives": drive, **asked}


def assert_like(found: Any, own: Any, node: str, element: str, within: float) -> None:
    for name, values in (
        (f"{node}.angle", own.angle.sel(node=node)),
        (f"{node}.speed", own.angular_velocity.sel(node=node)),
        (f"{node}.acceleration", own.acceleration.sel(node=node)),
        (f"{element}.torque", own.torque.sel(element=element)),
    ):
        assert np.abs(values).max() > 1e-3
        np.testing.assert_allclose(found[name], values, rtol=0, atol=within * float(np.abs(values).max()), err_msg=name)


@needs_compiler
@pytest.mark.usefixtures("as_shipped")
@pytest.mark.parametrize("version", BOTH)
def test_a_truck_runs_as_its_own_run_does(tmp_path: Path, version: str) -> None:
    path = tmp_path / "truck.fmu"
    told, system, asked = written_line(path, fmi=version)
    assert problems(path) == []
    assert told.compiled and told.outputs[:2] == ("damper_ring.angle", "damper_ring.speed")
    own = tv.transient(system, time=0.2, **asked)
    assert_like(simulated(path, 0.2), own, "gearbox_input", "dmf", 1e-9)


@needs_compiler
def test_friction_and_gaps_of_straight_springs_are_in_it(tmp_path: Path) -> None:
    _, system, asked = written_line(tmp_path / "truck.fmu", "truck_dmf_straight_spring")
    assert problems(tmp_path / "truck.fmu") == []
    own = tv.transient(system, time=0.05, **asked)
    rubbing = next(name for name, _, law in system.elements if law.remembers)
    assert_like(simulated(tmp_path / "truck.fmu", 0.05), own, "gearbox_input", rubbing, 1e-9)


@needs_compiler
def test_torques_from_outside_act_as_histories_do(tmp_path: Path) -> None:
    _, system, asked = written_line(tmp_path / "truck.fmu", inputs={"vehicle": 0.0, "gearbox_input": 5.0})
    names = ["time", "vehicle.applied_torque", "gearbox_input.applied_torque"]
    told = [(0.0, 0.0, 5.0), (0.01995, 0.0, 5.0), (0.01996, -300.0, 5.0)]
    told += [(0.02995, -300.0, 5.0), (0.02996, -300.0, 85.0)]
    signals = np.array(told, dtype=[(name, float) for name in names])
    found = simulated(tmp_path / "truck.fmu", 0.06, input=signals)
    just = 0.5e-4  # a step takes what holds at its end, the unit what it was told at the begin
    more = [
        tv.TorqueHistory("vehicle", (0.0, 0.02 + just, 0.02 + just), (0.0, 0.0, -300.0)),
        tv.TorqueHistory("gearbox_input", (0.0, 0.03 + just, 0.03 + just), (5.0, 5.0, 85.0)),
    ]
    own = tv.transient(system, time=0.06, **{**asked, "drives": [asked["drives"], *more]})
    assert_like(found, own, "gearbox_input", "dmf", 1e-9)


@needs_compiler
@pytest.mark.full
def test_pistons_pendulums_and_governors_are_in_it(tmp_path: Path) -> None:
    model = shipped("truck_dmf_pendulum")
    governor = tv.Governor("throw1", 100.0, acts_on="throw1", proportional=20.0, low=-100.0, high=300.0)
    asked: dict[str, Any] = {"speed": 100.0, "hold": model.landmarks.load}
    drives = [tv.CylinderTorques.of(model, 100.0, 800.0), governor]
    told = tv.export_fmu(model, tmp_path / "truck.fmu", drives=drives, inputs=(), **asked)
    own = tv.transient(tv.assemble(model.detailed().powertrain()), drives, 0.05, **asked)
    assert_like(simulated(tmp_path / "truck.fmu", 0.05), own, "gearbox_input", "dmf", 1e-9)
    assert "pendulum.inertia" not in told.parameters  # its mass stands in the terms of its path too


@numba.njit(cache=False, error_model="numpy")
def cubic_torque(parameters: Any, angle: float, rate: float, memory: float, step: float) -> Any:
    """k φ + k3 φ³."""
    slope = parameters[0] + 3.0 * parameters[1] * angle**2
    return plain(parameters[0] * angle + parameters[1] * angle**3, slope, 0.0)


class Cubic(Law):
    """A law of a user's own."""

    kernel = cubic_torque
    parameters = np.array([2e3, 4e5])  # type: ignore[assignment]


@needs_compiler
def test_a_law_of_ones_own_goes_the_same_way(tmp_path: Path) -> None:
    parts = {"a": tv.Inertia(1.0), "b": tv.Inertia(2.0), "s": tv.Coupling("a", "b", Cubic(), 2.0)}
    line = tv.Powertrain(parts)
    tv.export_fmu(line, tmp_path / "line.fmu", inputs={"a": 300.0}, start="rest")
    load = tv.TorqueHistory("a", (0.0,), (300.0,))
    own = tv.transient(tv.assemble(line), load, 0.2, "rest", speed=0.0)
    assert np.abs(own.twist).max() > 0.07  # where the cube has as much to say as the line
    assert_like(simulated(tmp_path / "line.fmu", 0.2), own, "b", "s", 1e-9)


@needs_compiler
def test_parameters_are_those_of_a_changed_line(tmp_path: Path) -> None:
    parts = {
        "a": tv.Inertia(1.0),
        "b": tv.Inertia(2.0),
        "load": tv.Inertia(9.0),
        "s": tv.Shaft("a", "b", 1e4, 5.0),
        "gear": tv.GearPair("b", "wheel", 2.0),
        "stages": tv.Coupling("ground", "a", Hinges.staged([(20.0, 1e3), (400.0, 3e3)])),
        "wheel": tv.Inertia(0.5),
        "t": tv.Shaft("wheel", "load", 4e4, 2.0),
    }
    line = tv.Powertrain(parts)
    tv.export_fmu(line, tmp_path / "line.fmu", inputs={"a": 100.0}, start="rest", step=1e-3)
    values = {"wheel.inertia": 0.7, "s.stiffness": 1.3e4, "t.damping": 9.0, "a.applied_torque": 150.0, "step": 1e-4}
    values["stages.stiffness_factor"] = 1.5
    stiffer = Hinges.staged([(30.0, 1.5e3), (600.0, 4.5e3)])
    other = line.replaced("wheel", inertia=0.7).replaced("s", stiffness=1.3e4).replaced("t", damping=9.0)
    other = other.replaced("stages", law=stiffer)
    found = simulated(tmp_path / "line.fmu", 0.1, start_values=values)
    own = tv.transient(tv.assemble(other), tv.TorqueHistory("a", (0.0,), (150.0,)), 0.1, "rest", speed=0.0)
    assert_like(found, own, "load", "s", 1e-9)


def instance(path: Path, folder: Path, version: str) -> Any:
    """A unit that has begun."""
    described = fmpy.read_model_description(str(path))
    fmpy.extract(str(path), str(folder))
    module = __import__(f"fmpy.fmi{version[0]}", fromlist=["x"])
    made = module.FMU2Slave if version == "2.0" else module.FMU3Slave
    unit = made(
        guid=described.guid,
        unzipDirectory=str(folder),
        modelIdentifier=described.coSimulation.modelIdentifier,
        instanceName="one",
    )
    unit.instantiate()
    if version == "2.0":
        unit.setupExperiment(startTime=0.0)
    unit.enterInitializationMode()
    unit.exitInitializationMode()
    return unit


@needs_compiler
@pytest.mark.parametrize("version", BOTH)
def test_states_are_kept_handed_on_and_taken_up(tmp_path: Path, version: str) -> None:
    path = tmp_path / "line.fmu"
    parts = {"a": tv.Inertia(1.0), "b": tv.Inertia(2.0), "s": tv.Shaft("a", "b", 1e4, 5.0)}
    told = tv.export_fmu(tv.Powertrain(parts), path, inputs={"a": 70.0}, start="rest", fmi=version)
    number = len(told.inputs) + len(told.parameters) + told.outputs.index("s.torque")
    unit = instance(path, tmp_path / "unpacked", version)
    get = unit.getReal if version == "2.0" else unit.getFloat64
    kept = "getFMUstate", "setFMUstate", "serializeFMUstate", "deSerializeFMUstate"
    if version == "3.0":
        kept = "getFMUState", "setFMUState", "serializeFMUState", "deserializeFMUState"
    take, put, pack, unpack = (getattr(unit, name) for name in kept)

    def on(steps: int, first: float) -> float:
        for k in range(steps):
            unit.doStep(first + k * 1e-3, 1e-3)
        return float(get([number])[0])

    on(5, 0.0)
    state = take()
    expected = on(7, 5e-3)
    put(state)
    assert on(7, 5e-3) == expected != 0.0
    put(unpack(pack(state)))
    assert on(7, 5e-3) == expected
    unit.reset()
    if version == "2.0":
        unit.setupExperiment(startTime=0.0)
    unit.enterInitializationMode()
    unit.exitInitializationMode()
    assert on(12, 0.0) == expected
    with pytest.raises(Exception, match=r"failed with status 3"):  # a parameter, once it runs
        (unit.setReal if version == "2.0" else unit.setFloat64)([1], [3.0])
    unit.terminate()
    unit.freeInstance()


@pytest.mark.parametrize("version", VERSIONS)
def test_hostile_names_are_escaped(tmp_path: Path, version: str) -> None:
    parts = {"Kurbel ψ": tv.Inertia(1.0), "b (rechts)": tv.Inertia(2.0), "s": tv.Shaft("Kurbel ψ", "b (rechts)", 1e4)}
    title = '"/><x a="&amp;\x01\n<!-- ]]> ../../etc'
    told = tv.export_fmu(tv.Powertrain(parts), tmp_path / "u.fmu", name=title, fmi=version, compiled=False)
    assert problems(tmp_path / "u.fmu") == []
    described = fmpy.read_model_description(str(tmp_path / "u.fmu"))
    assert described.modelName == '"/><x a="&amp;  <!-- ]]> ../../etc'
    assert "Kurbel ψ.speed" in {v.name for v in described.modelVariables} & {*told.outputs}
    assert described.coSimulation.modelIdentifier == "x_a_amp_etc"
    assert told.compiled == ""


@needs_compiler
def test_the_sources_in_the_archive_are_complete(tmp_path: Path) -> None:
    tv.export_fmu(shipped("truck_dmf").absorber, tmp_path / "u.fmu", compiled=False)
    with zipfile.ZipFile(tmp_path / "u.fmu") as archive:
        assert not [name for name in archive.namelist() if name.startswith("binaries")]
        archive.extractall(tmp_path)
    order = [COMPILER, "-std=c99", "-Wall", "-Werror", "-Wno-unused", "-shared", "-fPIC", "-o", "u.so", "all.c"]
    told = subprocess.run(order, cwd=tmp_path / "sources", capture_output=True, text=True, check=False)
    assert told.stderr == ""


@needs_compiler
@pytest.mark.parametrize("version", VERSIONS)
def test_the_interface_is_the_standards_own(tmp_path: Path, version: str) -> None:
    headers = Path(fmpy.__file__).parent / "c-code"
    tv.export_fmu(shipped("truck_dmf").absorber, tmp_path / "u.fmu", fmi=version, compiled=False)
    with zipfile.ZipFile(tmp_path / "u.fmu") as archive:
        archive.extractall(tmp_path)
    asked = ["-std=c99", "-fsyntax-only", "-Wall", "-Werror", "-Wno-unused", "-DWITH_FMI_HEADERS", f"-I{headers}"]
    told = subprocess.run(
        [COMPILER, *asked, "all.c"], cwd=tmp_path / "sources", capture_output=True, text=True, check=False
    )
    assert told.stderr == ""
    order = [COMPILER, "-E", "-P", "all.c"]
    source = subprocess.run(order, cwd=tmp_path / "sources", capture_output=True, text=True, check=True).stdout
    prefix = f"fmi{version[0]}"
    wanted = set(re.findall(rf"{prefix}FullName\(\s*{prefix}(\w+)\)", (headers / f"{prefix}Functions.h").read_text()))
    own = set(re.findall(rf"__attribute__\(\(visibility\(\"default\"\)\)\) [\w *]*?{prefix}(\w+)\(", source))
    exchange = {"EnterContinuousTimeMode", "EnterEventMode", "NewDiscreteStates", "CompletedIntegratorStep", "SetTime"}
    exchange |= {
        name for name in wanted if "ContinuousStates" in name or name in ("GetDerivatives", "GetEventIndicators")
    }
    missing = wanted - own
    assert missing <= (exchange if version == "2.0" else set())  # what only units for model exchange have
    assert len(wanted & own) > 20


def test_the_same_line_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("one", "two"):
        tv.export_fmu(shipped("truck_dmf"), tmp_path / f"{name}.fmu", compiled=False, speed=SPEED)
    assert (tmp_path / "one.fmu").read_bytes() == (tmp_path / "two.fmu").read_bytes()


def test_without_a_compiler_there_are_sources(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shutil, "which", lambda name: None)
    absorber = shipped("truck_dmf").absorber
    assert tv.export_fmu(absorber, tmp_path / "u.fmu").compiled == ""
    with pytest.raises(ModelError, match=r"no C compiler was found; allowed: cc, gcc, clang"):
        tv.export_fmu(absorber, tmp_path / "u.fmu", compiled=True)


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"fmi": "1.0"}, "this version of FMI is not written"),
        ({"method": "exact"}, "no unit takes such steps"),
        ({"inputs": ["gearbox"]}, "did you mean"),
        ({"outputs": ["dmff"]}, "did you mean 'dmf'"),
        ({"inputs": 3}, "names of nodes are wanted"),
    ],
)
def test_what_cannot_be_written_is_refused(tmp_path: Path, more: dict[str, Any], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        tv.export_fmu(shipped("truck_dmf"), tmp_path / "u.fmu", compiled=False, **more)
    assert not os.listdir(tmp_path)  # noqa: PTH208
