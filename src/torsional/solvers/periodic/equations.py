"""From a system with laws and a load to the arrays of the compiled harmonic balance."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from torsional.errors import ModelError
from torsional.laws import Law, packed
from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.balance.data import Balance
from torsional.numerics.balance.hinge_spectrum import scan_table
from torsional.numerics.linear.null_space import null_vectors
from torsional.numerics.modes.pole_residues import PoleResidues, pole_residues
from torsional.solvers.periodic.load import Load
from torsional.system import System

MOST_CONNECTIONS = 12
SMOOTH_SAMPLES, REMEMBERING_SAMPLES = 256, 512
TRUSTED = 1e-10
"""Largest relative difference between pole–residue sums and a direct solve before the latter takes over."""
COMPARED = np.array([0.25, 0.5, 1.0, 1.5, 3.0, 6.0, 12.0])
"""Orders at which they are compared."""


@dataclass(frozen=True, eq=False)
class Split:
    """A system parted into a linear one, with reference springs and dampers in place of its laws, and those laws."""

    system: System
    speed: float
    """Mean speed [rad/s] at which switched inertias are settled."""
    kin: Split | None = None
    """A system of the same connections whose references are taken, and its linear part where it is the same."""

    def __post_init__(self) -> None:
        count = len(self.laws)
        if not 1 <= count <= MOST_CONNECTIONS:
            allowed = f"1 to {MOST_CONNECTIONS}"
            raise ModelError(
                "the system has no connection with a law that bends"
                if not count
                else "too many connections have a law",
                found=f"{count} of them",
                allowed=allowed,
                remedy="a linear system is a matter for harmonic_response" if not count else "replace some by springs",
            )
        self._refuse_unsettled()
        if self.kin is not None:
            self.__dict__.update(
                {name: getattr(self.kin, name) for name in ("reference_stiffness", "reference_damping")}
            )
            if self.system.shares_linear_part(self.kin.system):
                self.__dict__.update({name: getattr(self.kin, name) for name in ("matrices", "poles", "rigid")})

    def _refuse_unsettled(self) -> None:
        """A periodic motion has one normal load for each law, and the deviation from the mean rotation alone."""
        c = self.system.connections
        for name, law, load, whole in zip(c.names, c.laws, c.loads, c.whole_speed, strict=True):
            if load is not None:
                remedy = "settle it at one speed: system.loaded(speed, mean torques)"
                raise ModelError("the normal load follows speed, torque or time", where=name, remedy=remedy)
            if whole and law is not None:
                remedy = "leave it out: its mean is part of the mean torque"
                raise ModelError("a law that sees the whole speed has no place here", where=name, remedy=remedy)

    @cached_property
    def places(self) -> tuple[int, ...]:
        """Numbers of the connections with a law."""
        return tuple(i for i, law in enumerate(self.system.connections.laws) if law is not None)

    @cached_property
    def laws(self) -> tuple[Law, ...]:
        """Their laws."""
        return tuple(law for law in self.system.connections.laws if law is not None)

    @cached_property
    def straight(self) -> bool:
        """Whether all laws are straight lines over the angle: crossings, spectra and motions are then exact."""
        return all(law.straight is not None for law in self.laws)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Their names."""
        return tuple(self.system.connections.names[i] for i in self.places)

    @cached_property
    def weights(self) -> Array:
        """Their directions (m, N)."""
        return self.system.connections.weights[list(self.places)]

    @cached_property
    def reference_stiffness(self) -> Array:
        """Reference springs (m,) [Nm/rad]: any positive value gives the same motions; the softest stage is taken.

        A law without slope at rest has none where springs beside it hold its ends together, and friction has none.
        """
        c = self.system.connections
        apart = np.abs(self.weights @ null_vectors(c.weights[c.stiffness > 0])).max(axis=1, initial=0.0) > 1e-12
        return np.array([_reference(law, bool(sole)) for law, sole in zip(self.laws, apart, strict=True)])

    @cached_property
    def reference_damping(self) -> Array:
        """Reference dampers (m,) [Nms/rad], which keep undamped poles off the path."""
        w = self.weights
        length = np.square((w * w).sum(axis=1))
        beside = np.einsum("mi,ij,mj->m", w, self.system.K, w) / np.where(length > 0, length, 1.0)  # locked ends: 0
        return 0.02 / self.speed * np.where(self.reference_stiffness > 0, self.reference_stiffness, beside)

    @cached_property
    def matrices(self) -> Array:
        """M, C, K, H, S (5, N, N), the references in them."""
        s, w = self.system.switched(self.speed), self.weights
        stiff, damp = ((w.T * v) @ w for v in (self.reference_stiffness, self.reference_damping))
        return np.stack([s.M, s.C + damp, s.K + stiff, s.H, s.S])

    @cached_property
    def poles(self) -> PoleResidues | None:
        """Poles and residues, unless the matrices vary with speed, are hysteretic, or poles all but coincide."""
        c, m = self.system.connections, self.system.switched(self.speed).masses
        if (c.loss_factor * c.stiffness).any() or c.centrifugal_stiffness.any():
            return None
        found = pole_residues(
            np.vstack([c.weights, self.weights]),
            np.concatenate([c.stiffness, self.reference_stiffness]),
            np.concatenate([c.damping, self.reference_damping]),
            m.weights,
            m.inertia,
        )
        return found if self._agrees(found, self.weights) else None

    @cached_property
    def _direct(self) -> ComplexArray:
        """Z⁻¹ wᵀ (orders compared, N, m) by a direct solve; not a number where that is singular."""
        mass, damping, stiffness = self.matrices[:3]
        omega = (self.speed * COMPARED)[:, None, None]
        z = stiffness + 1j * omega * damping - omega**2 * mass
        try:
            return np.asarray(
                np.linalg.solve(z, np.broadcast_to(self.weights.T, (len(COMPARED), *self.weights.T.shape)))
            )
        except np.linalg.LinAlgError:
            return np.full((len(COMPARED), *self.weights.T.shape), np.nan, dtype=complex)

    def summed(self, onto: Array) -> PoleResidues | None:
        """The poles, if their sums agree with a direct solve for loads (loads, N) on the coordinates too."""
        found = self.poles
        return found if found and self._agrees(found, onto) else None

    def _agrees(self, found: PoleResidues, onto: Array) -> bool:
        omega = (self.speed * COMPARED)[:, None, None]
        direct = onto @ self._direct
        sums = (onto @ found.shapes.T / (1j * omega - found.poles)) @ (self.weights @ found.shapes.T).T
        return bool((np.abs(sums - direct) <= TRUSTED * np.abs(direct).max(axis=2, keepdims=True)).all())

    @cached_property
    def rigid(self) -> Array:
        """Rotations (N, r) that no spring and no law holds back."""
        return null_vectors(self._elastic)

    @cached_property
    def rigid_turning(self) -> Array:
        """Rotations (N, r) that nothing holds back while the engine turns: pendulums are held by centrifugal force."""
        c = self.system.connections
        return null_vectors(np.vstack([self._elastic, c.weights[c.centrifugal_stiffness > 0]]))

    @property
    def _elastic(self) -> Array:
        c = self.system.connections
        return np.vstack([c.weights[c.stiffness > 0], self.weights[self.reference_stiffness > 0]])

    def deflection(self, onto: Array) -> Array:
        """Static coordinates (loads, N) for balanced loads on them, without rigid rotation."""
        held = self.matrices[2] + self.rigid @ self.rigid.T * np.abs(self.matrices[2]).max()
        return np.asarray(np.linalg.solve(held, onto.T).T)

    def twist(self, onto: Array) -> Array:
        """Static angles W K⁻¹ (m, loads) of the connections with laws for balanced loads (loads, N)."""
        return np.asarray(self.weights @ self.deflection(onto).T)

    def balanced(self, onto: Array, hold: str) -> Array:
        """Loads (loads, N) with the reaction at ``hold`` that leaves no work on the rigid rotations."""
        if not self.rigid.size:
            return onto
        work = onto @ self.rigid
        if not hold:
            if np.abs(work).max(initial=0.0) > 0:
                raise ModelError(
                    "the mean torque needs a node that takes it up", where="hold", remedy="name it: hold='vehicle'"
                )
            return onto
        held = self.system.T[self.system.node_index(hold)]
        along = held @ self.rigid
        if not along.any():
            raise ModelError(f"node '{hold}' does not turn and takes up no mean torque", where=hold)
        return np.asarray(onto - np.outer(work @ along / (along @ along), held))


