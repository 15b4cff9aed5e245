"""CVODE at DMF-LCP-1 through scikit-sundae, in an environment of its own.

Right-hand side and Jacobian are compiled; or the first is in NumPy and the second CVODE's own differences.

Run: .venv-bench-sundae/bin/python benchmarks/peer_sundae.py ; prints what it found and its CPU times as JSON.
"""

from __future__ import annotations

import os

os.environ |= {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}

import json
import sys
import time
from importlib.metadata import version
from pathlib import Path

import numpy as np
from sksundae.cvode import CVODE

sys.path.insert(0, str(Path(__file__).parent.parent))

import transient_scipy
from tests.validation import dmf_lcp

ROUNDS = 5
DRIVE = dmf_lcp.RUN_UP.drive


def rates(t, y, out) -> None:
    """ẏ into ``out``."""
    dmf_lcp.fill_rates(t, y, out, DRIVE)


def jacobian(t, y, rate, out) -> None:
    """∂ẏ/∂y into ``out``."""
    dmf_lcp.fill_jacobian(y, out)


def numpy_rates(t, y, out) -> None:
    """ẏ into ``out``, as one writes it first."""
    out[:] = transient_scipy.numpy_rates(t, y)


def run(kind: str, rtol: float, atol: float, span: float, sampling: float) -> tuple[float, np.ndarray]:
    """CPU time [s] of a run, and θ0 − θ1 [rad] at the samples."""
    given = {"rhsfn": rates, "jacfn": jacobian} if kind == "compiled" else {"rhsfn": numpy_rates}
    solver = CVODE(**given, rtol=rtol, atol=atol, method="BDF", max_num_steps=10**6)
    times = np.linspace(0.0, span, round(span / sampling) + 1)
    start = time.process_time()
    found = solver.solve(times, np.zeros(2 * dmf_lcp.NODES))
    seconds = time.process_time() - start
    return seconds, dmf_lcp.observed(found.y)[:, 0]


def main() -> None:
    """One round compiles and warms up, the others are timed."""
    kind, *numbers = sys.argv[1:]
    rounds = [run(kind, *(float(text) for text in numbers)) for _ in range(ROUNDS + 1)][1:]
    seconds = float(np.median([each for each, _ in rounds]))
    print(json.dumps({"version": version("scikit-sundae"), "seconds": seconds, "twist": rounds[-1][1].tolist()}))


if __name__ == "__main__":
    main()
