"""`torsional scenario`: figures, files, refusals, and what Ctrl-C keeps."""

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

import numpy as np
import pytest

from torsional import load_results
from torsional.files.scenario_schema import KINDS
from torsional.units import RPM

Run = Callable[..., Any]

BAD = [
    (["engine_strat"], ["'engine_strat'", "did you mean 'engine_start'?"]),
    (["nothing.yaml"], ["nothing.yaml", "there is no such file"]),
    (["tip_in", "-s", "gear=13"], ["gear", "there is no gear '13'", "allowed: 1, 2"]),
    (["tip_in", "-s", "after=4 kNm"], ["after", "would rest on its stop", "4000 Nm", "up to 3500 Nm"]),
    (["engine_start", "-s", "duration=-1s"], ["duration", "must be positive", "'-1s'"]),
    (["engine_start", "-s", "starter.sped=3"], ["starter.sped", "did you mean 'speed'?"]),
    (["engine_start", "-s", "step=0.1s"], ["step", "too large", "0.1 s", "at most a hundredth"]),
    (["engine_start", "-s", "starter"], ["path=value", "'starter'", "e.g. starter.speed=150rpm"]),
    (["engine_start", "--set", "absorber.dampin=3"], ["absorber.dampin", "did you mean 'damping'?"]),
    (["engine_start", "-o", "x.html"], ["--output", "'.html'"]),
]


@pytest.mark.parametrize(("arguments", "told"), BAD, ids=[" ".join(line) for line, _ in BAD])
def test_bad_lines_are_answered_in_one_sentence(
    torsional: Run, truck: str, arguments: list[str], told: list[str]
) -> None:
    answer = torsional("scenario", truck, *arguments)
    assert (answer.code, answer.out) == (2, "")
    error = answer.err.splitlines()[-1]
    assert error.startswith("error: ")
    assert [part for part in told if part not in error] == []
    assert list(Path().iterdir()) == []


@pytest.mark.parametrize(
    ("settings", "told"),
    [
        (["speed=2500rpm"], ["speed: 2500 rpm is outside the engine's range, 600 rpm to 2000 rpm"]),
        (["speed=600rpm", "after=2400Nm"], ["after: 2400 Nm is above full load, which is 1300 Nm at 600 rpm"]),
        (["after=2600Nm"], ["after: 2600 Nm is above full load, which is 2500 Nm at most"]),
        (["after=2500Nm"], []),
    ],
)
def test_what_the_engine_does_not_have_is_told(
    torsional: Run, truck: str, settings: list[str], told: list[str]
) -> None:
    options = [part for setting in ("duration=0.32s", *settings) for part in ("-s", setting)]
    answer = torsional("scenario", truck, "tip_in", *options)
    assert answer.code == 0
    assert answer.err.splitlines() == [f"warning: {line}" for line in told]


def test_a_start_reaches_idle_and_tells_its_peaks(torsional: Run, truck: str) -> None:
    told = torsional("scenario", truck, "engine_start", "-o", "s.json", "-o", "s.nc", "-o", "s.png", "-o", "s.csv")
    assert told.code == 0, told.err
    assert "Springs against their stops" in told.out
    document = json.loads(Path("s.json").read_text(encoding="utf-8"))
    assert (document["command"], document["settings"]["scenario"]) == ("scenario", "engine_start")
    assert document["values"]["starter"]["until"] == 1.2
    run = load_results("s.nc")
    last = run.angular_velocity.sel(node="primary", time=slice(1.8, None)).mean()
    assert float(last) == pytest.approx(600 * RPM, rel=0.03)
    highest = run.twist.sel(element="dmf").max()
    row = next(line for line in told.out.splitlines() if line.startswith("dmf"))
    assert float(row.split()[5]) == pytest.approx(np.rad2deg(float(highest)), rel=1e-4)
    assert Path("s.png").read_bytes().startswith(b"\x89PNG")
    heads = Path("s.csv").read_text(encoding="utf-8-sig").splitlines()[0].split(",")
    assert heads[:2] == ["time [s]", "angle primary [rad]"]  # no column for a frame that stands
    assert "torque dmf [Nm]" in heads and [head for head in heads if "lowest" in head or "stop" in head] == []


