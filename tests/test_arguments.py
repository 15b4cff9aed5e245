"""Public functions called with what they do not take: a sentence that says what was found and what to do."""

from __future__ import annotations

import dataclasses
import inspect
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import torsional
from torsional import ModelError
from torsional.arguments import checked
from torsional.quantities import branches, region
from torsional.studies import subharmonic
from torsional.units import RPM

TRUCK = Path(__file__).parents[1] / "examples" / "truck_dmf.yaml"
PUBLIC = [getattr(torsional, name) for name in torsional.__all__]
FUNCTIONS = [thing for thing in PUBLIC if inspect.isfunction(thing)]
FUNCTIONS += [branches.coexisting, branches.solutions_at, branches.without_stable]
FUNCTIONS += [region.stretches, subharmonic.sought_region, subharmonic.within]
GIVEN_BACK = (torsional.System, torsional.OperatingPoint, torsional.MotionState)  # made by functions alone
CLASSES = [
    thing for thing in PUBLIC if inspect.isclass(thing) and dataclasses.is_dataclass(thing) and thing not in GIVEN_BACK
]


class Stranger:
    """Nothing that any function takes."""


@pytest.fixture(scope="module")
def things() -> dict[str, Any]:
    """A model and what is made of it, by name."""
    model = torsional.load_model(TRUCK)
    system, point = torsional.at_operating_point(model, 1000.0)
    drive = torsional.engine_drive(model, 1000 * RPM, 1000.0)
    return {"model": model, "system": system, "point": point, "drive": drive, "powertrain": model.powertrain()}


@pytest.mark.parametrize("function", FUNCTIONS, ids=lambda function: function.__name__)
def test_every_public_function_refuses_a_stranger(function: Any) -> None:
    parameters = inspect.signature(function).parameters.values()
    single = [each for each in parameters if each.kind in (each.POSITIONAL_OR_KEYWORD, each.KEYWORD_ONLY)]
    needed = [each.name for each in single if each.default is each.empty]
    with pytest.raises(ModelError) as caught:
        function(**{name: Stranger() for name in needed})
    first = needed[0]
    assert caught.value.where == f"{function.__name__}({first})"
    assert caught.value.found == "a Stranger"
    assert caught.value.problem.endswith("is wanted")


@pytest.mark.parametrize("kind", CLASSES, ids=lambda kind: kind.__name__)
def test_every_public_class_refuses_a_stranger_in_any_field(kind: Any) -> None:
    fields = dataclasses.fields(kind)
    needed = [each.name for each in fields if each.default is each.default_factory is dataclasses.MISSING]
    told = []
    for name in needed or [fields[0].name]:
        others = {other: "1" if "str" in str(kind.__annotations__.get(other, "")) else 1 for other in needed}
        with pytest.raises(ModelError) as caught:
            kind(**{**others, name: Stranger()})
        assert caught.value.problem.endswith("wanted")
        told.append(caught.value.found)
    assert "a Stranger" in told or kind is torsional.Powertrain


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: torsional.Jenkins("50 Nm", 1.0), ["limit_torque: a finite number is wanted", "'50 Nm' (str)"]),
        (lambda: torsional.Hinges("x"), ["stiffness: a finite number is wanted; found 'x' (str)"]),
        (lambda: torsional.Hinges.staged([("x", 1.0)]), ["stages: pairs of a torque"]),
        (lambda: torsional.Polynomial("x"), ["coefficients: a list, each a finite number"]),
        (lambda: torsional.SpeedProfile.constant("x"), ["SpeedProfile.constant(speed)", "units.read"]),
        (lambda: torsional.SpeedProfile("x", "y"), ["times: a list"]),
        (lambda: torsional.TorqueHistory("a", "x", [1.0]), ["times: a list"]),
        (lambda: torsional.Excitation("a", [1.0], 1.0, [[1.0]]), ["nodes", "write ['a']"]),
        (lambda: torsional.Powertrain(5), ["Powertrain(components): a mapping from names"]),
        (lambda: torsional.Shaft(1, "b", 3.0), ["a: a text is wanted; found 1 (int)"]),
        (lambda: torsional.Shaft("a", "b", np.nan), ["stiffness: a finite number is wanted; found nan"]),
        (lambda: torsional.OrderTorques(5), ["excitation: an Excitation is wanted"]),
    ],
)
def test_what_classes_tell(make: Any, told: list[str]) -> None:
    with pytest.raises(ModelError) as caught:
        make()
    assert [part for part in told if part not in str(caught.value)] == []


def test_classes_take_numbers_of_every_kind() -> None:
    assert torsional.Shaft("a", "b", np.float32(2.0)).stiffness == 2.0
    assert torsional.FullLoad(np.array([1.0, 2.0]), [3, 4]).torques == (3, 4)
    assert torsional.Hinges.staged([(np.inf, 1)]).stiffness == 1.0


