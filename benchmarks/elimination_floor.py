"""L1 taken apart: operations of one solve, counted on the tape itself, and how near the kernel comes to the machine.

Run: OPENBLAS_NUM_THREADS=1 python benchmarks/elimination_floor.py
"""

from __future__ import annotations

import statistics
import time
from collections import Counter
from collections.abc import Callable

import chain15
import numpy as np
from ledger import Floor, Machine

from torsional.numerics.elimination import steps
from torsional.numerics.elimination.lanes import Rows
from torsional.numerics.elimination.plan import EliminationPlan
from torsional.numerics.elimination.route import build_route


class Counting:
    """Stands in for the builder of machine code: a formula that writes its instructions here is counted."""

    def __init__(self) -> None:
        self.counts: Counter[str] = Counter()

    def __getattr__(self, name: str) -> Callable[..., None]:
        return lambda *_, **__: self.counts.update([name])


def counted(program: np.ndarray) -> Counter[str]:
    """Instructions on one lane."""
    builder = Counting()
    for op, *offsets in program.tolist():
        steps._FORMULAS[op](Rows(builder, None), *offsets)
    return builder.counts


def floor(plan: EliminationPlan, loaded: range) -> tuple[Floor, Counter[str]]:
    """Arithmetic of one solve with all outputs, assembly included, and the bytes of its loads and results."""
    route = build_route(plan.tape, loaded, range(plan.nodes))
    counts = counted(route.fused) + counted(route.fused_backward)
    flops = sum(counts[name] for name in ("fadd", "fsub", "fmul", "fdiv", "fneg"))
    return Floor(flops + 5 * plan.tape.slot_row.size, 16 * (plan.nodes + len(loaded))), counts


def weights(n: int, planetary: int = 0) -> np.ndarray:
    """Shafts of a chain; one behind a planetary set on the shaft before."""
    rows = np.diff(np.eye(n), axis=0)
    if planetary:
        rows[planetary, planetary - 1 : planetary + 2] = -0.6, 1.6, -1.0
        rows = np.vstack([rows, np.eye(n)[planetary] - np.eye(n)[planetary - 1]])
    return rows


def timed(work: Callable[[], object], rounds: int = 41) -> float:
    """Median time [s] after one warming call."""
    work()
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def row(title: str, rows: np.ndarray, machine: Machine, frequencies: int = 12_000, designs: int = 1) -> None:
    """Time one topology with random values and print it beside its floor."""
    random, (m, n) = np.random.default_rng(1), rows.shape
    plan, loaded = EliminationPlan.build(rows, np.eye(n), keep_last=range(1, 7)), range(1, 7)
    k, c = 10 ** random.uniform(4, 6.5, (designs, m)), 10 ** random.uniform(0, 1.5, (designs, m))
    J = 10 ** random.uniform(-1.3, 0.5, (designs, n))
    omega, loads = np.linspace(20.0, 2500.0, frequencies), random.standard_normal((frequencies, 1, 6)) + 0j
    status = plan.solve(k, None, c, None, J, omega, 0.0, loaded, loads).status
    seconds = timed(lambda: plan.solve(k, None, c, None, J, omega, 0.0, loaded, loads)) / status.size
    least, counts = floor(plan, loaded)
    told = (
        f"{least.flops:5.0f} flops, {counts['fdiv']:2} divisions, {counts['load'] + counts['store']:4} loads and stores"
    )
    print(f"{title:34} {seconds * 1e9:7.1f} ns  {told}; {seconds / least.seconds(machine):4.1f} times the floor"
          f" {least.seconds(machine) * 1e9:5.1f} ns; {np.count_nonzero(status)} redone")  # fmt: skip


def main() -> None:
    """Print times and floors of chains, planetary sets and loops, then Chain15 beside NumPy."""
    machine = Machine.measured()
    print(
        f"matrix product {machine.flops_per_second / 1e9:.0f} Gflop/s, copy {machine.bytes_per_second / 1e9:.0f} GB/s"
    )
    row("chain of 15", weights(15), machine)
    row("with a planetary set", weights(15, 8), machine)
    row("chain of 30", weights(30), machine)
    row("with a planetary set", weights(30, 14), machine)
    ends = np.eye(30)[[0, 29]]
    row("ring of 30", np.vstack([weights(30), ends[1] - ends[0]]), machine)
    row("chain of 15, 2 000 designs × 128", weights(15), machine, 128, 2_000)
    row("chain of 15, 100 000 designs × 1", weights(15), machine, 1, 100_000)
    omega, dense = chain15.frequencies().ravel(), timed(chain15.dense, rounds=5)
    ground = chain15.GROUND_DAMPING
    plan = EliminationPlan.build(np.vstack([weights(15), np.eye(15)[ground > 0]]), np.eye(15), keep_last=range(1, 7))
    k, c = np.r_[chain15.STIFFNESS, np.zeros(7)], np.r_[chain15.DAMPING, ground[ground > 0]]
    loads = np.tile(chain15.torque()[chain15.THROWS].T, (chain15.RPM.size, 1))[:, None]
    given = (k, None, c, None, chain15.INERTIA, omega, 0.0, range(1, 7), loads)
    ours = timed(lambda: plan.solve(*given), rounds=201)
    one = timed(lambda: plan.solve(*given[:5], omega[:1], 0.0, range(1, 7), loads[:1]), rounds=201)
    print(f"Chain15: {ours / omega.size * 1e9:.1f} ns a solve, a single one {one * 1e6:.0f} µs; NumPy "
          f"{dense / omega.size * 1e9:.0f} ns: {dense / ours:.0f} times")  # fmt: skip


if __name__ == "__main__":
    main()
