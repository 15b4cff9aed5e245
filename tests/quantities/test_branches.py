"""Stable ranges, coexisting motions and motions at one speed, on branches in closed form."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from tests.synthetic_branches import FOLD, branches

from torsional.laws import Hinges
from torsional.quantities.branches import (
    bifurcation_points,
    coexisting,
    pieces,
    solutions_at,
    stable_ranges,
    stage_parts,
    stage_shares,
    without_stable,
)


@pytest.fixture
def result() -> xr.Dataset:
    return branches()


def test_pieces_cover_every_step_once(result: xr.Dataset) -> None:
    found = pieces(result)
    assert [(p.branch, p.stable) for p in found] == [
        (0, True),
        (0, False),
        (0, True),
        (1, True),
        (2, True),
        (2, False),
        (2, True),
    ]
    steps = sum(len(p.points) - 1 for p in found)
    assert steps == result.sizes["point"] - 3 + 1  # of three branches, one of which begins on another
    assert all(result.stable.values[p.points].all() for p in found if p.stable)
    assert result.branch.values[found[3].points][:2].tolist() == [0, 1]
    assert result.value.values[found[3].points[0]] == 90.0


def test_stable_ranges_end_at_bifurcations(result: xr.Dataset) -> None:
    """The points of the isolated branch lie beside its folds; the ranges end at them."""
    assert np.array(stable_ranges(result, 0)) == pytest.approx(np.array([(50, 90), (110, 150)]))
    assert np.array(stable_ranges(result, 1)) == pytest.approx(np.array([(90, 110)]))
    low, high = 130 - 10 * (1.4**3 - 1.4), 130 + 10 * (1.4**3 - 1.4)
    assert np.array(stable_ranges(result, 2)) == pytest.approx(np.array([(low, 130 + FOLD), (130 - FOLD, high)]))


def test_coexisting_motions(result: xr.Dataset) -> None:
    found = coexisting(result)
    low, high = 130 - 10 * (1.4**3 - 1.4), 130 + 10 * (1.4**3 - 1.4)
    spans = [(low, 130 - FOLD), (130 - FOLD, 130 + FOLD), (130 + FOLD, high)]
    assert np.array([span for span, _ in found]) == pytest.approx(np.array(spans))
    assert [here for _, here in found] == [[0, 2], [0, 2, 2], [0, 2]]


def test_where_nothing_is_stable(result: xr.Dataset) -> None:
    assert without_stable(result) == []
    main = result.isel(point=result.branch.values == 0, bifurcation=result.on_branch.values == 0)
    assert np.array(without_stable(main)) == pytest.approx(np.array([(90.0, 110.0)]))
    middle = main.isel(point=(main.value.values > 91) & (main.value.values < 109), bifurcation=[])
    assert np.array(without_stable(middle)) == pytest.approx(np.array([(92.0, 108.0)]))


def test_motions_at_a_speed(result: xr.Dataset) -> None:
    found = solutions_at(result, 99.3)
    assert found.branch.values.tolist() == [0, 1]
    assert found.stable.values.tolist() == [False, True]
    assert found.speed.values == pytest.approx([99.3, 99.3])
    half = np.abs(found.torque.sel(order=1.5, element="dmf").values)
    assert half == pytest.approx([0.0, 60 * np.sqrt(9.3 * 10.7)], rel=3e-3)  # the branch is taken as straight in a step
    third = np.abs(found.torque.sel(order=3.0, element="dmf").values)
    assert third == pytest.approx([400 - 2 * 49.3, 300.0])


def test_motions_at_a_computed_point_are_not_told_twice(result: xr.Dataset) -> None:
    assert solutions_at(result, 60.0).branch.values.tolist() == [0]
    assert solutions_at(result, 130.0).branch.values.tolist() == [0, 2, 2, 2]
    assert solutions_at(result, 50.0).branch.values.tolist() == [0]
    assert solutions_at(result, 150.0).branch.values.tolist() == [0]


def test_no_motion_outside(result: xr.Dataset) -> None:
    found = solutions_at(result, 151.0)
    assert found.sizes["point"] == 0
    assert set(found.data_vars) == set(result.data_vars)


def test_bifurcations_lie_on_their_branches(result: xr.Dataset) -> None:
    points = bifurcation_points(result)
    assert result.branch.values[points].tolist() == result.on_branch.values.tolist()
    assert np.abs(result.value.values[points] - result.bifurcation_value.values).max() < 2.0
    folds = np.abs(result.torque.sel(order=3.0, element="dmf").values[points[2:]])
    assert folds == pytest.approx([600 - 100 / np.sqrt(3), 600 + 100 / np.sqrt(3)], abs=5.0)


def test_stage_shares_of_a_sine() -> None:
    """A sine of amplitude 2 about the edge of a stage at 1: in it for the share arccos(−(1 − c)/2)/π of the time."""
    law = Hinges.staged([(100.0, 100.0), (1000.0, 400.0)], stop_stiffness=1e6)
    angle = 0.5 + 2 * np.cos(np.linspace(0, 2 * np.pi, 36000, endpoint=False))
    shares = stage_shares(law, angle)
    coast, drive = np.arccos(1.5 / 2) / np.pi, np.arccos(0.5 / 2) / np.pi
    assert list(shares) == ["stage 2, coast", "stage 1", "stage 2"]
    assert list(shares.values()) == pytest.approx([coast, 1 - coast - drive, drive], abs=1e-4)
    assert sum(shares.values()) == pytest.approx(1.0)


def test_stages_of_laws_without_stages() -> None:
    assert stage_parts(None, np.zeros(2)) == ["linear", "linear"]
