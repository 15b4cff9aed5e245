"""Global sensitivities: which parameters move the figures of a sweep, each by itself and together with others."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from torsional.errors import ModelError, nearest
from torsional.numerics.arrays import Array
from torsional.results import labelled
from torsional.studies.sweeps.blocks import BLOCKS, LEAST, LEVELS, WORDS, block_size, drawn, problem_of, salib
from torsional.studies.sweeps.work import OK
from torsional.units import QUANTITIES

RESAMPLES = 200
"""Bootstrap samples behind a confidence interval."""
LEVEL = 0.95
FLAT = 1e-12
"""Spread over size up to which a figure is the same for all designs."""
ASIDE = ("status", "reason")
INDICES = {
    "saltelli": {
        "total": "ST",
        "total_confidence": "ST_conf",
        "first_order": "S1",
        "first_order_confidence": "S1_conf",
    },
    "morris": {
        "effect_size": "mu_star",
        "effect_size_confidence": "mu_star_conf",
        "effect": "mu",
        "effect_spread": "sigma",
    },
}
"""The indices of a method by SALib's names; the first is that by which parameters are sorted."""
MEANING = {
    "total": "share of the variance, with all interactions",
    "first_order": "share of the variance, by the parameter alone",
    "effect_size": "mean size of elementary effects, over the whole range (mu*)",
    "effect": "mean of elementary effects, over the whole range (mu)",
    "effect_spread": "standard deviation of elementary effects, over the whole range (sigma)",
}


@dataclass(frozen=True)
class Figure:
    """A number of every design: its ``values`` (design,), NaN where there is none."""

    name: str
    values: Array
    quantity: str
    reduction: str


def sensitivities(found: xr.Dataset, figures: Sequence[str] | None = None) -> xr.Dataset:
    """Indices of every figure (figure, parameter) from a sweep over designs by "morris" or "saltelli".

    By Saltelli's designs ``total`` and ``first_order``, Sobol's shares of the variance (Comput. Phys. Commun. 181
    (2010) 259), by Morris's ``effect_size`` (mu*), ``effect`` (mu) and ``effect_spread`` (sigma) in the figure's own
    unit, as if the parameter went through its whole range (Technometrics 33 (1991) 161); ``..._confidence`` is half of
    the 95 % interval by bootstrap.  Figures are numbers; of an array the largest absolute value is taken, which
    ``reduction`` says.  A block of designs of which one has no answer is left out: ``blocks`` (figure) tells how many
    were complete.  A figure that no parameter moves has no shares of a variance: NaN.

    Raises ModelError for a sweep over other designs, figures it does not have, too few complete blocks.

    >>> from torsional.files.load import load_model
    >>> from torsional.studies.sweeps import sampled, sweep
    >>> truck = load_model("examples/truck_dmf.yaml")
    >>> ends = {"absorber.primary_inertia": (1.0, 1.8), "absorber.secondary_inertia": (0.5, 1.0)}
    >>> found = sweep(truck, sampled("morris", ends, 4), lambda m: {"inertia": m.components["primary"].inertia})
    >>> sensitivities(found).effect_size.values.round(6).tolist()
    [[0.8, 0.0]]
    """
    told = _sampling(found)
    method, names = told["method"], told["parameters"]
    size = block_size(method, len(names))
    chosen = _chosen(found, figures)
    blocks: list[np.ndarray] = [np.all(np.isfinite(figure.values).reshape(-1, size), axis=1) for figure in chosen]
    _refuse_few(chosen, blocks, method, asked=figures is not None)
    shares = drawn(method, blocks[0].size, len(names), told["seed"]).reshape(-1, size, len(names))
    rows = [
        _indices(method, figure.values.reshape(-1, size)[whole], shares[whole], told["seed"])
        for figure, whole in zip(chosen, blocks, strict=True)
    ]
    return _dataset(method, names, chosen, blocks, rows)


def _sampling(found: xr.Dataset) -> dict[str, Any]:
    told = json.loads(found.attrs.get("sampling", "{}"))
    if told.get("method") not in BLOCKS:
        method = str(told.get("method", "no sweep"))
        allowed = ", ".join(BLOCKS)
        raise ModelError(
            "sensitivities need designs of their own", where="designs.method", found=method, allowed=allowed
        )
    return dict(told)


