"""Single figures by which designs are compared side by side."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

import numpy as np

from torsional.components import Inertia
from torsional.errors import ModelError
from torsional.model import Model
from torsional.quantities import acceleration, irregularity, swing
from torsional.quantities.modes import modes_of
from torsional.solvers.run_up import run_up_response
from torsional.stamps import Connection
from torsional.workbench.fields import words
from torsional.workbench.views.asking import Answer, AskInGear, main_order, reached

SPEEDS = 141


class AskCriteria(AskInGear):
    """What a design comes to in one gear at full load over the operating range."""

    view: Literal["criteria"]

    def answer(self, model: Model) -> Answer:
        """A list of figures; what a model cannot tell is left out."""
        gear = self.engaged(model)
        return {"gear": gear, "criteria": [*_resonances(model, gear), *_swings(model, gear), *_inertias(model)]}


def _told(name: str, label: str, quantity: str, value: float, better: str = "less") -> Answer:
    return {"name": name, "label": label, "quantity": quantity, "value": value, "better": better}


def _resonances(model: Model, gear: str) -> Iterator[Answer]:
    """The speed at which the main order meets the absorber's mode."""
    order = main_order(model)
    if order is None or not model.landmarks.springs:
        return
    try:
        found = modes_of(model, gear, model.typical_torque(), model.operation.idle, order)
    except ModelError:
        return
    met = found.order_speed.values[found.name.values == model.absorber_mode]
    if met.size:
        label = f"order {order:g} meets the {model.absorber_mode} at"
        yield _told("absorber_resonance", label, "speed", float(met[0]))


def _swings(model: Model, gear: str) -> Iterator[Answer]:
    """Largest swings of all orders together, half peak-to-peak, at full load."""
    marks = model.landmarks
    if model.engine is None or not (marks.throws and marks.load):
        return
    speeds = reached(model, model.speeds(SPEEDS))
    found = run_up_response(model, speeds, model.full_load(speeds), gear)
    quiet = marks.input or marks.crankshaft
    moved = swing(acceleration(found.angle.sel(node=quiet)))
    label = f"largest acceleration of {words(quiet)}, half peak-to-peak"
    yield _told("acceleration", label, "acceleration", float(moved.max()))
    order = main_order(model)
    if order is not None:
        alone = abs(acceleration(found.angle.sel(node=quiet))).sel(order=order)
        label = f"the same of order {order:g} alone, 0-peak"
        yield _told("main_order_acceleration", label, "acceleration", float(alone.max()))
    if marks.crankshaft:
        turned = irregularity(found.angle.sel(node=[marks.crankshaft]))[..., 0]
        label = f"irregularity of {words(marks.crankshaft)} at {'idle' if _idles(model, speeds) else 'lowest speed'}"
        yield _told("irregularity", label, "irregularity", float(turned[0]))
    for name in marks.springs:
        label = f"largest torque swing of {words(name)}, half peak-to-peak"
        yield _told(f"torque_{name}", label, "torque", float(swing(found.torque.sel(element=name)).max()))
        yield from _distance(model, gear, name, found)


def _idles(model: Model, speeds: Any) -> bool:
    return bool(np.isclose(speeds[0], model.operation.idle))


def _distance(model: Model, gear: str, name: str, found: Any) -> Iterator[Answer]:
    """What is left to a spring's stop in drive."""
    law = next((s.law for s in model.powertrain(gear).stamps if isinstance(s, Connection) and s.name == name), None)
    stops = [] if law is None else [stop for stop in law.stops if stop > 0]
    if stops:
        reach = float((found.mean_twist.sel(element=name) + swing(found.twist.sel(element=name))).max())
        label = f"angle left to the stop of {words(name)}"
        yield _told(f"stop_{name}", label, "relative_angle", min(stops) - reach, "more")


def _inertias(model: Model) -> Iterator[Answer]:
    if model.absorber is not None:
        parts = [part for part in model.absorber.components.values() if isinstance(part, Inertia)]
        yield _told("inertia", "inertia of the absorber", "inertia", sum(part.inertia for part in parts))
