"""Optimisations that engineers ask for by name: what may be chosen of an absorber, and its limits, from the truck."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

from torsional.errors import ModelError, nearest
from torsional.files.edit import changed
from torsional.files.scaling import read_document, values_at
from torsional.model import Model
from torsional.studies.advice import concept
from torsional.studies.answers import main_order
from torsional.studies.concepts import OWN
from torsional.studies.down_speeding import travels
from torsional.studies.friction import washed
from torsional.studies.matching import CLUTCH, FRICTION, SPRINGS, TUNING
from torsional.studies.optimise.plan import Asked
from torsional.studies.optimise.task import Limit, Method, Task
from torsional.studies.sweeps.absorbers import InertiaRun
from torsional.studies.sweeps.criteria import CriteriaRun
from torsional.studies.sweeps.designs import Axis
from torsional.studies.swinging import SHORT
from torsional.studies.trucks import Trucks
from torsional.studies.tuned_absorber import SPRING
from torsional.units import RPM, read

Factors = Mapping[str, tuple[float, float]]
BODIES = (0.4, 2.0)
"""Inertia of a body, over its own."""
LIGHT, HEAVY = (0.25, 4.0), (0.5, 1.5)
"""Planets, tuned absorbers; pendulums, which have to find room in the flywheel, over their own."""
TUNED = 1.02
"""Order of pendulums over the firing order: on purpose above it, so that tolerances, wear and the fall of the order
with the swing do not bring it below, where pendulums amplify (Newland, J. Eng. Ind. 86 (1964) 257)."""
PENDULUM = "absorber.pendulum.mass"
QUOTIENT = (0.72, 1.28)
"""Gear quotient over its own; above 0.98 there is nothing of a power split."""
SPLIT = 5 / 3
"""Over idle: where low speeds end, 1000 rpm where that is 600."""
LOADS = [0.0, 1.0]
"""Shares of full load: the swing of a linear line is convex in the mean torque, so that the ends tell the worst."""
FRICTIONS, VISCOUS = (0.002, 0.06), (0.1, 1.5)
"""Friction torque over the full-load peak, viscous damping of the clutch over its own."""
NONE = 0.0004
"""Friction torque that stands for none, over the full-load peak."""
QUANTITIES = {
    "space": "inertia",
    "travel": "relative_angle",
    "power": "power",
    "absorber": "",
    "mass": "mass",
    "tuning": "ratio",
}
"""Options of presets with the quantities of their values."""
_CLUTCH: Factors = {"clutch.stiffness": CLUTCH, "clutch.damping": FRICTION}


@dataclass(frozen=True)
class Preset:
    """An optimisation by name: ``about`` in words, what it ``takes`` as options, how it is made."""

    about: str
    takes: tuple[str, ...]
    make: Callable[[Trucks, Mapping[str, Any]], Task]
    method: Method = field(default_factory=Method)


def preset(name: str, trucks: Trucks, given: Mapping[str, str] | None = None) -> Asked:
    """The optimisation of a name on a truck; options ``given`` as texts with units, or numbers in SI.

    Raises ModelError for an unknown name, for options that it does not take and values that cannot be.

    >>> preset("best-dmf", Trucks.shipped(), {"space": "2.5 kgm²"}).task.limits["space"]
    Limit(least=-inf, most=2.5)
    """
    if name not in PRESETS:
        raise ModelError("there is no such preset", found=repr(name), remedy=nearest(name, PRESETS))
    known = PRESETS[name]
    told: dict[str, Any] = {}
    for option, text in (given or {}).items():
        if option not in known.takes:
            allowed = ", ".join(f"--{each}" for each in known.takes)
            raise ModelError(f"{name} has no such limit", where=f"--{option}", allowed=allowed)
        told[option] = read(text, QUANTITIES[option], f"--{option}") if QUANTITIES[option] else text
    return Asked(name, known.make(trucks, told), known.method)


def _best_dmf(trucks: Trucks, given: Mapping[str, Any]) -> Task:
    return absorber_task(trucks.dmf, _flywheels(trucks.dmf), given)


def _best_psva(trucks: Trucks, given: Mapping[str, Any]) -> Task:
    own = {
        "absorber.primary_inertia": BODIES,
        "absorber.secondary_inertia": BODIES,
        "absorber.output_inertia": BODIES,
        "absorber.planet_inertia": LIGHT,
        "absorber.gear_quotient": QUOTIENT,
        _springs(trucks.psva): SPRINGS,
    }
    return absorber_task(trucks.psva, own, given)


def _best_tva(trucks: Trucks, given: Mapping[str, Any]) -> Task:
    model = stiff_tuned(trucks.tva)
    own = {
        "absorber.primary_inertia": BODIES,
        "absorber.flange_inertia": BODIES,
        "absorber.secondary_inertia": BODIES,
        "absorber.tva.inertia": LIGHT,
        "absorber.tva.stiffness": (LIGHT[0] * TUNING[0], LIGHT[1] * TUNING[1]),
        "absorber.primary_springs.stiffness": SPRINGS,
        "absorber.secondary_springs.stiffness": SPRINGS,
        _springs(model): SPRINGS,
    }
    return absorber_task(model, own, given)


def _best_pendulum(trucks: Trucks, given: Mapping[str, Any]) -> Task:
    order = given.get("tuning", TUNED) * main_order(trucks.pendulum)
    model = changed(trucks.pendulum, {"absorber.pendulum.order": order})
    task = absorber_task(model, {**_flywheels(model), PENDULUM: HEAVY}, given)
    if "mass" not in given:
        return task
    low, most = task.axes[PENDULUM].low, given["mass"]
    if most <= low:
        raise ModelError(
            "the pendulums cannot be so light", where="--mass", found=f"{most:g} kg", allowed=f"> {low:g} kg"
        )
    return replace(task, axes={**task.axes, PENDULUM: Axis(low=low, high=most, log=True)})


def _best_friction(trucks: Trucks, given: Mapping[str, Any]) -> Task:
    named = next((name for name, told in trucks.origins.items() if told == OWN), "dmf")
    model = concept(trucks, given.get("absorber", named))
    names = ("peak", "far", "power", "far_power")
    criteria = {name: {"of": "friction", "figure": name} for name in names}
    run = {"analysis": "criteria", "ask": {"friction": {"analysis": "friction"}}, "criteria": criteria}
    peak = model.full_load_peak()
    torques = Axis(low=FRICTIONS[0] * peak, high=FRICTIONS[1] * peak, log=True)
    axes = {"friction_torque": torques, "viscous": Axis(low=VISCOUS[0], high=VISCOUS[1], log=True)}
    limits = {"power": Limit(most=given["power"])} if "power" in given else {}
    nominal = {"friction_torque": NONE * peak, "viscous": 1.0}
    asked = CriteriaRun.model_validate(run)
    return Task(partial(with_washer, model), axes, asked, ("peak", "far"), limits, nominal=nominal)


PRESETS = {
    "best-dmf": Preset("flywheels, springs and clutch of a dual mass flywheel", ("space", "travel"), _best_dmf),
    "best-clutch-friction": Preset(
        "friction washer and viscous damping of the clutch: resonance against vibration far from it",
        ("power", "absorber"),
        _best_friction,
        Method(24, 10),
    ),
    "best-psva": Preset("a power split absorber and its clutch", ("space", "travel"), _best_psva),
    "best-tva": Preset("a tuned absorber, its flywheels, springs and clutch", ("space", "travel"), _best_tva),
    "best-pendulum": Preset(
        "pendulum mass, flywheels, springs and clutch; the swing keeps to 60 % of the pendulum's way",
        ("space", "travel", "mass", "tuning"),
        _best_pendulum,
    ),
}
"""Optimisations by name."""


def with_washer(model: Model, friction_torque: float, viscous: float) -> Model:
    """The truck with a friction washer [Nm] in its clutch, whose viscous damping is multiplied."""
    return washed(model, float(friction_torque), float(viscous))


def absorber_task(model: Model, own: Factors, given: Mapping[str, Any]) -> Task:
    """Low-speed against high-speed vibration of a truck, absorber and clutch chosen within factors of their values.

    ``given``: the limits ``space`` [kgm²] (default: the absorber's own inertia) and ``travel`` [rad] (default: its own
    way to the stop).
    """
    axes = axes_of(model, {**own, **_CLUTCH})
    space = given.get("space", float(InertiaRun(analysis="inertia")(model).inertia) * (1 + 1e-9))
    limits = {"space": Limit(most=space)}
    ways = travels(model)
    if "travel" in given or ways:
        limits["travel"] = Limit(most=given.get("travel", max(ways.values(), default=0.0)))
    run = criteria_of(model)
    limits |= {name: Limit(most=most) for name, most in (("reach", 1.0), ("swing", SHORT)) if name in run.criteria}
    return Task(model, axes, run, ("low_speed", "high_speed"), limits)


def criteria_of(model: Model) -> CriteriaRun:
    """The criteria of absorbers: worst gearbox-input acceleration at low and high speed, travel, space."""
    (low, high), springs = model.operation.speed, list(model.landmarks.springs)
    split = split_of(model)
    ranges = {"low_speed": (low, split), "high_speed": (split, high)}
    worst = {"of": "worst", "figure": "acceleration_swing"}
    criteria: dict[str, Any] = {
        name: {**worst, "select": {"speed": f"{a / RPM:.12g}:{b / RPM:.12g} rpm"}} for name, (a, b) in ranges.items()
    }
    criteria["travel"] = {"of": "worst", "figure": "twist", "select": {"element": springs}}
    if travels(model):
        criteria["reach"] = {"of": "worst", "figure": "reach", "select": {"element": springs}}
    if "pendulum" in model.components:
        criteria["swing"] = {"of": "worst", "figure": "reach", "select": {"element": "pendulum.suspension"}}
    criteria["space"] = {"of": "whole", "figure": "inertia"}
    ask = {"worst": {"analysis": "envelope", "loads": LOADS}, "whole": {"analysis": "inertia"}}
    return CriteriaRun.model_validate({"analysis": "criteria", "ask": ask, "criteria": criteria})


def split_of(model: Model) -> float:
    """Where low speeds end [rad/s]: at 5/3 of idle, or in the middle of the range where that is less."""
    return min(SPLIT * model.operation.idle, 0.5 * sum(model.operation.speed))


def axes_of(model: Model, factors: Factors) -> dict[str, Axis]:
    """Factors of the values that the model's file gives, on a logarithmic scale; what it does not give stays."""
    file = read_document(model.document)
    axes = {}
    for path, (low, high) in factors.items():
        for value in values_at(file, path).values():
            most = min(high * value, 0.98) if path.endswith("gear_quotient") else high * value
            axes[path] = Axis(low=low * value, high=most, log=True)
    return axes


def stiff_tuned(model: Model) -> Model:
    """The same truck whose tuned absorber is given by its stiffness, not by the speed that it is tuned to."""
    spring: Any = model.components[SPRING]
    told = {"absorber.tva.tuned_to": None, "absorber.tva.order": None}
    return changed(model, told | {"absorber.tva.stiffness": float(spring.stiffness)})


def _flywheels(model: Model) -> dict[str, tuple[float, float]]:
    flywheels = {"absorber.primary_inertia": BODIES, "absorber.secondary_inertia": BODIES}
    return {**flywheels, _springs(model): SPRINGS}


def _springs(model: Model) -> str:
    """Where the file has the stiffness of the springs."""
    return "absorber.stages.0.stiffness" if "stages" in model.document["absorber"] else "absorber.stiffness"
