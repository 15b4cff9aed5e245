"""`torsional optimise`: what is refused before any work, and what comes of a plan."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

PLANS = Path(__file__).parents[2] / "examples" / "plans"


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["best-dfm", "truck.yaml"], "there is no such preset, and no such plan; found 'best-dfm'"),
        (["nothing.yaml"], "nothing.yaml: there is no such file"),
        ([str(PLANS / "clutch_and_primary.yaml")], "torsional sweep takes this plan"),
        ([str(PLANS / "best_flywheel.yaml"), "truck.yaml"], "a plan names its own model and limits"),
    ],
)  # fmt: skip
def test_what_cannot_be_optimised_is_told(torsional: Callable[..., Any], arguments: list[str], told: str) -> None:
    found = torsional("optimise", *arguments)
    assert found.code == 2 and told in found.err and not list(Path.cwd().glob("*.optimise"))


def test_a_plan_is_worked_through_kept_and_told_in_every_form(torsional: Callable[..., Any]) -> None:
    few = "--population", 4, "--generations", 1, "--processes", 1, "--folder", "kept"
    files = [f"best{suffix}" for suffix in (".html", ".csv", ".json", ".nc", ".png")]
    outputs = [part for name in files for part in ("-o", name)]
    plan = str(PLANS / "best_flywheel.yaml")
    first = torsional("optimise", plan, *few, *outputs)
    assert first.code == 0, first.err
    assert "designs were asked" in first.out and all(f"written: {name}" in first.err for name in files)
    assert "best low speed" in Path("best.html").read_text(encoding="utf-8").lower()
    told = json.loads(Path("best.json").read_text(encoding="utf-8"))
    assert told["command"] == "optimise" and told["folder"] == "kept"
    again = torsional("optimise", plan, *few)
    assert again.code == 2 and "--resume goes on with it" in again.err
    resumed = torsional("optimise", plan, *few, "--resume", "--json")
    assert resumed.code == 0 and json.loads(resumed.out)["result"] == told["result"]
