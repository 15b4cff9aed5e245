"""The views of the page: a question about a model each, answered by named values and arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import get_args

from pydantic import ValidationError

from torsional.errors import ModelError, nearest
from torsional.files.faults import translated
from torsional.files.reader import Tree
from torsional.units import quoted
from torsional.workbench.views.asking import Answer, Ask, AskInGear
from torsional.workbench.views.criteria import AskCriteria
from torsional.workbench.views.machine import AskAbsorbers, AskModel, AskParts
from torsional.workbench.views.modes import AskInterference, AskModes
from torsional.workbench.views.response import AskMap, AskResponse
from torsional.workbench.views.springs import AskCharacteristic

__all__ = ["ASKS", "Answer", "Ask", "AskInGear", "ask_of"]

_KINDS: tuple[type[Ask], ...] = (
    AskModel,
    AskParts,
    AskAbsorbers,
    AskModes,
    AskInterference,
    AskResponse,
    AskMap,
    AskCharacteristic,
    AskCriteria,
)
ASKS: dict[str, type[Ask]] = {get_args(kind.model_fields["view"].annotation)[0]: kind for kind in _KINDS}


def ask_of(data: object) -> Ask:
    """The question that a message holds; ModelError, its ``where`` beginning with ``ask``, for anything else."""
    view = data.get("view") if isinstance(data, Mapping) else None
    if not isinstance(view, str) or view not in ASKS:
        remedy = nearest(str(view)[:64], ASKS)
        raise ModelError("there is no such view", where="ask.view", found=quoted(view), remedy=remedy)
    try:
        return ASKS[view].model_validate(data)
    except ValidationError as error:
        raise translated(error, Tree({})).located(prefix="ask") from None
