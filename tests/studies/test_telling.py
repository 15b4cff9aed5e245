"""Intervals, what the data leave open, criteria of models, and fits taken to their minimum."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy import stats

from torsional.studies.estimates import Identified, Measured, Unknown
from torsional.studies.identify import appraised, identified, refined
from torsional.studies.records import white_noise

X = np.linspace(0.0, 1.0, 12)
LINE = [Unknown("k", "stiffness", 3.0, 0.0, 9.0), Unknown("T", "torque", 0.5, -9.0, 9.0)]


def line(seed: int) -> tuple[Identified, np.ndarray]:
    y = 3.0 * X + 0.5 + 0.2 * np.random.default_rng(seed).standard_normal(X.size)
    told = [Measured("line", y, 0.2)]
    return identified(lambda v: [v["k"] * X + v["T"]], told, LINE), y


def test_intervals_of_a_line_are_the_textbooks() -> None:
    """scipy's regression: slope ± t · its standard error."""
    found, y = line(1)
    known = stats.linregress(X, y)
    reach = stats.t.ppf(0.975, X.size - 2) * known.stderr
    assert found.intervals()[0] == pytest.approx([known.slope - reach, known.slope + reach], rel=1e-6)
    assert found.deviations == pytest.approx([known.stderr, known.intercept_stderr], rel=1e-6)
    wide, narrow = np.diff(found.intervals(0.99)[0]), np.diff(found.intervals(0.5)[0])
    assert wide / narrow == pytest.approx(stats.t.ppf(0.995, 10) / stats.t.ppf(0.75, 10))


def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    held = [low <= 3.0 <= high for low, high in (line(seed)[0].intervals(0.9)[0] for seed in range(300))]
    assert np.mean(held) == pytest.approx(0.9, abs=4 * np.sqrt(0.9 * 0.1 / 300))


def test_errors_of_what_the_model_is_given_are_in_the_intervals() -> None:
    """Three lines, each along an angle that is off as a whole: without these errors far too few intervals hold."""
    k, off, noise, held = 50.0, 0.02, 0.1, np.zeros(2)
    draw, unknown = np.random.default_rng(3), [Unknown("k", "stiffness", 50.0, 1.0, 99.0)]
    for _ in range(200):
        wrong = 1.0 + off * draw.standard_normal(3)
        measured = [Measured(f"line {n}", k * X + noise * draw.standard_normal(X.size), noise) for n in range(3)]

        def predicted(values: dict[str, float], told: np.ndarray = wrong) -> list[np.ndarray]:
            return [values["k"] * X * each for each in told]

        def errors(values: dict[str, float]) -> list[np.ndarray]:
            return [values["k"] * X[:, None] * off] * 3

        near = appraised(predicted, measured, unknown)
        found = refined(predicted, measured, near, errors=errors)
        for place, each in enumerate((found, dataclasses.replace(found, inputs=()))):
            low, high = each.intervals()[0]
            held[place] += low <= k <= high
    assert held[0] / 200 > 0.9 and held[1] / 200 < 0.75, held


def test_criteria_of_models_by_hand() -> None:
    found, y = line(2)
    left = y - np.polyval(np.polyfit(X, y, 1), X)
    n, squares = 12, float(left @ left) / 0.2**2
    assert found.bic == pytest.approx(n * np.log(squares / n) + 3 * np.log(n), rel=1e-6)
    assert found.aicc == pytest.approx(n * np.log(squares / n) + 6 + 2 * 3 * 4 / (n - 4), rel=1e-6)
    third = [*LINE, Unknown("c", "damping", 1e-3, -9.0, 9.0, scale=1.0)]
    wider = identified(lambda v: [v["k"] * X + v["T"] + v["c"] * X**2], [Measured("line", y, 0.2)], third)
    assert wider.squares <= found.squares and wider.bic > found.bic


def test_what_only_the_sum_tells_is_named() -> None:
    pair = [Unknown("a", "stiffness", 1.0, 0.0, 9.0), Unknown("b", "stiffness", 2.0, 0.0, 9.0)]
    found = appraised(lambda v: [(v["a"] + v["b"]) * X], [Measured("line", 3.0 * X + 0.01 * X**2, 0.1)], pair)
    (open_, told) = found.ways
    assert open_.untold and not np.isfinite(open_.deviation) and not told.untold
    # over the scales 1 and 2 the sum is a + 2 b: what it leaves open is 2 a − b
    assert open_.words in ("0.89 a - 0.45 b", "-0.45 b + 0.89 a")
    assert not np.isfinite(found.intervals()).any()


def test_refined_ends_at_the_minimum_and_keeps_within_bounds() -> None:
    y = np.exp(-2.0 * X)
    unknown = [Unknown("rate", "eigenvalue", 1.7, 0.0, 9.0), Unknown("size", "number", 0.8, 0.0, 0.9)]
    told = [Measured("decay", y, 0.01)]

    def decay(values: dict[str, float]) -> list[np.ndarray]:
        return [values["size"] * np.exp(-values["rate"] * X)]

    free = [unknown[0], dataclasses.replace(unknown[1], high=2.0)]
    assert refined(decay, told, appraised(decay, told, free)).estimates == pytest.approx([2.0, 1.0], abs=1e-9)
    bound = refined(decay, told, appraised(decay, told, unknown))
    assert bound.values["size"] == pytest.approx(0.9, abs=1e-9) and bound.at_bounds() == ["size"]
    rates = np.linspace(1.0, 3.0, 20001)
    grid = np.square(0.9 * np.exp(-np.outer(rates, X)) - y).sum(axis=1)
    assert bound.values["rate"] == pytest.approx(rates[grid.argmin()], abs=2e-4)


def test_a_random_start_that_is_no_model_is_passed_over() -> None:
    from torsional.errors import ModelError

    def picky(values: dict[str, float]) -> list[np.ndarray]:
        if values["k"] > 5.0:
            raise ModelError("too stiff")
        return [values["k"] * X]

    one = [Unknown("k", "stiffness", 2.0, 0.0, 9.0)]
    found = identified(picky, [Measured("line", 3.0 * X + 1e-3 * X**2, 0.01)], one, starts=6)
    assert found.values["k"] == pytest.approx(3.0, abs=1e-2)


def test_white_noise_on_a_ramp_with_a_jump() -> None:
    time = np.sort(np.random.default_rng(0).random(5000))
    values = 50.0 * time + 7.0 * (time > 0.5) + 0.3 * np.random.default_rng(1).standard_normal(5000)
    assert white_noise(time, values) == pytest.approx(0.3, rel=0.05)
