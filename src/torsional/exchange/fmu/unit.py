"""What a unit is before it is written: arrays that are stepped, and its variables."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from torsional.errors import ModelError
from torsional.laws import Contacts
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.motion.data import CHANGE, DAMPER, SPRING
from torsional.numerics.stepping.plan import Masses, Plan
from torsional.numerics.stepping.state import ACCELERATION, Q, State, V
from torsional.solvers.transient.marching import Accuracy
from torsional.system import System


class Variable(NamedTuple):
    """A real variable: its ``name``, ``unit`` as FMI writes it, what it is, and the ``start`` of what is given."""

    name: str
    unit: str
    description: str
    start: float = 0.0


class Slope(NamedTuple):
    """A number that follows a parameter: the array by its path, its place there flat, and the slope."""

    array: str
    place: int
    weight: float


class Part(NamedTuple):
    """A share of an output: a place in coordinates (6 n), torques of connections (E), reference (3), end to end."""

    place: int
    weight: float


Parameter = tuple[Variable, tuple[Slope, ...]]
Output = tuple[Variable, tuple[Part, ...]]
Kernels = tuple[Callable[..., Any], ...]


@dataclass(frozen=True, eq=False)
class Unit:
    """Everything that is written: ``plan`` and ``state`` of a march, variables and what they mean in its arrays.

    ``inputs`` are torques, which stand at ``levels`` of the plan's knots, or where there are ``sides`` (coordinates)
    three each: angle, speed, acceleration.
    """

    name: str
    description: str
    plan: Plan
    state: State
    accuracy: Accuracy
    kernels: Kernels
    inputs: tuple[Variable, ...]
    levels: tuple[int, ...]
    sides: tuple[int, ...]
    parameters: tuple[Parameter, ...]
    outputs: tuple[Output, ...]

    @property
    def variables(self) -> list[tuple[str, Variable]]:
        """Causality and variable in the order of their numbers: inputs, parameters, outputs."""
        given = [("input", v) for v in self.inputs] + [("parameter", v) for v, _ in self.parameters]
        step = Variable("step", "s", "longest step of time within the unit", self.accuracy.step)
        return [*given, ("parameter", step), *(("output", v) for v, _ in self.outputs)]

    @property
    def restarts(self) -> bool:
        """Whether a beginning with other values is found within the unit: no pistons, pendulums or governors."""
        outside = self.plan.outside
        moved = outside.cranks.shape[1] + len(outside.pendulums) + outside.governors.shape[1]
        lags = self.plan.moving and np.isfinite(outside.reference_time)
        return not moved and not lags and bool(np.all(self.plan.masses.diagonal > 0.0))


def numbered_laws(plan: Plan, system: System) -> tuple[Plan, Kernels]:
    """The plan with laws by number in place of their addresses, and their kernels in that order."""
    listed = [law for law in system.connections.laws if law is not None]
    own = {law.address: type(law).kernel for law in listed if law.hinges() is None}
    if plan.outside.pendulums.size:
        end = Contacts.between(-1.0, 1.0, 1.0)
        own[end.address] = type(end).kernel
    kernels = dict(sorted(own.items(), key=lambda one: one[1].__name__))
    number = {address: i for i, address in enumerate(kernels)}
    places = plan.laws.places.copy()
    places[1] = [number[int(address)] for address in places[1]]
    return plan._replace(laws=plan.laws._replace(places=places)), tuple(kernels.values())


def unique(unit: Unit) -> Unit:
    """The unit; ModelError where two of its variables have one name, or one cannot be written."""
    names = [variable.name for _, variable in unit.variables]
    for name, count in Counter(names).items():
        if not name.isprintable():
            raise ModelError("the name cannot be written", found=repr(name), remedy="rename the node or the component")
        if count > 1:
            raise ModelError("two variables have one name", where=name, remedy="rename the node or the component")
    return unit


def parameters_of(plan: Plan, system: System, heavy: Sequence[str] = ()) -> list[Parameter]:
    """Inertias but for those of masses named ``heavy``, stiffnesses of plain springs and factors on those of others,
    damping coefficients."""
    masses, c = system.masses, system.connections
    hung = {name.rpartition(".")[0] for name, swing in zip(c.names, c.swings, strict=False) if swing is not None}
    found: list[Parameter] = [
        (
            Variable(f"{name}.inertia", "kg.m2", f"moment of inertia of {name}", float(inertia)),
            inertia_slopes(plan, row),
        )
        for name, inertia, row in zip(masses.names, masses.inertia, masses.weights, strict=True)
        if name not in {*heavy, *hung}  # a pendulum's mass stands in the terms of its path too
    ]
    count = len(c.names)
    for e, name in enumerate(c.names):
        if c.laws[e] is None and c.stiffness[e]:
            told = Variable(f"{name}.stiffness", "N.m/rad", f"stiffness of {name}", float(c.stiffness[e]))
            found.append((told, (Slope("plan.constants", SPRING * count + e, 1.0),)))
        if (hinged := np.flatnonzero(plan.hinges.of == e)).size:
            told = Variable(f"{name}.stiffness_factor", "1", f"factor on all stiffnesses of {name}", 1.0)
            found.append((told, _stiffened(plan, e, hinged)))
        if c.damping[e]:
            told = Variable(f"{name}.damping", "N.m.s/rad", f"viscous damping of {name}", float(c.damping[e]))
            found.append((told, (Slope("plan.constants", DAMPER * count + e, 1.0),)))
    return found


def _stiffened(plan: Plan, e: int, hinged: IntArray) -> tuple[Slope, ...]:
    """The stiffnesses of a connection, which stages, gaps and stops change."""
    constants, values = plan.constants, plan.hinges.values
    found = [(("plan.constants", SPRING * constants.shape[1] + e), constants[SPRING, e])]
    found += [(("plan.hinges.values", CHANGE * values.shape[1] + int(i)), values[CHANGE, i]) for i in hinged]
    return tuple(Slope(*place, float(value)) for place, value in found if value)


def inertia_slopes(plan: Plan, row: Array) -> tuple[Slope, ...]:
    """Where an inertia along a row of the coordinates stands in the masses of a plan: J v vᵀ."""
    masses: Masses = plan.masses
    node, couplings, n = plan.tape.node, plan.tape.couplings, len(row)
    ends = [(int(node[p]), int(node[p])) for p in range(n)]
    ends += [(int(node[p]), int(node[r])) for p, r in couplings.T.tolist()]
    found = [Slope("plan.masses.diagonal", i, float(row[i] ** 2)) for i in range(n)]
    found += [
        Slope("plan.masses.above", k, float(row[i] * row[j])) for k, (i, j) in enumerate(masses.above_at.T.tolist())
    ]
    found += [Slope("plan.masses.slots", s, float(row[i] * row[j])) for s, (i, j) in enumerate(ends)]
    return tuple(slope for slope in found if slope.weight)


def node_outputs(system: System, node: str) -> list[Output]:
    """Angle, as deviation from the mean rotation, whole speed and acceleration of a node."""
    i, n, count = system.node_index(node), len(system.coordinates), len(system.connections.names)
    ratio = float(system.speed_ratio[i])
    told = (
        (Q, "angle", "rad", "angle of {}, less the mean rotation"),
        (V, "speed", "rad/s", "angular velocity of {}"),
        (ACCELERATION, "acceleration", "rad/s2", "angular acceleration of {}"),
    )
    frame = [Part(6 * n + count + 2, ratio)]
    return [
        (Variable(f"{node}.{name}", unit, words.format(node)), (*_along(row * n, system.T[i]), *(frame * (row == V))))
        for row, name, unit, words in told
    ]


def element_output(system: System, name: str) -> Output:
    """The torque of a connection, its damping and law included."""
    e = system.connections.names.index(name)
    told = Variable(f"{name}.torque", "N.m", f"torque of {name}, damping included")
    return told, (Part(6 * len(system.coordinates) + e, 1.0),)


def _along(first: int, row: Array) -> list[Part]:
    return [Part(first + int(i), float(row[i])) for i in np.flatnonzero(row)]
