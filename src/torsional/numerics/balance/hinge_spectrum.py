"""Fourier coefficients of a piecewise-linear law along a periodic motion, exact between the crossings of its hinges.

    x(τ) = x_0 + Re Σ_h X_h exp(ihτ),   f(x) = k0 x + Σ_i s_i Δk_i max(0, s_i (x − g_i))

While hinge i is engaged it adds Δk_i (x − g_i).  With the spectra I_j of the engaged times, closed forms of the
crossing angles, the tangent stiffness has the two-sided spectrum S_j = k0 δ_j + Σ_i Δk_i I_j, and the force is the
convolution of S with x less that of the offsets O_j = Σ_i Δk_i g_i I_j.  The Jacobian by the harmonics is the same
convolution, since the force is continuous at a crossing.  Samples serve only to find the crossings, whose places are
polished by Newton's method.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import numba
import numpy as np

from torsional.numerics.arrays import Array, ComplexArray

TWO_PI = 2.0 * np.pi
CLOSE = 1e-9


def scan_table(harmonics: int, samples: int = 0) -> Array:
    """Table (samples, 1 + 2 harmonics) of 1, cos hτ, −sin hτ: times (x_0, Re X_1, Im X_1, …) it samples a motion.

    The default takes eight samples a period of the highest harmonic, at least 64: a sum of harmonics has no more than
    two extrema a period of its highest one, and extrema between samples are looked for beside.
    """
    wanted = samples or max(64, 8 * harmonics)
    angle = TWO_PI * np.arange(wanted) / wanted
    columns = [np.ones(wanted)]
    for h in range(1, harmonics + 1):
        columns += [np.cos(h * angle), -np.sin(h * angle)]
    return np.ascontiguousarray(np.stack(columns, axis=1))


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def motion(x: Array, tau: float) -> tuple[float, float, float]:
    """Angle, slope and curvature at τ of the motion (x_0, Re X_1, Im X_1, …)."""
    c, s = np.cos(tau), np.sin(tau)
    er, ei, value, slope, curvature = 1.0, 0.0, x[0], 0.0, 0.0
    for h in range(1, x.size // 2 + 1):
        er, ei = er * c - ei * s, er * s + ei * c
        re, im = x[2 * h - 1], x[2 * h]
        term = re * er - im * ei
        value += term
        slope -= h * (re * ei + im * er)
        curvature -= h * h * term
    return value, slope, curvature


@numba.njit(cache=True, error_model="numpy")
def _root(x: Array, gap: float, low: float, high: float, at_low: float, at_high: float) -> float:
    """The crossing of ``gap`` between two angles on either side of it, by Newton's method kept in its bracket."""
    tau = low + (high - low) * at_low / (at_low - at_high)
    for _ in range(60):
        value, slope, _ = motion(x, tau)
        value -= gap
        if (value > 0.0) == (at_high > 0.0):
            high = tau
        else:
            low = tau
        step = -value / slope if slope != 0.0 else np.inf
        following = tau + step
        if not low <= following <= high:
            following = 0.5 * (low + high)
        if abs(following - tau) <= CLOSE:  # the next step would be of the order of its square
            return following
        tau = following
    return tau


@numba.njit(cache=True, error_model="numpy")
def _extremum(x: Array, low: float, high: float) -> float:
    """The angle between two others at which the motion turns; their slopes have opposite signs."""
    rising = motion(x, low)[1] > 0.0
    tau = 0.5 * (low + high)
    for _ in range(60):
        _, slope, curvature = motion(x, tau)
        if (slope > 0.0) == rising:
            low = tau
        else:
            high = tau
        step = -slope / curvature if curvature != 0.0 else np.inf
        following = tau + step
        if not low <= following <= high:
            following = 0.5 * (low + high)
        if abs(following - tau) <= 1e-9:
            return following
        tau = following
    return tau


@numba.njit(cache=True, error_model="numpy")
def _grazed(x: Array, gap: float, before: float, here: float, after: float, middle: float, width: float) -> float:
    """The angle of an extremum that passes the gap unseen by three samples on one side of it, or −1.

    A parabola through them tells whether a closer look is worth it.
    """
    bend = before - 2.0 * here + after
    reach = 0.125 * (after - before) ** 2 / abs(bend) if bend != 0.0 else 0.0
    if abs(here) > 4.0 * reach + 0.25 * abs(bend):
        return -1.0
    low, high = middle - width, middle + width
    if (motion(x, low)[1] > 0.0) == (motion(x, high)[1] > 0.0):
        return -1.0
    turn = _extremum(x, low, high)
    return turn if (motion(x, turn)[0] - gap > 0.0) != (here > 0.0) else -1.0


