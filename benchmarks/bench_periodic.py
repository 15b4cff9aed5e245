"""H1 to H3: branches of periodic motion of DMF12 with their period doublings, multipliers, and the region they bound.

Every contender keeps the orders up to 13.5, from 600 to 1200 rpm, in about as many points: the peers all nine harmonics
of order 1.5, this project the four of order 3, which are all that the main branch has, and the odd ones of 1.5 in the
test for doublings.  Its amplitude at 600 rpm and its period doublings are checked before its time counts, which is CPU
time.  Sampled Jacobians move a doubling by two or three hundredths of a revolution per minute, hence the tolerance of
the peers.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path

import dmf12
import numpy as np
import ours_periodic as ours
import periodic_numpy as plain
import pytest

HERE = Path(__file__).parent
PYHARM = Path(f"{sys.prefix}-pyharm") / "bin" / "python"
pytestmark = pytest.mark.benchmark(timer=time.process_time)


def _numpy(form) -> dict:
    found = plain.branch(form)
    return found | {"amplitude": float(np.hypot(*found["twist"][0, [2, 2 + dmf12.HARMONICS]]))}


def _numpy_with_multipliers() -> dict:
    found = _numpy(plain.Receptances())
    return found | {"multipliers": plain.multipliers(found["twist"], found["speed"])}


def _right(found: dict, within: float) -> None:
    """Order 3 at 600 rpm to 1e-6 of itself, and where the period doubles [rpm]."""
    assert found["amplitude"] == pytest.approx(dmf12.AMPLITUDE, rel=1e-6)
    assert found["speed"][0] == pytest.approx(dmf12.SLOWEST) and found["speed"][-1] >= dmf12.FASTEST - 1e-6
    np.testing.assert_allclose(found["doublings"], dmf12.DOUBLINGS, atol=within)


EXACT, SAMPLED = 1e-4, 0.05

H1 = {
    "torsional, periodic_response": (lambda: ours.response(stability=False), ours.told_of_response),
    "torsional, the branch alone": (lambda: ours.branch(stability=False), ours.told_of_branch),
    "NumPy, receptances": (lambda: lambda: _numpy(plain.Receptances()), dict),
    "NumPy, all angles": (lambda: lambda: _numpy(plain.Coordinates()), dict),
}


@pytest.mark.parametrize("contender", H1)
def test_h1_branch(contender, timed, declared):
    prepare, told = H1[contender]
    work = prepare()
    found = told(work())
    _right(found, _tolerance(contender))
    points = len(found["speed"])
    if contender == next(iter(H1)):
        title = "main branch of a 12-disc line with a two-stage flywheel, doublings located; a case is one branch"
        declared("H1", title, ours.floor(points))
    timed(work, task="H1", contender=contender, cases=1, rounds=_rounds(contender), note=f"{points} points")


def _tolerance(contender: str) -> float:
    return EXACT if contender.startswith("torsional") else SAMPLED


def _rounds(contender: str) -> int:
    """Milliseconds need more rounds than seconds do."""
    return ours.ROUNDS if contender.startswith("torsional") else 5


def test_h1_pyharm(enter_time, tmp_path):
    """In a process of its own, which takes its own CPU time; it keeps files in the home and the working folder."""
    if not PYHARM.exists():
        pytest.skip("pyHarm is not installed: `make bench` does it where it can")
    command = [str(PYHARM), str(HERE / "peer_pyharm.py")]
    done = subprocess.run(command, check=True, capture_output=True, cwd=tmp_path, env={"HOME": str(tmp_path)})
    told = json.loads(done.stdout.splitlines()[-1])
    _right(told, SAMPLED)
    note = f"{len(told['speed'])} points"
    enter_time("H1", "pyHarm, doublings noticed only", told["seconds"], note)
    located = told["seconds"] + told["locating_seconds"]
    enter_time("H1", "pyHarm, doublings located", located, f"{note}; by its solver and SciPy's brentq")


H2 = {
    "torsional, periodic_response": (lambda: ours.response(stability=True), ours.told_of_response),
    "torsional, the branch alone": (lambda: ours.branch(stability=True), ours.told_of_branch),
    "NumPy, receptances; expm by stages": (lambda: _numpy_with_multipliers, dict),
}


@pytest.mark.parametrize("contender", H2)
def test_h2_multipliers(contender, timed, declared):
    prepare, told = H2[contender]
    work = prepare()
    found = told(work())
    _right(found, _tolerance(contender))
    _liouville(found)
    points = len(found["speed"])
    if contender == next(iter(H2)):
        title = "the same with Floquet multipliers at every point; a case is one point"
        declared("H2", title, ours.floor_with_multipliers(points))
    timed(work, task="H2", contender=contender, cases=points, rounds=_rounds(contender), note=f"{points} points")


def _liouville(found: dict) -> None:
    """Their product is exp(−∫ tr M⁻¹C dt) over a period of order 3; between the doublings one is below −1."""
    M, C, _ = dmf12.matrices()
    period = 2 * np.pi / (3 * np.asarray(found["speed"]) * dmf12.RPM)
    expected = np.exp(-np.trace(np.linalg.solve(M, C)) * period)
    np.testing.assert_allclose(np.prod(found["multipliers"], axis=1), expected, rtol=1e-6)
    low, high = dmf12.DOUBLINGS
    inside = (low + 1 < found["speed"]) & (found["speed"] < high - 1)
    outside = (found["speed"] < low - 1) | (high + 1 < found["speed"])
    least = np.where(np.abs(found["multipliers"].imag) < 1e-9, found["multipliers"].real, 0.0).min(axis=1)
    assert (least[inside] < -1).all() and (least[outside] > -1).all()


BOUNDARY_TORQUE, BOUNDARY_SPEED = (896.45, 1417.02), (749.79, 964.25)  # Nm, rpm: where the truck's region ends


def test_h3_region(timed, declared):
    declared("H3", "100 × 100 map of a truck's half-order vibration with its boundary; a case is one mean torque")
    work = ours.region()
    _bounded(work())
    timed(work, task="H3", contender="torsional, subharmonic_map", cases=ours.TORQUES.size, rounds=5)


def _bounded(found) -> None:
    """The curve's extent; the map vibrates where the curve says, but for the few places between it and its chords."""
    torque, speed = found.boundary_mean_torque.values, found.boundary_speed.values / dmf12.RPM
    assert set(found.boundary_kind.values) == {"period doubling"} and found.boundary_curve.max() == 0
    np.testing.assert_allclose([torque.min(), torque.max()], BOUNDARY_TORQUE, atol=0.01)
    np.testing.assert_allclose([speed.min(), speed.max()], BOUNDARY_SPEED, atol=0.01)
    assert found.amplitude.shape == (100, 100) and found.solutions.min() >= 1
    vibrates = found.amplitude.values > 0
    rows = ours.TORQUES[vibrates.any(axis=1)]
    step = ours.TORQUES[1] - ours.TORQUES[0]
    assert torque.min() < rows[0] < torque.min() + step and torque.max() - step < rows[-1] < torque.max()
    assert (vibrates != _inside(speed, torque)).sum() <= 5 < 300 < vibrates.sum()


def _inside(speed: np.ndarray, torque: np.ndarray) -> np.ndarray:
    """Which places of the map (torque, speed) lie inside a closed curve, by how often a line to the left meets it."""
    x, y = np.meshgrid(ours.SPEEDS / dmf12.RPM, ours.TORQUES)
    odd = np.zeros(x.shape, dtype=bool)
    for i in np.flatnonzero(torque != np.roll(torque, 1)):
        low, high = sorted([(torque[i - 1], speed[i - 1]), (torque[i], speed[i])])
        at = low[1] + (high[1] - low[1]) * (y - low[0]) / (high[0] - low[0])
        odd ^= (low[0] <= y) & (y < high[0]) & (at < x)
    return odd
