"""Units of powertrains and absorbers, as one function."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from torsional.absorbers import Absorber
from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.exchange.fmu.absorber import absorber_unit
from torsional.exchange.fmu.line import line_unit
from torsional.exchange.fmu.packing import Packed, packed
from torsional.model import Model
from torsional.powertrain import Powertrain
from torsional.solvers.transient.marching import Accuracy
from torsional.solvers.transient.problem import Drives
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.system import System, assemble

STEPPED = ("chung_hulbert", "hht", "bossak", "newmark")


@checked
def export_fmu(
    subject: Model | Powertrain | System | Absorber,
    path: str | os.PathLike[str],
    *,
    fmi: str = "2.0",
    name: str = "",
    gear: str | int | None = None,
    inputs: object = None,
    drives: Drives = (),
    speed: float | SpeedProfile = 0.0,
    hold: str = "",
    start: object = None,
    step: float = 1e-4,
    method: str = "chung_hulbert",
    spectral_radius: float = 0.8,
    outputs: Sequence[str] = (),
    detailed: bool = True,
    compiled: bool | None = None,
) -> Packed:
    """Write a powertrain or an absorber as a functional mock-up unit for co-simulation, as C that needs no Python.

    Of an `Absorber` angle, speed and acceleration of both sides go in and torques come out; flywheels on its sides stay
    outside.  Of a `Model` (in one ``gear``), `Powertrain` or `System` torques at the nodes ``inputs`` go in, {node: Nm
    at the start} or names, of a model by default its throws and its load; angles, speeds, accelerations of nodes and
    torques of elements come out, or those named by ``outputs``.  ``drives``, ``speed`` [rad/s], ``hold``, ``start``,
    ``step`` [s], ``method``, ``spectral_radius`` as in `transient`, whose steps the unit takes: same laws, same scheme,
    same figures.  ``detailed``: with an absorber's inner parts.  ``fmi``: 2.0 or 3.0.  ``compiled``: with a binary for
    this machine; None: where a C compiler is at hand.  Inertias, stiffnesses of plain springs, factors on those of
    springs with stages, damping coefficients and the step are parameters.

    Gives the file's size [bytes], the platform it is compiled for and the names of its variables.  Raises ModelError
    for what cannot be written.
    FMI: https://fmi-standard.org.
    """
    if method not in STEPPED:
        raise ModelError("no unit takes such steps", where="method", found=method, allowed=", ".join(STEPPED))
    accuracy = Accuracy(step, method, spectral_radius)
    if isinstance(subject, Absorber):
        unit = absorber_unit(subject, name or subject.kind, accuracy, detailed)
    else:
        system, title, places = _line(subject, gear, detailed)
        settings: dict[str, Any] = {"drives": drives, "speed": speed, "hold": hold, "start": start}
        nodes = given(places if inputs is None else inputs)
        unit = line_unit(system, name or title, nodes, accuracy=accuracy, outputs=outputs, **settings)
    return packed(unit, Path(path), fmi, compiled)


def given(inputs: object) -> dict[str, float]:
    """Nodes and their torques [Nm] at the start, nought where only names are told."""
    if isinstance(inputs, Mapping):
        return {str(node): float(torque) for node, torque in inputs.items()}
    listed = [inputs] if isinstance(inputs, str) else inputs
    if not isinstance(listed, Sequence):
        raise ModelError("names of nodes are wanted", where="inputs", found=repr(inputs)[:60])
    return {str(node): 0.0 for node in listed}


def _line(
    subject: Model | Powertrain | System, gear: str | int | None, detailed: bool
) -> tuple[System, str, list[str]]:
    """The system, a name for it, and the nodes on which torques usually act."""
    if isinstance(subject, System):
        return subject, "powertrain", []
    if isinstance(subject, Powertrain):
        return assemble(subject), "powertrain", []
    marks = subject.landmarks
    usual = [node for node in dict.fromkeys((*marks.throws, marks.load)) if node]
    whole = subject.detailed() if detailed else subject
    return assemble(whole.powertrain(gear)), subject.name, usual
