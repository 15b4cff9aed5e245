"""Commands that write units and matrices, and make model files of tables."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import numpy as np
import pytest
from scipy.io import loadmat
from tests.cli.conftest import Run
from tests.exchange.compiled import needs_compiler
from tests.shipped import shipped

import torsional as tv

TABLE = "node,inertia [kgm2],stiffness [kNm/rad]\nengine,1.2,25\nload,80,\n"


@needs_compiler
def test_fmu_says_what_is_in_the_unit(torsional: Run, truck: str) -> None:
    told = torsional("fmu", truck, "--absorber", "-o", "dmf.fmu")
    assert told.code == 0, told.err
    assert "compiled for" in told.out and "primary.angle, primary.speed, primary.acceleration … 6 in all" in told.out
    with zipfile.ZipFile("dmf.fmu") as archive:
        assert {"modelDescription.xml", "sources/all.c", "sources/core.h"} <= set(archive.namelist())


def test_fmu_of_a_line_as_json(torsional: Run, truck: str) -> None:
    asked = ("--sources", "--fmi", "3", "--gear", "11", "-i", "vehicle", "-t", "1200Nm")
    asked += ("-s", "1000rpm", "--step", "0.05ms")
    told = torsional("fmu", truck, *asked, "--json", "-o", "line.fmu")
    assert told.code == 0, told.err
    document = json.loads(told.out)
    assert document["inputs"] == ["vehicle.applied_torque"]
    assert document["platform"] is None and document["step"] == {"value": 5e-5, "units": "s"}
    assert Path("line.fmu").stat().st_size == document["size"]["value"]
    assert "gearbox_input.acceleration" in document["outputs"]


@pytest.mark.parametrize(
    ("more", "words"),
    [
        (("--fmi", "1.0"), "this version of FMI is not written"),
        (("-o", "unit.zip"), "this one is not known here"),
        (("--absorber", "--gear", "3"), "--gear: an absorber alone has no such thing"),
        (("-i", "crank"), "there is no node 'crank'"),
        (("--step", "0"), "--step: must be positive"),
    ],
)
def test_fmu_refuses_and_writes_nothing(torsional: Run, truck: str, more: tuple[str, ...], words: str) -> None:
    told = torsional("fmu", truck, "--sources", *more)
    assert (told.code, told.out) == (2, "")
    assert words in told.err and len(told.err.strip().splitlines()) == 1
    assert not list(Path.cwd().iterdir())


def test_export_writes_matrices_and_prints_them_without_a_file(torsional: Run, truck: str) -> None:
    told = torsional("export", truck, "-t", "1200", "-o", "m.mat", "-o", "m.csv", "-o", "m.json")
    assert told.code == 0 and told.out == "", told.err
    expected = tv.matrices(shipped("truck_dmf"), torque=1200.0)
    np.testing.assert_array_equal(loadmat("m.mat")["K"], expected.K)
    document = json.loads(Path("m.json").read_text(encoding="utf-8"))
    np.testing.assert_array_equal(document["matrices"]["M"]["values"], expected.M)
    printed = torsional("export", truck, "-t", "1200").out
    assert printed.splitlines() == Path("m.csv").read_text(encoding="utf-8").splitlines()


def test_import_makes_a_model_file_of_a_table(torsional: Run) -> None:
    Path("line.csv").write_text(TABLE, encoding="utf-8")
    assert torsional("import", "line.csv", "-o", "line.yaml").code == 0
    assert tv.load_model("line.yaml").components["load"] == tv.Inertia(80.0)
    told = torsional("modes", "line.yaml")
    assert told.code == 0 and "23.1" in told.out, told.err  # √(25e3 (1/1.2 + 1/80))/2π
    again = torsional("import", "line.csv", "-o", "line.yaml")
    assert again.code == 2 and "the file is there already" in again.err
    assert torsional("import", "line.csv", "-o", "line.yaml", "--force").code == 0
    assert torsional("import", "line.csv").out == Path("line.yaml").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("line.xlsx", "the ending says what is read"),
        ("none.csv", "there is no such file"),
        ("bad.csv", "line 3, column 'inertia'"),
    ],
)
def test_import_refuses_in_one_sentence(torsional: Run, name: str, words: str) -> None:
    Path("line.xlsx").write_text("x", encoding="utf-8")
    Path("bad.csv").write_text(TABLE.replace("80", "eighty"), encoding="utf-8")
    told = torsional("import", name, "-o", "x.yaml")
    assert told.code == 2 and words in told.err and len(told.err.strip().splitlines()) == 1
    assert not Path("x.yaml").exists()
