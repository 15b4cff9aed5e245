"""`torsional warmup`: every kernel compiled once and kept on disk."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from torsional import __version__, laws
from torsional.cli import map as maps
from torsional.cli import respond
from torsional.cli.answers import print_json
from torsional.cli.documents import amount, json_text
from torsional.cli.progress import progress
from torsional.cli.tables import Column, Table, print_tables
from torsional.components import Component, Coupling, Inertia
from torsional.engine import Excitation
from torsional.engine.orders import HALF_ORDERS
from torsional.files import changed, load_model, starter
from torsional.model import Model
from torsional.numerics.callbacks import address_of
from torsional.numerics.compiling import WATCH
from torsional.powertrain import Powertrain
from torsional.quantities.modes import modes_of
from torsional.solvers.campbell import campbell
from torsional.solvers.hysteresis import hysteresis
from torsional.solvers.map import response_map
from torsional.solvers.periodic import model_response, periodic_response, subharmonic_map
from torsional.solvers.transient import SpeedProfile, engine_drive, steady_map, transient
from torsional.studies.scenarios.run_up import run_up
from torsional.system import assemble
from torsional.units import RPM

Step = tuple[str, Callable[[], object]]
_STAGES = laws.Hinges(1.0, (1.0,), (1.0,), (1.0,))


def run(as_json: bool, quiet: bool) -> None:
    """Answer the command."""
    seconds: dict[str, float] = {}
    with WATCH.silent(), progress("compiling", quiet or as_json) as moved:
        todo = list(steps(_small_model()))
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


def _small_model() -> Model:
    """The starter truck, through the same reader as any other."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "truck.yaml"
        path.write_text(starter("truck"), encoding="utf-8")
        return load_model(path)


def steps(model: Model) -> Iterator[Step]:
    """What the commands do, on a few points each; the kernels are the same for more."""
    gear, peak = model.top_gear, model.full_load_peak()
    speeds, torques = model.speeds(3), model.torques(2)
    yield "modes", lambda: modes_of(model, gear, peak, float(speeds[0]), 3.0)
    yield "campbell", lambda: campbell(model, peak, [gear])
    nodes, elements = [model.landmarks.crankshaft], [*model.landmarks.springs]
    yield "respond", lambda: respond.response(model, gear, speeds, torques[[1, 1, 0]], HALF_ORDERS, nodes, elements)
    yield "map", lambda: maps.reduced(response_map(model, speeds, torques, [gear]), model)
    yield "laws", _laws
    yield "periodic", lambda: _periodic(model)
    yield "isolated", lambda: _one_disc(_STAGES, isolated=True)
    yield "smooth", lambda: _one_disc(laws.Polynomial((1.0, 0.0, 0.5)))
    yield "hysteresis", _slow_sweep
    yield "friction", lambda: _one_disc(_STAGES, laws.Jenkins(0.1, 1.0))
    yield "transient", lambda: _run_up(model)
    yield "settled", lambda: steady_map(model, speeds[:1], torques[:1], [gear], most_periods=4)
    yield "explicit", lambda: _explicit(model)


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


def _one_disc(*beside: laws.Law, isolated: bool = False) -> None:
    """Branches of one disc on springs beside each other: the kernels that `_periodic` does without."""
    parts: dict[str, Component] = {"disc": Inertia(1.0)}
    parts |= {f"spring{i}": Coupling("ground", "disc", law, damping=0.04) for i, law in enumerate(beside)}
    system = assemble(Powertrain(parts))
    drive = Excitation(("disc",), np.array([0.0, 1.0]), np.array(1.0), np.ones((1, 2), dtype=complex))
    periodic_response(system, drive, (2.0, 2.5), highest_order=3.0, isolated=isolated)


def _run_up(model: Model) -> None:
    """A few steps in time."""
    run_up(model, SpeedProfile.constant(100.0), 0.5 * model.full_load_peak(), 0.01)


def _explicit(model: Model) -> None:
    """A few explicit steps."""
    drive = engine_drive(model, 100.0, 0.5 * model.full_load_peak())
    transient(assemble(model.powertrain()), drive, 1e-3, speed=100.0, hold=model.landmarks.load, method="explicit")


def _slow_sweep() -> None:
    """One loop of a disc on a spring with a washer."""
    beside: dict[str, Component] = {"disc": Inertia(1.0), "hub": Inertia(1.0)}
    beside |= {"spring": Coupling("hub", "disc", _STAGES), "washer": Coupling("hub", "disc", laws.Jenkins(0.1, 1.0))}
    hysteresis(assemble(Powertrain(beside)), "disc", "hub", 0.0, 2.0)


def _laws() -> None:
    """The loops over laws once, and the kernel of each."""
    law = laws.Hinges.staged([(1.0, 1.0)], lash=0.1)
    law.march(law.torque(np.linspace(-1.0, 1.0, 5000)), 1.0)
    for kind in (
        laws.Contacts,
        laws.Coulomb,
        laws.Jenkins,
        laws.Karnopp,
        laws.LuGre,
        laws.Polynomial,
        laws.Stribeck,
        laws.Table,
    ):
        address_of(kind.kernel)
