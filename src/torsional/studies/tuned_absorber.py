"""A tuned absorber in a flywheel: its tuning, other sizes of it, and the resonance that it adds."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.linalg import eigh, null_space

from torsional.absorbers import tuned_stiffness
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.powertrain import Powertrain
from torsional.solvers.modal import natural_frequencies
from torsional.solvers.operating import at_operating_point
from torsional.studies.answers import main_order, mean_torque
from torsional.studies.trucks import reached, replaced, sprung, stiffness, within, without
from torsional.system import assemble

RING, SPRING = "tva", "tva_spring"


def tuning(model: Model) -> float:
    """Engine speed [rad/s] at which the firing order meets the absorber's own frequency."""
    ring: Any = model.components[RING]
    spring: Any = model.components[SPRING]
    return float(np.sqrt(spring.stiffness / ring.inertia)) / main_order(model)


def sized(model: Model, inertia: float, carrier: str = "") -> Model:
    """A copy whose absorber has another inertia, the same tuning and, if named, another carrier."""
    k = tuned_stiffness(float(inertia), tuning(model) * main_order(model))
    fields: dict[str, Any] = {"stiffness": k, **({"a": carrier} if carrier else {})}
    return replaced(replaced(model, RING, inertia=float(inertia)), SPRING, **fields)


def order_speeds(model: Model) -> Array:
    """Order speeds [rad/s] of the undamped elastic modes in top gear."""
    system, _ = at_operating_point(model, mean_torque(model))
    return _elastic(natural_frequencies(system)) / main_order(model)


def _elastic(omega: Array) -> Array:
    return np.asarray(omega[omega > 0])


def flywheel_alone(model: Model) -> Array:
    """Order speeds [rad/s] of engine and flywheel with an open clutch."""
    for spring in model.landmarks.springs:
        model = sprung(model, spring, stiffness(model, spring))
    nodes = reached(model.powertrain(), [model.landmarks.crankshaft], [model.landmarks.clutch])
    return _elastic(natural_frequencies(assemble(Powertrain(within(model, nodes))))) / main_order(model)


def added(model: Model, resonances: Callable[[Model], Array] = order_speeds) -> float:
    """Order speed [rad/s] of the resonance that the absorber adds.

    Of N + 1 modes it is the one after those that the line without the absorber has below the tuning: with a vanishing
    absorber it starts at the tuning, and the modes of a line do not cross as the absorber grows.
    """
    below = int((resonances(without(model, RING, SPRING)) < tuning(model)).sum())
    return float(resonances(model)[below])


def held_speeds(model: Model, node: str) -> Array:
    """Order speeds [rad/s] of the undamped modes in top gear with a node held still."""
    system, _ = at_operating_point(model, mean_torque(model))
    Z = null_space(system.T[[system.node_index(node)]])
    squares = eigh(Z.T @ system.K @ Z, Z.T @ system.M @ Z, eigvals_only=True)
    return np.asarray(np.sqrt(np.maximum(squares, 0.0)) / main_order(model))


def tunings_above(model: Model, carrier: str = "") -> list[tuple[float, float]]:
    """Tunings [rad/s] within the operating range, as pairs of ends, whose added resonance lies above them.

    Just below its tuning an absorber of any inertia holds its carrier still, so the count of modes below the tuning
    (Wittrick and Williams, J. Sound Vib. 16 (1971), doi:10.1016/0022-460X(71)90100-1) is that of the line so held, and
    the added mode is not among them from each mode of the line to its next one with the carrier held.
    """
    spring: Any = model.components[SPRING]
    free, (low, high) = order_speeds(without(model, RING, SPRING)), model.operation.speed
    held = held_speeds(without(model, RING, SPRING), carrier or spring.a)
    ends = [(float(own), float(next((each for each in held if each > own), np.inf))) for own in free]
    return [(max(first, low), min(last, high)) for first, last in ends if first < high and last > low]
