"""The sources of a unit in C: translated kernels, the plan's numbers, tables of variables, what is the same in all."""

from __future__ import annotations

import hashlib
import uuid
from collections.abc import Iterator, Mapping, Sequence
from importlib import resources
from typing import Any

import numpy as np

from torsional.exchange.fmu.unit import Unit
from torsional.exchange.translation.kinds import DOUBLE, Block, kind_of
from torsional.exchange.translation.program import Program
from torsional.exchange.translation.terms import number
from torsional.numerics.stepping.loop import new_work, run
from torsional.numerics.stepping.marching import blank_records, typed
from torsional.numerics.stepping.restart import restart

ENTRY = "all.c"
"""The one file that is compiled; the others are included by it."""


class Image:
    """Arrays of all kinds end to end, and the lines of C that bind them."""

    def __init__(self) -> None:
        self.doubles: list[float] = []
        self.wholes: list[int] = []
        self.lines: list[str] = []
        self.place: dict[str, int] = {}

    def bind(self, path: str, value: Any) -> None:
        """Lay a value down, tuples field by field."""
        if hasattr(value, "_fields"):
            for name in value._fields:
                self.bind(f"{path}.{name}", getattr(value, name))
        elif isinstance(value, tuple):
            for i, part in enumerate(value):
                self.bind(f"{path}._{i}", part)
        elif isinstance(value, np.ndarray):
            self._array(path, value)
        else:
            self.lines.append(f"m->{path} = {number(value).text};")

    def _array(self, path: str, value: np.ndarray[Any, Any]) -> None:
        kind = kind_of(value)
        assert isinstance(kind, Block)
        memory, letter = (self.doubles, "d") if kind.item is DOUBLE else (self.wholes, "i")
        self.place[path] = len(memory)
        self.lines.append(
            f"m->{path} = ({kind.name}){{m->{letter} + {len(memory)}, {{{', '.join(map(str, value.shape))}}}}};"
        )
        memory += value.ravel().tolist()


def sources_of(unit: Unit, version: str) -> dict[str, str]:
    """The files of the sources by name."""
    kept = ("runtime.h", "core.h", "states.h", f"fmi{version[0]}.h")
    told = {name: resources.files("torsional.exchange").joinpath("sources", name).read_text("utf-8") for name in kept}
    told["model.h"] = _model(unit)
    return told


def token_of(sources: Mapping[str, str], version: str) -> str:
    """What tells these sources from all others, as FMI wants it."""
    whole = "".join(sources[name] for name in sorted(sources))
    return str(uuid.UUID(hashlib.sha256(f"{version} {whole}".encode()).hexdigest()[:32]))


def entry_of(sources: Mapping[str, str], token: str) -> str:
    """The file that is compiled."""
    face = next(name for name in sources if name.startswith("fmi"))  # which takes states.h itself
    ordered = ("runtime.h", "model.h", "core.h", face)
    return f'#define TOKEN "{token}"\n' + "".join(f'#include "{name}"\n' for name in ordered)


def _model(unit: Unit) -> str:
    """What is generated."""
    program, image, method = Program(), Image(), unit.accuracy.family
    numbers = (method.alpha_m, method.alpha_f, method.beta, method.gamma)
    given: dict[str, Any] = {
        "plan": unit.plan,
        "state": unit.state,
        "work": new_work(unit.plan, unit.state),
        "settings": typed(unit.accuracy.settings),
        "method": numbers,
        "at": np.zeros(0, dtype=np.int64),
        "records": blank_records(unit.plan, 0),
        "mobility": np.zeros((unit.plan.tape.node.size,) * 2),
    }
    kinds = {name: kind_of(value) for name, value in given.items()}
    for name, value in given.items():
        image.bind(name, value)
    program.laws(unit.kernels)
    step = [DOUBLE, kind_of(1), kinds["at"], kinds["records"]]
    program.function(run, [*(kinds[name] for name in ("plan", "state", "work", "settings", "method")), *step])
    if unit.restarts:
        program.function(restart, [*(kinds[name] for name in ("plan", "state", "work", "mobility")), DOUBLE])
    fields = " ".join(f"{kind.name} {name};" for name, kind in kinds.items())
    lines = [
        program.text,
        *_sizes(unit),
        f"typedef struct {{ double *d; int64_t *i; double given[GIVEN + 1], time; {fields} }} Machine;",
        "static void machine_bind(Machine *m)\n{",
        *("    " + line for line in image.lines),
        "}",
        *_tables(unit, image),
    ]
    return "\n".join(lines) + "\n"


def _sizes(unit: Unit) -> Iterator[str]:
    sizes = {
        "INPUTS": len(unit.inputs),
        "PARAMETERS": len(unit.parameters) + 1,
        "OUTPUTS": len(unit.outputs),
        "PORTS": len(unit.sides),
        "RESTARTS": int(unit.restarts),
        "COORDINATES": unit.plan.tape.node.size,
        "CONNECTIONS": unit.plan.constants.shape[1],
    }
    yield from (f"#define {name} {value}" for name, value in sizes.items())
    yield "#define GIVEN (INPUTS + PARAMETERS)"
    yield "#define STEP (GIVEN - 1)"


def _tables(unit: Unit, image: Image) -> Iterator[str]:
    starts = [v.start for v in unit.inputs] + [v.start for v, _ in unit.parameters] + [unit.accuracy.step]
    slopes = [[(image.place[s.array] + s.place, s.weight) for s in own] for _, own in unit.parameters] + [[]]
    parts = [[(p.place, p.weight) for p in own] for _, own in unit.outputs]
    levels = [image.place["plan.outside.knots"] + place for place in unit.levels]
    yield _table("double", "image_d", image.doubles)
    yield _table("int64_t", "image_i", image.wholes)
    yield _table("double", "start_value", starts)
    yield _table("int64_t", "input_place", levels)
    yield _table("int64_t", "port_coordinate", unit.sides)
    for name, listed, own in (("parameter", slopes, "place"), ("output", parts, "of")):
        yield _table("int64_t", f"{name}_start", np.cumsum([0, *map(len, listed)]).tolist())
        yield _table("int64_t", f"{name}_{own}", [place for each in listed for place, _ in each])
        yield _table("double", f"{name}_weight", [weight for each in listed for _, weight in each])


def _table(kind: str, name: str, values: Sequence[float]) -> str:
    """A table of numbers, one at least, since C has none of none."""
    told = [number(value).text for value in values] or ["0"]
    lines = [", ".join(told[k : k + 8]) for k in range(0, len(told), 8)]
    return f"static const {kind} {name}[] = {{\n" + ",\n".join(lines) + "};"
