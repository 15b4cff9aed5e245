"""The workbench as its users have it: the command in a process of its own, its page in Chromium."""

from __future__ import annotations

import contextlib
import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, sync_playwright
from tests.browsers import browser_or_skip, missing
from tests.shipped import ROOT
from tests.signals import listening

import torsional

WAIT = 30_000
"""[ms] within which the page must have done what is waited for: no bar, only the end of patience."""


class Served:
    """A server, which can be stopped and started again at the same port."""

    def __init__(self, *arguments: str) -> None:
        self.arguments, self.port, self.told = arguments, 0, ""
        self.start()

    def start(self) -> None:
        """Start it and wait for its address."""
        port = f"--port={self.port}"
        line = [sys.executable, "-c", "import sys; from torsional.cli import main; sys.exit(main())", "workbench"]
        own = {**os.environ, "PYTHONPATH": str(Path(torsional.__file__).parents[1])}
        command = [*line, *self.arguments, "--no-browser", port]
        self.process = subprocess.Popen(
            command, stdout=subprocess.PIPE, env=own, text=True, cwd=ROOT, preexec_fn=listening
        )
        assert self.process.stdout
        for text in self.process.stdout:
            found = re.search(r"http://127\.0\.0\.1:(\d+)/\S*", text)
            if found:
                self.address, self.port = found[0], int(found[1])
                return
        pytest.fail(f"the server said no address and ended with {self.process.wait()}")

    def stop(self) -> None:
        """End it, as a machine that goes to sleep would."""
        self.process.kill()
        self.process.wait()
        with contextlib.suppress(OSError, ValueError):
            self.process.stdout.close()  # type: ignore[union-attr]


@pytest.fixture(scope="session")
def built() -> None:
    """The page is there."""
    if not (Path(torsional.__file__).parent / "workbench" / "page" / "index.html").exists():
        missing("the workbench's page was not built, which `make page` does: it is not looked at in a browser")


@pytest.fixture(scope="session")
def server(built: None) -> Iterator[Served]:
    """A server that all tests of this process share: it keeps nothing of theirs."""
    served = Served("examples/truck_dmf.yaml", "--processes=1")
    yield served
    served.stop()


@pytest.fixture(scope="session")
def chromium(built: None) -> Iterator[Browser]:
    """The browser."""
    path = browser_or_skip("the workbench")
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=path, args=["--no-sandbox", "--disable-dev-shm-usage"])
        yield browser
        browser.close()


@pytest.fixture
def opened(chromium: Browser) -> Iterator[Callable[..., Page]]:
    """Opens an address in a window of its own; what the page complains of in its console fails the test."""
    contexts, said = [], []

    def open_page(address: str, width: int = 1440, height: int = 900, **settings: object) -> Page:
        context = chromium.new_context(
            viewport={"width": width, "height": height},
            accept_downloads=True,
            **settings,  # type: ignore[arg-type]
        )
        contexts.append(context)
        page = context.new_page()
        page.set_default_timeout(WAIT)
        page.on("console", lambda message: said.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: said.append(str(error)))
        page.goto(address)
        return page

    yield open_page
    for context in contexts:
        context.close()
    expected = ("ERR_CONNECTION_REFUSED", "422", "409", "429")  # the browser's own words for what tests bring about
    assert not [text for text in said if not any(word in text for word in expected)]


@pytest.fixture
def page(opened: Callable[..., Page], server: Served) -> Page:
    """The page, open at the shipped truck."""
    return opened(server.address)
