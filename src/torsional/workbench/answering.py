"""One message of the page worked out: a design and what is asked of it, into a frame."""

from __future__ import annotations

from typing import Any

from torsional.errors import ModelError
from torsional.model import Model
from torsional.units import quoted
from torsional.workbench.designs import design_of, model_of
from torsional.workbench.frames import encoded
from torsional.workbench.refusals import faults
from torsional.workbench.views import Answer, ask_of

ASKED = 8


def answer(design: object, asks: object) -> bytes:
    """The frame of all answers; an ask that is wrong alone has its faults in the place of its answer.

    ModelError where the design itself is wrong.
    """
    if not isinstance(asks, list) or not 0 < len(asks) <= ASKED:
        found = str(len(asks)) if isinstance(asks, list) else quoted(asks)
        raise ModelError("a list of questions is wanted", where="ask", found=found, allowed=f"1 to {ASKED}")
    model = model_of(design_of(design))
    return encoded({"answers": [_one(model, ask) for ask in asks]})


def _one(model: Model, ask: Any) -> Answer:
    try:
        return ask_of(ask).answer(model)
    except ModelError as error:
        return {"errors": faults(error)}
