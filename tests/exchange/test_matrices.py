"""Matrices in files: whoever reads them finds the same eigenvalues."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from scipy.io import loadmat
from tests.shipped import shipped

import torsional as tv
from torsional.errors import ModelError

ROUND = 2 * np.pi


def frequencies(M: np.ndarray, K: np.ndarray) -> np.ndarray:
    found: np.ndarray = np.sqrt(np.abs(np.sort(np.linalg.eigvals(np.linalg.solve(M, K)).real))) / ROUND
    return found


@pytest.mark.parametrize("torque", [500.0, 2000.0])
def test_eigenvalues_of_a_mat_file_are_ours(tmp_path: Path, torque: float) -> None:
    model = shipped("truck_dmf_two_stage")  # whose second stage begins at 1000 Nm
    tv.write_matrices(tv.matrices(model, torque=torque), tmp_path / "m.mat")
    file = loadmat(tmp_path / "m.mat", simplify_cells=True)
    expected = tv.modal(tv.at_operating_point(model, torque)[0])
    np.testing.assert_allclose(frequencies(file["M"], file["K"])[1:], expected.frequency.values[1:], rtol=1e-9)
    assert list(file["nodes"]) == expected.node.values.tolist()
    assert (file["units"]["K"], file["mean_torque_Nm"], file["name"]) == ("Nm/rad", torque, model.name)
    A = np.block([[np.zeros_like(file["M"]), np.eye(len(file["M"]))], [-file["K"], -file["C"]]])
    A[len(file["M"]) :] = np.linalg.solve(file["M"], A[len(file["M"]) :])
    damped = tv.damped_modes(tv.at_operating_point(model, torque)[0]).eigenvalue.values
    own = damped[damped.imag > 1.0]
    found = np.linalg.eigvals(A)
    assert max(np.abs(found - value).min() / abs(value) for value in own) < 1e-9


def test_the_table_holds_every_digit_and_the_nodes_of_gears(tmp_path: Path) -> None:
    told = tv.matrices(shipped("truck_dmf"), torque=1200.0, gear=1)
    tv.write_matrices(told, tmp_path / "m.csv")
    lines = (tmp_path / "m.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0] == f"# {told.name}, mean torque 1200.0 Nm, speed 0.0 rad/s"
    head, *rows = csv.reader(line for line in lines if not line.startswith("#"))
    assert head[2:] == list(told.coordinates)
    for name, label in (("M", "M [kgm²]"), ("C", "C [Nm s/rad]"), ("K", "K [Nm/rad]"), ("T", "T")):
        found = np.array([row[2:] for row in rows if row[0] == label], dtype=float)
        np.testing.assert_array_equal(found, getattr(told, name))
    assert [row[1] for row in rows if row[0] == "T"] == list(told.nodes)
    assert not np.array_equal(told.T, np.eye(len(told.T)))  # a gear ties two nodes


def test_pendulums_stiffen_with_speed() -> None:
    model = shipped("truck_dmf_pendulum")
    still, turning = (tv.matrices(model, torque=500.0, speed=speed) for speed in (0.0, 150.0))
    system = tv.at_operating_point(model, 500.0)[0]
    np.testing.assert_allclose(turning.K - still.K, 150.0**2 * system.S, atol=1e-9)
    assert np.abs(system.S).max() > 0


def test_laws_and_other_endings_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"nonlinear|linear"):
        tv.matrices(tv.assemble(shipped("truck_dmf_two_stage").powertrain()))
    with pytest.raises(ModelError, match=r"matrices go to .mat or .csv"):
        tv.write_matrices(tv.matrices(shipped("truck_dmf"), torque=100.0), tmp_path / "m.xlsx")
