"""The published JSON Schema, and the quantities it is made of."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import jsonschema
import pytest
from tests.shipped import MODEL_FILES

from torsional.errors import ModelError
from torsional.files import json_schema
from torsional.files.reader import read_tree
from torsional.files.schema.fields import Quantity, plain_name
from torsional.units import QUANTITIES

SCHEMA = json_schema()


def blocks(node: Any) -> list[dict[str, Any]]:
    """Every mapping inside a schema."""
    inner = node.values() if isinstance(node, dict) else node if isinstance(node, list) else ()
    return ([node] if isinstance(node, dict) else []) + [found for item in inner for found in blocks(item)]


def test_is_a_schema_of_draft_2020_12() -> None:
    jsonschema.Draft202012Validator.check_schema(SCHEMA)
    assert SCHEMA["$schema"].endswith("2020-12/schema")


@pytest.mark.parametrize("path", MODEL_FILES, ids=lambda path: path.stem)
def test_shipped_models_are_valid_under_the_schema(path: Path) -> None:
    validator = jsonschema.Draft202012Validator(SCHEMA)
    data = read_tree(path).data
    assert [error.message for error in validator.iter_errors(data)] == []
    assert list(validator.iter_errors({**data, "absorbr": {}}))


def test_every_quantity_tells_its_unit() -> None:
    measured = [block for block in blocks(SCHEMA) if "x-quantity" in block]
    assert len(measured) > 100
    for block in measured:
        unit = QUANTITIES[block["x-quantity"]].unit
        assert unit == "-" or (block["x-unit"] == unit and unit in block.get("title", unit))


def test_keys_without_value_are_not_valid() -> None:
    assert {"type": "null"} not in blocks(SCHEMA)


def test_every_block_is_closed_and_described() -> None:
    for name, block in SCHEMA["$defs"].items():
        assert block["additionalProperties"] is False, name
        assert block["description"], name


@pytest.mark.parametrize(
    ("quantity", "value", "expected"),
    [
        (Quantity("stiffness"), "8 kNm/rad", 8000.0),
        (Quantity("stiffness", shape="one or list"), [1, "2 kNm/rad"], [1.0, 2000.0]),
        (Quantity("gear_ratio", shape="list or names"), {"low": 3, "high": "1"}, {"low": 3.0, "high": 1.0}),
        (Quantity("torque", shape="range"), "0:2.5 kNm", (0.0, 2500.0)),
    ],
)
def test_quantity_reads(quantity: Quantity, value: object, expected: object) -> None:
    assert quantity.read(value) == expected


@pytest.mark.parametrize(
    ("quantity", "value", "message"),
    [
        (Quantity("inertia", above=0), 0, "must be positive; found 0; allowed: > 0 kgm²"),
        (
            Quantity("damping", least=0),
            "-1 Nms/rad",
            "must not be negative; found '-1 Nms/rad'; allowed: >= 0 Nm s/rad",
        ),
        (Quantity("gear_ratio", nonzero=True), 0.0, "must not be zero; found 0; allowed: any other number"),
        (Quantity("ratio", above=1), 1, "is too small; found 1; allowed: > 1"),
        (Quantity("stiffness", shape="list"), 3.0, "a list is wanted; found 3.0"),
        (Quantity("stiffness", shape="one or list"), [], "the list has the wrong length; found 0; allowed: 1 to 2000"),
        (
            Quantity("speed", above=0, shape="range"),
            "-5:5 rpm",
            "must be positive; found '-5:5 rpm'; allowed: > 0 rad/s",
        ),
    ],
)
def test_quantity_refuses(quantity: Quantity, value: object, message: str) -> None:
    with pytest.raises(ModelError) as caught:
        quantity.read(value)
    assert str(caught.value) == message


@pytest.mark.parametrize("name", ["flywheel", "1", "gear 3", "throw-1", "Nebenwelle_ä", "tube.3"])
def test_names_that_may_be(name: str) -> None:
    assert plain_name(name) == name


@pytest.mark.parametrize("name", ["", " a", "a ", "a:b", "<b>", "a=b", "ground", "x" * 65, "a\nb", "=1+1", "a/b"])
def test_names_that_may_not_be(name: str) -> None:
    with pytest.raises(ModelError, match="this cannot be a name"):
        plain_name(name)
