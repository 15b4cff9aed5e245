"""How long from a key press to the redrawn picture, for each view of a running workbench.

Start one, then give its address:

    torsional workbench examples/truck_dmf.yaml --no-browser
    python tools/workbench_latency.py http://127.0.0.1:8210/

Each press turns the absorber's stiffness by 1 %; the clock runs in the page, from the key event to the end of the frame
that shows the answer.  Presses come one after the other, so none is answered by the picture of a later one.  It needs
playwright and a Chromium.
"""

from __future__ import annotations

import argparse
import shutil
import statistics
from typing import Any

from playwright.sync_api import Page, sync_playwright

VIEWS = ("modes", "interference", "response", "map", "characteristic")
PRESS = """
field => new Promise(done => {
  const answered = () => performance.getEntriesByType('resource').some(entry => entry.name.includes('api/answer'));
  const painted = () => {
    const {port1, port2} = new MessageChannel();
    port1.onmessage = () => done(performance.now() - begin);
    port2.postMessage(null);
  };
  const drawn = new PerformanceObserver(() => {
    if (!answered()) return;
    drawn.disconnect();
    requestAnimationFrame(painted);
  });
  performance.clearMarks();
  performance.clearResourceTimings();
  drawn.observe({type: 'mark'});
  const begin = performance.now();
  field.dispatchEvent(new KeyboardEvent('keydown', {key: 'KEY', bubbles: true, cancelable: true}));
})
"""
"""From the key event to the end of the frame in which its answer was painted: what is posted in a frame's callback
arrives after the frame."""


def measured(page: Page, view: str, presses: int) -> list[float]:
    """Milliseconds of each press while a view is on screen."""
    page.click(f"#tab-{view}")
    page.wait_for_selector(".picture")
    field = page.locator('[data-path="absorber.stiffness"] input[type="text"]')
    field.focus()
    once = [PRESS.replace("KEY", key) for key in ("ArrowUp", "ArrowDown")]
    times = [float(field.evaluate(once[i // 10 % 2])) for i in range(presses + 10)]
    return times[10:]


def first_load(page: Page, address: str) -> tuple[float, int]:
    """Seconds until the first picture, and bytes that came over the wire until then, the design's figures included."""
    sizes: list[int] = []
    page.on("requestfinished", lambda request: sizes.append(request.sizes()["responseBodySize"]))
    page.goto(address)
    page.wait_for_selector(".picture", timeout=120_000)
    seconds = float(page.evaluate("performance.now()")) / 1e3
    page.wait_for_load_state("networkidle")
    return seconds, sum(sizes)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("address", nargs="?", default="http://127.0.0.1:8210/")
    parser.add_argument("--presses", type=int, default=100)
    parser.add_argument("--chromium", default=shutil.which("chromium"))
    given: Any = parser.parse_args()
    with sync_playwright() as player:
        browser = player.chromium.launch(executable_path=given.chromium, args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1440, "height": 900})
        seconds, size = first_load(page, given.address)
        print(f"first picture after {seconds:.2f} s, {size / 1e3:.0f} kB over the wire")
        for view in VIEWS:
            times = sorted(measured(page, view, given.presses))
            late = times[int(0.95 * len(times))]
            print(
                f"{view:15s} median {statistics.median(times):6.1f} ms   95 % {late:6.1f} ms   most {times[-1]:6.1f} ms"
            )
        browser.close()


if __name__ == "__main__":
    main()
