"""`torsional transient`: run-ups and single speeds, against the linear response, and refusals."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from torsional import load_model, load_results, run_up_response, swing
from torsional.units import RPM

Run = Callable[..., Any]

BAD = [
    (["--gear", "13"], ["--gear", "'13'"]),
    (["--gear", "neutral"], ["--gear", "'neutral'; allowed: 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12\n"]),
    (["--speed", "600:"], ["--speed", "how does the speed run?", "found '600:'", "600:1200rpm"]),
    (["--speed", "600:1200:100rpm"], ["--speed", "found '600:1200:100rpm'"]),
    (["--duration", "-3s"], ["--duration", "must be positive"]),
    (["--duration", "3 Nm"], ["--duration", "Nm"]),
    (["--speed", "0rpm"], ["--speed", "the engine must turn", "torsional scenario"]),
    (["--torque", "4kNm"], ["torque", "would rest on its stop"]),
    (["--node", "gearbox_imput"], ["--node", "did you mean 'gearbox_input'?"]),
]


@pytest.mark.parametrize(("arguments", "told"), BAD, ids=[" ".join(line) for line, _ in BAD])
def test_bad_lines_are_answered_in_one_sentence(
    torsional: Run, truck: str, arguments: list[str], told: list[str]
) -> None:
    answer = torsional("transient", truck, *arguments)
    assert (answer.code, answer.out) == (2, "")
    assert [part for part in told if part not in answer.err.splitlines(keepends=True)[-1]] == []
    assert list(Path().iterdir()) == []


def test_at_one_speed_it_is_the_linear_response(torsional: Run, truck: str) -> None:
    """Far from stops the line is linear but for the crank's own motion in its torques: some per cent."""
    told = torsional("transient", truck, "--speed", "1200rpm", "--torque", "1000Nm", "--duration", "2s", "-o", "t.nc")
    assert told.code == 0, told.err
    run = load_results("t.nc")
    late = run.torque.sel(element="dmf", time=slice(1.5, None))
    model = load_model(truck)
    linear = run_up_response(model, np.array([1200 * RPM]), np.array([1000.0]), None, np.arange(0.5, 12.5, 0.5))
    expected = float(swing(linear.torque.sel(element="dmf"))[0])
    assert float(late.mean()) == pytest.approx(1000.0, rel=0.01)
    assert 0.5 * float(late.max() - late.min()) == pytest.approx(expected, rel=0.05)


def test_a_run_up_follows_its_speed(torsional: Run, truck: str) -> None:
    asked = ["--speed", "600:1200rpm", "--torque", "1200Nm", "--duration", "1s"]
    told = torsional("transient", truck, *asked, "-o", "u.json", "-o", "u.png", "-o", "u.csv")
    assert told.code == 0, told.err
    assert "Peaks, 600 rpm to 1200 rpm, 1200 Nm in gear 12" in told.out
    speed = json.loads(Path("u.json").read_text(encoding="utf-8"))["result"]["coordinates"]["speed"]["values"]
    assert (speed[0], speed[-1]) == pytest.approx((600 * RPM, 1200 * RPM))
    assert Path("u.png").read_bytes().startswith(b"\x89PNG")
    heads = Path("u.csv").read_text(encoding="utf-8-sig").splitlines()[0].split(",")
    assert heads[:4] == ["time [s]", "speed [rad/s]", "speed [rpm]", "crank_angle [rad]"]
    assert [head for head in heads if "lowest" in head or "stop" in head] == []  # figures of a whole run: no signals


def test_a_run_down_is_one_too(torsional: Run, truck: str) -> None:
    told = torsional("transient", truck, "--speed", "900:700rpm", "--torque", "500Nm", "--duration", "0.2s")
    assert told.code == 0, told.err
    assert "900 rpm to 700 rpm" in told.out
