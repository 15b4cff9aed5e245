"""An absorber alone as a unit: angle, speed and acceleration of its two sides in, torques on them out.

The sides have no inertia of their own within the unit: flywheels that sit on them stay outside, as in the adaptors of
the Modelica Standard Library (GeneralAngleToTorqueAdaptor).  Between two points of communication the sides move on
with the acceleration that is given, nought without.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from torsional.absorbers import Absorber
from torsional.components import Component, Inertia
from torsional.errors import ModelError
from torsional.exchange.fmu.unit import (
    Output,
    Part,
    Unit,
    Variable,
    element_output,
    numbered_laws,
    parameters_of,
    unique,
)
from torsional.numerics.arrays import Array
from torsional.numerics.stepping.plan import Plan
from torsional.numerics.stepping.state import ACCELERATION, EXTERNAL
from torsional.powertrain import Powertrain
from torsional.solvers.transient.marching import Accuracy, standing_of
from torsional.solvers.transient.problem import Problem
from torsional.solvers.transient.starts import MotionState
from torsional.system import System, assemble

HEAVY = 1e30
"""Inertia in the step matrix of a side that moves as it is told."""
STANDS_FOR = " (from outside)"
"""Behind the name of the disc that stands for what turns outside, so that no node is without mass."""


class Sides(NamedTuple):
    """An absorber without the flywheels on its sides: its ``system``, whose coordinates 0 and 1 are the sides."""

    system: System
    nodes: tuple[str, str]
    left_out: dict[str, float]


def sides_of(absorber: Absorber, detailed: bool = True) -> Sides:
    """What an absorber is between its sides, its inner parts in place where it is to be ``detailed``.

    Raises ModelError for one whose sides turn as one.
    """
    ends = (absorber.input, absorber.output)
    parts: Mapping[str, Component] = {**absorber.components, **(absorber.detail if detailed else {})}
    own = {name: part for name, part in parts.items() if isinstance(part, Inertia) and (part.node or name) in ends}
    kept = {name: part for name, part in parts.items() if name not in own}
    stands = {end + STANDS_FOR: Inertia(1.0, end) for end in ends}
    if len(stands) < 2:
        remedy = "a flywheel is an inertia to any tool; write the whole powertrain instead"
        raise ModelError("both sides of the absorber are one node", where=ends[0], found=absorber.kind, remedy=remedy)
    system = _turned(assemble(Powertrain({**stands, **kept}, reference=ends[0])), ends)
    return Sides(system, ends, {name: float(part.inertia) for name, part in own.items()})


def _turned(system: System, ends: tuple[str, str]) -> System:
    """The system over other coordinates, of which the first two are the angles of the sides."""
    rows = system.T[[system.node_index(end) for end in ends]]
    if np.linalg.matrix_rank(rows) < 2:
        raise ModelError("both sides of the absorber turn as one", where=" and ".join(ends))
    first = int(np.abs(rows[0]).argmax())
    left = rows[1] - rows[0] * (rows[1, first] / rows[0, first])
    left[first] = 0.0
    rest = np.setdiff1d(np.arange(rows.shape[1]), [first, int(np.abs(left).argmax())])
    back = np.linalg.inv(np.vstack([rows, np.eye(rows.shape[1])[rest]]))
    return dataclasses.replace(
        system,
        T=_tidied(system.T @ back),
        masses=dataclasses.replace(system.masses, weights=_tidied(system.masses.weights @ back)),
        connections=dataclasses.replace(system.connections, weights=_tidied(system.connections.weights @ back)),
    )


def _tidied(rows: Array) -> Array:
    """Rows without what rounding has left."""
    return np.asarray(np.where(np.abs(rows) < 1e-13 * np.abs(rows).max(initial=1.0), 0.0, rows))


def absorber_unit(absorber: Absorber, name: str, accuracy: Accuracy, detailed: bool = True) -> Unit:
    """The unit of an absorber."""
    sides = sides_of(absorber, detailed)
    system = sides.system
    problem = Problem.of(system, (), 0.0, reference=sides.nodes[0])
    plan, kernels = numbered_laws(problem.plan, system)
    outside = [end + STANDS_FOR for end in sides.nodes]
    torques = [_reaction(system, side, node, outside) for side, node in enumerate(sides.nodes)]
    return unique(
        Unit(
            name=name,
            description=f"{absorber.kind} between {sides.nodes[0]} and {sides.nodes[1]}{_left(sides)}",
            plan=_led(plan),
            state=standing_of(problem, MotionState.at_rest(system), accuracy.step),
            accuracy=accuracy,
            kernels=kernels,
            inputs=tuple(variable for node in sides.nodes for variable in _motion(node)),
            levels=(),
            sides=(0, 1),
            parameters=tuple(parameters_of(plan, system, outside)),
            outputs=(*torques, *(element_output(system, name) for name in system.connections.names)),
        )
    )


def _left(sides: Sides) -> str:
    told = ", ".join(f"{name} of {inertia:g} kg.m2" for name, inertia in sides.left_out.items())
    return f"; without {told}" if told else ""


def _motion(node: str) -> tuple[Variable, Variable, Variable]:
    return (
        Variable(f"{node}.angle", "rad", f"angle of {node}"),
        Variable(f"{node}.speed", "rad/s", f"angular velocity of {node}"),
        Variable(f"{node}.acceleration", "rad/s2", f"angular acceleration of {node}"),
    )


def _led(plan: Plan) -> Plan:
    """The plan in which the first two coordinates move as they are told: no step moves their inertia further."""
    slots = plan.masses.slots.copy()
    slots[: plan.tape.node.size][np.isin(plan.tape.node, (0, 1))] = HEAVY
    return plan._replace(masses=plan.masses._replace(slots=slots))


def _reaction(system: System, side: int, node: str, outside: list[str]) -> Output:
    """The torque on a side: of pendulums, less those of connections along it and what inertia within takes."""
    n, masses, c = len(system.coordinates), system.masses, system.connections
    inside = np.array([0.0 if name in outside else 1.0 for name in masses.names]) * masses.inertia
    inert = (masses.weights[:, side] * inside) @ masses.weights
    parts = [Part(EXTERNAL * n + side, 1.0)]
    parts += [Part(6 * n + int(e), -float(c.weights[e, side])) for e in np.flatnonzero(c.weights[:, side])]
    parts += [Part(ACCELERATION * n + int(i), -float(inert[i])) for i in np.flatnonzero(inert)]
    return Variable(f"{node}.torque", "N.m", f"torque of the absorber on {node}"), tuple(parts)
