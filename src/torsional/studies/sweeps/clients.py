"""Ways to a dask scheduler: an address, somebody's client, a cluster that is started here."""

from __future__ import annotations

import contextlib
import logging
import shutil
import sys
import warnings
from collections.abc import Iterator
from importlib import import_module
from types import ModuleType
from typing import Any

from torsional.errors import ModelError
from torsional.studies.crew import ONE_THREAD, inherited, processors
from torsional.studies.sweeps.workers import Dask, Jobs, LocalCluster, Remote, scheduler_address

PATIENCE = 4.0  # [s] for a scheduler to answer
AT_HOME = {"distributed.deploy.lost-worker-timeout": "1000 days", "distributed.scheduler.allowed-failures": 0}
"""Of a cluster that is started here: dead workers are not given up, and what they died of is told at once."""
GOODBYE = 10.0  # [s] for workers that were started here to end
LOGGERS = ("distributed", "distributed.client", "dask_jobqueue", "asyncio", "tornado.application")
DEAF = "import signal\n\nsignal.signal(signal.SIGINT, signal.SIG_IGN)\n"
"""What a worker that is started here does first: Ctrl-C is the driver's to answer."""


@contextlib.contextmanager
def joined(workers: Any) -> Iterator[Any]:
    """A client of a scheduler, by its address, by settings that may start one, or the caller's own, which is kept open.

    Raises ModelError where nobody answers, where a library is missing, and where the queueing system is not here.
    """
    distributed = library("distributed")
    if isinstance(workers, distributed.Client):
        yield _usable(workers)
        return
    wanted = Dask(kind="dask", address=scheduler_address(workers)) if isinstance(workers, str) else workers
    with _quiet(), contextlib.ExitStack() as stack:
        place = _scheduler(wanted, stack)
        try:
            client = distributed.Client(place, timeout=PATIENCE, set_as_default=False)
        except (OSError, ValueError, RuntimeError) as error:
            raise _unanswered(wanted, error) from None
        stack.callback(_closed, client)
        yield client


def library(name: str) -> ModuleType:
    """A library that the extra `cluster` brings; raises ModelError where it is not installed."""
    try:
        return import_module(name)
    except ImportError:
        remedy = "pip install 'torsional[cluster]'"
        problem = "a library that clusters need is not installed"
        raise ModelError(problem, where="workers", found=name.replace("_", "-"), remedy=remedy) from None


def _usable(client: Any) -> Any:
    if client.asynchronous:
        raise ModelError("the client is asynchronous", where="cluster", remedy="give one made by Client(...) alone")
    if client.status != "running":
        raise ModelError("the client is not connected", where="cluster", found=str(client.status))
    return client


def _scheduler(wanted: Remote, stack: contextlib.ExitStack) -> Any:
    """The address of the scheduler, or a cluster that is started and ends with the ``stack``."""
    if isinstance(wanted, Dask):
        return wanted.address
    if isinstance(wanted, LocalCluster):
        stack.enter_context(library("dask").config.set(AT_HOME))
        cluster = _local(wanted)
    else:
        cluster = _queued(wanted)
    stack.callback(_closed, cluster)
    return cluster


def _local(wanted: LocalCluster) -> Any:
    with inherited():
        return library("distributed").LocalCluster(
            n_workers=wanted.count or processors(),
            threads_per_worker=1,
            host="127.0.0.1",
            dashboard_address=":0",
            silence_logs=logging.CRITICAL,
            env=dict.fromkeys(ONE_THREAD, "1"),
            preload=[DEAF],
        )


def _queued(wanted: Jobs) -> Any:
    if shutil.which(wanted.submit) is None:
        remedy = "start the sweep on a machine from which jobs are sent"
        raise ModelError(
            "the queueing system is not here", where="workers", found=f"no command {wanted.submit}", remedy=remedy
        )
    make = getattr(library("dask_jobqueue"), wanted.queueing)
    try:
        cluster = make(**wanted.settings, scheduler_options={"dashboard_address": ":0"})
    except (ValueError, OSError, RuntimeError) as error:
        raise ModelError("the jobs cannot be asked for", where="workers", found=str(error)) from None
    cluster.adapt(minimum_jobs=wanted.jobs, maximum_jobs=wanted.jobs)  # jobs that end are asked for again
    return cluster


def _unanswered(wanted: Remote, error: Exception) -> ModelError:
    where = wanted.address if isinstance(wanted, Dask) else f"workers of kind {wanted.kind}"
    reason = str(error).strip().split("\n")[0] or type(error).__name__
    remedy = "is one running there (dask scheduler), and does it speak the same protocol?"
    return ModelError("no scheduler answers", where=where, found=reason, remedy=remedy)


def _closed(opened: Any) -> None:
    """End a client or a cluster, also one whose other side has gone."""
    with contextlib.suppress(Exception), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        opened.close(timeout=GOODBYE)


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """What the library logs of workers that come and go is ours to tell."""
    loggers = [logging.getLogger(name) for name in LOGGERS]
    levels = [each.level for each in loggers]
    for each in loggers:
        each.setLevel(sys.maxsize)
    try:
        yield
    finally:
        for each, level in zip(loggers, levels, strict=True):
            each.setLevel(level)
