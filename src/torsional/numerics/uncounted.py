"""Compiled functions that count no references: many arrays in a tuple are then handed on for nothing.

Numba counts each array of a tuple up and down, atomically, wherever the tuple is handed to a function or a part of it
is taken out; with a hundred arrays that is microseconds, more than a time step takes.  Such a function cannot make
arrays, and calls none that does.
"""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

import functools

import numba

uncounted = functools.partial(numba.njit, cache=True, error_model="numpy", _nrt=False)
"""Decorator: compiled, kept on disk, makes no arrays."""

inlined = functools.partial(numba.njit, cache=True, error_model="numpy", _nrt=False, inline="always")
"""Decorator: the same, and part of whatever calls it."""

inner = functools.partial(uncounted, no_cpython_wrapper=True, no_cfunc_wrapper=True)
"""Decorator: the same as `uncounted`, for compiled code alone; there is nothing that Python could call, and a call from
there ends the process."""

merged = functools.partial(inner, forceinline=True)
"""Decorator: the same as `inner`, its machine code part of whatever calls it: compiles sooner than `inlined`."""
