"""Branches as a Dataset."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr

from torsional.numerics.arrays import Array, ComplexArray
from torsional.results import Variable, dataset
from torsional.solvers.periodic.branches import NOT_BIFURCATIONS, Branch, Explorer
from torsional.solvers.periodic.problem import BoolArray
from torsional.solvers.periodic.states import states

QUANTITIES = {"speed": "speed", "mean_torque": "torque"}


def presented(explorer: Explorer, parameter: str, unit: str, stability: bool) -> xr.Dataset:
    """All branches point by point, with tables of the branches and of their bifurcations."""
    branches = explorer.branches
    orders = _orders(branches, explorer.setting.highest_order)
    found = [states(branch.problem, branch.scaled) for branch in branches]
    system = explorer.setting.split.system
    over = ("point", "order")
    variables: dict[str, Variable] = {
        "angle": ((*over, "node"), _laid(branches, [s.angle for s in found], orders), "angle"),
        "twist": ((*over, "element"), _laid(branches, [s.twist for s in found], orders), "relative_angle"),
        "torque": ((*over, "element"), _laid(branches, [s.torque for s in found], orders), "torque"),
        "residual": (("point",), np.concatenate([[p.residual for p in b.points] for b in branches]), ""),
        "iterations": (("point",), np.concatenate([[p.iterations for p in b.points] for b in branches]), ""),
        "event": (("point",), np.concatenate([_events(branch) for branch in branches]), ""),
    }
    if stability:
        variables |= _stability(branches)
    value = np.concatenate([branch.values for branch in branches])
    speed = value if explorer.setting.speed is None else np.full(len(value), explorer.setting.speed)
    return dataset(
        variables | _tables(branches) | _bifurcations(explorer, branches),
        {
            "order": (orders, "engine_order"),
            "node": (np.array(system.nodes), ""),
            "element": (np.array(system.connections.names), ""),
            "speed_ratio": (system.speed_ratio, "gear_ratio", "node"),
            "speed": (speed, "speed", "point"),
            "mean_torque": (_mean_torques(explorer, value), "torque", "point"),
            "value": (value, QUANTITIES.get(parameter, ""), "point"),
            "branch": (np.repeat(np.arange(len(branches)), [len(b.points) for b in branches]), "", "point"),
        },
        analysis="periodic response",
        amplitude="complex 0-peak; order 0 is the mean",
        parameter=parameter,
        parameter_unit=unit or _data_unit(parameter),
        main_order=explorer.base_order,
        highest_order=explorer.setting.highest_order,
        laws=list(explorer.setting.split.names),
        not_followed=explorer.lost,
        system_hash=system.hash,
    )


def _data_unit(parameter: str) -> str:
    """Unit of a parameter that has a name of its own."""
    return {"speed": "rad/s", "mean_torque": "Nm"}.get(parameter, "")


def _orders(branches: list[Branch], highest: float) -> Array:
    """All orders up to the highest that some branch has harmonics of."""
    coarsest = max(branch.base_order for branch in branches)
    parts = math.lcm(*(round(coarsest / branch.base_order) for branch in branches))
    return np.asarray(coarsest * np.arange(int(parts * highest / coarsest + 1e-9) + 1) / parts)


def _laid(branches: list[Branch], parts: list[ComplexArray], orders: Array) -> ComplexArray:
    """Harmonics of every branch at their places among all orders; the rest is exactly zero."""
    total = sum(len(part) for part in parts)
    out = np.zeros((total, len(orders), parts[0].shape[-1]), dtype=complex)
    start = 0
    for branch, part in zip(branches, parts, strict=True):
        step = round(branch.base_order / (orders[1] - orders[0]))
        out[start : start + len(part), 0 : step * part.shape[1] : step] = part
        start += len(part)
    return out


def _mean_torques(explorer: Explorer, value: Array) -> Array:
    load = explorer.setting.load
    mean = load.orders == 0
    return np.asarray(load.at(value)[..., mean].real.sum(axis=(-2, -1)))


def _stability(branches: list[Branch]) -> dict[str, Variable]:
    values = np.concatenate([branch.verdict.multipliers for branch in branches])
    return {
        "multiplier": (("point", "multiplier"), values, ""),
        "stable": (("point",), np.concatenate([_stable(branch) for branch in branches]), ""),
        "confirmed": (("point",), np.concatenate([branch.verdict.confirmed for branch in branches]), ""),
    }


def _events(branch: Branch) -> list[str]:
    """What each point is: a bifurcation, an end on another branch, or nothing particular."""
    own = {id(point) for point in branch.events}
    return [p.event if id(p) in own or p.event in NOT_BIFURCATIONS else "" for p in branch.points]


def _stable(branch: Branch) -> BoolArray:
    """Whether each point is stable; one where a multiplier is on the unit circle goes with a stable neighbour."""
    inside = branch.verdict.stable
    beside = np.append(inside[1:], False) | np.append(False, inside[:-1])
    return np.asarray(np.where([bool(point.event) for point in branch.points], beside | inside, inside))


def _tables(branches: list[Branch]) -> dict[str, Variable]:
    rows = ("branches",)
    return {
        "kind": (rows, np.array([b.kind for b in branches]), ""),
        "base_order": (rows, np.array([b.base_order for b in branches]), "engine_order"),
        "parent": (rows, np.array([b.parent[0] for b in branches]), ""),
        "started": (rows, np.array([b.started for b in branches]), ""),
        "ended": (rows, np.array([b.ended for b in branches]), ""),
    }


def _bifurcations(explorer: Explorer, branches: list[Branch]) -> dict[str, Variable]:
    rows = [(number, point) for number, branch in enumerate(branches) for point in branch.events]
    value = np.array([point.parameter for _, point in rows])
    speed = value if explorer.setting.speed is None else np.full(len(value), explorer.setting.speed)
    dim = ("bifurcation",)
    return {
        "bifurcation_type": (dim, np.array([point.event for _, point in rows], dtype=str), ""),
        "bifurcation_speed": (dim, speed, "speed"),
        "bifurcation_mean_torque": (dim, _mean_torques(explorer, value), "torque"),
        "bifurcation_value": (dim, value, ""),
        "on_branch": (dim, np.array([number for number, _ in rows], dtype=int), ""),
    }
