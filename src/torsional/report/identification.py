"""Pages about identifications and correlations: in words, tables, pictures, and how it was done."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import xarray as xr

from torsional.plots.correlation import plot_correlation
from torsional.plots.fit import plot_certainty, plot_fits, plot_residuals
from torsional.report.blocks import Items, Picture, Section, Table, Text, picture, table
from torsional.report.page import html_page
from torsional.units import QUANTITIES, show


def write_identification(found: xr.Dataset, model: tuple[str, str], path: Path) -> Path:
    """Write one self-contained HTML page about an identification; ``model``: name and hash."""
    parts = [
        Section("found", "What was found", (Items("In words", tuple(found.attrs["findings"].split("\n"))),)),
        Section("parameters", "The parameters", (_parameters(found), _certainty(found), _ways(found))),
        Section("fits", "Measured and fitted", (_fits(found), _residuals(found), _models(found))),
        Section("method", "How it was found", (Text(_method(found)),)),
    ]
    title = str(found.attrs["plan"])
    page = html_page(title, "identification", f"Parameters identified: {title}", parts, [model])
    path.write_text(page, encoding="utf-8")
    return path


def _parameters(found: xr.Dataset) -> Table:
    level = f"{100 * found.attrs['level']:g} %"
    rows = []
    for place, name in enumerate(found.parameter.values):
        kind = str(found.kind.values[place])
        figures = (found[of].values[place] for of in ("begun", "estimate", "interval_low", "interval_high"))
        rows.append((str(name), *(show(float(v), kind) if abs(v) < float("inf") else "-" for v in figures)))
    return table(
        "Estimates with intervals", ("parameter", "begun at", "found", f"{level} from", "to"), rows, range(1, 5)
    )


def _certainty(found: xr.Dataset) -> Picture:
    caption = (
        "Left: correlations of the estimates; near ±1 the data hardly tell two apart. Right: widths of the intervals"
    )
    caption += ", and profiles: bent where the model is not linear in a parameter." if "profile_rise" in found else "."
    return picture(plot_certainty(found), caption, "Correlations and intervals of the parameters.")


def _ways(found: xr.Dataset) -> Table:
    names = [str(name) for name in found.parameter.values]
    rows = [
        (
            f"{deviation:.3g}" if deviation < float("inf") else "not told",
            " ".join(f"{share:+.2f} {name}" for share, name in zip(shares, names, strict=True) if abs(share) >= 0.1),
        )
        for deviation, shares in zip(found.way_deviation.values, found.way_share.values, strict=True)
    ]
    head = ("standard deviation", "combination of parameters over their scales")
    return table("What the data tell, the least known first", head, rows, (0,), folded=True, wrapped=True)


def _fits(found: xr.Dataset) -> Picture:
    caption = "Dots: measured (of loops means of all cycles); lines: the models."
    if found.sizes["point"] > 12:
        caption += f" Twelve of {found.sizes['point']} points."
    return picture(plot_fits(found), caption, "Measured and fitted curves.")


def _residuals(found: xr.Dataset) -> Picture:
    caption = "Left: what the plan's own model leaves, along each point. Right: the same of all models, point by point."
    return picture(plot_residuals(found), caption, "Residuals over the noise.")


def _models(found: xr.Dataset) -> Table:
    head = ("model", "parameters", "residuals over noise", "of points held back", "AICc", "BIC")
    least = [float(found[name].min()) for name in ("aicc", "bic")]
    rows = []
    for place, name in enumerate(found.model.values):
        one = found.isel(model=place)
        held = f"{float(one.held_misfit):.3f}" if float(one.held_misfit) == float(one.held_misfit) else "-"
        over = (f"{float(one[of]) - base:+.1f}" for of, base in zip(("aicc", "bic"), least, strict=True))
        rows.append((str(name), f"{int(one.parameters)}", f"{float(one.misfit):.3f}", held, *over))
    return table("Models of the same data; criteria above the least", head, rows, range(1, 6))


def _method(found: xr.Dataset) -> str:
    return (
        f"Weighted least squares within bounds over {found.attrs['samples']} values, {found.attrs['evaluations']} "
        "evaluations of the models: a trust region first, Gauss and Newton's steps to the minimum. Deviations are "
        "s²(JᵀJ)⁻¹ and what the noise of measured angles adds to it; intervals take Student's quantiles."
    )


def write_correlation(
    found: xr.Dataset, sentences: Sequence[str], models: Sequence[tuple[str, str]], path: Path
) -> Path:
    """Write one self-contained HTML page about computed orders beside measured ones."""
    caption = "Dots: measured; lines: computed, at the measured speeds. The six largest orders."
    drawn = picture(plot_correlation(found), caption, "Measured and computed orders over speed.")
    parts = [
        Section("found", "What was found", (Items("In words", tuple(sentences)),)),
        Section("orders", "Order by order", (drawn, deviations(found))),
        Section("method", "What the figures mean", (Text(FIGURES),)),
    ]
    title = f"Measured beside computed: {found.attrs.get('place', found.attrs['quantity'])}"
    path.write_text(html_page(title, "correlation", title, parts, models), encoding="utf-8")
    return path


FIGURES = (
    "Amplitude error: RMS computed over RMS measured, less one. Peak error and shift: of the largest amplitudes, and "
    "of the speeds where they are, computed less measured. Phase: by what the computed order leads. FRAC: the "
    "frequency response assurance criterion, 1 for one shape whatever its size. RMS and relative deviation: of the "
    "amplitudes' differences, and over the measured RMS. R²: share of the measured variance "
    "over speed that is reproduced."
)


def deviations(found: xr.Dataset) -> Table:
    """The deviations as a table, an order a row."""
    unit = QUANTITIES[str(found.attrs["quantity"])].shown
    head = (
        "order",
        "speeds",
        "amplitude error [%]",
        "peak error [%]",
        "peak shift [rpm]",
        "phase [deg]",
        "FRAC",
        f"RMS deviation [{unit}]",
        "relative deviation [%]",
        "R²",
    )
    kinds = {
        "amplitude_error": "relative_difference",
        "peak_error": "relative_difference",
        "peak_shift": "speed",
        "phase_difference": "angle",
        "frac": "ratio",
        "rms_deviation": str(found.attrs["quantity"]),
        "relative_deviation": "relative_difference",
        "r_squared": "ratio",
    }
    rows = []
    for place, order in enumerate(found.order.values):
        one = found.isel(order=place)
        figures = (_shown(float(one[name]), kind) for name, kind in kinds.items())
        rows.append((f"{order:g}", f"{int(one.speeds)}", *figures))
    return table("Deviations", head, rows, range(len(head)))


def _shown(value: float, kind: str) -> str:
    return show(value, kind).split(" ")[0] if value == value else "-"
