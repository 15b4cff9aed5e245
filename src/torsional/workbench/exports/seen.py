"""What a view showed of one design."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from torsional.errors import ModelError
from torsional.model import Model
from torsional.workbench.views import Answer


@dataclass(frozen=True, eq=False)
class Seen:
    """The ``name`` of a design on the page ("" where it stands alone), its ``model``, and the ``answer`` of a view."""

    name: str
    model: Model
    answer: Answer


def alone(seen: Sequence[Seen], view: str) -> Seen:
    """The one design that a view shows; ModelError where several are asked for."""
    if len(seen) != 1:
        raise ModelError("this view shows one design at a time", where="variants", found=f"{len(seen)} for '{view}'")
    return seen[0]
