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
from torsional.studies.answers import floats, span
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.stiffness_step import stages, transition_torque
from torsional.studies.trucks import Trucks, hinged, replaced
from torsional.units import RPM

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture

TORQUES = np.arange(250.0, 2501.0, 250.0)
SPEEDS = np.arange(700.0, 1901.0, 50.0) * RPM
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
    """Swing of the input acceleration [rad/s²] and largest DMF twist over the stop's at `SPEEDS` under one mean torque.

    Not a number beyond full load, and where no stable motion was found.
    """
    inside = SPEEDS[model.running_engine.full_load_torque(SPEEDS) >= torque]
    table = np.full((2, SPEEDS.size), np.nan)
    try:
        found = model_response(model, (inside[0], inside[-1]), torque, depth=1, at=inside)
    except ModelError:
        return table[0], table[1]
    found = found.isel(point=found.stable.values)
    spring, stop = model.landmarks.springs[0], max(hinged(model, model.landmarks.springs[0]).stops)
    loud = swing(acceleration(found.angle.sel(node=model.landmarks.input))).values
    reach = largest(found.twist.sel(element=spring)) / stop
    for place, speed in enumerate(SPEEDS):
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
    "which the swing about the mean meets a stop are named",
    varies="mean torque from 250 to 2500 Nm in steps of 250, engine speed from 700 to 1900 rpm in steps of 50; one "
    "soft stage, one stiff stage, two stages",
    picture=mapped_stages,
    leading="two-stage over stiff below 60 % of the transition, largest [-]",
    trucks=40,
)
def a12(trucks: Trucks) -> Finding:
    model = trucks.two_stage
    variants = designs(model)
    tables = {name: np.array([row(m, float(t)) for t in TORQUES]) for name, m in variants.items()}
    loud, reach = ({name: found[:, i] for name, found in tables.items()} for i in (0, 1))
    low = transition_torque(model) * LOW >= TORQUES
    alike = float(np.nanmax(np.abs(loud["two-stage"][low] / loud["soft"][low] - 1)))
    gain = loud["two-stage"] / loud["stiff"]
    figures: dict[str, Figure] = {
        "mean torques [Nm]": floats(TORQUES),
        "two-stage over stiff, median over speed [-]": floats(np.nanmedian(gain, axis=1)),
        "two-stage over stiff, largest [-]": floats(np.nanmax(gain, axis=1)),
        "two-stage over soft at low mean torque, largest difference [%]": 100 * alike,
        "two-stage over stiff below 60 % of the transition, largest [-]": float(np.nanmax(gain[low])),
    }
    stops = {name: _stop_torque(variant) for name, variant in variants.items()}
    figures |= {f"{name}: mean torque that bottoms it [Nm]": torque for name, torque in stops.items()}
    figures |= {f"{name}: largest twist over the stop's [-]": _told(found) for name, found in reach.items()}
    figures |= {f"{name}: swings into its stop at": _named(found) for name, found in reach.items()}
    peak = model.full_load_peak()
    good = alike < 0.01 and float(np.nanmax(gain[low])) < 1 and stops["soft"] < peak < stops["two-stage"]
    return Finding(good, CONDITION, figures, _reason(gain, reach), _mapped(tables))


def _stop_torque(model: Model) -> float:
    law = hinged(model, model.landmarks.springs[0])
    return float(law.torque(max(law.stops)))


def _named(reach: Array) -> tuple[str, ...]:
    """Mean torques with the speeds at which the stop is met."""
    rows = [(torque, SPEEDS[line >= 1]) for torque, line in zip(TORQUES, reach, strict=True)]
    return tuple(f"{torque:g} Nm: {span(speeds)}" for torque, speeds in rows if speeds.size)


def _told(reach: Array) -> tuple[float, ...]:
    """Largest value of every mean torque that has any."""
    return tuple(float(np.nanmax(line)) if np.isfinite(line).any() else float("nan") for line in reach)


def _reason(gain: Array, reach: dict[str, Array]) -> str:
    crossed = (np.nanmax(gain, axis=1) > 1.01) & ~(reach["two-stage"] >= 1).any(axis=1)
    torques = TORQUES[crossed]
    told = []
    if torques.size:
        names = ", ".join(f"{torque:g}" for torque in torques)
        told.append(
            f"near its transition, at {names} Nm, the two-stage DMF is louder than the stiff one at some speeds, where "
            "the swing crosses both stages and order 1.5 occurs"
        )
    lost, known = np.isnan(reach["soft"]), np.isfinite(reach["two-stage"])
    if (lost & known).any():
        share = 100 * (lost & known).sum() / known.sum()
        told.append(f"against its stop the soft DMF has no stable motion of these orders in {share:.0f} % of the cells")
    struck = _named(reach["two-stage"])
    if struck:
        told.append(f"about the mean the third order swings the two-stage DMF into its stop at {', '.join(struck)}")
    return "; ".join(told)


def _mapped(tables: dict[str, Array]) -> xr.Dataset:
    values: dict[str, Any] = {}
    for name, found in tables.items():
        plain = name.replace("-", "_")
        values[f"amplitude_{plain}"] = (("mean_torque", "speed"), found[:, 0], "acceleration")
        values[f"twist_{plain}"] = (("mean_torque", "speed"), found[:, 1], "ratio")
    return labelled(
        values,
        {"mean_torque": (TORQUES, "torque"), "speed": (SPEEDS, "speed")},
        analysis="claim A12",
        amplitude="half peak-to-peak",
    )
