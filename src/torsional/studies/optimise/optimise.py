"""The best designs for objectives under limits: searched, their front found, chosen ones refined by exact gradients."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict
from typing import Any

import xarray as xr

from torsional.errors import ModelError
from torsional.studies.crew import Crew
from torsional.studies.optimise.generations import Generations, Job, made, prepare
from torsional.studies.optimise.polish import refined
from torsional.studies.optimise.result import told
from torsional.studies.optimise.search import released, searched
from torsional.studies.optimise.task import Limit, Method, Task
from torsional.studies.sweeps.designs import Axis
from torsional.studies.sweeps.identity import code
from torsional.studies.sweeps.store import Store
from torsional.studies.sweeps.sweep import refuse_unsendable, writing
from torsional.studies.sweeps.work import Build, Run

VERSION = 1
Progress = Callable[[int, int], None]


def optimise(
    build: Build,
    over: Mapping[str, Any],
    run: Run,
    objectives: Sequence[str],
    limits: Mapping[str, Limit] | None = None,
    *,
    maximised: Sequence[str] = (),
    nominal: Mapping[str, Any] | None = None,
    method: Method | None = None,
    between: int = 3,
    folder: str | os.PathLike[str] | None = None,
    processes: int | None = 1,
    progress: Progress = lambda done, total: None,
) -> xr.Dataset:
    """All designs that a search has asked, with the Pareto front of the ``objectives`` within ``limits`` among them.

    ``build`` and ``run`` as `sweep` has them, ``run`` giving single figures by name; ``over``: ends (low, high) or an
    `Axis` by parameter.  Figures are made as small as can be, those ``maximised`` as large.  Designs lie along
    ``design``: figures, parameters, ``generation`` (0: the nominal one), ``on_front``, ``within`` (all limits),
    ``status`` and ``reason``; ``role`` names the nominal design, the ends and the knee of the front, and those that the
    search had found before gradients refined them.  ``between``: so many designs between the ends of a front of two
    objectives are refined too; -1 for no refinement.  With a ``folder`` the same call goes on where it was ended.  One
    ``method`` (seed) gives one result, whatever the number of ``processes``.

    Raises ModelError where the task, the folder or the processes cannot be, and without pymoo.
    """
    axes = {name: end if isinstance(end, Axis) else _ends(name, end) for name, end in over.items()}
    task = Task(build, axes, run, tuple(objectives), dict(limits or {}), frozenset(maximised), nominal)
    return optimised(task, method or Method(), between, folder, processes, progress)


def _ends(name: str, end: Sequence[float]) -> Axis:
    try:
        low, high = end
        return Axis(low=float(low), high=float(high))
    except (TypeError, ValueError) as error:
        problem = error.problem if isinstance(error, ModelError) else "two ends are wanted"
        raise ModelError(problem, where=name, found=str(end)) from None


def optimised(
    task: Task,
    method: Method,
    between: int = 3,
    folder: str | os.PathLike[str] | None = None,
    processes: int | None = 1,
    progress: Progress = lambda done, total: None,
) -> xr.Dataset:
    """`optimise` of a `Task`."""
    if processes != 1:
        refuse_unsendable(task.build, task.run)
    total = (task.nominal_values is not None) + method.population * method.generations
    with contextlib.ExitStack() as stack:
        at = folder or stack.enter_context(tempfile.TemporaryDirectory(prefix="torsional-"))
        with writing(at):
            store = begun(task, method, at)
            crew: Crew[Job, None] = stack.enter_context(Crew(made, prepare, (task, store, total), processes))
            kept = Generations(task, store, crew, lambda done: progress(done, max(total, done)))
            return _worked(task, method, between, kept)


def begun(task: Task, method: Method, folder: str | os.PathLike[str]) -> Store:
    """The store of an optimisation in a folder; raises ModelError where that holds another one."""
    plan = {"torsional_optimise": VERSION, **task.plan(), "method": asdict(method)}
    return Store.begun(folder, plan, f"{code()} {released()}")


def _worked(task: Task, method: Method, between: int, kept: Generations) -> xr.Dataset:
    if task.nominal_values is not None:
        kept.answers(0, {name: [value] for name, value in task.nominal_values.items()})
    searched(task, method, kept)
    count = len(kept.found)
    reason = refined(task, method, between, kept) if between >= 0 else "not asked for"
    return told(task, method, kept.found, count, reason)
