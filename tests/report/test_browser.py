"""The page in a browser: every picture is drawn, nothing runs over the edge, nothing is run or fetched."""

from __future__ import annotations

import html
import json
import re
import subprocess
from pathlib import Path

import pytest
from tests.browsers import browser_or_skip

QUIET = [
    *("--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking"),
    *("--disable-component-update", "--disable-sync", "--disable-dev-shm-usage", "--hide-scrollbars"),
]
MEASURE = """
<pre id="measured"></pre><script>
const frame = document.querySelector("iframe");
frame.onload = () => {
  const page = frame.contentDocument, images = [...page.images];
  document.getElementById("measured").textContent = JSON.stringify({
    wide: page.documentElement.scrollWidth, images: images.length,
    drawn: images.filter(i => i.complete && i.naturalWidth > 100).length,
    loose: [...page.querySelectorAll("main p, main li, main h2, main figure, main table")].filter(
      e => e.getBoundingClientRect().right > WIDTH + 1 && !e.closest(".scroll")).length,
    styled: getComputedStyle(page.querySelector("section")).display, title: page.title,
    fetched: frame.contentWindow.performance.getEntriesByType("resource").filter(
      e => !e.name.startsWith("data:")).length,
  });
};
frame.srcdoc = PAGE;
</script>
"""


@pytest.fixture(scope="module")
def browser() -> str:
    return browser_or_skip("the report")


def measured(browser: str, page: str, width: int, folder: Path) -> dict[str, object]:
    """The page laid out in a frame of some width, and what a script outside it sees there."""
    told = json.dumps(page).replace("</", "<\\/")
    body = MEASURE.replace("WIDTH", str(width)).replace("PAGE", told)
    source = folder / f"measure-{width}.html"
    frame = f'<iframe width="{width}" height="900" style="border:0"></iframe>'
    source.write_text(f"<!doctype html><meta charset=utf-8><body style='margin:0'>{frame}{body}", encoding="utf-8")
    profile = f"--user-data-dir={folder / f'profile-{width}'}"
    command = [browser, *QUIET, profile, "--virtual-time-budget=10000", "--dump-dom", source.as_uri()]
    answer = subprocess.run(command, capture_output=True, text=True, timeout=180, check=True).stdout
    found = re.search(r'<pre id="measured">(.+?)</pre>', answer, re.DOTALL)
    assert found, "the browser did not lay the page out"
    return dict(json.loads(html.unescape(found[1])))


@pytest.mark.parametrize("width", [1400, 400])
def test_the_page_fits_and_every_picture_is_drawn(browser: str, page: str, width: int, tmp_path: Path) -> None:
    seen = measured(browser, page, width, tmp_path)
    assert seen["wide"] == width
    assert seen["loose"] == 0
    assert seen["drawn"] == seen["images"] == page.count("<img ")
    assert seen["styled"] == "grid"
    assert seen["fetched"] == 0


def test_hostile_names_run_nothing(browser: str, hostile_page: str, tmp_path: Path) -> None:
    """An alert would hold the page up, and the picture that asks for "x" would not be drawn."""
    seen = measured(browser, hostile_page, 600, tmp_path)
    assert str(seen["title"]).startswith("<script>alert(1)</script>")
    assert seen["drawn"] == seen["images"] == hostile_page.count("<img ")
    assert seen["wide"] == 600
