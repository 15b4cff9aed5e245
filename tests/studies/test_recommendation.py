"""The recommendation: fronts of the absorbers at equal inertia, their picture and their words."""

from __future__ import annotations

import json

import numpy as np
import pytest
import xarray as xr

import torsional as tv
from torsional.plots.fronts import plot_fronts
from torsional.results import labelled
from torsional.studies.register import tools
from torsional.studies.tools.recommendation import PRESETS, findings
from torsional.studies.trucks import Trucks


def fronts() -> xr.Dataset:
    """Two fronts that cross no other, one of a single point."""
    low = np.array([[400.0, 600.0, 900.0], [300.0, 500.0, 800.0], [50.0, np.nan, np.nan]])
    high = np.array([[300.0, 200.0, 100.0], [250.0, 150.0, 90.0], [500.0, np.nan, np.nan]])
    pairs = ("concept", "point")
    data = labelled(
        {
            "low_speed": (pairs, low, "acceleration"),
            "high_speed": (pairs, high, "acceleration"),
            "nominal_low_speed": (("concept",), np.array([900.0, 950.0, 300.0]), "acceleration"),
            "nominal_high_speed": (("concept",), np.array([700.0, 600.0, 400.0]), "acceleration"),
            "knee": (("concept",), np.array([1, 1, 0]), "number"),
        },
        {"concept": (np.array(["DMF", "PSVA", "other"]), ""), "point": (np.arange(3), "")},
        analysis="study recommendation",
    )
    ranges = {"low_range": [600 * tv.RPM, 1000 * tv.RPM], "high_range": [1000 * tv.RPM, 2000 * tv.RPM]}
    return data.assign_attrs({name: json.dumps(ends) for name, ends in ranges.items()})


def test_fronts_are_read_out_in_words() -> None:
    told = "\n".join(findings(fronts()))
    assert "DMF: down to 400 rad/s² at low speed, where high speed has 300, and down to 100 rad/s²" in told
    assert "PSVA against DMF: -25 % at low speed, -10 % at high." in told
    assert "For every design of DMF there is one of PSVA that is quieter at both ends." in told
    assert "of other that is quieter" not in told


def test_the_picture_shows_every_front_and_the_designs_as_they_are() -> None:
    axes = plot_fronts(fronts()).axes[0]
    drawn = {line.get_label(): line for line in axes.lines}
    assert {"DMF", "PSVA", "other", "as it is", "knee"} <= set(drawn)
    assert drawn["PSVA"].get_xdata().tolist() == [300.0, 500.0, 800.0]  # type: ignore[union-attr]
    assert "600 to 1000 rpm" in axes.get_xlabel() and "1000 to 2000 rpm" in axes.get_ylabel()


@pytest.mark.full
def test_all_concepts_keep_the_same_space() -> None:
    found = tools()["recommendation"](Trucks.shipped(), population=16, generations=4, between=0, processes=2)
    assert found.concept.values.tolist() == list(PRESETS)
    assert float(found.space.max()) <= 2.5 and float(found.low_speed.min()) > 0
    best = found.low_speed.min("point")
    assert (best < found.nominal_low_speed).all()
    today = found.sel(concept="DMF")
    assert float(found.low_speed.max()) <= float(today.nominal_low_speed)
    assert float(found.high_speed.max()) <= float(today.nominal_high_speed)
    assert float(best.sel(concept="DMF with pendulum")) < float(best.sel(concept="DMF"))
