"""Functions of numbers that C has by another name, or that the header beside the translation holds."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

_UNARY = ("exp", "log", "log10", "sqrt", "sin", "cos", "tan", "sinh", "cosh", "tanh", "expm1", "log1p")
_RENAMED = {"arcsin": "asin", "arccos": "acos", "arctan": "atan"}

BY_NAME: dict[Any, str] = {getattr(np, name): name for name in (*_UNARY, "floor", "ceil")}
"""Functions of one double that give a double; floor and ceil of `math` give whole numbers."""
BY_NAME |= {getattr(math, name): name for name in _UNARY}
BY_NAME |= {getattr(np, name): c for name, c in _RENAMED.items()} | {getattr(math, c): c for c in _RENAMED.values()}
BY_NAME |= {math.fabs: "fabs", np.fabs: "fabs"}
TWO: dict[Any, str] = {
    math.copysign: "copysign",
    np.copysign: "copysign",
    math.hypot: "hypot",
    np.hypot: "hypot",
    math.atan2: "atan2",
    np.arctan2: "atan2",
    math.pow: "pow",
    math.fmod: "fmod",
}
"""Those of two."""
WHOLE: dict[Callable[..., Any], str] = {math.floor: "floor", math.ceil: "ceil", int: "", np.int64: "", np.uint32: ""}
"""Those that give a whole number, after the function named."""
EXTREME = {min: "least", max: "most"}
