"""A user who compares designs, browses a finished study, and has branches and runs in time worked out."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Locator, Page, expect
from tests.shipped import ROOT

import torsional
from torsional.quantities.modes import modes_of
from torsional.results import labelled, save_results

from .conftest import Served
from .test_designing import field, view

Opened = Callable[..., Page]
TWO_STAGE = [ROOT / "examples" / name for name in ("truck_dmf_two_stage.yaml", "truck13_full_load.csv")]


def met_at(stiffness: str) -> float:
    """The speed [rpm] at which the main order meets the absorber's mode."""
    model = torsional.changed(
        torsional.load_model(ROOT / "examples" / "truck_dmf.yaml"), f"absorber.stiffness={stiffness}"
    )
    found = modes_of(model, "12", model.typical_torque(), model.operation.idle, 3.0)
    at = [str(name) for name in found.name.values].index("DMF mode")
    return float(found.order_speed[at]) / torsional.RPM


def told(speed: float) -> str:
    """As the page tells it."""
    return f"{float(f'{speed:.4g}'):g} rpm"


def row(page: Page, text: str) -> Locator:
    return page.get_by_role("region", name="Criteria").get_by_role("row").filter(has_text=text)


def test_designs_are_kept_compared_and_taken_back(page: Page) -> None:
    field(page, "absorber.stiffness").fill("10 kNm/rad")
    view(page, "Comparison")
    page.get_by_role("button", name="Keep as variant").click()
    field(page, "absorber.stiffness").fill("16 kNm/rad")
    cells = row(page, "meets the DMF mode").get_by_role("cell")
    expect(cells.nth(0)).to_contain_text(told(met_at("16kNm/rad")))
    expect(cells.nth(1)).to_contain_text(told(met_at("10kNm/rad")))
    expect(cells.nth(1).get_by_label("best")).to_be_visible()
    expect(cells.nth(1)).to_contain_text(f"−{100 * (1 - met_at('10kNm/rad') / met_at('16kNm/rad')):.1f} %")
    differing = page.get_by_role("region", name="What the designs differ in").get_by_role("row").nth(1)
    expect(differing).to_have_text(re.compile("absorber.stiffness.*16 kNm/rad.*10 kNm/rad"))
    page.get_by_role("textbox", name="Name of variant 1").fill("softer")
    page.get_by_role("button", name="Take back").click()
    expect(field(page, "absorber.stiffness")).to_have_value("10 kNm/rad")
    page.get_by_role("button", name="Undo", exact=True).click()
    expect(field(page, "absorber.stiffness")).to_have_value("16 kNm/rad")
    page.get_by_role("button", name="Remove softer").click()
    expect(page.get_by_role("button", name="Take back")).to_have_count(0)


def test_a_computation_is_cancelled(page: Page) -> None:
    view(page, "Branches")
    page.get_by_role("button", name="Run branches").click()
    expect(page.get_by_role("progressbar")).to_be_visible()
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_text("Cancelled.")).to_be_visible()
    expect(page.get_by_role("button", name="Run branches")).to_be_enabled()


