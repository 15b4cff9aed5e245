"""The machine itself: what its file holds, how it is drawn, what a part of it is made of."""

from __future__ import annotations

import contextlib
from typing import Any, Literal

import numpy as np

from torsional.errors import ModelError
from torsional.files import warnings_of
from torsional.files.blocks import machine
from torsional.files.edit import put
from torsional.files.expand import vars_of
from torsional.files.load import rebuilt, validated
from torsional.files.reader import Tree
from torsional.model import Model
from torsional.plots.layout import chain
from torsional.stamps import Stamp
from torsional.workbench.absorbers import choices
from torsional.workbench.fields import Field, fields_of, groups_of, words
from torsional.workbench.views.asking import Answer, Ask, AskInGear

STEP = 2.0**-10
"""Share by which a value is moved to see what it acts on."""


class AskModel(AskInGear):
    """What the file holds, and its chain in one gear."""

    view: Literal["model"]

    def answer(self, model: Model) -> Answer:
        """Names, ranges, editable values and the chain."""
        powertrain, operation, curve = model.powertrain(self.engaged(model)), model.operation, model.full_load_curve
        orders = model.engine_orders()
        return {
            "name": model.name,
            "gears": [name for name in model.gear_names if name],
            "gear": self.engaged(model),
            "ratios": [gear.ratio for gear in model.gears.values()],
            "operation": {"idle": operation.idle, "speed": operation.speed, "torque": _torques(model)},
            "full_load": curve and {"speed": np.array(curve.speeds), "torque": np.array(curve.torques)},
            "orders": orders,
            "main_order": orders[0] if orders else None,
            "nodes": powertrain.nodes,
            "elements": [
                link.name for link in chain(powertrain).links if link.kind in ("spring", "friction", "damper")
            ],
            "landmarks": vars_of(model.landmarks),
            "absorber": _absorber(model),
            "groups": groups_of(model),
            "chain": self._drawn(model),
            "warnings": warnings_of(model),
        }

    def _drawn(self, model: Model) -> Answer:
        """Places of discs and links, each with the key path of the block it comes from."""
        line, origin = chain(model.powertrain(self.engaged(model))), _origin(model)
        nodes = [
            {
                "name": node,
                "label": words(node),
                "x": x,
                "y": y,
                "inertia": line.inertia[node],
                "ratio": line.ratio[node],
                "path": origin.get(node, ""),
            }
            for node, (x, y) in line.places.items()
        ]
        links = [
            {
                "name": link.name,
                "label": words(link.name),
                "kind": link.kind,
                "nodes": link.nodes,
                "told": link.described,
                "path": origin.get(link.name, ""),
            }
            for link in line.links
        ]
        return {"nodes": nodes, "links": links}


class AskParts(AskInGear):
    """Which values each disc and each link is made of."""

    view: Literal["parts"]

    def answer(self, model: Model) -> Answer:
        """{part: key paths}, found by moving each value a little and looking which stamps change."""
        gear = self.engaged(model)
        before = {stamp.name: stamp for stamp in model.powertrain(gear).stamps}
        found: dict[str, list[str]] = {name: [] for name in before}
        for field in fields_of(model):
            for name in _moved(model, gear, field, before):
                found[name].append(field.path)
        return {"gear": gear, "parts": found}


class AskAbsorbers(Ask):
    """The absorbers that could stand in the place of this one."""

    view: Literal["absorbers"]

    def answer(self, model: Model) -> Answer:
        """Ready blocks, scaled to the model as studies of absorbers scale them."""
        return {"absorbers": [{"name": name, "label": told, "block": block} for name, told, block in choices(model)]}


def _torques(model: Model) -> tuple[float, float] | None:
    with contextlib.suppress(ModelError):  # neither a range nor a curve
        low, high = model.torques(2)
        return float(low), float(high)
    return None


def _absorber(model: Model) -> Answer | None:
    block = model.document.get("absorber")
    if model.absorber is None or not isinstance(block, dict):
        return None
    return {"type": block["type"], "label": model.absorber.kind, "pendulum": "pendulum" in block}


def _origin(model: Model) -> dict[str, str]:
    """The key path of the block that each part comes from."""
    throws = model.engine.layout.throw_count if model.engine else None
    return machine(validated(Tree(dict(model.document))), throws).origin


def _moved(model: Model, gear: str, field: Field, before: dict[str, Stamp]) -> list[str]:
    """The parts that change with a value; engine and operation are no parts of the line."""
    if field.value is None or field.kind != "quantity" or field.path.startswith(("engine", "operation")):
        return []
    document = _deep(model.document)
    value = field.value * (1 + STEP) if field.value else STEP
    put(document, field.path, value)
    with contextlib.suppress(ModelError):  # a value that nothing else allows is left alone
        after = rebuilt(model, document).powertrain(gear).stamps
        return [stamp.name for stamp in after if stamp.name in before and stamp != before[stamp.name]]
    return []


def _deep(value: Any) -> Any:
    """A copy whose mappings and lists may be changed."""
    if isinstance(value, dict):
        return {key: _deep(item) for key, item in value.items()}
    return [_deep(item) for item in value] if isinstance(value, list) else value