def _reference(law: Law, sole: bool) -> float:
    """A stiffness of the law's own size: its softest stage that is not free, its slope near rest; none of friction."""
    if not law.carries_mean_torque:
        return 0.0
    slopes: Array
    if law.straight is not None:
        slopes = law.slopes
        return float(slopes[slopes > 0].min(initial=np.inf)) if (slopes > 0).any() else 1.0
    slopes = np.asarray(law.tangent(np.concatenate([[0.0], np.geomspace(1e-4, 1.0, 9)])))
    if slopes[0] > 0:
        return float(slopes[0])
    return float(slopes.max(initial=0.0)) if sole else 0.0


def balance(
    split: Split,
    load: Load,
    base_order: float,
    harmonics: int,
    scale: Array,
    *,
    hold: str = "",
    speed: float | None = None,
    half_orders: int = 0,
    samples: int = 0,
    periods: int = 1,
) -> Balance:
    """The compiled balance of a split system; with ``speed`` [rad/s] the parameter is another quantity than speed.

    ``periods``: how many periods of the excitation the base order takes.
    """
    onto = split.system.T[[split.system.node_index(node) for node in load.nodes]]
    carried = split.twist(split.balanced(onto, hold) if np.abs(load.order(0.0)).max() > 0 else onto)
    orders = base_order * np.arange(harmonics + 1)
    torque = np.stack([load.order(n) for n in orders], axis=2)
    poles = split.summed(onto)
    modal: ComplexArray = torque @ (onto @ poles.shapes.T) if poles else np.zeros((1, 4, 1, 0), complex)
    values: ComplexArray = poles.poles if poles else np.zeros(0, complex)
    left: ComplexArray = split.weights @ poles.shapes.T if poles else np.zeros((len(split.laws), 0), complex)
    pairs = (left[:, None] * left).reshape(len(left) ** 2, values.size)
    laws = packed([law if law.straight is None else law.straight for law in split.laws])
    return Balance(
        base_order=float(base_order),
        fixed_speed=float(speed or 0.0),
        by_speed=int(speed is None),
        breaks=np.ascontiguousarray(load.breaks, dtype=float),
        poles=np.ascontiguousarray(np.stack([-values.real, values.imag])),
        left=np.ascontiguousarray(np.stack([left.real, left.imag])),
        pairs=np.ascontiguousarray(np.stack([pairs.real, pairs.imag])),
        modal_load=np.ascontiguousarray(np.stack([modal.real, modal.imag])),
        matrices=np.ascontiguousarray(split.matrices),
        weights=np.ascontiguousarray(split.weights),
        node_load=np.ascontiguousarray(torque @ onto),
        loaded=np.array([int(np.abs(torque[:, :, h]).max() > 0) for h in range(harmonics + 1)]),
        static=np.ascontiguousarray(split.twist(split.weights)),
        static_load=np.ascontiguousarray(torque[:, :, 0].real @ carried.T),
        reference_stiffness=split.reference_stiffness,
        reference_damping=split.reference_damping,
        law_values=laws.values,
        law_start=laws.start,
        address=laws.address,
        remembers=laws.remembers,
        half_orders=half_orders,
        table=scan_table(harmonics, samples or _samples(split, harmonics, periods)),
        scale=np.ascontiguousarray(scale, dtype=float),
    )


def _samples(split: Split, harmonics: int, periods: int) -> int:
    """Samples of a motion: as few as find the crossings of hinges, many in each period where a law is sampled."""
    if split.straight:
        return 0
    least = REMEMBERING_SAMPLES if any(law.remembers for law in split.laws) else SMOOTH_SAMPLES
    return periods * max(least, 1 << (16 * harmonics // periods - 1).bit_length())
