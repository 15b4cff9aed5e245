"""The arrays that a harmonic balance is made of, and what it needs of the linear part at one value of the parameter."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np

from torsional.numerics.arrays import Array, ComplexArray, IntArray
from torsional.numerics.linear.small import complex_solve


class Balance(NamedTuple):
    """x_h + G_h F̃_h(x) = b_h over H harmonics of ``base_order`` ν and m connections; n = m (2H + 1) unknowns.

    Unknowns: the m means, then for each harmonic the m real and the m imaginary parts, X_h being complex 0-peak.  The
    continued parameter p is the speed Ω [rad/s] where ``by_speed`` is 1; else Ω is ``fixed_speed``.  The load is a
    cubic in p between ``breaks``, with coefficients (intervals, 4, …), lowest power first, of p less the break.

    ``poles`` (2, K) are −Re λ and Im λ, ``left`` (2, m, K) real and imaginary parts of ψ, ``pairs`` (2, m², K) those of
    ψ ψᵀ: G_h = Σ_k ψ_k ψ_kᵀ / (ihνΩ − λ_k), with ``modal_load`` (2, intervals, 4, H + 1, K).  Without poles
    ``matrices`` (M, C, K, H, S; each N × N), ``weights`` (m, N) and ``node_load`` (intervals, 4, H + 1, N) do, a solve
    for each harmonic.  ``loaded`` (H + 1,) is 1 where a harmonic is excited.
    ``static`` (m, m) and ``static_load`` (intervals, 4, m): harmonic 0.
    ``reference_stiffness``, ``reference_damping`` (m,) are in the linear part and taken off the laws.
    ``law_values`` from ``law_start`` on are a law's parameters; ``address`` 0 means hinges; ``remembers`` a memory.
    ``half_orders``: how many odd multiples of ν/2 the test for period doublings takes, H + 1 at most.
    ``table``: `scan_table` of the motion.  ``scale`` (n + 1,) divides the unknowns and p.
    """

    base_order: float
    fixed_speed: float
    by_speed: int
    breaks: Array
    poles: Array
    left: Array
    pairs: Array
    modal_load: Array
    matrices: Array
    weights: Array
    node_load: ComplexArray
    loaded: IntArray
    static: Array
    static_load: Array
    reference_stiffness: Array
    reference_damping: Array
    law_values: Array
    law_start: IntArray
    address: IntArray
    remembers: IntArray
    half_orders: int
    table: Array
    scale: Array


@numba.njit(cache=True, error_model="numpy")
def interval(breaks: Array, p: float) -> int:
    """Number of the piece of the load that p lies in; the end pieces go on beyond their ends."""
    low, high = 0, breaks.size - 2
    while low < high:
        middle = (low + high + 1) // 2
        if p >= breaks[middle]:
            low = middle
        else:
            high = middle - 1
    return low


@numba.njit(cache=True, error_model="numpy")
def static_part(balance: Balance, p: float, b: ComplexArray, db: ComplexArray) -> None:
    """Harmonic 0 of b and its derivative by p."""
    at = interval(balance.breaks, p)
    d, c = p - balance.breaks[at], balance.static_load[at]
    for e in range(c.shape[1]):
        b[0, e] = c[0, e] + d * (c[1, e] + d * (c[2, e] + d * c[3, e]))
        db[0, e] = c[1, e] + d * (2.0 * c[2, e] + 3.0 * d * c[3, e])


# The sums below take whole arrays and indices: a view of an array costs more here than a sum over its entries.


@numba.njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc", "nsz"})
def _distances(poles: Array, omega: float, inverse: Array) -> None:
    """1/(iω − λ_k), real and imaginary parts (2, K)."""
    for k in range(poles.shape[1]):
        x, y = poles[0, k], omega - poles[1, k]
        size = 1.0 / (x * x + y * y)
        inverse[0, k], inverse[1, k] = x * size, -y * size


@numba.njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc", "nsz"})
def _summed(pairs: Array, row: int, inverse: Array) -> tuple[complex, complex]:
    """Σ r_k inv_k and Σ r_k inv_k² of the residues in one row."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    for k in range(inverse.shape[1]):
        x, y = inverse[0, k], inverse[1, k]
        u, v = pairs[0, row, k] * x - pairs[1, row, k] * y, pairs[0, row, k] * y + pairs[1, row, k] * x
        a += u
        b += v
        c += u * x - v * y
        d += u * y + v * x
    return complex(a, b), complex(c, d)


@numba.njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc", "nsz"})
def _loaded_sums(
    left: Array, load: Array, d: float, e: int, piece: int, h: int, inverse: Array
) -> tuple[complex, complex, complex]:
    """Σ ψ_k u_k inv_k, Σ ψ_k u_k inv_k² and Σ ψ_k u'_k inv_k for connection e, the load u being a cubic in d."""
    a, b, c, s, f, g = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(inverse.shape[1]):
        x, y = inverse[0, k], inverse[1, k]
        p, q = left[0, e, k] * x - left[1, e, k] * y, left[0, e, k] * y + left[1, e, k] * x
        r1, r2, r3 = load[0, piece, 1, h, k], load[0, piece, 2, h, k], load[0, piece, 3, h, k]
        i1, i2, i3 = load[1, piece, 1, h, k], load[1, piece, 2, h, k], load[1, piece, 3, h, k]
        re, im = (
            load[0, piece, 0, h, k] + d * (r1 + d * (r2 + d * r3)),
            load[1, piece, 0, h, k] + d * (i1 + d * (i2 + d * i3)),
        )
        u, v = p * re - q * im, p * im + q * re
        a += u
        b += v
        c += u * x - v * y
        s += u * y + v * x
        re, im = r1 + d * (2.0 * r2 + 3.0 * d * r3), i1 + d * (2.0 * i2 + 3.0 * d * i3)
        f += p * re - q * im
        g += p * im + q * re
    return complex(a, b), complex(c, s), complex(f, g)


