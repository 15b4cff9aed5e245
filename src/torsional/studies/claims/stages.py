"""The claim about one and two stages of a dual mass flywheel over mean torque (A12)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.laws import Hinges
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities import acceleration, swing
from torsional.results import labelled
from torsional.solvers.periodic import model_response
from torsional.studies.answers import by_idle, by_peak, floats, span
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.stiffness_step import stages, transition_torque
from torsional.studies.trucks import Trucks, hinged, replaced
from torsional.units import RPM

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture

TORQUES = np.arange(250.0, 2501.0, 250.0)
SPEEDS = np.arange(700.0, 1901.0, 50.0) * RPM
"""Mean torques [Nm] and speeds [rad/s] of the shipped truck; those of others follow full load's peak and idle."""
LOW = 0.6
"""Mean torques up to this share of the transition count as low."""
CONDITION = (
    "top gear, mean torques and speeds within full load; acceleration at the gearbox input, half peak-to-peak, the "
    "largest of the stable motions; all three with the travel of the two-stage DMF"
)


def designs(model: Model) -> dict[str, Model]:
    """One stage with the first stiffness, one with the second, both with the two-stage model's travel; that model."""
    spring = model.landmarks.springs[0]
    law = hinged(model, spring)
    travel, beyond = max(law.stops), float(law.tangent(2 * max(law.stops)))
    single = {
        name: replaced(model, spring, law=Hinges.staged([(k * travel, k)], stop_stiffness=beyond))
        for name, k in zip(("soft", "stiff"), stages(model), strict=True)
    }
    return {**single, "two-stage": model}


def row(model: Model, torque: float) -> tuple[Array, Array]:
    """Swing of the input acceleration [rad/s²] and largest DMF twist over the stop's under one mean torque, at `SPEEDS`
    moved with the truck's idle.

    Not a number beyond full load, and where no stable motion was found.
    """
    speeds = by_idle(model, SPEEDS)
    inside = speeds[model.running_engine.full_load_torque(speeds) >= torque]
    table = np.full((2, SPEEDS.size), np.nan)
    if not inside.size:
        return table[0], table[1]
    try:
        found = model_response(model, (inside[0], inside[-1]), torque, depth=1, at=inside)
    except ModelError:
        return table[0], table[1]
    found = found.isel(point=found.stable.values)
    if not found.point.size:
        return table[0], table[1]
    spring, stop = model.landmarks.springs[0], max(hinged(model, model.landmarks.springs[0]).stops)
    loud = swing(acceleration(found.angle.sel(node=model.landmarks.input))).values
    reach = largest(found.twist.sel(element=spring)) / stop
    for place, speed in enumerate(speeds):
        here = np.isclose(found.speed.values, speed, rtol=1e-9)
        if here.any():
            table[:, place] = loud[here].max(), reach[here].max()
    return table[0], table[1]


def largest(orders: xr.DataArray) -> Array:
    """Largest value of signals over two turns of the crank, the mean in it."""
    values = orders.transpose("point", "order")
    turns = np.exp(1j * np.outer(values.order.values, np.linspace(0, 4 * np.pi, 721)))
    return np.asarray((values.values @ turns).real.max(axis=1))


def mapped_stages(data: xr.Dataset) -> Picture:
    """The maps of the three designs, and their largest twist over mean torque."""
    from torsional.plots import plot_design_maps

    return plot_design_maps(data)


