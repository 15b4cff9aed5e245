"""Amplitude conventions, told apart on signals known in closed form."""

import numpy as np
import pytest
import xarray as xr

import torsional as tv
from torsional import quantities as q
from torsional.errors import ModelError

SPEED = 100.0
ANGLE = xr.DataArray(
    [[2e-3 * np.exp(0.3j), 1e-3 * np.exp(-1.1j)]],
    coords={"speed": [SPEED], "order": [1.5, 3.0]},
    attrs={"units": "rad"},
)


def test_acceleration_is_the_second_derivative() -> None:
    alpha = q.waveform(ANGLE).crank_angle.values
    t = alpha / SPEED
    theta = 2e-3 * np.cos(1.5 * SPEED * t + 0.3) + 1e-3 * np.cos(3 * SPEED * t - 1.1)
    assert np.allclose(q.waveform(ANGLE).values[0], theta, atol=1e-15)
    second = -(150.0**2) * 2e-3 * np.cos(150 * t + 0.3) - 300.0**2 * 1e-3 * np.cos(300 * t - 1.1)
    assert np.allclose(q.waveform(q.acceleration(ANGLE)).values[0], second)
    assert q.acceleration(ANGLE).attrs["units"] == "rad/s²"


def test_the_swing_of_no_signals_is_none() -> None:
    none = xr.DataArray(np.zeros((0, 2), complex), dims=("point", "order"), coords={"order": [1.5, 3.0]})
    assert q.swing(none).shape == (0,)


def test_swing_is_below_the_bound_and_exact_for_one_order() -> None:
    assert float(q.swing(ANGLE)[0]) < float(q.order_sum(ANGLE)[0]) == pytest.approx(3e-3)
    assert float(q.swing(ANGLE.sel(order=[3.0]))[0]) == pytest.approx(1e-3, rel=1e-4)
    assert q.amplitude(ANGLE, 1.5).values == pytest.approx([2e-3])


def test_irregularity_of_one_order() -> None:
    """ω = Ω + A nΩ cos: (ω_max − ω_min)/Ω = 2 A n."""
    assert float(q.irregularity(ANGLE.sel(order=[3.0]))[0]) == pytest.approx(2 * 1e-3 * 3, rel=1e-4)


def test_modes_without_frequency_are_called_what_they_are() -> None:
    """Nothing pulls a pendulum back that nothing spins; an engine behind an open clutch is a whole that turns."""
    hung = {"a": tv.Inertia(1.0), "b": tv.Inertia(2.0), "s": tv.Shaft("a", "b", 1e4)}
    line = tv.assemble(tv.Powertrain({**hung, "p": tv.CentrifugalPendulum("b", 1.0, 0.1, 3.0)}))
    assert q.named_modes(tv.modal(line), {}) == ["rigid rotation", "free p", "s mode"]
    assert q.named_modes(tv.modal(line, 100.0), {}) == ["rigid rotation", "s mode", "p.suspension mode"]
    apart = {**hung, "c": tv.Inertia(2.0), "d": tv.Inertia(1.0), "t": tv.Shaft("c", "d", 2e4)}
    names = q.named_modes(tv.modal(tv.assemble(tv.Powertrain(apart, parts=2))), {})
    assert names == ["rigid rotation", "rigid rotation", "s mode", "t mode"]
    alone = tv.modal(tv.assemble(tv.Powertrain({"a": tv.Inertia(1.0)})))
    assert q.named_modes(alone, {}) == ["rigid rotation"]


def test_order_share_and_missing_order() -> None:
    assert float(q.order_share(ANGLE, 1.5)[0]) == pytest.approx(0.8)
    with pytest.raises(ModelError, match=r"order 4 was not computed; allowed: 1\.5, 3"):
        q.amplitude(ANGLE, 4.0)


def test_third_order_speed() -> None:
    """20 f rpm."""
    assert float(q.order_speed(xr.DataArray([10.0]), 3.0)[0]) * 30 / np.pi == pytest.approx(200.0)
