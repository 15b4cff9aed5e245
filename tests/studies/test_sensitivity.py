"""Sensitivities against functions whose indices are known, and against what a truck's parts do far above resonance."""

from __future__ import annotations

import itertools
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from tests.studies.test_sweep import same

import torsional as tv
from torsional.errors import ModelError
from torsional.studies.answers import at_input
from torsional.studies.sweeps import Axis, bands, sampled, sensitivities, sweep
from torsional.studies.sweeps.blocks import salib
from torsional.studies.sweeps.designs import Designs
from torsional.studies.trucks import Trucks

A, B = 7.0, 0.1
ANGLES = dict.fromkeys(("x1", "x2", "x3"), (-np.pi, np.pi))
SLOPES = {"small": 1.0, "large": -4.0, "none": 0.0}
ENDS = {"small": (0.0, 2.0), "large": (1.0, 2.0), "none": (-5.0, 5.0)}


def values(**told: float) -> Any:
    """Stands for a model: the values themselves."""
    if told.get("small", 0.0) > 1.9:
        raise ModelError("too large", found=f"{told['small']}")
    return told


def anything(**told: float) -> Any:
    """The same that refuses none."""
    return told


def ishigami(x: Any) -> dict[str, float]:
    """sin x1 + a sin² x2 + b x3⁴ sin x1 (Ishigami and Homma, ISUMA 1990)."""
    return {"y": np.sin(x["x1"]) + A * np.sin(x["x2"]) ** 2 + B * x["x3"] ** 4 * np.sin(x["x1"])}


def line(x: Any) -> dict[str, Any]:
    """A sum, an array of it and of its opposite and an empty place, a constant, and a count."""
    y = sum(SLOPES[name] * x[name] for name in SLOPES)
    return {"y": y, "several": ("place", [y, -2.0 * y, np.nan]), "same": 3.0, "count": int(x["small"] > 1.0)}


def test_shares_of_the_variance_of_ishigamis_function() -> None:
    """Within their own intervals, and these within what sampling allows."""
    found = sensitivities(sweep(anything, sampled("saltelli", ANGLES, 1024, seed=5), ishigami, chunk=1000))
    one, two, both = 0.5 * (1 + B * np.pi**4 / 5) ** 2, A**2 / 8, 8 * B**2 * np.pi**8 / 225
    whole = one + two + both
    for name, expected in (
        ("first_order", np.array([one, two, 0.0]) / whole), ("total", np.array([one + both, two, both]) / whole)
    ):  # fmt: skip
        error = abs(found[name].sel(figure="y") - expected)
        assert (error < 1.5 * found[f"{name}_confidence"].sel(figure="y")).all() and (error < 0.06).all(), name
        assert float(found[f"{name}_confidence"].max()) < 0.12


def test_elementary_effects_of_ishigamis_function() -> None:
    """Against all steps that there are on a grid of four levels."""
    found = sensitivities(sweep(anything, sampled("morris", ANGLES, 300, seed=2), ishigami)).sel(figure="y")
    levels = np.linspace(-np.pi, np.pi, 4)
    for place, name in enumerate(ANGLES):
        effects = []
        for point in itertools.product(levels[:2], levels, levels):
            at = np.roll(point, place)
            there = at.copy()
            there[place] += 4 / 3 * np.pi
            ends = [ishigami(dict(zip(ANGLES, each, strict=True)))["y"] for each in (at, there)]
            effects.append((ends[1] - ends[0]) * 1.5)
        here = found.sel(parameter=name)
        assert float(here.effect_size) == pytest.approx(np.mean(np.abs(effects)), rel=0.06)
        assert float(here.effect) == pytest.approx(np.mean(effects), abs=0.06 * np.abs(effects).mean() + 0.5)
        assert float(here.effect_spread) == pytest.approx(np.std(effects), rel=0.06)


