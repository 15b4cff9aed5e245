"""Model files into models."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from torsional.arguments import checked
from torsional.engine import Engine
from torsional.engine.excitation import checked_nodes
from torsional.errors import ModelError, nearest
from torsional.files.blocks import Machine, machine
from torsional.files.engine_parts import engine
from torsional.files.faults import placed, translated
from torsional.files.opening import TABLE_BYTES, read_text
from torsional.files.reader import Tree, read_tree, resolve_reference
from torsional.files.schema import ModelFile
from torsional.files.schema.document import LandmarksBlock, OperationBlock
from torsional.files.schema.parts import DistributedShaftPart
from torsional.model import Landmarks, Model, Operation
from torsional.powertrain import Powertrain
from torsional.units import quoted

PARTS = 400
_NEEDS = {
    "crankshaft": ("absorber", "to turn"),
    "clutch": ("absorber", "to sit on"),
    "driveline": ("gearbox", "to hang on"),
    "vehicle": ("driveline", "to be moved by"),
}


@checked
def load_model(path: str | os.PathLike[str]) -> Model:
    """The model that a YAML or JSON file describes, checked; files it names are read from its own folder.

    ModelError, and no other error, says what is wrong: file, key path with line, what was found, what is allowed.

    >>> load_model("examples/truck_dmf.yaml").components["dmf"].law.stiffness  # Nm/rad
    13000.0
    """
    tree = read_tree(path)
    return model_from_tree(_completed(tree, path))


def model_from_document(
    document: Mapping[str, Any], folder: str | os.PathLike[str] | None = None, file: str = ""
) -> Model:
    """The model that a parsed model file describes; ``folder`` is where the files it names lie.

    >>> discs = {"disc": {"type": "inertia", "inertia": "0.2 kgm²"}}
    >>> model_from_document({"torsional": 1, "name": "one disc", "components": discs}).components["disc"].inertia
    0.2
    """
    tree = Tree(dict(document), {}, file)
    return model_from_tree(tree if folder is None else _completed(tree, Path(folder) / "model.yaml"))


def validated(tree: Tree) -> ModelFile:
    """The tree as blocks of the schema; ModelError for whatever is not of it."""
    try:
        _refuse_blanks(tree.data, "")
        file = ModelFile.model_validate(tree.data)
        _refuse_loose_blocks(file)
    except ValidationError as error:
        raise translated(error, tree) from None
    except ModelError as error:
        raise placed(error, tree) from None
    return file


def rebuilt(model: Model, document: Mapping[str, Any]) -> Model:
    """The model of a changed document; an engine block that is as before keeps its engine and all it has worked out."""
    same = document.get("engine") == model.document.get("engine")
    return model_from_tree(Tree(dict(document)), model.engine if same else None)


def model_from_tree(tree: Tree, motor: Engine | None = None) -> Model:
    """The model of a parsed file that stands on its own; with its ``motor`` where that is known."""
    file = validated(tree)
    try:
        return _built(file, tree.data, motor)
    except ModelError as error:
        raise placed(error, tree) from None


def _built(file: ModelFile, document: Mapping[str, Any], known: Engine | None) -> Model:
    motor = known or (engine(file.engine) if file.engine else None)
    built = machine(file, motor.layout.throw_count if motor else None)
    model = Model(
        name=file.name,
        components=built.parts,
        landmarks=_landmarks(built.landmarks, file.landmarks),
        gears=built.gears,
        engine=motor,
        operation=_operation(file.operation),
        absorber=built.absorber,
        document=document,
    )
    _check_powertrains(model, built)
    return model


def _operation(block: OperationBlock | None) -> Operation:
    plain = Operation()
    if block is None:
        return plain
    speed, torque = block.speed or plain.speed, block.torque
    return Operation(block.idle or plain.idle, (speed[0], speed[1]), (torque[0], torque[1]) if torque else None)


def _landmarks(found: Landmarks, block: LandmarksBlock | None) -> Landmarks:
    return dataclasses.replace(found, **block.values()) if block else found


def _check_powertrains(model: Model, built: Machine) -> None:
    """Every gear must make a powertrain; gears that differ by values alone are of one structure."""
    loops = len(built.gears) and any(path.startswith(("components", "gears")) for path in built.origin.values())
    for gear in model.gear_names if loops else (model.top_gear,):
        try:
            powertrain = model.powertrain(gear)
        except ModelError as error:
            raise _traced(error, built) from None
        _check_landmarks(model, powertrain)


def _traced(error: ModelError, built: Machine) -> ModelError:
    """An error of the powertrain with the key path of the component it names."""
    part = error.where.partition(".")[0]
    path = built.origin.get(part, "")
    where = path if path.endswith(part) else ".".join(filter(None, (path, error.where)))
    remedy = "connect them by a shaft, a coupling or gears" if "parts=" in error.remedy else error.remedy
    told = {"found": error.found, "allowed": error.allowed, "remedy": remedy}
    return ModelError(error.problem, where=where or error.where or "components", **told)


def _check_landmarks(model: Model, powertrain: Powertrain) -> None:
    marks = model.landmarks
    nodes = {"throws": marks.throws, "crankshaft": (marks.crankshaft,), "load": (marks.load,), "input": (marks.input,)}
    parts = {"springs": marks.springs, "clutch": (marks.clutch,)}
    for known, kind, places in ((powertrain.nodes, "node", nodes), (tuple(powertrain), "component", parts)):
        for key, names in places.items():
            for name in names:
                if name and name not in known:
                    where = f"landmarks.{key}"
                    raise ModelError(f"there is no {kind} '{name}'", where=where, remedy=nearest(name, known))
    if model.engine and marks.throws:
        try:
            checked_nodes(marks.throws, model.engine.layout.throw_count)
        except ModelError as error:
            raise ModelError(
                error.problem, where="landmarks.throws", found=error.found, allowed=error.allowed
            ) from None


def _refuse_blanks(value: object, path: str) -> None:
    """A key without a value is a line that someone meant to finish."""
    if value is None:
        raise ModelError("the key has no value", where=path, remedy="give it one, or remove the line")
    if isinstance(value, dict | list):
        for key, item in value.items() if isinstance(value, dict) else enumerate(value):
            _refuse_blanks(item, f"{path}.{key}" if path else str(key))


def _refuse_loose_blocks(file: ModelFile) -> None:
    """Blocks that need another one to hang on."""
    for key, (needed, why) in _NEEDS.items():
        if getattr(file, key) is not None and getattr(file, needed) is None:
            raise ModelError(f"a {key} needs a block '{needed}' {why}", where=key, remedy="or write it as components")
    if file.gearbox and not file.clutch and "gearbox_input" not in file.components:
        raise ModelError(
            "a gearbox needs a block 'clutch' before it", where="gearbox", remedy="or write it as components"
        )
    if file.driveline and not file.vehicle:
        raise ModelError("a driveline needs a block 'vehicle' to move", where="driveline")
    _refuse_giants(file)
    if file.gearbox and file.gears:
        raise ModelError("gears and gearbox exclude each other", where="gears", remedy="remove one of the two")
    if not file.absorber and not file.components:
        problem = "the file describes no machine"
        raise ModelError(problem, remedy="give the blocks of a vehicle (absorber, clutch, gearbox …) or components")


def _refuse_giants(file: ModelFile) -> None:
    """Checking a machine takes time with the square of its parts: one file must not take a face's minute."""
    largest = max(([*gear.components.values()] for gear in file.gears.values()), key=len, default=[])
    count = sum(
        part.elements if isinstance(part, DistributedShaftPart) else 1 for part in (*file.components.values(), *largest)
    )
    if count > PARTS:
        remedy = "give distributed shafts fewer elements"
        raise ModelError(
            "the machine has too many parts",
            where="components",
            found=str(count),
            allowed=f"at most {PARTS}",
            remedy=remedy,
        )


