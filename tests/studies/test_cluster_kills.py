"""Two machines played by separate processes over loopback: killed at random moments, gone on with to the same bits."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from tests.signals import listening
from tests.studies.test_sweep import ENDS, TRUCK, answered, counted, made, same
from tests.studies.test_sweep_kills import CHUNK, COUNT, chunks, designs, until, workers

from torsional.studies.sweeps import sampled, sweep, table
from torsional.studies.sweeps.workers import LocalCluster, Slurm

pytest.importorskip("distributed")
ROOT = Path(__file__).parents[2]
pytestmark = [
    pytest.mark.full,
    pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals there"),
]
DRIVER = """
import sys
from tests.studies.test_sweep import TRUCK, answered
from tests.studies.test_sweep_kills import CHUNK, designs
from torsional.errors import ModelError
from torsional.studies.sweeps import cluster, sweep

cluster.ENOUGH = 0.3
if __name__ == "__main__":
    try:
        sweep(TRUCK, designs(), answered, folder=sys.argv[1], chunk=CHUNK, cluster=sys.argv[2])
    except ModelError as error:
        sys.exit(f"refused: {error}")
"""
LONGEST = 120.0  # [s] that anything is waited for


class Machines:
    """A scheduler and two machines with a worker each, which start it anew when it dies."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.file = folder, folder / "scheduler.json"
        self.started: list[subprocess.Popen[bytes]] = []

    def __enter__(self) -> Machines:
        self.scheduler = self._run("dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--dashboard-address", ":0")
        self.machines = [self._run("dask_worker", "--nthreads", "1", "--no-dashboard") for _ in range(2)]
        waited(lambda: self.file.exists() and self.file.stat().st_size > 0)
        self.address = str(json.loads(self.file.read_text())["address"])
        return self

    def _run(self, program: str, *options: str) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", f"distributed.cli.{program}", "--scheduler-file", str(self.file), *options]
        place = ["--local-directory", str(self.folder)] if program == "dask_worker" else []
        environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])}
        process = subprocess.Popen(
            [*command, *place], cwd=ROOT, env=environment, stderr=subprocess.DEVNULL, start_new_session=True
        )
        self.started.append(process)
        return process

    def workers(self) -> list[int]:
        """The processes at work."""
        return [pid for machine in self.machines for pid in workers(machine.pid)]

    def __exit__(self, *_: object) -> None:
        for process in self.started:
            for pid in workers(process.pid):
                os.kill(pid, signal.SIGKILL)
            process.kill()
            process.wait()


def waited(condition: Any) -> None:
    """Wait until something is so."""
    latest = time.monotonic() + LONGEST
    while not condition():
        assert time.monotonic() < latest, "waited in vain"
        time.sleep(0.02)


def driver(folder: Path, machines: Machines) -> subprocess.Popen[str]:
    """A driver in a group of its own."""
    command = [sys.executable, "-c", DRIVER, str(folder), machines.address]
    return subprocess.Popen(command, cwd=ROOT, stderr=subprocess.PIPE, text=True, start_new_session=True)


@pytest.fixture(scope="module")
def whole() -> xr.Dataset:
    """The undisturbed answer, worked out in this process."""
    return sweep(TRUCK, designs(), answered, chunk=CHUNK)


@pytest.fixture
def machines(tmp_path: Path) -> Iterator[Machines]:
    """Machines of a test of its own."""
    with Machines(tmp_path) as found:
        yield found


def test_two_machines_give_the_bits_of_one_process(tmp_path: Path, machines: Machines, whole: xr.Dataset) -> None:
    kept = tmp_path / "kept"
    assert same(whole, sweep(TRUCK, designs(), answered, folder=kept, chunk=CHUNK, cluster=machines.address))


def test_drivers_killed_at_random_moments(tmp_path: Path, machines: Machines, whole: xr.Dataset) -> None:
    """Ten, each after it has added something; workers stay for the next."""
    chance, kept = random.Random(1), tmp_path / "kept"
    for _ in range(10):
        process = driver(kept, machines)
        until(kept, chunks(kept) + 1, process)  # type: ignore[arg-type]
        time.sleep(chance.uniform(0.0, 0.3))
        assert process.poll() is None
        process.kill()
        process.communicate()
    assert chunks(kept) < COUNT // CHUNK
    assert same(whole, sweep(TRUCK, designs(), answered, folder=kept, chunk=CHUNK, cluster=machines.address))


def test_workers_killed_at_random_moments(tmp_path: Path, machines: Machines, whole: xr.Dataset) -> None:
    """Ten of one driver, which ends by itself with all done; no design is blamed thrice."""
    chance, kept, kills = random.Random(2), tmp_path / "kept", 0
    process = driver(kept, machines)
    while process.poll() is None and kills < 10:
        until(kept, chunks(kept) + 1, process)  # type: ignore[arg-type]
        time.sleep(chance.uniform(0.0, 0.3))
        for pid in machines.workers()[:1]:
            os.kill(pid, signal.SIGKILL)
            kills += 1
    _, told = process.communicate(timeout=LONGEST)
    assert process.returncode == 0 and kills == 10, told
    found = sweep(TRUCK, designs(), answered, folder=kept, chunk=CHUNK)
    assert not found.status.values.any() and same(whole, found)


