"""What a notebook shows: short tables, with units, that nothing typed by a user can break out of."""

import sys
from types import SimpleNamespace

import numpy as np
import pytest

import torsional as tv
from tests.shipped import shipped
from torsional.plots.style import show_in_notebooks


@pytest.fixture(scope="module")
def truck() -> tv.Model:
    return shipped("truck_dmf")


def test_objects_tell_what_they_are_in_a_line(truck: tv.Model) -> None:
    system, _ = tv.at_operating_point(truck, 1500.0)
    for shown, told in (
        (truck, "38 components, dual mass flywheel, gears 1, 2"),
        (truck.powertrain(), "40 components on 18 nodes"),
        (system, "18 nodes, 16 coordinates, linear"),
        (tv.assemble(truck.powertrain()), "with laws: dmf"),
    ):
        assert told in repr(shown)
        assert len(repr(shown)) < 140


def test_tables_have_units(truck: tv.Model) -> None:
    system, point = tv.at_operating_point(truck, 1500.0)
    assert "<td>dmf</td><td>Coupling</td><td>a secondary, b primary, law Hinges, damping" in truck._repr_html_()
    assert "<td>half_shafts</td><td>100 kNm/rad</td>" in system._repr_html_()
    # 1500 Nm on 13 kNm/rad
    row = f"<td>dmf</td><td>1500 Nm</td><td>{np.degrees(1500 / 13e3):.4f} deg</td><td>13 kNm/rad</td>"
    assert row in point._repr_html_()
    assert "<td>damper</td><td>0 Nm</td><td>0 deg</td>" in point._repr_html_()


def test_a_model_with_parts_missing_is_shown_too(truck: tv.Model) -> None:
    assert "flywheel" in truck.without("clutch")._repr_html_()


def test_names_are_escaped() -> None:
    page = tv.Model("<script>", {"a": tv.Inertia(1.0)}, tv.Landmarks())._repr_html_()
    assert "<script>" not in page and "&lt;script&gt;" in page


def test_pictures_are_shown_without_pyplot(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[object] = []
    shell = SimpleNamespace(kernel=object())
    tools = SimpleNamespace(select_figure_formats=lambda *told: asked.append(told))
    monkeypatch.setitem(sys.modules, "IPython", SimpleNamespace(get_ipython=lambda: shell))
    monkeypatch.setitem(sys.modules, "IPython.core.pylabtools", tools)
    show_in_notebooks()
    assert asked == [(shell, {"png"})]
    del shell.kernel  # a terminal
    show_in_notebooks()
    assert len(asked) == 1
