"""Order response of many variants of one system, which differ in numbers only: what they share is eliminated once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from torsional.laws import Hinges
from torsional.laws.hinges import hinge_tangents
from torsional.numerics.arrays import Array, ComplexArray, IntArray
from torsional.numerics.elimination.backends import backend
from torsional.numerics.elimination.coupling import CoupledPlan, Rest
from torsional.numerics.elimination.plan import Status
from torsional.solvers.equilibrium import OperatingPoint, with_load_stiffness
from torsional.solvers.harmonic import response
from torsional.system import System

NUMBERS = ("stiffness", "loss_factor", "damping", "centrifugal_stiffness")


@dataclass(frozen=True, eq=False)
class Loading:
    """What a system is asked: its mean ``state`` (states first), ``omega`` and ``speed`` [rad/s] (states, frequencies),
    complex ``torque`` [Nm] (states, frequencies, nodes) on ``nodes``."""

    state: OperatingPoint
    omega: Array
    speed: Array
    nodes: tuple[str, ...]
    torque: ComplexArray


@dataclass(frozen=True, eq=False)
class Variants:
    """Systems that differ from ``system`` in the numbers of some ``connections`` and ``masses`` (their places).

    ``outputs``: combinations of the coordinates that are wanted, (outputs, coordinates), as rows of ``System.T`` for
    nodes or weights for twists.  Varied laws must be `Hinges`, and statics alone must fix the mean torques: `possible`
    tells.  ``backend``: an array library instead of the compiled kernel, see `numerics.elimination.backends`.
    """

    system: System
    loading: Loading
    connections: IntArray
    masses: IntArray
    outputs: Array
    backend: str = ""

    @cached_property
    def possible(self) -> bool:
        """Whether all variants carry the same mean torques, and what varies is known to be linear or made of hinges."""
        c, switches = self.system.connections, self.system.masses.switches
        carried = (c.stiffness > 0) | np.array([law is not None and law.carries_mean_torque for law in c.laws])
        tree = np.linalg.matrix_rank(c.weights[carried]) == int(carried.sum())
        bent = [i for i in self.connections if c.laws[i] is not None]
        straight = all(type(c.laws[i]) is Hinges and c.stiffness[i] == 0 and c.loads[i] is None for i in bent)
        return bool(tree and straight and not any(switches) and not any(c.whole_speed[i] for i in bent))

    @cached_property
    def _linear(self) -> System:
        return with_load_stiffness(self.system)

    @cached_property
    def _plan(self) -> CoupledPlan:
        c, m = self._linear.connections, self._linear.masses
        return CoupledPlan.build(c.weights, m.weights, self.connections.tolist(), self.masses.tolist())

    @cached_property
    def _places(self) -> IntArray:
        """The coordinates that any output needs."""
        return np.flatnonzero(self.outputs.any(axis=0))

    @cached_property
    def _rest(self) -> Rest:
        """The shared part over all cases, states outermost."""
        system, at = self._linear, self.loading
        onto = np.array([system.T[system.node_index(node)] for node in at.nodes])
        loaded = np.flatnonzero(onto.any(axis=0))
        each, c = at.omega.shape[1], system.connections
        stiffness, damping = (np.repeat(table, each, axis=0) for table in (at.state.stiffness, at.state.damping))
        return self._plan.rest(
            (stiffness, c.loss_factor, damping, c.centrifugal_stiffness),
            system.masses.inertia,
            (at.omega.ravel(), at.speed.ravel()),
            loaded.tolist(),
            at.torque.reshape(at.omega.size, -1) @ onto[:, loaded],
            self._places.tolist(),
        )

    def angles(self, numbers: Mapping[str, Array], laws: Mapping[int, Array]) -> ComplexArray:
        """Complex 0-peak outputs [rad] (variants, outputs, states, frequencies).

        ``numbers``: a table by field of connections and of masses ("inertia"), (variants or 1, all of them); ``laws``:
        parameters (variants or 1, …) by place of varied connections with a law.  Not a number where there is no answer:
        an undamped mode is met exactly.
        """
        slopes = {i: self._slopes(i, rows) for i, rows in laws.items()}
        count = max(len(table) for table in (*numbers.values(), *slopes.values()))
        shape = self.loading.omega.shape
        groups = self._alike(slopes)
        q = np.empty((count if len(groups) > 1 else 0, self._places.size, *shape), dtype=complex)
        stiffness = np.repeat(numbers["stiffness"], count // len(numbers["stiffness"]), axis=0)
        for states in groups:
            for i, slope in slopes.items():
                stiffness[:, i] = slope[:, states[0]]
            cases = (states[:, None] * shape[1] + np.arange(shape[1])).ravel()
            part = self._solved(cases, {**numbers, "stiffness": stiffness}).reshape(count, -1, len(states), shape[1])
            if len(groups) == 1:
                return _combined(self.outputs[:, self._places], part)
            q[:, :, states] = part
        return _combined(self.outputs[:, self._places], q)

    def _slopes(self, connection: int, parameters: Array) -> Array:
        """Tangent stiffnesses (variants, states) of a law at the mean torques."""
        return hinge_tangents(parameters, self.loading.state.torque[:, connection])

    def _alike(self, slopes: Mapping[int, Array]) -> list[IntArray]:
        """Groups of states in which every variant has its one stiffness."""
        left, rows, groups = np.arange(len(self.loading.omega)), list(slopes.values()), []
        while left.size:
            same = np.ones(left.size, dtype=bool)
            for slope in rows:
                same &= (slope[:, left] == slope[:, left[:1]]).all(axis=0)
            groups.append(left[same])
            left = left[~same]
        return groups

    def _solved(self, cases: IntArray, numbers: Mapping[str, Array]) -> ComplexArray:
        """Coordinates (variants, places, cases); where the short way is not to be trusted, by the whole system."""
        plan = self._plan
        k, eta, c, lift = (numbers[name][:, plan.connections] for name in NUMBERS)
        rest, inertia = self._rest.at(cases), numbers["inertia"][:, plan.masses]
        if self.backend:
            q, flagged = backend(self.backend).solve(plan, rest, (k, eta, c, lift), inertia)
            q = np.array(q)  # to be written to
        else:
            q, flagged = plan.solve(rest, (k, eta, c, lift), inertia)
        for variant, place in np.argwhere(flagged):
            own = {name: table[variant if len(table) > 1 else 0] for name, table in numbers.items()}
            q[variant, :, place] = self._whole(int(cases[place]), own)
        return q

    def _whole(self, case: int, numbers: Mapping[str, Array]) -> ComplexArray:
        """One case of one variant by the whole system."""
        at = self.loading
        state, frequency = divmod(case, at.omega.shape[1])
        own = dict(numbers)
        for name, tangent in (("stiffness", at.state.stiffness), ("damping", at.state.damping)):
            own[name] = tangent[state].copy()
            own[name][self.connections] = numbers[name][self.connections]
        part = state, slice(frequency, frequency + 1)
        q, status = response(self._linear, at.omega[part], at.speed[part], at.nodes, at.torque[part], own)
        return q[0, self._places] if status[0] != Status.SINGULAR else np.full(self._places.size, complex(np.nan))


def _combined(outputs: Array, q: ComplexArray) -> ComplexArray:
    """Combinations (variants, outputs, …) of coordinates (variants, coordinates, …), always summed in one order."""
    found = np.empty((len(q), len(outputs), *q.shape[2:]), dtype=complex)
    for o, row in enumerate(outputs):
        used = np.flatnonzero(row)
        found[:, o] = q[:, used[0]] * row[used[0]]
        for place in used[1:]:
            found[:, o] += q[:, place] * row[place]
    return found
