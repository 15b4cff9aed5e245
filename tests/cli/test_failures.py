"""Failures: one sentence on stderr, the exit code, nothing on stdout, nothing written."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from ruamel.yaml import YAML

import torsional.cli.modes

Run = Callable[..., Any]
TRUCK = "truck"

BAD = [
    (["modes", TRUCK, "--gear", "13"], ["--gear", "'13'", "allowed: 1, 2, 3"]),
    (["respond", TRUCK, "--gear", "all"], ["--gear", "one gear is wanted"]),
    (["modes", TRUCK, "--torque", "1200 rpm"], ["--torque", "rpm is an angular velocity", "Nm"]),
    (["map", TRUCK, "--torque", "900:100Nm"], ["--torque", "above its start"]),
    (["respond", TRUCK, "--speed", "60:200rad"], ["--speed", "allowed: rad/s, rpm, rev/s, deg/s"]),
    (["hysteresis", TRUCK, "--rate", "3deg"], ["--rate", "deg is an angle", "allowed: rad/s, rpm, rev/s, deg/s"]),
    (["respond", TRUCK, "--order", "2.3"], ["order", "2.3"]),
    (["respond", TRUCK, "--order", "0"], ["--order", "positive", "found 0"]),
    (["modes", TRUCK, "--order", "0"], ["--order", "positive", "found 0"]),
    (["modes", TRUCK, "--speed", "-10rpm"], ["--speed", "backwards", "found -10 rpm"]),
    (["map", TRUCK, "--speed", "-600:900rpm"], ["--speed", "backwards", "found -600 rpm"]),
    (["respond", TRUCK, "--speed", "600:3000rpm"], ["full_load", "(600 rpm) to 209.44 rad/s (2000 rpm)"]),
    (["respond", TRUCK, "--orders", "0.5:x"], ["--orders", "a number is wanted"]),
    (["respond", TRUCK, "--node", "gearbox_imput"], ["--node", "did you mean 'gearbox_input'?"]),
    (["map", TRUCK, "--element", "clutsch"], ["--element", "did you mean 'clutch'?"]),
    (["modes", TRUCK, "--set", "absorber.dampin=3"], ["absorber.dampin", "did you mean 'damping'?"]),
    (["modes", TRUCK, "--set", "nonsense"], ["path=value", "'nonsense'"]),
    (["modes", TRUCK, "-o", "out.xls"], ["--output", "'.xls'", ".nc, .csv, .json, .png, .svg"]),
    (["modes", TRUCK, "-o", "out.jsn"], ["did you mean '.json'?"]),
    (["modes", TRUCK, "-o", "out"], ["a name without one"]),
    (["modes", TRUCK, "-o", "there/out.csv"], ["there is no such folder", "'there'", "make the folder"]),
    (["modes", TRUCK, "-o", "a.csv", "-o", "./a.csv"], ["named twice"]),
    (["report", TRUCK, "-o", "page.pdf"], ["'.pdf'", ".html"]),
    (["check", TRUCK, "-o", "x.yaml"], ["'.yaml'", "allowed: .json"]),
    (["check", TRUCK, "--expand", "--json"], ["--expand", "leave --json out"]),
    (["check", "nothing.yaml"], ["nothing.yaml", "there is no such file"]),
    (["check", "."], ["folder"]),
    (["new", "boat"], ["'boat'", "truck"]),
    (["modes"], ["MODEL", "torsional modes --help"]),
    (["mods"], ["'mods'", "'modes'", "torsional --help"]),
    (["modes", TRUCK, "--geer", "1"], ["--geer", "--gear"]),
    (["modes", TRUCK, "--gear"], ["'--gear' requires an argument", "torsional modes --help"]),
    (["map", TRUCK, "--worst", "0"], ["--worst", "'0'", ">= 1"]),
    (["map", TRUCK, "--worst", "few"], ["--worst: a whole number is wanted; found 'few'"]),
    (["modes", TRUCK, "--order", "three"], ["--order: a number is wanted", "'three'"]),
    (["respond", TRUCK, "--speed", "600-2000"], ["--speed", "a range", "is written 600:2000"]),
    (["modes"], ["'MODEL'", "torsional new", "torsional modes --help"]),
    (["scenario", TRUCK], ["'SCENARIO'", "engine_start"]),
    (["modes", TRUCK, "--set", "absorber.stages.1.stiffness=3"], ["absorber.stages: the model has no such list"]),
]


@pytest.mark.parametrize(("arguments", "told"), BAD, ids=[" ".join(line).replace(TRUCK, "") for line, _ in BAD])
def test_bad_lines_are_answered_in_one_sentence(
    torsional: Run, truck: str, arguments: list[str], told: list[str]
) -> None:
    answer = torsional(*(truck if part == TRUCK else part for part in arguments))
    assert (answer.code, answer.out) == (2, "")
    *warnings, error = answer.err.splitlines()
    assert all(line.startswith("warning: ") for line in warnings)
    assert error.startswith("error: ")
    assert [part for part in told if part not in error] == []
    assert list(Path().iterdir()) == []


def test_several_faults_stand_below_each_other(torsional: Run, truck: str) -> None:
    Path("bad.yaml").write_text(Path(truck).read_text(encoding="utf-8").replace("mm", "mmm"), encoding="utf-8")
    first, *others = torsional("check", "bad.yaml").err.splitlines()
    assert first == "error: bad.yaml: 3 things are not right"
    assert [line.split()[0] for line in others] == ["engine.bore", "engine.stroke", "engine.rod_length"]


def test_the_nearest_file_is_named(torsional: Run, truck: str) -> None:
    assert "did you mean 'truck_dmf.yaml'?" in torsional("modes", truck.replace("dmf", "dnf")).err


def test_errors_of_a_file_name_file_key_and_line(torsional: Run, truck: str) -> None:
    text = (
        Path(truck).read_text(encoding="utf-8").replace("secondary_inertia: 1.0 kgm²", "secondary_inertia: -1.0 kgm²")
    )
    Path("full.csv").write_bytes(Path(truck).with_name("truck13_full_load.csv").read_bytes())
    Path("mine.yaml").write_text(text.replace("truck13_full_load.csv", "full.csv"), encoding="utf-8")
    line = 1 + text.splitlines().index(next(row for row in text.splitlines() if "secondary_inertia" in row))
    told = torsional("map", "mine.yaml")
    assert told.code == 2
    assert told.err.startswith(f"error: mine.yaml: absorber.secondary_inertia (line {line}): ")


@pytest.mark.parametrize("output", ["truck.json", "full.csv", "link.csv"])
def test_input_files_are_never_written_over(torsional: Run, truck: str, output: str) -> None:
    assert torsional("check", truck, "--expand", "-o", "truck.yaml").code == 0
    text = Path("truck.yaml").read_text(encoding="utf-8")
    Path("full.csv").write_bytes(Path(truck).with_name("truck13_full_load.csv").read_bytes())
    document = YAML(typ="safe").load(text)
    document["engine"]["full_load"] = {"file": "full.csv"}
    Path("truck.json").write_text(json.dumps(document), encoding="utf-8")
    Path("link.csv").symlink_to("full.csv")
    before = {path.name: path.read_bytes() for path in Path().iterdir()}
    told = torsional("modes", "truck.json", "-o", output)
    assert (told.code, told.out) == (2, "")
    assert "overwrite an input file" in told.err
    assert {path.name: path.read_bytes() for path in Path().iterdir()} == before


def test_no_arguments_show_the_help(torsional: Run) -> None:
    told = torsional()
    assert told.code == 0
    assert told.out == torsional("--help").out
    assert "respond" in told.out


def failing(monkeypatch: pytest.MonkeyPatch, failure: BaseException) -> None:
    def run(*_: object, **__: object) -> None:
        raise failure

    monkeypatch.setattr(torsional.cli.modes, "run", run)


@pytest.mark.parametrize(
    ("failure", "code", "said"),
    [
        (ZeroDivisionError("oh"), 1, "error: this should not have happened: ZeroDivisionError: oh; TORSIONAL_DEBUG=1"),
        (MemoryError(), 1, "error: there is not enough memory"),
        (OSError(28, "No space left on device"), 1, "error: the system says: No space left on device"),
        (KeyboardInterrupt(), 130, "stopped, nothing written"),
        (SystemExit(7), 7, ""),
    ],
    ids=lambda value: type(value).__name__,
)
def test_unexpected_failures(
    torsional: Run, truck: str, monkeypatch: pytest.MonkeyPatch, failure: BaseException, code: int, said: str
) -> None:
    monkeypatch.delenv("TORSIONAL_DEBUG", raising=False)
    failing(monkeypatch, failure)
    told = torsional("modes", truck)
    assert (told.code, told.out) == (code, "")
    assert told.err.startswith(said)
    assert "Traceback" not in told.err
    assert told.err.count("\n") == bool(said)


@pytest.mark.parametrize("command", ["map --gear all --torque 0:2500:0.01Nm", "respond --order 3"])
def test_grids_that_no_memory_holds_are_refused_at_once(torsional: Run, truck: str, command: str) -> None:
    name, *options = command.split()
    told = torsional(name, truck, *options, "--speed", "600:2000:0.002rpm", "--orders", "0.5:180")
    assert (told.code, told.out) == (1, "")
    assert told.err == "error: there is not enough memory for this; ask for fewer speeds, torques, orders or gears\n"


def test_the_traceback_is_there_for_who_asks(torsional: Run, truck: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TORSIONAL_DEBUG", "1")
    failing(monkeypatch, ZeroDivisionError("oh"))
    told = torsional("modes", truck)
    assert told.code == 1
    assert "Traceback" in told.err
    assert "ZeroDivisionError: oh" in told.err


def test_control_characters_do_not_reach_the_terminal(torsional: Run) -> None:
    told = torsional("check", "\x1b[31mred.yaml")
    assert told.code == 2
    assert "\x1b" not in told.err
    assert "\\x1b[31mred.yaml" in told.err


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_ctrl_c_leaves_nothing(truck: str, tmp_path: Path) -> None:
    Path("report.html").write_text("the last one", encoding="utf-8")
    # a shell's background jobs ignore Ctrl-C, and what they start inherits that
    listen = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)"
    code = f"{listen}; import sys; from torsional.cli import main; sys.exit(main())"
    line = [sys.executable, "-c", code, "report", truck]
    with subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        until = time.monotonic() + 60
        while not list(tmp_path.glob(".torsional-*")) and time.monotonic() < until:
            time.sleep(0.01)  # the page is begun when its draft folder is there
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    assert (process.returncode, out, err) == (130, "", "stopped, nothing written\n")
    assert [path.name for path in tmp_path.iterdir()] == ["report.html"]
    assert Path("report.html").read_text(encoding="utf-8") == "the last one"


@pytest.mark.skipif(os.name == "nt", reason="pipes of POSIX")
def test_a_reader_that_goes_away_is_no_error(truck: str) -> None:
    code = "import sys; from torsional.cli import main; sys.exit(main())"
    own = {key: value for key, value in os.environ.items() if key != "PYTHONUNBUFFERED"}
    line = [sys.executable, "-c", code, "map", truck, "--gear", "all", "--json"]
    with subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=own) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        assert process.stdout.read(10) == b'{"torsiona'
        process.stdout.close()
        assert process.stderr.read() == b""
        assert process.wait(timeout=60) == 141
