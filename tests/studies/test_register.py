"""The register of claims: all there, described, judged; what is not reproduced says why."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from torsional.studies.base import Claim, Finding, Outcome, claim, shown
from torsional.studies.register import claims
from torsional.studies.swept import Along, Curve, swept

IDS = [
    *(f"A{n}" for n in range(1, 17)),
    *(f"B{n}" for n in range(1, 7)),
    *(f"C{n}" for n in range(1, 7)),
    *(f"D{n}" for n in range(1, 5)),
    *(f"E{n}" for n in range(1, 3)),
    *(f"F{n}" for n in range(1, 5)),
    *(f"G{n}" for n in range(1, 5)),
]
NOT_REPRODUCED = {"A1", "A13", "F4"}
WITH_A_CONDITION = {"A3", "A10", "A12", "B3", "B5", "D2", "E2", "F1", "F2", "G1", "G2", "G3"}


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


def test_an_outcome_is_a_table_in_a_notebook() -> None:
    claim = Claim("Z1", "1.2", "Springs are soft < hard.", "by hand")
    told = Outcome(claim, Finding(True, "top gear", {"speed [rpm]": 650.0}, proviso="below idle"))._repr_html_()
    assert "Z1: reproduced with a condition. Springs are soft &lt; hard." in told
    assert "<td>holds where</td><td>below idle</td>" in told and "<td>speed [rpm]</td><td>650</td>" in told
    assert "to be said" not in told  # there is nothing


def test_what_draws_a_finding() -> None:
    data = swept("Z1", Along("factor", [1.0, 2.0], "ratio"), {"speed": Curve([3.0, 4.0], "speed")})
    asked = claim("Z1", "1.2", "s", "c", picture=lambda found: found.sizes["factor"])(lambda trucks: None)
    assert asked.drawn(Finding(True, "c", {}, dataset=data)) == 2
    assert asked.drawn(Finding(True, "c", {})) is None
    assert len(dataclasses.replace(asked, picture=None).drawn(Finding(True, "c", {}, dataset=data)).axes) == 1
