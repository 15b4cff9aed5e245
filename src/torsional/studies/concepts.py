"""The shipped truck with each of its absorbers, and the same absorbers on another truck.

A shipped absorber on another truck is scaled so that it stands in it as in its own: torques and stiffnesses follow the
peak of the full-load curve, t; inertias follow t ((3 · 600 rpm)/(n · idle))², n the firing order, so that its modes
meet the firing order at the same multiples of idle; damping keeps its damping ratios; tuning follows firing order and
idle.  On the shipped truck every factor is 1.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any

from torsional.errors import ModelError
from torsional.files.load import model_from_document, rebuilt
from torsional.files.reader import parse_tree
from torsional.files.scaling import scaled_absorber
from torsional.model import Model
from torsional.units import RPM

ORDER, IDLE, PEAK = 3.0, 600 * RPM, 2500.0
"""Firing order, idle [rad/s] and full-load peak [Nm] of the shipped truck."""
SHIPPED = "as shipped"
OWN = "yours, as it is"
_DOUBLE = "dual_mass_flywheel"
_KINDS = {
    "single_mass_flywheel": "smf",
    "power_split": "psva",
    "planetary_dual_mass_flywheel": "planetary",
    "arc_spring_flywheel": "arc_spring",
}


def _data(name: str) -> dict[str, Any]:
    text = (files("torsional") / "data" / f"{name}.yaml").read_text(encoding="utf-8")
    return parse_tree(text, f"{name}.yaml").data


@cache
def absorbers() -> dict[str, tuple[str, dict[str, Any]]]:
    """The shipped absorbers by concept: name with its article, and block of a model file.

    >>> absorbers()["smf"]
    ('a single mass flywheel', {'type': 'single_mass_flywheel', 'inertia': '1.9 kgm²'})
    """
    return {concept: (told["name"], told["absorber"]) for concept, told in _data("absorbers").items()}


@cache
def shipped() -> dict[str, Model]:
    """The representative truck with each of the absorbers; all share one engine."""
    truck = _data("truck13")
    documents = {
        concept: truck | {"name": f"{truck['name']} with {name}", "absorber": block}
        for concept, (name, block) in absorbers().items()
    }
    return built(documents)


def built(documents: Mapping[str, Mapping[str, Any]], known: Model | None = None) -> dict[str, Model]:
    """Models of documents with the same engine block, which they share; with ``known`` its engine where it is that."""
    models: dict[str, Model] = {}
    for concept, document in documents.items():
        known = rebuilt(known, document) if known else model_from_document(document)
        models[concept] = known
    return models


@dataclass(frozen=True)
class Scale:
    """A truck against the shipped one: full-load ``torque``, ``idle`` and firing ``order``, each a ratio."""

    torque: float
    idle: float
    order: float

    @classmethod
    def of(cls, model: Model) -> Scale:
        """By its full-load curve, idle and cylinders."""
        cylinders = model.running_engine.layout.cylinders
        return cls(model.full_load_peak() / PEAK, model.operation.idle / IDLE, cylinders / 2 / ORDER)

    @property
    def inertia(self) -> float:
        """Ratio of inertias, t ((3 · 600 rpm)/(n · idle))²."""
        return self.torque / (self.order * self.idle) ** 2

    @property
    def acceleration(self) -> float:
        """Ratio of accelerations, torque over inertia: (n · idle / (3 · 600 rpm))²."""
        return self.torque / self.inertia

    @property
    def factors(self) -> dict[str, float]:
        """By quantity of the nomenclature; what is not named stays (lengths, angles, ratios, friction, contacts)."""
        return {
            "torque": self.torque,
            "stiffness": self.torque,
            "spring_rate": self.torque,
            "inertia": self.inertia,
            "mass": self.inertia,
            "damping": math.sqrt(self.torque * self.inertia),
            "speed": self.idle,
            "engine_order": self.order,
        }

    def __str__(self) -> str:
        return f"torques and stiffnesses times {self.torque:.3g}, inertias times {self.inertia:.3g}"


def on_truck(model: Model) -> tuple[dict[str, Model], dict[str, str]]:
    """All concepts on a user's truck: models, and of each in words whose design it is.

    ModelError where the model lacks what the studies need, or where another absorber does not fit into it.
    """
    _check(model)
    own, scale = _own(model.document["absorber"]), Scale.of(model)
    models: dict[str, Model] = {}
    told: dict[str, str] = {}
    for concept, (name, block) in absorbers().items():
        if concept in own:
            told[concept], kept = own[concept]
            models[concept] = model if told[concept] == OWN else _fitted(model, f"your truck with {name}", kept)
        else:
            told[concept] = f"{name} as on the shipped truck, scaled to yours: {scale}"
            models[concept] = _fitted(model, f"your truck with {name}", scaled_absorber(block, scale.factors))
    return models, told


def _fitted(model: Model, name: str, block: Mapping[str, Any]) -> Model:
    """A copy with another absorber; landmarks that name parts of the old one go."""
    document = {**model.document, "name": name, "absorber": dict(block)}
    marks = {key: at for key, at in document.pop("landmarks", {}).items() if key not in ("springs", "crankshaft")}
    try:
        return rebuilt(model, document | ({"landmarks": marks} if marks else {}))
    except ModelError as error:
        remedy = f"studies put {name.rpartition(' with ')[2]} in its place; leave out what hangs on your own absorber"
        told = {"found": error.found, "allowed": error.allowed, "remedy": remedy}
        raise ModelError(error.problem, where=error.where, **told) from None


def _own(block: Mapping[str, Any]) -> dict[str, tuple[str, Mapping[str, Any]]]:
    """The concepts that a user's absorber block is: in words what was done to it, and the block."""
    plain = {key: value for key, value in block.items() if key != "pendulum"}
    kind, bare = block["type"], OWN if len(plain) == len(block) else "yours without its pendulum"
    if kind == "dual_mass_flywheel_with_tuned_absorber":
        return (
            {"tva": (OWN, block)}
            if block["on"] == "flange"
            else {"dmf": ("yours without its tuned absorber", _under(plain))}
        )
    if kind != _DOUBLE:
        return {_KINDS[kind]: (bare, plain)} if kind in _KINDS else {}
    if len(block.get("stages", ())) > 1:
        return {"two_stage": (bare, plain)}
    return {"dmf": (bare, plain)} | ({"pendulum": (OWN, block)} if bare != OWN else {})


def _under(block: Mapping[str, Any]) -> dict[str, Any]:
    """The flywheels and springs under a tuned absorber on the secondary flywheel."""
    return {key: value for key, value in block.items() if key not in ("tva", "on")} | {"type": _DOUBLE}


def _check(model: Model) -> None:
    """ModelError, with the key that is missing, for a model that the studies cannot ask."""
    marks = model.landmarks
    wanted = {
        "absorber": (model.absorber, "an absorber block, in whose place studies put others"),
        "engine": (model.engine, "an engine block, which excites the line"),
        "engine.full_load": (model.full_load_curve, "a full-load curve, by whose peak torques are chosen"),
        "clutch": (marks.clutch and marks.input, "a clutch block, behind which the gearbox input lies"),
        "gearbox": (marks.load, "a gearbox block, or landmarks.load, where the mean torque is taken up"),
    }
    for key, (found, what) in wanted.items():
        if not found:
            raise ModelError(f"studies of absorbers need {what}", where=key, remedy=f"give the model file '{key}'")
    if "absorber" not in model.document:
        remedy = "load it with load_model, or change values of the file with changed"
        raise ModelError("studies of absorbers need the model's file", where=model.name, remedy=remedy)
