"""Units in tests are compiled without optimisation, in a quarter of the time, but where a test asks for it."""

from __future__ import annotations

import pytest

from torsional.exchange.fmu import packing

AS_SHIPPED = packing.OPTIONS


@pytest.fixture(autouse=True)
def compiled_quickly(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(packing, "OPTIONS", tuple("-O0" if option == "-O2" else option for option in AS_SHIPPED))


@pytest.fixture
def as_shipped(compiled_quickly: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(packing, "OPTIONS", AS_SHIPPED)
