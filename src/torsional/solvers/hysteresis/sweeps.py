"""Hysteresis loops: the torque between two nodes while one is turned slowly to and fro against the other."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.numerics.quasi_static.loops import (
    half_swing,
    harmonic_stiffness,
    loss_factor,
    loss_per_cycle,
    secant_stiffness,
)
from torsional.results import dataset
from torsional.solvers.hysteresis.bench import Bench, on_bench
from torsional.solvers.hysteresis.courses import Course, Run, mounted, run
from torsional.system import BoolArray, Connections, System, assemble

RATE = np.radians(3.0)
"""Pace of the sweep [rad/s]: 3°/s, as rigs that measure the characteristic have it."""
SAMPLES = 720
"""Steps of one cycle."""
CYCLES = 10
"""Cycles after which a loop that does not close is taken as it is."""
CLOSED = 1e-4
"""What the torque of two cycles may differ by, over the largest."""
NOTHING = 1e-5
"""Share of the largest torque of all loops below which there is none to speak of."""
MOVES = 0.01
"""Share of the sweep by which a rubbing part without memory must swing to count as sliding."""


@checked
def hysteresis(
    system: System,
    turned: str,
    held: str,
    speed: ArrayLike,
    sweep: ArrayLike,
    *,
    rate: float = RATE,
    centre: float = 0.0,
    samples: int = SAMPLES,
    progress: Callable[[int, int], None] | None = None,
) -> xr.Dataset:
    """Loops of the torque at a node ``turned`` against ``held``, both going round at a mean ``speed`` [rad/s].

    The relative angle θ_turned − θ_held goes to and fro by ± each ``sweep`` [rad] about ``centre`` [rad], at a
    constant ``rate`` [rad/s], from a relaxed state until the loop closes.  Inertia plays no part; friction remembers;
    normal loads follow the speed of the reference node and the springs.  What acts only on one side of the two nodes,
    or against the ground, is left out.  ``samples`` steps a cycle, of backward Euler; ``progress`` is told (done, all).

    Gives over ``speed``, ``sweep`` and ``cycle`` ("first", "closed"): ``drive_torque`` at ``turned`` over ``sample``,
    ``angle`` of nodes relative to ``held``, ``twist``, ``torque`` and ``normal_load`` of elements; and of the closed
    loop its ``loss``, ``stiffness`` (chord between the turning points), ``harmonic_stiffness`` and ``loss_factor`` as
    `torsional.numerics.quasi_static.loops` defines them, the loss of each element, and which rubbing elements slide.
    Raises ModelError for nodes that turn at different speeds or with nothing between, sweeps and rates that are not
    positive, and where no balance is found.

    >>> from torsional.components import Coupling, Inertia, Shaft
    >>> from torsional.laws import Jenkins
    >>> from torsional.powertrain import Powertrain
    >>> parts = {"a": Inertia(1.0), "b": Inertia(1.0), "spring": Shaft("b", "a", 1000.0)}
    >>> parts["washer"] = Coupling("b", "a", Jenkins(5.0, 1e4))
    >>> loop = hysteresis(assemble(Powertrain(parts)), "a", "b", 0.0, 0.1)
    >>> round(loop.loss.item(), 2), round(4 * 5.0 * (0.1 - 5.0 / 1e4), 2)
    (1.99, 1.99)
    """
    speeds, sweeps = (np.atleast_1d(np.asarray(v, dtype=float)) for v in (speed, sweep))
    _checked(speeds, sweeps, rate, samples)
    bench = on_bench(system, turned, held)
    parts = mounted(bench)
    runs: list[list[Run]] = []
    for done, w in enumerate(speeds):
        courses = (_course(w, a, rate, centre, samples) for a in sweeps)
        runs.append([run(bench, parts, course, most=CYCLES, closed=CLOSED) for course in courses])
        if progress:
            progress(done + 1, len(speeds))
    return _told(bench, runs, speeds, sweeps, (turned, held), rate=rate, centre=centre)


@checked
def model_hysteresis(
    model: Model,
    speed: ArrayLike,
    sweep: ArrayLike,
    *,
    gear: str | int | None = None,
    turned: str = "",
    held: str = "",
    rate: float = RATE,
    centre: float = 0.0,
    samples: int = SAMPLES,
) -> xr.Dataset:
    """`hysteresis` of a model's absorber: from the ``crankshaft`` landmark to the node that carries the clutch.

    The absorber is taken in its detail where the model has one.  ``turned`` and ``held`` name other nodes.
    Raises ModelError for a model without these places.

    ``speed`` [rad/s], ``sweep``, ``centre`` [rad] and ``rate`` [rad/s] as in `hysteresis`.

    >>> import torsional
    >>> truck = torsional.load_model("examples/truck_dmf.yaml")
    >>> float(model_hysteresis(truck, 0.0, 0.1).stiffness.round().item())  # Nm/rad: 13e3 + 20 Nms/rad · 3°/s over 0.1
    13010.0
    """
    first, last = absorber_ends(model)
    system = assemble(model.detailed().powertrain(gear))
    told = hysteresis(system, turned or first, held or last, speed, sweep, rate=rate, centre=centre, samples=samples)
    return told.assign_attrs(model=model.name, hash=model.hash)


def absorber_ends(model: Model) -> tuple[str, str]:
    """The nodes before and behind the absorber; an empty name where the model does not say."""
    marks = model.landmarks
    part = model.components.get(marks.clutch)
    weights = next(iter(part.stamps(marks.clutch))).weights if part is not None else {}
    return marks.crankshaft, next((node for node, weight in weights.items() if weight > 0), "")


def _checked(speeds: Array, sweeps: Array, rate: float, samples: int) -> None:
    for values, where, unit in ((sweeps, "sweep", "rad"), (np.array([rate]), "rate", "rad/s")):
        if not (np.isfinite(values).all() and (values > 0).all()):
            raise ModelError("must be positive", where=where, found=f"{values.min():g} {unit}", allowed="> 0")
    if not np.isfinite(speeds).all():
        raise ModelError("must be finite", where="speed")
    if samples < 8 or samples % 4:
        raise ModelError("a cycle has four equal parts", where="samples", found=str(samples), allowed="8, 12, 16, …")


def swept(sweep: float, centre: float, samples: int) -> Array:
    """One cycle of the angle [rad] as a triangle, up first, its start left out.

    >>> swept(1.0, 0.0, 8).tolist()
    [0.5, 1.0, 0.5, 0.0, -0.5, -1.0, -0.5, 0.0]
    """
    quarter = samples // 4
    corners = np.repeat([0.0, sweep, 0.0, -sweep], quarter), np.repeat([sweep, 0.0, -sweep, 0.0], quarter)
    share = np.tile(np.arange(1, quarter + 1) / quarter, 4)
    return np.asarray(centre + corners[0] + (corners[1] - corners[0]) * share)


def _course(speed: float, sweep: float, rate: float, centre: float, samples: int) -> Course:
    return Course(speed, swept(sweep, centre, samples), 4.0 * sweep / (rate * samples), centre, sweep, rate)


def _told(
    bench: Bench,
    runs: Sequence[Sequence[Run]],
    speeds: Array,
    sweeps: Array,
    ends: tuple[str, str],
    **settings: float,
) -> xr.Dataset:
    c = bench.system.connections
    place, element_torque, load = (np.array([[run[i] for run in row] for row in runs]) for i in range(3))
    twist = place @ c.weights.T
    torque, drive = element_torque @ c.weights[:, -1], place[0, :, 1, :, -1]
    closed = torque[:, :, 1]
    loss, stiffness = loss_per_cycle(drive, closed), secant_stiffness(drive, closed)
    relative = loss_factor(loss, stiffness, half_swing(drive))
    every, grid = ("speed", "sweep", "cycle", "sample"), ("speed", "sweep")
    slides = _slides(c, twist[:, :, 1], sweeps)
    return dataset(
        {
            "drive_torque": (every, torque, "torque"),
            "drive_angle": (("sweep", "sample"), drive, "relative_angle"),
            "angle": ((*every, "node"), place @ bench.places.T, "angle"),
            "twist": ((*every, "element"), twist, "relative_angle"),
            "torque": ((*every, "element"), element_torque, "torque"),
            "normal_load": ((*every, "element"), np.where([bool(x) for x in c.loads], load, np.nan), "force"),
            "loss": (grid, loss, "energy"),
            "stiffness": (grid, stiffness, "stiffness"),
            "harmonic_stiffness": (grid, harmonic_stiffness(drive, closed), "stiffness"),
            "loss_factor": (grid, np.where(_carries(closed), relative, np.nan), "loss_factor"),
            "element_loss": ((*grid, "element"), _element_loss(twist[:, :, 1], element_torque[:, :, 1]), "energy"),
            "slides": ((*grid, "element"), slides.astype(np.int8), "number"),
            "sliding": (grid, slides.sum(axis=-1), "number"),
            "cycles": (grid, np.array([[run.cycles for run in row] for row in runs]), "number"),
            "closure": (grid, np.array([[run.closure for run in row] for row in runs]), "ratio"),
        },
        {
            "speed": (speeds, "speed"),
            "sweep": (sweeps, "relative_angle"),
            "cycle": (np.array(["first", "closed"]), ""),
            "node": (np.array(bench.nodes), ""),
            "element": (np.array(c.names), ""),
            "rubs": (rubbing(c).astype(np.int8), "", "element"),
        },
        analysis="hysteresis",
        turned=ends[0],
        held=ends[1],
        **settings,
    )


def _carries(torque: Array) -> BoolArray:
    """Whether loops (…, sample) carry torque at all, and are not within the free play."""
    largest = np.abs(torque).max(axis=-1)
    return np.asarray(largest > NOTHING * largest.max())


def _element_loss(twist: Array, torque: Array) -> Array:
    return loss_per_cycle(np.moveaxis(twist, -1, -2), np.moveaxis(torque, -1, -2))


def rubbing(c: Connections) -> BoolArray:
    """Which connections rub: those whose law holds no torque at rest."""
    return np.array([law is not None and not law.carries_mean_torque for law in c.laws], dtype=bool)


def _slides(c: Connections, twist: Array, sweeps: Array) -> BoolArray:
    """Which rubbing elements slide within the closed cycle (speed, sweep, element), by the swing of their twist.

    One with memory slides where it swings more than its own elastic deflection, another where it moves at all.
    """
    low, high = twist.min(axis=-2), twist.max(axis=-2)
    found = np.zeros(low.shape, dtype=bool)
    for i in np.flatnonzero(rubbing(c)):
        law = c.laws[i]
        assert law is not None
        far = law.changes_within(low[..., i], high[..., i]) if law.remembers else np.ones(low.shape[:2], dtype=bool)
        found[..., i] = far & (high[..., i] - low[..., i] > (0.0 if law.remembers else MOVES) * 2 * sweeps)
    return found