def test_a_straight_line_has_its_slopes() -> None:
    found = sensitivities(sweep(anything, sampled("morris", ENDS, 6), line))
    assert found.sel(figure="y").effect.values == pytest.approx([2.0, -4.0, 0.0], abs=1e-12)
    assert found.sel(figure="y").effect_size.values == pytest.approx([2.0, 4.0, 0.0], abs=1e-12)
    assert found.effect_spread.sel(figure="y").values == pytest.approx(np.zeros(3), abs=1e-12)
    assert found.sel(figure="several").effect_size.values == pytest.approx([4.0, 8.0, 0.0], abs=1e-12)
    assert str(found.reduction.sel(figure="several").item()) == "largest absolute value over place"
    assert str(found.reduction.sel(figure="y").item()) == ""
    assert not found.sel(figure="same").effect_size.values.any()
    shares = sensitivities(sweep(anything, sampled("saltelli", ENDS, 256), line, chunk=1000))
    assert shares.sel(figure="y").total.values == pytest.approx([0.2, 0.8, 0.0], abs=0.02)
    assert shares.sel(figure="y").first_order.values == pytest.approx([0.2, 0.8, 0.0], abs=0.06)
    assert np.isnan(shares.sel(figure="same").total).all()


def test_a_logarithm_over_a_logarithmic_axis_is_a_straight_line() -> None:
    axes = {"x": Axis(low=1.0, high=100.0, log=True), "kind": Axis(("soft", "stiff"))}
    found = sweep(anything, sampled("morris", axes, 5), lambda x: {"y": np.log(x["x"]) + 5.0 * (x["kind"] == "stiff")})
    told = sensitivities(found)
    assert told.effect.values.ravel() == pytest.approx([np.log(100.0), 7.5])  # two levels: the step is the whole
    assert told.effect_spread.values.ravel() == pytest.approx([0.0, 0.0], abs=1e-12)


@pytest.mark.parametrize(("method", "count", "size"), [("morris", 40, 4), ("saltelli", 64, 5)])
def test_blocks_that_lost_a_design_are_left_out(method: str, count: int, size: int) -> None:
    """The indices are those of the complete ones, as SALib tells them."""
    found = sweep(values, sampled(method, ENDS, count, seed=3), line)
    fine = (found.status.values == 0).reshape(-1, size).all(axis=1)
    assert 0 < fine.sum() < count
    told = sensitivities(found, ["y"])
    assert told.blocks.values.tolist() == [fine.sum()] and told.attrs["blocks"] == count
    y = found["y"].values.reshape(-1, size)[fine].ravel()
    problem = {"num_vars": 3, "names": ["a", "b", "c"], "bounds": [[0.0, 1.0]] * 3}
    if method == "saltelli":
        beside = salib("analyze.sobol").analyze(problem, y, calc_second_order=False, seed=4)
        assert told.total.values[0] == pytest.approx(beside["ST"], rel=1e-12)
    else:
        assert told.effect.values[0] == pytest.approx([2.0, -4.0, 0.0], abs=1e-9)


def test_too_few_complete_blocks_are_refused() -> None:
    few = sweep(values, sampled("morris", ENDS | {"small": (1.0, 2.0)}, 4, seed=1), line)
    with pytest.raises(ModelError, match=r"y: too few trajectories are complete; found [0-3] of 4; allowed: >= 4"):
        sensitivities(few, ["y"])
    with pytest.raises(ModelError, match="need designs of their own; found sobol"):
        sensitivities(sweep(anything, sampled("sobol", ENDS, 8), line))
    with pytest.raises(ModelError, match="no such figure; found yy; did you mean 'y'"):
        sensitivities(sweep(anything, sampled("morris", ENDS, 4), line), ["yy"])
    with pytest.raises(ModelError, match="need more base points; found 4; allowed: >= 16"):
        sampled("saltelli", ENDS, 4)
    with pytest.raises(ModelError, match="trajectories have 4 designs each; found 41 designs"):
        Designs({name: Axis(low=0.0, high=1.0) for name in ENDS}, 41, "morris")


def test_a_missing_library_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.partition(".")[0] == "SALib"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "SALib", None)
    with pytest.raises(ModelError, match=r"need the library SALib; pip install 'torsional\[design\]'"):
        sampled("morris", ENDS, 4)


