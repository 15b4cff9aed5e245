"""What tests of translated C share: a compiler, and libraries of translated functions."""

from __future__ import annotations

import ctypes
import os
import shutil
from collections.abc import Callable, Sequence
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from torsional.exchange.fmu.packing import COMPILERS, binary_of
from torsional.exchange.fmu.sources import ENTRY
from torsional.exchange.translation.kinds import BOOL, DOUBLE, INT, kind_of
from torsional.exchange.translation.program import Program

COMPILER = next((found for name in COMPILERS if (found := shutil.which(name))), "")
needs_compiler = pytest.mark.skipif(not COMPILER and not os.environ.get("CI"), reason="there is no C compiler here")
RUNTIME = resources.files("torsional.exchange").joinpath("sources", "runtime.h").read_text("utf-8")
EXPORTED = '__attribute__((visibility("default"))) '


def library(text: str, folder: Path) -> ctypes.CDLL:
    """A shared library of C behind the runtime."""
    path = folder / "library.so"
    path.write_bytes(binary_of({"runtime.h": RUNTIME, ENTRY: '#include "runtime.h"\n' + text}, COMPILER))
    return ctypes.CDLL(str(path))


class Laws:
    """Kernels in C, called with numbers."""

    def __init__(self, kernels: Sequence[Callable[..., Any]], folder: Path) -> None:
        program = Program()
        program.laws(kernels)
        call = (
            EXPORTED + "void call(int64_t n, double *p, int64_t c, double a, double r, double m, double h, double *o)"
            "{ tuple_d_d_d_d_d_d_d_d t = laws[n]((f1){p, {c}}, a, r, m, h); double *v = &t._0;"
            " for (int k = 0; k < 8; k++) o[k] = v[k]; }"
        )
        self._call = library(program.text + call, folder).call
        pointer = ctypes.POINTER(ctypes.c_double)
        self._call.argtypes = [ctypes.c_int64, pointer, ctypes.c_int64, *(ctypes.c_double,) * 4, pointer]

    def __call__(self, number: int, parameters: np.ndarray, *values: float) -> list[float]:
        out, row = np.zeros(8), np.ascontiguousarray(parameters, dtype=float)
        pointer = ctypes.POINTER(ctypes.c_double)
        self._call(number, row.ctypes.data_as(pointer), row.size, *values, out.ctypes.data_as(pointer))
        return out.tolist()


def of_numbers(function: Callable[..., Any], example: Sequence[float | int], folder: Path) -> Callable[..., Any]:
    """One function of numbers that gives a number, in C."""
    program = Program()
    made = program.function(function, [kind_of(value) for value in example])
    types = {DOUBLE: ctypes.c_double, INT: ctypes.c_int64, BOOL: ctypes.c_bool}
    kinds = [kind_of(value) for value in example]
    names = [f"x{i}" for i in range(len(kinds))]
    taken = ", ".join(f"{kind.name} {name}" for kind, name in zip(kinds, names, strict=True))
    head = f"{EXPORTED}{made.kind.name} call({taken})"
    called = library(program.text + f"{head} {{ return {made.name}({', '.join(names)}); }}", folder).call
    called.argtypes, called.restype = [types[kind] for kind in kinds], types[made.kind]
    return called
