"""Bands of uncertainty: shaded percentiles of curves or single figures, the median, and the nominal design."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from torsional.errors import ModelError
from torsional.plots import style

MOST = 8
"""Panels that a picture has, those of the largest medians."""
STACKED = 3
"""Panels that stand below each other, so that their axes can be compared."""
BAND, INNER = "#bcd7ea", "#6ba6cf"


@style.styled
def plot_bands(data: xr.Dataset) -> Figure:
    """Percentiles of `torsional.studies.sweeps.bands`: a panel for each curve, the outer ones shaded lighter.

    A figure that is a curve over some dimension has a panel for each place in its others; all other figures have one
    panel in which every place has its bars.  The eight panels of the largest medians are drawn of one figure.  Raises
    ModelError for a Dataset that holds no percentiles.
    """
    if "percentile" not in data.dims:
        raise ModelError("bands are drawn from percentiles along designs", found=str(data.attrs.get("analysis", "")))
    names = [str(name) for name, v in data.data_vars.items() if "percentile" in v.dims]
    parts = [(name, at) for name in names for at in _places(data[name])]
    columns = 1 if len(parts) <= STACKED else 2
    drawn = style.panels(-(-len(parts) // columns), columns, (6.4, 3.4))
    for axes, (name, at) in zip(drawn, parts, strict=False):
        nominal = next((v for v in data.data_vars.values() if v.attrs.get("nominal_of") == name), None)
        own = None if nominal is None else nominal.sel(at)
        (_curves if data[name].attrs["along"] else _bars)(axes, data[name].sel(at), own)
        axes.set_title(_title(name, at))
    drawn[0].legend()
    for axes in drawn[len(parts) :]:
        axes.remove()
    return style.figure_of(drawn[0])


def _places(values: xr.DataArray) -> list[dict[str, Any]]:
    """The places of one panel each: of a curve every combination of its other dimensions, the strongest of many."""
    along = values.attrs["along"]
    dims = [str(dim) for dim in values.dims if dim not in ("percentile", along)] if along else []
    places = [dict(zip(dims, labels, strict=True)) for labels in product(*(values[dim].values for dim in dims))]
    if len(places) <= MOST:
        return places
    peaks = [float(_percentile(values.sel(at), 50.0).max()) for at in places]
    strongest = set(np.argsort(np.nan_to_num(peaks))[-MOST:].tolist())
    return [at for number, at in enumerate(places) if number in strongest]


def _percentile(values: xr.DataArray, which: float) -> Any:
    return values.sel(percentile=which, method="nearest")


def _title(name: str, at: Mapping[str, Any]) -> str:
    told = [f"{dim} {label:g}" if isinstance(label, float) else f"{dim} {label}" for dim, label in at.items()]
    return ", ".join([style.readable(name), *map(style.readable, told)])


def _pairs(values: xr.DataArray) -> list[tuple[float, float]]:
    """Percentiles by pairs, the outermost first; the one in the middle is left."""
    listed = sorted(values.percentile.values.tolist())
    return [(listed[n], listed[-1 - n]) for n in range(len(listed) // 2)]


def _curves(axes: Axes, values: xr.DataArray, nominal: xr.DataArray | None) -> None:
    along = str(values.attrs["along"])
    x = style.shown(values[along], str(values[along].attrs.get("quantity", "number")))
    quantity = str(values.attrs.get("quantity", "number"))
    pairs = _pairs(values)
    for number, (low, high) in enumerate(pairs):
        lower, upper = (style.shown(values.sel(percentile=each), quantity) for each in (low, high))
        colour = BAND if number == 0 and len(pairs) > 1 else INNER
        axes.fill_between(x, lower, upper, color=colour, linewidth=0, label=f"{low:g} to {high:g} %")
    median = style.shown(_percentile(values, 50.0), quantity)
    axes.plot(x, median, color=style.COLOURS[0], label="median")
    if nominal is not None:
        axes.plot(x, style.shown(nominal, quantity), color=style.INK, linestyle="--", linewidth=1.2, label="nominal")
    axes.set_xlim(x.min(), x.max())
    if float(values.min()) >= 0:
        axes.set_ylim(bottom=0)
    words = "engine speed" if along == "speed" else style.readable(along)
    axes.set_xlabel(style.label(str(values[along].attrs.get("quantity", "number")), name=words))
    axes.set_ylabel(style.label(quantity, _convention(values), _words(values)))


def _bars(axes: Axes, values: xr.DataArray, nominal: xr.DataArray | None) -> None:
    """Every place of a figure that is no curve: thin and thick bars, a stroke for the median, a ring for nominal."""
    dims = [str(dim) for dim in values.dims if dim != "percentile"]
    quantity = str(values.attrs.get("quantity", "number"))
    flat = style.shown(values.transpose("percentile", *dims), quantity).reshape(values.sizes["percentile"], -1)
    at = np.arange(flat.shape[1], dtype=float)
    order = dict(zip(values.percentile.values.tolist(), flat, strict=True))
    pairs = _pairs(values)
    for number, (low, high) in enumerate(pairs):
        colour, width = (BAND, 0.5) if number == 0 and len(pairs) > 1 else (INNER, 0.32)
        axes.bar(at, order[high] - order[low], width, order[low], color=colour, label=f"{low:g} to {high:g} %")
    median = order[min(order, key=lambda each: abs(each - 50.0))]
    axes.hlines(median, at - 0.3, at + 0.3, color=style.COLOURS[0], label="median")
    if nominal is not None:
        own = style.shown(nominal.transpose(*dims), quantity).ravel()
        axes.plot(at, own, "o", color=style.INK, markerfacecolor="none", label="nominal")
    labels = [" ".join(map(str, each)) for each in product(*(values[dim].values.tolist() for dim in dims))]
    axes.set_xticks(at, [style.plain(label) for label in labels] if dims else [""])
    axes.grid(visible=False, axis="x")
    axes.set_xlim(-0.7, flat.shape[1] - 0.3)
    axes.use_sticky_edges = False  # bars would else stand on the frame
    axes.margins(y=0.08)
    axes.set_xlabel(", ".join(map(style.readable, dims)))
    axes.set_ylabel(style.label(quantity, _convention(values), _words(values)))


def _words(values: xr.DataArray) -> str:
    quantity = str(values.attrs.get("quantity", ""))
    return style.readable(values.name) if quantity in ("", "number", "ratio") else quantity.replace("_", " ")


def _convention(values: xr.DataArray) -> str:
    return str(values.attrs.get("amplitude", ""))
