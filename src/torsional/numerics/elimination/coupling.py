"""Receptance coupling: of many designs that differ in a few factors, all that they share is eliminated once.

What is left of the shared part at each frequency is a row sum and a load at every node that the varied factors touch,
and couplings between those; beside these the varied factors are stamped and eliminated design by design, in lanes of
the same kernel.  In row-sum form the reduction of the shared part adds stiffnesses and subtracts none, as in `plan`.
"""
# mypy: disable-error-code="untyped-decorator, no-any-return"

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from torsional.numerics.arrays import Array, ComplexArray, IntArray
from torsional.numerics.elimination.job import Weights, checked, eliminated, part_of, prepared
from torsional.numerics.elimination.order import Removal, removals, supports
from torsional.numerics.elimination.route import Route, build_route
from torsional.numerics.elimination.steps import COUPLING_LIMIT, GROWTH_LIMIT
from torsional.numerics.elimination.tape import Tape, build_tape

_BATCH_CASES = 8_000  # solved at once, few enough to stay in the cache
Values = tuple[Array, Array, Array, Array]
"""Stiffness, loss factor, damping, centrifugal stiffness; connections on the last axis."""


class Rest(NamedTuple):
    """What is left of the shared part over the cases: ``slots`` (slots, 3, cases) for the kernel, ``loads`` (cases,
    loaded), each output as ``transfers`` (outputs, kept, cases) of the kept nodes plus ``offsets`` (outputs, cases);
    ``sound`` (cases,): where its own elimination is to be trusted."""

    slots: Array
    loads: ComplexArray
    transfers: ComplexArray
    offsets: ComplexArray
    sound: NDArray[np.bool_]
    frequencies: tuple[Array, Array]
    route: Route

    def at(self, cases: IntArray) -> Rest:
        """Some of the cases."""
        if len(cases) == self.sound.size:
            return self
        omega, speed = self.frequencies
        some = self.slots[..., cases], self.loads[cases], self.transfers[..., cases], self.offsets[..., cases]
        return Rest(*some, self.sound[cases], (omega[cases], speed[cases]), self.route)


