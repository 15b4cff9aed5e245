"""Vector formulas over rows of lanes: complex arithmetic that becomes straight-line machine code.

A row holds ``LANES`` doubles of a flat workspace, a complex row two of them.  A *lane operation* is a Python function
written with ``Real`` and ``Complex`` vectors; numba calls it once, while compiling, to write the instructions for a
whole block.  LLVM's own vectoriser would guard every loop with hundreds of overlap checks.  Arithmetic is strict IEEE,
without contraction or reassociation: a case has the same bits alone, among a million and on any processor.
"""
# mypy: disable-error-code="no-any-return"

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

LANES = 64
COMPLEX = 2 * LANES
OPERANDS = 7
_WIDTH = 8
_INTEGER = ir.IntType(64)
_VECTOR = ir.VectorType(ir.DoubleType(), _WIDTH)


def _constant(value: float) -> ir.Constant:
    return ir.Constant(_VECTOR, [value] * _WIDTH)


@dataclass(frozen=True, slots=True)
class Real:
    """Lanes of real numbers."""

    builder: Any
    value: Any

    def __add__(self, other: Real) -> Real:
        return Real(self.builder, self.builder.fadd(self.value, other.value))

    def __sub__(self, other: Real) -> Real:
        return Real(self.builder, self.builder.fsub(self.value, other.value))

    def __mul__(self, other: Real | float) -> Real:
        factor = other.value if isinstance(other, Real) else _constant(other)
        return Real(self.builder, self.builder.fmul(self.value, factor))

    def __neg__(self) -> Real:
        return Real(self.builder, self.builder.fneg(self.value))

    def inverse(self) -> Real:
        return Real(self.builder, self.builder.fdiv(_constant(1.0), self.value))

    def unless(self, comparison: str, other: Real, penalty: float) -> Real:
        """Zero in the lanes where the comparison holds; else, and where either is not a number, ``penalty``."""
        holds = self.builder.fcmp_ordered(comparison, self.value, other.value)
        return Real(self.builder, self.builder.select(holds, _constant(0.0), _constant(penalty)))


@dataclass(frozen=True, slots=True)
class Complex:
    """Lanes of complex numbers."""

    re: Real
    im: Real

    def __add__(self, other: Complex) -> Complex:
        return Complex(self.re + other.re, self.im + other.im)

    def __sub__(self, other: Complex) -> Complex:
        return Complex(self.re - other.re, self.im - other.im)

    def __mul__(self, other: Complex | Real) -> Complex:
        if isinstance(other, Real):
            return Complex(self.re * other, self.im * other)
        return Complex(self.re * other.re - self.im * other.im, self.re * other.im + self.im * other.re)

    def squared(self) -> Real:
        """The squared magnitude."""
        return self.re * self.re + self.im * self.im

    def inverse(self) -> Complex:
        q = self.squared().inverse()
        return Complex(self.re * q, -self.im * q)


@dataclass(frozen=True, slots=True)
class Rows:
    """The rows of a workspace at some of the lanes."""

    builder: Any
    base: Any

    def at(self, row: Any, behind: int = 0) -> Any:
        """Address of a row (an offset known now or when running), ``behind`` doubles further on."""
        offset = ir.Constant(_INTEGER, row) if isinstance(row, int) else row
        start = self.builder.add(offset, ir.Constant(_INTEGER, behind))
        return self.builder.bitcast(self.builder.gep(self.base, [start]), _VECTOR.as_pointer())

    def constant(self, value: float) -> Real:
        return Real(self.builder, _constant(value))

    def real(self, row: Any, behind: int = 0) -> Real:
        return Real(self.builder, self.builder.load(self.at(row, behind), align=8))

    def complex(self, row: Any, behind: int = 0) -> Complex:
        return Complex(self.real(row, behind), self.real(row, behind + LANES))

    def put(self, row: Any, value: Real | Complex, behind: int = 0) -> None:
        if isinstance(value, Complex):
            self.put(row, value.re, behind)
            self.put(row, value.im, behind + LANES)
        else:
            self.builder.store(value.value, self.at(row, behind), align=8)

    def add(self, row: Any, value: Real | Complex, behind: int = 0) -> None:
        old = self.complex(row, behind) if isinstance(value, Complex) else self.real(row, behind)
        self.put(row, old + value, behind)  # type: ignore[operator]


Formula = Callable[..., None]
"""A lane operation ``formula(rows, a, b, …)`` on rows at up to ``OPERANDS`` offsets."""


def lane_program(formulas: Mapping[int, Formula]) -> Any:
    """Compile formulas by number into ``operate(w, number, offsets…)``, which runs one of them over all lanes."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        data = context.make_array(signature.args[0])(context, builder, arguments[0]).data
        end = builder.append_basic_block("end")
        switch = builder.switch(arguments[1], end)
        for number, formula in formulas.items():
            block = builder.append_basic_block(formula.__name__)
            switch.add_case(ir.Constant(_INTEGER, int(number)), block)
            builder.position_at_end(block)
            _write(builder, data, formula, arguments[2:])
            builder.branch(end)
        builder.position_at_end(end)
        return context.get_dummy_value()

    def operate(context: Any, w: Any, op: Any, a: Any, b: Any, c: Any, d: Any, e: Any, f: Any, g: Any) -> Any:
        return types.void(w, *[types.int64] * (1 + OPERANDS)), generate

    return intrinsic(operate)


def _write(builder: Any, data: Any, formula: Formula, offsets: Any) -> None:
    """The loop over a block's lanes, a vector at a time."""
    with cgutils.for_range(builder, ir.Constant(_INTEGER, LANES // _WIDTH)) as loop:
        lane = builder.mul(loop.index, ir.Constant(_INTEGER, _WIDTH))
        formula(Rows(builder, builder.gep(data, [lane])), *offsets)
