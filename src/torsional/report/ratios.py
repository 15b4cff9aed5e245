"""Findings about two variants: the ratio of their vibrations and the cells in which the first is louder."""

from __future__ import annotations

import numpy as np
import xarray as xr

from torsional.numerics.arrays import Array
from torsional.report.analysis import Comparison, Response, Variant
from torsional.report.finding import Finding
from torsional.report.labels import gears_told, listed, rounded, told
from torsional.report.levels import peak


def against(comparison: Comparison, other: Variant) -> list[Finding]:
    """The first variant set against another: ratios, the largest vibration, irregularity at idle."""
    ratio = comparison.ratio(other)
    if ratio is None:
        return [
            Finding("ratio", "No ratio is told: the two have no gear, speed and torque at which both have a response.")
        ]
    found = [_median(ratio), *louder(ratio)]
    first, second = comparison.first.response, other.response
    assert first is not None and second is not None
    (mine, _), (theirs, _) = peak(first), peak(second)
    text = f"The largest acceleration is {rounded(mine / theirs)} times as large: {told(mine, 'acceleration')} against "
    found.append(Finding("peaks", text + f"{told(theirs, 'acceleration')}.", {"ratio": mine / theirs}))
    return found + _irregular(first, second)


def _median(ratio: xr.DataArray) -> Finding:
    median, most = float(ratio.median()), float(ratio.max())
    share = float((ratio > 1).sum() / ratio.notnull().sum())
    text = "The median ratio of the accelerations over all gears, speeds and torques up to full load is "
    text += f"{rounded(median)}, the largest {rounded(most)}; {_percent(share)} of the cells are above 1."
    return Finding("ratio", text, {"median": median, "largest": most, "share above 1": share})


def _percent(share: float) -> str:
    return "none" if share == 0 else f"{rounded(100 * share, 2)} %" if share >= 0.001 else "less than 0.1 %"


def louder(ratio: xr.DataArray) -> list[Finding]:
    """Where the first variant vibrates more than the other: speeds, with the gears that share them."""
    above = (ratio > 1).any("mean_torque")
    alike: dict[str, list[str]] = {}
    values = {}
    for gear in ratio.gear.values[above.any("speed").values]:
        alike.setdefault(listed(_runs(ratio.speed.values, above.sel(gear=gear).values)), []).append(str(gear))
        values[str(gear)] = float(ratio.sel(gear=gear).max())
    known = [str(gear) for gear in ratio.gear.values]
    places = []
    for speeds, gears in alike.items():
        where = gears_told(gears, known)
        most = rounded(max(values[gear] for gear in gears))
        places.append(f"{where} at {speeds} (up to {most})" if where else f"{speeds} (up to {most})")
    more = "; and elsewhere" if len(places) > 8 else ""
    return [Finding("louder", f"Cells above 1: {'; '.join(places[:8])}{more}.", values)] if places else []


def _runs(speeds: Array, inside: Array) -> list[str]:
    """Speeds that follow each other, as ranges in rpm."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], inside.astype(int), [0]])))
    runs = []
    for start, stop in edges.reshape(-1, 2):
        low, high = told(float(speeds[start]), "speed"), told(float(speeds[stop - 1]), "speed")
        runs.append(low if low == high else f"{low.removesuffix(' rpm')}–{high}")
    return runs


def _irregular(first: Response, second: Response) -> list[Finding]:
    if first.idle is None or second.idle is None:
        return []
    mine, theirs = float(first.idle[0]), float(second.idle[0])
    text = f"The crankshaft's irregularity at idle under the least mean torque is {100 * mine:.2g} % against "
    text += f"{100 * theirs:.2g} %."
    return [Finding("irregularity", text, {"first": mine, "second": theirs})]
