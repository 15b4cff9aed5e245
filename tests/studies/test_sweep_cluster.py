"""Sweeps on a dask scheduler with a worker in this process: what is sent, what comes back, what is refused."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.studies.test_sweep import ENDS, LEVELS, TRUCK, answered, counted, made, same

from torsional.errors import ModelError
from torsional.model import Model
from torsional.studies.sweeps import clients, cluster, remote, sampled, sweep, table
from torsional.studies.sweeps.workers import Dask, Slurm

DESIGNS = sampled("latin_hypercube", ENDS, 9, seed=2)


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    """A client of a scheduler and one worker, all in this process."""
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(
            n_workers=1, threads_per_worker=2, processes=False, dashboard_address=":0", silence_logs=50
        ) as here,
        distributed.Client(here, set_as_default=False) as found,
    ):
        yield found


def test_the_same_bits_as_in_process(client: Any, tmp_path: Path) -> None:
    """Also of what is in the folder; what is there already is not asked again."""
    told: list[tuple[int, int]] = []
    found = sweep(
        TRUCK, DESIGNS, answered, cluster=client, folder=tmp_path / "far", chunk=2, progress=lambda *at: told.append(at)
    )
    assert same(found, sweep(TRUCK, DESIGNS, answered, folder=tmp_path / "here", chunk=2))
    far, here = (sorted((tmp_path / place / "chunks").iterdir()) for place in ("far", "here"))
    assert [(path.name, path.read_bytes()) for path in far] == [(path.name, path.read_bytes()) for path in here]
    assert told[0] == (0, 9) and told[-1] == (9, 9) and len(told) == 6
    far[3].unlink()
    told.clear()
    again = {"folder": tmp_path / "far", "chunk": 2, "progress": lambda *at: told.append(at)}
    sweep(TRUCK, DESIGNS, answered, cluster=client, **again)  # type: ignore[arg-type]
    assert told == [(7, 9), (9, 9)]


def test_functions_without_a_name_are_sent_too(client: Any) -> None:
    place = "secondary"
    found = sweep(TRUCK, LEVELS, lambda model: {"here": place in model.components}, cluster=client)
    assert found.here.values.all()


def test_failures_come_back_with_status_and_reason(client: Any) -> None:
    designs = table({"inertia": [1.0, -1.0, 1.2], "fail": [0.0, 0.0, 1.0]})
    assert same(sweep(made, designs, counted, cluster=client), sweep(made, designs, counted))


def test_small_chunks_are_asked_together(client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """As many as take a second by what others took, whatever the bits."""
    asked: list[int] = []
    submit = cluster.ClusterCrew._submit

    def noted(crew: cluster.ClusterCrew, task: Any, unaware: bool = False) -> None:
        asked.append(len(task.numbers))
        submit(crew, task, unaware)

    monkeypatch.setattr(cluster.ClusterCrew, "_submit", noted)
    designs = sampled("sobol", ENDS, 80, seed=1)
    found = sweep(TRUCK, designs, counted, cluster=client, chunk=1)
    assert same(found, sweep(TRUCK, designs, counted))
    assert asked[0] == 1 and max(asked) > 5 and len(asked) < 30


def test_what_workers_die_of_is_cut_down_to_the_design(client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """By a scheduler that gives up what holds designs 4 or 7 of nine, whatever is asked beside them."""
    asked: list[tuple[tuple[int, ...], int]] = []
    told = cluster.ClusterCrew._told

    def dying(crew: cluster.ClusterCrew, future: Any) -> Any:
        task, _ = crew._out[future.key]
        designs = {d for n in task.numbers for d in crew._pieces.designs(n)} if task.design < 0 else {task.design}
        if not (designs - crew._aside()) & {4, 7}:
            return told(crew, future)
        asked.append(task)
        crew._deaths += 1
        return None

    monkeypatch.setattr(cluster.ClusterCrew, "_told", dying)
    found = sweep(TRUCK, DESIGNS, counted, cluster=client, chunk=2)
    assert found.status.values.tolist() == [0, 0, 0, 0, 3, 0, 0, 3, 0]
    assert found.reason.values[4] == "ended 3 processes" and found.nodes.values[[0, 8]].all()
    alone = [task.design for task in asked if task.design >= 0]
    assert sorted(alone) == [4, 4, 4, 7, 7, 7]


def test_a_piece_that_ends_workers_only_as_a_whole_is_refused(client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    told = cluster.ClusterCrew._told

    def dying(crew: cluster.ClusterCrew, future: Any) -> Any:
        task, _ = crew._out[future.key]
        crew._deaths += 1
        return told(crew, future) if task.design >= 0 else None

    monkeypatch.setattr(cluster.ClusterCrew, "_told", dying)
    with pytest.raises(ModelError, match=r"ends every process .* each design by itself does not.* give wor"):
        sweep(TRUCK, DESIGNS, counted, cluster=client, chunk=5)


def test_other_code_is_refused(client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(remote, "code", lambda: "0123456789abcdef")
    with pytest.raises(ModelError, match=r"inproc.*other code than this one; found .* 0123456789ab there, .* here"):
        sweep(TRUCK, DESIGNS, answered, cluster=client)


def test_functions_that_a_worker_cannot_read_are_told(client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "_sent", lambda pieces: b"cno_such_module\nthing\n.")
    with pytest.raises(ModelError, match=r"cannot read the functions it is sent; found ModuleNot.*no_such_module"):
        sweep(TRUCK, DESIGNS, answered, cluster=client)


def test_functions_of_another_text_than_the_workers_are_told(client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "source", lambda function: "other")
    with pytest.raises(ModelError, match="the function 'run' has another text here"):
        sweep(TRUCK, DESIGNS, answered, cluster=client)


def test_what_cannot_be_sent_is_told(client: Any) -> None:
    lock = threading.Lock()

    def locked(model: Model) -> dict[str, Any]:
        with lock:
            return {"nodes": len(model.components)}

    with pytest.raises(ModelError, match="workers cannot be sent these functions; found TypeError"):
        sweep(TRUCK, DESIGNS, locked, cluster=client)


def test_addresses_that_lead_nowhere(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr(clients, "PATIENCE", 0.2)
    for place in ("tcp://127.0.0.1:1", Dask(kind="dask", address="tcp://127.0.0.1:1")):
        with pytest.raises(ModelError, match=r"tcp://127.0.0.1:1: no scheduler answers; found .*; is one running"):
            sweep(TRUCK, DESIGNS, answered, cluster=place)
    with pytest.raises(ModelError, match=r"no address of a scheduler; found 'there:8786'; allowed: .*tcp://h"):
        sweep(TRUCK, DESIGNS, answered, cluster="there:8786")


def test_a_missing_library_names_its_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    with pytest.raises(ModelError, match=r"a library .*found distributed; pip install 'torsional\[clu"):
        sweep(TRUCK, DESIGNS, answered, cluster="tcp://127.0.0.1:1")


def test_a_client_that_is_closed_is_refused(client: Any) -> None:
    with type(client)(client.scheduler.address, set_as_default=False) as closed:
        pass
    with pytest.raises(ModelError, match="the client is not connected; found closed"):
        sweep(TRUCK, DESIGNS, answered, cluster=closed)


def test_a_scheduler_without_workers_is_waited_for_with_a_word(client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """The word, a warning, is an error here and so ends the waiting."""
    monkeypatch.setattr(cluster, "LONELY", 0.1)
    monkeypatch.setattr(cluster, "LOOK", 0.05)
    local = type(client.cluster)
    with (
        local(n_workers=0, processes=False, dashboard_address=":0", silence_logs=50) as here,
        type(client)(here, set_as_default=False) as lonely,
        pytest.raises(UserWarning, match="has no worker; waiting for one"),
    ):
        sweep(TRUCK, DESIGNS, counted, cluster=lonely)


def test_a_queue_that_is_not_here_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ModelError, match=r"queueing system is not here; found no command sbatch; start the sweep on"):
        sweep(TRUCK, DESIGNS, answered, cluster=Slurm(kind="slurm", jobs=1, cores=2, memory="2 GB"))
