"""The region of sub-harmonic vibration over speed and mean torque: how strong it is, and where it begins."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.engine.orders import HIGHEST_ORDER
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.balance.equations import corrected_at
from torsional.results import dataset, of_model
from torsional.solvers.periodic.boundary import curve_variables, region_curves
from torsional.solvers.periodic.branches import MAIN, Branch, Explorer
from torsional.solvers.periodic.isolated import seek_doubled
from torsional.solvers.periodic.machine import EngineLoads
from torsional.solvers.periodic.problem import BoolArray, HarmonicProblem
from torsional.solvers.periodic.response import Exploration, explorer_of
from torsional.solvers.periodic.stability import MARGIN, branch_multipliers
from torsional.solvers.periodic.states import states
from torsional.solvers.periodic.verdict import verdict
from torsional.system import assemble

PROBES = 3
"""Points between two events at which the stability is worked out."""


@checked
def subharmonic_map(
    model: Model,
    speed: ArrayLike,
    torque: ArrayLike,
    gear: str | int | None = None,
    *,
    element: str = "",
    node: str = "",
    highest_order: float = HIGHEST_ORDER,
    boundary: bool = True,
    progress: Callable[[int, int], None] = lambda done, total: None,
) -> xr.Dataset:
    """Largest stable vibration at half the engine's order over mean ``torque`` [Nm] and ``speed`` [rad/s].

    Every branch at each mean torque is followed and read at the speeds.  (mean_torque, speed): ``amplitude`` [Nm] of
    the torque in ``element`` (default: the first connection with a law), ``twist_amplitude`` [rad] there and
    ``acceleration`` [rad/s²] at ``node`` (default: the landmark to be kept quiet), each 0-peak of the sub-harmonic
    order and zero where there is none; ``stable_solutions``, ``solutions`` how many there are.  ``boundary_speed``,
    ``boundary_mean_torque`` (boundary_point), with ``boundary_kind`` and ``boundary_curve``: curves of period
    doublings, and of folds of the doubled branches.  ``progress(done, total)`` is called after each mean torque.
    Raises ModelError as `model_response` does.
    """
    speeds, torques = (np.atleast_1d(np.asarray(v, dtype=float)) for v in (speed, torque))
    for name, values in (("speed", speeds), ("torque", torques)):
        if values.size < 2 or not (np.diff(values) > 0).all():
            raise ModelError("at least two rising values are wanted", where=name, found=str(values[:4]))
    system, span = assemble(model.powertrain(gear)), (float(speeds[0]), float(speeds[-1]))
    loads = EngineLoads(model, span, highest_order)
    asked = Exploration(hold=model.landmarks.load, highest_order=highest_order)
    first = explorer_of(system, loads.at(float(torques[-1])), span, asked)
    place = element or first.setting.split.names[0]
    quiet = node or model.landmarks.input or system.nodes[-1]
    table = _Table(speeds, torques, system.connections.names.index(place), system.node_index(quiet))
    edges: list[tuple[float, Explorer]] = []
    for row, value in enumerate(torques):
        explorer = Explorer(
            replace(first.setting, load=loads.at(float(value))), first.base_order, span, depth=1, stability=False
        )
        explorer.explored()
        seek_doubled(explorer)
        table.fill(row, explorer.branches)
        edges.append((float(value), explorer))
        progress(row + 1, len(torques))
    curves = region_curves(edges, loads.problem, span) if boundary else []
    data = table.presented(curves, place, quiet, 0.5 * first.base_order)
    return of_model(data, model, model.gear_name(gear))


class _Table:
    """The grid as it is filled, one torque after the other."""

    def __init__(self, speeds: Array, torques: Array, element: int, node: int) -> None:
        self.speeds, self.torques, self.element, self.node = speeds, torques, element, node
        shape = (torques.size, speeds.size)
        self.amplitude, self.twist, self.acceleration = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        self.solutions, self.stable = np.zeros(shape, dtype=int), np.zeros(shape, dtype=int)

    def fill(self, row: int, branches: list[Branch]) -> None:
        """Read every branch at the speeds of the grid."""
        for branch in branches:
            stable = _stable_stretches(branch)
            guesses, columns, stretch = read(branch, self.speeds)
            np.add.at(self.solutions[row], columns, 1)
            np.add.at(self.stable[row], columns, stable[stretch])
            kept = stable[stretch]
            if branch.kind != MAIN and kept.any():
                self._largest(row, branch.problem, guesses[kept], columns[kept])

    def _largest(self, row: int, problem: HarmonicProblem, guesses: Array, columns: IntArray) -> None:
        points, good = corrected_at(problem.balance, guesses)
        points, columns = points[good > 0], columns[good > 0]
        told = states(problem, points)
        omega = problem.base_order * self.speeds[columns]
        for target, values in (
            (self.amplitude, np.abs(told.torque[:, 1, self.element])),
            (self.twist, np.abs(told.twist[:, 1, self.element])),
            (self.acceleration, np.abs(told.angle[:, 1, self.node]) * omega**2),
        ):
            np.maximum.at(target[row], columns, values)

    def presented(self, curves: list[tuple[str, Array]], element: str, node: str, order: float) -> xr.Dataset:
        """The Dataset."""
        over = ("mean_torque", "speed")
        return dataset(
            {
                "amplitude": (over, self.amplitude, "torque"),
                "twist_amplitude": (over, self.twist, "relative_angle"),
                "acceleration": (over, self.acceleration, "acceleration"),
                "solutions": (over, self.solutions, ""),
                "stable_solutions": (over, self.stable, ""),
            }
            | curve_variables(curves, "mean_torque", "torque"),
            {"mean_torque": (self.torques, "torque"), "speed": (self.speeds, "speed")},
            analysis="subharmonic map",
            amplitude="0-peak of the sub-harmonic order",
            order=order,
            element=element,
            node=node,
        )


def read(branch: Branch, speeds: Array) -> tuple[Array, IntArray, IntArray]:
    """Where a branch passes the speeds: scaled guesses between its points, columns of speeds, numbers of stretches."""
    scaled, values = branch.scaled, speeds / branch.problem.scale[-1]
    start, end = scaled[:-1, -1], scaled[1:, -1]
    way = np.sign(end - start)[:, None]  # a stretch holds its start and not its end, whichever way it runs
    last = (np.arange(len(start)) == len(start) - 1)[:, None]
    behind, ahead = way * (values - start[:, None]), way * (end[:, None] - values)
    stretch, columns = np.nonzero((behind >= 0) & ((ahead > 0) | (last & (way != 0) & (ahead == 0))))
    share = ((values[columns] - start[stretch]) / (end[stretch] - start[stretch]))[:, None]
    guesses = scaled[stretch] + share * (scaled[stretch + 1] - scaled[stretch])
    guesses[:, -1] = values[columns]
    return guesses, columns, stretch


def _stable_stretches(branch: Branch) -> BoolArray:
    """Whether each stretch between two points is stable: told at a few points between two events, where it changes."""
    events = np.array([bool(point.event) for point in branch.points])
    edges = np.unique(np.concatenate([[0], np.flatnonzero(events), [len(events) - 1]]))
    stable = np.zeros(max(len(events) - 1, 1), dtype=bool)
    scaled = branch.scaled
    for start, end in pairwise(edges):
        inner = np.arange(start + 1, end) if end > start + 1 else np.array([start])
        probes = inner[np.unique(np.linspace(0, len(inner) - 1, PROBES).round().astype(int))]
        if end > start + 1:
            inside = verdict(branch.problem, [branch.points[i] for i in probes]).stable
        else:
            middle = 0.5 * (scaled[[start]] + scaled[[end]])
            inside = np.asarray((np.abs(branch_multipliers(branch.problem, middle)) <= 1 + MARGIN).all(axis=1))
        stable[start:end] = inside.mean() > 0.5  # beside an event a multiplier passes one a little early or late
    return stable
