"""The engine block as an Engine."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from torsional.engine import (
    ChenFlynn,
    CombustionCycle,
    CrankLayout,
    Engine,
    FullLoad,
    GasSource,
    LoadTable,
    PressureTrace,
    Wiebe,
)
from torsional.errors import ModelError
from torsional.files.schema.engine import (
    CombustionBlock,
    EngineBlock,
    FullLoadBlock,
    PressureTraceBlock,
    TableOverLoad,
    WiebeBlock,
)
from torsional.files.schema.fields import Block
from torsional.tables import parse_table
from torsional.units import quoted

_RENAMED = {"heat_spread": "cylinder_spread", "load table": "mean_effective_pressure", "pressure": "pressure_trace"}


@contextmanager
def within(path: str) -> Iterator[None]:
    """Errors of what is built inside name the key path, in the model file's words."""
    try:
        yield
    except ModelError as error:
        head, _, rest = error.where.partition(".")
        last = path.rpartition(".")[2]
        if head == last or head == "wiebe":
            head, rest = rest, ""
        error.where = ".".join(part for part in (_RENAMED.get(head, head), rest) if part)
        raise error.located(prefix=path) from None


def engine(block: EngineBlock) -> Engine:
    """The engine with its gas source, friction and full-load curve; ModelError names the key path."""
    cycle = _combustion(block.combustion) if block.combustion else CombustionCycle()
    gas: GasSource = _trace(block.pressure_trace) if block.pressure_trace else cycle
    friction = _friction(block)
    full_load = _full_load(block.full_load) if block.full_load else None
    with within("engine"):
        return Engine(
            bore=block.bore,
            stroke=block.stroke,
            rod_length=block.rod_length,
            pin_offset=block.pin_offset,
            reciprocating_mass=block.reciprocating_mass,
            compression_ratio=block.compression_ratio,
            layout=_layout(block),
            gas=gas,
            friction=friction,
            crankcase_pressure=block.crankcase_pressure,
            leakage_time=block.leakage_time,
            deactivated=tuple(block.deactivated),
            deactivated_valves=block.deactivated_valves,
            trapped_pressure=block.trapped_pressure,
            heat_spread=tuple(block.cylinder_spread or ()),
            full_load=full_load,
        )


def _layout(block: EngineBlock) -> CrankLayout:
    intervals = block.firing_intervals or ()
    if block.layout.startswith("inline"):
        return CrankLayout.inline(block.firing_order, intervals)
    return CrankLayout.vee(block.firing_order, block.bank_angle or 0.0, intervals, block.throws, block.pin_split)


def _friction(block: EngineBlock) -> ChenFlynn:
    with within("engine.friction"):
        return ChenFlynn(**_given(block.friction)) if block.friction else ChenFlynn()


def _given(block: Block) -> dict[str, Any]:
    return {key: getattr(block, key) for key in block.model_fields_set if getattr(block, key) is not None}


def _combustion(block: CombustionBlock) -> CombustionCycle:
    settings = _given(block)
    for key in ("main", "premixed"):
        if key in settings:
            settings[key] = _wiebe(settings[key], f"engine.combustion.{key}")
    for key in ("boost", "premixed_fraction"):
        if key in settings:
            settings[key] = _load_table(settings[key], f"engine.combustion.{key}")
    with within("engine.combustion"):
        return CombustionCycle(**settings)


def _wiebe(block: WiebeBlock, path: str) -> Wiebe:
    with within(path):
        return Wiebe(block.start, block.duration, block.shape, block.efficiency)


def _load_table(block: TableOverLoad, path: str) -> LoadTable | float:
    loads, values = block.mean_effective_pressure, block.value
    if len(loads) != len(values):
        found = f"{len(loads)} loads, {len(values)} values"
        raise ModelError("a value for each load is wanted", where=path, found=found)
    with within(path):
        return LoadTable(tuple(zip(loads, values, strict=True))) if len(values) > 1 else values[0]


@contextmanager
def _in_file(file: str | None, path: str) -> Iterator[None]:
    """Errors in a table name its file and the place there, beside the key that refers to it."""
    try:
        yield
    except ModelError as error:
        problem = ": ".join(part for part in (f"in {quoted(file or 'text')}", error.where, error.problem) if part)
        told = {"found": error.found, "allowed": error.allowed, "remedy": error.remedy}
        raise ModelError(problem, where=path, **told) from None


def _trace(block: PressureTraceBlock) -> PressureTrace:
    text = embedded_text(block.file, block.text, "engine.pressure_trace")
    with _in_file(block.file, "engine.pressure_trace"):
        return PressureTrace.from_text(text, speed=block.speed, offset=block.offset, own_angle=block.own_angle)


def _full_load(block: FullLoadBlock) -> FullLoad:
    if block.speed is not None and block.torque is not None:
        columns = {"speed": block.speed, "torque": block.torque}
    else:
        text = embedded_text(block.file, block.text, "engine.full_load")
        with _in_file(block.file, "engine.full_load"):
            columns = parse_table(text, {"speed": "speed", "torque": "torque"}, increasing="speed")
    with within("engine.full_load"):
        return FullLoad(tuple(columns["speed"]), tuple(columns["torque"]))


def embedded_text(file: str | None, text: str | None, path: str) -> str:
    """The content of a file that a model refers to, which loading has put beside its name."""
    if text is None:
        remedy = "load the model with load_model, or give its folder"
        raise ModelError("the file is not at hand", where=path, found=repr(file), remedy=remedy)
    return text
