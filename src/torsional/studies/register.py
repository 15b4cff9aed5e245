"""The register of studies: whatever a module of `torsional.studies.claims` or `torsional.studies.tools` declares.

Adding a study is adding a module there.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from typing import TypeVar

from torsional.studies.base import Study, Tool

Kind = TypeVar("Kind", Study, Tool)


@cache
def claims() -> dict[str, Study]:
    """The studies of the thesis's claims by id, in their order.

    >>> list(claims())[:3]
    ['A1', 'A2', 'A3']
    """
    found = {each.name: each for each in _declared("claims", Study)}
    return dict(sorted(found.items(), key=lambda item: (item[0][0], int(item[0][1:]))))


@cache
def tools() -> dict[str, Tool]:
    """The studies that engineers run by name, in the order of their names."""
    found = {each.name: each for each in _declared("tools", Tool)}
    return dict(sorted(found.items()))


def _declared(room: str, kind: type[Kind]) -> Iterator[Kind]:
    package = import_module(f"torsional.studies.{room}")
    for module in iter_modules(package.__path__, f"{package.__name__}."):
        yield from (each for each in vars(import_module(module.name)).values() if isinstance(each, kind))
