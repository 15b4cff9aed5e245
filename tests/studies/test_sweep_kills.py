"""Sweeps ended at random moments: driver and workers by SIGKILL, a full disk, two drivers, bits turned on the disk."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import xarray as xr
from tests.studies.test_sweep import ENDS, TRUCK, answered, same

from torsional.errors import ModelError
from torsional.studies.sweeps import sampled, sweep
from torsional.studies.sweeps.designs import Designs

ROOT = Path(__file__).parents[2]
pytestmark = [
    pytest.mark.full,
    pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals there"),
]
COUNT, CHUNK = 600, 4
DRIVER = """
import sys
from tests.studies.test_sweep import TRUCK, answered
from tests.studies.test_sweep_kills import CHUNK, designs
from torsional.studies.sweeps import sweep

if __name__ == "__main__":
    sweep(TRUCK, designs(), answered, folder=sys.argv[1], chunk=CHUNK, processes=2)
"""


def designs() -> Designs:
    """Points whose work takes two processes some ten seconds."""
    return sampled("sobol", ENDS, COUNT, seed=5)


@pytest.fixture(scope="module")
def whole() -> xr.Dataset:
    """The undisturbed answer."""
    return sweep(TRUCK, designs(), answered, chunk=CHUNK)


def driver(folder: Path) -> subprocess.Popen[bytes]:
    """A driver with two workers, in a group of its own."""
    return subprocess.Popen(
        [sys.executable, "-c", DRIVER, str(folder)], cwd=ROOT, stderr=subprocess.DEVNULL, start_new_session=True
    )


def workers(pid: int) -> list[int]:
    """The processes that a driver has spawned to work, by what their command lines say."""
    told = subprocess.run(["ps", "-wweo", "pid=,ppid=,args="], capture_output=True, text=True, check=True)
    rows = [line.split(None, 2) for line in told.stdout.splitlines()]
    return [
        int(own)
        for own, parent, args in (r for r in rows if len(r) == 3)
        if parent == str(pid) and "spawn_main" in args
    ]


def chunks(folder: Path) -> int:
    """How many pieces lie there."""
    return len(list(folder.glob("chunks/0*")))


def until(folder: Path, count: int, process: subprocess.Popen[bytes]) -> None:
    """Wait until so many pieces lie there, or the driver has ended."""
    latest = time.monotonic() + 60
    while chunks(folder) < count and process.poll() is None and time.monotonic() < latest:
        time.sleep(0.01)


def test_drivers_killed_at_random_moments(tmp_path: Path, whole: xr.Dataset) -> None:
    """Twenty-five, each after it has added something."""
    chance, kills = random.Random(1), 0
    for _ in range(25):
        process = driver(tmp_path)
        until(tmp_path, chunks(tmp_path) + 1, process)
        time.sleep(chance.uniform(0.0, 0.05))
        kills += process.poll() is None
        process.kill()
        process.wait()
    assert kills >= 20 and chunks(tmp_path) < COUNT // CHUNK
    assert same(whole, sweep(TRUCK, designs(), answered, folder=tmp_path, chunk=CHUNK, processes=2))


def test_workers_killed_at_random_moments(tmp_path: Path, whole: xr.Dataset) -> None:
    """Twenty-five of one driver, which ends by itself with all done; no design is blamed thrice."""
    chance, kills = random.Random(2), 0
    process = driver(tmp_path)
    while process.poll() is None and kills < 25:
        until(tmp_path, chunks(tmp_path) + 2, process)
        time.sleep(chance.uniform(0.0, 0.05))
        found = workers(process.pid)
        if found:
            os.kill(chance.choice(found), signal.SIGKILL)
            kills += 1
    assert process.wait(timeout=120) == 0 and kills == 25
    found = sweep(TRUCK, designs(), answered, folder=tmp_path, chunk=CHUNK)
    assert not found.status.values.any() and same(whole, found)


def test_two_drivers_on_one_folder(tmp_path: Path, whole: xr.Dataset) -> None:
    both = [driver(tmp_path) for _ in range(2)]
    assert [process.wait(timeout=240) for process in both] == [0, 0]
    assert same(whole, sweep(TRUCK, designs(), answered, folder=tmp_path, chunk=CHUNK))
    assert chunks(tmp_path) == COUNT // CHUNK


def test_bits_turned_and_files_cut_on_the_disk(tmp_path: Path, whole: xr.Dataset) -> None:
    chance = random.Random(3)
    sweep(TRUCK, designs(), answered, folder=tmp_path, chunk=CHUNK, processes=2)
    for path in chance.sample(sorted(tmp_path.glob("chunks/0*")), 20):
        data = bytearray(path.read_bytes())
        if chance.random() < 0.5:
            data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
        else:
            del data[chance.randrange(len(data)) :]
        path.write_bytes(bytes(data))
    assert same(whole, sweep(TRUCK, designs(), answered, folder=tmp_path, chunk=CHUNK))


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of 200 kB."""
    place = tmp_path / "small"
    place.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=200k", "tmpfs", str(place)], capture_output=True)
    if mounted.returncode:
        pytest.skip("a small disk cannot be mounted here: " + mounted.stderr.decode().strip())
    yield place
    subprocess.run(["umount", str(place)], check=True)


def test_a_full_disk_is_told_and_gone_on_from(small_disk: Path, whole: xr.Dataset) -> None:
    """What fits is kept; with room again the rest is worked out."""
    folder = small_disk / "sweep"
    with pytest.raises(
        ModelError, match="cannot be written; found No space left on device; what was worked out is kept"
    ):
        sweep(TRUCK, designs(), answered, folder=folder, chunk=CHUNK)
    before = chunks(folder)
    assert 0 < before < COUNT // CHUNK and not list(folder.glob("chunks/.*"))
    subprocess.run(["mount", "-o", "remount,size=5m", str(small_disk)], check=True)
    assert same(whole, sweep(TRUCK, designs(), answered, folder=folder, chunk=CHUNK, processes=2))