def _completed(tree: Tree, path: str | os.PathLike[str]) -> Tree:
    """The tree with its files, which lie beside the file ``path``."""
    return with_contents(tree, lambda name: read_text(resolve_reference(path, name), TABLE_BYTES))


def with_contents(tree: Tree, read: Callable[[str], str]) -> Tree:
    """The tree with the content of every file it names beside the name, so that a model stands on its own.

    What is wrong with the tree itself is told before what is wrong with a file.
    """
    try:
        return Tree(_with_files(tree, read), tree.lines, tree.file)
    except ModelError:
        validated(tree)
        raise


def _with_files(tree: Tree, read: Callable[[str], str]) -> dict[str, Any]:
    named = dict(_named_files(tree.data))
    if not named:
        return tree.data
    engine_block = {**tree.data["engine"]}
    for key, value in named.items():
        engine_block[key] = {**value, "text": _content(value["file"], read, f"engine.{key}", tree)}
    return {**tree.data, "engine": engine_block}


def _named_files(document: Mapping[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """The keys of the engine block that name a file whose content does not stand beside, with their blocks."""
    block = document.get("engine")
    if not isinstance(block, dict):
        return
    for key in ("full_load", "pressure_trace"):
        value = {"file": block[key]} if isinstance(block.get(key), str) else block.get(key)
        if isinstance(value, dict) and isinstance(value.get("file"), str) and "text" not in value:
            yield key, value


def files_named(document: Mapping[str, Any]) -> tuple[str, ...]:
    """The names of the files that a parsed model file wants beside it.

    >>> files_named({"engine": {"full_load": "curve.csv"}})
    ('curve.csv',)
    """
    return tuple(dict.fromkeys(value["file"] for _, value in _named_files(document)))


def _content(reference: str, read: Callable[[str], str], key: str, tree: Tree) -> str:
    try:
        return read(reference)
    except ModelError as error:
        found = error.found or quoted(reference)
        told = {"found": found, "allowed": error.allowed, "remedy": error.remedy}
        raise ModelError(error.problem, where=tree.place(key), file=tree.file, **told) from None
