"""Scenario files: read strictly, refused clearly, changed by key paths."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.shipped import ROOT, shipped

from torsional import ModelError
from torsional.files.scenario import adapted, load_scenario, scenario_from_document
from torsional.files.scenario_schema import KINDS
from torsional.units import RPM

BAD = [
    ("engine_start", "starter.sped=3", ["starter.sped", "did you mean 'speed'?"]),
    ("engine_start", "duration=-1 s", ["duration", "must be positive", "-1 s"]),
    ("engine_start", "firing_from=5 s", ["firing_from", "5 s", "before the end, 2 s"]),
    ("engine_start", "step=0.5 s", ["step", "too large", "0.5 s", "0.02 s"]),
    ("engine_start", "starter.torque=30 rpm", ["starter.torque", "rpm is an angular velocity"]),
    ("traction_loss", "found=0.1 s", ["found", "0.1 s", "after 0.3 s"]),
    ("gear_shift", "clutch.opens=0.3 s", ["clutch.opens", "the engine still pulls", "0.3 s", "0.4 s and later"]),
    ("gear_shift", "synchroniser.begins=0.45 s", ["synchroniser.begins", "not open yet", "0.5 s and later"]),
    ("gear_shift", "synchroniser.within=1 s", ["clutch.engages", "not in yet", "1.2 s", "1.55 s and later"]),
    ("gear_shift", "torque_from=1 s", ["torque_from", "the clutch is still open", "1.2 s and later"]),
    ("gear_shift", "duration=1.4 s", ["torque_from", "nothing would be seen"]),
    ("stall", "torsional_scenario=2", ["torsional_scenario", "later torsional", "allowed: 1"]),
    ("engine_strat", "duration=1 s", ["engine_strat", "did you mean 'engine_start'?"]),
]


@pytest.mark.parametrize(("kind", "change", "told"), BAD, ids=[change for _, change, _ in BAD])
def test_bad_values_are_refused_in_words(kind: str, change: str, told: list[str]) -> None:
    with pytest.raises(ModelError) as caught:
        load_scenario(kind, [change])
    assert [part for part in told if part not in str(caught.value)] == []


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_stands_without_a_file(kind: str) -> None:
    assert load_scenario(kind) == scenario_from_document({"torsional_scenario": 1, "scenario": kind})


@pytest.mark.parametrize("path", sorted((ROOT / "examples" / "scenarios").glob("*.yaml")), ids=lambda path: path.stem)
def test_examples_are_the_defaults_written_out(path: Path) -> None:
    """What a file shows is what holds without it: the two cannot tell different stories."""
    found, usual = (dict(leaves(load_scenario(source).model_dump())) for source in (path, path.stem))
    other = {key for key, value in found.items() if usual.get(key) is not None and not same(value, usual[key])}
    assert other <= {"name", "model"}


def same(a: Any, b: Any) -> bool:
    """Numbers to rounding, all else exactly."""
    return a == (pytest.approx(b, rel=1e-12) if isinstance(b, float) else b)


def leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Key paths and single values."""
    if isinstance(value, dict) and path != "model":
        for key, item in value.items():
            yield from leaves(item, f"{path}.{key}" if path else key)
    else:
        yield path, value


def test_every_kind_has_an_example() -> None:
    assert sorted(path.stem for path in (ROOT / "examples" / "scenarios").glob("*.yaml")) == sorted(KINDS)


def test_errors_name_file_key_and_line(tmp_path: Path) -> None:
    file = tmp_path / "start.yaml"
    file.write_text("torsional_scenario: 1\nscenario: engine_start\nstarter:\n  torque: -5 Nm\n", encoding="utf-8")
    with pytest.raises(ModelError, match=r"start\.yaml: starter\.torque \(line 4\): must be positive; found '-5 Nm'"):
        load_scenario(file)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("torsional_scenario: 1\nscenario: engine_strat\n", "did you mean 'engine_start'"),
        ("torsional_scenario: 1\nduration: 1 s\n", "the key 'scenario' is missing"),
        ("torsional: 1\nname: My truck\n", "is this a model file"),
        ("torsional_scenario: 1\nscenario: stall\nduration:\n", "the key has no value"),
        ("scenario: stall\n", "the key 'torsional_scenario' is missing"),
    ],
)
def test_files_that_are_none(tmp_path: Path, text: str, told: str) -> None:
    file = tmp_path / "bad.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError, match=told):
        load_scenario(file)


def test_a_scenario_overrides_values_of_the_model() -> None:
    model = shipped("truck_dmf")
    overriding = {"torsional_scenario": 1, "scenario": "stall", "model": {"absorber": {"damping": 7.0}}}
    changed = adapted(model, scenario_from_document(overriding))
    assert changed.components["dmf"].damping == 7.0  # type: ignore[attr-defined]
    overriding["model"] = {"absorber": {"dampin": 7.0}}
    with pytest.raises(ModelError, match=r"model\.absorber\.dampin: .*did you mean 'damping'"):
        adapted(model, scenario_from_document(overriding))


def test_units_are_read() -> None:
    scenario = load_scenario("engine_start", ["starter.speed=150 rpm", "starter.until=900 ms"])
    assert scenario.model_dump()["starter"]["speed"] == pytest.approx(150 * RPM)
    assert scenario.model_dump()["starter"]["until"] == pytest.approx(0.9)
