"""Claims of the thesis, asked of every design of a sweep."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Literal

import xarray as xr
from pydantic import Field

from torsional.errors import ModelError, nearest
from torsional.model import Model
from torsional.results import labelled
from torsional.studies.base import VERDICTS
from torsional.studies.register import claims
from torsional.studies.sweeps.analyses import Asking
from torsional.studies.trucks import Trucks


class ClaimsRun(Asking):
    """Claims of the thesis."""

    gives: ClassVar[Mapping[str, str]] = {"verdict": "number"}
    analysis: Literal["claims"]
    ids: list[str] = Field(description="of claims, as A6 or B2", min_length=1)

    def refuse_unknown(self) -> None:
        """ModelError for an id that no claim has."""
        for id in self.ids:
            if id not in claims():
                raise ModelError("there is no such claim", where="run.ids", found=id, remedy=nearest(id, claims()))

    def __call__(self, model: Model) -> xr.Dataset:
        """The ``verdict`` of each, by its place in `VERDICTS`."""
        trucks = Trucks.of(model)
        told = [VERDICTS.index(claims()[id].tried(trucks).verdict) for id in self.ids]
        data = labelled({"verdict": (("claim",), told, "number")}, {"claim": (self.ids, "")}, analysis="claims")
        data.verdict.attrs["flag_meanings"] = "; ".join(VERDICTS)
        return data
