"""Random models of the elimination's reference, and the file of their responses in 50-digit arithmetic.

``python tests/numerics/elimination/elimination_models.py`` writes the file anew (it needs mpmath and some minutes).
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

FILE = Path(__file__).with_name("elimination_reference.npz")
COUNT = 120
FIELDS = ("connection_weights", "mass_weights", "stiffness", "loss", "damping", "inertia", "response")


@dataclass(frozen=True)
class Reference:
    """One model at one frequency, loaded by 1 Nm at one node, and the response correctly rounded."""

    connection_weights: np.ndarray
    mass_weights: np.ndarray
    stiffness: np.ndarray
    loss: np.ndarray
    damping: np.ndarray
    inertia: np.ndarray
    response: np.ndarray
    omega: float
    node: int

    @property
    def planetary(self) -> bool:
        return bool(np.any(np.count_nonzero(self.connection_weights, axis=1) > 2))


def _log_uniform(random: np.random.Generator, low: float, high: float, size: int) -> np.ndarray:
    return np.exp(random.uniform(np.log(low), np.log(high), size))


def _connections(random: np.random.Generator, n: int, planetary: bool) -> np.ndarray:
    """A tree of shafts behind gear ratios 0.1–20, some behind a planetary set, and a few that close loops."""
    rows = np.zeros((n - 1 + int(random.integers(0, max(1, n // 4) + 1)), n))
    ratios = _log_uniform(random, 0.1, 20.0, len(rows))
    for row, ratio, i in zip(rows, ratios, range(1, len(rows) + 1), strict=True):
        a, b = (i, int(random.integers(max(0, i - 3), i))) if i < n else random.choice(n, 2, replace=False)
        if planetary and 2 <= i < n and random.random() < 0.15:
            a, b = random.choice(i, 2, replace=False)
            row[a], row[b] = random.integers(7, 1280, 2) / 64  # dyadic, so that the weights add up to exactly zero
            row[i] = -(row[a] + row[b])
        else:
            row[a], row[b] = ratio, -ratio
    return rows


def random_model(random: np.random.Generator, planetary: bool, damped: bool) -> Reference:
    """Trees and loops of 2–40 nodes, ratios 0.1–20, J 1e-4–1e4, k 10–1e9, damping 0–0.5; the response is missing."""
    n = int(random.integers(2, 41))
    weights = _connections(random, n, planetary)
    m = len(weights)
    stiffness = _log_uniform(random, 10.0, 1e9, m)
    loss = damped * np.where(random.random(m) < 0.5, random.uniform(0.0, 0.5, m), 0.0)
    damping = damped * np.where(random.random(m) < 0.3, stiffness * _log_uniform(random, 1e-6, 1e-3, m), 0.0)
    inertia, ratios = _log_uniform(random, 1e-4, 1e4, n), _log_uniform(random, 0.1, 20.0, n)
    omega, node = float(10.0 ** random.uniform(0.0, 3.8)), int(random.integers(n))
    return Reference(weights, np.diag(ratios), stiffness, loss, damping, inertia, np.zeros(n, complex), omega, node)


def exact(model: Reference) -> np.ndarray:
    """The response by Gaussian elimination in 60 digits."""
    import mpmath as mp

    n = len(model.response)
    with mp.workdps(60):
        omega = mp.mpf(model.omega)
        Z, b = mp.matrix(n, n), mp.matrix(n, 1)
        values = [mp.mpf(k) * mp.mpc(1, h) + mp.mpc(0, omega * mp.mpf(c)) for k, h, c in zip(
            model.stiffness, model.loss, model.damping, strict=True)]  # fmt: skip
        values += [-(omega**2) * mp.mpf(J) for J in model.inertia]
        for value, w in zip(values, np.vstack([model.connection_weights, model.mass_weights]), strict=True):
            for i, j in ((i, j) for i in np.flatnonzero(w).tolist() for j in np.flatnonzero(w).tolist()):
                Z[i, j] += value * mp.mpf(w[i]) * mp.mpf(w[j])
        b[model.node] = 1
        return np.array([complex(x) for x in mp.lu_solve(Z, b)])


def write() -> None:
    """Half of the models with planetary sets, half of each without damping."""
    random, arrays = np.random.default_rng(1985), {field: [] for field in FIELDS}
    sizes, omega, node = [], [], []
    for index in range(COUNT):
        model = random_model(random, planetary=index % 4 >= 2, damped=index % 2 == 0)
        for field in FIELDS[:-1]:
            arrays[field].append(
                np.diag(model.mass_weights) if field == "mass_weights" else getattr(model, field).ravel()
            )
        arrays["response"].append(exact(model))
        sizes.append(model.connection_weights.shape)
        omega.append(model.omega)
        node.append(model.node)
    data = {field: np.concatenate(parts) for field, parts in arrays.items()}
    np.savez_compressed(FILE, sizes=np.array(sizes), omega=np.array(omega), node=np.array(node), **data)


def read() -> list[Reference]:
    """All models of the file."""
    with np.load(FILE) as file:
        data, found, at = dict(file), [], dict.fromkeys(FIELDS, 0)
    for (m, n), omega, node in zip(data["sizes"], data["omega"], data["node"], strict=True):
        parts = {}
        for field, size in zip(FIELDS, (m * n, n, m, m, m, n, n), strict=True):
            parts[field] = data[field][at[field] : at[field] + size]
            at[field] += size
        parts["connection_weights"] = parts["connection_weights"].reshape(m, n)
        parts["mass_weights"] = np.diag(parts["mass_weights"])
        found.append(Reference(**parts, omega=float(omega), node=int(node)))
    return found


if __name__ == "__main__":
    write()
