"""What a hysteresis loop amounts to: the energy it loses, its stiffness, its loss factor.

A loop is closed: the last point joins the first.  Angles and torques are straight lines between points, for which all
figures here are exact.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from torsional.numerics.arrays import Array


def loss_per_cycle(angle: ArrayLike, torque: ArrayLike) -> Array:
    """Energy [J] a cycle, ∮ T dφ: angles [rad] and torques [Nm] (…, points); positive where energy is lost.

    >>> float(loss_per_cycle([-1.0, 1.0, 1.0, -1.0], [2.0, 2.0, 0.0, 0.0]))
    4.0
    """
    x, y = _closed(angle), _closed(torque)
    return np.asarray(np.sum(0.5 * (y[..., 1:] + y[..., :-1]) * np.diff(x, axis=-1), axis=-1))


def half_swing(angle: ArrayLike) -> Array:
    """Half of the peak-to-peak swing [rad] of angles (…, points)."""
    return np.asarray(0.5 * np.ptp(np.asarray(angle, dtype=float), axis=-1))


def secant_stiffness(angle: ArrayLike, torque: ArrayLike) -> Array:
    """Stiffness [Nm/rad] of the chord between the turning points: torque over angle where the angle turns back.

    >>> float(secant_stiffness([1.0, 0.0, -1.0, 0.0], [10.0, -3.0, -10.0, 3.0]))
    10.0
    """
    x, y = np.broadcast_arrays(np.asarray(angle, dtype=float), np.asarray(torque, dtype=float))
    high, low = (np.expand_dims(pick(x, axis=-1), -1) for pick in (np.argmax, np.argmin))

    def rise(values: Array) -> Array:
        return np.asarray((np.take_along_axis(values, high, -1) - np.take_along_axis(values, low, -1))[..., 0])

    return rise(y) / rise(x)


def harmonic_stiffness(angle: ArrayLike, torque: ArrayLike) -> Array:
    """Stiffness [Nm/rad] of the first harmonic: (1/πA) ∮ T cos τ dτ with φ = φ_m + A cos τ.

    It is the line k φ that fits the torque best where the angle moves as a sine of the same half swing A, whatever
    the pace of the loop.  The angle must turn back only twice.  For a stiffness alone it is that stiffness.

    >>> x = np.cos(np.linspace(0, 2 * np.pi, 200, endpoint=False))
    >>> round(float(harmonic_stiffness(0.1 * x, 1000.0 * 0.1 * x)), 9)
    1000.0
    """
    x, y = _closed(angle), _closed(torque)
    half = half_swing(angle)[..., None]
    middle = 0.5 * (x.max(axis=-1, keepdims=True) + x.min(axis=-1, keepdims=True))
    place = np.clip((x - middle) / half, -1.0, 1.0)
    phase = np.arccos(place)  # each half of the loop goes over 0 … π, the way back with the sign of its direction
    slope = _over(np.diff(y, axis=-1), np.diff(place, axis=-1))
    start = y[..., :-1] - slope * place[..., :-1]
    sine = np.sin(phase)
    first, second = np.diff(sine, axis=-1), np.diff(0.5 * phase + 0.5 * sine * place, axis=-1)
    forward = np.sign(np.diff(phase, axis=-1))
    return np.asarray(np.sum(forward * (start * first + slope * second), axis=-1) / (np.pi * half[..., 0]))


def loss_factor(loss: ArrayLike, stiffness: ArrayLike, amplitude: ArrayLike) -> Array:
    """η = ΔW/(2π W) with the energy W = ½ k A² of the chord between the turning points about their middle.

    ``loss`` ΔW [J] a cycle, ``stiffness`` k of the chord [Nm/rad], ``amplitude`` A half the swing [rad].  After Ungar
    and Kerwin (J. Acoust. Soc. Am. 34 (1962) 954), who divide by the energy stored where the cycle turns: for the
    elliptic loop of k (1 + iη) it is η itself.  Not a number where nothing is stored.

    >>> round(float(loss_factor(np.pi * 0.3 * 1000.0 * 0.1**2, 1000.0, 0.1)), 12)
    0.3
    """
    stored = 0.5 * np.asarray(stiffness, dtype=float) * np.square(np.asarray(amplitude, dtype=float))
    lost, turning = np.broadcast_arrays(np.asarray(loss, dtype=float), 2.0 * np.pi * stored)
    return np.asarray(np.divide(lost, turning, out=np.full(lost.shape, np.nan), where=turning != 0))


def _closed(values: ArrayLike) -> Array:
    given = np.asarray(values, dtype=float)
    return np.concatenate([given, given[..., :1]], axis=-1)


def _over(rise: Array, run: Array) -> Array:
    """Slopes of pieces; a piece along which the angle stands still has none."""
    rise, run = np.broadcast_arrays(rise, run)
    return np.asarray(np.divide(rise, run, out=np.zeros(rise.shape), where=run != 0))
