"""Solve random networks in 50-digit arithmetic and freeze the results: ``python -m tests.reference.generate``.

Nothing of the package takes part in the solution: responses come from the full equations with one Lagrange multiplier
for each gear, frequencies from the symmetric eigenvalue problem of the discs tied together by gears.
"""

from __future__ import annotations

import gzip
import json
from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np

from tests.random_models import Network, random_network

TARGET = Path(__file__).with_name("networks.json.gz")
COUNT = 200


def response(net: Network, omega: mp.mpf, loaded: int) -> list[mp.mpc]:
    """Angles of all discs under 1 Nm at one of them, gears held by Lagrange multipliers."""
    n, g = len(net.inertias), len(net.gears)
    z = mp.matrix(n + g, n + g)
    for i, inertia in enumerate(net.inertias):
        z[i, i] -= omega**2 * mp.mpf(inertia)
    for a, b, k, c in net.shafts:
        value = mp.mpc(mp.mpf(k), omega * mp.mpf(c))
        z[a, a] += value
        z[b, b] += value
        z[a, b] -= value
        z[b, a] -= value
    for row, (a, b, ratio) in enumerate(net.gears, n):
        z[row, a] = z[a, row] = mp.mpf(1)
        z[row, b] = z[b, row] = -mp.mpf(ratio)
    load = mp.matrix(n + g, 1)
    load[loaded] = 1
    return list(mp.lu_solve(z, load))[:n]


def frequencies(net: Network) -> list[mp.mpf]:
    """Angular frequencies, ascending: discs tied by gears turn as one coordinate."""
    group, factor = _tied(net)
    kept = sorted(set(group))
    at = {g: i for i, g in enumerate(kept)}
    mass, k = [mp.mpf(0)] * len(kept), mp.matrix(len(kept), len(kept))
    for i, inertia in enumerate(net.inertias):
        mass[at[group[i]]] += mp.mpf(inertia) * factor[i] ** 2
    for a, b, stiffness, _ in net.shafts:
        row = {at[group[a]]: -factor[a]}
        row[at[group[b]]] = row.get(at[group[b]], mp.mpf(0)) + factor[b]
        for i, wi in row.items():
            for j, wj in row.items():
                k[i, j] += mp.mpf(stiffness) * wi * wj / mp.sqrt(mass[i] * mass[j])
    values = mp.eigsy(k, eigvals_only=True)
    return [mp.sqrt(v) if v > mp.mpf(10) ** -30 * values[len(values) - 1] else mp.mpf(0) for v in values]


def _tied(net: Network) -> tuple[list[int], list[mp.mpf]]:
    """For each disc the disc that stands for it and θ of the disc over θ of that one."""
    group, factor = list(range(len(net.inertias))), [mp.mpf(1)] * len(net.inertias)
    for a, b, ratio in net.gears:
        share = factor[a] / mp.mpf(ratio)
        old, scale = group[b], factor[b]
        for i, g in enumerate(group):
            if g == old:
                group[i], factor[i] = group[a], factor[i] / scale * share
    return group, factor


def case(seed: int) -> dict[str, Any]:
    """One network with its frequencies and the response at one frequency away from resonance."""
    rng = np.random.default_rng(seed)
    nodes = int(np.clip(round(2 * 20 ** rng.random() ** 1.3), 2, 40))
    net = random_network(rng, nodes)
    omegas = frequencies(net)
    elastic = [w for w in omegas if w > 0]
    omega = mp.mpf(float(elastic[int(rng.integers(0, len(elastic)))] * mp.mpf(float(rng.uniform(0.3, 1.7)))))
    loaded = int(rng.integers(0, len(net.inertias)))
    x = response(net, omega, loaded)
    return {
        "inertias": net.inertias,
        "shafts": net.shafts,
        "gears": net.gears,
        "omega": float(omega),
        "loaded": loaded,
        "response": [[mp.nstr(v.real, 20), mp.nstr(v.imag, 20)] for v in x],
        "frequencies": [mp.nstr(w, 20) for w in omegas],
    }


def main() -> None:
    """Write all cases."""
    mp.mp.dps = 50
    cases = [case(seed) for seed in range(COUNT)]
    with gzip.GzipFile(TARGET, "wb", mtime=0) as file:
        file.write(json.dumps(cases).encode())


if __name__ == "__main__":
    main()
