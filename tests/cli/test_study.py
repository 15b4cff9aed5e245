"""`torsional study`: a tool's signature as options, its Dataset as tables, files and a picture."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure
from tests.shipped import EXAMPLES

from torsional.cli.study import tables_of
from torsional.cli.study_group import options_of
from torsional.results import labelled, load_results
from torsional.studies import register
from torsional.studies.base import Tool, tool
from torsional.studies.trucks import Trucks
from torsional.units import RPM

Run = Callable[..., Any]


@tool("echo", varies="nothing", picture=lambda data: Figure())
def echo(
    trucks: Trucks,
    *,
    by: Annotated[tuple[float, ...], "speed", "how far down"] = (100 * RPM, 200 * RPM),
    limit: Annotated[float | None, "acceleration", "limit"] = None,
    count: Annotated[int, "how many"] = 3,
    best: Annotated[bool, "only the best"] = False,
    way: Annotated[str, "which way"] = "down",
) -> xr.Dataset:
    """Say what was asked.

    Nothing is computed.
    """
    told = {"inertia": (("speed",), np.full(len(by), count), "inertia")}
    found = labelled(told, {"speed": (by, "speed")}, analysis="study echo", asked=[limit, best, way])
    return found.assign_attrs(condition=trucks.smf.name, findings="first\nsecond")


@pytest.fixture(autouse=True)
def only_echo(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(register, "tools", lambda: {"echo": echo})


def test_options_are_read_with_their_units(torsional: Run) -> None:
    asked = ["--by", "50,10.471975511965978rad/s", "--limit", "300", "--count", "7", "--best", "--way", "up"]
    told = torsional("study", "echo", EXAMPLES / "truck_psva.yaml", *asked, "--json")
    document = json.loads(told.out)
    assert document["settings"]["options"]["by"] == pytest.approx([50 * RPM, 100 * RPM])
    assert document["result"]["variables"]["inertia"]["values"] == [7, 7]
    assert json.loads(document["result"]["attributes"]["asked"]) == [300.0, True, "up"]
    assert document["model"]["name"] == "13-litre truck with a power split absorber"


def test_defaults_findings_and_files(torsional: Run) -> None:
    told = torsional("study", "echo", "-o", "a.nc", "-o", "a.png", "-o", "a.csv")
    assert told.code == 0 and told.err.count("written") == 3
    assert told.out.startswith(
        "first\nsecond\nAsked under: 13-litre truck with a single mass flywheel.\n\nOver speed\n"
    )
    assert load_results("a.nc").speed.values == pytest.approx([100 * RPM, 200 * RPM])
    assert Path("a.png").read_bytes()[:4] == b"\x89PNG"


def test_help_tells_units_and_defaults(torsional: Run) -> None:
    text = " ".join(torsional("study", "echo", "--help").out.split())
    for part in ("Say what was asked.", "Varies nothing.", "How far down [rpm], several as 1,2,3; default: 100,200."):
        assert part in text
    assert "Limit [rad/s²]; default: from the truck." in text
    listed = torsional("study")
    assert listed.code == 0 and "Say what was asked." in listed.out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["ecko"], "there is no such study; found 'ecko'; did you mean 'echo'?"),
        (["echo", "--by", "fast"], "--by: a number is wanted"),
        (["echo", "--limit", "3 kg"], "--limit"),
        (["echo", "--count", "2.5"], "a whole number is wanted"),
        (["echo", "nix.yaml"], "there is no such file"),
        (["echo", "--set", "clutch.stifness=3"], "stiffness"),
        (["echo", "-o", "a.xyz"], "the ending of the file"),
        (["echo", "--nix"], "No such option"),
    ],
    ids=lambda value: "",
)
def test_refusals(torsional: Run, arguments: list[object], said: str) -> None:
    told = torsional("study", *arguments)
    assert told.code == 2 and said in told.err, told.err


def test_tables_of_one_and_two_dimensions() -> None:
    table = np.arange(6.0).reshape(2, 3)
    coordinates = {"gear": (np.array(["11", "12"]), ""), "speed": (np.array([1.0, 2.0, 3.0]) * RPM, "speed")}
    values = {"torque": (("gear", "speed"), table, "torque"), "twist": (("gear",), table[:, 0], "relative_angle")}
    long = {"curve": (("time",), np.zeros(100), "torque")}
    data = labelled({**values, **long}, {**coordinates, "time": (np.arange(100.0), "time")}, analysis="x")
    crossed, beside = tables_of(data)
    assert [column.heading for column in crossed.columns] == ["speed [rpm]", "11 [Nm]", "12 [Nm]"]
    assert crossed.cells()[2] == ["3", "2", "5"]
    assert [column.heading for column in beside.columns] == ["gear", "twist [deg]"]


@pytest.mark.parametrize("each", register.tools().values(), ids=lambda each: each.name)
def test_every_tool_says_what_its_options_are(each: Tool) -> None:
    assert each.about.endswith(".") and each.varies
    for option in options_of(each):
        assert option.words and option.kind in (float, int, str, bool), option
