"""Coupled designs through the array-API standard: the same elimination on whole arrays, for accelerators.

A backend is a namespace of the standard (https://data-apis.org/array-api): NumPy, JAX, CuPy.  The compiled kernel is
the reference and the default; on processors it is the faster one.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.elimination.coupling import CoupledPlan, Rest, Values
from torsional.numerics.elimination.steps import COUPLING_LIMIT, GROWTH_LIMIT, ROOT_LIMIT

NAMES = ("numpy", "jax", "cupy")
Tables = Mapping[str, Any]


@dataclass(frozen=True)
class Backend:
    """A namespace of arrays, how its functions are compiled, and how its arrays come back."""

    arrays: Any
    compiled: Callable[[Callable[..., Any]], Callable[..., Any]]
    back: Callable[[Any], np.ndarray]

    def solve(
        self, plan: CoupledPlan, rest: Rest, values: Values, inertia: Array
    ) -> tuple[ComplexArray, NDArray[np.bool_]]:
        """As `CoupledPlan.solve`, to rounding; connections with more than two nodes lose what their row sums cancel."""
        each = {"k": values[0], "eta": values[1], "c": values[2], "lift": values[3], "J": inertia}
        shared = {
            "omega": rest.frequencies[0],
            "speed": rest.frequencies[1],
            "slots": rest.slots,
            "loads": rest.loads.T,
            "transfers": rest.transfers,
            "offsets": rest.offsets,
        }
        work = self._work(plan, rest.route.loads.tobytes())
        tables = {name: self.arrays.asarray(np.ascontiguousarray(table)) for name, table in (each | shared).items()}
        y, flagged = work(tables)
        return self.back(y), self.back(flagged) | ~rest.sound

    def _work(self, plan: CoupledPlan, loads: bytes) -> Callable[[Tables], tuple[Any, Any]]:
        key = id(self.arrays), plan, loads
        if key not in _COMPILED:
            at = np.frombuffer(loads, dtype=np.int64)
            loaded = tuple(node for node, offset in plan.tape.layout.loads.items() if offset in at)
            order = tuple(sorted(loaded, key=lambda node: int(np.flatnonzero(at == plan.tape.layout.loads[node])[0])))
            _COMPILED[key] = self.compiled(lambda tables: _solved(self.arrays, plan, order, tables))
        return _COMPILED[key]


_COMPILED: dict[Any, Callable[[Tables], tuple[Any, Any]]] = {}


@cache
def backend(name: str) -> Backend:
    """A backend by its name; raises ModelError for an unknown one and for a library that is not there."""
    if name not in NAMES:
        raise ModelError("there is no such array library", where="backend", found=name, allowed=", ".join(NAMES))
    try:
        if name == "jax":
            import jax

            jax.config.update("jax_enable_x64", True)
            return Backend(jax.numpy, jax.jit, np.asarray)
        if name == "cupy":
            import cupy

            return Backend(cupy, lambda function: function, cupy.asnumpy)
    except ImportError:
        remedy = f"install {name} for your accelerator, or leave the backend out"
        raise ModelError("the array library is not installed", where="backend", found=name, remedy=remedy) from None
    return Backend(np, lambda function: function, np.asarray)


@dataclass
class _Sums:
    """Row sums by node, the squared sizes they were summed from, couplings by pair; arrays (designs or 1, cases)."""

    xp: Any
    rows: dict[int, Any]
    sizes: dict[int, Any]
    couplings: dict[frozenset[int], Any]
    suspect: Any = False

    def add(self, value: Any, weights: Array) -> None:
        """Stamp value × w wᵀ."""
        used = np.flatnonzero(weights).tolist()
        total = weights.sum() if abs(weights.sum()) > 4e-16 * weights.size * abs(weights).sum() else 0.0
        for i in used if total else ():
            self.rows[i] = self.rows[i] + float(weights[i] * total) * value
        for i, j in combinations(used, 2):
            share = float(-weights[i] * weights[j]) * value
            pair = frozenset((i, j))
            self.couplings[pair] = self.couplings[pair] + share if pair in self.couplings else share

    def couple(self, pair: frozenset[int], share: Any) -> None:
        """Add what an elimination couples; suspect where that nearly cancels."""
        total = self.couplings[pair] + share if pair in self.couplings else share
        self.couplings[pair] = total
        self.suspect = self.suspect | (_squared(self.xp, total) < COUPLING_LIMIT * _squared(self.xp, share))

    def near(self, node: int) -> dict[int, Any]:
        """Couplings by neighbour of a node that is taken out."""
        pairs = sorted((pair for pair in self.couplings if node in pair), key=sorted)
        return {next(iter(pair - {node})): self.couplings.pop(pair) for pair in pairs}


def _stamped(xp: Any, plan: CoupledPlan, tables: Tables) -> _Sums:
    """What is left of the shared part, and the designs' own factors."""
    layout, slots = plan.tape.layout, tables["slots"]
    zero = slots[0, 0, :][None, :] * 0.0
    sums = _Sums(xp, dict.fromkeys(layout.columns, _complex(xp, zero, zero)), {}, {})
    omega, speed = tables["omega"][None, :], tables["speed"][None, :]
    for f, weights in enumerate(plan.weights.connection[0]):
        k, eta, c, lift = (tables[name][:, f][:, None] for name in ("k", "eta", "c", "lift"))
        sums.add(_complex(xp, k + speed**2 * lift, k * eta + omega * c), weights)
    for m, weights in enumerate(plan.weights.mass[0][: tables["J"].shape[1]]):
        J = tables["J"][:, m][:, None]
        sums.add(_complex(xp, -(omega**2) * J, 0.0 * J * omega), weights)
    for place, node in enumerate(layout.columns):
        sums.sizes[node] = _squared(xp, sums.rows[node]) + slots[place, 2, :][None, :]
        sums.rows[node] = sums.rows[node] + _complex(xp, slots[place, 0, :][None, :], slots[place, 1, :][None, :])
    for place, pair in enumerate(layout.couplings, len(layout.columns)):
        share = _complex(xp, slots[place, 0, :][None, :], slots[place, 1, :][None, :])
        sums.couplings[pair] = sums.couplings[pair] + share if pair in sums.couplings else share
    return sums


