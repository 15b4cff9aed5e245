"""Designs of finished sweeps and optimisations, for a look at their Pareto fronts."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, IntArray
from torsional.results import load_results
from torsional.units import quoted
from torsional.workbench.fields import words

MOST = 20_000
"""Designs that are shown; of more, those of the front and an even choice of the rest."""
_OWN = ("status", "reason", "generation", "on_front", "within", "role", "design")
Answer = dict[str, Any]


def front_of(path: str | Path) -> Answer:
    """What a results file of `sweep` or `optimise` holds, design by design.

    ``parameters`` [{path, label, values}] and ``criteria`` [{name, label, quantity, better, objective, limits, values}]
    with one figure a design, ``limits`` [least, most] or None where there are none; ``on_front`` and ``within`` (1, 0),
    None where nothing tells them; ``role`` (texts).  ModelError for a file that holds no designs.
    """
    data = load_results(path)
    dims = _design_dims(data)
    if not dims:
        remedy = "write one with: torsional optimise plan.yaml -o best.nc, or torsional sweep plan.yaml -o designs.nc"
        raise ModelError(
            "the file holds no designs", file=str(path), found=quoted(data.attrs.get("analysis", "")), remedy=remedy
        )
    designs = data.stack(_designs=dims, create_index=False) if dims != ["design"] else data.rename(design="_designs")
    kept = _shown(designs)
    designs = designs.isel(_designs=kept)
    criteria = list(_criteria(designs))
    if not criteria:
        raise ModelError("no figure of the file is a single one a design", file=str(path))
    return {
        "name": Path(path).stem,
        "designs": len(kept),
        "all": int(np.prod([data.sizes[dim] for dim in dims])),
        "parameters": list(_parameters(data, designs, dims)),
        "criteria": criteria,
        "on_front": _flags(designs, "on_front"),
        "within": _flags(designs, "within"),
        "role": [str(role) for role in designs.role.values] if "role" in designs.coords else None,
    }


def _design_dims(data: xr.Dataset) -> list[str]:
    """The dimensions along which designs lie: `design`, or one a parameter of a grid."""
    if "design" in data.dims:
        return ["design"]
    return [str(dim) for dim in data.dims if "." in str(dim)]


def _shown(designs: xr.Dataset) -> IntArray:
    """Places of the designs to show."""
    count = designs.sizes["_designs"]
    if count <= MOST:
        return np.arange(count)
    best = np.flatnonzero(designs.on_front.values) if "on_front" in designs else np.empty(0, dtype=int)
    return np.unique([*best[:MOST], *np.linspace(0, count - 1, MOST).astype(int)])


def _parameters(data: xr.Dataset, designs: xr.Dataset, dims: list[str]) -> Iterator[Answer]:
    """The values that made each design, by key path."""
    for name in dims if dims != ["design"] else [str(name) for name in data.coords if "." in str(name)]:
        values = designs[name].values
        plain: Any = values.astype(float) if values.dtype.kind in "iuf" else [str(value) for value in values]
        yield {"path": name, "label": words(name.replace(".", ", ")), "values": plain}


def _criteria(designs: xr.Dataset) -> Iterator[Answer]:
    """Figures of which every design has one."""
    objectives = json.loads(designs.attrs.get("objectives", "[]"))
    maximised = json.loads(designs.attrs.get("maximised", "[]"))
    limits = json.loads(designs.attrs.get("limits", "{}"))
    for name, values in designs.data_vars.items():
        single = values.size == designs.sizes["_designs"]
        if str(name) in _OWN or not single or values.dtype.kind not in "iuf":
            continue
        yield {
            "name": str(name),
            "label": words(str(name)),
            "quantity": str(values.attrs.get("quantity", "number")),
            "better": "more" if name in maximised else "less",
            "objective": name in objectives,
            "limits": limits.get(name),
            "values": values.values.reshape(-1).astype(float),
        }


def _flags(designs: xr.Dataset, name: str) -> Array | None:
    return designs[name].values.astype(float) if name in designs else None
