"""Assemblies of openTorsion: the eigenvalues that openTorsion itself finds, undamped and damped."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import torsional as tv
from torsional.errors import ModelError
from torsional.exchange.documents import yaml_of

ot = pytest.importorskip("opentorsion")


def assembly() -> Any:
    """Every kind of element: shafts by numbers and by dimensions, damped disks, rigid and elastic gears."""
    pinion = ot.Gear(2, 0.3, 50)
    soft = ot.ElasticGear(4, 0.2, 40)
    shafts = [
        ot.Shaft(0, 1, k=2e4, c=3.0, I=0.01),
        ot.Shaft(1, 2, L=800, odl=60, idl=10),
        ot.Shaft(3, 4, k=5e4, c=1.0),
        ot.Shaft(5, 6, k=8e4),
    ]
    disks = [ot.Disk(0, 1.2, c=0.5), ot.Disk(1, 0.7), ot.Disk(6, 4.0), ot.Disk(6, 0.1)]
    wheels = [ot.ElasticGear(5, 0.5, 100, k=3e5, c=5.0, parent=soft)]
    return ot.Assembly(shafts, disks, [pinion, ot.Gear(3, 0.9, 120, parent=pinion)], [soft, *wheels])


def test_natural_frequencies_are_opentorsions_own() -> None:
    own = assembly()
    expected = np.sort(np.sqrt(np.abs(own.undamped_modal_analysis()[0].real))) / (2 * np.pi)
    found = tv.modal(tv.assemble(tv.from_opentorsion(own).powertrain())).frequency.values
    assert expected.size == 6
    np.testing.assert_allclose(found[1:], expected[1:], rtol=1e-9)


def test_damped_eigenvalues_are_opentorsions_own() -> None:
    own = assembly()
    expected = np.linalg.eigvals(own.state_space()[0])
    swinging = np.sort_complex(expected[expected.imag > 1.0])
    found = tv.damped_modes(tv.assemble(tv.from_opentorsion(own).powertrain())).eigenvalue.values
    np.testing.assert_allclose(np.sort_complex(found[found.imag > 1.0]), swinging, rtol=1e-9)


def test_the_model_file_has_the_same_modes(tmp_path: Path) -> None:
    model = tv.from_opentorsion(assembly())
    (tmp_path / "line.yaml").write_text(yaml_of(model), encoding="utf-8")
    again = tv.load_model(tmp_path / "line.yaml")
    assert again.components == model.components


TORS = {
    "name": "a pump",
    "structure": [["motor.coupling", "pump.disk"]],
    "components": [
        {
            "name": "motor",
            "elements": [
                {"type": "Disk", "name": "rotor", "inertia": 0.4, "damping": 0.1},
                {"type": "ShaftDiscrete", "name": "coupling", "stiffness": 9e3, "damping": 2.0},
            ],
        },
        {"name": "pump", "elements": [{"type": "Disk", "name": "disk", "inertia": 0.1, "damping": 0.0}]},
    ],
}


def test_files_in_its_own_form_are_read(tmp_path: Path) -> None:
    (tmp_path / "pump.json").write_text(json.dumps(TORS), encoding="utf-8")
    model = tv.read_tors(tmp_path / "pump.json")
    assert model.name == "a pump"
    frequency = tv.modal(tv.assemble(model.powertrain())).frequency.values[1]
    assert frequency == pytest.approx(np.sqrt(9e3 * (1 / 0.4 + 1 / 0.1)) / (2 * np.pi), rel=1e-12)


@pytest.mark.parametrize("text", ["{", "[]", '{"structure": []}'])
def test_other_files_are_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "x.json").write_text(text, encoding="utf-8")
    with pytest.raises(ModelError, match="openTorsion does not read this file"):
        tv.read_tors(tmp_path / "x.json")


def test_what_is_no_assembly_is_refused() -> None:
    with pytest.raises(ModelError, match=r"from_opentorsion\(assembly\): an Assembly is wanted; found a dict"):
        tv.from_opentorsion({})


def test_the_missing_library_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "opentorsion.assembly", None)
    with pytest.raises(ModelError, match="pip install opentorsion"):
        tv.read_tors(tmp_path / "x.json")
