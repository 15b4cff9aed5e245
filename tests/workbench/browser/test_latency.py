"""The tool that times key presses: it times as many as it was asked for, each by the picture that answers it."""

from __future__ import annotations

from playwright.sync_api import Page
from tests.test_project import ROOT, loaded


def test_each_press_is_timed(page: Page) -> None:
    tool = loaded(ROOT / "tools" / "workbench_latency.py")
    page.wait_for_selector(".picture")
    field = page.locator('[data-path="absorber.stiffness"] input[type="text"]')
    times = tool.measured(page, "modes", 3)
    assert len(times) == 3 and all(0 < time < 30_000 for time in times)
    assert float(field.input_value().split()[0]) > 13.0  # ten steps up for a start, three down again
