"""Absorbers against closed forms: cancellation, notch and pendulum order, to the digits of another computation."""

from __future__ import annotations

import numpy as np
import pytest

import torsional as tv
from torsional.absorbers import Absorber, tuned_stiffness
from torsional.solvers.harmonic import response


def line(absorber: Absorber, stiffness: float = 60e3, inertia: float = 8.0) -> tv.System:
    """An absorber with one driveline inertia on one shaft."""
    behind = {"shaft": tv.Shaft("vehicle", absorber.output, stiffness), "vehicle": tv.Inertia(inertia)}
    return tv.assemble(tv.Powertrain({**absorber.components, **behind}))


def pushed(system: tv.System, node: str, torque: float, omega: float) -> dict[str, complex]:
    """Angles [rad] under a torque at one node."""
    load = tv.Excitation((node,), [1.0], [omega], np.full((1, 1, 1), torque, dtype=complex))
    found = tv.harmonic_response(system, load).angle.isel(speed=0, order=0)
    return {str(name): complex(found.sel(node=name)) for name in found.node.values}


def hertz(system: tv.System) -> np.ndarray:
    found = tv.modal(system).frequency.values
    return found[found > 0]


# --- power split: J1 1.8, J2 0.5, J3 0.02, J4 1.2 kgm², k 20 kNm/rad, g 2.5, r 0.6; 60 kNm/rad to 8 kgm² ---

SPLIT = {"planet_ratio": 2.5, "gear_quotient": 0.6}


def split(**changes: float) -> tv.System:
    return line(tv.power_split_absorber(1.8, 0.5, 0.02, 1.2, tv.Hinges(20e3), **{**SPLIT, **changes}))


def test_power_split_cancels() -> None:
    omega = tv.cancellation_frequency(20e3, 0.5, 0.02, 2.5, 0.6)
    assert omega / (2 * np.pi) == pytest.approx(41.4404174, abs=5e-8, rel=0)
    angles = pushed(split(), "primary", 1000.0, omega)
    assert angles["primary"].real == pytest.approx(-0.010510688836, abs=5e-13, rel=0)
    assert abs(angles["output"]) < 1e-15
    # at rest, the output leaves (1 − r) θ1 + r θ2 = 0, and primary and secondary to balance the torque alone
    assert angles["secondary"].real == pytest.approx(-(1 - 0.6) / 0.6 * angles["primary"].real, rel=1e-12)


def test_power_split_modes() -> None:
    """Eigenvalues of the three by three matrices written out by hand, in 30 digits."""
    assert hertz(split()) == pytest.approx([21.3016010963146, 34.0479811608384], rel=1e-12)


@pytest.mark.parametrize("inertia", [0.3, 8.0, 500.0])
@pytest.mark.parametrize("stiffness", [5e3, 60e3, 1e6])
def test_cancellation_does_not_ask_the_driveline(stiffness: float, inertia: float) -> None:
    omega = tv.cancellation_frequency(20e3, 0.5, 0.02, 2.5, 0.6)
    absorber = tv.power_split_absorber(1.8, 0.5, 0.02, 1.2, tv.Hinges(20e3), **SPLIT)
    angles = pushed(line(absorber, stiffness, inertia), "primary", 1.0, omega)
    assert abs(angles["output"]) < 1e-12 * abs(angles["primary"])


def test_planetary_flywheel_cancels() -> None:
    """Quotient 1: ω² = k/(J3 g (g − 1))."""
    flywheel = tv.planetary_dual_mass_flywheel(1.8, 1.7, 0.02, tv.Hinges(20e3), planet_ratio=2.5)
    omega = np.sqrt(20e3 / (0.02 * 2.5 * 1.5))
    angles = pushed(line(flywheel), "primary", 1.0, omega)
    assert abs(angles["secondary"]) < 1e-12 * abs(angles["primary"])


# --- flange absorber: J1 1.8, Jm 0.05, J2 1.2, Ja 0.15 kgm², k1 = k2 30, ka 15 kNm/rad; 60 kNm/rad to 8 kgm² ---


