"""`torsional warmup`: every kernel compiled once and kept on disk."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from torsional import __version__, laws
from torsional.cli import map as maps
from torsional.cli import modes, respond
from torsional.cli.answers import print_json
from torsional.cli.documents import amount, json_text
from torsional.cli.progress import progress
from torsional.cli.tables import Column, Table, print_tables
from torsional.files import changed, load_model, starter
from torsional.model import RPM, Model
from torsional.numerics.callbacks import address_of
from torsional.solvers.campbell import campbell
from torsional.solvers.map import HALF_ORDERS, response_map
from torsional.solvers.periodic import model_response, subharmonic_map

Step = tuple[str, Callable[[], object]]


def run(as_json: bool, quiet: bool) -> None:
    """Answer the command."""
    seconds: dict[str, float] = {}
    with progress("compiling", quiet or as_json) as moved:
        todo = list(steps(small_model()))
        for done, (name, work) in enumerate(todo, 1):
            start = time.perf_counter()
            work()
            seconds[name] = time.perf_counter() - start
            moved(done, len(todo))
    if as_json:
        told = {name: amount(value, "time") for name, value in seconds.items()}
        print_json(json_text({"torsional": __version__, "command": "warmup", "times": told}))
    elif not quiet:
        rows = [*seconds.items(), ("together", sum(seconds.values()))]
        print_tables([Table("Kernels are ready", [Column("for"), Column("took", "time")], rows)])


def small_model() -> Model:
    """The starter truck, through the same reader as any other."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "truck.yaml"
        path.write_text(starter("truck"), encoding="utf-8")
        return load_model(path)


def steps(model: Model) -> Iterator[Step]:
    """What the commands do, on a few points each; the kernels are the same for more."""
    gear, peak = model.top_gear, model.full_load_peak()
    speeds, torques = model.speeds(3), model.torques(2)
    yield "modes", lambda: modes.modes_of(model, gear, peak, float(speeds[0]), 3.0)
    yield "campbell", lambda: campbell(model, peak, [gear])
    nodes, elements = [model.landmarks.crankshaft], [*model.landmarks.springs]
    yield "respond", lambda: respond.response(model, gear, speeds, torques[[1, 1, 0]], HALF_ORDERS, nodes, elements)
    yield "map", lambda: maps.reduced(response_map(model, speeds, torques, [gear]), model)
    yield "laws", _laws
    yield "periodic", lambda: _periodic(model)


def _periodic(model: Model) -> None:
    """Branches, a doubled one among them, and the region over speed and torque, of a spring with two stages."""
    staged = changed(
        model,
        {
            "absorber.stiffness": None,
            "absorber.stop_torque": None,
            "absorber.stages": [{"up_to": 1000.0, "stiffness": 8e3}, {"up_to": 3500.0, "stiffness": 24e3}],
        },
    )
    span = (800 * RPM, 1000 * RPM)
    model_response(staged, span, 1200.0)
    subharmonic_map(staged, np.linspace(*span, 5), (1150.0, 1250.0))


def _laws() -> None:
    """The loops over laws once, and the kernel of each."""
    law = laws.Hinges.staged([(1.0, 1.0)], lash=0.1)
    law.march(law.torque(np.linspace(-1.0, 1.0, 5000)), 1.0)
    for kind in (laws.Coulomb, laws.Jenkins, laws.LuGre, laws.Polynomial, laws.Table):
        address_of(kind.kernel)
