"""Exact derivatives of the order response with respect to parameters of the model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.elimination.plan import EliminationPlan
from torsional.results import dataset
from torsional.solvers.harmonic import node_angles, order_response
from torsional.system import System

MATRICES = ("M", "C", "K", "H", "S", "T")


@dataclass(frozen=True, eq=False)
class Slope:
    """Derivatives of the matrices of a `System` with respect to one parameter, by their names; ``W``: of the directions
    of its connections."""

    M: Array
    C: Array
    K: Array
    H: Array
    S: Array
    T: Array
    W: Array

    @classmethod
    def between(cls, low: System, high: System, step: float) -> Slope:
        """Central differences of two systems whose parameter differs by ``step``.

        They are exact where the matrices are polynomials of the parameter of at most second degree: inertias,
        stiffnesses, damping, masses, distances, ratios, orders of tuning.  Raises ModelError for systems of different
        parts.
        """
        if low.coordinates != high.coordinates or low.connections.names != high.connections.names:
            raise ModelError("the systems differ in more than a value", where="slope")
        W = (high.connections.weights - low.connections.weights) / step
        M, C, K, H, S, T = ((getattr(high, name) - getattr(low, name)) / step for name in MATRICES)
        return cls(M, C, K, H, S, T, W)


@checked
def response_derivatives(system: System, excitation: Excitation, slopes: Mapping[str, Slope]) -> xr.Dataset:
    """Steady response of a linear ``system`` and how it changes with parameters, exactly.

    From Z q = Tᵀu with Z = K(1 + iη) + Ω²S + iωC − ω²M follows dq/dp = Z⁻¹(dTᵀ/dp u − dZ/dp q).  Complex 0-peak
    ``angle`` (speed, order, node) [rad], ``angle_derivative`` (parameter, speed, order, node) [rad over the unit of the
    parameter].  ``slopes``: of the matrices by parameter.  Raises ModelError as `harmonic_response`, and for an
    inertia that switches over speed.

    >>> from torsional.components import Inertia, Shaft
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> pair = lambda k: assemble(Powertrain({"a": Inertia(1.0), "b": Inertia(2.0), "s": Shaft("a", "b", k)}))
    >>> slope = Slope.between(pair(0.9e4), pair(1.1e4), 0.2e4)
    >>> found = response_derivatives(pair(1e4), Excitation.unit("a", [1.0], [50.0]), {"k": slope})
    >>> higher, lower = (response_derivatives(pair(1e4 + d), Excitation.unit("a", [1.0], [50.0]), {}) for d in (1, -1))
    >>> differences = (higher.angle - lower.angle).values / 2
    >>> bool(np.allclose(found.angle_derivative.values[0], differences, rtol=1e-6))
    True
    """
    speed, orders, omega, turning, q = order_response(system, excitation)
    moved = coordinate_derivatives(system, excitation, omega, turning, q, list(slopes.values()))
    grid = (len(speed), len(orders), len(system.nodes))
    change = [q @ slope.T.T + part @ system.T.T for slope, part in zip(slopes.values(), moved, strict=True)]
    return dataset(
        {
            "angle": (("speed", "order", "node"), node_angles(system, q).reshape(grid), "angle"),
            "angle_derivative": (
                ("parameter", "speed", "order", "node"),
                np.reshape(change, (len(slopes), *grid)),
                "",
            ),
        },
        {
            "speed": (speed, "speed"),
            "order": (orders, "engine_order"),
            "node": (np.array(system.nodes), ""),
            "parameter": (np.array(list(slopes), dtype=str), ""),
        },
        {"angle_derivative": "angles over the unit of a parameter", "parameter": "parameters by name"},
        analysis="response derivatives",
        amplitude="complex 0-peak",
        system_hash=system.hash,
    )


def coordinate_derivatives(
    system: System, excitation: Excitation, omega: Array, turning: Array, q: ComplexArray, slopes: list[Slope]
) -> ComplexArray:
    """dq/dp (parameters, pairs, coordinates) of what `order_response` gave."""
    if any(switch is not None for switch in system.masses.switches):
        raise ModelError("an inertia that switches over speed has no derivative there", where="inertia")
    if not slopes:
        return np.empty((0, *q.shape), dtype=complex)
    loads = _loads(excitation, omega.size)
    onto = [system.node_index(node) for node in excitation.nodes]
    right = np.stack([loads @ slope.T[onto] - _changed(slope, omega, turning, q) for slope in slopes], axis=1)
    c, m = system.connections, system.masses
    found, _ = EliminationPlan.build(c.weights, m.weights).solve(
        c.stiffness,
        c.loss_factor,
        c.damping,
        c.centrifugal_stiffness,
        m.inertia,
        omega,
        turning,
        tuple(range(q.shape[1])),
        right,
        connection_weights=c.weights,
        mass_weights=m.weights,
    )
    return np.asarray(np.moveaxis(found[0], 1, 0))


def _loads(excitation: Excitation, pairs: int) -> ComplexArray:
    """Torques (pairs, nodes)."""
    kept = excitation.torque[..., excitation.orders > 0]
    speeds = np.atleast_1d(excitation.speed).size
    return np.asarray(np.moveaxis(kept.reshape(speeds, len(excitation.nodes), -1), 1, 2).reshape(pairs, -1))


def _changed(slope: Slope, omega: Array, turning: Array, q: ComplexArray) -> ComplexArray:
    """dZ/dp q, (pairs, coordinates)."""
    still = q @ (slope.K + 1j * slope.H).T
    moving = (1j * omega[:, None]) * (q @ slope.C.T) - (omega**2)[:, None] * (q @ slope.M.T)
    return np.asarray(still + moving + (turning**2)[:, None] * (q @ slope.S.T))
