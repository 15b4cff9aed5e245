"""The two trucks compared on a coarse grid, once for all tests; their page, once for those that read it."""

from __future__ import annotations

import pytest
from tests.shipped import shipped

from torsional.model import Model
from torsional.report.analysis import Comparison, analysed
from torsional.report.page import rendered


def example(name: str) -> Model:
    return shipped(name)


@pytest.fixture(scope="session")
def trucks() -> Comparison:
    return analysed([example("truck_dmf_two_stage"), example("truck_smf")], [], 15, 6, lambda done, total: None)


@pytest.fixture(scope="session")
def page(trucks: Comparison) -> str:
    return rendered(trucks)


@pytest.fixture(scope="session")
def hostile_page() -> str:
    """A report on a model whose names try to be more than names."""
    name = "<script>alert(1)</script> $\\frac{ --> & \"'><img src=x onerror=alert(2)> {{ 7 * 6 }}"
    model = example("mwm_engine").replaced(name=name)
    return rendered(analysed([model, example("marine_line").replaced(name="<b>bold</b>")], [], 6, 4, lambda a, b: None))
