"""`torsional optimise`: what is refused before any work."""

from __future__ import annotations

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
