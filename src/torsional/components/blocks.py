"""The usual groups of a vehicle's powertrain: crankshaft, clutch, gearbox, driveline; functions that return parts.

In every spring ``b`` is the engine's side, so that twists and mean torques are positive while the engine drives.
Every group names its nodes in the way of the model file's blocks, so that results carry the same names everywhere.
"""

from __future__ import annotations

from collections.abc import Sequence

from torsional.components.base import Component
from torsional.components.coupling import Coupling
from torsional.components.gears import GearPair
from torsional.components.inertia import Inertia, Vehicle
from torsional.components.shaft import Damper, Shaft, Tyre
from torsional.errors import ModelError
from torsional.laws import Law

Parts = dict[str, Component]


def each(values: float | Sequence[float], count: int, field: str) -> list[float]:
    """One value for each of ``count`` places, from a single number or a list of that length."""
    listed = [float(values)] * count if isinstance(values, (int, float)) else [float(v) for v in values]
    if len(listed) != count:
        allowed = f"one number, or a list of {count}"
        raise ModelError("the list has the wrong length", where=field, found=f"{len(listed)} values", allowed=allowed)
    return listed


def crankshaft(
    throws: int,
    throw_inertia: float | Sequence[float],
    stiffness: float | Sequence[float],
    *,
    flange: str,
    flange_stiffness: float,
    damping: float | Sequence[float] = 0.0,
    flange_damping: float = 0.0,
    absolute_damping: float | Sequence[float] = 0.0,
    before: str = "",
    before_stiffness: float = 0.0,
) -> Parts:
    """Throws ``throw1`` … joined by ``crank1`` …, the last shaft going to the node ``flange``.

    ``throw_inertia`` [kgm²] with half the reciprocating share; ``stiffness`` between throws [Nm/rad], relative
    ``damping`` [Nms/rad], ``absolute_damping`` of each throw [Nms/rad]; ``before``: the node at the free end (the hub
    of a torsional damper) on a shaft of ``before_stiffness``.

    >>> sorted(crankshaft(2, 0.1, 1e6, flange="flywheel", flange_stiffness=2e6))
    ['crank1', 'crank2', 'throw1', 'throw2']
    """
    parts: Parts = {}
    names = [f"throw{i + 1}" for i in range(throws)]
    relative = each(damping, throws - 1, "crankshaft.damping") if throws > 1 else []
    between = each(stiffness, throws - 1, "crankshaft.stiffness") if throws > 1 else []
    if before:
        parts["crank_front"] = Shaft(names[0], before, before_stiffness, relative[0] if relative else 0.0)
    for name, inertia in zip(names, each(throw_inertia, throws, "crankshaft.throw_inertia"), strict=True):
        parts[name] = Inertia(inertia)
    for i, (k, c) in enumerate(zip(between, relative, strict=True)):
        parts[f"crank{i + 1}"] = Shaft(names[i + 1], names[i], k, c)
    parts[f"crank{throws}"] = Shaft(flange, names[-1], flange_stiffness, flange_damping)
    for name, c in zip(names, each(absolute_damping, throws, "crankshaft.absolute_damping"), strict=True):
        if c:
            parts[f"{name}_bearing"] = Damper(name, damping=c)
    return parts


def torsional_damper(ring_inertia: float, hub_inertia: float, stiffness: float, damping: float) -> Parts:
    """A crankshaft damper: ``damper_ring`` and ``damper_hub`` [kgm²] joined by ``damper``.

    >>> sorted(torsional_damper(0.3, 0.1, 2.8e5, 80.0))
    ['damper', 'damper_hub', 'damper_ring']
    """
    return {
        "damper_ring": Inertia(ring_inertia),
        "damper_hub": Inertia(hub_inertia),
        "damper": Shaft("damper_ring", "damper_hub", stiffness, damping),
    }


def clutch(
    flywheel: str,
    law: Law,
    *,
    inertia: float,
    damping: float = 0.0,
    hub_stiffness: float,
    friction: Law | None = None,
) -> Parts:
    """A closed clutch: the damper ``clutch`` from ``flywheel`` to ``clutch_disc``, ``clutch_hub`` to ``gearbox_input``.

    A ``friction`` law stands beside the damper as ``clutch_friction``.

    >>> from torsional.laws import Hinges
    >>> sorted(clutch("flywheel", Hinges(25e3), inertia=0.09, damping=30.0, hub_stiffness=1.5e5))
    ['clutch', 'clutch_disc', 'clutch_hub']
    """
    return {
        "clutch": Coupling("clutch_disc", flywheel, law, damping),
        **({"clutch_friction": Coupling("clutch_disc", flywheel, friction)} if friction else {}),
        "clutch_disc": Inertia(inertia),
        "clutch_hub": Shaft("gearbox_input", "clutch_disc", hub_stiffness),
    }


def gearbox(
    ratio: float, *, input_inertia: float, mesh_inertia: float, output_inertia: float, stiffness: float
) -> Parts:
    """A gearbox in one gear: ``gearbox_input`` –``gearbox``– ``gearbox_mesh`` (input speed), then ``ratio`` to the
    ``gearbox_output`` (output speed); inertias [kgm²] at their own speeds, ``stiffness`` [Nm/rad] at input speed.

    >>> parts = gearbox(2.0, input_inertia=0.12, mesh_inertia=0.15, output_inertia=0.25, stiffness=3e5)
    >>> sorted(parts)
    ['gear', 'gearbox', 'gearbox_input', 'gearbox_mesh', 'gearbox_output']
    """
    return {
        "gearbox_input": Inertia(input_inertia),
        "gearbox": Shaft("gearbox_mesh", "gearbox_input", stiffness),
        "gearbox_mesh": Inertia(mesh_inertia),
        "gear": GearPair("gearbox_mesh", "gearbox_output", ratio),
        "gearbox_output": Inertia(output_inertia),
    }


def driveline(
    *,
    shaft_stiffness: float,
    axle_inertia: float,
    final_drive_ratio: float,
    half_shaft_stiffness: float,
    wheel_inertia: float,
    tyre_stiffness: float,
    tyre_damping: float,
    vehicle: Vehicle,
    shaft_damping: float = 0.0,
    half_shaft_damping: float = 0.0,
) -> Parts:
    """Propeller shaft, axle, final drive, half shafts, wheels, tyres and ``vehicle``; every value at its own speed.

    >>> parts = driveline(shaft_stiffness=1.2e5, axle_inertia=0.3, final_drive_ratio=2.85, half_shaft_stiffness=1e5,
    ...     wheel_inertia=70.0, tyre_stiffness=1.6e5, tyre_damping=1500.0, vehicle=Vehicle(40e3, 0.5))
    >>> parts["tyres"].a
    'vehicle'
    """
    return {
        "propeller_shaft": Shaft("axle", "gearbox_output", shaft_stiffness, shaft_damping),
        "axle": Inertia(axle_inertia),
        "final_drive": GearPair("axle", "differential", final_drive_ratio),
        "half_shafts": Shaft("wheels", "differential", half_shaft_stiffness, half_shaft_damping),
        "wheels": Inertia(wheel_inertia),
        "tyres": Tyre("vehicle", "wheels", tyre_stiffness, tyre_damping),
        "vehicle": vehicle,
    }
