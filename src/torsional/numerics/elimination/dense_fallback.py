"""Dense solution in twice the working precision, for the few cases that an elimination without pivoting cannot judge.

Numbers are pairs (high, low) of doubles, after Dekker, Numer. Math. 18 (1971) 224, doi:10.1007/BF01397083; complex ones
are four doubles.  Gaussian elimination with row pivoting loses at most as many digits as the system's condition
number has, so that up to 1e16 all digits of a double remain.
"""
# mypy: disable-error-code="untyped-decorator, no-any-return"

from __future__ import annotations

import numpy as np
from numba import njit

from torsional.numerics.arrays import Array, ComplexArray, IntArray
from torsional.numerics.elimination.assembly import weight_sum

Pair = tuple[float, float]
_Quad = tuple[float, float, float, float]

MAGNIFICATION_LIMIT = 1e12
"""Forces inside the system this many times the loads mean a resonance that no damping limits."""

PIVOT_LIMIT = 1e-27
"""Of a pivot this small against its column nothing but rounding is left; 1e-4 Nm/rad beside 1e9 are far above it."""


@njit(error_model="numpy")
def _sum(a: Pair, b: Pair) -> Pair:
    s = a[0] + b[0]
    v = s - a[0]
    e = (a[0] - (s - v)) + (b[0] - v) + (a[1] + b[1])
    high = s + e
    return high, e - (high - s)


@njit(error_model="numpy")
def _split(a: float) -> Pair:
    c = 134217729.0 * a
    high = c - (c - a)
    return high, a - high


@njit(error_model="numpy")
def _product(a: Pair, b: Pair) -> Pair:
    p = a[0] * b[0]
    (ah, al), (bh, bl) = _split(a[0]), _split(b[0])
    e = ((ah * bh - p) + ah * bl + al * bh) + al * bl + (a[0] * b[1] + a[1] * b[0])
    high = p + e
    return high, e - (high - p)


@njit(error_model="numpy")
def _inverse(a: Pair) -> Pair:
    """One Newton step from the double's reciprocal."""
    q = 1.0 / a[0]
    r = _sum((1.0, 0.0), _product((-q, 0.0), a))
    return _sum((q, 0.0), (q * r[0], 0.0))


@njit(error_model="numpy")
def _add(a: _Quad, b: _Quad) -> _Quad:
    re, im = _sum((a[0], a[1]), (b[0], b[1])), _sum((a[2], a[3]), (b[2], b[3]))
    return re[0], re[1], im[0], im[1]


@njit(error_model="numpy")
def _multiply(a: _Quad, b: _Quad) -> _Quad:
    ar, ai, br, bi = (a[0], a[1]), (a[2], a[3]), (b[0], b[1]), (b[2], b[3])
    re = _sum(_product(ar, br), _product((-ai[0], -ai[1]), bi))
    im = _sum(_product(ar, bi), _product(ai, br))
    return re[0], re[1], im[0], im[1]


@njit(error_model="numpy")
def _reciprocal(a: _Quad) -> _Quad:
    ar, ai = (a[0], a[1]), (a[2], a[3])
    q = _inverse(_sum(_product(ar, ar), _product(ai, ai)))
    re, im = _product(ar, q), _product(ai, q)
    return re[0], re[1], -im[0], -im[1]


@njit(error_model="numpy")
def _scale(a: _Quad, factor: float) -> _Quad:
    re, im = _product((a[0], a[1]), (factor, 0.0)), _product((a[2], a[3]), (factor, 0.0))
    return re[0], re[1], im[0], im[1]


@njit(error_model="numpy")
def _quad(row: Array) -> _Quad:
    return row[0], row[1], row[2], row[3]


@njit(error_model="numpy")
def _put(row: Array, a: _Quad) -> None:
    row[0], row[1], row[2], row[3] = a


@njit(error_model="numpy")
def _stamp(Z: Array, weights: Array, value: _Quad) -> None:
    """Add z w wᵀ, the diagonal as row sum less couplings so that a rigid rotation meets exactly no stiffness."""
    total = weight_sum(weights)
    for i in range(weights.size):
        if weights[i] != 0.0:
            own = _scale(value, weights[i])
            _put(Z[i, i], _add(_quad(Z[i, i]), _scale(own, total)))
            for j in range(weights.size):
                if j != i and weights[j] != 0.0:
                    share = _scale(own, weights[j])
                    _put(Z[i, j], _add(_quad(Z[i, j]), share))
                    _put(Z[i, i], _add(_quad(Z[i, i]), _scale(share, -1.0)))