def test_schedulers_killed_at_random_moments(tmp_path: Path, whole: xr.Dataset) -> None:
    """Five: the driver says that it has gone and how to go on, and what it had is kept."""
    chance, kept = random.Random(3), tmp_path / "kept"
    for number in range(5):
        place = tmp_path / str(number)
        place.mkdir()
        with Machines(place) as machines:
            process = driver(kept, machines)
            until(kept, chunks(kept) + 1, process)  # type: ignore[arg-type]
            time.sleep(chance.uniform(0.0, 0.3))
            before = chunks(kept)
            machines.scheduler.kill()
            _, told = process.communicate(timeout=LONGEST)
            assert process.returncode == 1 and "the scheduler has gone" in told and "--resume" in told, told
            assert "Traceback" not in told and chunks(kept) >= before > 0
    assert same(whole, sweep(TRUCK, designs(), answered, folder=kept, chunk=CHUNK, processes=2))


def test_two_drivers_on_one_folder_and_one_scheduler(tmp_path: Path, machines: Machines, whole: xr.Dataset) -> None:
    both = [driver(tmp_path / "kept", machines) for _ in range(2)]
    told = [process.communicate(timeout=2 * LONGEST)[1] for process in both]
    assert [process.returncode for process in both] == [0, 0], told
    assert same(whole, sweep(TRUCK, designs(), answered, folder=tmp_path / "kept", chunk=CHUNK))


@pytest.mark.parametrize("at_home", [True, False])
def test_a_design_that_ends_workers_is_set_aside(tmp_path: Path, at_home: bool) -> None:
    """After three; all others are answered, in the same bits as by processes."""
    told = table({"inertia": [1.0, 1.1, 1.2, 0.9], "fail": [0.0, 2.0, 0.0, 1.0]})
    if at_home:
        found = sweep(made, told, counted, chunk=2, cluster=LocalCluster(kind="local_cluster", count=2))
    else:
        with Machines(tmp_path) as machines:
            found = sweep(made, told, counted, chunk=2, cluster=machines.address)
    assert found.status.values.tolist() == [0, 3, 0, 2] and found.reason.values[1] == "ended 3 processes"
    assert same(found, sweep(made, told, counted, chunk=2, processes=2))


def test_ctrl_c_ends_driver_and_local_cluster_at_once_and_quietly(tmp_path: Path) -> None:
    plan = tmp_path / "plan.yaml"
    plan.write_text(
        f"torsional_sweep: 1\nmodel: {ROOT / 'examples' / 'truck_psva.yaml'}\n"
        "over: [{parameter: clutch.stiffness, low: 15 kNm/rad, high: 35 kNm/rad, points: 4000}]\n"
        "run: {analysis: transient, scenario: tip_in}\nchunk: 1\nworkers: {kind: local_cluster, count: 2}\n"
    )
    command = subprocess.Popen(
        [sys.executable, "-m", "torsional", "sweep", str(plan)], preexec_fn=listening,
        cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )  # fmt: skip
    waited(lambda: chunks(tmp_path / "plan.sweep") > 2 or command.poll() is not None)
    begun = workers(command.pid)
    os.killpg(command.pid, signal.SIGINT)
    _, said = command.communicate(timeout=60)
    assert command.returncode == 130 and "are kept in" in said and "--resume goes on" in said
    assert said.count("\n") == 1, said
    assert begun and not any(Path(f"/proc/{pid}").exists() for pid in begun)


def test_a_driver_that_is_killed_takes_its_local_cluster_along(tmp_path: Path) -> None:
    script = DRIVER.replace("sys.argv[2]", "LocalCluster(kind='local_cluster', count=1)").replace(
        "from torsional.errors", "from torsional.studies.sweeps.workers import LocalCluster\nfrom torsional.errors"
    )
    process = subprocess.Popen([sys.executable, "-c", script, str(tmp_path)], cwd=ROOT, start_new_session=True)
    waited(lambda: chunks(tmp_path) > 0)
    begun = workers(process.pid)
    process.kill()
    process.wait()
    assert begun
    waited(lambda: not any(Path(f"/proc/{pid}").exists() for pid in begun))


def test_jobs_of_a_queue(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A queue that starts every job at once, as `sbatch` and `scancel` of an idle cluster do."""
    fake = tmp_path / "bin"
    fake.mkdir()
    (fake / "sbatch").write_text(
        f"#!/bin/sh\ncd {tmp_path}\ncp \"$1\" script\nsetsid sh script >out 2>&1 &\n"
        'echo $! >> jobs\necho "Submitted batch job $!"\n'
    )
    (fake / "scancel").write_text('#!/bin/sh\nkill -- -"$1" 2>/dev/null\nexit 0\n')
    for path in fake.iterdir():
        path.chmod(0o755)
    monkeypatch.setenv("PATH", f"{fake}{os.pathsep}{os.environ['PATH']}")
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(ROOT), *sys.path]))
    monkeypatch.chdir(tmp_path)
    asked = Slurm(
        kind="slurm", jobs=1, cores=2, memory="2 GB", walltime="00:10:00", queue="compute", interface="lo",
        extra=["--constraint=fast"], account="driveline", prologue=["export QUEUED=1"],
    )  # fmt: skip
    few = sampled("sobol", ENDS, 40, seed=5)
    found = sweep(TRUCK, few, answered, chunk=CHUNK, cluster=asked)
    script = (tmp_path / "script").read_text()
    assert same(found, sweep(TRUCK, few, answered)) and np.isfinite(found.amplitude.values).all()
    for line in ("-p compute", "-A driveline", "--cpus-per-task=2", "-t 00:10:00", "--constraint=fast"):
        assert f"#SBATCH {line}" in script
    assert "--nworkers 2" in script and "--nthreads 1" in script and "export QUEUED=1" in script
    jobs = [int(line) for line in (tmp_path / "jobs").read_text().split()]
    waited(lambda: not any(Path(f"/proc/{pid}").exists() for pid in jobs))
