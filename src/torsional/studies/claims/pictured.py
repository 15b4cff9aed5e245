"""What the claims about sub-harmonic vibration draw: branches point by point, peaks over the stiffness difference."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import labelled
from torsional.solvers.periodic.branches import Branch
from torsional.studies.answers import main_order
from torsional.studies.motions import amplitudes, stable
from torsional.studies.stiffness_step import Sweep, table

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture


@dataclass(frozen=True, eq=False)
class Line:
    """A branch and what it is called."""

    branch: Branch
    words: str


def branch_points(
    id: str, model: Model, lines: Sequence[Line], along: tuple[str, str], quantity: int, kind: str, **told: object
) -> xr.Dataset:
    """Half the firing order and the firing order along branches, point by point, with stability.

    ``along``: the parameter's name and quantity; ``quantity``: its place in `amplitudes`, of a ``kind``.
    """
    order = main_order(model)
    parts: dict[str, list[Array]] = {name: [] for name in ("at", "half", "main", "stable", "line")}
    for number, line in enumerate(lines):
        branch, size = line.branch, line.branch.values.size
        parts["at"].append(branch.values)
        for name, n in (("half", order / 2), ("main", order)):
            whole = n / branch.base_order
            known = abs(whole - round(whole)) < 1e-9
            parts[name].append(amplitudes(model, branch, n)[quantity] if known else np.zeros(size))
        parts["stable"].append(stable(branch.problem, branch.scaled).astype(float))
        parts["line"].append(np.full(size, float(number)))
    of = {name: np.concatenate(values) for name, values in parts.items()}
    name, unit = along
    return labelled(
        {
            name: (("point",), of["at"], unit),
            "half_order": (("point",), of["half"], kind),
            "main_order": (("point",), of["main"], kind),
            "stable": (("point",), of["stable"], "number"),
            "line": (("point",), of["line"], "number"),
        },
        {"point": (np.arange(of["at"].size), "")},
        analysis=f"claim {id}",
        along=name,
        orders=[order / 2, order],
        words=[line.words for line in lines],
        **told,
    )


def draw_motions(data: xr.Dataset) -> Picture:
    """Branches with their stability."""
    from torsional.plots import plot_doubling

    return plot_doubling(data)


SWEPT = {"k2": "k2 varied", "k1": "k1 varied", "light": "k2 varied, {damping:.4g} Nms/rad (reported)"}
"""What each sweep varies."""


def peaks(
    id: str,
    found: Mapping[str, Sweep],
    kinds: Mapping[str, tuple[int, str]],
    which: int,
    judged: Sequence[str],
    **told: object,
) -> xr.Dataset:
    """Amplitudes (``which`` 1) or mean torques (2) of `table` over the stiffness difference, case by case.

    ``kinds``: {name: (place in the table, quantity)}; ``judged``: the names that the verdict turns on.
    """
    tables = {name: table(sweep.cases) for name, sweep in found.items()}
    words = {name: SWEPT[name].format(damping=sweep.damping) for name, sweep in found.items()}
    sweeps = np.concatenate([np.full(t[0].size, words[name]) for name, t in tables.items()])
    differences = np.concatenate([t[0] for t in tables.values()])
    values = {
        name.lower().replace(" ", "_"): (("case",), np.concatenate([t[which][:, q] for t in tables.values()]), kind)
        for name, (q, kind) in kinds.items()
    }
    values |= {"difference": (("case",), differences, "stiffness"), "sweep": (("case",), sweeps, "")}
    data = labelled(values, {"case": (np.arange(differences.size), "")}, analysis=f"claim {id}", **told)
    for name in kinds:
        key = name.lower().replace(" ", "_")
        data[key].attrs |= {"words": name, "judged": int(name in judged)}
    return data


def draw_peaks(data: xr.Dataset) -> Picture:
    """Points, straight lines through them, R²."""
    from torsional.plots import plot_regression

    return plot_regression(data)
