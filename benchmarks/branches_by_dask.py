"""Nonlinear branches as a Dask run: H1's line of 12 discs with other springs, in process and on workers beside it.

    python benchmarks/branches_by_dask.py [branches, 10000] [workers, 2]

Each design is assembled anew; its main branch from 600 to 1200 rpm is followed with folds and period doublings located.
"""

from __future__ import annotations

import resource
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import dmf12
import numpy as np
import ours_periodic as ours

from torsional import Coupling, Inertia, Powertrain, Shaft, assemble
from torsional.laws import Hinges
from torsional.solvers.periodic.response import Exploration, explorer_of
from torsional.studies.sweeps import sampled, sweep
from torsional.studies.sweeps.clients import joined
from torsional.studies.sweeps.workers import LocalCluster

ENDS = {"first": (8e3, 12e3), "second": (20e3, 30e3), "gap": (0.06, 0.10)}
CHUNK, TOLD = 50, 4
ASKED = Exploration(highest_order=ours.HIGHEST, depth=0, stability=False)


def line(first: float, second: float, gap: float):
    """The line with other springs in its flywheel."""
    law = Hinges(first, (gap, -gap), (1.0, -1.0), (second - first, second - first))
    parts = {name: Inertia(float(J)) for name, J in zip(ours.NODES, dmf12.INERTIA, strict=True)}
    for i, (k, c) in enumerate(zip(dmf12.STIFFNESS.tolist(), dmf12.DAMPING.tolist(), strict=True)):
        ends = ours.NODES[i], ours.NODES[i + 1]
        if i == dmf12.PRIMARY:
            parts[ours.SPRINGS] = Coupling(*ends, law, damping=c)
        else:
            parts[f"shaft_{i}"] = Shaft(*ends, k, c)
    parts["mount"] = Shaft("ground", ours.NODES[-1], dmf12.GROUND_STIFFNESS)
    return assemble(Powertrain(parts))


def branch(system) -> dict:
    """Its branch: points, order 3 at the lowest speed, the speeds of folds and period doublings, processor time."""
    since = time.process_time()
    found = explorer_of(system, ours.excitation(), ours.SPAN, ASKED).explored()[0]
    seconds = time.process_time() - since
    told = {"points": len(found.points), "seconds": seconds}
    told["amplitude"] = float(abs(found.problem.harmonics_of(found.scaled)[0, 0, 1]))
    for name in ("fold", "period doubling"):
        at = np.sort([event.parameter / dmf12.RPM for event in found.events if event.event == name])
        told[f"{name}s"] = at.size
        told[name] = ("place", np.append(at[:TOLD], np.full(max(TOLD - at.size, 0), np.nan)))
    return told


def used() -> float:
    """Processor time of this process and of those it has seen the end of [s]."""
    usages = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in usages)


def timed(work) -> tuple[object, float, float]:
    """What some work gives, the time it takes and its processor time, with that of processes that it ended."""
    wall, busy = time.perf_counter(), used()
    found = work()
    return found, time.perf_counter() - wall, used() - busy


def told(name: str, count: int, found, wall: float, busy: float) -> None:
    each = np.median(found.seconds.values) * 1e3
    print(f"{name:24s} {wall:7.1f} s wall {busy:7.1f} s CPU {1e3 * busy / count:6.2f} ms CPU a design; "
          f"the branch itself {each:.2f} ms (median)")  # fmt: skip


def main(count: int, workers: int) -> None:
    designs = sampled("sobol", ENDS, count, seed=1)
    reference = branch(line(float(dmf12.STIFFNESS[dmf12.PRIMARY]), dmf12.SECOND_STAGE, dmf12.GAP))
    assert abs(reference["amplitude"] / dmf12.AMPLITUDE - 1) < 1e-6
    np.testing.assert_allclose(reference["period doubling"][1][:2], dmf12.DOUBLINGS, atol=1e-4)
    place = LocalCluster(kind="local_cluster", count=workers)

    def on_dask():
        with tempfile.TemporaryDirectory() as folder, joined(place) as client:
            client.wait_for_workers(workers)
            started = time.perf_counter()
            found = sweep(line, designs, branch, folder=folder, chunk=CHUNK, cluster=client)
            print(f"{'working':24s} {time.perf_counter() - started:7.1f} s wall, without start and end of the workers")
            return found

    far, wall, busy = timed(on_dask)
    told(f"dask, {workers} workers", count, far, wall, busy)
    here, wall, busy = timed(lambda: sweep(line, designs, branch, chunk=CHUNK))
    told("in process", count, here, wall, busy)
    figures = [name for name in here if here[name].dtype.kind in "if" and name != "seconds"]
    same = all(here[name].values.tobytes() == far[name].values.tobytes() for name in figures)
    doubled = float((here["period doublings"] > 0).mean())
    print(f"the same bits: {same}; {int((here.status == 0).sum())} of {count} answered; "
          f"{float(here.points.mean()):.0f} points a branch; {100 * doubled:.0f} % double their period")  # fmt: skip


if __name__ == "__main__":
    asked = [int(each) for each in sys.argv[1:]]
    main(*asked, *(10_000, 2)[len(asked) :])
