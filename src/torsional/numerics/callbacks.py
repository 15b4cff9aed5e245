"""Laws by address: one compiled loop, kept on disk, calls any law's kernel without being compiled for it.

A kernel is a compiled function of plain floats::

    torque(parameters, angle, rate, memory, step)
        -> (torque, d_angle, d_rate, d_memory, memory, m_angle, m_rate, m_memory)

Its meaning is told in `torsional.laws`; here it is a signature and a place in memory.
"""
# mypy: disable-error-code="untyped-decorator,no-untyped-call"

from __future__ import annotations

import functools
from typing import Any

import numba
from numba.core import cgutils
from numba.extending import intrinsic

from torsional.errors import ModelError
from torsional.numerics import compiling as compiling  # watches: laws come before whatever else is compiled

RETURNED = 8
"""Numbers that a kernel gives back."""

LAW_SIGNATURE = numba.types.UniTuple(numba.float64, RETURNED)(numba.float64[::1], *(numba.float64,) * 4)

_LAW = numba.types.FunctionType(LAW_SIGNATURE)


def _law_at(typing_context: Any, address: Any) -> Any:
    """The kernel at an `address_of` it, for compiled code: ``law_at(address)(parameters, angle, rate, memory, step)``.

    Give it a name by itself: numba warns of functions in a tuple.  What the kernel raises is passed on.  An address of
    anything else ends the process.
    """

    def built(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        made = cgutils.create_struct_proxy(_LAW)(context, builder)
        made.c_addr = made.py_addr = cgutils.get_null_value(cgutils.voidptr_t)
        made.jit_addr = builder.inttoptr(arguments[0], cgutils.voidptr_t)
        return made._getvalue()

    return _LAW(numba.int64), built


law_at: Any = intrinsic(_law_at)  # a name of its own, since its callers see one argument


@functools.cache  # holds the kernel, and with it the machine code at the address, for as long as the process runs
def address_of(kernel: Any) -> int:
    """The address of a law's compiled ``kernel``, compiled now or read from disk where it is kept there.

    Raises ModelError for what is no compiled function, or one that does not give back eight floats.
    """
    name = getattr(kernel, "__name__", repr(kernel))
    if not hasattr(kernel, "get_compile_result"):
        raise ModelError("a law's kernel is no compiled function", found=name, remedy="decorate it with numba.njit")
    try:
        result = kernel.get_compile_result(LAW_SIGNATURE)
    except (numba.errors.TypingError, TypeError) as error:
        raise ModelError("a law's kernel does not compile", found=name, remedy=str(error)) from error
    if result.signature.return_type != LAW_SIGNATURE.return_type:
        found = f"{name}, which gives {result.signature.return_type}"
        raise ModelError(f"a law's kernel gives back {RETURNED} floats", found=found, remedy="see torsional.laws.plain")
    return int(result.library.get_pointer_to_function(result.fndesc.llvm_func_name))
