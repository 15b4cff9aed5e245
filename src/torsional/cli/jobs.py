"""Jobs: what a command was asked for, to be done after parsing, so that failures pass through no hands but ours."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from importlib import import_module
from typing import Any

Job = Callable[[], None]
RESULTS = (".nc", ".csv", ".json", ".png", ".svg")


def job(module: str, **asked: Any) -> Job:
    """What a module of this package shall do."""
    return partial(_do, module, asked)


def _do(module: str, asked: dict[str, Any]) -> None:
    import_module(f"torsional.cli.{module}").run(**asked)


def analysis(module: str, asked: dict[str, Any], suffixes: tuple[str, ...] = RESULTS) -> Job:
    """A job on a model file."""
    return partial(_analyse, module, asked, suffixes)


def _analyse(module: str, asked: dict[str, Any], suffixes: tuple[str, ...]) -> None:
    """Read the model before the analyses are imported: a bad file or output name is answered at once."""
    from torsional.cli.request import requested
    from torsional.numerics.compiling import WATCH

    common = {key: asked.pop(key) for key in ("model", "changes", "output", "as_json", "quiet")}
    request = requested(suffixes=suffixes, **common)
    with WATCH.silent(request.quiet or request.as_json):
        import_module(f"torsional.cli.{module}").run(request, **asked)
