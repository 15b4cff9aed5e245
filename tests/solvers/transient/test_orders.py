"""Orders over the crank angle, root mean squares, and what a long run is told to be."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from torsional.errors import ModelError
from torsional.numerics.stepping.stroboscopic import repeats
from torsional.solvers.transient.character import dimension, named
from torsional.solvers.transient.orders import order_tracking, windowed_rms
from torsional.solvers.transient.speed_profile import SpeedProfile


def run_up(fast: float = 40.0) -> tuple[xr.DataArray, xr.DataArray]:
    """Order 1.5 of a falling and order 3 of a constant amplitude over a run-up."""
    t = np.arange(0.0, 3.0, 2e-4)
    alpha = SpeedProfile.ramp(60.0, 60.0 + 3.0 * fast, 3.0).angle(t)
    signal = (2.0 - 0.5 * t) * np.cos(1.5 * alpha + 0.4) + 0.7 * np.sin(3 * alpha)
    coords = {"time": t}
    return xr.DataArray(signal, dims="time", coords=coords), xr.DataArray(alpha, dims="time", coords=coords)


def test_orders_of_a_run_up_do_not_smear() -> None:
    signal, alpha = run_up()
    found = order_tracking(signal, alpha, [1.5, 3.0, 6.0])
    expected = (2.0 - 0.5 * found.time) * np.exp(0.4j)
    np.testing.assert_allclose(found.sel(order=1.5).values, expected.values, rtol=0.02)
    np.testing.assert_allclose(found.sel(order=3.0).values, -0.7j, atol=0.03)
    assert float(abs(found.sel(order=6.0)).max()) < 0.01


def test_the_same_over_time_would_smear() -> None:
    signal, alpha = run_up()
    mean = float(alpha.diff("time").mean()) * 1.0
    even = xr.DataArray(np.arange(alpha.size) * mean, dims="time", coords=alpha.coords)
    found = order_tracking(signal, even, [1.5, 3.0])
    assert float(abs(found.sel(order=3.0)).min()) < 0.35


def test_a_window_of_hann_keeps_phase_and_amplitude() -> None:
    t = np.arange(0.0, 2.0, 5e-4)
    alpha = xr.DataArray(80.0 * t, dims="time", coords={"time": t})
    signal = (1.0 + 0.5 * np.cos(3 * alpha + 1.0)).expand_dims(node=["a"])
    found = order_tracking(signal, alpha, [0.0, 3.0], cycles=2, window="hann", overlap=0.5)
    assert found.dims == ("time", "node", "order")
    np.testing.assert_allclose(found.sel(order=3.0).values, 0.5 * np.exp(1j), atol=1e-6)
    np.testing.assert_allclose(found.sel(order=0.0).values, 1.0, atol=1e-6)


@pytest.mark.parametrize(
    "orders, settings, told",
    [
        ([0.25], {}, "whole periods"),
        ([3.0], {"window": "hann"}, "no such window"),
        ([3.0], {"cycles": 90}, "shorter than one window"),
    ],
)
def test_windows_that_cannot_be_are_refused(orders: list[float], settings: dict[str, object], told: str) -> None:
    with pytest.raises(ModelError, match=told):
        order_tracking(*run_up(), orders, **settings)  # type: ignore[arg-type]


def test_root_mean_square_is_about_the_mean() -> None:
    t = np.arange(0.0, 1.0, 1e-3)
    signal = xr.DataArray(5.0 + 2.0 * np.sin(2 * np.pi * 20 * t), dims="time", coords={"time": t})
    np.testing.assert_allclose(windowed_rms(signal, 0.25).values, np.sqrt(2.0), rtol=1e-9)
    with pytest.raises(ModelError, match="no such window"):
        windowed_rms(signal, 1e-4)


# --- character ---


def test_a_spiral_is_not_taken_for_several_periods() -> None:
    turn = np.exp(-0.05 + 2j * np.pi * 0.2003)  # nearly five periods a turn, dying away
    z = turn ** np.arange(48)
    points = np.stack([z.real, z.imag], axis=1)
    assert repeats(points, 1.0, 8, 0.05)[0] == 0
    still = turn ** np.arange(600)
    assert repeats(np.stack([still.real, still.imag], axis=1), 1.0, 8, 1e-6)[0] == 1


def test_an_alternation_that_dies_out_is_not_taken_for_two_periods() -> None:
    """A multiplier of −0.99: after two periods it is within 2 % of its distance to the end, which is that of one."""
    points = 0.1 * (-0.99) ** np.arange(2000)[:, None]
    told = [repeats(points[:count], 1.0, 8, 1e-5)[0] for count in range(40, 2000, 32)]
    assert set(told) == {0, 1} and told == sorted(told)
    assert told[30] == 1  # 0.1·0.99¹⁰⁰⁰ = 4e-6
    lasting = points + 0.003 * np.array([1.0, -1.0] * 1000)[:, None]
    assert repeats(lasting[:1200], 1.0, 8, 1e-5)[0] == 2


@pytest.mark.parametrize("period", [1, 2, 3, 5, 8])
def test_periods_are_counted(period: int) -> None:
    points = np.tile(np.random.default_rng(1).standard_normal((period, 3)), (20, 1))
    assert repeats(points, 1.0, 8, 1e-9) == (period, 0.0)


def test_dimensions_of_known_sets() -> None:
    random = np.random.default_rng(2)
    curve = 2 * np.pi * 0.6180339887 * np.arange(1500)
    assert dimension(np.stack([np.cos(curve), 2 * np.sin(curve)], axis=1)) == pytest.approx(1.0, abs=0.05)
    assert dimension(random.random((1500, 2))) == pytest.approx(1.9, abs=0.1)
    x = np.zeros((2000, 2))
    x[0] = 0.1
    for i in range(1, len(x)):  # Hénon's map, whose correlation dimension is 1.21 to 1.25
        x[i] = 1.0 - 1.4 * x[i - 1, 0] ** 2 + x[i - 1, 1], 0.3 * x[i - 1, 0]
    assert dimension(x[100:]) == pytest.approx(1.22, abs=0.06)


def test_names_of_motions() -> None:
    assert named(1, 1e-7, np.nan, np.nan, True).kind == "periodic"
    assert "after 3 periods" in named(3, 1e-7, np.nan, np.nan, True).words
    assert named(0, 0.3, 0.65, np.nan, False).kind == "chaotic"
    assert named(0, 0.3, 1e-4, 1.02, False).kind == "quasi-periodic"
    assert named(0, 0.3, -0.2, np.nan, False).kind == "unsettled"


def test_a_crank_that_does_not_turn_is_refused_with_where_its_angle_is() -> None:
    """In a scenario that starts from rest the frame stands, and all of the rotation is the crank's own."""
    signal, alpha = run_up()
    with pytest.raises(ModelError, match=r"the crank does not turn; .*crank_angle_of\(run, node\)"):
        order_tracking(signal, 0.0 * alpha, [3.0])
    with pytest.raises(ModelError, match="stands or turns back"):
        order_tracking(signal, -alpha, [3.0])
