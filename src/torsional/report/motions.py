"""Periodic motions of a variant whose springs have stages: where it vibrates at half its engine's order, and how."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.laws import Law
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities.branches import coexisting, solutions_at
from torsional.report.finding import Finding
from torsional.report.labels import told
from torsional.solvers.periodic import model_response
from torsional.studies.subharmonic import sought_region, within
from torsional.system import assemble

SPEEDS, TORQUES, BETWEEN = 57, 21, 161
"""Speeds and mean torques of the region, and speeds at which branches have points."""


@dataclass(frozen=True, eq=False)
class Motions:
    """Motions of one variant in one ``gear``: the ``region`` of sub-harmonic vibration and the branches at full load.

    ``branches`` are those at the mean torque of the region's largest amplitude, ``at`` its speed [rad/s] and torque
    [Nm] with ``largest`` [Nm] and ``acceleration`` [rad/s²] there; None where no such vibration is within full load.
    """

    gear: str
    element: str
    law: Law
    stiffness: float
    node: str
    order: float
    region: xr.Dataset
    full_load: xr.Dataset
    branches: xr.Dataset | None = None
    at: dict[str, float] | None = None

    @property
    def solutions(self) -> xr.Dataset | None:
        """The motions where the sub-harmonic one is largest."""
        return None if self.branches is None or self.at is None else solutions_at(self.branches, self.at["speed"])


def motions_of(model: Model, speeds: tuple[float, float]) -> Motions | None:
    """The periodic motions of a model over ``speeds`` [rad/s] in its last gear; None where no spring has stages.

    Raises ModelError where they cannot be found.
    """
    gear = model.top_gear
    c = assemble(model.powertrain(gear)).connections
    staged = {name: law for name, law in zip(c.names, c.laws, strict=True) if has_stages(law)}
    if model.engine is None or not staged:
        return None
    element = next((name for name in model.landmarks.springs if name in staged), next(iter(staged)))
    low, high = speeds
    region = sought_region(model, np.linspace(low, high, SPEEDS), model.torques(TORQUES), gear, element=element)
    full = model_response(model, speeds, None, gear, at=np.linspace(low, high, BETWEEN))
    law, stiffness = staged[element], float(c.stiffness[c.names.index(element)])
    assert law is not None
    shown = {"gear": gear, "element": element, "law": law, "stiffness": stiffness, "node": str(region.attrs["node"])}
    found: Any = {**shown, "order": float(region.attrs["order"]), "region": region, "full_load": full}
    at = _largest(region)
    if at is None:
        return Motions(**found)
    values = np.append(np.linspace(low, high, BETWEEN), at["speed"])
    return Motions(**found, branches=model_response(model, speeds, at["mean_torque"], gear, at=values), at=at)


def has_stages(law: Law | None) -> bool:
    """Whether a law bends elsewhere than at its stops."""
    return law is not None and law.straight is not None and bool(law.transitions)


def _largest(region: xr.Dataset) -> dict[str, float] | None:
    """Where within full load the sub-harmonic amplitude is largest; None where there is none."""
    inside = within(region)
    size: Array = inside.amplitude.transpose("mean_torque", "speed").values
    if not (size > 0).any():
        return None
    row, column = np.unravel_index(int(size.argmax()), size.shape)
    here = {"amplitude": float(size[row, column]), "acceleration": float(inside.acceleration.max())}
    return {**here, "speed": float(inside.speed[column]), "mean_torque": float(inside.mean_torque[row])}


def motion_findings(motions: Motions) -> list[Finding]:
    """What the periodic motions come to, in sentences."""
    gear = f" in gear {motions.gear}" if motions.gear else ""
    return [_sub_harmonic(motions, gear), *_jumps(motions, gear)]


def _sub_harmonic(motions: Motions, gear: str) -> Finding:
    order, at = f"order {motions.order:g}", motions.at
    if at is None:
        text = f"No stable vibration of {order}, half the main order, was found within full load{gear}."
        return Finding("sub-harmonic", text, {"amplitude": 0.0})
    size = within(motions.region).amplitude.transpose("mean_torque", "speed").values > 0
    speeds = motions.region.speed.values[size.any(axis=0)][[0, -1]]
    torques = motions.region.mean_torque.values[size.any(axis=1)][[0, -1]]
    text = (
        f"At mean torques of {told(torques[0], 'torque')} to {told(torques[1], 'torque')} and speeds of "
        f"{told(speeds[0], 'speed')} to {told(speeds[1], 'speed')} it vibrates{gear} at {order}, every second ignition "
        f"alike: up to {told(at['amplitude'], 'torque')} (0-peak) in {motions.element.replace('_', ' ')}, at "
        f"{told(at['speed'], 'speed')} and {told(at['mean_torque'], 'torque')}, and up to "
        f"{told(at['acceleration'], 'acceleration')} at {motions.node.replace('_', ' ')}. No linear analysis shows it."
    )
    ends = {"speed from": speeds[0], "speed to": speeds[1], "torque from": torques[0], "torque to": torques[1]}
    return Finding("sub-harmonic", text, {**at, **{name: float(value) for name, value in ends.items()}})


def _jumps(motions: Motions, gear: str) -> list[Finding]:
    """Ranges at full load in which the way one came decides."""
    ranges = coexisting(motions.full_load)
    if not ranges:
        return []
    spans = [f"{told(low, 'speed', 4)} to {told(high, 'speed', 4)}" for (low, high), _ in ranges]
    text = f"At full load{gear} more than one motion is stable at speeds of {' and of '.join(spans)}: amplitudes jump "
    text += "there, at other speeds on the way up than on the way down."
    return [Finding("jumps", text, {"ranges": float(len(ranges))})]


def sought(model: Model, speeds: tuple[float, float]) -> tuple[Motions | None, str]:
    """The motions of a model, or why there are none to tell."""
    try:
        return motions_of(model, speeds), ""
    except ModelError as error:  # a report tells what it can
        return None, f"Its periodic motions are not told: {error}."
