"""Where the parts of a powertrain stand in a picture: its longest chain on one line, branches beside it."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from torsional.laws import Law
from torsional.powertrain import Powertrain
from torsional.stamps import GROUND, Constraint, Mass, Stamp
from torsional.units import show


@dataclass(frozen=True)
class Link:
    """What joins nodes: ``kind`` is spring, friction, damper, gear or planets; ``law`` where it is not linear."""

    name: str
    kind: str
    nodes: tuple[str, ...]
    stiffness: float = 0.0
    law: Law | None = None

    @property
    def described(self) -> str:
        """The label of its law, or its stiffness: 13 kNm/rad, 8 / 24 kNm/rad for stages; empty where it has none."""
        if self.law is not None and self.law.label:
            return self.law.label
        values = [self.stiffness]
        if self.law is not None and self.law.hinges() is not None:
            values = _stage_stiffnesses(self.law)
        if not any(values):
            return ""
        *first, last = [show(value, "stiffness") for value in values]
        return " / ".join([*(text.removesuffix(" kNm/rad") for text in first), last])


@dataclass(frozen=True)
class Chain:
    """Places of nodes (x, y), the links between them, and each node's inertia referred to engine speed [kgm²]."""

    places: Mapping[str, tuple[float, float]]
    links: tuple[Link, ...]
    inertia: Mapping[str, float]
    ratio: Mapping[str, float]


def _stage_stiffnesses(law: Law) -> list[float]:
    """Stiffnesses [Nm/rad] of the stages a spring goes through in drive, from zero to its stop, stop left out.

    >>> from torsional.laws import Hinges
    >>> _stage_stiffnesses(Hinges.staged([(1000.0, 8e3), (3500.0, 24e3)], stop_stiffness=1e6))
    [8000.0, 24000.0]
    """
    return [float(value) for value in law.tangent(np.array(stage_angles(law))) if value > 0]


def stage_angles(law: Law) -> list[float]:
    """An angle [rad] inside each stage in drive, from zero to the stop."""
    end = min((stop for stop in law.stops if stop > 0), default=np.inf)
    edges = [0.0, *(edge for edge in law.edges.tolist() if 0 < edge < end)]
    inside = [0.5 * (a + b) for a, b in pairwise(edges)]
    return [*inside, 0.5 * (edges[-1] + end) if np.isfinite(end) else edges[-1] + 0.1]


def chain(powertrain: Powertrain) -> Chain:
    """Places, links and referred inertias of a powertrain.

    >>> from torsional.components import Inertia, Shaft
    >>> line = {"a": Inertia(1.0), "b": Inertia(2.0), "s": Shaft("a", "b", 1e4)}
    >>> chain(Powertrain(line)).places
    {'a': (0.0, 0.0), 'b': (1.0, 0.0)}
    """
    links = tuple(link for stamp in powertrain.stamps if (link := _link(stamp)))
    ratio = dict(zip(powertrain.nodes, (float(r) for r in powertrain.structure.speed_ratio), strict=True))
    own = dict.fromkeys(powertrain.nodes, 0.0)
    for stamp in powertrain.stamps:
        if isinstance(stamp, Mass) and len(stamp.weights) == 1:
            ((node, weight),) = stamp.weights.items()
            own[node] += stamp.inertia * weight**2 * (ratio[node] or 1.0) ** 2
    places: dict[str, tuple[float, float]] = {}
    for part in powertrain.structure.parts:
        below = min((y for _, y in places.values()), default=6.0) - 6.0
        places |= {node: (x, y + below) for node, (x, y) in _placed(part, links).items()}
    return Chain(places, links, own, ratio)


def _link(stamp: Stamp) -> Link | None:
    nodes = tuple(node for node in stamp.weights if node != GROUND)
    if len(nodes) < 2:
        return None
    if isinstance(stamp, Constraint):
        return Link(stamp.name, "gear", nodes)
    if isinstance(stamp, Mass):
        return Link(stamp.name, "planets", nodes)
    if stamp.law is not None and not stamp.law.carries_mean_torque and stamp.stiffness == 0:
        return Link(stamp.name, "friction", nodes, law=stamp.law)
    elastic = stamp.stiffness > 0 or stamp.law is not None or stamp.centrifugal_stiffness > 0
    return Link(stamp.name, "spring" if elastic else "damper", nodes, stamp.stiffness, stamp.law)


def _placed(part: Sequence[str], links: Sequence[Link]) -> dict[str, tuple[float, float]]:
    """The longest way through one connected part on y = 0, the rest above it."""
    order = {node: i for i, node in enumerate(part)}
    near = neighbours(part, links)
    far = _ways(part[0], near)[0][-1]
    reached, before = _ways(far, near)
    path = [reached[-1]]
    while path[-1] in before:
        path.append(before[path[-1]])
    path = path if order[path[0]] <= order[path[-1]] else path[::-1]
    places = {node: (float(x), 0.0) for x, node in enumerate(path)}
    waiting = deque(path)
    while waiting:
        node = waiting.popleft()
        for child in (n for n in near[node] if n not in places):
            places[child] = _free(places, node)
            waiting.append(child)
    return places


def _free(places: Mapping[str, tuple[float, float]], parent: str) -> tuple[float, float]:
    """The nearest free place for a branch: beside a part that is on a branch itself, else above it."""
    x, y = places[parent]
    taken = set(places.values())
    tries = [(x + 1.0, y)] if y > 0 else []
    tries += [(x + shift, y + 4.6 * (level + 1)) for level in range(8) for shift in (0.0, 1.0, -1.0)]
    return next((place for place in tries if place not in taken), (x, y + 20.0 + len(taken)))


def neighbours(part: Sequence[str], links: Sequence[Link]) -> dict[str, list[str]]:
    """For every node of a part the nodes it is joined to."""
    near: dict[str, list[str]] = {node: [] for node in part}
    for link in links:
        for a in link.nodes:
            if a in near:
                near[a] += [b for b in link.nodes if b != a and b not in near[a]]
    return near


def _ways(start: str, near: Mapping[str, Sequence[str]]) -> tuple[list[str], dict[str, str]]:
    """Nodes by rising distance from a start, and the node before each."""
    reached, before = [start], {}
    for node in reached:
        for other in near[node]:
            if other != start and other not in before:
                before[other] = node
                reached.append(other)
    return reached, before
