"""Exact motion of M q̈ + C q̇ + K q = u(t) + W λ with one-sided springs and contact times, from event to event.

    λ_i = max(0, −k_i (g_i + τ_i ġ_i)),  g = g0 + Wᵀq,  u(t) = u_0 + Re Σ_h u_h exp(ihωt)

Between events the motion is linear: its Taylor series is summed to rounding, and the first place where the polynomial
of some g_i + τ_i ġ_i passes zero ends the stage.  For checks of time steps on small systems; nothing is compiled.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray, IntArray
from torsional.numerics.contacts.step import OneSided

REACH = 0.5  # of a step, in times of the fastest eigenvalue
TERMS = 40
ROUNDING = 4e-16
MOST_EVENTS_AT_ONCE = 100  # contacts that open and close without time passing: the motion does not get on


Flags = NDArray[np.bool_]


class Exact(NamedTuple):
    """Samples at ``times`` (T,) [s]: ``angles``, ``rates`` (T, N), ``forces`` λ (T, n); when (events,) which opened
    (−1 − i) or closed (i)."""

    times: Array
    angles: Array
    rates: Array
    forces: Array
    events: Array
    which: IntArray


@dataclass(frozen=True)
class ExactContacts:
    """The motion of ``mass``, ``damping``, ``stiffness`` (N, N) with ``contacts`` under ``loads`` (H + 1, N) [Nm].

    Loads are complex 0-peak, harmonic h turning with h times ``base_frequency`` ω [rad/s], the first of them constant.
    A negative k is a stage that ends.  Raises ModelError for shapes that do not fit.

    >>> wall = OneSided(np.array([[-1.0]]), np.array([0.1]), np.array([100.0]), np.zeros(1))
    >>> way = ExactContacts([[1.0]], [[0.0]], [[0.0]], wall).run([0.0, 1.0], [0.0], [1.0])
    >>> way.events.round(12), way.which, way.rates[-1].round(12)
    (array([0.1       , 0.41415927]), array([ 0, -1]), array([-1.]))
    """

    mass: ArrayLike
    damping: ArrayLike
    stiffness: ArrayLike
    contacts: OneSided
    loads: ArrayLike = ()
    base_frequency: float = 0.0
    _open: Array = field(init=False, repr=False)
    _push: Array = field(init=False, repr=False)
    _press: Array = field(init=False, repr=False)
    _stages: dict[bytes, tuple[Array, float]] = field(init=False, repr=False, default_factory=dict)

    def __post_init__(self) -> None:
        M, C, K = (np.atleast_2d(np.asarray(a, dtype=float)) for a in (self.mass, self.damping, self.stiffness))
        n, W = len(M), self.contacts.directions
        loads = np.asarray(self.loads, dtype=complex).reshape(-1, n)
        if {M.shape, C.shape, K.shape} != {(n, n)} or W.shape != (n, self.contacts.gap.size):
            raise ModelError("matrices and contacts do not fit", found=f"{M.shape}, {C.shape}, {K.shape}, {W.shape}")
        object.__setattr__(self, "_open", _linear(M, C, K, loads, self.base_frequency))
        push, press = np.zeros((len(self._open), W.shape[1])), np.zeros((W.shape[1], len(self._open)))
        push[n : 2 * n] = np.linalg.solve(M, W) * self.contacts.stiffness
        press[:, :n], press[:, n : 2 * n] = -W.T, -self.contacts.contact_time[:, None] * W.T
        press[:, 2 * n] = -self.contacts.gap
        object.__setattr__(self, "_push", push)
        object.__setattr__(self, "_press", press)

    def run(self, times: ArrayLike, angles: ArrayLike, rates: ArrayLike) -> Exact:
        """Samples at rising times [s], from angles [rad] and rates [rad/s] (N,) at the first of them."""
        grid, n = np.asarray(times, dtype=float), len(np.atleast_2d(np.asarray(self.mass)))
        states, events, which = np.empty((grid.size, len(self._open))), [], []
        z = np.zeros(len(self._open))
        z[:n], z[n : 2 * n], z[2 * n] = angles, rates, 1.0
        closed: Flags = self._press @ self._loaded(z, grid[0]) > 0.0
        states[0] = z
        for i in range(1, grid.size):
            t, at_once = float(grid[i - 1]), 0
            while t < grid[i]:
                step, other = self._step(self._loaded(z, t), closed, float(grid[i]) - t)
                t = float(grid[i]) if step >= grid[i] - t else t + step
                at_once = 0 if step > 0.0 else at_once + 1
                if at_once > MOST_EVENTS_AT_ONCE:
                    raise ModelError("contacts open and close without end", found=f"at {t:g} s")
                if other >= 0:
                    closed[other] = not closed[other]
                    events.append(t)
                    which.append(other if closed[other] else -1 - other)
            states[i] = z
        forces = np.maximum(0.0, states @ self._press.T * self.contacts.stiffness)
        ends = np.array(events), np.array(which, dtype=np.int64)
        return Exact(grid, states[:, :n], states[:, n : 2 * n], forces, *ends)

    def _loaded(self, z: Array, t: float) -> Array:
        """The state with its loads as they are at a time, in place."""
        first = 2 * len(np.atleast_2d(np.asarray(self.mass))) + 1
        turn = self.base_frequency * t * np.arange(1, 1 + (z.size - first) // 2)
        z[first::2], z[first + 1 :: 2] = np.cos(turn), np.sin(turn)
        return z

    def _stage(self, closed: Flags) -> tuple[Array, float]:
        """Matrix A of ż = A z and the longest step of a combination of closed contacts."""
        key = closed.tobytes()
        if key not in self._stages:
            A = self._open + self._push[:, closed] @ self._press[closed]
            fastest = np.abs(np.linalg.eigvals(A)).max()
            self._stages[key] = A, REACH / fastest if fastest > 0.0 else np.inf
        return self._stages[key]

    def _step(self, z: Array, closed: Flags, longest: float) -> tuple[float, int]:
        """Carry z on, in place, to the end of a step or the first event; how far that is, and whose event or −1."""
        A, reach = self._stage(closed)
        step, n = min(reach, longest), len(np.atleast_2d(np.asarray(self.mass)))
        series = [z.copy()]
        for k in range(1, TERMS):
            series.append(A @ series[-1] * (step / k))
            sizes = [np.abs([series[0][part], series[-1][part]]).max(axis=1) for part in (slice(n), slice(n, None))]
            if k > 4 and all(term <= 1e-18 * first for first, term in sizes):
                break
        powers = np.array(series)
        blur = ROUNDING * np.abs(self._press) @ np.abs(z)
        place, which = _first_event(powers @ self._press.T, np.where(closed, 1.0, -1.0), blur)
        z[:] = (place ** np.arange(len(powers))) @ powers
        return place * step, which


def _linear(M: Array, C: Array, K: Array, loads: ComplexArray, omega: float) -> Array:
    """A of ż = A z with all contacts open; z = (q, q̇, 1, cos ωt, sin ωt, cos 2ωt, …)."""
    n, harmonics = len(M), max(len(loads) - 1, 0)
    A = np.zeros((2 * n + 1 + 2 * harmonics,) * 2)
    A[:n, n : 2 * n] = np.eye(n)
    A[n : 2 * n, :n], A[n : 2 * n, n : 2 * n] = -np.linalg.solve(M, K), -np.linalg.solve(M, C)
    moved = np.linalg.solve(M, loads.T)
    for h in range(harmonics + 1) if len(loads) else ():
        cosine = 2 * n + 2 * h - 1
        if h == 0:
            A[n : 2 * n, 2 * n] = moved[:, 0].real
            continue
        A[n : 2 * n, cosine], A[n : 2 * n, cosine + 1] = moved[:, h].real, -moved[:, h].imag
        A[cosine, cosine + 1], A[cosine + 1, cosine] = -h * omega, h * omega
    return A


def _first_event(pressed: Array, side: Array, blur: Array) -> tuple[float, int]:
    """First τ in [0, 1] after which one of the polynomials (terms, n) is off its ``side`` ±1 of zero, and which; 1, −1
    where none is."""
    first, which = 1.0, -1
    reach = np.abs(pressed[1:]).sum(axis=0)
    for i in np.flatnonzero(side * pressed[0] <= reach):
        place = _exit(side[i] * pressed[:, i], float(blur[i]))
        if place < first:
            first, which = place, int(i)
    return first, which


def _exit(p: Array, blur: float) -> float:
    """First place in [0, 1) after which a polynomial, lowest power first, is negative by more than ``blur``; or 2."""
    found = np.polynomial.polynomial.polyroots(np.trim_zeros(np.where(np.abs(p) < 1e-3 * blur, 0.0, p), "b"))
    near = found[(np.abs(found.imag) < 1e-6) & (found.real > 0.0) & (found.real < 1.0)].real
    edges = [0.0, *sorted(near), 1.0]
    for left, right in pairwise(edges):
        if np.polynomial.polynomial.polyval(0.5 * (left + right), p) < -blur:
            return _polished(p, left) if left > 0.0 else 0.0
    return 2.0


def _polished(p: Array, place: float) -> float:
    """A root after two of Newton's steps."""
    slope = np.polynomial.polynomial.polyder(p)
    for _ in range(2):
        change = np.polynomial.polynomial.polyval(place, slope)
        if change != 0.0:
            place -= float(np.polynomial.polynomial.polyval(place, p) / change)
    return min(max(place, 0.0), 1.0)