@pytest.mark.parametrize("method", ["morris", "saltelli"])
def test_the_same_bits_again_however_it_is_cut(method: str, tmp_path: Path) -> None:
    """Seed 0 too, which some take for none."""
    designs = sampled(method, ENDS, 16)
    whole = sweep(anything, designs, line)
    cut = sweep(anything, sampled(method, ENDS, 16), line, chunk=7, folder=tmp_path)
    assert same(whole, cut) and sensitivities(whole).identical(sensitivities(cut))
    tv.save_results(cut, tmp_path / "kept.nc")
    assert sensitivities(tv.load_results(tmp_path / "kept.nc")).equals(sensitivities(whole))
    other = sampled(method, ENDS, 16, seed=1).columns(0, 9)["large"]
    assert (np.asarray(other) != designs.columns(0, 9)["large"]).any()


def test_far_above_resonance_a_truck_follows_its_secondary_inertia() -> None:
    """At 2000 rpm the secondary flywheel is a free mass between two springs, moved through the one and its damper:

    d ln a / d ln J2 = -J2 w² / (J2 w² - k1 - k2), and of spring and damper as k1² and (w c1)² share |k1 + i w c1|².
    """
    truck, speed = Trucks.shipped().dmf, 2000.0 * tv.RPM
    w, j2, k1, k2, c1 = 3.0 * speed, 1.0, 13e3, 25e3, 20.0
    own = {"absorber.secondary_inertia": j2, "absorber.stiffness": k1, "absorber.damping": c1}
    axes = {name: Axis(low=0.95 * value, high=1.05 * value, log=True) for name, value in own.items()}
    found = sweep(
        truck, sampled("morris", axes, 4), lambda model: {"level": np.log(at_input(model, np.array([speed]))[0])}
    )
    slopes = sensitivities(found).effect.values[0] / np.log(1.05 / 0.95)
    rest, whole = j2 * w**2 - k1 - k2, k1**2 + (w * c1) ** 2
    expected = [-j2 * w**2 / rest, k1**2 / whole + k1 / rest, (w * c1) ** 2 / whole]
    assert slopes == pytest.approx(expected, rel=0.03)


# --- bands ---


def test_percentiles_of_what_is_spread_evenly() -> None:
    designs = sampled("latin_hypercube", {"low": (0.0, 1.0)}, 1000)
    found = sweep(
        anything, designs, lambda x: {"curve": ("speed", x["low"] * np.arange(8.0)), "turned": 1j * x["low"], "n": 1}
    )
    found["speed"] = ("speed", np.arange(8.0) * 100.0, {"quantity": "speed"})
    told = bands(found, {"curve": ("speed", np.arange(8.0)), "turned": -1j})
    expected = np.outer([0.05, 0.25, 0.5, 0.75, 0.95], np.arange(8.0))
    assert told.curve.values == pytest.approx(expected, abs=0.01)
    assert told.turned.values == pytest.approx(expected[:, 1], abs=0.01) and float(told.turned_nominal) == 1.0
    assert told.curve.attrs["along"] == "speed" and told.curve_nominal.attrs["nominal_of"] == "curve"
    assert told.speed.attrs["units"] == "rad/s" and told.attrs["answered"] == 1000


def test_designs_without_an_answer_do_not_count() -> None:
    found = sweep(values, sampled("latin_hypercube", ENDS, 60), line)
    told = bands(found)
    fine = found.status.values == 0
    assert told.attrs["answered"] == fine.sum() < 60
    assert told["y"].values[2] == np.median(found["y"].values[fine])
    assert told["count"].values[2] == np.median(found["count"].values[fine])
    assert np.isnan(told["several"].values[:, 2]).all() and "y_nominal" not in told
    with pytest.raises(ModelError, match="too few designs have an answer; found 8; allowed: >= 20"):
        bands(sweep(anything, sampled("sobol", ENDS, 8), line))
    with pytest.raises(ModelError, match="a percentile is from 0 to 100"):
        bands(found, percentiles=[101.0])


def test_bands_of_a_grid_are_taken_over_all_of_it() -> None:
    found = sweep(anything, {"small": np.arange(5.0), "large": np.arange(4.0), "none": [0.0]}, line)
    assert isinstance(found, xr.Dataset) and bands(found)["y"].dims == ("percentile",)
    assert float(bands(found)["y"].sel(percentile=50.0)) == np.median(found["y"].values)