def flange(tva: float = 0.15) -> tv.System:
    stages = tv.Hinges(30e3), tv.Hinges(30e3)
    return line(tv.tuned_flange_flywheel(1.8, 0.05, 1.2, *stages, tva_inertia=tva, tva_stiffness=100e3 * (tva or 1.0)))


def test_flange_absorber_modes() -> None:
    found = hertz(flange())
    assert found == pytest.approx([14.2024806, 40.1208472, 47.7352941, 197.358413], abs=5e-7, rel=0)


def test_flange_absorber_notch() -> None:
    """At ω² = ka/Ja flange, secondary and all behind stand still, and the primary swings alone against k1."""
    omega = np.sqrt(15e3 / 0.15)
    assert omega / (2 * np.pi) == pytest.approx(50.3292121, abs=5e-8, rel=0)
    angles = pushed(flange(), "primary", 100.0, omega)
    alone = 100.0 / (30e3 - 1.8 * omega**2)
    assert angles["primary"].real == pytest.approx(alone, rel=1e-12)
    assert max(abs(angles[node]) for node in ("flange", "secondary", "vehicle")) < 1e-12 * abs(alone)
    assert angles["tva"].real == pytest.approx(-30e3 / 15e3 * alone, rel=1e-12)


def test_one_mode_more() -> None:
    assert hertz(flange()).size == hertz(flange(0.0)).size + 1


def test_light_flange_between_heavy_flywheels() -> None:
    """The added resonance at ω_t sqrt((k1 + k2)/(k1 + k2 + ka)): below the tuning on the flange; on a free secondary
    flywheel at ω_t sqrt(1 + Ja/J2), above it (Wramner, Chalmers, 2020, §2.2.3)."""
    k, ka, Ja = 30e3, 15e3, 0.15
    stages = tv.Hinges(k), tv.Hinges(k)
    heavy = tv.tuned_flange_flywheel(1e5, 1e-6, 1e5, *stages, tva_inertia=Ja, tva_stiffness=ka)
    found = hertz(tv.assemble(tv.Powertrain(heavy.components)))
    tuning = np.sqrt(ka / Ja) / (2 * np.pi)
    assert found[1] == pytest.approx(tuning * np.sqrt(2 * k / (2 * k + ka)), rel=1e-4)
    soft = tv.tuned_secondary_flywheel(1e5, 1.2, tv.Hinges(1.0), tva_inertia=Ja, tva_stiffness=ka)
    found = hertz(tv.assemble(tv.Powertrain(soft.components)))
    assert found[1] == pytest.approx(tuning * np.sqrt(1 + Ja / 1.2), rel=1e-4)


# --- pendulum: J 0.5 kgm², m 1 kg, R 0.1 m, ρ R/9 ---


def rotor() -> tv.System:
    pendulum = tv.CentrifugalPendulum("rotor", mass=1.0, distance=0.1 + 0.1 / 9, order=3.0)
    return tv.assemble(tv.Powertrain({"rotor": tv.Inertia(0.5), "pendulum": pendulum}))


@pytest.mark.parametrize("speed", [20.0, 100.0, 250.0])
def test_pendulum_order(speed: float) -> None:
    """The rotor stands still at order 3 and resonates at 3 sqrt(1 + m (R + ρ)²/J) = 3.03681119, at every speed."""
    system = rotor()
    at = np.array([3.0, 2.9])
    q, _ = response(system, at * speed, np.full(2, speed), ["rotor"], np.ones((2, 1), dtype=complex))
    rest, near = np.abs(q.reshape(2, -1) @ system.T[system.node_index("rotor")])
    assert rest < 1e-12 * near
    order = 2 * np.pi * float(tv.modal(system, speed).frequency[1]) / speed
    assert order == pytest.approx(3.03681119, abs=5e-9, rel=0)


def test_tuned_stiffness() -> None:
    assert tuned_stiffness(0.15, np.sqrt(15e3 / 0.15)) == pytest.approx(15e3, rel=1e-15)
