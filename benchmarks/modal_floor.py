"""L3 taken apart: what the modes of one design of Chain15 cost in operations, and how near the kernel comes to that.

Run: OPENBLAS_NUM_THREADS=1 python benchmarks/modal_floor.py
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable

import chain15
import numpy as np
import ours
import peers
from ledger import Floor, Machine

from torsional.numerics.modes.jacobi import graded_rows


def replay(inertia: np.ndarray, stiffness: np.ndarray) -> tuple[int, int, int]:
    """Sweeps, products and rotations of the one-sided Jacobi method on one design, replayed in NumPy."""
    network = np.sqrt(stiffness)[:, None] * np.diff(np.eye(inertia.size), axis=0) / np.sqrt(inertia)
    rows = graded_rows(network[:, :, None].copy(), stiffness.size)[0][:, :, 0]
    sweeps = products = rotations = turned = 0
    while sweeps == 0 or turned:
        sweeps, turned = sweeps + 1, 0
        for i in range(len(rows) - 1):
            for j in range(i + 1, len(rows)):
                p, q = rows[i], rows[j]
                product, products = p @ q, products + 1
                if abs(product) <= inertia.size * 2.3e-16 * np.sqrt((p @ p) * (q @ q)):
                    continue
                cotangent = (q @ q - p @ p) / (2.0 * product)
                tangent = np.copysign(1.0, cotangent) / (abs(cotangent) + np.hypot(1.0, cotangent))
                cosine = 1.0 / np.hypot(1.0, tangent)
                rows[[i, j]] = cosine * np.array([p - tangent * q, tangent * p + q])
                turned += 1
        rotations += turned
    return sweeps, products, rotations


def floor(sample: int = 20) -> Floor:
    """Operations of one design, the mean of a few, counting the dense steps in full; bytes read and written."""
    inertia, stiffness = chain15.designs(sample)
    _, products, rotations = np.mean([replay(*design) for design in zip(inertia, stiffness, strict=True)], axis=0)
    n = inertia.shape[1]
    factors = 2 / 3 * n**3 + 2 * n**3 + n**3  # elimination, Householder triangle with its pivot search, their product
    return Floor(flops=factors + 2 * n * products + (6 * n + 20) * rotations, bytes=8 * (n * n + 3 * n))


def median(work: Callable[[], object], rounds: int = 7) -> float:
    """Median time [s] after one warming call."""
    work()
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def main() -> None:
    """Print the time of a design beside SciPy's and beside the counted floor."""
    few, many = chain15.designs(1_000), chain15.designs(10_000)
    matrices = peers.stiffness_matrices(few[1])
    scipy_time = median(lambda: peers.scipy_modes(few[0], matrices)) / len(few[0])
    our_time = median(lambda: ours.modes(*many)) / len(many[0])
    one = median(lambda: ours.modes(many[0][:1], many[1][:1]), rounds=101)
    machine, counted = Machine.measured(), floor()
    sweeps, _, rotations = replay(many[0][0], many[1][0])
    print(f"scipy.linalg.eigh in a loop  {scipy_time * 1e6:7.1f} µs a design")
    print(f"torsional, 10 000 designs    {our_time * 1e6:7.1f} µs a design, {scipy_time / our_time:.1f} times faster")
    print(f"torsional, one design        {one * 1e6:7.1f} µs")
    print(f"{sweeps} sweeps, {rotations} rotations, {counted.flops:.0f} operations, {counted.bytes:.0f} bytes a design")
    rate, peak = counted.flops / our_time / 1e9, machine.flops_per_second / 1e9
    print(f"{rate:.1f} Gflop/s of {peak:.1f} in a matrix product: {peak / rate:.1f} times the floor")


if __name__ == "__main__":
    main()
