"""The register of claims: all there, described, judged; what is not reproduced says why."""

from __future__ import annotations

import numpy as np
import pytest

from torsional.studies.base import Finding, Outcome, shown
from torsional.studies.register import claims

IDS = [
    *(f"A{n}" for n in range(1, 17)),
    *(f"B{n}" for n in range(1, 7)),
    *(f"C{n}" for n in range(1, 7)),
    *(f"D{n}" for n in range(1, 5)),
    *(f"E{n}" for n in range(1, 3)),
    *("F3", "F4"),
    *(f"G{n}" for n in range(1, 5)),
]
NOT_REPRODUCED = {"A1", "A13", "F4"}
WITH_A_CONDITION = {"A3", "D2", "E2", "G2"}


def test_every_claim_is_there() -> None:
    assert list(claims()) == IDS


def test_an_unknown_claim() -> None:
    with pytest.raises(KeyError):
        claims()["Z9"]


@pytest.mark.parametrize("id", IDS)
def test_described(id: str) -> None:
    claim = claims()[id].claim
    assert claim.id == id
    assert all(len(text) > 1 for text in (claim.section, claim.statement, claim.criterion))


@pytest.mark.parametrize("id", IDS)
def test_verdicts_on_the_shipped_truck(id: str, outcomes: dict[str, Outcome]) -> None:
    """A change of verdict is a change of the truck or of the physics: look at the figures first."""
    outcome = outcomes[id]
    conditional = "reproduced with a condition" if id in WITH_A_CONDITION else "reproduced"
    assert outcome.verdict == ("not reproduced" if id in NOT_REPRODUCED else conditional), str(outcome)
    assert outcome.finding.condition and outcome.finding.figures
    assert outcome.finding.reproduced or outcome.finding.reason
    for value in outcome.finding.figures.values():
        assert isinstance(value, str) or np.ravel(np.asarray(value)).dtype.kind in "fU"
    assert str(outcome).startswith(f"{id} {outcome.verdict}")
    told = outcome.finding.dataset
    curves = [] if told is None else [told[name] for name in told.data_vars if name != "order_speed"]
    assert all("units" in curve.attrs for curve in curves if curve.dtype.kind == "f")


def test_figures_as_text() -> None:
    assert shown(()) == "none"
    assert shown((1.0, 2.5)) == "1, 2.5"
    assert Finding(True, "c", {}).dataset is None
