"""One look for every picture: colours, fonts, axis labels with units; Figure objects, no global state of pyplot."""

from __future__ import annotations

import importlib
import io
import re
import sys
import warnings
from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.units import QUANTITIES, convert

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000", "#999999")
"""Okabe and Ito's palette, told apart by eyes that see red and green alike; the yellow left out as too pale."""

DASHES = ("-", "--", ":", "-.")
SEQUENCE = "viridis"
AMOUNT = "cividis"
RATIO = "RdBu_r"
INK, FAINT, SHADE = "#222222", "#8a8a8a", "#e9eef3"

_STYLE: dict[str, object] = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "axes.titlesize": 10.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.labelcolor": INK,
    "axes.edgecolor": "#666666",
    "axes.linewidth": 0.8,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.prop_cycle": f"cycler('color', {list(COLOURS)})",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.6,
    "legend.fontsize": 8.0,
    "legend.frameon": True,
    "legend.framealpha": 0.85,
    "legend.edgecolor": "none",
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "hatch.linewidth": 0.5,
    "figure.constrained_layout.use": True,
    "figure.facecolor": "white",
    "svg.fonttype": "path",
    "svg.hashsalt": "torsional",
    "axes.formatter.use_mathtext": False,
}

P = ParamSpec("P")
R = TypeVar("R")


def styled(picture: Callable[P, R]) -> Callable[P, R]:
    """A picture drawn in the house style, with matplotlib's own settings as they were afterwards."""

    @wraps(picture)
    def drawn(*args: P.args, **kwargs: P.kwargs) -> R:
        with mpl.rc_context(_STYLE):  # type: ignore[arg-type]
            return picture(*args, **kwargs)

    return drawn


@styled
def panels(
    rows: int = 1,
    columns: int = 1,
    size: tuple[float, float] = (6.0, 3.6),
    *,
    sharex: bool = False,
    sharey: bool = False,
) -> list[Axes]:
    """Axes of one new figure, row by row; ``size`` [inch] of each; ``sharex``, ``sharey`` as matplotlib has them."""
    figure = Figure(figsize=(size[0] * columns, size[1] * rows))
    FigureCanvasAgg(figure)
    return list(figure.subplots(rows, columns, squeeze=False, sharex=sharex, sharey=sharey).ravel())


def on(axes: Axes | None, size: tuple[float, float] = (6.0, 3.6)) -> tuple[Figure, Axes]:
    """The given axes, or those of a new figure of ``size`` [inch]."""
    chosen = axes if axes is not None else panels(size=size)[0]
    return figure_of(chosen), chosen


def figure_of(axes: Axes) -> Figure:
    """The figure that axes belong to."""
    figure = axes.get_figure(root=True)
    assert isinstance(figure, Figure)
    return figure


def show_in_notebooks() -> None:
    """Have a notebook show figures, which it does by itself only when pyplot has been imported."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    if shell is not None and hasattr(shell, "kernel"):
        importlib.import_module("IPython.core.pylabtools").select_figure_formats(shell, {"png"})


show_in_notebooks()


def plain(text: object, longest: int = 48) -> str:
    """A user's name as a label: no mathematics read into it, no legend entry hidden by an underscore, not too long.

    >>> plain("_cost $x$")
    ' _cost \\\\$x\\\\$'
    """
    told = re.sub(r"\s+", " ", "".join(c for c in str(text) if c.isprintable() or c.isspace())).strip()
    told = told if len(told) <= longest else told[: longest - 1] + "…"
    return (" " if told.startswith("_") else "") + told.replace("$", r"\$")


def readable(name: object) -> str:
    """A component's name as words: gearbox_input is gearbox input."""
    return plain(str(name).replace("_", " ").strip())


def shown_unit(quantity: str) -> str:
    """The unit in which a quantity is shown."""
    return QUANTITIES[quantity].shown


def shown(values: xr.DataArray | Array, quantity: str = "") -> Array:
    """Values in the unit in which their quantity is shown; the quantity is a DataArray's own unless named."""
    named = quantity or (str(values.attrs.get("quantity", "")) if isinstance(values, xr.DataArray) else "")
    entry = QUANTITIES[named]
    factor = 1.0 if entry.unit == entry.shown else convert(1.0, entry.unit, entry.shown)
    return np.asarray(values) * factor


def over(values: xr.DataArray, *dims: str) -> xr.DataArray:
    """Values over just these dimensions, in this order; others of a single value are dropped.

    Raises ModelError for dimensions that are missing, and for further ones, with how to choose one of their values.
    """
    rest = {str(dim): size for dim, size in values.sizes.items() if dim not in dims and size > 1}
    missing = [dim for dim in dims if dim not in values.dims]
    told = f"a picture over {' and '.join(dims)} is drawn from values over them alone"
    if missing:
        raise ModelError(told, found=f"no dimension '{missing[0]}'")
    if rest:
        dim, size = next(iter(rest.items()))
        raise ModelError(told, found=f"{size} values of '{dim}' as well", remedy=f"choose one: .sel({dim}=…)")
    return values.squeeze([dim for dim in values.dims if dim not in dims], drop=True).transpose(*dims)


def label(quantity: str, amplitude: str = "", name: str = "") -> str:
    """An axis label: what it is, in which unit, and by which convention the amplitude is told.

    >>> label("acceleration", "0-peak", "acceleration")
    'acceleration [rad/s²], 0-peak'
    """
    entry = QUANTITIES[quantity]
    unit = "" if entry.shown == "-" else f" [{entry.shown}]"
    return f"{name or entry.long_name}{unit}" + (f", {amplitude}" if amplitude else "")


def operating_range(axes: Axes, speed: tuple[float, float] | None, idle: float | None) -> None:
    """Shade the speeds outside the operating range and mark idle; both in rad/s, the axis in rpm."""
    if speed is not None:
        left, right = axes.get_xlim()
        low, high = (float(shown(np.asarray(v), "speed")) for v in speed)
        axes.axvspan(low, high, color=SHADE, zorder=0, label="operating range")
        axes.set_xlim(left, right)
    if idle is not None:
        at = float(shown(np.asarray(idle), "speed"))
        axes.axvline(at, color=FAINT, linestyle=(0, (4, 2)), linewidth=1.0, label="idle")


def save_svg(figure: Figure) -> bytes:
    """The picture as SVG, its text drawn as paths so that it looks the same everywhere; same input, same bytes.

    Paths are told to a hundredth of a point, which no screen shows and which halves the size.
    """
    full = _saved(figure, format="svg", metadata={"Date": None, "Creator": None}).decode("utf-8")
    return re.sub(r' d="[^"]+"', lambda path: _shortened(path[0]), full).encode("utf-8")


def _shortened(path: str) -> str:
    numbers = re.sub(r"-?\d+\.\d{3,}", lambda number: f"{float(number[0]):.2f}".rstrip("0").rstrip("."), path)
    return re.sub(r"\s+", " ", numbers)


def save_png(figure: Figure, dpi: float = 110.0) -> bytes:
    """The picture as PNG."""
    return _saved(figure, format="png", dpi=dpi, metadata={"Software": None})


@styled
def _saved(figure: Figure, **settings: object) -> bytes:
    stream = io.BytesIO()
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")  # names may be in any script
        figure.savefig(stream, **settings)  # type: ignore[arg-type]
    return stream.getvalue()
