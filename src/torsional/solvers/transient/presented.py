"""A run in time as a Dataset."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from torsional.errors import ModelError, nearest
from torsional.laws import Law
from torsional.numerics.arrays import Array, IntArray
from torsional.results import Variable, dataset
from torsional.solvers.transient.marching import LEDGER, Marched, method_share
from torsional.solvers.transient.problem import Problem
from torsional.solvers.transient.starts import MotionState

Coordinates = dict[str, tuple[object, str] | tuple[object, str, str]]

FRAME = "speed of the frame that deviations count from"
"""What `speed` is in time: the mean speed of an engine only where its own does not change."""


def presented(problem: Problem, told: Marched, keep: Sequence[str], **settings: object) -> xr.Dataset:
    """Angles, speeds and accelerations of nodes, twists and torques of elements, the ledger of energy, and the last
    state, from which a run can go on; ``keep`` names nodes and elements, all where it is empty."""
    system = problem.system
    nodes, elements = kept(keep, system.nodes, system.connections.names)
    frame = problem.speed.at(told.time)
    coordinates: Coordinates = {
        "time": (told.time, "time"),
        "node": (np.array(system.nodes)[nodes], ""),
        "element": (np.array(system.connections.names)[elements], ""),
        "share": (np.array(LEDGER), ""),
        "speed": (frame, "speed", "time"),
        "crank_angle": (problem.speed.angle(told.time), "crank_angle", "time"),
        "speed_ratio": (system.speed_ratio[nodes], "gear_ratio", "node"),
    }
    rubbing, named = _friction(problem, told, elements)
    found = dataset(
        _motion(problem, told, frame, nodes, elements) | rubbing | ending(told.end),
        coordinates | named,
        analysis="transient",
        amplitude="signal",
        steps=told.steps,
        iterations=told.iterations,
        status=told.status,
        method_share=method_share(told.end.standing),
        end_time=told.end.time,
        end_reference=float("nan") if told.end.reference is None else told.end.reference,
        system_hash=problem.line_hash,
        **settings,
    )
    found.speed.attrs["long_name"] = FRAME
    return found


def _motion(problem: Problem, told: Marched, frame: Array, nodes: IntArray, elements: IntArray) -> dict[str, Variable]:
    """What nodes and elements do, and the ledger."""
    system = problem.system
    rows = system.T[nodes].T
    turning = told.speed @ rows + np.multiply.outer(frame, system.speed_ratio[nodes])
    return {
        "angle": (("time", "node"), told.angle @ rows, "angle"),
        "angular_velocity": (("time", "node"), turning, "angular_velocity"),
        "acceleration": (("time", "node"), told.acceleration @ rows, "acceleration"),
        "twist": (("time", "element"), told.angle @ system.connections.weights[elements].T, "relative_angle"),
        "torque": (("time", "element"), told.torque[:, elements], "torque"),
        "energy": (("time", "share"), told.energy, "energy"),
    }


def _friction(problem: Problem, told: Marched, elements: IntArray) -> tuple[dict[str, Variable], Coordinates]:
    """Memories and normal loads of the elements that have them, and what each part that rubs has lost."""
    c = problem.system.connections
    names = np.array(c.names)
    remembering = np.array([i for i in elements if (law := c.laws[i]) is not None and law.remembers], dtype=np.int64)
    loaded = np.array([i for i in elements if c.loads[i] is not None], dtype=np.int64)
    variables: dict[str, Variable] = {}
    coordinates: Coordinates = {}
    if remembering.size:
        variables["memory"] = (("time", "friction"), told.memory[:, remembering], "relative_angle")
        coordinates["friction"] = (names[remembering], "")
    if loaded.size:
        variables["normal_load"] = (("time", "loaded"), told.load[:, loaded], "force")
        coordinates["loaded"] = (names[loaded], "")
    rubs = np.array([i for i in elements if _rubs(c.laws[i])], dtype=np.int64)
    if rubs.size:
        variables["friction_loss"] = (("time", "rubbing"), told.lost[:, rubs], "energy")
        coordinates["rubbing"] = (names[rubs], "")
    return variables, coordinates


def _rubs(law: Law | None) -> bool:
    return law is not None and (law.remembers or not law.carries_mean_torque)


def ending(end: MotionState) -> dict[str, Variable]:
    """The last state, from which another run can go on."""
    charge = {} if end.charge is None or not len(end.charge) else {"end_charge": (("charge",), end.charge, "")}
    return {
        "end_angle": (("coordinate",), end.angle, "angle"),
        "end_speed": (("coordinate",), end.speed, "angular_velocity"),
        "end_memory": (("connection",), end.memory, "relative_angle"),
        "end_integral": (("governor",), end.integral, ""),
        **charge,
    }


def kept(keep: Sequence[str], nodes: Sequence[str], elements: Sequence[str]) -> tuple[IntArray, IntArray]:
    """Places of the nodes and elements that are named, all of them without a name; raises ModelError for others."""
    if not keep:
        return np.arange(len(nodes)), np.arange(len(elements))
    for name in keep:
        if name not in nodes and name not in elements:
            remedy = nearest(name, [*nodes, *elements])
            raise ModelError(f"there is no node or element '{name}'", where="keep", remedy=remedy)
    places = ([names.index(name) for name in keep if name in names] for names in (list(nodes), list(elements)))
    first, second = (np.array(found, dtype=np.int64) for found in places)
    return first, second


def joined(parts: Sequence[Array]) -> Array:
    """Pieces of a record one after the other, the first moment of each left out but for the first piece."""
    return np.concatenate([parts[0], *(part[1:] for part in parts[1:])])
