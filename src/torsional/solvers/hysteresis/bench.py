"""An absorber alone on a bench: what acts between two nodes, one of them turned against the other."""

from __future__ import annotations

import dataclasses
from typing import NamedTuple

import numpy as np

from torsional.errors import ModelError
from torsional.numerics.arrays import Array, IntArray
from torsional.solvers.hysteresis.parts import grouped
from torsional.system import BoolArray, Connections, System

NOTHING = 1e-9


class Bench(NamedTuple):
    """An absorber alone: ``system`` over the free coordinates and, last, the angle that is turned.

    ``nodes`` of which angles are told: ``places`` (nodes, coordinates) are their rows.
    """

    system: System
    nodes: tuple[str, ...]
    places: Array


def on_bench(system: System, turned: str, held: str) -> Bench:
    """What acts between two nodes, over the coordinates that are free while the one is turned and the other held."""
    ends = system.T[[system.node_index(turned), system.node_index(held)]]
    _refuse_ends(system, ends, (turned, held))
    c = system.connections
    pinned, rest = _pinned(ends)
    solved: Array = np.linalg.solve(ends[:, pinned], np.column_stack([-ends[:, rest], [1.0, 0.0]]))
    by_rest, by_drive = solved[:, :-1], solved[:, -1]
    free, drive = _reduced(c.weights, pinned, rest, by_rest, by_drive)
    relevant, kept = _relevant(free, drive, np.abs(c.weights.sum(axis=1)) < NOTHING)
    if not relevant.any():
        remedy = "name two nodes with springs between them"
        raise ModelError(f"nothing acts between '{turned}' and '{held}'", where="hysteresis", remedy=remedy)
    rows = np.column_stack([np.where(relevant[:, None], free[:, kept], 0.0), np.where(relevant, drive, 0.0)])
    nodes, node_drive = _reduced(system.T, pinned, rest, by_rest, by_drive)
    outside = np.delete(nodes, kept, axis=1)
    inside: BoolArray = np.all(np.abs(outside) < NOTHING, axis=1)
    places = np.column_stack([nodes[:, kept], node_drive])[inside]
    names = tuple(name for name, own in zip(system.nodes, inside, strict=True) if own)
    return Bench(dataclasses.replace(system, connections=_restricted(c, rows, relevant)), names, places)


def _refuse_ends(system: System, ends: Array, names: tuple[str, str]) -> None:
    if names[0] == names[1] or np.abs(ends[0] - ends[1]).max() < NOTHING:
        problem = f"'{names[0]}' and '{names[1]}' turn as one: there is no absorber spring to measure"
        raise ModelError(problem, where="hysteresis", remedy="name two nodes with springs between them")
    ratio = [float(system.speed_ratio[system.node_index(name)]) for name in names]
    if abs(ratio[0] - ratio[1]) > NOTHING * abs(ratio[0]):
        found = f"{names[0]} at {ratio[0]:g}, {names[1]} at {ratio[1]:g} times the engine's speed"
        raise ModelError("the two nodes turn at different mean speeds", where="hysteresis", found=found)


def _pinned(ends: Array) -> tuple[IntArray, IntArray]:
    """Two coordinates that the two ends settle, best conditioned, and the others."""
    first = int(np.abs(ends[1]).argmax())
    left = ends[0] - ends[1] * (ends[0, first] / ends[1, first])
    left[first] = 0.0
    pair = np.array([first, int(np.abs(left).argmax())])
    return pair, np.setdiff1d(np.arange(ends.shape[1]), pair)


def _reduced(rows: Array, pinned: IntArray, rest: IntArray, by_rest: Array, by_drive: Array) -> tuple[Array, Array]:
    """Rows over the coordinates left and over the turned angle, rounding taken away."""
    free, drive = rows[:, rest] + rows[:, pinned] @ by_rest, rows[:, pinned] @ by_drive
    scale = np.abs(rows).max(axis=1, initial=0.0)
    free = np.where(np.abs(free) < NOTHING * scale[:, None], 0.0, free)
    return free, np.where(np.abs(drive) < NOTHING * scale, 0.0, drive)


def _relevant(free: Array, drive: Array, rotates: BoolArray) -> tuple[BoolArray, IntArray]:
    """Connections that take part, and the free coordinates that they move.

    Coordinates hang together through connections.  A group that stays at rest while the held end does, or goes with
    the turned end as one, takes no part.
    """
    group = grouped(free[rotates])
    relevant = np.zeros(len(drive), dtype=bool)
    kept: list[int] = []
    for label in np.unique(group):
        own = np.flatnonzero(group == label)
        rows = rotates & (free[:, own] != 0).any(axis=1)
        still = (np.abs(drive[rows]) < NOTHING).all()
        along = (np.abs(drive[rows] + free[rows].sum(axis=1)) < NOTHING).all()
        if not (still or along):
            relevant |= rows
            kept += own.tolist()
    direct = rotates & (free == 0).all(axis=1) & (drive != 0)
    return relevant | direct, np.array(sorted(kept), dtype=np.int64)


def _restricted(c: Connections, rows: Array, relevant: BoolArray) -> Connections:
    """The connections that take part, and those whose torque presses on one of them.

    A pendulum hangs on its centrifugal spring: a slow turn moves no mass.
    """
    pressing = {name for own, load in zip(relevant, c.loads, strict=True) if own and load for name in load.share_of}
    chosen = np.flatnonzero([own or name in pressing for own, name in zip(relevant, c.names, strict=True)])
    return dataclasses.replace(c.picked(chosen, rows[chosen]), swings=())