@claim(
    "A12",
    "2.2.1",
    "Two stages: low stiffness at low mean torque gives low vibration, high stiffness at high torque avoids bottoming.",
    "below 60 % of the transition's torque the two-stage DMF vibrates as the soft one (within 1 %) and less than the "
    "stiff one at every speed; it carries the peak of full load short of its stop, which the soft one cannot; cells in "
    "which its swing about the mean meets the stop all the same, or in which it is louder than the stiff one (by more "
    "than 1 %), are the condition",
    varies="mean torque from 10 to 100 % of full load's peak in steps of 10 %, engine speed from 7/6 to 19/6 of idle "
    "in 25 steps; one soft stage, one stiff stage, two stages",
    picture=mapped_stages,
    leading="two-stage over stiff below 60 % of the transition, largest [-]",
    trucks=40,
)
def a12(trucks: Trucks) -> Finding:
    model = trucks.two_stage
    variants, torques = designs(model), by_peak(model, TORQUES)
    tables = {name: np.array([row(m, float(t)) for t in torques]) for name, m in variants.items()}
    loud, reach = ({name: found[:, i] for name, found in tables.items()} for i in (0, 1))
    low = transition_torque(model) * LOW >= torques
    if not np.isfinite(loud["two-stage"][low]).any():
        told = {"found": f"{transition_torque(model):g} Nm", "remedy": "raise the torque of the first stage"}
        raise ModelError("no mean torque asked lies well below the transition", where="absorber.stages", **told)
    alike = float(np.nanmax(np.abs(loud["two-stage"][low] / loud["soft"][low] - 1)))
    gain = loud["two-stage"] / loud["stiff"]
    figures: dict[str, Figure] = {
        "mean torques [Nm]": floats(torques),
        "two-stage over stiff, median over speed [-]": floats(np.nanmedian(gain, axis=1)),
        "two-stage over stiff, largest [-]": floats(np.nanmax(gain, axis=1)),
        "two-stage over soft at low mean torque, largest difference [%]": 100 * alike,
        "two-stage over stiff below 60 % of the transition, largest [-]": float(np.nanmax(gain[low])),
    }
    stops = {name: _stop_torque(variant) for name, variant in variants.items()}
    figures |= {f"{name}: mean torque that bottoms it [Nm]": torque for name, torque in stops.items()}
    figures |= {f"{name}: largest twist over the stop's [-]": _told(found) for name, found in reach.items()}
    struck = {name: _named(model, found) for name, found in reach.items()}
    figures |= {f"{name}: swings into its stop at": cells for name, cells in struck.items()}
    peak = model.full_load_peak()
    good = alike < 0.01 and float(np.nanmax(gain[low])) < 1 and stops["soft"] < peak < stops["two-stage"]
    proviso = _proviso(torques, gain, struck["two-stage"], reach) if good else ""
    return Finding(good, CONDITION, figures, _reason(reach), _mapped(model, tables), proviso)


def _stop_torque(model: Model) -> float:
    law = hinged(model, model.landmarks.springs[0])
    return float(law.torque(max(law.stops)))


def _named(model: Model, reach: Array) -> tuple[str, ...]:
    """Mean torques with the speeds at which the stop is met."""
    torques, asked = by_peak(model, TORQUES), by_idle(model, SPEEDS)
    rows = [(torque, asked[line >= 1]) for torque, line in zip(torques, reach, strict=True)]
    return tuple(f"{torque:g} Nm: {span(speeds)}" for torque, speeds in rows if speeds.size)


def _told(reach: Array) -> tuple[float, ...]:
    """Largest value of every mean torque that has any."""
    return tuple(float(np.nanmax(line)) if np.isfinite(line).any() else float("nan") for line in reach)


def _proviso(torques: Array, gain: Array, struck: tuple[str, ...], reach: dict[str, Array]) -> str:
    """Where the two-stage DMF meets its stop, or is louder than the stiff one, all the same."""
    crossed = np.array([np.nanmax(line, initial=0.0) > 1.01 for line in gain])
    crossed &= ~(reach["two-stage"] >= 1).any(axis=1)
    told = []
    if struck:
        told.append(
            f"short of the stop by the mean torque, but with the swing about it into the stop at {', '.join(struck)}"
        )
    if crossed.any():
        names = ", ".join(f"{torque:g}" for torque in torques[crossed])
        told.append(
            f"at {names} Nm louder than the stiff one at some speeds, up to {np.nanmax(gain[crossed]):.2f} times, "
            "where the swing about the mean crosses both stages"
        )
    return "; ".join(told)


def _reason(reach: dict[str, Array]) -> str:
    lost, known = np.isnan(reach["soft"]), np.isfinite(reach["two-stage"])
    if not (lost & known).any():
        return ""
    share = 100 * (lost & known).sum() / known.sum()
    return f"against its stop the soft DMF has no stable motion of these orders in {share:.0f} % of the cells"


def _mapped(model: Model, tables: dict[str, Array]) -> xr.Dataset:
    values: dict[str, Any] = {}
    for name, found in tables.items():
        plain = name.replace("-", "_")
        values[f"amplitude_{plain}"] = (("mean_torque", "speed"), found[:, 0], "acceleration")
        values[f"twist_{plain}"] = (("mean_torque", "speed"), found[:, 1], "ratio")
    return labelled(
        values,
        {"mean_torque": (by_peak(model, TORQUES), "torque"), "speed": (by_idle(model, SPEEDS), "speed")},
        analysis="claim A12",
        amplitude="half peak-to-peak",
    )