@dataclass(frozen=True, eq=False)
class CoupledPlan:
    """The elimination of one topology for designs that differ in ``connections`` and ``masses`` (places of factors).

    Connections with more than two nodes count as varied: their share cannot be told by row sums and couplings without
    loss.  ``kept``: the nodes that these factors touch.
    """

    connections: IntArray
    masses: IntArray
    kept: tuple[int, ...]
    shared: tuple[Array, Array, IntArray, IntArray]  # weights of the other connections and masses, and their places
    order: tuple[Removal, ...]
    tape: Tape
    weights: Weights

    @classmethod
    def build(
        cls, connection_weights: Array, mass_weights: Array, connections: Sequence[int], masses: Sequence[int]
    ) -> CoupledPlan:
        """Plan for weights (connections, n) and (masses, n) [-] of which the named rows vary, or vary in value."""
        n = connection_weights.shape[1]
        wholes = np.flatnonzero((connection_weights != 0).sum(axis=1) > 2)
        varied = np.union1d(np.asarray(connections, dtype=np.int64), wholes).astype(np.int64)
        heavy = np.unique(np.asarray(masses, dtype=np.int64))
        touched = (connection_weights[varied] != 0).any(axis=0) | (mass_weights[heavy] != 0).any(axis=0)
        kept = tuple(int(i) for i in np.flatnonzero(touched))
        others = np.setdiff1d(np.arange(len(connection_weights)), varied)
        light = np.setdiff1d(np.arange(len(mass_weights)), heavy)
        shared = connection_weights[others], mass_weights[light], others, light
        order = removals(supports(shared[0] != 0), supports(shared[1] != 0), n, kept)
        inner = tuple(removal for removal in order if removal.node not in kept)
        pairs = _left_coupled(shared, inner, kept)
        small = _small(connection_weights[varied], kept), np.vstack([_small(mass_weights[heavy], kept), pairs])
        tape = build_tape(supports(small[0] != 0), supports(small[1] != 0), len(kept))
        return cls(varied, heavy, kept, shared, inner, tape, prepared(tape, small[0][None], small[1][None]))

    def rest(
        self,
        values: Values,
        inertia: Array,
        frequencies: tuple[Array, Array],
        load_nodes: Sequence[int],
        loads: ComplexArray,
        outputs: Sequence[int],
    ) -> Rest:
        """The shared part over cases of ``frequencies`` ω and Ω [rad/s] (cases,) under ``loads`` (cases, load nodes).

        ``values`` and ``inertia`` of all connections and masses, as rows that serve all cases or (cases, …); what is
        varied is not looked at.
        """
        full = _Reduction.of(self.shared, values, inertia, frequencies)
        full.load[:, list(load_nodes)] += loads
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # such cases are not sound
            for removal in self.order:
                full.take_out(removal)
            transfers, offsets = full.recovery(self.order, self.kept, outputs)
        reached = [place for place, node in enumerate(self.kept) if full.load[:, node].any()]
        used = tuple(range(len(self.kept)))
        return Rest(
            self._slots(full),
            full.load[:, [self.kept[place] for place in reached]],
            transfers,
            offsets,
            full.sound,
            frequencies,
            build_route(self.tape, reached, used),
        )

    def _slots(self, full: _Reduction) -> Array:
        """Row sums with their sizes, then couplings, then nothing for connections kept whole."""
        slots = np.zeros((self.tape.slot_row.size, 3, len(full.sums)))
        at = [self.kept[place] for place in self.tape.layout.columns]
        slots[: len(at)] = np.stack([full.sums.real.T[at], full.sums.imag.T[at], full.sizes.T[at]], axis=1)
        for number, pair in enumerate(self.tape.layout.couplings, len(at)):
            i, j = (self.kept[place] for place in pair)
            slots[number, :2] = full.couplings[:, i, j].real, full.couplings[:, i, j].imag
        return slots

    def solve(self, rest: Rest, values: Values, inertia: Array) -> tuple[ComplexArray, NDArray[np.bool_]]:
        """Responses (designs, outputs, cases) at the outputs, and the cases (designs, cases) that must be done anew.

        ``values`` (designs, connections of the plan) and ``inertia`` (designs, masses of the plan) as they vary, or
        one row for all.  A case has the same bits whichever designs are solved beside it.
        """
        nothing = self.weights.mass.shape[1] - inertia.shape[1]  # pairs that the shared part couples have no own value
        heavy = np.hstack([inertia, np.zeros((len(inertia), nothing))])
        job = checked(self.weights, (*values, heavy), rest.frequencies, rest.loads[:, None, :], rest.slots)
        y = np.empty((job.designs, len(rest.offsets), rest.sound.size), dtype=complex)
        flagged = np.empty((job.designs, rest.sound.size), dtype=bool)
        used, size = np.asarray(rest.transfers.any(axis=2)), max(1, _BATCH_CASES // rest.sound.size)
        for first in range(0, job.designs, size):
            part = slice(first, first + size)
            x, flagged[part], _ = eliminated(self.tape, rest.route, part_of(job, part), len(self.kept))
            _recover(x[:, 0], rest.transfers, used, rest.offsets, y[part])
        return y, flagged | ~rest.sound


@dataclass(frozen=True, eq=False)
class _Reduction:
    """Row sums (cases, n), the squared sizes they were summed from, couplings (cases, n, n) and loads, in place."""

    sums: ComplexArray
    sizes: Array
    couplings: ComplexArray
    load: ComplexArray
    inverse: dict[int, ComplexArray]
    growth: Array
    sound: NDArray[np.bool_]

    @classmethod
    def of(
        cls, shared: tuple[Array, Array, IntArray, IntArray], values: Values, inertia: Array, at: tuple[Array, Array]
    ) -> _Reduction:
        """All shared factors stamped over the cases."""
        (springs, bodies, c, m), (omega, speed) = shared, (f[:, None] for f in at)
        k, eta, damping, lift = (np.atleast_2d(table)[:, c] for table in values)
        z = k + speed**2 * lift + 1j * (k * eta + omega * damping)
        y = -(omega**2) * np.atleast_2d(inertia)[:, m]
        weights = np.vstack([springs, bodies])
        z = np.hstack([np.broadcast_to(z, (omega.size, len(c))), np.broadcast_to(y, (omega.size, len(m)))])
        totals = weights.sum(axis=1)
        totals[np.abs(totals) <= 4e-16 * weights.shape[1] * np.abs(weights).sum(axis=1)] = 0.0
        sums = z @ (totals[:, None] * weights)
        couplings = -np.einsum("fe,ei,ej->fij", z, weights, weights, optimize=True)
        return cls(
            sums,
            sums.real**2 + sums.imag**2,
            couplings,
            np.zeros_like(sums),
            {},
            np.zeros(omega.size),
            np.ones(omega.size, dtype=bool),
        )

    def take_out(self, removal: Removal) -> None:
        """s = e_i + Σ a_ij; t_j = a_ij / s; e_j += t_j e_i; b_j += t_j b_i; a_jk += t_j a_ik; t_j stays for a_ij."""
        i, near = removal.node, sorted(removal.neighbours)
        a = self.couplings[:, i, near].copy()
        pivot = 1.0 / (self.sums[:, i] + a.sum(axis=1))
        t = a * pivot[:, None]
        growth = t.real**2 + t.imag**2
        self.sums[:, near] += t * self.sums[:, i, None]
        self.sizes[:, near] += growth * self.sizes[:, i, None]
        self.load[:, near] += t * self.load[:, i, None]
        for p, q in combinations(range(len(near)), 2):
            share = t[:, p] * a[:, q]
            total = self.couplings[:, near[p], near[q]] + share
            self.couplings[:, near[p], near[q]] = self.couplings[:, near[q], near[p]] = total
            self.sound[:] &= abs(total) ** 2 >= COUPLING_LIMIT * abs(share) ** 2
        self.couplings[:, i, near] = t
        self.inverse[i] = pivot
        self.growth[:] += growth.sum(axis=1)
        self.sound[:] &= self.growth < GROWTH_LIMIT  # not where it is no number either

    def recovery(
        self, order: Sequence[Removal], kept: Sequence[int], outputs: Sequence[int]
    ) -> tuple[ComplexArray, ComplexArray]:
        """x of each output as a sum over the kept nodes plus a share of its own: x_i = b_i / s + Σ t_j x_j."""
        cases, n = self.sums.shape
        maps, offsets = np.zeros((n, len(kept), cases), dtype=complex), np.zeros((n, cases), dtype=complex)
        maps[list(kept), range(len(kept))] = 1.0
        for removal in reversed(order):
            i = removal.node
            offsets[i] = self.load[:, i] * self.inverse[i]
            for j in sorted(removal.neighbours):
                maps[i] += self.couplings[:, i, j] * maps[j]
                offsets[i] += self.couplings[:, i, j] * offsets[j]
        return maps[list(outputs)], offsets[list(outputs)]


def _left_coupled(
    shared: tuple[Array, Array, IntArray, IntArray], inner: Sequence[Removal], kept: Sequence[int]
) -> Array:
    """A row with two ones for every pair of kept nodes that the shared part couples."""
    coupled: set[frozenset[int]] = set()
    for support in (*supports(shared[0] != 0), *supports(shared[1] != 0), *(removal.neighbours for removal in inner)):
        coupled |= {frozenset(pair) for pair in combinations(sorted(support), 2)}
    pairs = sorted(tuple(sorted(pair)) for pair in coupled if pair <= set(kept))
    rows = np.zeros((len(pairs), len(kept)))
    for row, pair in zip(rows, pairs, strict=True):
        row[[kept.index(node) for node in pair]] = 1.0
    return rows


def _small(weights: Array, kept: Sequence[int]) -> Array:
    return np.ascontiguousarray(weights[:, list(kept)])


@njit(cache=True, error_model="numpy")
def _recover(
    x: ComplexArray, transfers: ComplexArray, used: NDArray[np.bool_], offsets: ComplexArray, y: ComplexArray
) -> None:
    """y = Σ t x + y₀ for every design, output and case."""
    for d in range(x.shape[0]):
        for o in range(offsets.shape[0]):
            y[d, o] = offsets[o]
            for k in range(x.shape[1]):
                if used[o, k]:
                    y[d, o] += transfers[o, k] * x[d, k]
