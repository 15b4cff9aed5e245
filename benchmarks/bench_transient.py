"""T1 and T2: a dual mass flywheel with shoes, loose springs and stops, run up in one second; 300 operating points.

Every contender starts from rest and tells the flywheel's relative angle every millisecond.  Over the first 0.1 s it
must be within 5e-5 of the largest angle of what DOP853 finds at a relative tolerance of 1e-11, and its time counts only
then; later the clearances rattle, and trajectories part.  CPU time.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import ours_transient as ours
import pytest
import transient_scipy
from tests.validation import dmf_lcp

HERE = Path(__file__).parent
SPAN, COMPARED, SAMPLING, STEP = 1.0, 0.1, 1e-3, 1e-4  # s
WITHIN = 5e-5
pytestmark = pytest.mark.benchmark(timer=time.process_time)


@pytest.fixture(scope="module")
def error():
    """Largest deviation of θ0 − θ1 over the first tenth of a second, over the largest angle there."""
    exact, _ = transient_scipy.run("DOP853", 1e-11, 1e-13, COMPARED, SAMPLING)
    told = {round(t / SAMPLING): twist for t, twist, *_ in dmf_lcp.REFERENCE}
    np.testing.assert_allclose(exact[list(told)], list(told.values()), rtol=0, atol=1e-10)

    def measured(twist) -> float:
        assert len(twist) == round(SPAN / SAMPLING) + 1 and np.isfinite(twist).all()
        found = np.asarray(twist)[: exact.size] - exact
        return float(np.abs(found).max() / np.abs(exact).max())

    return measured


def _right(deviation: float) -> str:
    assert deviation <= WITHIN
    return f"error {deviation:.1e}"


OURS = {
    "torsional, transient": (ours.response, ours.told_of_response),
    "torsional, the march alone": (ours.march, ours.told_of_march),
}


@pytest.mark.parametrize("contender", OURS)
def test_t1_ours(contender, timed, declared, error):
    prepare, told = OURS[contender]
    if contender == next(iter(OURS)):
        title = "DMF-LCP-1: 18 discs, 34 one-sided springs, a run-up of one second; a case is the run"
        declared("T1", title, ours.floor(STEP, SPAN))
    work = prepare(STEP, SPAN, SAMPLING)
    timed(work, task="T1", contender=contender, cases=1, rounds=15, note=_right(error(told(work()))))


def test_t1_explicit(timed, error):
    work = ours.explicit(1e-4, SPAN, SAMPLING)
    note = _right(error(ours.told_of_explicit(work())))
    timed(work, task="T1", contender="torsional, explicit, tolerance 1e-4", cases=1, rounds=5, note=note)


# method, relative and absolute tolerance, right-hand side, rounds
SCIPY = {
    "SciPy, LSODA 1e-3": ("LSODA", 1e-3, 1e-6, dmf_lcp.right_hand_side, 5),
    "SciPy, LSODA 1e-4, NumPy right-hand side": ("LSODA", 1e-4, 1e-6, transient_scipy.numpy_rates, 3),
    "SciPy, Radau 1e-3": ("Radau", 1e-3, 1e-5, dmf_lcp.right_hand_side, 3),
    "SciPy, Radau 1e-6": ("Radau", 1e-6, 1e-8, dmf_lcp.right_hand_side, 1),
    "SciPy, RK45 1e-3": ("RK45", 1e-3, 1e-6, dmf_lcp.right_hand_side, 5),
}


@pytest.mark.parametrize("contender", SCIPY)
def test_t1_scipy(contender, timed, error):
    method, rtol, atol, rates, rounds = SCIPY[contender]

    def work():
        return transient_scipy.run(method, rtol, atol, SPAN, SAMPLING, rates)

    twist, calls = work()
    note = f"{_right(error(twist))}, {calls} right-hand sides"
    timed(work, task="T1", contender=contender, cases=1, rounds=rounds, note=note)


def test_t1_classical(timed, error):
    """What a few lines for this one case take: contacts as damped as these are not stiff at such steps."""

    def work():
        return transient_scipy.classical(STEP, SPAN, SAMPLING)

    timed(work, task="T1", contender="RK4 written for this case", cases=1, rounds=15, note=_right(error(work())))


# a script of its own environment, and what it is asked for before the span and the sampling
PEERS = {
    "Exudyn, generalised-α 1e-4": ("exudyn", [STEP]),
    "CVODE 1e-4": ("sundae", ["compiled", 1e-4, 1e-5]),
    "CVODE 1e-4, NumPy right-hand side": ("sundae", ["numpy", 1e-4, 1e-5]),
}


@pytest.mark.parametrize("contender", PEERS)
def test_t1_peers(contender, enter_time, error, tmp_path):
    """In processes of their own, which take their own CPU time."""
    name, asked = PEERS[contender]
    python = Path(f"{sys.prefix}-{name}") / "bin" / "python"
    if not python.exists():
        pytest.skip(f"{name} is not installed: `make bench` does it where it can")
    command = [str(python), str(HERE / f"peer_{name}.py"), *(str(value) for value in [*asked, SPAN, SAMPLING])]
    done = subprocess.run(command, check=True, capture_output=True, cwd=tmp_path, env=os.environ)
    told = json.loads(done.stdout.splitlines()[-1])
    enter_time("T1", contender, told["seconds"], f"{_right(error(told['twist']))}; version {told['version']}")


def test_t2_operating_points(enter_time, declared):
    """Swings must be the same however many processes there are."""
    count, simulated = len(ours.POINTS), 3.0 * len(ours.POINTS)
    declared("T2", f"{count} operating points of it, 3 s each; a case is all of them, on the clock")
    told = {}
    for processes in (1, 2):
        clock, seconds, told[processes] = ours.operate_all(processes)
        note = (
            f"{seconds:.1f} s CPU, {simulated / seconds:.0f} simulated s a CPU second, {simulated / clock:.0f} a second"
        )
        enter_time("T2", f"torsional, {processes} process{'es' * (processes - 1)}", clock, note)
    np.testing.assert_array_equal(told[1], told[2])
    assert (told[1] > 1e-3).all()