def _solved(xp: Any, plan: CoupledPlan, loaded: tuple[int, ...], tables: Tables) -> tuple[Any, Any]:
    """Responses (designs, outputs, cases) and which cases are flagged."""
    sums = _stamped(xp, plan, tables)
    load = {node: tables["loads"][place, :][None, :] for place, node in enumerate(loaded)}
    growth: Any = 0.0
    undo: list[tuple[int, Any, dict[int, Any]]] = []
    for removal in plan.tape.removals:
        i, row = removal.node, sums.rows[removal.node]
        near = sums.near(i)
        pivot = row
        for coupling in near.values():
            pivot = pivot + coupling
        if not near:
            sums.suspect = sums.suspect | ~(_squared(xp, row) > ROOT_LIMIT * sums.sizes[i])
        ways = {j: coupling / pivot for j, coupling in near.items()}
        for j, t in ways.items():
            size = _squared(xp, t)
            growth = growth + size
            sums.rows[j] = sums.rows[j] + t * row
            sums.sizes[j] = sums.sizes[j] + size * sums.sizes[i]
            if i in load:
                load[j] = load[j] + t * load[i] if j in load else t * load[i]
        for j, k in combinations(ways, 2):
            sums.couple(frozenset((j, k)), ways[j] * near[k])
        undo.append((i, pivot, ways))
    return _recovered(xp, _substituted(load, undo), tables), sums.suspect | ~(growth < GROWTH_LIMIT)


def _substituted(load: Mapping[int, Any], undo: list[tuple[int, Any, dict[int, Any]]]) -> dict[int, Any]:
    """x_i = b_i / s + Σ t_j x_j, the last node first."""
    x: dict[int, Any] = {}
    for i, pivot, ways in reversed(undo):
        terms = [load[i] / pivot] if i in load else []
        terms += [t * x[j] for j, t in ways.items() if j in x]
        if terms:
            x[i] = sum(terms[1:], terms[0])
    return x


def _recovered(xp: Any, x: Mapping[int, Any], tables: Tables) -> Any:
    """y = Σ t x + y₀."""
    transfers, offsets, found = tables["transfers"], tables["offsets"], []
    for o in range(offsets.shape[0]):
        total = offsets[o, :][None, :]
        for place, value in x.items():
            total = total + transfers[o, place, :][None, :] * value
        found.append(total)
    return xp.stack(found, axis=1)


def _complex(xp: Any, real: Any, imaginary: Any) -> Any:
    return xp.astype(real, xp.complex128) + 1j * xp.astype(imaginary, xp.complex128)


def _squared(xp: Any, value: Any) -> Any:
    return xp.real(value) ** 2 + xp.imag(value) ** 2
