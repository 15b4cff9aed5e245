"""Two hundred random networks against 50-digit arithmetic (see generate.py)."""

from __future__ import annotations

import gzip
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.random_models import Network
from torsional.engine import Excitation
from torsional.solvers.harmonic import harmonic_response
from torsional.solvers.modal import natural_frequencies
from torsional.system import assemble

CASES: list[dict[str, Any]] = json.loads(gzip.decompress(Path(__file__).with_name("networks.json.gz").read_bytes()))


def network(case: dict[str, Any]) -> Network:
    return Network(tuple(case["inertias"]), tuple(map(tuple, case["shafts"])), tuple(map(tuple, case["gears"])))


@pytest.mark.parametrize("number", range(0, len(CASES), 20))
def test_frequencies(number: int) -> None:
    for case in CASES[number : number + 20]:
        found = natural_frequencies(assemble(network(case).powertrain()))
        wanted = np.array([float(w) for w in case["frequencies"]])
        elastic = wanted > 0
        assert np.array_equal(found > 0, elastic)
        assert np.abs(found[elastic] / wanted[elastic] - 1).max() <= 1e-10


@pytest.mark.parametrize("number", range(0, len(CASES), 20))
def test_responses(number: int) -> None:
    for case in CASES[number : number + 20]:
        system = assemble(network(case).powertrain())
        at = Excitation.unit(f"n{case['loaded']}", [1.0], [case["omega"]])
        found = harmonic_response(system, at).angle.sel(node=[f"n{i}" for i in range(len(case["inertias"]))])
        wanted = np.array([float(re) + 1j * float(im) for re, im in case["response"]])
        assert (np.abs(found.values.ravel() - wanted) / np.abs(wanted)).max() <= 1e-11
