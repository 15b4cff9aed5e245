"""Designs in blocks, from which sensitivities are read: Morris's trajectories and Saltelli's crossed points.

SALib draws them; a block is complete or of no use, so that one that lost a design is left out as a whole.
"""

from __future__ import annotations

import warnings
from importlib import import_module
from types import ModuleType
from typing import Any

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array

BLOCKS = {"morris": 1, "saltelli": 2}
"""By how much a block has more designs than there are parameters."""
WORDS = {"morris": "trajectories", "saltelli": "base points"}
LEAST = {"morris": 4, "saltelli": 16}
"""Blocks below which no sensitivity is told."""
LEVELS = 4
"""Of Morris's grid: shares 0, 1/3, 2/3 and 1, with steps of two thirds."""


def block_size(method: str, parameters: int) -> int:
    """How many designs belong together: 1 where each stands alone.

    >>> block_size("morris", 3), block_size("saltelli", 3), block_size("sobol", 3)
    (4, 5, 1)
    """
    return parameters + BLOCKS[method] if method in BLOCKS else 1


def salib(module: str) -> ModuleType:
    """A module of SALib; raises ModelError, with the extra that brings it, where it is not installed."""
    try:
        return import_module(f"SALib.{module}")
    except ImportError:
        remedy = "pip install 'torsional[design]'"
        raise ModelError("sensitivities need the library SALib", where="designs.method", remedy=remedy) from None


def drawn(method: str, blocks: int, parameters: int, seed: int) -> Array:
    """Shares from 0 to 1 (design, parameter) of all blocks, one block after the other.

    Morris's trajectories: Technometrics 33 (1991) 161, one parameter changed at a time by 2/3 of its range.  Saltelli's
    points without those for second-order indices: Comput. Phys. Commun. 181 (2010) 259, on scrambled Sobol points.
    """
    problem = problem_of(parameters)
    if method == "morris":
        return np.asarray(salib("sample.morris").sample(problem, blocks, num_levels=LEVELS, seed=seed))
    sample: Any = salib("sample.sobol").sample
    with warnings.catch_warnings():  # counts that are no powers of two are the user's own
        warnings.filterwarnings("ignore", message="The balance properties of Sobol' points", category=UserWarning)
        return np.asarray(sample(problem, blocks, calc_second_order=False, seed=seed))


def problem_of(parameters: int) -> dict[str, Any]:
    """The unit cube as SALib describes it."""
    return {
        "num_vars": parameters, "names": [str(n) for n in range(parameters)], "bounds": [[0.0, 1.0]] * parameters
    }  # fmt: skip
