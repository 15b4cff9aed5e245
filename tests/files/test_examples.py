"""Every shipped model loads, is like no misprint, and has the figures its source gives."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh
from tests.shipped import MODEL_FILES

from torsional.files import load_model, starter, warnings_of
from torsional.solvers.operating import at_operating_point
from torsional.system import assemble

TRUCKS = [path for path in MODEL_FILES if path.stem.startswith("truck")]


def example(name: str) -> Path:
    return MODEL_FILES[0].with_name(f"{name}.yaml")


@pytest.mark.parametrize("path", MODEL_FILES, ids=lambda path: path.stem)
def test_loads_without_a_warning(path: Path) -> None:
    model = load_model(path)
    assert warnings_of(model) == []
    for gear in model.gear_names:
        assert np.linalg.eigvalsh(assemble(model.powertrain(gear)).M).min() > 0


@pytest.mark.parametrize("path", MODEL_FILES, ids=lambda path: path.stem)
def test_every_file_is_explained(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    assert text.startswith("# ")
    assert re.search(r"our\W+own|doi", text), "where the figures come from"
    assert text.count("#") >= 7
    assert max(map(len, text.splitlines())) <= 120


@pytest.mark.parametrize("path", TRUCKS, ids=lambda path: path.stem)
def test_trucks_differ_by_their_absorber_alone(path: Path) -> None:
    document, other = load_model(path).document, load_model(example("truck_smf")).document
    assert {key for key in document if document[key] != other.get(key)} <= {"absorber", "name"}


@pytest.mark.parametrize("path", TRUCKS, ids=lambda path: path.stem)
def test_landmarks_of_a_vehicle(path: Path) -> None:
    model = load_model(path)
    marks = model.landmarks
    assert marks.throws == tuple(f"throw{i}" for i in range(1, 7))
    assert (marks.load, marks.input, marks.clutch) == ("vehicle", "gearbox_input", "clutch")
    assert marks.crankshaft == ("flywheel" if path.stem == "truck_smf" else "primary")
    powertrain = model.powertrain()
    assert set(marks.springs) <= set(powertrain)
    assert bool(marks.springs) == (path.stem != "truck_smf")
    assert model.gear_names == tuple(str(i) for i in range(1, 13))


def test_truck_engine_is_the_public_one() -> None:
    engine = load_model(example("truck_dmf")).engine
    assert engine is not None
    assert engine.displacement == pytest.approx(12.78e-3, rel=1e-3)
    assert engine.full_load_torque(np.array([600, 1100, 1900, 2000]) * np.pi / 30).tolist() == pytest.approx(
        [1300, 2500, 1600, 0], abs=1e-9
    )


def test_mwm_engine_has_its_published_modes() -> None:
    """Data of Mendes, Meirelles, Zampieri, doi 10.1243/14644193JMBD126; frequencies recomputed from them elsewhere."""
    system = assemble(load_model(example("mwm_engine")).powertrain())
    found = np.sqrt(eigh(system.K, system.M, eigvals_only=True)[1:]) / (2 * np.pi)
    expected = [216.5836, 592.7405, 984.9230, 1171.0174, 1415.9950, 1660.0439, 1794.3876, 2993.4736]
    assert found == pytest.approx(expected, abs=5e-5)


def test_marine_line_follows_its_gear_and_its_shaft() -> None:
    """The lowest mode by hand: the line as two bodies, engine side referred to the propeller, on three springs."""
    line = load_model(example("marine_line")).powertrain()
    assert line.speed_ratio("propeller") == pytest.approx(200 / 750, rel=1e-15)
    square = 3.75**2
    engine, polar = (30 + 12 + 6 * 55 + 400) * square, np.pi * 0.28**4 / 32
    coupling, shaft = 450e3 * square, 80e9 * polar / 14
    system = assemble(line)
    first = np.sqrt(eigh(system.K, system.M, eigvals_only=True)[1])
    bodies = np.array([engine, 22 * square + 340, 2600 + 7850 * polar * 14 / 2])
    bodies[1] += 7850 * polar * 14 / 2
    stiffness = np.array([[coupling, -coupling, 0], [-coupling, coupling + shaft, -shaft], [0, -shaft, shaft]])
    assert first == pytest.approx(np.sqrt(eigh(stiffness, np.diag(bodies), eigvals_only=True)[1]), rel=2e-3)


def test_car_sits_on_its_stages() -> None:
    """At 150 Nm the arc springs are on the first stage, at 350 Nm on the second, given per degree."""
    car = load_model(example("passenger_car_dmf"))
    for torque, stage in ((150.0, 9.0), (350.0, 28.0)):
        system, _ = at_operating_point(car, torque, "5")
        found = system.connections.stiffness[system.connections.names.index("dmf")]
        assert found == pytest.approx(stage * 180 / np.pi, rel=1e-12)


@pytest.mark.parametrize("kind", ["truck", "line"])
def test_starter_models_load(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    path.write_text(starter(kind), encoding="utf-8")
    model = load_model(path)
    assert warnings_of(model) == []
    at_operating_point(model, float(model.torques(3)[1]))
