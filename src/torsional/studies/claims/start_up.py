"""The claim about engine starts through the resonance of a dual mass flywheel (G2)."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from torsional.model import Model
from torsional.studies.answers import falling, floats
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.starts import (
    Peaks,
    histories,
    moments,
    passed,
    resonance,
    run_up,
    spring_of,
    sprung,
    start,
    started,
    starter,
    stop_angle,
)
from torsional.studies.trucks import Trucks, replaced, stiffness
from torsional.units import RPM

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture

RAMP, STARTER = "time from a third of idle to idle [s]", "starter speed [rpm]"
STIFFNESS, DAMPING = "stiffness [kNm/rad]", "damping [Nms/rad]"
RAMPS = (3.2, 0.8, 0.2, 0.1)
STARTERS = (3 / 12, 5 / 12, 7 / 12)
"""Over idle."""
STIFFNESSES = (13.0, 9.0, 6.0, 3.0)
"""Over a thirteenth of the model's."""
DAMPINGS = (0.5, 1.0, 2.0)
"""Over the model's."""
FACTORS = (1.0, 2.0, 4.0)
"""Of inertias."""
FAST = 3 / 4
"""Over idle, of a starter that turns faster than the resonance of softer springs, against compression too."""
LEADING = "largest angle, slowest run-up over the fastest [-]"


CONDITION = (
    "one-stage DMF, gearbox in neutral, cylinders burning over the crank's own angle, starts averaged over the moment "
    "of the first firing; run-ups by an ideal drive, whose torque follows the speed weakly; other stiffnesses up to a "
    "stop at the same torque; steps of 0.4 ms in starts, which change no peak by more than 0.1 %"
)
PROVISO = (
    "softer springs help by what they pass on, their peak torque and the gearbox's acceleration, and by the share of "
    "the way to a stop at the same torque; by the angle itself a lower resonance helps only where more inertia on the "
    "crankshaft lowers it, or while it falls below the starter's speed"
)


def rates(model: Model) -> tuple[float, ...]:
    """Stiffnesses that are asked [Nm/rad]."""
    own = stiffness(model, spring_of(model))
    return tuple(own * part / STIFFNESSES[0] for part in STIFFNESSES)


def dampings(model: Model) -> tuple[float, ...]:
    """Dampings beside the springs that are asked [Nms/rad]."""
    coupling: Any = model.components[spring_of(model)]
    return tuple(factor * coupling.damping for factor in DAMPINGS)


def drawn(data: xr.Dataset) -> Picture:
    """The springs' angle in the runs that are compared, a panel for each parameter."""
    from torsional.plots.histories import plot_histories

    return plot_histories(data)


@claim(
    "G2",
    "3.3",
    "An engine start passes the resonance of the DMF with high amplitudes; faster acceleration, a higher starter "
    "speed, a lower resonance and more damping help.",
    "in time, the largest angle of the DMF falls from the first to the last value of each: time of a run-up at "
    "constant engine torque, speed of the starter, stiffness of the springs, their damping; where it does not, peak "
    "torque, gearbox acceleration and share of the way to the stop are told beside it",
    varies="time of a run-up, speed of the starter, stiffness of the springs, their damping; inertias beside them",
    picture=drawn,
    leading=LEADING,
    trucks=20,
)
def g2(trucks: Trucks) -> Finding:
    model = trucks.dmf
    own = cache(lambda: started(model))
    idle = model.operation.idle
    ask: dict[str, tuple[Sequence[float], Callable[[float], Peaks]]] = {
        RAMP: (RAMPS, lambda time: passed(model, time)),
        STARTER: (
            tuple(round(part * idle / RPM, 9) for part in STARTERS),
            lambda rpm: started(model, *starter(model, rpm * RPM / idle)),
        ),
        STIFFNESS: (tuple(rate / 1e3 for rate in rates(model)), lambda rate: started(sprung(model, 1e3 * rate))),
        DAMPING: (dampings(model), lambda damping: own() if damping == dampings(model)[1] else damped(model, damping)),
    }
    found = {name: [question(value) for value in values] for name, (values, question) in ask.items()}
    figures: dict[str, Figure] = {}
    for name, (values, _) in ask.items():
        angles = [each.angle for each in found[name]]
        figures |= {name: tuple(values), f"largest angle [deg], {name.split(' [')[0]}": floats(angles)}
    figures[LEADING] = found[RAMP][0].angle / found[RAMP][-1].angle
    lower = softer(model, found[STIFFNESS])
    passed_on = all(falling(np.array(values, dtype=float)) for values in lower.values())
    helps = {name: row[-1].angle < row[0].angle for name, row in found.items()}
    others = all(helped for name, helped in helps.items() if name != STIFFNESS)
    reason = "" if all(helps.values()) else _reason(helps)
    good = others and (helps[STIFFNESS] or passed_on)
    told = [PROVISO] if good and not helps[STIFFNESS] else []
    told += [_turning(name, row) for name, row in found.items() if good and helps[name] and _turns(row)]
    return Finding(good, CONDITION, figures | lower | elsewhere(model, own()), reason, compared(model), "; ".join(told))