@pytest.fixture(scope="module")
def browsing(built: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A server beside a study of five designs, the last of them beyond a limit."""
    stiffness = np.array([13e3, 9576.1234567, 11e3, 12e3, 8e3])
    figures = {"noise": np.array([900.0, 600.0, 700.0, 950.0, 500.0]), "travel": np.array([1.0, 2.0, 1.5, 3.0, 5.0])}
    columns = {name: (("design",), values, "acceleration") for name, values in figures.items()}
    data = labelled(columns, {}, analysis="optimisation")
    data = data.assign_coords({"absorber.stiffness": ("design", stiffness), "role": ("design", ["nominal", *4 * [""]])})
    data = data.assign(on_front=("design", stiffness < 12e3), within=("design", stiffness > 9e3))
    notes = {"objectives": json.dumps([*figures]), "limits": json.dumps({"travel": [None, 4.0]})}
    path = tmp_path_factory.mktemp("study") / "best.nc"
    save_results(data.assign_attrs(maximised="[]", **notes), path)
    served = Served("examples/truck_dmf.yaml", "--processes=1", f"--results={path}")
    yield served
    served.stop()


def test_a_design_of_a_study_is_taken_over(opened: Opened, browsing: Served) -> None:
    page = opened(browsing.address)
    view(page, "Pareto front")
    picture = page.get_by_role("group", name=re.compile("arrow keys walk along the front"))
    picture.focus()
    page.keyboard.press("ArrowRight")
    design = page.get_by_role("region", name="Design best design 2")
    expect(design.get_by_role("row").filter(has_text="absorber.stiffness")).to_contain_text("9.576 kNm/rad")
    expect(design.get_by_role("row").filter(has_text="noise")).to_contain_text("−33.3 %")
    design.get_by_role("button", name="Take this design over").click()
    expect(field(page, "absorber.stiffness")).to_have_value(re.compile(r"9\.5761234567\d* kNm/rad"))
    page.keyboard.press("Control+z")
    expect(field(page, "absorber.stiffness")).to_have_value("13 kNm/rad")
    design.get_by_role("button", name="Keep as variant").click()
    view(page, "Comparison")
    expect(row(page, "meets the DMF mode").get_by_role("cell").nth(1)).to_contain_text(
        told(met_at("9576.1234567 Nm/rad"))
    )


def test_a_study_is_written_as_a_table_and_a_picture(opened: Opened, browsing: Served, tmp_path: Path) -> None:
    page = opened(browsing.address)
    view(page, "Pareto front")
    for kind, begins in (("csv", b"\xef\xbb\xbfdesign,absorber.stiffness"), ("svg", b"<svg"), ("png", b"\x89PNG")):
        with page.expect_download() as download:
            page.get_by_text("Export").click()
            page.get_by_role("button", name=kind.upper()).click()
        download.value.save_as(tmp_path / kind)
        assert download.value.suggested_filename == f"best.{kind}"
        assert (tmp_path / kind).read_bytes().startswith(begins)
    assert b"9576.1234567," in (tmp_path / "csv").read_bytes()


def test_branches_outlive_a_reload_and_say_when_they_are_out_of_date(page: Page) -> None:
    """The two-stage flywheel at 1200 Nm: a period doubling at either end of the motion of every second ignition."""
    with page.expect_file_chooser() as chooser:
        page.get_by_text("Open", exact=True).click()
        page.get_by_role("button", name="A model file of yours").click()
    chooser.value.set_files(TWO_STAGE)
    expect(page.get_by_role("heading", level=1)).to_contain_text("two-stage")
    view(page, "Branches")
    page.get_by_label("Mean torque of the branches").fill("1200")
    page.get_by_role("button", name="Run branches").click()
    expect(page.get_by_role("progressbar")).to_be_visible()
    page.reload()
    expect(page.get_by_role("progressbar")).to_be_visible()
    expect(page.get_by_role("listitem").filter(has_text="period doubling at")).to_have_count(2, timeout=120_000)
    expect(page.get_by_text("about the present design")).to_be_visible()
    field(page, "absorber.damping").press("ArrowUp")
    expect(page.get_by_text("about an earlier design")).to_be_visible()
    with page.expect_download() as download:
        page.get_by_text("Export").click()
        page.get_by_role("button", name="CSV").click()
    assert download.value.suggested_filename == "branches.csv"


@pytest.mark.full
def test_a_run_in_time_is_played_and_faults_of_its_values_are_told(page: Page) -> None:
    view(page, "Scenarios")
    page.get_by_role("combobox", name="Scenario").select_option(label="Tip-in")
    page.get_by_text("Its values").click()
    values = page.get_by_role("textbox", name="Values of the scenario")
    values.fill("durations: 0.5 s")
    values.blur()
    page.get_by_role("button", name="Run tip-in").click()
    expect(page.get_by_role("alert")).to_contain_text("did you mean 'duration'?", timeout=60_000)
    values.fill("duration: 0.5 s\nat: 0.1")
    values.blur()
    page.get_by_role("button", name="Run tip-in").click()
    player = page.get_by_role("group", name="Player")
    expect(player).to_be_visible(timeout=120_000)
    player.focus()
    page.keyboard.press("End")
    expect(player.get_by_role("status")).to_have_text("0.500 of 0.5 s")
    page.get_by_role("button", name=re.compile("Go to mean engine torque")).click()
    expect(player.get_by_role("status")).to_have_text(re.compile(r"0\.(099|100) of"))
    player.focus()
    page.keyboard.press(" ")
    expect(player.get_by_role("button", name="Play")).to_be_visible(timeout=60_000)  # it has come to its end
    expect(player.get_by_role("status")).to_have_text("0.500 of 0.5 s")
    expect(page.get_by_text("highest torque of dmf")).to_be_visible()
