"""Tables of inertias and stiffnesses: the line they mean, and what is wrong with one told by its line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import torsional as tv
from torsional.errors import ModelError
from torsional.exchange.documents import yaml_of

TABLE = """node; inertia [kgm²]; stiffness [kNm/rad]; damping [Nms/rad]; ratio; ground_damping [Nms/rad]; to
engine; 2.1; 25; 10; ; 0.5;
gear in; 0.1; 30; ; 2.5; ;
out; 0.5; 10; ; ; ;
load; 80; ; ; ; ;
pump; 0.02; ; ; -0.5; ; gear in
"""


def read(folder: Path, text: str) -> tv.Model:
    (folder / "line.csv").write_text(text, encoding="utf-8")
    return tv.read_inertia_table(folder / "line.csv")


def test_a_table_is_a_line_with_gears_and_a_branch(tmp_path: Path) -> None:
    model = read(tmp_path, TABLE)
    parts = model.components
    assert parts["engine to gear in"] == tv.Shaft("engine", "gear in", 25e3, 10.0)
    assert parts["gear in to out gear"] == tv.GearPair("gear in end", "out", 2.5)
    assert parts["pump to gear in"] == tv.GearPair("pump", "gear in", -0.5)
    assert parts["engine to ground"] == tv.Damper("engine", "ground", 0.5)
    # referred to the engine's side: the output's inertias and stiffness over the square of its ratio
    J = np.diag([2.1, 0.1 + 0.02 / 4, 0.5 / 2.5**2, 80 / 2.5**2])
    k = [25e3, 30e3, 10e3 / 2.5**2]
    K = sum(s * np.outer(w, w) for s, w in zip(k, np.diff(np.eye(4), axis=0), strict=True))
    expected = np.sqrt(np.abs(np.sort(np.linalg.eigvals(np.linalg.solve(J, K)).real))) / (2 * np.pi)
    found = tv.modal(tv.assemble(model.powertrain())).frequency.values
    np.testing.assert_allclose(found[1:], expected[1:], rtol=1e-12)


def test_the_model_file_of_a_table_is_the_same_line(tmp_path: Path) -> None:
    model = read(tmp_path, TABLE)
    (tmp_path / "line.yaml").write_text(yaml_of(model), encoding="utf-8")
    assert tv.load_model(tmp_path / "line.yaml").components == model.components


HEAD = "node,inertia [kgm2],stiffness [Nm/rad]"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("node,inertia [kgm2]\na,1\nb,2\n", r"column 'stiffness' is missing"),
        (f"{HEAD},stifness [Nm/rad]\na,1,2,3\nb,1,,\n", r"column is unknown.*did you mean 'stiffness'"),
        ("node,inertia,stiffness [Nm/rad]\na,1,2\nb,1,\n", r"names no unit; write 'inertia \[kgm²\]'"),
        ("node,inertia [mm],stiffness [Nm/rad]\na,1,2\nb,1,\n", r"line 2, column 'inertia'.*mm is a length"),
        (f"{HEAD}\na,1,2\na,1,\n", r"line 2: the node stands twice"),
        (f"{HEAD}\na,1,2\nb,-1,\n", r"line 3.*inertia.*found -1"),
        (f"{HEAD}\na,1,2\nb,x,\n", r"line 3, column 'inertia'.*found 'x"),
        (f"{HEAD}\na,1,2\nb,1,3\n", r"line 3.*there is no next node.*stiffness empty"),
        (f"{HEAD},to\na,1,2,c\nb,1,,\n", r"there is no such node; found 'c'"),
        (f"{HEAD}\na,1,2\nb,1,,\n", r"line 3: 3 cells are wanted; found 4 cells"),
        (f"{HEAD}\na,1,2\nground,1,\n", r"line 3, column 'node': this cannot be a name"),
        (f"{HEAD}\na,1,\nb,1,\n", "hang together|parts|connected"),
        (f"{HEAD}\na,1,2\n", r"a header and at least two rows"),
    ],
)
def test_what_is_wrong_is_told_with_its_line(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(ModelError, match=words) as told:
        read(tmp_path, text)
    assert str(told.value).startswith(str(tmp_path / "line.csv"))
