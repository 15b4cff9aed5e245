"""Fields: what can be edited is what the file's schema has."""

from __future__ import annotations

from pathlib import Path

import pytest

import torsional
from torsional.errors import ModelError
from torsional.units import QUANTITIES, read
from torsional.workbench.fields import at_path, fields_of, groups_of

FILES = sorted(path.stem for path in Path("examples").glob("*.yaml"))


@pytest.mark.parametrize("name", FILES)
def test_every_text_put_back_changes_nothing(name: str) -> None:
    model = torsional.load_model(f"examples/{name}.yaml")
    fields = [field for field in fields_of(model) if field.given and field.kind != "text"]
    again = torsional.changed(model, *(f"{field.path}={field.text}" for field in fields))
    assert len(fields) > 3
    for part in ("components", "gears", "engine", "operation", "landmarks", "absorber"):
        assert getattr(again, part) == getattr(model, part), part


@pytest.mark.parametrize("name", FILES)
def test_values_are_those_that_the_text_is_read_as(name: str) -> None:
    model = torsional.load_model(f"examples/{name}.yaml")
    for field in fields_of(model):
        if field.value is not None and field.quantity:
            told = at_path(model.document, field.path) if field.given else field.text
            assert read(told, field.quantity) == field.value, field.path
            assert field.unit == QUANTITIES[field.quantity].unit.strip("-")


def test_bounds_are_those_that_the_schema_keeps() -> None:
    model = torsional.load_model("examples/truck_dmf.yaml")
    fields = {field.path: field for field in fields_of(model)}
    assert fields["absorber.stiffness"].above == 0 and fields["absorber.damping"].least == 0
    assert fields["crankshaft.throws"].least == 1 and fields["crankshaft.throws"].most == 16
    assert fields["engine.deactivated_valves"].choices == ("closed", "working")
    for field in fields.values():
        bound = field.above if field.above is not None else field.least
        if field.given and bound is not None:
            beyond = bound if field.above is not None else bound - 1
            with pytest.raises(ModelError):
                torsional.changed(model, {field.path: beyond})


def test_groups_follow_the_file() -> None:
    paths = [group["path"] for group in groups_of(torsional.load_model("examples/truck_dmf_tva.yaml"))]
    assert paths[:4] == ["name", "engine", "crankshaft", "absorber"] and paths[-1] == "operation"
    line = groups_of(torsional.load_model("examples/marine_line.yaml"))
    assert any(group["path"].startswith("components.") for group in line)