@numba.njit(cache=True, error_model="numpy")
def crossings(x: Array, samples: Array, gap: float, places: Array, rising: Array) -> int:
    """Angles in [0, 2π) at which the motion passes ``gap``, and whether it rises there; returns their number."""
    size, count = samples.size, 0
    width = TWO_PI / size
    before, here = samples[size - 1] - gap, samples[0] - gap
    for i in range(size):
        after = samples[i + 1 if i + 1 < size else 0] - gap
        if (here > 0.0) != (after > 0.0):
            if count < places.size:
                places[count] = _root(x, gap, i * width, (i + 1) * width, here, after)
                rising[count] = 1.0 if after > 0.0 else 0.0
                count += 1
        elif (before > 0.0) == (here > 0.0) and (here - before) * (after - here) <= 0.0:
            toward = before >= here if here > 0.0 else before <= here
            turn = _grazed(x, gap, before, here, after, i * width, width) if toward else -1.0
            if turn > (i - 1) * width and turn != -1.0 and count + 1 < places.size:
                beyond = motion(x, turn)[0] - gap
                low, high = (i - 1) * width, (i + 1) * width
                places[count] = _root(x, gap, low, turn, motion(x, low)[0] - gap, beyond)
                places[count + 1] = _root(x, gap, turn, high, beyond, motion(x, high)[0] - gap)
                rising[count], rising[count + 1] = (1.0, 0.0) if beyond > 0.0 else (0.0, 1.0)
                count += 2
        before, here = here, after
    return count


@numba.njit(cache=True, error_model="numpy")
def hinge_spectrum(
    law: Array, x: Array, samples: Array, stiffness: ComplexArray, offset: ComplexArray, found: Array
) -> int:
    """Fill the spectra S_j of the ``stiffness`` and O_j of the ``offset``, j ≥ 0, of a law along a motion.

    ``law``: k0, then (g, s, Δk) of each hinge; ``x``: x_0, Re X_1, Im X_1, …; ``samples``: the motion on an even grid
    of τ.  ``found`` (places, 3) takes the crossings as (τ, hinge, rising); their number is returned.
    """
    stiffness[:] = 0.0
    offset[:] = 0.0
    stiffness[0] = law[0]
    low, high, total = samples.min(), samples.max(), 0
    slack = 0.25 * (high - low)
    places, rising = np.empty(2 * x.size), np.empty(2 * x.size)
    for i in range(1, law.size, 3):
        gap, side, change = law[i], law[i + 1], law[i + 2]
        count = 0
        if low - slack < gap < high + slack:
            count = crossings(x, samples, gap, places, rising)
        share = 0.0
        for sample in samples:
            share += side * (sample - gap) > 0.0
        share /= samples.size
        if count:  # exact but for whole turns, which the samples tell
            exact = _engaged(places, rising, count, side, change, gap, stiffness, offset)
            share = exact + np.round(share - exact)
        for c in range(count):
            if total < found.shape[0]:
                found[total, 0], found[total, 1], found[total, 2] = places[c] % TWO_PI, i // 3, rising[c]
                total += 1
        stiffness[0] += change * share
        offset[0] += change * gap * share
    return total


@numba.njit(cache=True, error_model="numpy", fastmath={"contract"})
def _engaged(
    places: Array,
    rising: Array,
    count: int,
    side: float,
    change: float,
    gap: float,
    stiffness: ComplexArray,
    offset: ComplexArray,
) -> float:
    """Add the spectrum of the engaged arcs of a hinge, j ≥ 1; the share of the period they take, but for whole ones."""
    share = 0.0
    for c in range(count):
        leaving = -1.0 if (rising[c] > 0.5) == (side > 0.0) else 1.0
        turn = complex(np.cos(places[c]), -np.sin(places[c]))
        phasor = complex(1.0, 0.0)
        share += leaving * places[c] / TWO_PI
        for j in range(1, stiffness.size):
            phasor *= turn
            term = leaving * change / (TWO_PI * j) * complex(-phasor.imag, phasor.real)
            stiffness[j] += term
            offset[j] += gap * term
    return share