def test_settings_and_files_say_the_same(torsional: Run, truck: str) -> None:
    text = "torsional_scenario: 1\nscenario: engine_start\nduration: 0.3 s\nfiring_from: 0.1 s\n"
    Path("mine.yaml").write_text(text + "starter: {speed: 150 rpm}\n", encoding="utf-8")
    named = ["engine_start", "-s", "duration=0.3 s", "-s", "firing_from=0.1 s", "-s", "starter.speed=150rpm"]
    by_file, by_hand = (torsional("scenario", truck, *asked, "--json") for asked in (["mine.yaml"], named))
    results = [json.loads(told.out)["result"] for told in (by_file, by_hand)]
    assert results[0]["variables"] == results[1]["variables"]
    assert torsional("scenario", truck, "mine.yaml", "-o", "mine.json").code == 0
    Path("mine.json").write_text('{"torsional_scenario": 1, "scenario": "engine_start"}', encoding="utf-8")
    told = torsional("scenario", truck, "mine.json", "-o", "mine.json")
    assert (told.code, "overwrite an input file" in told.err) == (2, True)


def test_a_stalled_engine_is_told(torsional: Run, truck: str) -> None:
    dumped = ["-s", "gear=8", "-s", "clutch.within=0.05 s", "-s", "duration=1 s"]
    told = torsional("scenario", truck, "clutch_engagement", *dumped)
    assert told.code == 0
    assert "warning: the engine stalls at" in told.err


@pytest.mark.parametrize("kind", ["engine_stop", "stall"])
def test_an_engine_that_shall_stop_needs_no_warning(torsional: Run, truck: str, kind: str) -> None:
    told = torsional("scenario", truck, kind)
    assert (told.code, told.err) == (0, "")


def test_rounding_is_no_torque(torsional: Run, truck: str) -> None:
    """Road load only brakes: what is above nought in its torque is nought."""
    told = torsional("scenario", truck, "clutch_engagement", "-s", "duration=1.5 s")
    row = next(line for line in told.out.splitlines() if line.startswith("road_load"))
    assert row.split()[1] == "0" and float(row.split()[2]) > 1000


def test_help_names_every_kind(torsional: Run) -> None:
    text = "".join(torsional("scenario", "--help").out.split())
    assert [kind for kind in KINDS if kind not in text] == []


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_ctrl_c_keeps_what_was_reached(truck: str) -> None:
    long = ["scenario", truck, "idle_pulse", "-s", "duration=300 s", "-s", "step=0.02 ms", "-o", "part.nc"]
    code = "import sys; from torsional.cli import main; sys.exit(main())"
    # a job in the background ignores Ctrl-C, and so does what it starts
    hook = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
    hook += "import torsional.solvers.transient.run as r; told = r.Run._tell\n"
    hook += "def tell(self, at, *rest):\n"
    hook += " if at > 0: print('at', at, file=sys.stderr, flush=True)\n told(self, at, *rest)\n"
    with subprocess.Popen(
        [sys.executable, "-c", f"import sys\n{hook}r.Run._tell = tell\n{code}", *long],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as running:
        assert running.stderr is not None and running.stdout is not None
        assert running.stderr.readline().startswith("at ")
        time.sleep(0.2)
        running.send_signal(signal.SIGINT)
        out, err = running.communicate(timeout=300)
    assert running.returncode == 130, err
    assert "what was reached is kept" in err
    assert "Springs against their stops" in out
    run = load_results("part.nc")
    assert run.attrs["status"].startswith("interrupted at")
    assert 0 < float(run.time[-1]) < 300