CASES: list[tuple[str, list[Any], dict[str, Any], list[str]]] = [
    (
        "transient",
        ["model", "drive", 1.0],
        {},
        ["transient(system)", "found a Model", "assemble("],
    ),
    ("transient", ["system", 5, 1.0], {}, ["transient(drives)", "found 5 (int)", "OrderTorques"]),
    ("transient", ["system", "drive", "=1 s"], {}, ["transient(time)", "found '1 s' (str)", "units.read"]),
    ("transient", ["system", "drive", np.nan], {}, ["transient(time)", "found nan"]),
    ("transient", ["system", "drive", 0.1], {"keep": "=primary"}, ["write ['primary']"]),
    ("transient", ["system", "drive", 0.1], {"levels": {"a": 5}}, ["transient(levels)", "2 values"]),
    ("modal", ["powertrain"], {}, ["modal(system)", "found a Powertrain", "assemble(powertrain)"]),
    ("assemble", ["model"], {}, ["assemble(powertrain)", "model.powertrain(gear)"]),
    ("assemble", [{}], {}, ["found a dict", "Powertrain(parts)"]),
    ("campbell", ["=truck.yaml"], {}, ["campbell(model)", "found 'truck.yaml' (str)", "load_model(path)"]),
    ("campbell", [Path("truck.yaml")], {}, ["campbell(model)", "load_model(path)"]),
    ("campbell", [{"name": "truck"}], {}, ["found a dict", "load_model(path)"]),
    ("campbell", ["system"], {}, ["a Model is wanted; found a System"]),
    ("campbell", ["model", 100.0], {"gears": "=12"}, ["campbell(gears)", "write ['12']"]),
    ("campbell", ["model", 100.0], {"gears": []}, ["campbell(gears)", "found [] (list)"]),
    ("campbell", ["model", 100.0], {"orders": 3.0}, ["campbell(orders)", "a list", "found 3.0"]),
    ("campbell", ["model", 100.0], {"speeds": [-10.0, 90.0]}, ["campbell(speeds)", "backwards", "-10 rad/s"]),
    ("response_map", ["model", [600, 2000]], {}, ["response_map(speed)", "2000 rad/s", "'2000 rpm'"]),
    ("response_map", ["model", []], {}, ["response_map(speed)", "found [] (list)"]),
    ("response_map", ["model", [90.0], ["=x"]], {}, ["response_map(torque)", "an array of them"]),
    ("response_map", ["model", [[90.0], [1.0, 2.0]]], {}, ["response_map(speed)", "found [[90.0], [1.0, 2.0]]"]),
    ("model_response", ["model", (60.0, 70.0, 80.0)], {}, ["2 values", "found (60.0, 70.0, 80.0)"]),
    ("model_response", ["model"], {"depth": True}, ["a whole number", "found True"]),
    ("model_hysteresis", ["model", "=x", 0.1], {}, ["model_hysteresis(speed)", "found 'x'"]),
    ("model_hysteresis", ["model", 0.0, 60.0], {}, ["model_hysteresis(sweep)", "'60 deg'"]),
    ("run_up_response", ["model", [70.0, 80.0], [1.0, 2.0, 3.0]], {}, ["3 torques and 2 speeds"]),
    ("run_up", ["model", 900, 500.0, 1.0], {}, ["run_up(speed)", "'900 rpm'"]),
    ("equilibrium", ["system", {"throw1": "x"}, "=vehicle"], {}, ["equilibrium(torques)", "a mapping from names"]),
    ("engine_drive", ["model", 90.0, 500.0, -3.0], {}, ["orders", "3 and -3"]),
    ("engine_drive", ["model", 90.0, 500.0], {"base_order": 0.0}, ["orders", "0 and 18"]),
    ("steady_state", ["system", "drive"], {"longest": 0}, ["longest", "found 0"]),
    ("steady_state", ["system", "drive"], {"parts": -1}, ["parts", "found -1"]),
    ("steady_state", ["system", "drive"], {"tolerance": 0.0}, ["tolerance", "found 0"]),
    ("write_report", [["=x.yaml"], "=page.html"], {}, ["write_report(models)", "load_model(path)"]),
    ("changed", ["model", 5], {}, ["changed(edits)", "a text or a mapping"]),
    ("load_model", [5], {}, ["load_model(path)", "a text or a path"]),
]


@pytest.mark.parametrize(("name", "arguments", "options", "told"), CASES, ids=lambda value: str(value)[:50])
def test_what_is_told(things: Any, name: str, arguments: list[Any], options: Any, told: list[str]) -> None:
    def meant(value: Any) -> Any:
        if isinstance(value, list):
            return [meant(each) for each in value]
        if not isinstance(value, str):
            return value
        return value[1:] if value[0] == "=" else things[value]

    with pytest.raises(ModelError) as caught:
        getattr(torsional, name)(*map(meant, arguments), **{key: meant(value) for key, value in options.items()})
    assert [part for part in told if part not in str(caught.value)] == []


def test_numbers_of_every_kind_are_taken() -> None:
    @checked
    def same(value: float, whole: int, both: tuple[float, float], limit: float = np.inf) -> list[Any]:
        return [value, whole, both, limit]

    assert same(np.float32(0.5), np.int64(3), [1, 2]) == [0.5, 3, [1, 2], np.inf]
    assert same(np.array(2), 3, np.array([1.0, 2.0]), limit=np.inf)[0] == 2
    with pytest.raises(ModelError, match="found inf"):
        same(np.inf, 3, (1.0, 2.0))


def test_python_itself_names_what_is_missing(things: Any) -> None:
    with pytest.raises(TypeError, match=r"transient\(\) missing 2 required positional arguments"):
        torsional.transient(things["system"])
    with pytest.raises(TypeError, match="unexpected keyword argument 'stepp'"):
        torsional.modal(things["system"], stepp=1.0)


def test_a_fast_speed_is_taken_where_the_model_says_nothing_of_its_range() -> None:
    parts = {
        "disc": torsional.Inertia(1.0),
        "hub": torsional.Inertia(2.0),
        "shaft": torsional.Shaft("hub", "disc", 1e4),
    }
    bare = torsional.Model("bare", parts, torsional.Landmarks())
    assert torsional.campbell(bare, 0.0, speeds=[600.0, 2000.0], orders=[1.0]).sizes["speed"] == 2
