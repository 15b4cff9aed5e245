"""Bands of uncertainty: where the figures of a sweep lie for most of its designs, place by place."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.results import labelled
from torsional.studies.sweeps.sensitivity import ASIDE
from torsional.studies.sweeps.work import OK, Answer

PERCENTILES = (5.0, 25.0, 50.0, 75.0, 95.0)
LEAST = 20
"""Answered designs below which percentiles of one in twenty say nothing."""
NOMINAL = "_nominal"
CURVE = 6
"""Numbers that a dimension has at least for a curve over it."""


def bands(found: xr.Dataset, nominal: Answer | None = None, percentiles: Sequence[float] = PERCENTILES) -> xr.Dataset:
    """Percentiles (percentile, ...) of every figure of a sweep along its designs, complex ones by their size.

    Every design that has an answer counts alike, whatever the sweep chose them by; where a figure has no number, its
    place does not count.  ``nominal``: the answer of the unchanged model to the same question, kept beside each figure
    by its name with ``_nominal``.  Raises ModelError for fewer than 20 answered designs, and percentiles that are none.

    >>> from torsional.files.load import load_model
    >>> from torsional.studies.sweeps import sampled, sweep
    >>> truck = load_model("examples/truck_dmf.yaml")
    >>> designs = sampled("latin_hypercube", {"absorber.primary_inertia": (1.0, 2.0)}, 100)
    >>> found = bands(sweep(truck, designs, lambda model: {"inertia": model.components["primary"].inertia}))
    >>> found.inertia.values.round(2).tolist()
    [1.05, 1.25, 1.5, 1.75, 1.95]
    """
    if not percentiles or not all(0 <= each <= 100 for each in percentiles):
        raise ModelError("a percentile is from 0 to 100", found=str(tuple(percentiles)))
    along = [str(dim) for dim in found.status.dims]
    fine = found.status.values.ravel() == OK
    if fine.sum() < LEAST:
        raise ModelError("too few designs have an answer", found=str(fine.sum()), allowed=f">= {LEAST}")
    variables: dict[str, Any] = {}
    for name, values in found.data_vars.items():
        if name not in ASIDE:
            dims = [str(dim) for dim in values.dims if dim not in along]
            flat = values.transpose(*along, *dims).values.reshape(fine.size, *(values.sizes[dim] for dim in dims))
            told = _percentiles(flat[fine], percentiles)
            variables[str(name)] = (("percentile", *dims), told, str(values.attrs.get("quantity", "")))
    variables |= _nominal(nominal, variables)
    return _labelled(found, variables, percentiles, int(fine.sum()), fine.size)


def _percentiles(values: np.ndarray, percentiles: Sequence[float]) -> np.ndarray:
    real = abs(values) if np.iscomplexobj(values) else values.astype(float)
    with warnings.catch_warnings():  # places that no design has a number for stay without one
        warnings.filterwarnings("ignore", message="All-NaN slice encountered", category=RuntimeWarning)
        return np.asarray(np.nanpercentile(real, percentiles, axis=0))


def _nominal(nominal: Answer | None, variables: dict[str, Any]) -> dict[str, Any]:
    """The figures of the unchanged model that have the shape of those of the designs."""
    told = nominal if isinstance(nominal, xr.Dataset) else xr.Dataset(dict(nominal or {}))
    beside = {}
    for name, ((_, *dims), values, quantity) in variables.items():
        if name in told and set(told[name].dims) == set(dims):
            own = told[name].transpose(*dims).values
            if own.shape == values.shape[1:]:
                beside[f"{name}{NOMINAL}"] = (tuple(dims), abs(own) if np.iscomplexobj(own) else own, quantity)
    return beside


def _labelled(
    found: xr.Dataset, variables: dict[str, Any], percentiles: Sequence[float], answered: int, asked: int
) -> xr.Dataset:
    dims = {dim for held, _, _ in variables.values() for dim in held}
    labels: dict[str, Any] = {
        str(name): (values.values, str(values.attrs.get("quantity", "")), str(values.dims[0]))
        for name, values in found.coords.items()
        if values.ndim == 1 and values.dims[0] in dims
    }
    labels["percentile"] = (np.asarray(percentiles, dtype=float), "")
    data = labelled(variables, labels, analysis="bands", designs=asked, answered=answered)
    for name, values in data.data_vars.items():
        own = str(name).removesuffix(NOMINAL) if str(name).endswith(NOMINAL) else str(name)
        values.attrs["along"] = _along(values)
        values.attrs |= {"nominal_of": own} if own != name else {}
        values.attrs |= {key: told for key, told in found[own].attrs.items() if key == "amplitude"}
    data.percentile.attrs |= {"long_name": "percentile along the designs", "units": "%"}
    return data


def _along(values: xr.DataArray) -> str:
    """The dimension over which a figure is a curve: the one of most numbers; "" where none has enough."""
    sizes = {str(dim): values.sizes[dim] for dim in values.dims if dim != "percentile"}
    curved = [dim for dim in sizes if dim in values.coords and values[dim].dtype.kind == "f" and sizes[dim] >= CURVE]
    return max(curved, key=lambda dim: sizes[dim], default="")
