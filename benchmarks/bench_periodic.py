"""H1 to H3: branches of periodic motion of DMF12 with their period doublings, multipliers, and the region they bound.

Every contender keeps nine harmonics of order 1.5, from 600 to 1200 rpm, in about as many points; its amplitude at 600
rpm and its period doublings are checked before its time counts.  Sampled Jacobians move a doubling by two or three
hundredths of a revolution per minute, hence the tolerance there.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import dmf12
import numpy as np
import ours_periodic as ours
import periodic_numpy as plain
import pytest

HERE = Path(__file__).parent
PYHARM = Path(f"{sys.prefix}-pyharm") / "bin" / "python"
MEANS = np.linspace(200.0, 2000.0, 100)


def _numpy(form) -> dict:
    found = plain.branch(form)
    return found | {"amplitude": float(np.hypot(*found["twist"][0, [2, 2 + dmf12.HARMONICS]]))}


def _numpy_with_multipliers() -> dict:
    found = _numpy(plain.Receptances())
    return found | {"multipliers": plain.multipliers(found["twist"], found["speed"])}


def _right(found: dict) -> None:
    """Order 3 at 600 rpm to 1e-6 of itself, and where the period doubles."""
    assert found.get("amplitude", dmf12.AMPLITUDE) == pytest.approx(dmf12.AMPLITUDE, rel=1e-6)
    assert found["speed"][-1] >= dmf12.FASTEST - 1e-6
    np.testing.assert_allclose(found["doublings"], dmf12.DOUBLINGS, atol=0.05)


H1 = {
    "torsional, periodic_response": lambda: ours.branch(stability=False),
    "torsional, without its dataset": ours.bare_branch,
    "NumPy, receptances": lambda: lambda: _numpy(plain.Receptances()),
    "NumPy, all angles": lambda: lambda: _numpy(plain.Coordinates()),
}


@pytest.mark.parametrize("contender", H1)
def test_h1_branch(contender, timed, declared):
    work = H1[contender]()
    points = len(work()["speed"])
    if contender == next(iter(H1)):
        title = "main branch of a 12-disc line with a two-stage flywheel, doublings located; a case is one branch"
        declared("H1", title, ours.floor(points))
    _right(timed(work, task="H1", contender=contender, cases=1, rounds=_rounds(contender), note=f"{points} points"))


def _rounds(contender: str) -> int:
    """Milliseconds need more rounds than seconds do."""
    return 41 if contender.startswith("torsional") else 5


def test_h1_pyharm(enter_time, tmp_path):
    """In a process of its own, which takes its own CPU time; it keeps files in the home and the working folder."""
    if not PYHARM.exists():
        pytest.skip("pyHarm is not installed: `make bench` does it where it can")
    command = [str(PYHARM), str(HERE / "peer_pyharm.py")]
    done = subprocess.run(command, check=True, capture_output=True, cwd=tmp_path, env={"HOME": str(tmp_path)})
    told = json.loads(done.stdout.splitlines()[-1])
    _right(told)
    note = f"{len(told['speed'])} points, CPU"
    enter_time("H1", "pyHarm, doublings noticed only", told["seconds"], note)
    located = told["seconds"] + told["locating_seconds"]
    enter_time("H1", "pyHarm, doublings located", located, f"{note}; by its solver and SciPy's brentq")


H2 = {
    "torsional, periodic_response": lambda: ours.branch(stability=True),
    "NumPy, receptances; expm by stages": lambda: _numpy_with_multipliers,
}


@pytest.mark.parametrize("contender", H2)
def test_h2_multipliers(contender, timed, declared):
    declared("H2", "the same with Floquet multipliers at every point; a case is one branch")
    work = H2[contender]()
    points = len(work()["speed"])
    found = timed(work, task="H2", contender=contender, cases=1, rounds=_rounds(contender), note=f"{points} points")
    _right(found)
    _liouville(found)


def _liouville(found: dict) -> None:
    """Their product is exp(−∫ tr M⁻¹C dt) over a period of order 3; between the doublings one is below −1."""
    M, C, _ = dmf12.matrices()
    period = 2 * np.pi / (3 * found["speed"] * dmf12.RPM)
    expected = np.exp(-np.trace(np.linalg.solve(M, C)) * period)
    np.testing.assert_allclose(np.prod(found["multipliers"], axis=1), expected, rtol=1e-6)
    low, high = dmf12.DOUBLINGS
    inside = (low + 1 < found["speed"]) & (found["speed"] < high - 1)
    outside = (found["speed"] < low - 1) | (high + 1 < found["speed"])
    least = np.where(np.abs(found["multipliers"].imag) < 1e-9, found["multipliers"].real, 0.0).min(axis=1)
    assert (least[inside] < -1).all() and (least[outside] > -1).all()


def test_h3_region(timed, declared):
    declared("H3", "every branch over speed at 100 mean torques, 200 to 2000 Nm; a case is one mean torque")
    work = ours.region(MEANS)
    points = sum(found.sizes["point"] for found in work())
    maps = timed(work, task="H3", contender="torsional", cases=MEANS.size, rounds=3, note=f"{points} points")
    doublings = [ours.told(found)["doublings"] for found in maps]
    inside = np.flatnonzero([at.size for at in doublings])
    # the region is one piece, and the line at 1000 Nm cuts it where the checked branch doubles
    assert inside[0] > 0 and inside[-1] < MEANS.size - 1 and (np.diff(inside) == 1).all()
    _right(ours.told(ours.region(np.array([dmf12.MEAN]))()[0]) | {"speed": [dmf12.FASTEST]})
