"""What is shipped beside the package: model files, scenarios, and the models themselves, each read once."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from torsional.files import load_model
from torsional.model import Model

ROOT = Path(__file__).parents[1]
EXAMPLES = ROOT / "examples"
MODEL_FILES = sorted(EXAMPLES.glob("*.yaml"))


@cache
def shipped(name: str) -> Model:
    """The model of ``examples/<name>.yaml``."""
    return load_model(EXAMPLES / f"{name}.yaml")
