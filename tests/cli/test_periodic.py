"""`torsional periodic` and `torsional subharmonic`: what they tell people, scripts and files, and what they refuse."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
import xarray as xr
from tests.shipped import EXAMPLES
from tests.synthetic_branches import FOLD, branches, region

import torsional.cli.periodic
from torsional.cli.periodic_tables import (
    bifurcation_table,
    branch_table,
    coexisting_table,
    largest_tables,
    motion_tables,
    places_of,
)
from torsional.cli.spans import Span, asked, quantity_at
from torsional.cli.subharmonic import tables
from torsional.errors import ModelError
from torsional.files import load_model
from torsional.laws import Hinges
from torsional.model import Model
from torsional.quantities.branches import solutions_at
from torsional.results import load_results
from torsional.units import RPM

Run = Callable[..., Any]
STAGED = str(EXAMPLES / "truck_dmf_two_stage.yaml")
LINEAR = str(EXAMPLES / "truck_smf.yaml")
AT_1200 = ["--speed", "800:1000rpm", "--torque", "1200Nm"]


@pytest.fixture(scope="module")
def model() -> Model:
    return load_model(STAGED)


# --- periodic ---


def test_tables_for_people(torsional: Run) -> None:
    told = torsional("periodic", STAGED, *AT_1200, "--at", "900rpm")
    assert (told.code, told.err) == (0, "")
    wanted = ["period doubling of 0", "839.53 to 963.29", "joined the branch it left", "Largest stable acceleration"]
    wanted += ["Motions at 900 rpm in gear 12, mean torque 1200 Nm: torque of dmf", "order 1.5 0-peak [Nm]", "time in"]
    assert [text for text in wanted if text not in told.out] == []


def document(torsional: Run, *arguments: str) -> dict[str, Any]:
    told = torsional("periodic", STAGED, *arguments, "--json")
    assert (told.code, told.err) == (0, "")
    return dict(json.loads(told.out))


def test_one_point_is_the_same_along_speed_torque_and_stiffness(torsional: Run) -> None:
    """At 900 rpm, 1200 Nm and 24 kNm/rad three ways meet, each on a branch of its own."""
    ways = [
        [*AT_1200, "--at", "900rpm"],
        ["--speed", "900rpm", "--torque", "900:1500Nm", "--at", "1200Nm"],
        [
            *("--speed", "900rpm", "--torque", "1200Nm", "--at", "24kNm/rad"),
            "-p",
            "absorber.stages.1.stiffness=18:26kNm/rad",
        ],
    ]
    found = []
    for way in ways:
        motions = document(torsional, *way)["motions"]["variables"]
        assert motions["stable"]["values"] == [False, True]
        torque = np.array(motions["torque"]["real"]) + 1j * np.array(motions["torque"]["imaginary"])
        found.append(np.abs(torque[:, :, 0]))
    assert found[1] == pytest.approx(found[0], rel=1e-6, abs=1e-6)
    assert found[2] == pytest.approx(found[0], rel=1e-6, abs=1e-6)
    assert found[0][1, 1] > 100  # order 1.5 on the doubled branch


def test_settings_say_what_was_followed(torsional: Run) -> None:
    settings = document(torsional, "--speed", "900rpm", "--torque", "900:1500Nm")["settings"]
    low, high = ({"value": value, "units": "Nm"} for value in (900.0, 1500.0))
    assert settings["parameter"] == {"name": "mean_torque", "from": low, "to": high}
    assert settings["speed"] == {"value": pytest.approx(900 * RPM), "units": "rad/s"}
    assert "torque" not in settings
    assert settings["orders"] == [3.0, 1.5]


def test_files_of_every_kind(torsional: Run) -> None:
    outputs = [f"out{suffix}" for suffix in (".nc", ".csv", ".json", ".png", ".svg")]
    more = [part for name in outputs for part in ("-o", name)]
    told = torsional("periodic", STAGED, *AT_1200, "--at", "900rpm", "--json", *more)
    assert told.code == 0, told.err
    assert Path("out.json").read_text(encoding="utf-8") == told.out
    assert Path("out.png").read_bytes().startswith(b"\x89PNG")
    assert ElementTree.parse("out.svg").getroot().tag.endswith("svg")
    saved = load_results("out.nc")
    assert saved.sizes["element"] > 10  # everything, not only what was looked at
    rows = list(csv.DictReader(io.StringIO(Path("out.csv").read_text(encoding="utf-8-sig"))))
    assert len(rows) == saved.sizes["point"] * saved.sizes["order"]
    assert [float(row["speed [rpm]"]) for row in rows[::13]] == pytest.approx(list(saved.speed.values / RPM))
    last = rows[saved.sizes["order"] * 20 + 1]
    here = saved.torque.isel(point=20, order=1).sel(element="dmf").item()
    assert complex(float(last["torque dmf real [Nm]"]), float(last["torque dmf imaginary [Nm]"])) == here
    assert int(last["branch"]) == int(saved.branch[20])


def test_orders_and_places_may_be_chosen(torsional: Run) -> None:
    told = torsional("periodic", STAGED, *AT_1200, "-n", "4.5", "--element", "clutch", "-o", "p.png")
    assert told.code == 0, told.err
    assert "order 4.5, 0-peak" in told.out and "clutch" in told.out
    assert "gearbox_input" not in told.out and "order 3, 0-peak" not in told.out


def test_the_motions_are_those_of_the_changed_model(torsional: Run) -> None:
    """The stages of a spring that is varied are those at the value looked at, not those of the file."""
    way = ["--speed", "900rpm", "--torque", "1200Nm", "-p", "absorber.stages.0.up_to=1000:1400Nm", "--at", "1400Nm"]
    varied, fixed = (
        torsional("periodic", STAGED, *arguments).out
        for arguments in (way, [*AT_1200, "--at", "900rpm", "--set", "absorber.stages.0.up_to=1400Nm"])
    )
    shares = [next(row for row in out.splitlines() if row.startswith("A ")).split("  ")[-1] for out in (varied, fixed)]
    assert shares[0] == shares[1]
    assert "stage 1" in shares[0]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--speed", "900rpm"], ["--speed", "nothing varies", "500:1200rpm"]),
        (["--speed", "600:1200:20rpm"], ["--speed", "steps", "third number"]),
        (["--speed", "600:900rpm", "--torque", "900:1200Nm"], ["--speed", "only one thing may vary"]),
        (["--speed", "600:900rpm", "--at", "950rpm"], ["--at", "950 rpm", "600 rpm to 900 rpm"]),
        (["--speed", "600:900rpm", "--at", "950Nm"], ["--at", "torque", "angular velocity is wanted"]),
        (["--speed", "-600:900rpm"], ["--speed", "backwards"]),
        (["--speed", "600:900rpm", "--order", "2.3"], ["--order", "no branch has this order", "2.3", "3, "]),
        (["--parameter", "absorber.damping"], ["--parameter", "path=range", "'absorber.damping'"]),
        (["--parameter", "absorber.damping=20"], ["--parameter", "path=range"]),
        (["--parameter", "absorber.dampin=2:20"], ["absorber.dampin", "did you mean 'damping'?"]),
        (["--parameter", "name=2:20"], ["name", "a text is wanted"]),
        (["--parameter", "absorber.damping=2:20 Nm"], ["--parameter absorber.damping", "torque", "damping is wanted"]),
        (["--parameter", "absorber.damping=2:20", "--speed", "600:900rpm"], ["--speed", "only one thing may vary"]),
        (["--element", "dnf"], ["--element", "did you mean 'dmf'?"]),
        (["--gear", "all"], ["--gear", "one gear"]),
        (["-o", "out.xls"], ["--output", "'.xls'"]),
    ],
    ids=lambda value: " ".join(value) if value and value[0].startswith("-") else "",
)
def test_bad_lines_are_answered_in_one_sentence(torsional: Run, arguments: list[str], told: list[str]) -> None:
    answer = torsional("periodic", STAGED, *arguments)
    assert (answer.code, answer.out) == (2, "")
    *warnings, error = answer.err.splitlines()
    assert all(line.startswith("warning: ") for line in warnings)
    assert error.startswith("error: ")
    assert [part for part in told if part not in error] == []
    assert list(Path().iterdir()) == []


@pytest.mark.parametrize("command", ["periodic", "subharmonic"])
def test_a_linear_model_is_told_which_springs_could_have_stages(torsional: Run, command: str) -> None:
    told = torsional(command, LINEAR)
    assert (told.code, told.out) == (2, "")
    assert told.err.count("\n") == 1
    assert "give clutch stages" in told.err
    changes = [part.split("'")[0] for part in told.err.split("--set '")[1:]]
    assert torsional("check", LINEAR, "--set", changes[0], "--set", "clutch.stiffness=null").code == 0


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.yaml")), ids=lambda path: path.stem)
def test_shipped_models_are_answered_or_refused_in_one_sentence(torsional: Run, path: Path) -> None:
    told = torsional("periodic", path, "--speed", "700:900rpm")
    assert told.code in (0, 2), told.err
    assert sum(line.startswith("error: ") for line in told.err.splitlines()) == (told.code == 2)
    assert all(line.startswith(("error: ", "warning: ")) for line in told.err.splitlines())
    assert bool(told.out) == (told.code == 0)


def test_ctrl_c_writes_nothing(torsional: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(torsional_periodic(), "model_response", stopped)
    told = torsional("periodic", STAGED, "-o", "out.png")
    assert (told.code, told.out, told.err) == (130, "", "stopped, nothing written\n")
    assert list(Path().iterdir()) == []


def torsional_periodic() -> Any:
    return torsional.cli.periodic


@pytest.mark.full
def test_after_warmup_nothing_is_left_to_compile(process: Run, tmp_path: Path) -> None:
    kept = tmp_path / "kernels"
    assert process("warmup", NUMBA_CACHE_DIR=str(kept)).code == 0
    before = sorted(path.name for path in kept.rglob("*.nbc"))
    for command in (["periodic", *AT_1200, "--at", "900rpm"], ["subharmonic", *SMALL]):
        assert process(command[0], STAGED, *command[1:], "--quiet", NUMBA_CACHE_DIR=str(kept)).code == 0
        assert sorted(path.name for path in kept.rglob("*.nbc")) == before, command[0]


# --- what is typed ---


@pytest.mark.parametrize(
    ("path", "quantity"),
    [
        ("absorber.stages.1.stiffness", "stiffness"),
        ("absorber.stages.0.up_to", "torque"),
        ("absorber.damping", "damping"),
        ("absorber.secondary_inertia", "inertia"),
        ("clutch.inertia", "inertia"),
        ("gearbox.ratios.11", "gear_ratio"),
        ("gearbox.stiffness.2", "stiffness"),
        ("crankshaft.damper.stiffness", "stiffness"),
        ("vehicle.mass", "mass"),
    ],
)
def test_quantities_of_paths(model: Model, path: str, quantity: str) -> None:
    assert quantity_at(model, path) == quantity


@pytest.mark.parametrize("path", ["absorber.stages", "absorber", "name", "nothing", "absorber.stages.7.stiffness"])
def test_paths_without_a_number_are_refused(model: Model, path: str) -> None:
    with pytest.raises(ModelError):
        asked(model, "", "", f"{path}=1:2")


def test_what_stays_the_same_is_told(model: Model) -> None:
    assert asked(model, "", "", "").told == "full load"
    assert asked(model, "600:900rpm", "1200Nm", "").told == "mean torque 1200 Nm"
    assert asked(model, "900rpm", "500:2000Nm", "").told == "900 rpm"
    both = asked(model, "900rpm", "1200Nm", "absorber.damping=5:50")
    assert (both.told, both.quantity, both.low) == ("900 rpm, mean torque 1200 Nm", "damping", 5.0)


# --- tables, on branches in closed form ---


@pytest.fixture
def result() -> xr.Dataset:
    return branches()


def test_branches_are_told_with_their_stable_ranges(result: xr.Dataset) -> None:
    rows = branch_table(result, "speed", "Periodic motions").cells()
    rpm = [f"{value / RPM:.5g}" for value in (50, 90, 110, 150)]
    assert rows[0][:6] == ["0", "main", "3", rpm[0], rpm[3], f"{rpm[0]} to {rpm[1]}, {rpm[2]} to {rpm[3]}"]
    assert rows[1][1:] == [
        "period doubling of 0",
        "1.5",
        rpm[1],
        rpm[2],
        f"{rpm[1]} to {rpm[2]}",
        "joined the branch it left",
    ]
    assert rows[2][1] == "isolated"


def test_bifurcations_and_coexisting_motions(result: xr.Dataset) -> None:
    places = places_of(result, ["crankshaft"], ["dmf"])
    rows = bifurcation_table(result, "speed", places, [3.0, 1.5]).rows
    assert [row[0] for row in rows] == ["period doubling", "period doubling", "fold", "fold"]
    assert [row[2] for row in rows] == pytest.approx([90, 110, 130 + FOLD, 130 - FOLD])
    assert rows[0][3] == pytest.approx(320.0)
    assert rows[0][4] == pytest.approx(0.0032 * (3 * 90) ** 2)
    told = coexisting_table(result, "speed").rows
    assert [row[2] for row in told] == [2, 3, 2]
    assert [row[3] for row in told] == ["0, 2"] * 3


def test_largest_motions_are_stable_ones(result: xr.Dataset) -> None:
    torques, accelerations = largest_tables(result, "speed", places_of(result, ["crankshaft"], ["dmf"]), [3.0, 1.5])
    assert torques.rows[0][1:] == ["order 3, 0-peak", pytest.approx(740.0), pytest.approx(130 + 13.44), 2]
    assert torques.rows[1][1:] == ["order 1.5, 0-peak", pytest.approx(600.0), pytest.approx(100.0), 1]
    assert accelerations.rows[0][2] == pytest.approx(740e-5 * (3 * 143.44) ** 2)
    none = result.assign(torque=result.torque.where(result.order != 1.5, 0))
    assert largest_tables(none, "speed", places_of(none, [], ["dmf"]), [1.5])[0].rows[0][2:] == [0.0, None, None]


def test_motions_tell_orders_and_stages(result: xr.Dataset) -> None:
    motions = solutions_at(result, 100.0)
    law = Hinges.staged([(1000.0, 8e3), (3500.0, 24e3)])
    spring, node = motion_tables(motions, places_of(motions, ["input"], ["dmf"]), [3.0, 1.5], {"dmf": law}, "955 rpm")
    assert [row[:3] for row in spring.rows] == [["A", 0, "no"], ["B", 1, "yes"]]
    assert [row[4:6] for row in spring.rows] == [[pytest.approx(300), 0], [pytest.approx(300), pytest.approx(600)]]
    assert spring.rows[0][6] == pytest.approx(300.0, rel=1e-3)
    assert str(spring.rows[0][8]).startswith("stage 1 ")
    assert len(node.rows[0]) == 7


# --- subharmonic ---


SMALL = ["--speed", "800:1000:20rpm", "--torque", "1100:1300:100 Nm"]


def test_the_region_is_told(torsional: Run) -> None:
    outputs = [f"out{suffix}" for suffix in (".nc", ".csv", ".json", ".png", ".svg")]
    more = [part for name in outputs for part in ("-o", name)]
    told = torsional("subharmonic", STAGED, *SMALL, *more)
    assert told.code == 0, told.err
    rows = [line.split() for line in told.out.splitlines() if line.strip()[:4] in ("1100", "1200", "1300")]
    assert [row[0] for row in rows] == ["1100", "1200", "1300"]
    followed = document(torsional, *AT_1200)["result"]["variables"]["bifurcation_speed"]["values"]
    assert [float(value) for value in rows[1][1:3]] == pytest.approx([value / RPM for value in followed], abs=0.2)
    saved = load_results("out.nc")
    table = list(csv.reader(io.StringIO(Path("out.csv").read_text(encoding="utf-8-sig"))))
    assert len(table) == 1 + saved.amplitude.size
    assert {"mean_torque [Nm]", "speed [rpm]", "amplitude [Nm]", "within_full_load"} <= set(table[0])
    assert json.loads(Path("out.json").read_text(encoding="utf-8"))["settings"]["order"] == 1.5


def test_a_map_and_a_branch_agree(torsional: Run) -> None:
    assert torsional("subharmonic", STAGED, *SMALL, "-o", "map.nc", "-q").code == 0
    size = float(load_results("map.nc").amplitude.sel(mean_torque=1200.0).sel(speed=900 * RPM, method="nearest"))
    motions = document(torsional, *AT_1200, "--at", "900rpm")["motions"]["variables"]["torque"]
    assert size == pytest.approx(np.hypot(motions["real"][1][1][0], motions["imaginary"][1][1][0]), rel=1e-6)


def test_where_there_is_none_it_is_said(torsional: Run) -> None:
    told = torsional("subharmonic", STAGED, "--speed", "1500:1600:50rpm", "--torque", "500:700:100Nm", "-o", "p.png")
    assert told.code == 0, told.err
    assert "no sub-harmonic vibration" in told.out and "none found" in told.out
    assert Path("p.png").exists()


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--speed", "900rpm"], ["--speed", "a region needs a range", "torsional periodic"]),
        (["--torque", "900Nm"], ["--torque", "a region needs a range"]),
        (["--points", "1"], ["--points"]),
        (["--node", "inputt"], ["--node", "there is no node"]),
        (["--element", "dnf"], ["--element", "did you mean 'dmf'?"]),
    ],
    ids=lambda value: " ".join(value) if value and value[0].startswith("-") else "",
)
def test_bad_regions_are_refused(torsional: Run, arguments: list[str], told: list[str]) -> None:
    answer = torsional("subharmonic", STAGED, *arguments)
    assert (answer.code, answer.out) == (2, "")
    assert [part for part in told if part not in answer.err] == []


def test_what_lies_above_full_load_is_not_told() -> None:
    found = region()
    above = found.mean_torque.values[:, None] * np.ones(found.sizes["speed"]) < 1100
    summary, rows = tables(found.assign(within_full_load=(("mean_torque", "speed"), above)), "Order 1.5")
    assert max(float(str(row[5])) for row in summary.rows) < 1100
    assert max(float(str(row[0])) for row in rows.rows) < 1100
    nothing = found.assign(within_full_load=(("mean_torque", "speed"), np.zeros_like(above)))
    assert "though there is some above it" in str(tables(nothing, "Order 1.5")[0].rows)


# --- what is warned of ---


def test_ranges_without_a_stable_motion_are_warned_of(result: xr.Dataset, capsys: pytest.CaptureFixture[str]) -> None:
    span = Span("speed", "speed", 50.0, 150.0)
    torsional.cli.periodic.warn_unsettled(result, span)
    assert capsys.readouterr().err == ""
    main = result.isel(point=result.branch.values == 0, bifurcation=result.on_branch.values == 0)
    ends = f"from {90 / RPM:.5g} rpm to {110 / RPM:.5g} rpm"
    torsional.cli.periodic.warn_unsettled(main, span)
    assert capsys.readouterr().err.startswith(f"warning: no stable periodic motion was found {ends}; a wider range")
    torus = main.assign(bifurcation_type=("bifurcation", np.full(main.sizes["bifurcation"], "Neimark–Sacker")))
    torsional.cli.periodic.warn_unsettled(torus, span)
    assert "a frequency there that is no order of the engine" in capsys.readouterr().err


def test_a_branch_that_crosses_the_whole_range_is_found(torsional: Run) -> None:
    """Inside of the region neither end of the doubled branch is in sight."""
    told = torsional("periodic", STAGED, "--speed", "880:940rpm", "--torque", "1200Nm")
    assert (told.code, told.err) == (0, "")
    assert "880 to 940" in told.out and "623.2" in told.out
