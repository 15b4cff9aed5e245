"""The shipped truck with its absorbers, and the claims judged on it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import pytest

from torsional.studies.base import Outcome
from torsional.studies.register import claims
from torsional.studies.trucks import Trucks


@pytest.fixture(scope="session")
def trucks() -> Trucks:
    return Trucks.shipped()


class Judged(Mapping[str, Outcome]):
    """Outcomes by claim id, each worked out when it is first asked for."""

    def __init__(self, trucks: Trucks) -> None:
        self.trucks = trucks
        self.known: dict[str, Outcome] = {}

    def __getitem__(self, id: str) -> Outcome:
        if id not in self.known:
            self.known[id] = claims()[id](self.trucks)
        return self.known[id]

    def __iter__(self) -> Iterator[str]:
        return iter(claims())

    def __len__(self) -> int:
        return len(claims())


@pytest.fixture(scope="session")
def outcomes(trucks: Trucks) -> Mapping[str, Outcome]:
    return Judged(trucks)
