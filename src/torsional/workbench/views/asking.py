"""What every ask of the page has: settings checked key by key, and an answer of plain values and arrays."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any, ClassVar

from pydantic import AfterValidator, Field

from torsional.errors import ModelError, nearest
from torsional.files.schema.fields import Block
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.system import System

Answer = dict[str, Any]
LARGEST = 1e9


def _finite(value: float) -> float:
    if not abs(value) <= LARGEST:  # NaN as well
        raise ModelError("a finite number is wanted", found=f"{value:g}", allowed=f"-{LARGEST:g} to {LARGEST:g}")
    return value


Number = Annotated[float, AfterValidator(_finite)]
Orders = Annotated[list[Annotated[float, Field(gt=0, le=48)]], Field(min_length=1, max_length=48)]
Names = Annotated[list[Annotated[str, Field(max_length=64)]], Field(max_length=64)]


class Ask(Block):
    """A question about a model; ``view`` tells which."""

    view: str
    names: ClassVar[str] = ""

    def answer(self, model: Model) -> Answer:
        """Named values and arrays in SI; ModelError where the model cannot tell."""
        raise NotImplementedError


class AskInGear(Ask):
    """A question about one gear; the last one where none is named."""

    gear: Annotated[str, Field(max_length=64)] = ""

    def engaged(self, model: Model) -> str:
        """The gear's name."""
        return model.gear_name(self.gear)


def main_order(model: Model) -> float | None:
    """The engine's strongest order; None without an engine."""
    return next(iter(model.engine_orders()), None)


def refuse_unknown(asked: Iterable[str], known: Iterable[str], kind: str) -> None:
    """ModelError for a name that is none of those known."""
    listed = list(known)
    for name in asked:
        if name not in listed:
            raise ModelError(f"there is no {kind} '{name}'", where=kind, remedy=nearest(name, listed))


def observed(
    model: Model, system: System, nodes: list[str] | None, elements: list[str] | None
) -> tuple[list[str], list[str]]:
    """The nodes and connections asked for, or the model's landmarks."""
    refuse_unknown(nodes or (), system.nodes, "node")
    refuse_unknown(elements or (), system.connections.names, "connection")
    if nodes is None and elements is None:
        return list(model.landmarks.observed_nodes), list(model.landmarks.observed_elements)
    return nodes or [], elements or []


def reached(model: Model, speeds: Array) -> Array:
    """Those of some speeds [rad/s] that the full-load curve reaches; all where there is none."""
    curve = model.full_load_curve
    return speeds if curve is None else speeds[curve.reaches(speeds)]
