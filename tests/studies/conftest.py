"""The shipped truck with its absorbers, and the claims judged on it."""

from __future__ import annotations

from pathlib import Path

import pytest

from torsional.files import load_model
from torsional.studies.claims import Outcome, judged
from torsional.studies.claims.trucks import Trucks

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.fixture(scope="session")
def trucks() -> Trucks:
    files = ["smf", "dmf", "psva", "dmf_tva", "planetary_dmf", "dmf_pendulum"]
    return Trucks(*(load_model(EXAMPLES / f"truck_{name}.yaml") for name in files))


@pytest.fixture(scope="session")
def outcomes(trucks: Trucks) -> dict[str, Outcome]:
    return {outcome.claim.id: outcome for outcome in judged(trucks)}
