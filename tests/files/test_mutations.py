"""Damaged model files: a model or one sentence comes out, never another error, never a hang.

The mutants are the same on every machine, so that a failure is repeated by its file, seed and number.
"""

from __future__ import annotations

import shutil
import time
from pathlib import Path

import pytest
from tests.files.mutation import mutant
from tests.shipped import MODEL_FILES

from torsional.errors import ModelError
from torsional.files import load_model
from torsional.model import Model
from torsional.system import assemble

CURVE = MODEL_FILES[0].with_name("truck13_full_load.csv")
SHORT, LONG = 300, 100_000


def outcome(folder: Path, data: bytes) -> Model | ModelError:
    """What loading these bytes gives; anything but a model or a ModelError is raised."""
    path = folder / "mutant.yaml"
    path.write_bytes(data)
    try:
        return load_model(path)
    except ModelError as error:
        return error


def check(folder: Path, path: Path, seed: int, number: int) -> bool:
    """Whether the mutant loads; the assertions name it."""
    damage, data = mutant(path.read_bytes(), seed, number)
    before = time.process_time()
    found = outcome(folder, data)
    name = (path.stem, seed, number, damage)
    assert time.process_time() - before < 1.0, name
    if isinstance(found, Model):
        assert assemble(found.powertrain()).M.shape[0] > 0, name
        return True
    text = str(found)
    assert "mutant.yaml: " in text, name
    assert len(text) < 3000, name
    assert text.replace("\n", "").isprintable(), name
    return False


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shutil.copy(CURVE, tmp_path)
    load_model(MODEL_FILES[0])  # what the first call compiles or imports is not the mutants' time
    return tmp_path


@pytest.mark.parametrize("path", MODEL_FILES, ids=lambda path: path.stem)
def test_mutants(folder: Path, path: Path) -> None:
    loaded = sum(check(folder, path, 0, number) for number in range(SHORT))
    assert 0.05 * SHORT < loaded < 0.6 * SHORT


@pytest.mark.full
@pytest.mark.parametrize("path", MODEL_FILES, ids=lambda path: path.stem)
def test_a_hundred_thousand_mutants(folder: Path, path: Path) -> None:
    for number in range(LONG // len(MODEL_FILES)):
        check(folder, path, 1, number)


@pytest.mark.parametrize("number", range(200))
def test_mutants_of_the_curve(folder: Path, number: int) -> None:
    truck = MODEL_FILES[0].with_name("truck_smf.yaml").read_bytes()
    (folder / CURVE.name).write_bytes(mutant(CURVE.read_bytes(), 2, number)[1])
    found = outcome(folder, truck)
    assert isinstance(found, Model) or "engine.full_load" in str(found)
