"""The engine block as an Engine."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from torsional.engine import (
    ChenFlynn,
    CombustionCycle,
    CrankLayout,
    Engine,
    FullLoad,
    GasSource,
    PressureTrace,
)
from torsional.errors import ModelError
from torsional.files.schema.engine import (
    EngineBlock,
    FullLoadBlock,
    PressureTraceBlock,
)
from torsional.tables import parse_table
from torsional.units import quoted

_RENAMED = {"heat_spread": "cylinder_spread", "pressure": "pressure_trace"}


@contextmanager
def within(path: str) -> Iterator[None]:
    """Errors of what is built inside name the key path, in the model file's words."""
    try:
        yield
    except ModelError as error:
        head, _, rest = error.where.partition(".")
        last = path.rpartition(".")[2]
        if head == last:
            head, rest = rest, ""
        error.where = ".".join(part for part in (_RENAMED.get(head, head), rest) if part)
        raise error.located(prefix=path) from None


def engine(block: EngineBlock) -> Engine:
    """The engine with its gas source, friction and full-load curve; ModelError names the key path."""
    with within("engine.combustion"):
        cycle = block.combustion.made() if block.combustion else CombustionCycle()
    gas: GasSource = _trace(block.pressure_trace) if block.pressure_trace else cycle
    with within("engine.friction"):
        friction = block.friction.made() if block.friction else ChenFlynn()
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
    text = _embedded_text(block.file, block.text, "engine.pressure_trace")
    with _in_file(block.file, "engine.pressure_trace"):
        return PressureTrace.from_text(text, speed=block.speed, offset=block.offset, own_angle=block.own_angle)


def _full_load(block: FullLoadBlock) -> FullLoad:
    if block.speed is not None and block.torque is not None:
        columns = {"speed": block.speed, "torque": block.torque}
    else:
        text = _embedded_text(block.file, block.text, "engine.full_load")
        with _in_file(block.file, "engine.full_load"):
            columns = parse_table(text, {"speed": "speed", "torque": "torque"}, increasing="speed")
    with within("engine.full_load"):
        return FullLoad(tuple(columns["speed"]), tuple(columns["torque"]))


def _embedded_text(file: str | None, text: str | None, path: str) -> str:
    """The content of a file that a model refers to, which loading has put beside its name."""
    if text is None:
        remedy = "load the model with load_model, or give its folder"
        raise ModelError("the file is not at hand", where=path, found=repr(file), remedy=remedy)
    return text
