"""The browser that tests look at pages with: Debian's Chromium, or another of its family."""

from __future__ import annotations

import os
import shutil

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")


def browser_or_skip(what: str) -> str:
    """The path of the browser; without one a test is skipped and says so, but in CI it fails."""
    found = next((path for name in NAMES if (path := shutil.which(name))), None)
    if found is None:
        missing(f"no Chromium is installed, so {what} is not looked at in a browser")
    assert found
    return found


def missing(message: str) -> None:
    """Skip with a plain reason; fail in CI, where everything has to be there."""
    if os.environ.get("CI"):
        pytest.fail(message)
    pytest.skip(message)
