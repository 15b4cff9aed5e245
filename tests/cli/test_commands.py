"""Every command on the shipped models: what it tells people, scripts and files."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import jsonschema
import numpy as np
import pytest
from numba.core.event import end_event, start_event
from ruamel.yaml import YAML
from tests.shipped import ROOT

from torsional.cli import modes
from torsional.files import load_model
from torsional.files.starter import KINDS
from torsional.numerics import compiling
from torsional.quantities import SAMPLES
from torsional.results import load_results
from torsional.system import assemble

Run = Callable[..., Any]

ANALYSES = {
    "modes": ["--gear", "11,12"],
    "respond": ["--speed", "600:1000:100rpm", "--order", "3", "--order", "1.5"],
    "map": ["--speed", "600:1000:200rpm", "--torque", "500:1500:500 Nm", "--orders", "0.5:3"],
    "campbell": ["--gear", "all"],
}
CASES = [pytest.param(name, more, id=name) for name, more in ANALYSES.items()]


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        (["check"], ["dual mass flywheel", "to the stop [deg]", "First elastic modes", "full load peak"]),
        (["modes"], ["frequency [Hz]", "DMF mode", "clutch mode", "order 3 meets it at [rpm]", "dmf 63 %"]),
        (["respond"], ["half peak-to-peak", "sum as a bound", "gearbox_input", "clutch", "peak [rad/s²]", "full load"]),
        (["map", "--worst", "1"], ["cells within full load", "gearbox_input", "bound [Nm]", "1 gears × 26 torques"]),
        (["campbell", "--order", "3"], ["Speeds at which orders meet modes in gear 12", "order 3 at [rpm]"]),
    ],
    ids=lambda value: value[0],
)
def test_tables_for_people(torsional: Run, truck: str, command: list[str], expected: list[str]) -> None:
    told = torsional(command[0], truck, *command[1:])
    assert (told.code, told.err) == (0, "")
    assert [text for text in expected if text not in told.out] == []
    assert "\x1b" not in told.out


@pytest.mark.parametrize("command", ["check", *ANALYSES])
@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.yaml")), ids=lambda path: path.stem)
def test_shipped_models_are_answered_or_refused_in_one_sentence(torsional: Run, path: Path, command: str) -> None:
    more = {"respond": ["--order", "3"], "map": ["--order", "3"]}.get(command, [])
    told = torsional(command, path, "--quiet", *more)
    excited = load_model(path).engine is not None
    runs = excited or command not in ("respond", "map")
    assert told.code == 0 if runs else told.code == 2
    assert told.out == ""
    two_stages = ("truck_dmf_two_stage", "truck_dmf_arc_spring")
    warned = command == "respond" and path.stem in two_stages  # their swing runs across the two stages
    assert told.err.count("\n") == (0 if runs and not warned else 1)


def units_of(document: Any) -> Iterator[bool]:
    """For every value of a JSON document that has a quantity or is an amount: whether it names its unit."""
    if isinstance(document, dict):
        if "quantity" in document or "value" in document:
            yield bool(document.get("units"))
        for value in document.values():
            yield from units_of(value)
    elif isinstance(document, list):
        for value in document:
            yield from units_of(value)


@pytest.mark.parametrize(("command", "more"), [pytest.param("check", [], id="check"), *CASES])
def test_json_is_one_strict_document_with_units(torsional: Run, truck: str, command: str, more: list[str]) -> None:
    told = torsional(command, truck, "--json", *more)
    assert (told.code, told.err) == (0, "")

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is not JSON")

    document = json.loads(told.out, parse_constant=refuse)
    assert document["command"] == command
    assert document["model"]["hash"] == load_model(truck).hash
    named = list(units_of(document))
    assert len(named) > 5
    assert all(named)


@pytest.mark.parametrize(("command", "more"), CASES)
def test_files_of_every_kind(torsional: Run, truck: str, command: str, more: list[str]) -> None:
    outputs = [f"out{suffix}" for suffix in (".nc", ".csv", ".json", ".png", ".svg")]
    told = torsional(command, truck, "--json", *more, *(part for name in outputs for part in ("-o", name)))
    assert told.code == 0
    assert sorted(path.name for path in Path().iterdir()) == sorted(outputs)
    assert Path("out.png").read_bytes().startswith(b"\x89PNG")
    assert Path("out.svg").read_text(encoding="utf-8").startswith("<?xml")
    assert Path("out.json").read_text(encoding="utf-8") == told.out
    saved = load_results("out.nc")
    for name, variable in json.loads(told.out)["result"]["variables"].items():
        same_variable(saved[name], variable)


def same_variable(saved: Any, told: dict[str, Any]) -> None:
    assert list(saved.dims) == told["dimensions"]
    if saved.dtype.kind == "c":
        np.testing.assert_array_equal(saved.values.real, told["real"])
        np.testing.assert_array_equal(saved.values.imag, told["imaginary"])
    else:
        values = np.array(told["values"])
        np.testing.assert_array_equal(saved.values, values if saved.dtype.kind in "OUT" else values.astype(saved.dtype))


@pytest.mark.parametrize("command", ["respond", "map"])
@pytest.mark.parametrize("places", [["--node", "wheels"], ["--element", "clutch"]], ids=["node", "element"])
def test_pictures_and_tables_of_one_kind_of_place(torsional: Run, truck: str, command: str, places: list[str]) -> None:
    told = torsional(
        command, truck, "--order", "3", *places, "-o", "p.png", "-o", "p.csv", "-o", "p.nc", "-o", "p.json"
    )
    assert told.code == 0, told.err
    assert set(load_results("p.nc").dims) & {"node", "element"} == {places[0].removeprefix("--")}
    assert places[1] in told.out
    assert places[1] in Path("p.csv").read_text(encoding="utf-8")


def test_quiet_prints_nothing(torsional: Run, truck: str) -> None:
    told = torsional("modes", truck, "--quiet", "-o", "out.csv")
    assert (told.code, told.out, told.err) == (0, "", "")
    assert Path("out.csv").exists()


def test_a_change_is_made_and_told(torsional: Run, truck: str) -> None:
    stiff = torsional("modes", truck, "--set", "absorber.stiffness=52kNm/rad", "--json")
    changed, plain = json.loads(stiff.out), json.loads(torsional("modes", truck, "--json").out)
    assert changed["model"]["changes"] == ["absorber.stiffness=52kNm/rad"]
    assert changed["model"]["hash"] != plain["model"]["hash"]
    frequencies = [np.ravel(each["result"]["variables"]["frequency"]["values"]) for each in (plain, changed)]
    assert np.all(frequencies[1][1:] >= frequencies[0][1:])
    assert frequencies[1][3] > 1.05 * frequencies[0][3]


def test_respond_shows_the_swing_below_its_bound(torsional: Run, truck: str) -> None:
    told = json.loads(torsional("respond", truck, "--json", "--node", "all").out)["result"]["variables"]
    swing, bound = (np.array(told[f"acceleration_{kind}"]["values"]) for kind in ("swing", "bound"))
    assert swing.shape == (141, 18)
    assert np.all(swing <= bound * (1 + 1e-12))
    assert np.all(swing > 0.2 * bound)
    assert not any(name.startswith("torque_") for name in told)


def test_irregularity_counts_a_nodes_own_mean_speed(torsional: Run, truck: str) -> None:
    arguments = [
        "respond",
        truck,
        "--json",
        "--gear",
        "1",
        "--speed",
        "1000rpm",
        "--node",
        "gearbox_output",
        "--order",
        "3",
    ]
    told = json.loads(torsional(*arguments).out)["result"]["variables"]
    angle = complex(told["angle"]["real"][0][0][0], told["angle"]["imaginary"][0][0][0])
    # one order alone swings by twice its amplitude n Ω |θ|, over the output's own speed Ω / 14.94
    expected = 2 * 3 * abs(angle) * 14.94
    sampled = 1 - np.cos(3 * 2 * np.pi / SAMPLES)  # the highest sample lies at most half a step beside the peak
    assert (1 - sampled) * expected <= told["irregularity"]["values"][0][0] <= expected * (1 + 1e-12)


def test_map_lists_the_worst_cells_within_full_load_alone(torsional: Run, truck: str) -> None:
    told = torsional("map", truck, "--worst", "1", "--json", "--order", "3")
    result = json.loads(told.out)["result"]["variables"]
    within = np.array(result["within_full_load"]["values"])
    swing = np.array(result["acceleration_swing"]["values"])[0, :, :, 1]
    assert not within.all()
    worst = np.where(within, swing, 0.0).max()
    table = torsional("map", truck, "--worst", "1", "--order", "3").out
    line = next(line for line in table.splitlines() if line.startswith("gearbox_input"))
    assert float(line.split()[4]) == pytest.approx(worst, rel=1e-4)


def test_expanded_model_is_the_same_model(torsional: Run, truck: str) -> None:
    assert torsional("check", truck, "--expand", "-o", "parts.yaml").code == 0
    original, expanded = (load_model(path) for path in (truck, "parts.yaml"))
    for gear in ("1", "12"):
        a, b = (assemble(model.powertrain(gear)) for model in (original, expanded))
        for name in ("M", "C", "K"):
            np.testing.assert_array_equal(getattr(a, name), getattr(b, name))
    printed = torsional("check", truck, "--expand")
    assert printed.out == Path("parts.yaml").read_text(encoding="utf-8")


def test_check_tells_the_stop_that_is_reached(torsional: Run, truck: str) -> None:
    free = json.loads(torsional("check", truck, "--json").out)
    (spring,) = (row for row in free["equilibrium"] if row["connection"] == "dmf")
    # 2500 Nm on 13 kNm/rad; the stop waits at 3500 Nm on the same stiffness
    assert spring["travel"]["value"] == pytest.approx(2500 / 13e3, rel=1e-12)
    assert spring["to_stop"]["value"] == pytest.approx(1000 / 13e3, rel=1e-12)
    told = torsional("check", truck, "--torque", "3.6 kNm")
    assert told.code == 0
    assert "warning: dmf: the mean torque of 3600 Nm presses it onto its stop" in told.err


def test_check_doubts_units(torsional: Run, truck: str) -> None:
    told = torsional("check", truck, "--set", "clutch.stiffness=0.025")
    assert told.code == 0
    assert "warning: clutch.stiffness: 0.025 Nm/rad is unusual" in told.err
    assert "Hz, unusual for a powertrain" in told.err


@pytest.mark.parametrize("kind", KINDS)
def test_new_writes_a_model_that_loads(torsional: Run, kind: str) -> None:
    assert torsional("new", kind, "-o", "my.yaml").code == 0
    assert torsional("check", "my.yaml", "--quiet").code == 0
    assert torsional("new", kind).out == Path("my.yaml").read_text(encoding="utf-8")


def test_new_replaces_nothing_unasked(torsional: Run) -> None:
    Path("my.yaml").write_text("mine\n", encoding="utf-8")
    refused = torsional("new", "-o", "my.yaml")
    assert refused.code == 2
    assert "--force" in refused.err
    assert Path("my.yaml").read_text(encoding="utf-8") == "mine\n"
    assert torsional("new", "-o", "my.yaml", "--force").code == 0
    assert load_model("my.yaml").gears


def test_schema_is_json_and_names_the_blocks(torsional: Run) -> None:
    printed = torsional("schema")
    assert torsional("schema", "-o", "s.json").code == 0
    schema = json.loads(Path("s.json").read_text(encoding="utf-8"))
    assert schema == json.loads(printed.out)
    assert {"engine", "absorber", "clutch", "gearbox"} <= set(schema["properties"])


@pytest.mark.parametrize(
    ("kind", "files"),
    [
        ("model", "examples/truck_*.yaml"),
        ("scenario", "examples/scenarios/*.yaml"),
        ("sweep", "examples/plans/*.yaml"),
        ("optimise", "examples/plans/*.yaml"),
        ("identify", "examples/plans/*.yaml"),
    ],
)
def test_schemas_take_the_shipped_files_and_no_others(torsional: Run, kind: str, files: str) -> None:
    validator = jsonschema.Draft202012Validator(json.loads(torsional("schema", kind).out))
    key = "torsional" if kind == "model" else f"torsional_{kind}"
    documents = [YAML(typ="safe").load(path.read_text(encoding="utf-8")) for path in sorted(ROOT.glob(files))]
    mine = [document for document in documents if key in document]
    assert mine and all(validator.is_valid(document) for document in mine)
    assert not any(validator.is_valid({**document, "oder": 3}) for document in mine)
    assert not any(validator.is_valid(document) for document in documents if key not in document)


def test_schemas_of_other_files(torsional: Run) -> None:
    assert "pulses_per_turn" in json.loads(torsional("schema", "mapping").out)["$defs"]["ChannelBlock"]["properties"]
    refused = torsional("schema", "mappings", "-o", "s.json")
    assert refused.code == 2 and "did you mean 'mapping'?" in refused.err and not Path("s.json").exists()


def test_report_writes_one_page(torsional: Run) -> None:
    smf = ROOT / "examples" / "truck_smf.yaml"
    text = (ROOT / "examples" / "truck_dmf.yaml").read_text(encoding="utf-8")
    document = YAML(typ="safe").load(text)
    document["gearbox"] |= {"ratios": [1.0], "stiffness": 2.5e5}
    one_gear = {
        **document,
        "engine": {**document["engine"], "full_load": {"speed": ["600 rpm", "2000 rpm"], "torque": [2e3, 2e3]}},
    }
    Path("one.json").write_text(json.dumps(one_gear), encoding="utf-8")
    told = torsional("report", "one.json", "--compare", smf, "--set", "gearbox.ratios=[1.27]", "--json")
    assert told.code == 0
    assert [model["name"] for model in json.loads(told.out)["models"]] == [document["name"], load_model(smf).name]
    page = Path("report.html").read_text(encoding="utf-8")
    assert page.lstrip().lower().startswith("<!doctype html>")
    assert document["name"] in page
    assert sorted(path.name for path in Path().iterdir()) == ["one.json", "report.html"]


def test_warmup_tells_times(torsional: Run) -> None:
    times = json.loads(torsional("warmup", "--json").out)["times"]
    assert {"modes", "respond", "map"} <= set(times)
    assert all(time["units"] == "s" and time["value"] >= 0 for time in times.values())


@pytest.mark.full
def test_after_warmup_nothing_is_left_to_compile(process: Run, truck: str, tmp_path: Path) -> None:
    kept = tmp_path / "kernels"
    assert process("warmup", NUMBA_CACHE_DIR=str(kept)).code == 0
    before = sorted(path.name for path in kept.rglob("*.nbc"))
    assert before
    for command in ("check", "modes", "respond", "map", "campbell", "transient"):
        length = ("--duration", "0.05 s") if command == "transient" else ()
        assert process(command, truck, "--quiet", *length, NUMBA_CACHE_DIR=str(kept)).code == 0
        assert sorted(path.name for path in kept.rglob("*.nbc")) == before, command


@pytest.mark.parametrize("options", [(), ("--quiet",), ("--json",)])
def test_a_word_while_functions_are_compiled_unless_it_is_not_wanted(
    torsional: Run, truck: str, monkeypatch: pytest.MonkeyPatch, options: tuple[str, ...]
) -> None:
    kernel = SimpleNamespace(py_func=modes.run)
    monkeypatch.setattr(compiling, "watched", lambda: True)
    monkeypatch.setattr(compiling, "PATIENCE", -1.0)
    monkeypatch.setattr(compiling.WATCH, "told", False)
    monkeypatch.setattr(modes, "run", lambda *_, **__: start_event("numba:compile", {"dispatcher": kernel}))
    try:
        told = torsional("modes", truck, *options)
    finally:
        end_event("numba:compile", {"dispatcher": kernel})
    assert (told.out, told.err) == ("", "" if options else compiling.WORD + "\n")


def test_version(torsional: Run) -> None:
    from torsional import __version__

    assert torsional("--version").out == f"torsional {__version__}\n"


def test_one_order_alone_swings_by_its_amplitude(torsional: Run, truck: str) -> None:
    """A single order is told once, and several that were chosen are not called all orders."""
    alone = torsional("respond", truck, "--order", "3").out
    assert "order 3, 0-peak" in alone
    assert "half peak-to-peak" not in alone
    several = torsional("respond", truck, "--order", "3", "--order", "6").out
    assert "orders chosen, half peak-to-peak" in several
    assert "all orders" not in several


def test_torque_above_full_load_is_told(torsional: Run, truck: str) -> None:
    told = torsional("modes", truck, "--torque", "9000 Nm")
    assert told.err == "warning: --torque: 9000 Nm is above full load, which is 2500 Nm at most\n"
    assert torsional("modes", truck, "--torque", "2500 Nm").err == ""


def test_torque_above_full_load_at_its_speed_is_told(torsional: Run, truck: str) -> None:
    told = torsional("modes", truck, "--torque", "2000", "--speed", "600")
    assert told.err.startswith("warning: --torque: 2000 Nm is above full load, which is ")
    assert told.err.endswith(" at 600 rpm\n")
    assert torsional("modes", truck, "--torque", "2000", "--speed", "1200").err == ""


def test_speeds_outside_the_engines_range_are_told(torsional: Run, truck: str) -> None:
    told = torsional("respond", truck, "--torque", "500Nm", "--speed", "600:2400:600rpm").err
    assert told == "warning: --speed: 2400 rpm is outside the engine's range, 600 rpm to 2000 rpm\n"
    assert "94 rpm is outside" in torsional("modes", truck, "--speed", "94").err


def test_the_first_modes_are_those_of_a_turning_pendulum(torsional: Run, truck: str) -> None:
    """`check` tells the modes that `modes` tells, at the speed of the highest full load."""
    pendulum = truck.replace("truck_dmf", "truck_dmf_pendulum")
    checked = json.loads(torsional("check", pendulum, "--json").out)["modes"]
    modal = json.loads(torsional("modes", pendulum, "--json").out)["result"]["variables"]["frequency"]["values"][0]
    assert [mode["frequency"]["value"] for mode in checked] == pytest.approx(modal[1:7], rel=1e-12)
    assert "pendulum.suspension mode" in [mode["name"] for mode in checked]


def test_the_campbell_picture_names_the_modes(torsional: Run, truck: str) -> None:
    assert torsional("campbell", truck, "-o", "c.svg").code == 0
    assert "clutch mode" in Path("c.svg").read_text(encoding="utf-8")


TWO_DISCS = """
name: two discs
torsional: 1
engine: {layout: inline-6, bore: 0.131, stroke: 0.158, rod_length: 0.2675, reciprocating_mass: 4.2,
         compression_ratio: 18.1, firing_order: [1, 5, 3, 6, 2, 4]}
