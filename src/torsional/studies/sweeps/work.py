"""The work on a stretch of designs: each built and asked by itself, each failure with a status and a reason."""

from __future__ import annotations

import json
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

OK, REFUSED, FAILED, CRASHED = range(4)
STATUS = ("ok", "refused: the model or the analysis cannot be", "failed: an error that nobody expected",
          "crashed: ended the process that worked on it")  # fmt: skip
"""What became of a design, by its status."""
CRASHES = 3
"""How often a design may end a process before it is set aside."""
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
        """The chunk of designs ``start`` to ``stop`` − 1: answers (design, …), status, and reasons by number, as text;
        designs ``aside`` are not tried.

        What is not answered is not a number, or zero where answers are whole numbers.
        """
        answers: list[xr.Dataset | None] = []
        status = np.zeros(stop - start, np.int8)
        reasons: dict[int, str] = {}
        shape: dict[str, Any] | None = None
        with WATCH.silent():
            for number, values in enumerate(self.designs.rows(start, stop), start):
                told, reason, answer = (
                    (CRASHED, f"ended {CRASHES} processes", None) if number in aside else self._tried(number, values)
                )
                if answer is not None:
                    shape = shape or shape_of(answer)
                    if shape_of(answer) != shape:
                        told, answer = FAILED, None
                        reason = "its answer has other names, sizes or kinds than those before it"
                status[number - start] = told
                answers.append(answer)
                reasons |= {number: reason} if reason else {}
        told_of = {"shape": shape, "reasons": reasons}
        text = json.dumps(told_of, sort_keys=True, ensure_ascii=False).encode()
        return {"status": status, "told": np.frombuffer(text, np.uint8), **_stacked(answers, shape)}

    def _tried(self, number: int, values: Values) -> tuple[int, str, xr.Dataset | None]:
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


def _stacked(answers: list[xr.Dataset | None], shape: Mapping[str, Any] | None) -> dict[str, np.ndarray]:
    found = {}
    for name, (_, size, kind, _) in (shape or {"variables": {}})["variables"].items():
        dtype = np.dtype(kind)
        empty = np.nan if dtype.kind in "fc" else np.zeros((), dtype)[()]
        stack = np.full((len(answers), *size), empty, dtype)
        for place, answer in enumerate(answers):
            if answer is not None:
                stack[place] = answer[name].values
        found[f"answer.{name}"] = stack
    return found
