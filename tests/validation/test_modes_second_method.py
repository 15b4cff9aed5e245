"""Modes a second way: a state matrix, differences of frequencies, the wave equation of a shaft."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy.optimize import brentq
from tests.shipped import shipped

import torsional as tv


def truck(torque: float = 1500.0) -> tv.System:
    """The shipped truck with a pendulum, linear about a mean torque."""
    return tv.at_operating_point(shipped("truck_dmf_pendulum"), torque)[0]


def test_damped_modes_against_a_state_matrix() -> None:
    """Eigenvalues of [[0, 1], [−M⁻¹K, −M⁻¹C]], which numpy knows to rounding of the largest."""
    system, speed = truck(), 130.0
    m, c, k = system.M, system.C, system.K + speed**2 * system.S
    n = len(m)
    state = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(m, k), -np.linalg.solve(m, c)]])
    values = np.linalg.eigvals(state)
    found = tv.damped_modes(system, speed).eigenvalue.values
    assert len(found) == n + 1  # pairs count once; the rigid rotation stands for two roots: it stops by the bearings
    for value in found:
        assert np.abs(values - value).min() < 1e-9 * np.abs(values).max()
    matched = found[found.imag > 0]
    assert np.sort(matched.imag) == pytest.approx(np.sort(values.imag[values.imag > 1e-3]), rel=1e-8)


def test_modal_damping_is_the_limit_of_light_damping() -> None:
    """Damping a thousandth of the truck's: estimate and damped modes agree to its square."""
    full = truck()
    light = dataclasses.replace(full.connections, damping=1e-3 * full.connections.damping)
    system = dataclasses.replace(full, connections=light)
    plain, damped = tv.modal(system, 130.0), tv.damped_modes(system, 130.0)
    elastic = plain.frequency.values > 0
    pairs = damped.eigenvalue.values.imag > 0
    assert plain.damping_ratio.values[elastic] == pytest.approx(damped.damping_ratio.values[pairs], rel=1e-6)
    assert plain.frequency.values[elastic] == pytest.approx(damped.frequency.values[pairs], rel=1e-6)


def test_energy_shares_are_sensitivities() -> None:
    """∂ln ω/∂ln k is half the elastic share, ∂ln ω/∂ln J minus half the kinetic share: by differences."""
    system, speed, step = truck(), 130.0, 1e-5
    modes = tv.modal(system, speed)

    def slope(part: str, field: str, index: int) -> np.ndarray:
        ends = []
        for factor in (1 - step, 1 + step):
            factors = getattr(system, part)
            values = getattr(factors, field).copy()
            values[index] *= factor
            changed = dataclasses.replace(system, **{part: dataclasses.replace(factors, **{field: values})})
            ends.append(tv.modal(changed, speed).frequency.values[1:])
        return np.log(ends[1] / ends[0]) / (2 * step)

    for i, name in enumerate(system.connections.names):
        field = "centrifugal_stiffness" if name == "pendulum.suspension" else "stiffness"
        share = modes.elastic_share.sel(element=name).values[1:]
        assert slope("connections", field, i) == pytest.approx(share / 2, abs=1e-8)
    for i, name in enumerate(system.masses.names):
        assert slope("masses", "inertia", i) == pytest.approx(
            -modes.kinetic_share.sel(mass=name).values[1:] / 2, abs=1e-8
        )


def test_shaft_of_distributed_mass_between_discs() -> None:
    """G I_p θ″ = −ρ I_p ω² θ with a disc at either end; elements converge to it with the square of their length."""
    shear, density, length, outer, inner, discs = 80e9, 7850.0, 2.5, 0.12, 0.05, (1.5, 4.0)
    moment, wave = np.pi * (outer**4 - inner**4) / 32, np.sqrt(shear / density)

    def end_torque(omega: float) -> float:
        """Torque that the far disc lacks when the near one swings by cos ωt: θ = cos βx + B sin βx."""
        beta = omega / wave
        share = -discs[0] * omega**2 / (shear * moment * beta)
        angle = np.cos(beta * length) + share * np.sin(beta * length)
        slope = beta * (share * np.cos(beta * length) - np.sin(beta * length))
        return float(discs[1] * omega**2 * angle - shear * moment * slope)

    grid = np.linspace(50, 15e3, 3000)
    signs = np.sign([end_torque(w) for w in grid])
    roots = [brentq(end_torque, grid[i], grid[i + 1], xtol=1e-9) for i in np.flatnonzero(signs[1:] != signs[:-1])][:3]

    def finite(elements: int) -> np.ndarray:
        tube = tv.DistributedShaft("a", "b", length, outer, inner, elements, shear, density)
        line = {"a": tv.Inertia(discs[0]), "b": tv.Inertia(discs[1]), "tube": tube}
        return 2 * np.pi * tv.modal(tv.assemble(tv.Powertrain(line))).frequency.values[1:4]

    coarse, fine = finite(40), finite(80)
    assert fine == pytest.approx(roots, rel=3e-4)
    assert (coarse / roots - 1) / (fine / roots - 1) == pytest.approx(4.0, rel=1e-2)
    assert (4 * fine - coarse) / 3 == pytest.approx(roots, rel=1e-6)
