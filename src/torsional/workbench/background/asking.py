"""What the jobs share: settings checked key by key, progress, and what a job hands back."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import xarray as xr
from pydantic import Field

from torsional.errors import ModelError
from torsional.files.schema.fields import Block
from torsional.model import Model
from torsional.workbench.views.asking import Number

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Progress = Callable[[int, int, str], None]
"""Takes how much is done, of how much (0: not known), and what is going on."""
Name = Annotated[str, Field(max_length=64)]
Range = Annotated[list[Number], Field(min_length=2, max_length=2)]


@dataclass(frozen=True, eq=False)
class Found:
    """The ``content`` of a frame, a ``picture`` to draw of it, a ``table``."""

    content: Mapping[str, Any]
    picture: Callable[[], Figure]
    table: xr.Dataset


class Long(Block):
    """A question that takes long; the last gear where none is named."""

    gear: Name = ""

    def found(self, model: Model, progress: Progress) -> Found:
        """The answer; ModelError where the model cannot tell."""
        raise NotImplementedError


def span_of(asked: list[float] | None, usual: tuple[float, float], where: str) -> tuple[float, float]:
    """A range that was asked for, or the usual one; ModelError for one that does not rise."""
    low, high = asked or usual
    if not low < high:
        raise ModelError("a range rises", where=where, found=f"{low:g} to {high:g}")
    return float(low), float(high)