def _chosen(found: xr.Dataset, names: Sequence[str] | None) -> list[Figure]:
    held = [str(name) for name, v in found.data_vars.items() if name not in ASIDE and v.dtype.kind in "fciub"]
    if not held:
        raise ModelError("no design of the sweep has an answer", remedy="status and reason of each stand in the sweep")
    for name in names or ():
        if name not in held:
            raise ModelError("the sweep has no such figure", found=name, remedy=nearest(name, held))
    fine = found.status.values == OK
    return [_figure(found[name], fine) for name in names or held]


def _figure(values: xr.DataArray, fine: np.ndarray) -> Figure:
    """A figure as one number a design: the largest absolute value of an array, places without one left out."""
    dims = [str(dim) for dim in values.dims if dim != "design"]
    flat = values.transpose("design", *dims).values.reshape(values.sizes["design"], -1)
    if dims:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message="All-NaN slice encountered", category=RuntimeWarning)
            flat = np.nanmax(abs(flat), axis=1, keepdims=True)
    single = abs(flat[:, 0]) if np.iscomplexobj(flat) else flat[:, 0].astype(float)
    several = " and ".join(dim for dim in dims if values.sizes[dim] > 1)
    reduction = f"largest absolute value over {several}" if several else "absolute value" if dims else ""
    return Figure(str(values.name), np.where(fine, single, np.nan), str(values.attrs.get("quantity", "")), reduction)


def _refuse_few(figures: Sequence[Figure], blocks: Sequence[np.ndarray], method: str, asked: bool) -> None:
    """ModelError where a figure that was asked for, or every figure, has too few complete blocks."""
    few = [n for n, whole in enumerate(blocks) if whole.sum() < LEAST[method]]
    if few and (asked or len(few) == len(figures)):
        name, whole = figures[few[0]].name, blocks[few[0]]
        raise ModelError(
            f"too few {WORDS[method]} are complete",
            where=name,
            found=f"{whole.sum()} of {whole.size}",
            allowed=f">= {LEAST[method]}",
            remedy="see why designs fail, narrow the ranges, or ask for more",
        )


def _indices(method: str, values: Array, shares: Array, seed: int) -> dict[str, Array]:
    """The indices of one figure from its complete blocks: ``values`` (block, place), ``shares`` (block, place, D)."""
    parameters = shares.shape[2]
    none = dict.fromkeys(INDICES[method], np.full(parameters, np.nan))
    few = values.shape[0] < LEAST[method]
    if few or (method == "saltelli" and np.ptp(values) <= FLAT * abs(values).max()):
        return none
    common = {"num_resamples": RESAMPLES, "conf_level": LEVEL, "seed": seed + 1}  # 0 would be taken for none
    problem, told = problem_of(parameters), values.ravel()
    if method == "morris":
        x = np.ascontiguousarray(shares.reshape(-1, parameters))
        found = salib("analyze.morris").analyze(problem, x, told, num_levels=LEVELS, **common)
    else:
        with warnings.catch_warnings():  # resamples of a figure that seldom moves
            warnings.filterwarnings("ignore", message="Constant values encountered", category=UserWarning)
            found = salib("analyze.sobol").analyze(problem, told, calc_second_order=False, **common)
    return {name: np.asarray(found[key], dtype=float) for name, key in INDICES[method].items()}


def _dataset(
    method: str,
    names: Sequence[str],
    figures: Sequence[Figure],
    blocks: Sequence[np.ndarray],
    rows: Sequence[Mapping[str, Array]],
) -> xr.Dataset:
    indices, quantity = list(INDICES[method]), "ratio" if method == "saltelli" else ""
    variables = {each: (("figure", "parameter"), [row[each] for row in rows], quantity) for each in indices}
    complete = {"blocks": (("figure",), [int(whole.sum()) for whole in blocks], "number")}
    data = labelled(
        {**variables, **complete},
        {
            "figure": ([figure.name for figure in figures], ""),
            "parameter": (list(names), ""),
            "quantity": ([figure.quantity for figure in figures], "", "figure"),
            "unit": ([QUANTITIES[figure.quantity or "number"].unit for figure in figures], "", "figure"),
            "reduction": ([figure.reduction for figure in figures], "", "figure"),
        },
        analysis="sensitivity",
        method=method,
        blocks=int(blocks[0].size),
        blocks_words=WORDS[method],
        importance=indices[0],
        confidence=LEVEL,
    )
    for each in indices:
        whole = each.removesuffix("_confidence")
        data[each].attrs["long_name"] = ("" if whole == each else "half the 95 % interval of the ") + MEANING[whole]
    return data
