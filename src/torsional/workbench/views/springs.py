"""The absorber's springs: their characteristic, where full load puts them, and how far they swing there."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from torsional.errors import ModelError
from torsional.laws import Law
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.plots.layout import stage_angles
from torsional.quantities import swing
from torsional.solvers.run_up import run_up_response
from torsional.stamps import Connection
from torsional.workbench.fields import words
from torsional.workbench.views.asking import Answer, AskInGear, Number, refuse_unknown

POINTS = 400
BEYOND = 0.08
"""Share of the range drawn beyond its ends."""


class AskCharacteristic(AskInGear):
    """Torque over twist of a spring, and its operating point at a speed under a mean torque (default: full load)."""

    view: Literal["characteristic"]
    element: Annotated[str, Field(max_length=64)] = ""
    torque: Number | None = None
    speed: Annotated[float, Field(gt=0, le=1e4)] | None = None

    def answer(self, model: Model) -> Answer:
        """The spring's own curve without dampers; where friction stands beside it, the ways up and down."""
        gear = self.engaged(model)
        springs = {s.name: s for s in model.powertrain(gear).stamps if isinstance(s, Connection)}
        spring = springs[self._chosen(model, springs)]
        rubbing = springs.get(f"{spring.name}_friction")
        point = self._point(model, gear, spring.name)
        angle = _angles(spring.law, point)
        torque = spring_torque(spring, angle)
        slip = _slipping(rubbing.law) if rubbing is not None and rubbing.law is not None else 0.0
        return {
            "gear": gear,
            "element": spring.name,
            "label": words(spring.name),
            "elements": [name for name in (*model.landmarks.springs, model.landmarks.clutch) if name in springs],
            "angle": angle,
            "torque": torque,
            "friction": slip,
            "stages": _stages(spring),
            "stops": [] if spring.law is None else list(spring.law.stops),
            "point": point,
        }

    def _chosen(self, model: Model, springs: dict[str, Connection]) -> str:
        marks = (*model.landmarks.springs, model.landmarks.clutch)
        name = self.element or next((name for name in marks if name in springs), "")
        if not name:
            raise ModelError("the model names no spring", where="landmarks.springs")
        refuse_unknown([name], springs, "connection")
        return name

    def _point(self, model: Model, gear: str, element: str) -> Answer | None:
        """Mean twist and torque, half the peak-to-peak swing of all orders; None where no engine tells it."""
        if model.engine is None:
            return None
        low, high = model.operation.speed
        speed = 0.5 * (low + high) if self.speed is None else self.speed
        torque = float(model.full_load(speed)) if self.torque is None else self.torque
        found = run_up_response(model, [speed], [torque], gear).sel(element=element)
        mean = float(found.mean_twist[0])
        return {"speed": speed, "torque": torque, "angle": mean, "swing": float(swing(found.twist)[0])}


def spring_torque(spring: Connection, angle: Array) -> Array:
    """Torque [Nm] of a spring at rest over its twist [rad]."""
    own = spring.stiffness * angle
    return np.asarray(own + spring.law.torque(angle) if spring.law is not None else own)


def _angles(law: Law | None, point: Answer | None) -> Array:
    """From the farthest of stop, operating point and swing on coast to that on drive; every edge is among them."""
    ends = [0.0] if law is None else [0.0, *law.stops, *law.transitions]
    if point:
        ends += [point["angle"] - point["swing"], point["angle"] + point["swing"]]
    low, high = min(ends), max(ends)
    room = BEYOND * (high - low) or 0.1
    edges = [] if law is None else [edge for edge in law.edges.tolist() if low - room < edge < high + room]
    return np.unique([*np.linspace(low - room, high + room, POINTS), *edges])


def _stages(spring: Connection) -> list[Answer]:
    """Stiffness of each stage in drive, from zero to the stop."""
    if spring.law is None:
        return [{"angle": 0.0, "stiffness": spring.stiffness}]
    angles = np.array(stage_angles(spring.law))
    return [
        {"angle": float(a), "stiffness": float(k) + spring.stiffness}
        for a, k in zip(angles, spring.law.tangent(angles), strict=True)
    ]


def _slipping(law: Law) -> float:
    """The torque [Nm] at which friction beside a spring slips; 0 where it is no single one."""
    return float(getattr(law, "limit_torque", 0.0))
