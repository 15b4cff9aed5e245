"""Stamps against the textbook matrices."""

import numpy as np
import pytest

from torsional.components import Coupling, DistributedShaft, Inertia, Shaft, Vehicle, blocks
from torsional.errors import ModelError
from torsional.powertrain import Powertrain
from torsional.system import assemble


def test_consistent_element_matrices() -> None:
    """One element between two discs: k [[1, −1], [−1, 1]] and J/6 [[2, 1], [1, 2]]."""
    shaft = DistributedShaft("a", "b", length=2.0, outer_diameter=0.2, inner_diameter=0.1, elements=1)
    system = assemble(Powertrain({"a": Inertia(1.0), "b": Inertia(3.0), "tube": shaft}))
    ip = np.pi * (0.2**4 - 0.1**4) / 32
    k, j = 80e9 * ip / 2.0, 7850 * ip * 2.0
    assert np.allclose(system.K, k * np.array([[1, -1], [-1, 1]]), rtol=1e-13)
    assert np.allclose(system.M, np.diag([1.0, 3.0]) + j / 6 * np.array([[2, 1], [1, 2]]), rtol=1e-13)


def test_loss_factor_is_the_imaginary_stiffness() -> None:
    pair = {"a": Inertia(1.0), "b": Inertia(1.0), "s": Shaft("a", "b", 1e3, loss_factor=0.1)}
    assert assemble(Powertrain(pair)).H[0, 0] == pytest.approx(100.0)


def test_vehicle_is_m_r_squared() -> None:
    assert assemble(Powertrain({"v": Vehicle(40e3, 0.5)})).M[0, 0] == 10_000.0


def test_lists_of_the_wrong_length_are_refused() -> None:
    with pytest.raises(
        ModelError, match=r"crankshaft\.throw_inertia.*found 3 values; allowed: one number, or a list of 4"
    ):
        blocks.crankshaft(4, [0.1, 0.1, 0.1], 1e6, flange="f", flange_stiffness=1e6)


def test_a_coupling_with_a_number_for_a_law_is_refused() -> None:
    with pytest.raises(ModelError, match=r"law: a Law is wanted; found 13000.0; a plain spring is Hinges"):
        Coupling("a", "b", 13e3)  # type: ignore[arg-type]