components:
  a: {type: inertia, inertia: 1}
  b: {type: inertia, inertia: 1}
  s: {type: shaft, a: a, b: b, stiffness: 5000}
landmarks: {throws: [a], crankshaft: a, load: b, input: b}
operation: {idle: 100, speed: [100, 200], torque: [0, 500]}
"""


def test_an_undamped_mode_met_exactly_is_told(torsional: Run) -> None:
    """Two discs of 1 kgm² on 5000 Nm/rad vibrate at 100 rad/s: order 1 meets that at 100 rad/s, order 2 at half."""
    Path("two.yaml").write_text(TWO_DISCS, encoding="utf-8")
    for speeds, told in (("100rad/s", "at 954.93 rpm, where"), ("50:200:50rad/s", "at 477.46 rpm and 1 more, where")):
        answer = torsional("respond", "two.yaml", "--speed", speeds, "--orders", "1:2:1", "--torque", "500Nm")
        assert answer.code == 0
        assert f"an undamped mode is met {told}" in answer.err
    assert "warning: no part has any damping" in torsional("check", "two.yaml").err


def test_a_swing_across_a_stage_is_told(torsional: Run, truck: str) -> None:
    """1100 Nm lies 100 Nm above the transition, the third order at the DMF is larger; one stage has none to cross."""
    asked = ("--torque", "1100 Nm", "--order", "3", "--speed", "600:700:100rpm")
    said = "warning: dmf swings across a change of its stiffness, where the linear response is an approximation"
    staged = torsional("respond", str(ROOT / "examples/truck_dmf_two_stage.yaml"), *asked)
    assert staged.err == f"{said}: 600 rpm to 700 rpm\n"
    assert torsional("respond", truck, *asked).err == ""


def test_friction_that_slips_is_told(torsional: Run, truck: str) -> None:
    """The washer sticks within ±0.1°, far less than the third order swings at 600 rpm; by a stiff clutch it is not."""
    asked = ("--order", "3", "--speed", "600:700:100rpm", "--set", "clutch.friction_torque=60Nm")
    slipping = torsional("respond", truck, *asked)
    said = "warning: clutch_friction slips, where the linear response lets it stick"
    assert slipping.err == f"{said}: 600 rpm to 700 rpm\n"
    stiff = torsional("respond", truck, *asked, "--set", "clutch.stiffness=1 MNm/rad")
    assert stiff.err == ""
    told = torsional("check", truck, "--set", "clutch.friction_torque=60Nm")
    row = next(line for line in told.out.splitlines() if line.startswith("clutch_friction"))
    assert row.split() == ["clutch_friction", "0", "5.7296", "34.377", "sticks", "-"]
