"""pyHarm at the branch of DMF12, in an environment of its own: its pins and this project's do not go together.

Run: .venv-bench-pyharm/bin/python benchmarks/peer_pyharm.py ; prints what it found and its CPU times as JSON.
"""

from __future__ import annotations

import os

os.environ |= {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "MKL_NUM_THREADS": "1", "NUMBA_NUM_THREADS": "1"}
os.environ["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"

import json
import logging
import statistics
import time
import warnings
from importlib.metadata import version

import dmf12
import numpy as np
from scipy.optimize import brentq

warnings.simplefilter("ignore")
logging.disable(logging.CRITICAL)

from pyHarm.Maestro import Maestro  # noqa: E402
from pyHarm.Solver import FirstSolution  # noqa: E402

SAMPLES, ROUNDS = 512, 3
UNIT = dmf12.RPM * dmf12.BASE  # ω of one rpm


def task() -> dict:
    """The line as pyHarm's input: one substructure, a bilateral gap for the second stage, forcings on the throws.

    A mean torque is a forcing of harmonic 0; the spring on the ground keeps harmonic 0 of the line regular.
    """
    M, C, K = dmf12.matrices()
    second = dmf12.SECOND_STAGE - dmf12.STIFFNESS[dmf12.PRIMARY]
    connectors: dict = {
        "second_stage": {
            "type": "PenaltyBilateralGap",
            "connect": {"line": [dmf12.PRIMARY], "INTERNAL": [dmf12.SECONDARY]},
            "dirs": [0],
            "g": dmf12.GAP,
            "k": second,
        }
    }
    loads = dmf12.load()
    for harmonic, node in zip(*np.nonzero(loads), strict=True):
        force = {"type": "GOForcing", "connect": {"line": [int(node)]}, "dirs": [0], "dto": 0, "phi": 0.0}
        connectors[f"torque_{harmonic}_{node}"] = force | {"ho": int(harmonic), "amp": float(loads[harmonic, node])}
    return {
        "system": {"type": "Base", "nh": dmf12.HARMONICS, "nti": SAMPLES},
        "substructures": {"line": {"matrix": {"M": M, "C": C, "K": K}, "ndofs": 1}},
        "connectors": connectors,
        "analysis": {"branch": study()},
    }


def study() -> dict:
    """Its own Newton and secant predictor, the quickest of its choices here, in steps of the benchmark's length."""
    longest = dmf12.STEP * UNIT
    return {
        "study": "frf",
        "solver": "NewtonRaphson",
        "solver_options": {"tol_residual": 1e-6, "tol_delta_x": 1e-9, "max_iter": 20},
        "predictor": "secant",
        "corrector": "pseudo_arc_length",
        "puls_inf": dmf12.SLOWEST * UNIT,
        "puls_sup": dmf12.FASTEST * UNIT,
        "ds0": longest,
        "ds_max": longest,
        "ds_min": 1e-4 * longest,
        "verbose": False,
    }


def branch():
    """The branch, as one calls pyHarm for it."""
    maestro = Maestro(task())
    maestro.operate()
    analysis = maestro.nls["branch"]
    return analysis, [solution for solution in analysis.SolList if solution.flag_accepted]


def doublings(analysis, points) -> list[float]:
    """pyHarm tells between which points a determinant changes its sign; its solver is asked for the place [rpm]."""
    brackets = [(point.precedent_solution, point) for point in points if point.flag_bifurcation]
    return [_located(analysis, low.x[:-1], low.x[-1], high.x[-1]) / UNIT for low, high in brackets]


def _located(analysis, x: np.ndarray, low: float, high: float) -> float:
    reference = None

    def determinant(omega: float) -> float:
        nonlocal reference
        solution = FirstSolution(np.append(x, omega))
        analysis.solver.Solve(solution, analysis.SolList)
        sign, size = np.linalg.slogdet(analysis.globalJacobian(solution.x_red, solution)[:-1, :-1])
        reference = size if reference is None else reference
        return sign * np.exp(size - reference)

    return brentq(determinant, low, high, xtol=1e-3 * UNIT)


def amplitude(x: np.ndarray) -> float:
    """Order 3 of the flywheel's relative angle."""
    twist = x[:-1].reshape(-1, dmf12.INERTIA.size) @ dmf12.weights()
    return float(np.hypot(twist[3], twist[4]))


def main() -> None:
    """One round warms the caches, the others are timed."""
    branch()
    seconds, located = [], []
    for _ in range(ROUNDS):
        start = time.process_time()
        analysis, points = branch()
        middle = time.process_time()
        found = doublings(analysis, points)
        seconds.append(middle - start)
        located.append(time.process_time() - middle)
    told = {
        "version": version("pyharm-os"),
        "seconds": statistics.median(seconds),
        "locating_seconds": statistics.median(located),
        "speed": [float(point.x[-1] / UNIT) for point in points],
        "amplitude": amplitude(points[0].x),
        "doublings": found,
    }
    print(json.dumps(told))


if __name__ == "__main__":
    main()
