"""L2 and S2: designs of a truck that differ in the absorber, by the hundred thousand and by the million.

Every contender's numbers are checked against a dense solver before its time counts.
"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import ours_scale
import pytest

MANY, FEW = 100_000, 200
CONTENDERS = {
    "torsional, the coupling alone": (MANY, lambda chain: chain.coupled()),
    "NumPy, assembled and solved in a batch": (FEW, lambda chain: chain.dense),
}


@pytest.mark.parametrize("contender", CONTENDERS)
def test_l2_absorbers(contender, timed, declared):
    title = "designs of the truck that differ in the dual mass flywheel, 128 frequencies; a case is one complex solve"
    declared("L2", title, ours_scale.floor())
    count, prepared = CONTENDERS[contender]
    work = prepared(ours_scale.Chain(count))
    found = timed(work, task="L2", contender=contender, cases=count * ours_scale.FREQUENCIES, rounds=3)
    expected = ours_scale.Chain(20).dense()
    apart = np.abs(found[:20] - expected).max(axis=1) / np.abs(expected).max(axis=1)
    assert apart.max() < 1e-10


@pytest.mark.parametrize(("count", "processes"), [(10_000, 1), (100_000, 1), (1_000_000, 1), (1_000_000, 2)])
def test_s2_sweep(count, processes, tmp_path, enter_time, declared):
    declared("S2", "sweep of such designs kept in a folder and written to netCDF; a case is one design")
    asked = [sys.executable, str(Path(__file__).parent / "ours_scale.py"), str(count), str(tmp_path), str(processes)]
    told = json.loads(subprocess.run(asked, capture_output=True, text=True, check=True).stdout)
    spent, memory, size, query = (told[key] for key in ("seconds", "memory", "size", "asked"))
    note = f"{spent:.0f} s, {memory:.2f} GB of memory, {size:.2f} GB on disk, asked in {query:.1f} s"
    enter_time("S2", f"torsional, {count} designs, {processes} at once", spent / count, note)
    assert told["ok"] == count