def _turns(row: Sequence[Peaks]) -> bool:
    """Whether the angle falls from the first to the last value, but not at every step."""
    return not falling(np.array([each.angle for each in row]))


def _turning(name: str, row: Sequence[Peaks]) -> str:
    angles = ", ".join(f"{each.angle:.2f}" for each in row)
    return f"the {name.split(' [')[0]} helps between the ends of what is asked, not at every step: {angles} deg"


def damped(model: Model, damping: float) -> Peaks:
    """Of starts with another damping beside the springs [Nms/rad]."""
    return started(replaced(model, spring_of(model), damping=damping))


def compared(model: Model) -> xr.Dataset:
    """Angles of the springs in the runs that are compared, the first of the starts that are averaged."""
    first, spring = float(moments()[0]), spring_of(model)
    starters = [part * model.operation.idle for part in STARTERS]
    return histories(
        model,
        {
            "run_up": ("time", RAMPS, [run_up(model, time) for time in RAMPS]),
            "starter_speed": ("speed", starters, [start(model, first, *starter(model, part)) for part in STARTERS]),
            "stiffness": ("stiffness", rates(model), [start(sprung(model, rate), first) for rate in rates(model)]),
            "damping": (
                "damping",
                dampings(model),
                [start(replaced(model, spring, damping=damping), first) for damping in dampings(model)],
            ),
        },
    )


def softer(model: Model, found: Sequence[Peaks]) -> dict[str, Figure]:
    """Of starts with softer springs: where the resonance lies, and peaks other than the angle."""
    models = [sprung(model, rate) for rate in rates(model)]
    return {
        "firing order at the resonance [rpm], stiffness": floats([resonance(each) for each in models]),
        "peak torque of the DMF [Nm], stiffness": floats([each.torque for each in found]),
        "peak acceleration of the gearbox input [rad/s²], stiffness": floats([each.acceleration for each in found]),
        "over the angle of a stop at the same torque [-], stiffness": floats(
            [each.angle / stop_angle(varied) for each, varied in zip(found, models, strict=True)]
        ),
    }


def elsewhere(model: Model, own: Peaks) -> dict[str, Figure]:
    """A starter faster than the resonance, a resonance lowered by inertia, and other dampings with softer springs;
    ``own``: of the model as it is."""
    fast = starter(model, FAST)
    figures: dict[str, Figure] = {
        "largest angle from the first firing on [deg], stiffness, fast starter": floats(
            [started(sprung(model, rate), *fast, burning=True).angle for rate in rates(model)]
        )
    }
    for name, node in (("primary", model.landmarks.crankshaft), ("secondary", secondary(model))):
        body: Any = model.components[node]
        heavier = [replaced(model, node, inertia=factor * body.inertia) for factor in FACTORS]
        angles = [own, *(started(each) for each in heavier[1:])]
        figures |= {
            f"firing order at the resonance [rpm], inertia of {name} times 1, 2, 4": floats(
                [resonance(each) for each in heavier]
            ),
            f"largest angle [deg], inertia of {name} times 1, 2, 4": floats([each.angle for each in angles]),
        }
    for damping in (dampings(model)[0], dampings(model)[-1]):
        ends = (rates(model)[0], rates(model)[-1])
        both = [damped(sprung(model, rate), damping) for rate in ends]
        at = f"stiffness {ends[0] / 1e3:g} and {ends[1] / 1e3:g} kNm/rad, damping {damping:g} Nms/rad"
        figures |= {
            f"largest angle [deg], {at}": floats([each.angle for each in both]),
            f"peak torque of the DMF [Nm], {at}": floats([each.torque for each in both]),
        }
    return figures


def secondary(model: Model) -> str:
    """The node behind the absorber's springs."""
    spring: Any = model.components[spring_of(model)]
    return str(next(node for node in (spring.a, spring.b) if node != model.landmarks.crankshaft))


def _reason(helps: Mapping[str, bool]) -> str:
    told = [f"the {name.split(' [')[0]} does not help by the angle" for name, helped in helps.items() if not helped]
    if not helps[STIFFNESS]:
        told.append(
            "the first strokes and the crank's own acceleration turn springs by a torque over their stiffness, which "
            "grows faster than the resonance's share falls; more inertia of the secondary adds to that torque"
        )
    return "; ".join(told)
