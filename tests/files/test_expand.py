"""A model written out as components is the same model."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from tests.shipped import MODEL_FILES

from torsional.components import Coupling, Inertia
from torsional.errors import ModelError
from torsional.files import expanded, load_model, model_from_document
from torsional.laws import Law, plain
from torsional.model import Landmarks, Model
from torsional.system import assemble


@pytest.mark.parametrize("path", MODEL_FILES, ids=lambda path: path.stem)
def test_expanded_model_is_the_same_to_the_last_bit(path: Path) -> None:
    model = load_model(path)
    again = model_from_document(json.loads(json.dumps(expanded(model))))
    assert again.landmarks == model.landmarks
    assert again.operation == model.operation
    assert {name: gear.ratio for name, gear in again.gears.items()} == {n: g.ratio for n, g in model.gears.items()}
    for gear in model.gear_names:
        one, two = assemble(model.powertrain(gear)), assemble(again.powertrain(gear))
        assert one.coordinates == two.coordinates
        assert one.connections.laws == two.connections.laws
        assert one.masses.switches == two.masses.switches
        for matrix in "MCKHS":
            assert np.array_equal(getattr(one, matrix), getattr(two, matrix))


@pytest.mark.parametrize("path", MODEL_FILES, ids=lambda path: path.stem)
def test_expanded_model_is_read_from_a_file_and_expands_to_itself(path: Path, tmp_path: Path) -> None:
    document = expanded(load_model(path))
    file = tmp_path / "expanded.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    assert expanded(load_model(file)) == document
    assert not {"absorber", "crankshaft", "clutch", "gearbox", "driveline", "vehicle"} & set(document)


def test_what_the_file_format_does_not_know_is_refused() -> None:
    class Odd:
        def stamps(self, name: str) -> object:
            return Inertia(1.0).stamps(name)

    with pytest.raises(ModelError, match="odd: the file format has no such component; found Odd"):
        expanded(Model("m", {"odd": Odd()}, Landmarks()))  # type: ignore[dict-item]

    class Own(Law):
        kernel = plain
        parameters = np.ones(1)  # type: ignore[assignment]

    parts = {"a": Inertia(1.0), "b": Inertia(1.0), "c": Coupling("a", "b", Own())}
    with pytest.raises(ModelError, match="c: the file format has no such law; found Own"):
        expanded(Model("m", parts, Landmarks()))


def test_engine_without_a_file_is_refused() -> None:
    model = load_model(MODEL_FILES[-1])
    with pytest.raises(ModelError, match="the engine did not come from a model file"):
        expanded(model.replaced(document={}))
