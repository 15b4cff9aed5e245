"""Compiled functions give in C what they give in Python, to the last bits."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numba
import numpy as np
import pytest
from tests.exchange.compiled import Laws, needs_compiler, of_numbers

from torsional.errors import ModelError
from torsional.exchange.translation.kinds import DOUBLE, INT, kind_of
from torsional.exchange.translation.program import Program
from torsional.exchange.translation.terms import UntranslatableError
from torsional.laws import Contacts, Coulomb, Hinges, Jenkins, Karnopp, Law, LuGre, Polynomial, Stribeck, Table, plain

SHIPPED: list[Law] = [
    Hinges.staged([(1000.0, 8e3), (3500.0, 24e3)], lash=0.02, stop_stiffness=1e6),
    Contacts.between(-0.3, 0.4, 1e5, 1e-4),
    Contacts.lash(0.2, 1e5, 1e-3, damper="cut"),
    Contacts.lash(0.2, 1e5, 1e-3, damper="limited"),
    Coulomb(50.0, 0.1),
    Jenkins(50.0, 25e3),
    Karnopp(1.0, 1.5, 0.1, 1e4, 10.0),
    LuGre(1e5, 300.0, 1.0, 1.5, 0.001, 0.4, grease_damping=0.2),
    Polynomial((100.0, 3.0, 5e3)),
    Stribeck(1.0, 1.5, 0.1, 1e-3),
    Table(((-0.4, -900.0), (-0.1, -100.0), (0.0, 0.0), (0.2, 300.0), (0.5, 1500.0))),
]


@numba.njit
def own_torque(parameters: Any, angle: float, rate: float, memory: float, step: float) -> Any:
    """A law of a user's own: a cubic spring and a damper that wears out, written with most of what is allowed."""
    total, weight, n = 0.0, 1, 0
    while True:
        n += 1
        if n > 3:
            break
        if n % 2 == 0:
            continue
        for k in range(parameters.size - 1, -1, -1):
            total = total * angle + parameters[k] * weight
        weight = -weight
    damper = parameters[0] * math.exp(-abs(rate)) if -1.0 < rate <= 1.0 and not angle > 5.0 else 0.5 * parameters[0]
    return plain(total + damper * rate + (angle // 0.1) + rate**2 - max(n, 2.5), np.sin(angle) ** 3, damper)


class OwnLaw(Law):
    """Its Python side."""

    kernel = own_torque


@needs_compiler
def test_every_law_gives_the_same_in_c(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    kernels = [type(law).kernel for law in SHIPPED] + [own_torque]
    packed = [law.packed for law in SHIPPED] + [np.array([3.0, 40.0, 2e3])]
    told = Laws(kernels, tmp_path)
    for number, (kernel, parameters) in enumerate(zip(kernels, packed, strict=True)):
        python: Callable[..., Any] = kernel.py_func  # type: ignore[attr-defined]
        values = rng.uniform(-1.0, 1.0, (400, 3)) * (0.6, 2.0, 0.003)
        values[::7, 1] = 0.0  # rates at which friction has a branch of its own
        for angle, rate, memory in values.tolist():
            for step in (0.0, 1e-6, 1e-3):
                expected = python(parameters, angle, rate, memory, step)
                found = told(number, parameters, angle, rate, memory, step)
                np.testing.assert_allclose(found, expected, rtol=1e-14, atol=1e-300)


def arithmetic(a: int, b: int, x: float, y: float) -> float:
    """Whole numbers and others, signs and all."""
    p, q = (a, b) if a > b else (b, a)
    p, q = q, p
    total = float(p // 3) + q % 7 - (1 << 3) + (a & 6 | 1) - abs(a) * abs(x)
    total += x // 0.3 + x % 0.7 + y**3 + 2.0**a + y**-2 + 0.5 ** abs(b)
    total -= min(a, b, 2) * max(x, y) - math.copysign(1.5, x) + math.hypot(x, y) + int(10 * x) + np.floor(y)
    return total / a if a != 0 else total / 2 + (a == b) + (x < y < 10.0)


@needs_compiler
def test_arithmetic_is_pythons(tmp_path: Path) -> None:
    told = of_numbers(arithmetic, (1, 1, 1.0, 1.0), tmp_path)
    rng = np.random.default_rng(5)
    for a, b in rng.integers(-9, 10, (60, 2)).tolist():
        for x, y in rng.uniform(-3.0, 3.0, (10, 2)).tolist():
            assert told(a, b, x, y) == pytest.approx(arithmetic(a, b, x, y), rel=1e-13, abs=1e-13)


class Both(NamedTuple):
    """A tuple with names."""

    row: Any
    factor: float


TABLE = (0.5, 0.25, 0.125)


def weighted(both: Both, first: int) -> tuple[float, int]:
    """Tuples with names, slices, constants and calls of others."""
    part, total = both.row[first : first + 2], 0.0
    for i in range(len(TABLE)):
        total += TABLE[i] * part[i % 2]
    return total * both.factor, part.size


def doubled(row: Any, first: int) -> float:
    """Two values of another function, of which one is looked at."""
    told = weighted(Both(row, factor=2.0), first)
    sum_, size = told
    return told[0] + sum_ if size == 2 else 0.0


def whole(first: int) -> float:
    """Of no array at all."""
    return 1.0 * first


def test_tuples_and_arrays_are_written() -> None:
    program = Program()
    made = program.function(doubled, [kind_of(np.zeros(3)), INT])
    assert made.kind is DOUBLE
    assert "typedef struct { f1 row; double factor; } Both;" in program.text
    assert program.function(doubled, [kind_of(np.zeros(3)), INT]) == made  # once for the same kinds


def of_lists(x: float) -> float:
    return sum([x, x])


def of_words(x: float) -> float:
    return 1.0 if "a" else x


def of_itself(x: float) -> float:
    return of_itself(x - 1.0) if x > 0.0 else 0.0


def of_files(x: float) -> float:
    with open("x"):  # noqa: PTH123
        return x


def of_numpy(x: float) -> float:
    return float(np.linalg.norm(x))


def of_two_kinds(x: float) -> Any:
    return x if x > 0.0 else (x, x)


def of_unknown(x: float) -> float:
    return x + nowhere  # type: ignore[name-defined]  # noqa: F821


def of_a_try(x: float) -> float:
    try:
        return 1.0 / x
    except ZeroDivisionError:
        return 0.0


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (of_lists, "no C is written"),
        (of_words, "no C is written for this constant"),
        (of_itself, "calls itself"),
        (of_files, "no C is written for this statement"),
        (of_numpy, "no C is written for this function"),
        (of_two_kinds, "of one kind"),
        (of_unknown, "the name has no value here"),
        (of_a_try, "no C is written for this statement"),
        (len, "no function of Python"),
    ],
)
def test_what_is_not_plain_arithmetic_is_refused_by_name(function: Callable[..., Any], words: str) -> None:
    with pytest.raises(UntranslatableError, match=words) as told:
        Program().function(function, [DOUBLE])
    assert function is len or function.__name__ in str(told.value)


def test_a_kernel_gives_back_eight_floats() -> None:
    def few(parameters: Any, angle: float, rate: float, memory: float, step: float) -> float:
        return angle

    with pytest.raises(ModelError, match="eight floats"):
        Program().laws([few])
