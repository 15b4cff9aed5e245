"""A user at the page: values turned, wrong ones told, gears and absorbers exchanged, work saved, shared, found."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from playwright.sync_api import Page, expect
from tests.shipped import ROOT

import torsional
from torsional.quantities.modes import modes_of

from .conftest import WAIT, Served

expect.set_options(timeout=WAIT)
Opened = Callable[..., Page]
LARGEST = 500_000
"""Bytes of the whole page, as they are before any compression."""


def view(page: Page, name: str) -> None:
    page.get_by_role("tab", name=name, exact=True).click()


def block(page: Page, label: str) -> None:
    """Show the values of a block."""
    page.get_by_role("combobox", name="Values of").select_option(label=label)


def field(page: Page, path: str) -> Any:
    """The input of a value, by its key path; those with defaults are unfolded."""
    row = page.locator(f'[data-path="{path}"]')
    expect(row).to_have_count(1)
    if not row.is_visible():
        page.get_by_text(re.compile("more, not in the file")).click()
    return row.locator("input:not([type=range]), select").first


def first_frequency(page: Page, mode: str) -> Any:
    """The cell with the frequency of a mode."""
    row = page.get_by_role("region", name="Modes").get_by_role("row").filter(has_text=mode).first
    return row.get_by_role("cell").first


def told_frequency(mode: str, *changes: str, gear: str = "12", file: str = "truck_dmf") -> str:
    """What the page must say of a mode's frequency: the library's figure in four digits."""
    model = torsional.load_model(ROOT / "examples" / f"{file}.yaml")
    model = torsional.changed(model, *changes) if changes else model
    found = modes_of(model, gear, model.typical_torque(), model.operation.idle, 3.0)
    at = [str(name) for name in found.name.values].index(mode)
    return f"{float(f'{float(found.frequency[at]):.4g}'):g}"


def test_the_page_is_small_and_asks_nobody_else(opened: Opened, server: Served) -> None:
    page = opened("about:blank")
    asked: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.goto(server.address)
    expect(page.get_by_role("heading", level=1)).to_have_text("13-litre truck with a dual mass flywheel")
    view(page, "Modes")
    expect(first_frequency(page, "DMF mode")).to_have_text(told_frequency("DMF mode"))
    assert {urlsplit(address).netloc for address in asked} == {urlsplit(server.address).netloc}
    static = [address for address in asked if "/api/" not in address]
    sizes = [page.request.get(address).body() for address in static]
    assert len(static) >= 3 and sum(map(len, sizes)) <= LARGEST


def test_a_value_turned_is_answered_and_undone(page: Page) -> None:
    view(page, "Modes")
    stiffness = field(page, "absorber.stiffness")
    stiffness.fill("10 kNm/rad")
    expect(first_frequency(page, "DMF mode")).to_have_text(told_frequency("DMF mode", "absorber.stiffness=10kNm/rad"))
    stiffness.press("ArrowUp")
    expect(stiffness).to_have_value(re.compile(r"10\.1 kNm/rad"))
    expect(first_frequency(page, "DMF mode")).to_have_text(told_frequency("DMF mode", "absorber.stiffness=10.1kNm/rad"))
    for _ in range(4):
        page.keyboard.press("Control+z")
    expect(stiffness).to_have_value("13 kNm/rad")
    expect(first_frequency(page, "DMF mode")).to_have_text(told_frequency("DMF mode"))
    page.keyboard.press("Control+Shift+z")
    expect(stiffness).not_to_have_value("13 kNm/rad")


@pytest.mark.parametrize(
    ("label", "path", "value", "change"),
    [
        ("Absorber", "absorber.primary_inertia", "15000 kg·cm²", "absorber.primary_inertia=15000 kg·cm²"),
        ("Clutch", "clutch.stiffness", "31000", "clutch.stiffness=31000"),  # a plain number
        ("Gearbox", "gearbox.ratios.11", "1.5", "gearbox.ratios.11=1.5"),  # one of a list
        (
            "Engine",
            "engine.firing_order",
            "[1, 4, 2, 6, 3, 5]",
            "engine.firing_order=[1, 4, 2, 6, 3, 5]",
        ),  # a whole list
        ("Engine", "engine.deactivated_valves", "working", "engine.deactivated_valves=working"),  # a choice
        ("Crankshaft", "crankshaft.flange_damping", "12", "crankshaft.flange_damping=12"),
        ("Absorber", "absorber.friction_torque", "40 Nm", "absorber.friction_torque=40 Nm"),  # not in the file
        ("Operation", "operation.speed", "700:1900 rpm", "operation.speed=700:1900 rpm"),  # a range
        ("Vehicle", "vehicle.mass", "20 t", "vehicle.mass=20 t"),
        ("Model", "name", "Another name", "name=Another name"),  # a text
    ],
)
def test_every_kind_of_value_can_be_changed_and_saved(
    page: Page, label: str, path: str, value: str, change: str, tmp_path: Path
) -> None:
    block(page, label)
    edited = field(page, path)
    if edited.evaluate("element => element.tagName") == "SELECT":
        edited.select_option(value)
    else:
        edited.fill(value)
    wanted = torsional.changed(torsional.load_model(ROOT / "examples" / "truck_dmf.yaml"), change)
    assert saved(page, tmp_path).hash == wanted.hash
    expect(edited).to_have_attribute("aria-invalid", "false")


def saved(page: Page, folder: Path) -> torsional.Model:
    """The model file that the page hands over, loaded."""
    with page.expect_download() as told:
        page.get_by_role("button", name="Save", exact=True).click()
    told.value.save_as(folder / "saved.yaml")
    (folder / "truck13_full_load.csv").write_bytes((ROOT / "examples" / "truck13_full_load.csv").read_bytes())
    return torsional.load_model(folder / "saved.yaml")


def test_counts_and_switches_of_another_absorber(page: Page, tmp_path: Path) -> None:
    page.get_by_role("combobox", name="type").select_option(label="arc-spring dual mass flywheel")
    expect(page.locator('[data-path="absorber.segments"]')).to_have_count(1)
    field(page, "absorber.segments").fill("10")
    field(page, "absorber.spring.free_length").fill("191 mm")  # longer than its channel, which has to be meant
    field(page, "absorber.preloaded").check()
    found = saved(page, tmp_path)
    assert found.document["absorber"]["segments"] == 10 and found.document["absorber"]["preloaded"] is True


@pytest.mark.parametrize(
    ("path", "value", "told"),
    [
        ("absorber.stiffness", "twelve", "a number is wanted"),
        ("absorber.stiffness", "13 kNm/furlong", "unit"),
        ("absorber.primary_inertia", "-1", "must be positive"),
        ("absorber.stop_torque", "1e400 Nm", ""),
    ],
)
def test_a_wrong_value_is_told_at_its_field_and_the_picture_stays(page: Page, path: str, value: str, told: str) -> None:
    view(page, "Modes")
    before = told_frequency("DMF mode")
    expect(first_frequency(page, "DMF mode")).to_have_text(before)
    wrong = field(page, path)
    right = wrong.input_value()
    wrong.fill(value)
    expect(wrong).to_have_attribute("aria-invalid", "true")
    fault = page.locator(f'[data-path="{path}"] .fault')
    expect(fault).to_contain_text(told)
    assert fault.get_attribute("id") in (wrong.get_attribute("aria-describedby") or "")
    expect(first_frequency(page, "DMF mode")).to_have_text(before)
    wrong.fill(right)
    expect(wrong).to_have_attribute("aria-invalid", "false")


def test_another_absorber_and_back(page: Page) -> None:
    view(page, "Modes")
    field(page, "absorber.stiffness").fill("12 kNm/rad")
    choice = page.get_by_role("combobox", name="type")
    choice.select_option(label="power split absorber")
    expect(first_frequency(page, "PSVA mode")).to_be_visible()
    expect(page.locator('[data-path="absorber.planet_ratio"]')).to_be_visible()
    expect(page.get_by_label(re.compile("^planets"))).to_have_count(1)
    choice.select_option(label="single mass flywheel")
    expect(page.locator('[data-path="absorber.inertia"]')).to_be_visible()
    for _ in range(2):
        page.get_by_role("button", name="Undo", exact=True).click()
    expect(first_frequency(page, "DMF mode")).to_have_text(told_frequency("DMF mode", "absorber.stiffness=12kNm/rad"))


def test_gears_are_switched(page: Page) -> None:
    view(page, "Modes")
    page.get_by_role("combobox", name="Gear").select_option("3")
    expect(first_frequency(page, "clutch mode")).to_have_text(told_frequency("clutch mode", gear="3"))


def test_a_link_carries_the_design(opened: Opened, server: Served) -> None:
    page = opened(server.address, permissions=["clipboard-read", "clipboard-write"])
    view(page, "Modes")
    field(page, "absorber.stiffness").fill("9.5 kNm/rad")
    wanted = told_frequency("DMF mode", "absorber.stiffness=9.5kNm/rad")
    expect(first_frequency(page, "DMF mode")).to_have_text(wanted)
    page.get_by_role("button", name="Share").click()
    expect(page.get_by_text("The link to this design")).to_be_visible()
    link = page.evaluate("() => navigator.clipboard.readText()")
    assert "#d=" in link and link.startswith(server.address)
    other = opened(link)
    expect(field(other, "absorber.stiffness")).to_have_value("9.5 kNm/rad")
    view(other, "Modes")
    expect(first_frequency(other, "DMF mode")).to_have_text(wanted)


def test_a_broken_link_is_told(opened: Opened, server: Served) -> None:
    page = opened(f"{server.address}#d=AAAAbroken")
    expect(page.get_by_text(re.compile("link"))).to_be_visible()
    expect(page.get_by_role("heading", level=1)).to_contain_text("13-litre truck")


def test_work_survives_a_reload(page: Page) -> None:
    field(page, "absorber.stiffness").fill("9 kNm/rad")
    view(page, "Modes")
    expect(first_frequency(page, "DMF mode")).to_have_text(told_frequency("DMF mode", "absorber.stiffness=9kNm/rad"))
    page.reload()
    expect(field(page, "absorber.stiffness")).to_have_value("9 kNm/rad")


def test_a_file_of_ones_own_with_its_table(page: Page, tmp_path: Path) -> None:
    for name in ("truck_psva.yaml", "truck13_full_load.csv"):
        (tmp_path / name).write_bytes((ROOT / "examples" / name).read_bytes())
    chosen = page.locator('input[type=file][aria-label^="Model file"]')
    chosen.set_input_files([tmp_path / "truck_psva.yaml"])
    expect(page.get_by_text(re.compile("names truck13_full_load.csv"))).to_be_visible()
    page.locator('input[type=file][aria-label^="Files that"]').set_input_files([tmp_path / "truck13_full_load.csv"])
    expect(page.get_by_role("heading", level=1)).to_contain_text("power split")
    view(page, "Modes")
    expect(first_frequency(page, "PSVA mode")).to_have_text(told_frequency("PSVA mode", file="truck_psva"))


def test_names_are_never_run(page: Page, tmp_path: Path) -> None:
    said: list[str] = []
    page.on("dialog", lambda dialog: (said.append(dialog.message), dialog.dismiss()))
    hostile = "<img src=x onerror=alert(1)><script>alert(2)</script>"
    block(page, "Model")
    field(page, "name").fill(hostile)
    expect(page.get_by_role("heading", level=1)).to_contain_text(hostile)
    for name in ("Modes", "Response", "Map"):
        view(page, name)
        expect(page.locator("figure").first).to_be_visible()
    assert page.locator("h1 img, h1 script").count() == 0 and not said


def test_a_lost_connection_loses_nothing(opened: Opened, server: Served, built: None) -> None:
    own = Served("examples/truck_dmf.yaml", "--processes=1")
    try:
        page = opened(own.address)
        view(page, "Modes")
        expect(first_frequency(page, "DMF mode")).to_have_text(told_frequency("DMF mode"))
        own.stop()
        field(page, "absorber.stiffness").fill("11 kNm/rad")
        expect(page.get_by_text("No connection to the server")).to_be_visible()
        expect(first_frequency(page, "DMF mode")).to_have_text(told_frequency("DMF mode"))
        own.start()
        wanted = told_frequency("DMF mode", "absorber.stiffness=11kNm/rad")
        expect(first_frequency(page, "DMF mode")).to_have_text(wanted)
        expect(page.get_by_text("No connection to the server")).to_be_hidden()
    finally:
        own.stop()


@pytest.mark.parametrize("kind", ["PNG", "SVG", "CSV"])
def test_pictures_are_handed_over(page: Page, kind: str, tmp_path: Path) -> None:
    view(page, "Response")
    picture = page.locator("figure").first
    picture.get_by_text("Export").click()
    with page.expect_download() as told:
        picture.get_by_role("button", name=kind, exact=True).click()
    content = Path(told.value.path()).read_bytes()
    assert told.value.suggested_filename.endswith(f".{kind.lower()}")
    begins = {"PNG": b"\x89PNG", "SVG": b"<?xml", "CSV": "\ufeff".encode()}[kind]
    assert content.startswith(begins) and len(content) > 2000


def test_a_part_of_the_chain_is_chosen_by_keys(page: Page) -> None:
    part = page.get_by_label(re.compile("^axle,"))
    part.focus()
    page.keyboard.press("Enter")
    expect(page.locator('[data-path="driveline.axle_inertia"]')).to_be_visible()
    view(page, "Modes")
    page.get_by_role("tab", name="Modes").focus()
    page.keyboard.press("ArrowRight")
    following = page.get_by_role("tab").nth(1)
    expect(following).to_be_focused()
    expect(following).to_have_attribute("aria-selected", "true")


@pytest.mark.parametrize("width", [420, 1920])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_every_view_fits_its_window(opened: Opened, server: Served, width: int, scheme: str) -> None:
    page = opened(server.address, width, 900, color_scheme=scheme)
    tabs = page.get_by_role("tab")
    expect(tabs.first).to_be_visible()
    for place in range(tabs.count()):
        tabs.nth(place).click()
        expect(page.get_by_role("tabpanel")).to_be_visible()
        page.wait_for_load_state("networkidle")
        assert page.evaluate("document.documentElement.scrollWidth") <= width, tabs.nth(place).inner_text()
        nameless = page.locator("button:visible, input:visible, select:visible").evaluate_all(
            "all => all.filter(e => !(e.labels?.length || e.ariaLabel || e.textContent.trim())).map(e => e.outerHTML)"
        )
        assert not nameless


def test_the_report_is_handed_over(page: Page) -> None:
    with page.expect_download(timeout=120_000) as told:
        page.get_by_role("button", name="Report").click()
    content = Path(told.value.path()).read_text(encoding="utf-8")
    assert content.startswith("<!doctype html>") and "13-litre truck with a dual mass flywheel" in content
