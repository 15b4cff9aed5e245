"""`torsional fmu`: a model, or its absorber, as a functional mock-up unit."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from torsional.cli import inputs as asked
from torsional.cli.answers import print_json
from torsional.cli.documents import amount, json_text
from torsional.cli.outputs import written
from torsional.cli.request import Request
from torsional.cli.runs import seconds
from torsional.cli.tables import Column, Table, print_tables
from torsional.errors import ModelError
from torsional.exchange.fmu.export import export_fmu
from torsional.exchange.fmu.packing import Packed
from torsional.solvers.transient import engine_drive
from torsional.units import quoted

STEP = 1e-4


def run(
    request: Request,
    absorber: bool,
    inputs: Sequence[str] | None,
    gear: str,
    torque: str,
    speed: str,
    step: str,
    fmi: str,
    sources: bool,
) -> None:
    """Answer the command."""
    common: dict[str, Any] = {"fmi": fmi, "step": seconds(step, "--step", STEP), "compiled": False if sources else None}
    subject, own = (
        _absorber(request, inputs, gear, torque, speed) if absorber else _line(request, inputs, gear, torque, speed)
    )
    told: list[Packed] = []
    written({request.outputs[0]: lambda draft: told.append(export_fmu(subject, draft, **own, **common))})
    _tell(request, request.outputs[0], told[0], fmi)


def _absorber(
    request: Request, inputs: Sequence[str] | None, gear: str, torque: str, speed: str
) -> tuple[Any, dict[str, Any]]:
    """The absorber, which knows nothing of the rest of the line."""
    for option, value in (("--input", inputs), ("--gear", gear), ("--torque", torque), ("--speed", speed)):
        if value:
            found = quoted(value if isinstance(value, str) else value[0])
            raise ModelError("an absorber alone has no such thing", where=option, found=found, remedy="leave it out")
    if request.model.absorber is None:
        raise ModelError("the model has no absorber block", where="absorber", remedy="leave --absorber out")
    return request.model.absorber, {"name": f"{request.model.name}, {request.model.absorber.kind}"}


def _line(
    request: Request, inputs: Sequence[str] | None, gear: str, torque: str, speed: str
) -> tuple[Any, dict[str, Any]]:
    """The line in a gear at a mean speed, its engine's orders within where a mean torque is named."""
    model = request.model
    at = asked.speed(model, speed)
    own: dict[str, Any] = {"gear": asked.one_gear(model, gear), "speed": at, "inputs": inputs}
    if torque:
        mean = asked.torque(model, torque, [at])
        own |= {"drives": engine_drive(model, at, mean), "hold": model.landmarks.load}
    return model, own


def _tell(request: Request, path: Path, found: Packed, fmi: str) -> None:
    """What was written."""
    counts = {"inputs": found.inputs, "parameters": found.parameters, "outputs": found.outputs}
    if request.as_json:
        document = {"command": "fmu", "file": str(path), "fmi": fmi, "size": {"value": found.size, "units": "byte"}}
        print_json(
            json_text({**document, "platform": found.compiled or None, "step": amount(found.step, "time"), **counts})
        )
    elif not request.quiet:
        rows: list[tuple[str, str]] = [("file", str(path)), ("FMI", f"{fmi}, co-simulation")]
        rows += [("size", f"{found.size / 1000:.0f} kB"), ("step of time", f"{found.step:g} s at most")]
        rows += [("compiled for", found.compiled or "nothing; the sources are in it")]
        rows += [
            (name, ", ".join(names[:3] or ["none"]) + (f" … {len(names)} in all" if len(names) > 3 else ""))
            for name, names in counts.items()
        ]
        print_tables([Table("Functional mock-up unit", [Column("what"), Column("value")], rows)])