@njit(cache=True, error_model="numpy")
def factor_values(k: Array, h: Array, c: Array, s: Array, J: Array, omega: float, speed: float) -> Array:
    """z of each connection k (1 + iη) + Ω² s + iωc, then −ω² J of each mass."""
    z = np.zeros((k.size + J.size, 4))
    squared, speed_squared = _product((omega, 0.0), (omega, 0.0)), _product((speed, 0.0), (speed, 0.0))
    for f in range(k.size):
        re = _sum((k[f], 0.0), _product(speed_squared, (s[f], 0.0)))
        im = _sum(_product((k[f], 0.0), (h[f], 0.0)), _product((omega, 0.0), (c[f], 0.0)))
        _put(z[f], (re[0], re[1], im[0], im[1]))
    for m in range(J.size):
        re = _product(squared, (-J[m], 0.0))
        _put(z[k.size + m], (re[0], re[1], 0.0, 0.0))
    return z


@njit(error_model="numpy")
def _size(a: Array) -> float:
    return abs(a[0]) + abs(a[2])


@njit(error_model="numpy")
def _largest(Z: Array, column: int, first: int, end: int) -> int:
    """The row with the largest entry of a column; one that is not a number comes first."""
    best = first
    for i in range(first + 1, end):
        if not _size(Z[i, column]) <= _size(Z[best, column]):
            best = i
    return best


@njit(error_model="numpy")
def _reduce(Z: Array, n: int) -> bool:
    """Gaussian elimination with row pivoting of columns 0 … n of Z; False where only rounding is left of a pivot."""
    scale = [_size(Z[_largest(Z, p, 0, n), p]) for p in range(n)]
    for p in range(n):
        best = _largest(Z, p, p, n)
        if not _size(Z[best, p]) > PIVOT_LIMIT * scale[p]:
            return False
        for j in range(p, Z.shape[1]):
            for part in range(4):
                Z[p, j, part], Z[best, j, part] = Z[best, j, part], Z[p, j, part]
        inverse = _scale(_reciprocal(_quad(Z[p, p])), -1.0)
        for i in range(p + 1, n):
            if Z[i, p, 0] != 0.0 or Z[i, p, 2] != 0.0:
                t = _multiply(_quad(Z[i, p]), inverse)
                for j in range(p + 1, Z.shape[1]):
                    _put(Z[i, j], _add(_quad(Z[i, j]), _multiply(t, _quad(Z[p, j]))))
    return True


@njit(error_model="numpy")
def _substitute(Z: Array, n: int) -> None:
    """Back substitution; the solutions replace the right-hand sides."""
    for right in range(n, Z.shape[1]):
        for i in range(n - 1, -1, -1):
            total = _quad(Z[i, right])
            for j in range(i + 1, n):
                total = _add(total, _scale(_multiply(_quad(Z[i, j]), _quad(Z[j, right])), -1.0))
            _put(Z[i, right], _multiply(total, _reciprocal(_quad(Z[i, i]))))


@njit(error_model="numpy")
def _magnification(weights: Array, z: Array, x: Array, load: float) -> float:
    """Largest sum of the magnitudes of all forces at one node, over the largest load."""
    forces = np.zeros(weights.shape[1])
    for f in range(z.shape[0]):
        combined = (0.0, 0.0, 0.0, 0.0)
        for i in range(weights.shape[1]):
            combined = _add(combined, _scale(_quad(x[i]), weights[f, i]))
        force = (abs(z[f, 0]) + abs(z[f, 2])) * (abs(combined[0]) + abs(combined[2]))
        for i in range(weights.shape[1]):
            forces[i] += abs(weights[f, i]) * force
    largest = 0.0
    for force in forces:
        largest = max(largest, force)
    return largest / load if load > 0.0 else 0.0


@njit(cache=True, error_model="numpy")
def solve_dense(weights: Array, z: Array, nodes: IntArray, loads: ComplexArray, x: ComplexArray) -> bool:
    """Solve Σ z w wᵀ x = b for the right-hand sides ``loads`` (rights, nodes) into x (rights, n).

    ``weights`` are (factors, n), z (factors, 4) as ``factor_values`` gives them.  False where the system is singular,
    or so near to it that the forces within exceed the loads a trillion times.
    """
    n, rights = weights.shape[1], loads.shape[0]
    Z = np.zeros((n, n + rights, 4))
    for f in range(z.shape[0]):
        _stamp(Z, weights[f], _quad(z[f]))
    for right in range(rights):
        for i in range(nodes.size):
            Z[nodes[i], n + right, 0], Z[nodes[i], n + right, 2] = loads[right, i].real, loads[right, i].imag
    if not _reduce(Z, n):
        return False
    _substitute(Z, n)
    sound = True
    for right in range(rights):
        load, finite = 0.0, 0.0
        for i in range(nodes.size):
            load = max(load, abs(loads[right, i].real) + abs(loads[right, i].imag))
        for i in range(n):
            x[right, i] = complex(Z[i, n + right, 0], Z[i, n + right, 2])
            finite += 0.0 * (Z[i, n + right, 0] + Z[i, n + right, 2])
        sound = sound and finite == 0.0 and _magnification(weights, z, Z[:, n + right], load) < MAGNIFICATION_LIMIT
    return sound
