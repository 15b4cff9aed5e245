"""The work on a stretch of designs: each built and asked by itself, each failure with a status and a reason."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.files.edit import changed
from torsional.model import Model
from torsional.numerics.compiling import WATCH
from torsional.studies.crew import marked
from torsional.studies.sweeps.designs import Designs, Values
from torsional.studies.sweeps.store import json_of

OK, REFUSED, FAILED, CRASHED = range(4)
STATUS = ("ok", "refused: the model or the analysis cannot be", "failed: an error that nobody expected",
          "crashed: ended the process that worked on it")  # fmt: skip
"""What became of a design, by its status."""
CRASHES = 3
"""How often a design may end a process before it is set aside."""
UNEVEN = "its answer has other names, sizes or kinds than the first one"
Answer: TypeAlias = xr.Dataset | Mapping[str, Any]
Run: TypeAlias = Callable[[Model], Answer]
Build: TypeAlias = Model | Callable[..., Model]


@dataclass(frozen=True)
class Work:
    """What is asked of the ``designs``: each is built and run.

    ``build``: a model whose key paths the designs change, or a function of the named values that makes one; ``run``: a
    function of a model that gives a Dataset, or numbers and arrays by name, of the same shape for every design.
    """

    build: Build
    designs: Designs
    run: Run

    def stretch(self, start: int, stop: int, aside: Collection[int] = ()) -> dict[str, np.ndarray]:
        """The chunk of designs ``start`` to ``stop`` − 1; designs ``aside`` are not tried.

        ``status`` (design,); ``told``: reasons by number and the shapes of answers, as text; ``kind`` (design,): which
        of the shapes an answer has, -1 for none; ``answer.K.NAME``: the answers of kind K, one after the other.
        """
        count = stop - start
        status, kind = np.zeros(count, np.int8), np.full(count, -1, np.int32)
        reasons: dict[int, str] = {}
        shapes: list[str] = []
        answers: list[list[xr.Dataset]] = []
        with WATCH.silent():
            for place, values in enumerate(self.designs.rows(start, stop)):
                status[place], reason, answer = self._tried(start + place, values, aside)
                reasons |= {start + place: reason} if reason else {}
                if answer is not None:
                    kind[place] = _place_of(json_of(shape_of(answer)), shapes, answers)
                    answers[kind[place]].append(answer)
        text = json_of({"shapes": shapes, "reasons": reasons}).encode()
        stacked = {
            f"answer.{number}.{name}": np.stack([answer[name].values for answer in alike])
            for number, alike in enumerate(answers)
            for name in alike[0].data_vars
        }
        return {"status": status, "kind": kind, "told": np.frombuffer(text, np.uint8), **stacked}

    def _tried(self, number: int, values: Values, aside: Collection[int]) -> tuple[int, str, xr.Dataset | None]:
        if number in aside:
            return CRASHED, f"ended {CRASHES} processes", None
        marked(number)
        try:
            model = changed(self.build, dict(values)) if isinstance(self.build, Model) else self.build(**values)
            return OK, "", _figures(self.run(model))
        except ModelError as error:
            return REFUSED, str(error), None
        except Exception as error:  # one design's defect must not cost the answers of a million others
            return FAILED, f"{type(error).__name__}: {error}", None


def _figures(answer: Answer) -> xr.Dataset:
    """The numbers of an answer; what labels its dimensions with other numbers may differ from design to design."""
    data = (answer if isinstance(answer, xr.Dataset) else xr.Dataset(dict(answer))).reset_coords()
    return data[[name for name, values in data.data_vars.items() if values.dtype.kind in "fciub"]]


def shape_of(answer: xr.Dataset) -> dict[str, Any]:
    """What all answers of a sweep share: dimensions, sizes, kinds and attributes of the variables, and coordinates."""
    variables = {
        str(name): [list(map(str, v.dims)), list(v.shape), v.dtype.str, _plain(v.attrs)]
        for name, v in answer.data_vars.items()
    }
    coordinates = {
        str(name): [list(map(str, c.dims)), c.values.tolist(), _plain(c.attrs)] for name, c in answer.coords.items()
    }
    return {"variables": variables, "coordinates": coordinates}


def _plain(attrs: Mapping[Any, Any]) -> dict[str, Any]:
    return {str(k): v.item() if isinstance(v, np.generic) else v for k, v in attrs.items()}


def _place_of(shape: str, shapes: list[str], answers: list[list[xr.Dataset]]) -> int:
    """Which of the shapes that were met this is; a new one is added."""
    if shape not in shapes:
        shapes.append(shape)
        answers.append([])
    return shapes.index(shape)
