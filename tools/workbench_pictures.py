"""Pictures of every view of a running workbench: wide and narrow, light and dark, after some work in it.

    torsional workbench examples/truck_dmf_two_stage.yaml --results best.nc --no-browser
    python tools/workbench_pictures.py http://127.0.0.1:8210/ pictures/

With --docs the folder gets the few that the documentation shows.  It needs playwright and a Chromium.
"""

from __future__ import annotations

import argparse
import re
import shutil
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, Page, expect, sync_playwright

SIZES = {"wide": (1440, 900), "narrow": (420, 900)}
DOCS = {"response": "light", "map": "light", "branches": "light", "comparison": "dark"}
"""Views in the documentation, and how they look there."""
PATIENCE = 120_000


def worked(page: Page) -> None:
    """A variant kept, the springs turned: what pictures are for."""
    page.set_default_timeout(PATIENCE)
    page.wait_for_selector(".picture")
    page.click("#tab-comparison")
    page.get_by_role("button", name="Keep as variant").click()
    field = page.locator('[data-path="absorber.stages.0.stiffness"] input[type=text]')
    field.fill("7 kNm/rad")
    page.locator('[data-path="absorber.secondary_inertia"] input[type=text]').fill("1.4 kgm²")
    page.wait_for_load_state("networkidle")


def shown(page: Page, view: str) -> None:
    """Bring a view on screen, what it works out in the background with it."""
    page.click(f"#tab-{view}")
    page.wait_for_timeout(400)
    if view == "branches":  # there the stages of the shipped flywheel are swung across
        page.get_by_label("Mean torque of the branches").fill("1200")
    for run in page.get_by_role("button", name=re.compile("^Run ")).all():
        if run.is_enabled():
            run.click()
    page.wait_for_load_state("networkidle")
    expect(page.locator("main progress")).to_have_count(0, timeout=PATIENCE)
    page.wait_for_timeout(1500)


def opened(browser: Browser, address: str, size: str, scheme: str) -> Page:
    """The page in a window of its own."""
    width, height = SIZES[size]
    context = browser.new_context(
        viewport={"width": width, "height": height},
        color_scheme="dark" if scheme == "dark" else "light",
        reduced_motion="reduce",
    )
    page = context.new_page()
    page.goto(address)
    worked(page)
    return page


def views_of(page: Page) -> list[str]:
    """The names of all views."""
    return [tab.get_attribute("id").removeprefix("tab-") for tab in page.get_by_role("tab").all()]  # type: ignore[union-attr]


def main() -> None:
    """Take them."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("address")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--docs", action="store_true")
    parser.add_argument("--chromium", default=shutil.which("chromium"))
    given: Any = parser.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    with sync_playwright() as player:
        browser = player.chromium.launch(executable_path=given.chromium, args=["--no-sandbox"])
        for scheme in ("light", "dark"):
            for size in ("wide",) if given.docs else SIZES:
                page = opened(browser, given.address, size, scheme)
                for view in views_of(page):
                    if given.docs and DOCS.get(view) != scheme:
                        continue
                    shown(page, view)
                    name = f"workbench-{view}.png" if given.docs else f"{view}-{size}-{scheme}.png"
                    page.screenshot(path=given.folder / name, full_page=size == "narrow")
                page.context.close()
        browser.close()


if __name__ == "__main__":
    main()