@numba.njit(cache=True, error_model="numpy")
def receptances_at(balance: Balance, orders: Array, speed: float, g: ComplexArray, dg: ComplexArray) -> None:
    """G (orders, m, m) at each of the orders, and its derivative by the speed."""
    m, pairs, inverse = g.shape[1], balance.pairs, np.empty_like(balance.poles)
    for i in range(orders.size):
        if inverse.size == 0:
            rest = np.zeros((0, balance.weights.shape[1]), dtype=np.complex128)
            _solved(balance, orders[i], speed, rest, g[i], dg[i], np.zeros((2, 0), dtype=np.complex128))
            continue
        _distances(balance.poles, orders[i] * speed, inverse)
        for e in range(m):
            for f in range(e + 1):
                value, square = _summed(pairs, e * m + f, inverse)
                g[i, e, f] = g[i, f, e] = value
                dg[i, e, f] = dg[i, f, e] = complex(0.0, -orders[i]) * square


@numba.njit(cache=True, error_model="numpy")
def harmonic_parts(
    balance: Balance, p: float, speed: float, g: ComplexArray, dg: ComplexArray, b: ComplexArray, db: ComplexArray
) -> None:
    """G_h, b_h of h = 1 … H and their derivatives by the parameter."""
    at = interval(balance.breaks, p)
    d, m, inverse = p - balance.breaks[at], g.shape[1], np.empty_like(balance.poles)
    pairs, left, load, loaded = balance.pairs, balance.left, balance.modal_load, balance.loaded
    for h in range(1, g.shape[0]):
        order = h * balance.base_order
        if inverse.size == 0:
            _solved_loaded(balance, order, speed, h, at, d, g, dg, b, db)
            continue
        _distances(balance.poles, order * speed, inverse)
        turn = complex(0.0, -order * balance.by_speed)
        for e in range(m):
            for f in range(e + 1):
                value, square = _summed(pairs, e * m + f, inverse)
                g[h, e, f] = g[h, f, e] = value
                dg[h, e, f] = dg[h, f, e] = turn * square
            b[h, e] = db[h, e] = 0.0
            if loaded[h]:
                value, square, rise = _loaded_sums(left, load, d, e, at, h, inverse)
                b[h, e], db[h, e] = value, rise + turn * square


@numba.njit(cache=True, error_model="numpy")
def _solved_loaded(
    balance: Balance,
    order: float,
    speed: float,
    h: int,
    at: int,
    d: float,
    g: ComplexArray,
    dg: ComplexArray,
    b: ComplexArray,
    db: ComplexArray,
) -> None:
    """`harmonic_parts` by a solve with the load and its derivative as further columns."""
    c = balance.node_load[at, :, h]
    columns = np.empty((2, c.shape[1]), dtype=np.complex128)
    columns[0] = c[0] + d * (c[1] + d * (c[2] + d * c[3]))
    columns[1] = c[1] + d * (2.0 * c[2] + 3.0 * d * c[3])
    answer = np.zeros((2 * g.shape[1], 2), dtype=np.complex128)
    _solved(balance, order, speed, columns, g[h], dg[h], answer)
    m = g.shape[1]
    b[h] = answer[:m, 0]
    db[h] = answer[:m, 1]
    if balance.by_speed == 1:
        db[h] += answer[m:, 0]
    else:
        dg[h] = 0.0


@numba.njit(cache=True, error_model="numpy")
def _solved(
    balance: Balance,
    order: float,
    speed: float,
    columns: ComplexArray,
    g: ComplexArray,
    dg: ComplexArray,
    answer: ComplexArray,
) -> None:
    """G = W Z⁻¹ Wᵀ and −W Z⁻¹ Z' Z⁻¹ Wᵀ; the same of further ``columns`` into (value; slope) of ``answer``."""
    mass, damping, stiffness = balance.matrices[0], balance.matrices[1], balance.matrices[2]
    hysteresis, lift = balance.matrices[3], balance.matrices[4]
    omega, n, m = order * speed, mass.shape[0], g.shape[0]
    z = stiffness + speed * speed * lift - omega * omega * mass + 1j * (omega * damping + hysteresis)
    dz = 2.0 * speed * lift - 2.0 * omega * order * mass + 1j * order * damping
    extra = columns.shape[0]
    x = np.zeros((n, m + extra), dtype=np.complex128)
    x[:, :m] = balance.weights.T
    x[:, m:] = columns.T
    complex_solve(z.copy(), x)
    slope = -(dz @ x)
    complex_solve(z, slope)
    w = balance.weights.astype(np.complex128)
    value, rise = w @ x, w @ slope
    g[:] = value[:, :m]
    dg[:] = rise[:, :m]
    if extra:
        answer[:m] = value[:, m:]
        answer[m:] = rise[:, m:]
