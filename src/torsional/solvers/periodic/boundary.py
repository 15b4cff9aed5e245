"""Boundaries of regions of sub-harmonic vibration over speed and a second quantity."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.engine.orders import HIGHEST_ORDER
from torsional.errors import ModelError
from torsional.files import changed
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.numerics.continuation.following import FOLD, Point
from torsional.results import Variable, dataset, of_model
from torsional.solvers.periodic.branches import MAIN, Explorer
from torsional.solvers.periodic.curves import DOUBLING, bifurcation_curve
from torsional.solvers.periodic.equations import Split
from torsional.solvers.periodic.machine import EngineLoads
from torsional.solvers.periodic.problem import HarmonicProblem
from torsional.solvers.periodic.response import Exploration, explorer_of
from torsional.system import assemble

Family = Callable[[HarmonicProblem, float], HarmonicProblem]
"""The problem over speed for a value of the second quantity, of the base order and scales of another problem."""

TORQUE = "torque"
SAME = 5e-3
"""Distance, in shares of the ranges, within which a bifurcation is taken for one of a curve that is known."""


@checked
def subharmonic_boundary(
    model: Model,
    speed: tuple[float, float],
    span: tuple[float, float],
    along: str = TORQUE,
    *,
    torque: float | None = None,
    gear: str | int | None = None,
    places: int = 7,
    highest_order: float = HIGHEST_ORDER,
) -> xr.Dataset:
    """Where vibration at half the engine's order begins and ends over ``speed`` [rad/s] and a second quantity.

    ``along`` is "torque" [Nm], or a path of the model file such as ``absorber.stages.1.stiffness`` at one mean
    ``torque`` [Nm]; ``span`` its range in SI units, at ``places`` of which branches are followed to find the curves.
    Dimension ``boundary_point``: ``boundary_speed``, ``boundary_value``, ``boundary_kind`` (period doubling of the main
    branch, fold of a doubled one) and ``boundary_curve``.  Raises ModelError as `model_response` does.

    g(x, p; r) = 0 beside R(x, p; r) = 0, g of the bordered singular matrix (Govaerts, Numerical Methods for
    Bifurcations of Dynamical Equilibria, SIAM 2000, doi 10.1137/1.9780898719543).
    """
    if along != TORQUE and torque is None:
        raise ModelError("the mean torque is missing", where=TORQUE, remedy="give the one at which the value is varied")
    loads = EngineLoads(model, speed, highest_order)
    asked = Exploration(hold=model.landmarks.load, highest_order=highest_order)
    first = explorer_of(assemble(model.powertrain(gear)), loads.at(span[1] if torque is None else torque), speed, asked)
    family = loads.problem if along == TORQUE else _varied(model, along, gear)
    edges: list[tuple[float, Explorer]] = []
    for value in np.linspace(*span, places):
        setting = family(first.problem(first.base_order), float(value)).setting
        explorer = Explorer(setting, first.base_order, speed, depth=1, stability=False)
        explorer.explored()
        edges.append((float(value), explorer))
    quantity = "torque" if along == TORQUE else ""
    found = dataset(
        curve_variables(region_curves(edges, family, speed), "value", quantity),
        {},
        analysis="subharmonic boundary",
        along=along,
        order=0.5 * first.base_order,
    )
    return of_model(found, model, model.gear_name(gear))


def _varied(model: Model, path: str, gear: str | int | None) -> Family:
    problems: dict[tuple[float, float], HarmonicProblem] = {}

    def family(like: HarmonicProblem, value: float) -> HarmonicProblem:
        key = like.base_order, value
        if key not in problems:
            split = like.setting.split
            system = assemble(changed(model, {path: value}).powertrain(gear))
            setting = replace(like.setting, split=Split(system, split.speed, split))
            problems[key] = HarmonicProblem(setting, like.base_order)
        return problems[key]

    return family


def curve_variables(curves: Sequence[tuple[str, Array]], second: str, quantity: str) -> dict[str, Variable]:
    """Curves (points, 2) of speed and a second quantity as variables of a Dataset."""
    along = ("boundary_point",)
    points = np.concatenate([curve for _, curve in curves]) if curves else np.zeros((0, 2))
    sizes = [len(curve) for _, curve in curves]
    return {
        "boundary_speed": (along, points[:, 0], "speed"),
        f"boundary_{second}": (along, points[:, 1], quantity),
        "boundary_kind": (along, np.repeat([kind for kind, _ in curves], sizes).astype(str), ""),
        "boundary_curve": (along, np.repeat(np.arange(len(curves)), sizes), ""),
    }


def region_curves(
    edges: Sequence[tuple[float, Explorer]], family: Family, span: tuple[float, float]
) -> list[tuple[str, Array]]:
    """Curves (speed, second quantity), each once: period doublings of main branches, folds of the doubled ones.

    ``edges``: explored branches at rising values of the second quantity.
    """
    curves: list[tuple[str, Array]] = []
    seconds = (edges[0][0], edges[-1][0])
    for value, explorer in edges:
        for branch in explorer.branches:
            for event in branch.events:
                wanted = event.event == (DOUBLING if branch.kind == MAIN else FOLD)
                if wanted and not _on(curves, event, value, span, seconds):
                    curves.append((event.event, _curve(branch.problem, family, event, value, span, seconds)))
    return [(kind, curve) for kind, curve in curves if len(curve) > 1]


def _curve(
    problem: HarmonicProblem,
    family: Family,
    event: Point,
    value: float,
    span: tuple[float, float],
    seconds: tuple[float, float],
) -> Array:
    trace = bifurcation_curve(lambda second: family(problem, second), event, value, span, seconds)
    rows = [[point.z[-2] * problem.scale[-1], point.parameter] for point in trace.points]
    return np.array(rows).reshape(-1, 2)


def _on(
    curves: Sequence[tuple[str, Array]],
    event: Point,
    value: float,
    span: tuple[float, float],
    seconds: tuple[float, float],
) -> bool:
    """Whether an event lies on a curve that is known already."""
    size = np.array([span[1] - span[0], seconds[1] - seconds[0]])
    at = np.array([event.parameter, value]) / size
    for kind, curve in curves:
        if kind != event.event or len(curve) < 2:
            continue
        start, step = curve[:-1] / size, np.diff(curve / size, axis=0)
        length = np.maximum((step**2).sum(axis=1), 1e-30)
        share = np.clip(((at - start) * step).sum(axis=1) / length, 0, 1)
        if np.linalg.norm(start + share[:, None] * step - at, axis=1).min() < SAME:
            return True
    return False
