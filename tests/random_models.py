"""Random powertrains for property tests: trees and loops of shafts and gears over many orders of magnitude.

A model is plain data, so that it can be frozen, solved elsewhere, permuted or turned into a `Powertrain`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from torsional.components import Component, GearPair, Inertia, Shaft
from torsional.powertrain import Powertrain


@dataclass(frozen=True)
class Network:
    """Discs J; shafts (a, b, k, c); gears (a, b, ratio): θ_a = ratio θ_b."""

    inertias: tuple[float, ...]
    shafts: tuple[tuple[int, int, float, float], ...]
    gears: tuple[tuple[int, int, float], ...]

    def components(self, order: tuple[int, ...] | None = None) -> dict[str, Component]:
        """Named components, discs listed in any order."""
        listed = order or tuple(range(len(self.inertias)))
        parts: dict[str, Component] = {f"n{i}": Inertia(self.inertias[i]) for i in listed}
        for s, (a, b, k, c) in enumerate(self.shafts):
            parts[f"s{s}"] = Shaft(f"n{a}", f"n{b}", k, c)
        for g, (a, b, ratio) in enumerate(self.gears):
            parts[f"g{g}"] = GearPair(f"n{a}", f"n{b}", ratio)
        return parts

    def powertrain(self, order: tuple[int, ...] | None = None) -> Powertrain:
        """The network as a powertrain."""
        return Powertrain(self.components(order))


def random_network(rng: np.random.Generator, nodes: int, *, damped: bool = True) -> Network:
    """A connected network: J 1e-4–1e4 kgm², k 10–1e9 Nm/rad, ratios 0.1–20, damping ratio of each shaft 0–0.5."""
    inertias = list(10 ** rng.uniform(-4, 4, nodes))
    shafts: list[tuple[int, int, float, float]] = []
    gears: list[tuple[int, int, float]] = []
    speed = [1.0] * nodes
    for i in range(1, nodes):
        parent = int(rng.integers(max(0, i - 4), i))
        if i > 1 and rng.random() < 0.25:
            ratio = float(10 ** rng.uniform(-1, np.log10(20)))
            gears.append((parent, i, ratio))
            speed[i] = speed[parent] / ratio
        else:
            shafts.append(_shaft(rng, inertias, parent, i, damped))
            speed[i] = speed[parent]
    for _ in range(int(rng.integers(0, 3))):
        _close_loop(rng, inertias, speed, shafts, gears, damped)
    if not shafts:
        inertias.append(1.0)
        shafts.append(_shaft(rng, inertias, 0, len(inertias) - 1, damped))
    return Network(tuple(inertias), tuple(shafts), tuple(gears))


def _shaft(
    rng: np.random.Generator, inertias: list[float], a: int, b: int, damped: bool
) -> tuple[int, int, float, float]:
    k = float(10 ** rng.uniform(1, 9))
    ratio = float(rng.uniform(0, 0.5)) if damped else 0.0
    return a, b, k, 2 * ratio * float(np.sqrt(k / (1 / inertias[a] + 1 / inertias[b])))


def _close_loop(
    rng: np.random.Generator,
    inertias: list[float],
    speed: list[float],
    shafts: list[tuple[int, int, float, float]],
    gears: list[tuple[int, int, float]],
    damped: bool,
) -> None:
    """A second path between two discs; a gear on a disc of its own brings it to the same mean speed."""
    a, b = (int(i) for i in rng.integers(0, len(inertias), 2))
    if a == b:
        return
    if speed[a] != speed[b]:
        inertias.append(float(10 ** rng.uniform(-4, 4)))
        speed.append(speed[a])
        gears.append((len(inertias) - 1, b, speed[a] / speed[b]))
        b = len(inertias) - 1
    shafts.append(_shaft(rng, inertias, a, b, damped))
