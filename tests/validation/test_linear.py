"""Published and closed-form linear cases through the public functions, to the digits printed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

import torsional as tv


def chain(inertias: Sequence[float], stiffnesses: Sequence[float]) -> dict[str, tv.Inertia | tv.Shaft]:
    discs = {f"disc{i}": tv.Inertia(J) for i, J in enumerate(inertias, 1)}
    shafts = {f"shaft{i}": tv.Shaft(f"disc{i + 1}", f"disc{i}", k) for i, k in enumerate(stiffnesses, 1)}
    return {**discs, **shafts}


def frequencies(parts: dict[str, object]) -> np.ndarray:
    """Elastic natural frequencies [Hz]."""
    found = tv.modal(tv.assemble(tv.Powertrain(parts))).frequency.values
    return found[found > 0]


MWM_INERTIAS = [0.0170, 0.0090, 0.0467, 0.0327, 0.0467, 0.0467, 0.0327, 0.0487, 2.0750]
MWM_STIFFNESSES = [1.106e6, 1.631e6, 1.253e6, 1.253e6, 1.678e6, 1.253e6, 1.253e6, 1.976e6]
MWM = [216.5836, 592.7405, 984.9230, 1171.0174, 1415.9950, 1660.0439, 1794.3876, 2993.4736]
CHAINS = {
    "two discs (test set of openTorsion)": ([211.4, 8.3], [9.775e6], [176.1], 0.05),
    "Thomson, Theory of Vibration, table 12.4-1": (
        [5.0, 11.0, 22.0],
        [1e5, 2e5],
        [123.665800 / (2 * np.pi), 202.658349 / (2 * np.pi)],
        5e-7 / (2 * np.pi),
    ),
    "Friswell et al., Dynamics of Rotating Machines, example 9.7.1": (
        [3.5e-3, 3.5e-3, 3.5e-3, 0.15, 0.05],
        [12e3, 12e3, 14e3, 10e3],
        [81.21, 141.21, 378.95, 536.36],
        0.005,
    ),
    "MWM diesel: Mendes, Meirelles, Zampieri, doi 10.1243/14644193JMBD126": (MWM_INERTIAS, MWM_STIFFNESSES, MWM, 5e-5),
    "dual mass flywheel, sqrt(k (1/J1 + 1/J2))": ([1.8, 1.2], [12e3], [20.54681480], 5e-9),
}


@pytest.mark.parametrize("case", CHAINS)
def test_chains(case: str) -> None:
    inertias, stiffnesses, expected, digit = CHAINS[case]
    assert frequencies(chain(inertias, stiffnesses)) == pytest.approx(expected, abs=digit, rel=0)


def test_holzer_residual_torques() -> None:
    """Torque left over at the last disc when the first swings with 1 rad: minus what must act there from outside
    (Thomson, Theory of Vibration, table 12.4-1)."""
    line = tv.assemble(tv.Powertrain(chain([5.0, 11.0, 22.0], [1e5, 2e5])))
    found = tv.harmonic_response(line, tv.Excitation.unit("disc3", [1.0], [20.0, 40.0]))
    residual = -1 / found.angle.sel(node="disc1", order=1.0).values
    assert residual.imag == pytest.approx([0.0, 0.0], abs=1e-9)
    assert residual[0].real == pytest.approx(14658.27, abs=0.005, rel=0)
    assert residual[1].real == pytest.approx(52318.2, abs=0.05, rel=0)


def test_geared_branches() -> None:
    """A 1:1 pair with a branch beside it (Friswell et al., Dynamics of Rotating Machines, section 9.7)."""
    inertias = {"rotor1": 400e-6, "gear1": 25e-6, "gear2": 25e-6, "rotor2": 700e-6, "rotor3": 700e-6}
    parts = {name: tv.Inertia(J) for name, J in inertias.items()}
    parts |= {
        "shaft1": tv.Shaft("rotor1", "gear1", 1e4),
        "mesh": tv.GearPair("gear1", "gear2", ratio=-1.0),
        "shaft2": tv.Shaft("gear2", "rotor2", 5e3),
        "shaft3": tv.Shaft("rotor3", "gear1", 5e3),
    }
    assert frequencies(parts) == pytest.approx([425.4, 634.1, 3247.2], abs=0.05, rel=0)


@pytest.mark.parametrize(
    ("elements", "expected"),
    [(5, [1.9417, 4.0719, 6.5437, 9.1547]), (50, [1.9106, 3.8232, 5.7394, 7.6613])],
)
def test_tube_with_distributed_mass(elements: int, expected: list[float]) -> None:
    """Consistent-mass finite elements between two discs (Friswell et al., example 9.9)."""
    tube = tv.DistributedShaft(
        "top", "bit", 800.0, 0.78, inner_diameter=0.65, elements=elements, shear_modulus=75e9, density=8000.0
    )
    found = frequencies({"top": tv.Inertia(200.0), "bit": tv.Inertia(10.0), "tube": tube})
    assert found[:4] == pytest.approx(expected, abs=5e-5, rel=0)


def test_rubber_damper() -> None:
    """A ring on rubber, free and with its hub held: closed form."""
    damper = {"hub": tv.Inertia(0.10), "ring": tv.Inertia(0.20), "rubber": tv.Shaft("ring", "hub", 1000.0)}
    modes = tv.modal(tv.assemble(tv.Powertrain(damper)))
    assert float(modes.frequency[1]) == pytest.approx(19.492420030841906, rel=1e-14)
    assert modes.shape.values[1] == pytest.approx([1.0, -0.5], abs=1e-14)
    held = {"ring": tv.Inertia(0.20), "rubber": tv.Shaft("ring", "ground", 1000.0)}
    assert frequencies(held) == pytest.approx([11.253953951963826], rel=1e-14)


def test_dual_mass_flywheel_receptances() -> None:
    """Angles per newton metre on the primary at 30 Hz: closed form."""
    pair = tv.assemble(tv.Powertrain(chain([1.8, 1.2], [12e3])))
    found = tv.harmonic_response(pair, tv.Excitation.unit("disc1", [1.0], [60 * np.pi])).angle.values[0, 0]
    assert found.real == pytest.approx([-2.11618759e-5, 8.28883610e-6], abs=5e-14, rel=0)
    assert found.imag == pytest.approx([0.0, 0.0], abs=1e-20)
