"""Designs of the shipped models, as the page sends them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

EXAMPLES = Path("examples")


@pytest.fixture
def design() -> Callable[..., dict[str, Any]]:
    """A shipped model as a design with some changes."""

    def made(name: str = "truck_dmf", /, **changes: Any) -> dict[str, Any]:
        files = {path.name: path.read_text(encoding="utf-8") for path in EXAMPLES.glob("*.csv")}
        text = (EXAMPLES / f"{name}.yaml").read_text(encoding="utf-8")
        return {"text": text, "files": files, "changes": {path.replace("__", "."): v for path, v in changes.items()}}

    return made
