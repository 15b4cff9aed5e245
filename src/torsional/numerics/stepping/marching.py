"""Implicit time stepping of `Equations`: a state, and marches from it that may be cut anywhere.

The loop is compiled, and forces are evaluated by the laws' own kernels.  Energy is booked at every step.  Formulation:
Acary, Z. Angew. Math. Mech. 96 (2016) 585, of Newmark schemes with one-sided springs; the contacts' own time keeps
stiff ones from making energy.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.stepping.alpha_method import AlphaMethod
from torsional.numerics.stepping.loop import new_work, run
from torsional.numerics.stepping.plan import Plan
from torsional.numerics.stepping.start import begin
from torsional.numerics.stepping.state import Count, Entry, March, Records, Settings, State, Status

__all__ = ["Count", "Entry", "March", "Settings", "State", "Status", "begin", "march", "produced"]


def march(
    plan: Plan,
    method: AlphaMethod,
    step: float,
    steps: int,
    state: State,
    *,
    stride: int = 1,
    at: ArrayLike | None = None,
    settings: Settings | None = None,
) -> March:
    """Take ``steps`` steps of ``step`` h [s] from a state, which stays as it is.

    Recorded are the state at the start and after every ``stride`` steps, or after the steps listed in ``at``, rising;
    0 is the start.  A march in pieces, each from the state that the one before ended with, gives the same bits as one
    in a single call.  Governors act on the speed predicted for a step's end: one with k_p h act·M⁻¹·sense
    beyond 1 chatters.  Raises ModelError for a step that is not positive and for steps to record beyond the last.
    """
    chosen = np.arange(0, steps + 1, max(stride, 1)) if at is None else np.asarray(at)
    places = np.ascontiguousarray(chosen, dtype=np.int64)
    _check(step, steps, places)
    told = Settings() if settings is None else settings
    moved, records = state.copied(), blank_records(plan, places.size)
    numbers, own = (method.alpha_m, method.alpha_f, method.beta, method.gamma), typed(told)
    status = Status(run(plan, moved, new_work(plan, moved), own, numbers, float(step), int(steps), places, records))
    if not (np.isfinite(moved.coordinates).all() and np.isfinite(moved.ledger).all()):
        status = Status.NOT_FINITE
    elif status == Status.DONE and produced(moved.ledger, state.ledger) > told.production:
        status = Status.PRODUCES
    return March(records, moved, status)


def produced(ledger: Array, before: Array | None = None) -> float:
    """Energy that the method made of its own, since the start or since the ledger ``before``, over the throughput.

    Friction that on the whole gave energy is the method's doing as well.

    >>> ledger = np.zeros(len(Entry))
    >>> ledger[Entry.MADE], ledger[Entry.THROUGHPUT] = 2.0, 100.0
    >>> produced(ledger)
    0.02
    """
    made, through = float(ledger[Entry.MADE]), float(ledger[Entry.THROUGHPUT])
    lately = made if before is None else made - float(before[Entry.MADE])
    return max(0.0, made, lately, -float(ledger[Entry.RUBBED])) / through if through > 0.0 else 0.0


def _check(step: float, steps: int, places: IntArray) -> None:
    if not 0.0 < step < np.inf:
        raise ModelError("the time step must be positive", where="step", found=f"{step:g} s")
    if steps < 0 or (places.size and (np.diff(places) < 0).any()) or (places.size and places[0] < 0):
        raise ModelError("steps to record must rise from 0 on", where="at", found=f"{places[:5].tolist()}")
    if places.size and places[-1] > steps:
        raise ModelError("a step to record lies beyond the last", where="at", found=str(places[-1]), allowed=str(steps))


def typed(told: Settings) -> Settings:
    """Settings of the types that the loop is compiled for."""
    return told._replace(
        guard=bool(told.guard),
        passes=int(told.passes),
        rungs=int(told.rungs),
        agreement=float(told.agreement),
        angle_error=float(told.angle_error),
        relative_error=float(told.relative_error),
        production=float(told.production),
    )


def blank_records(plan: Plan, count: int) -> Records:
    """Room for a ``count`` of records."""
    n, connections, laws = plan.tape.node.size, plan.constants.shape[1], plan.laws.places.shape[1]
    shapes = ((count,), (3, count, n), (2, count, connections), (3, count, laws), (count, len(Entry)))
    return Records(*(np.full(shape, np.nan) for shape in shapes))
