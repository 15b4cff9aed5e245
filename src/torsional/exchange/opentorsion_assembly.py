"""Assemblies of openTorsion as models: the same matrices, from the same elements.

openTorsion (Aalto University, https://pypi.org/project/opentorsion) numbers its nodes; here they are n0, n1, …
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any, Protocol

from torsional.arguments import checked
from torsional.components import Component, Damper, GearPair, Inertia, PlanetSpin, Shaft
from torsional.errors import ModelError
from torsional.files.opening import TABLE_BYTES, read_text, shown
from torsional.model import Landmarks, Model


class Assembly(Protocol):
    """What an `opentorsion.Assembly` has."""

    @property
    def shaft_elements(self) -> Any:
        """Its shafts."""

    @property
    def disk_elements(self) -> Any:
        """Its disks."""

    @property
    def gear_elements(self) -> Any:
        """Its rigid gears."""

    @property
    def elastic_gear_elements(self) -> Any:
        """Its elastic gears."""


@checked
def from_opentorsion(assembly: Assembly, name: str = "openTorsion assembly") -> Model:
    """The model of an `opentorsion.Assembly`: shafts, disks, gears, elastic gears.

    A shaft's own inertia is J/6 [[2, 1], [1, 2]], as there: three squares.  The stiffness of a disk to the ground is
    left out, as openTorsion's matrices (0.3.2) leave it out; a disk's damping acts to the ground.
    Raises ModelError for what is no assembly, and for stiffnesses and inertias that cannot be.
    """
    gears, elastic = assembly.gear_elements or (), assembly.elastic_gear_elements or ()
    listed = [
        *_shafts(assembly.shaft_elements or ()),
        *_disks(assembly.disk_elements or ()),
        *_gears(gears),
        *_elastic(elastic),
    ]
    model = Model(name, dict(_numbered(listed)), Landmarks())
    _ = model.powertrain()
    return model


@checked
def read_tors(path: str | os.PathLike[str]) -> Model:
    """The model of a file in openTorsion's own form, TORS (JSON); openTorsion itself reads it.

    Raises ModelError where openTorsion is not installed and for a file that it does not read.
    """
    try:
        parser = import_module("opentorsion.assembly").Assembly
    except ImportError:
        remedy = "pip install opentorsion"
        raise ModelError(
            "a library that TORS files need is not installed", found="opentorsion", remedy=remedy
        ) from None
    text = read_text(path, TABLE_BYTES)
    try:
        told = json.loads(text)
        assembly = parser.from_tors(told)
    except Exception as error:  # whatever the library says of a file that is none
        found = f"{type(error).__name__}: {error}"[:120]
        raise ModelError("openTorsion does not read this file", file=shown(path), found=found) from None
    return from_opentorsion(assembly, str(told.get("name") or Path(path).stem))


def _numbered(parts: Iterable[tuple[str, Component]]) -> Iterator[tuple[str, Component]]:
    """Names that occur again get a number."""
    seen: dict[str, int] = {}
    for name, part in parts:
        seen[name] = seen.get(name, 0) + 1
        yield (name if seen[name] == 1 else f"{name} no {seen[name]}"), part


def _node(number: Any) -> str:
    return f"n{int(number)}"


def _shafts(shafts: Iterable[Any]) -> Iterator[tuple[str, Component]]:
    for shaft in shafts:
        a, b, sixth = _node(shaft.nl), _node(shaft.nr), float(shaft.mass)
        name = f"shaft {a} {b}"
        yield name, Shaft(a, b, float(shaft.k), float(shaft.c))
        if sixth:  # m [[2, 1], [1, 2]]: m on either end, and 4 m on their mean
            yield f"{name} at {a}", Inertia(sixth, a)
            yield f"{name} at {b}", Inertia(sixth, b)
            yield f"{name} both", PlanetSpin(a, b, 0.5, 4.0 * sixth)


def _disks(disks: Iterable[Any]) -> Iterator[tuple[str, Component]]:
    for disk in disks:
        node = _node(disk.node)
        if disk.I:
            yield f"disk {node}", Inertia(float(disk.I), node)
        if disk.c:
            yield f"disk {node} damper", Damper(node, "ground", float(disk.c))


def _gears(gears: Iterable[Any]) -> Iterator[tuple[str, Component]]:
    """Rigid gears: R_p θ_p + R θ = 0."""
    for gear in gears:
        node = _node(gear.node)
        if gear.I:
            yield f"gear {node}", Inertia(float(gear.I), node)
        if gear.parent is not None:
            yield (
                f"mesh {_node(gear.parent.node)} {node}",
                GearPair(_node(gear.parent.node), node, -float(gear.R) / float(gear.parent.R)),
            )


def _elastic(gears: Iterable[Any]) -> Iterator[tuple[str, Component]]:
    """Gears whose mesh yields, k (θ_p + θ R/R_p)² / 2: a rigid mesh, and a shaft from there to the parent."""
    for gear in gears:
        node = _node(gear.node)
        if gear.I:
            yield f"gear {node}", Inertia(float(gear.I), node)
        if gear.parent is not None:
            parent, mesh = _node(gear.parent.node), f"mesh {_node(gear.parent.node)} {node}"
            yield mesh, GearPair(f"{mesh} side", node, -float(gear.R) / float(gear.parent.R))
            yield f"{mesh} spring", Shaft(parent, f"{mesh} side", float(gear.k), float(gear.c or 0.0))
