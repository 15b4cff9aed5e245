"""Undamped modes from the factors of the matrices, K = Wᵀ diag(k) W and M = Vᵀ diag(J) V, one design or a million.

Neither matrix is ever formed: with M = Rᵀ R the angular frequencies are the singular values of diag(√k) W R⁻¹, and each
keeps its own relative accuracy although stiff cranks and heavy vehicles spread the eigenvalues over 16 decades.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.numerics.linear.null_space import null_vectors
from torsional.numerics.modes.lanes import solve_designs


class Modes(NamedTuple):
    """Angular frequencies ``omega`` (…, modes) [rad/s], ascending, and mass-normalised ``shapes`` (…, nodes, modes)."""

    omega: Array
    shapes: Array


def _structural(weights: Array, values: Array) -> Iterator[tuple[slice | list[int], Array]]:
    """Groups of designs with equally many null vectors, and these: (designs or 1, nodes, count).

    A value of zero takes its row out of the network, so the null space hangs on which values are zero.
    """
    if len(weights) == 1 and np.all(values > 0.0):
        yield slice(None), null_vectors(weights[0])[np.newaxis]
        return
    nulls = [null_vectors(weights[min(d, len(weights) - 1)][values[d] > 0.0]) for d in range(len(values))]
    for count in sorted({null.shape[1] for null in nulls}):
        group = [d for d, null in enumerate(nulls) if null.shape[1] == count]
        yield group, np.stack([nulls[d] for d in group])


def _part(weights: Array, group: slice | list[int]) -> Array:
    return weights if len(weights) == 1 else weights[group]


def _checked(values: ArrayLike, name: str, designs: int) -> Array:
    array = np.array(np.broadcast_to(values, (designs, np.shape(values)[-1])), dtype=float)
    wrong = np.argwhere(~((array >= 0.0) & (array < np.inf)))
    if len(wrong):
        design, row = (int(index) for index in wrong[0])
        place = f"{name}[{design}, {row}]"
        raise ModelError("must be finite and not negative", where=place, found=f"{array[design, row]}")
    return array


def _refuse_massless(mass_weights: Array, inertia: Array) -> None:
    for _, null in _structural(mass_weights, inertia):
        if null.shape[2]:
            moved = [int(node) for node in np.flatnonzero(null[0, :, 0])]
            problem, remedy = "no inertia moves with this motion", "give it inertia or condense it"
            raise ModelError(problem, where=f"coordinates {moved}", remedy=remedy)


def modes(elastic_weights: ArrayLike, stiffness: ArrayLike, mass_weights: ArrayLike, inertia: ArrayLike) -> Modes:
    """Undamped modes of one design or of many: ω² M φ = K φ with K = Wᵀ diag(k) W and M = Vᵀ diag(J) V.

    ``elastic_weights`` W (rows, nodes) and ``mass_weights`` V (masses, nodes), or with a leading axis of designs;
    ``stiffness`` k ≥ 0 (rows,) [Nm/rad] and ``inertia`` J ≥ 0 (masses,) [kg m²], or with a leading axis of designs.
    Returns ``omega`` (…, nodes) [rad/s] ascending and ``shapes`` (…, nodes, modes) with φᵀ M φ = 1 and the largest
    entry of each mode positive.  Rigid modes come first: their number is structural, their frequency exactly zero.
    Raises ModelError for values that are negative or not finite and for a coordinate without inertia.

    Every frequency has its own relative accuracy, about 1e-14.  Sources: see ``torsional.numerics.modes.jacobi``.

    >>> omega, shapes = modes([[-1.0, 1.0]], [12e3], [[1.0, 0.0], [0.0, 1.0]], [1.8, 1.2])
    >>> omega / (2 * np.pi)
    array([ 0.       , 20.5468148])
    """
    w, v = np.array(elastic_weights, dtype=float), np.array(mass_weights, dtype=float)
    single = max(w.ndim - 1, v.ndim - 1, np.ndim(stiffness), np.ndim(inertia)) == 1
    w, v = (a if a.ndim == 3 else a[np.newaxis] for a in (w, v))
    designs = max(len(w), len(v), len(np.atleast_2d(stiffness)), len(np.atleast_2d(inertia)))
    k, J = _checked(stiffness, "stiffness", designs), _checked(inertia, "inertia", designs)
    _refuse_massless(v, J)
    nodes = w.shape[2]
    omega, shapes = np.empty((designs, nodes)), np.empty((designs, nodes, nodes))
    for group, null in _structural(w, k):
        part = omega[group], shapes[group]
        solve_designs(_part(w, group), k[group], _part(v, group), J[group], null, *part)
        if not isinstance(group, slice):  # then the part is a copy
            omega[group], shapes[group] = part
    return Modes(omega[0], shapes[0]) if single else Modes(omega, shapes)
