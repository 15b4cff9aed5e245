"""The structure of a set of stamps: connected parts, rigid conditions eliminated, mean speed of every node.

What cannot be a model is refused here by name: unknown or massless nodes, disconnected parts, contradictory gears.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.numerics.linear.null_space import CANCELLED, Elimination, Loop, eliminate, null_vectors, transformed
from torsional.stamps import GROUND, Connection, Constraint, Mass, Stamp


@dataclass(frozen=True)
class Structure:
    """θ = ``transform`` q: all ``nodes`` from the independent ``coordinates`` q, scaled so that rigid rotation is ones.

    ``speed_ratio``: mean speed of every node over that of the reference node; ``parts``: nodes of each connected
    part.
    """

    nodes: tuple[str, ...]
    coordinates: tuple[str, ...]
    transform: Array
    speed_ratio: Array
    parts: tuple[tuple[str, ...], ...]


def resolve(stamps: Sequence[Stamp], parts: int | None = None, reference: str = "") -> Structure:
    """Check the stamps and work out their structure; ``parts`` is the number of connected parts that is meant.

    ``reference`` is the node whose mean speed counts as one (default: the first node that turns).

    Raises ModelError, by name, for no masses, nodes without inertia, disconnected parts, contradictory gear loops.
    """
    nodes = _nodes(stamps)
    _known(stamps, nodes)
    found = _parts(stamps, nodes)
    if parts is not None and len(found) != parts:
        raise _disconnected(found, parts)
    solved, conditions = _condense(stamps, nodes)
    speed = _referred(_speed_ratio(stamps, nodes, found, solved, conditions), nodes, reference)
    scale = np.array([speed[i] or 1.0 for i in solved.independent])
    transform = solved.transform * scale
    _inertial(stamps, nodes, solved, transform)
    return Structure(nodes, tuple(nodes[i] for i in solved.independent), transform, speed, found)


def weight_rows(stamps: Iterable[Stamp], nodes: Sequence[str]) -> Array:
    """The weights of stamps as rows over all nodes; ground has no column."""
    index = {node: i for i, node in enumerate(nodes)}
    chosen = list(stamps)
    rows = np.zeros((len(chosen), len(index)))
    for row, stamp in zip(rows, chosen, strict=True):
        for node, weight in stamp.weights.items():
            if node != GROUND:
                row[index[node]] += weight
    return rows


def _nodes(stamps: Sequence[Stamp]) -> tuple[str, ...]:
    nodes = dict.fromkeys(node for stamp in stamps for node in stamp.weights if node != GROUND)
    if not any(isinstance(stamp, Mass) for stamp in stamps):
        raise ModelError("a powertrain needs at least one inertia", remedy="give every rotating body an inertia")
    return tuple(nodes)


def _known(stamps: Sequence[Stamp], nodes: Sequence[str]) -> None:
    """Every node must have an inertia or be tied to others by gears."""
    heavy = {node for stamp in stamps if not isinstance(stamp, Connection) for node in stamp.weights}
    for stamp in stamps:
        for node in stamp.weights:
            if node in heavy or node == GROUND:
                continue
            close = difflib.get_close_matches(node, sorted(heavy), n=1, cutoff=0.6)
            hint = f"did you mean '{close[0]}'? " if close else ""
            raise ModelError(
                f"node '{node}' has no inertia",
                where=stamp.name,
                remedy=f"{hint}give the node an inertia; known nodes: {', '.join(sorted(heavy)[:12])}",
            )


def _parts(stamps: Sequence[Stamp], nodes: Sequence[str]) -> tuple[tuple[str, ...], ...]:
    """Nodes that hang together by any stamp, in the order of the nodes."""
    label = {node: i for i, node in enumerate(nodes)}
    for stamp in stamps:
        tied = {label[node] for node in stamp.weights if node != GROUND}
        label = {node: min(tied) if old in tied else old for node, old in label.items()}
    kept = dict.fromkeys(label.values())
    return tuple(tuple(node for node in nodes if label[node] == number) for number in kept)


def _disconnected(found: Sequence[Sequence[str]], parts: int) -> ModelError:
    listed = "; ".join("{" + ", ".join(part[:6]) + (", …" if len(part) > 6 else "") + "}" for part in found[:5])
    return ModelError(
        "the nodes do not hang together",
        found=f"{len(found)} parts: {listed}",
        allowed=f"{parts} part" + ("s" if parts > 1 else ""),
        remedy="connect them, or say parts= when an open clutch is meant",
    )


def _condense(stamps: Sequence[Stamp], nodes: Sequence[str]) -> tuple[Elimination, list[Constraint]]:
    """Eliminate the rigid conditions; ground is the last column and stands still."""
    conditions = [stamp for stamp in stamps if isinstance(stamp, Constraint)]
    index = {**{node: i for i, node in enumerate(nodes)}, GROUND: len(nodes)}
    rows = [{index[node]: weight for node, weight in stamp.weights.items()} for stamp in conditions]
    solved = eliminate(rows, len(nodes) + 1, ground=len(nodes))
    if solved.locked:
        raise _locked(solved.locked[0], nodes, [stamp.name for stamp in conditions])
    if not solved.independent:
        raise ModelError("every node is held by the ground", remedy="leave at least one node free to turn")
    # the ground is no coordinate, and its row of the transform is zero
    return Elimination(solved.transform[:-1], solved.independent, solved.redundant, ()), conditions


def _locked(loop: Loop, nodes: Sequence[str], names: Sequence[str]) -> ModelError:
    listed = ", ".join(f"'{names[row]}'" for row in loop.rows)
    node = nodes[loop.node] if loop.node is not None else "?"
    return ModelError(
        f"the gears {listed} contradict one another: together they force '{node}' to stand still",
        where=names[loop.rows[-1]] if loop.rows else "",
        remedy="the ratios round a closed loop must multiply to 1",
    )


def _speed_ratio(
    stamps: Sequence[Stamp],
    nodes: Sequence[str],
    parts: Sequence[Sequence[str]],
    solved: Elimination,
    conditions: Sequence[Constraint],
) -> Array:
    """Mean speed of every node: the rigid rotation of each part, scaled to 1 at its first node that turns."""
    elastic = [stamp for stamp in stamps if isinstance(stamp, Connection) and not _damper(stamp)]
    for chosen in (elastic, [stamp for stamp in elastic if GROUND not in stamp.weights]):
        rows = transformed(weight_rows(chosen, nodes), solved.transform)
        modes = solved.transform @ null_vectors(rows) if rows.size else solved.transform
        speed = _rotation(modes)
        if speed.any():
            break
    held = {node for stamp in conditions if GROUND in stamp.weights for node in stamp.weights}
    holding: list[Connection | Constraint] = [*elastic, *conditions]
    if not any(GROUND in stamp.weights for stamp in holding):
        _turning(parts, nodes, speed, held)
    return speed


def _referred(speed: Array, nodes: Sequence[str], reference: str) -> Array:
    """Speeds over that of the reference node."""
    if not reference:
        return speed
    if reference not in nodes or speed[nodes.index(reference)] == 0:
        raise ModelError(f"the reference node '{reference}' does not turn", where="reference", found=reference)
    return np.asarray(speed / speed[nodes.index(reference)])


def _damper(stamp: Connection) -> bool:
    bends = stamp.law is not None and not stamp.whole_speed  # a brake or a road load holds nothing in its place
    return not bends and not stamp.stiffness and not stamp.centrifugal_stiffness


def _rotation(modes: Array) -> Array:
    """The sum of the rigid rotations, each scaled to 1 at the first node it moves."""
    speed = np.zeros(len(modes))
    for mode in modes.T:
        moved = np.flatnonzero(np.abs(mode) > CANCELLED * np.abs(mode).max())
        if moved.size and not speed[moved].any():
            speed += mode / mode[moved[0]]
    speed[np.abs(speed) <= CANCELLED * max(np.abs(speed).max(), 1.0)] = 0.0
    return speed


def _turning(parts: Sequence[Sequence[str]], nodes: Sequence[str], speed: Array, held: set[str]) -> None:
    still = {node for node, ratio in zip(nodes, speed, strict=True) if ratio == 0}
    for part in parts:
        if set(part) <= still and not set(part) & held:
            raise ModelError(
                "the gear ratios contradict one another: these nodes cannot turn together",
                found=", ".join(part[:12]),
                remedy="the ratios round every closed loop, shafts included, must multiply to 1",
            )


def _inertial(stamps: Sequence[Stamp], nodes: Sequence[str], solved: Elimination, transform: Array) -> None:
    """Every direction of motion must have inertia."""
    masses = [stamp for stamp in stamps if isinstance(stamp, Mass)]
    rows = transformed(weight_rows(masses, nodes), transform)
    free = null_vectors(rows[[bool(mass.inertia or mass.switch) for mass in masses]])
    if free.shape[1]:
        node = nodes[solved.independent[int(np.argmax(np.abs(free[:, 0])))]]
        raise ModelError(
            f"node '{node}' has no inertia",
            where=node,
            remedy="give it an inertia, or leave the node out and join its neighbours directly",
        )
