"""The region of sub-harmonic vibration: its boundary as curves, the speeds between them, the closer look."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from tests.synthetic_branches import region

from torsional.quantities.region import boundary_curves, crossings, smooth, stretches
from torsional.studies.subharmonic import closer_grid, round_steps, within
from torsional.units import RPM


@pytest.fixture
def found() -> xr.Dataset:
    return region()


def test_curves_pass_through_their_points_and_between_them(found: xr.Dataset) -> None:
    """The boundary in closed form is an ellipse; a chord between its 41 points would be off by 3e-3 of its size."""
    kinds, curves = zip(*boundary_curves(found), strict=True)
    assert kinds == ("fold", "period doubling")
    assert curves[0][-1] == pytest.approx(curves[1][0])
    for curve in curves:
        radius = np.hypot((curve[:, 0] - 95) / 20, (curve[:, 1] - 1100) / 200)
        assert radius == pytest.approx(1.0, abs=5e-5)


def test_short_and_repeated_points_are_kept() -> None:
    assert smooth(np.array([[1.0, 2.0]])).tolist() == [[1.0, 2.0]]
    twice = np.array([[0.0, 0.0], [1.0, 1.0], [1.0, 1.0], [2.0, 0.0]])
    assert smooth(twice)[[0, -1]] == pytest.approx(np.array([[0.0, 0.0], [2.0, 0.0]]))


def test_a_torque_crosses_the_boundary_twice(found: xr.Dataset) -> None:
    half = 20 * np.sqrt(1 - (50 / 200) ** 2)
    assert np.sort(crossings(found, 1150.0)) == pytest.approx([95 - half, 95 + half], abs=2e-3)
    assert crossings(found, 1350.0).size == 0


def test_stretches_end_at_the_boundary_and_not_at_the_grid(found: xr.Dataset) -> None:
    row = int(np.flatnonzero(found.mean_torque.values == 1150.0)[0])
    ((columns, low, high),) = stretches(found, row)
    half = 20 * np.sqrt(1 - (50 / 200) ** 2)
    assert (low, high) == pytest.approx((95 - half, 95 + half), abs=2e-3)
    assert (found.amplitude.values[row, columns] > 0).all()
    bare = found.isel(boundary_point=[])
    ((columns, low, high),) = stretches(bare, row)
    assert (low, high) == (found.speed.values[columns][0], found.speed.values[columns][-1])


def test_a_region_is_looked_at_closely_at_round_values(found: xr.Dataset) -> None:
    closer = closer_grid(found)
    assert closer is not None
    speeds, torques = closer
    assert speeds[0] < 75 < 115 < speeds[-1]
    assert torques[0] < 900 < 1300 < torques[-1]
    assert np.diff(torques) == pytest.approx(25.0)
    assert np.diff(speeds / RPM) == pytest.approx(20.0)
    assert speeds / RPM == pytest.approx(np.round(speeds / RPM))


def test_nothing_is_not_looked_at_closely(found: xr.Dataset) -> None:
    assert closer_grid(found.assign(amplitude=0 * found.amplitude).isel(boundary_point=[])) is None
    assert round_steps(0.0, 1.0, 2).tolist() == [0.0, 1.0]


def test_what_lies_above_full_load_is_left_out(found: xr.Dataset) -> None:
    reached = found.mean_torque < 1100 + 0 * found.speed
    kept = within(found.assign(within_full_load=reached))
    assert float(kept.amplitude.where(~reached).max()) == 0
    assert float(kept.amplitude.where(reached).max()) == float(found.amplitude.where(reached).max()) > 0
    assert kept.boundary_speed.equals(found.boundary_speed)
