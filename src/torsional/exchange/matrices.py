"""Matrices for other tools: M, C, K of the system that small vibrations see, with names and units."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.solvers.checks import linear
from torsional.solvers.operating import at_operating_point
from torsional.spreadsheet import neutral
from torsional.system import System
from torsional.tables import heading

UNITS = {"M": "kgm²", "C": "Nm s/rad", "K": "Nm/rad", "H": "Nm/rad", "T": "-"}
MEANING = (
    "M q'' + C q' + (K + iH) q = T' u, angles of the nodes = T q; coordinates carry the name of a node, divided by its "
    "mean speed ratio; u are torques on the nodes"
)


class Matrices(NamedTuple):
    """``M`` [kgm²], ``C`` [Nms/rad], ``K`` (centrifugal parts at ``speed`` in it) and ``H`` [Nm/rad] over
    ``coordinates``, ``T`` (nodes, coordinates)."""

    name: str
    speed: float
    mean_torque: float
    coordinates: tuple[str, ...]
    nodes: tuple[str, ...]
    M: Array
    C: Array
    K: Array
    H: Array
    T: Array


@checked
def matrices(
    subject: System | Model, *, torque: float = 0.0, gear: str | int | None = None, speed: float = 0.0
) -> Matrices:
    """The matrices of a linear system, or of a model about a mean engine ``torque`` [Nm] in a ``gear``.

    ``speed`` [rad/s]: the mean speed at which centrifugal stiffness and speed-switched inertias count.
    Raises ModelError for a system with laws, and where the model has no operating point.

    >>> from torsional.components import Inertia, Shaft
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> pair = assemble(Powertrain({"a": Inertia(1.0), "b": Inertia(2.0), "s": Shaft("a", "b", 1e4)}))
    >>> matrices(pair).K.tolist()
    [[10000.0, -10000.0], [-10000.0, 10000.0]]
    """
    name = subject.name if isinstance(subject, Model) else "system"
    system = at_operating_point(subject, torque, gear)[0] if isinstance(subject, Model) else subject
    linear(system)
    system = system.switched(speed)
    stiffness = system.K + speed**2 * system.S
    head = (name, float(speed), float(torque), system.coordinates, system.nodes)
    return Matrices(*head, system.M, system.C, stiffness, system.H, system.T)


@checked
def write_matrices(told: Matrices, path: str | os.PathLike[str]) -> None:
    """Write matrices as MAT (version 5, for MATLAB, Octave, SciPy) or CSV, as the ending of the file says.

    Raises ModelError for another ending.
    """
    ending = Path(path).suffix.lower()
    if ending == ".mat":
        _write_mat(told, Path(path))
    elif ending == ".csv":
        Path(path).write_text(csv_of(told), encoding="utf-8", newline="")
    else:
        raise ModelError("matrices go to .mat or .csv", where=str(path), found=repr(ending), allowed=".mat, .csv")


def _write_mat(told: Matrices, path: Path) -> None:
    from scipy.io import savemat

    values: dict[str, Any] = {name: getattr(told, name) for name in UNITS}
    values |= {name: np.array(getattr(told, name), dtype=object) for name in ("coordinates", "nodes")}
    values |= {"units": UNITS, "name": told.name, "meaning": MEANING}
    values |= {"mean_torque_Nm": told.mean_torque, "speed_rad_s": told.speed}
    savemat(path, values, oned_as="column")


def csv_of(told: Matrices) -> str:
    """One table: which matrix, its row, and a column for each coordinate; every digit kept."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    text.write(f"# {_one_line(told.name)}, mean torque {told.mean_torque!r} Nm, speed {told.speed!r} rad/s\r\n")
    text.write(f"# {MEANING}\r\n")
    writer.writerow(["matrix", "row", *map(neutral, told.coordinates)])
    for name, unit in UNITS.items():
        rows: Sequence[str] = told.nodes if name == "T" else told.coordinates
        for label, values in zip(rows, getattr(told, name).tolist(), strict=True):
            writer.writerow([heading(name, unit), neutral(label), *values])
    return text.getvalue()


def _one_line(text: str) -> str:
    return "".join(c if c.isprintable() else " " for c in text)
