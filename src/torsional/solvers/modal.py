"""Natural frequencies, mode shapes, energy shares; undamped and damped."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.numerics.arrays import Array
from torsional.numerics.modes.damped import DampedModes
from torsional.numerics.modes.damped import damped_modes as quadratic_modes
from torsional.numerics.modes.undamped import Modes, modes
from torsional.results import dataset
from torsional.solvers.checks import linear
from torsional.system import System


@checked
def modal(system: System, speed: float = 0.0) -> xr.Dataset:
    """Undamped modes at a mean ``speed`` [rad/s], rigid rotations first, with their energies.

    (K + Ω²S) φ = ω² M φ.  ``frequency`` (mode) [Hz]; ``shape`` (mode, node), largest angle one; ``elastic_share``
    (mode, element) and ``kinetic_share`` (mode, mass), each summing to one over an elastic mode; ``damping_ratio``
    (mode), the modal estimate ½ φᵀ(C/ω + H/ω²)φ, exact where damping does not couple modes.
    Raises ModelError for a nonlinear system.

    >>> from torsional.components import Inertia, Shaft
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> pair = {"a": Inertia(211.4), "b": Inertia(8.3), "s": Shaft("a", "b", 9.775e6)}
    >>> modal(assemble(Powertrain(pair))).frequency.values.round(1)
    array([  0. , 176.1])
    """
    found = modal_values(system, speed)
    return dataset(
        {
            "frequency": (("mode",), found.frequency, "frequency"),
            "damping_ratio": (("mode",), found.damping_ratio, "damping_ratio"),
            "shape": (("mode", "node"), found.shape, "mode_shape"),
            "elastic_share": (("mode", "element"), found.elastic_share, "energy_share"),
            "kinetic_share": (("mode", "mass"), found.kinetic_share, "energy_share"),
        },
        {
            "mode": (np.arange(found.frequency.size), ""),
            "node": (np.array(system.nodes), ""),
            "element": (np.array(system.connections.names), ""),
            "mass": (np.array(system.masses.names), ""),
        },
        analysis="modal",
        mean_speed=float(speed),
        system_hash=system.hash,
    )


@dataclass(frozen=True, eq=False)
class ModalValues:
    """What `modal` tells, as plain arrays: for analyses that ask it very often."""

    frequency: Array
    damping_ratio: Array
    shape: Array
    elastic_share: Array
    kinetic_share: Array


def modal_values(system: System, speed: float) -> ModalValues:
    """The values of `modal`; ModelError for a nonlinear system."""
    linear(system)
    system = system.switched(speed)
    omega, shapes = _modes(system, speed)
    c, m = system.connections, system.masses
    with np.errstate(divide="ignore", invalid="ignore"):
        elastic = _stiffness(system, speed)[:, None] * (c.weights @ shapes) ** 2 / omega**2
        dissipated = c.damping[:, None] / omega + (c.stiffness * c.loss_factor)[:, None] / omega**2
        ratio = 0.5 * np.sum((c.weights @ shapes) ** 2 * dissipated, axis=0)
    elastic[:, omega == 0], ratio[omega == 0] = 0.0, 0.0
    kinetic = m.inertia[:, None] * (m.weights @ shapes) ** 2
    angles = system.T @ shapes
    largest = angles[np.abs(angles).argmax(axis=0), np.arange(omega.size)]
    return ModalValues(omega / (2 * np.pi), ratio, (angles / largest).T, elastic.T, kinetic.T)


@checked
def damped_modes(system: System, speed: float = 0.0) -> xr.Dataset:
    """Damped modes at a mean ``speed`` [rad/s]: (M λ² + C λ + K + Ω²S) φ = 0, without loss factors.

    ``frequency`` |λ|/2π [Hz], ``damping_ratio`` −Re λ/|λ| (1 where overdamped), ``eigenvalue`` λ [1/s] and complex
    ``shape`` (mode, node), largest angle one; rigid rotations first.

    Raises ModelError for a nonlinear system.

    >>> from torsional.components import Inertia, Shaft
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> disc = assemble(Powertrain({"disc": Inertia(1.0), "s": Shaft("ground", "disc", 100.0, damping=2.0)}))
    >>> damped_modes(disc).damping_ratio.values.round(9)
    array([0.1])
    """
    linear(system)
    told, system = system.hash, system.switched(speed)
    found = _damped(system, speed)
    angles = system.T @ found.shapes
    largest = angles[np.abs(angles).argmax(axis=0), np.arange(found.eigenvalues.size)]
    return dataset(
        {
            "frequency": (("mode",), found.omega / (2 * np.pi), "frequency"),
            "damping_ratio": (("mode",), found.damping_ratio, "damping_ratio"),
            "eigenvalue": (("mode",), found.eigenvalues, "eigenvalue"),
            "shape": (("mode", "node"), (angles / largest).T, "mode_shape"),
        },
        {"mode": (np.arange(found.eigenvalues.size), ""), "node": (np.array(system.nodes), "")},
        analysis="damped modes",
        mean_speed=float(speed),
        system_hash=told,
    )


def damped_frequencies(system: System, speed: float = 0.0) -> tuple[Array, Array]:
    """|λ| [rad/s] and damping ratio of `damped_modes` alone."""
    linear(system)
    found = _damped(system.switched(speed), speed)
    return found.omega, found.damping_ratio


def natural_frequencies(system: System, speed: float = 0.0) -> Array:
    """Undamped angular frequencies [rad/s] of a linear system at a mean ``speed`` [rad/s], ascending."""
    return _modes(system.switched(speed), speed).omega


def _damped(system: System, speed: float) -> DampedModes:
    c, m = system.connections, system.masses
    return quadratic_modes(c.weights, _stiffness(system, speed), c.weights, c.damping, m.weights, m.inertia)


def _stiffness(system: System, speed: float) -> Array:
    return np.asarray(system.connections.stiffness + speed**2 * system.connections.centrifugal_stiffness)


def _modes(system: System, speed: float) -> Modes:
    stiffness = _stiffness(system, speed)
    return modes(system.connections.weights, stiffness, system.masses.weights, system.masses.inertia)
