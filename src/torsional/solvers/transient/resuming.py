"""Going on from a stored run to the last bit: all that a march stands on, as one row of numbers in the result."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr

from torsional.numerics.arrays import Array
from torsional.numerics.stepping.marching import begin
from torsional.numerics.stepping.state import State as Standing
from torsional.solvers.transient.marching import Accuracy
from torsional.solvers.transient.problem import Problem
from torsional.solvers.transient.starts import MotionState

ROW, STEP, MARK = "end_standing", "end_step", "end_of"


def resumable(run: xr.Dataset, problem: Problem, end: MotionState, accuracy: Accuracy) -> xr.Dataset:
    """The ``run`` with the accelerations, open and closed contacts, torques and the ledger of its last moment."""
    if end.standing is None:
        return run
    row = np.concatenate([np.ravel(part).astype(float) for part in end.standing])
    return run.assign({ROW: ("standing", row)}).assign_attrs({STEP: end.step, MARK: mark(problem, accuracy)})


def resumed(start: object, state: MotionState, problem: Problem, accuracy: Accuracy) -> MotionState:
    """The ``state`` with all that, where ``start`` is a run of the same equations by the same method; else as it is:
    accelerations that other torques have left are none to go on with."""
    if not isinstance(start, xr.Dataset) or ROW not in start or start.attrs.get(MARK) != mark(problem, accuracy):
        return state
    like = begin(problem.plan, state.angle, state.speed, time=state.time)
    ends = np.cumsum([part.size for part in like])
    row = np.asarray(start[ROW].values, dtype=float)
    parts = zip(np.split(row, ends[:-1]), like, strict=True)
    if row.size != ends[-1]:
        return state
    standing = Standing._make(own.reshape(part.shape).astype(part.dtype) for own, part in parts)
    return replace(state, standing=standing, step=float(start.attrs[STEP]))


def mark(problem: Problem, accuracy: Accuracy) -> str:
    """What is the same for runs that can go on from each other: the equations, the method but for its step, and how the
    row is laid out."""
    laid_out = " ".join(Standing._fields)
    found = hashlib.sha256(f"{problem.system.hash} {accuracy.method} {accuracy.spectral_radius!r} {laid_out}".encode())
    for values in _numbers(problem.equations):
        found.update(np.ascontiguousarray(values).tobytes())
    return found.hexdigest()[:16]


def _numbers(group: NamedTuple) -> list[Array]:
    """All numbers of arrays within each other; where a law's compiled function lies is none of them."""
    found: list[Array] = []
    for name, value in zip(group._fields, group, strict=True):
        if hasattr(value, "_fields"):
            found += _numbers(value)
        elif name != "address":
            found.append(np.asarray(value))
    return found
