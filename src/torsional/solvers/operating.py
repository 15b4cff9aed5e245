"""The linear system of a model in one gear under a mean engine torque."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.model import Landmarks, Model
from torsional.solvers.equilibrium import OperatingPoint, equilibrium, linearize
from torsional.system import System, assemble


def torque_places(model: Model) -> Landmarks:
    """The landmarks of a model that says where mean torque enters (throws) and is taken up (load); else ModelError."""
    marks = model.landmarks
    if not marks.throws or not marks.load:
        raise ModelError(
            "the model does not say where the mean torque enters and is taken up",
            where="landmarks",
            remedy="name landmarks.throws (or an engine block) and landmarks.load",
        )
    return marks


def mean_state(model: Model, system: System, torque: ArrayLike) -> OperatingPoint:
    """Equilibrium of a model's ``system`` under mean engine ``torque`` [Nm] (any shape), shared by the throws alike.

    Raises ModelError where the model does not say where torque enters (throws) and is taken up (load).
    """
    marks = torque_places(model)
    share = np.asarray(torque, dtype=float) / len(marks.throws)
    return equilibrium(system, dict.fromkeys(marks.throws, share), hold=marks.load)


@checked
def at_operating_point(model: Model, torque: float, gear: str | int | None = None) -> tuple[System, OperatingPoint]:
    """The linear system about the mean engine ``torque`` [Nm] in one ``gear``, and that operating point.

    A model without any law needs no landmarks: its system is linear as it is.

    Raises ModelError where the model does not say where torque enters (throws) and is taken up (load).

    >>> import torsional
    >>> truck = torsional.load_model("examples/truck_dmf.yaml")
    >>> system, point = at_operating_point(truck, torque=2000.0, gear=12)
    >>> round(float(point.angle[point.names.index("dmf")]), 6)  # rad: 2000 Nm over 13 kNm/rad
    0.153846
    """
    system = assemble(model.powertrain(gear))
    if not system.elements and not (model.landmarks.throws and model.landmarks.load):
        c, still = system.connections, np.zeros(len(system.connections.names))
        return system, OperatingPoint(c.names, still, still, c.stiffness, c.damping, c.laws)
    point = mean_state(model, system, float(torque))
    return linearize(system, point), point
