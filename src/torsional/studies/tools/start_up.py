"""`start-up`: what an engine start through the absorber's resonance does to its springs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Annotated, Any, NamedTuple

import numpy as np
import xarray as xr

from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.advice import advised, chosen, concept, drawn, over, positive, values_of
from torsional.studies.base import tool
from torsional.studies.starts import (
    Peaks,
    passed,
    resonance,
    spring_of,
    sprung,
    started,
    starter,
    stop_angle,
)
from torsional.studies.swept import Along, Curve
from torsional.studies.trucks import Trucks, replaced, stiffness
from torsional.units import RPM

STARTER = 5 / 12
"""Speed of the starter over idle, where nothing else is said: 250 rpm of 600."""


class Varied(NamedTuple):
    """A parameter: its quantity, in words, values derived from a model, and the model with another one."""

    quantity: str
    words: str
    derived: Callable[[Model], Array]
    changed: Callable[[Model, float], Model] = lambda model, value: model


def _damping(model: Model) -> float:
    spring: Any = model.components[spring_of(model)]
    return float(spring.damping)


VARIED = {
    "starter_speed": Varied("speed", "starter speed", lambda m: m.operation.idle * np.array([3, 4, 5, 6, 7]) / 12),
    "run_up_time": Varied("time", "time from a third of idle to idle", lambda m: np.geomspace(0.1, 3.2, 6)),
    "stiffness": Varied(
        "stiffness",
        "stiffness up to a stop at the same torque",
        lambda m: stiffness(m, spring_of(m)) * np.array([0.25, 0.5, 0.75, 1.0, 1.25]),
        sprung,
    ),
    "damping": Varied(
        "damping",
        "damping beside the springs",
        lambda m: _damping(m) * np.array([0.25, 0.5, 1.0, 2.0, 4.0]),
        lambda m, value: replaced(m, spring_of(m), damping=value),
    ),
}


@tool("start-up", varies="starter speed, time of a run-up, stiffness or damping of the springs", picture=drawn)
def start_up(
    trucks: Trucks,
    *,
    absorber: Annotated[str, "absorber concept with springs: dmf, two-stage, psva …"] = "dmf",
    varied: Annotated[str, "starter-speed, run-up-time, stiffness or damping"] = "starter-speed",
    values: Annotated[tuple[float, ...] | None, "values of it in SI; empty: about its own"] = None,
    starter_speed: Annotated[
        float | None, "speed", "starter speed where another is varied; default 5/12 of idle"
    ] = None,
    starter_torque: Annotated[float | None, "torque", "its torque at standstill; default 60 % of full load"] = None,
) -> xr.Dataset:
    """Engine start through the absorber's resonance: largest angle and torque of its springs, acceleration behind.

    In time, gearbox in neutral, averaged over four moments of the first firing; run-ups by an ideal drive.
    """
    model, asked = concept(trucks, absorber), chosen(VARIED, varied, "varied")
    _ = spring_of(model)
    at = values_of(values, asked.derived(model), "values", least=1)
    idle, peak = model.operation.idle, model.full_load_peak()
    speed = positive(starter_speed, STARTER * idle, "starter_speed")
    torque = positive(starter_torque, 0.6 * peak, "starter_torque")
    models = [asked.changed(model, float(value)) for value in at]

    def one(changed: Model, value: float) -> Peaks:
        if asked.quantity == "time":
            return passed(changed, value)
        turning = value if asked.quantity == "speed" else speed
        return started(changed, *starter(changed, turning / idle, torque / peak))

    found = np.array([one(changed, float(value)) for changed, value in zip(models, at, strict=True)])
    name = varied.replace("-", "_")
    data = over(Along(name, at, asked.quantity, asked.words), _curves(models, found), model)
    del data.attrs["speed_range"]  # starts lie below it
    where = "" if asked.quantity == "speed" else f" and {speed / RPM:.0f} rpm"
    by = f"starter of {torque:.0f} Nm at standstill{where}; averaged over four moments of the first firing, after 0.6 s"
    if asked.quantity == "time":
        by = "run-ups by an ideal drive at 12 % of the peak torque"
    condition = f"gearbox in neutral, {by}; absorber: {trucks.origins.get(absorber.replace('-', '_'), 'as given')}"
    return advised(data, "start-up", model, condition, list(_findings(data, name)))


def _curves(models: list[Model], found: Array) -> dict[str, Curve]:
    angle, torque, acceleration = found.T
    stops = np.array([stop_angle(each) for each in models])
    largest = "largest angle of the springs"
    told = {
        "angle": Curve(np.deg2rad(angle), "relative_angle", "reached", largest),
        "torque": Curve(torque, "torque", panel="peak torque of the springs"),
        "acceleration": Curve(acceleration, "acceleration", panel="peak at the gearbox input"),
        "resonance": Curve(np.array([resonance(each) for each in models]) * RPM, "speed", panel="DMF mode in neutral"),
    }
    if np.isfinite(stops).all():
        told["stop"] = Curve(np.deg2rad(stops), "relative_angle", "stop", largest)
    return told


def _findings(data: xr.Dataset, name: str) -> Iterator[str]:
    ends = [data.isel({name: place}) for place in (0, -1)]
    for end in ends:
        stop = f" of {np.rad2deg(float(end.stop)):.1f}° to the stop" if "stop" in data else ""
        yield (
            f"{name.replace('_', ' ')} {_shown(end[name])}: the springs turn by "
            f"{np.rad2deg(float(end.angle)):.1f}°{stop}, carry {float(end.torque):.0f} Nm, "
            f"the gearbox input has {float(end.acceleration):.0f} rad/s² at most"
        )
    met = data.resonance.values / RPM
    told = f"{met[0]:.0f} rpm" if np.ptp(met) < 0.5 else f"{met.min():.0f} to {met.max():.0f} rpm"
    yield f"the firing order meets the springs' mode in neutral at {told}"
    if "stop" in data and (data.angle >= data.stop).any():
        yield f"the stop is met with {', '.join(_shown(at) for at in data[name][data.angle >= data.stop])}"


def _shown(value: xr.DataArray) -> str:
    quantity = str(value.attrs["quantity"])
    return f"{float(value) / RPM:.0f} rpm" if quantity == "speed" else f"{float(value):.3g} {value.attrs['units']}"
