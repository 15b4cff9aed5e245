"""The claim about a sudden load change (G3)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.files.scenario import load_scenario
from torsional.laws import Hinges
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import labelled
from torsional.studies.answers import floats
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.scenarios.kinds import planned
from torsional.studies.scenarios.running import run_plan
from torsional.studies.trucks import Trucks, hinged, replaced, stiffness
from torsional.units import RPM

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture

UP, FASTER = 4 / 7, 6 / 7
"""Engine speed of the shift, and of a second one: so far up the range."""
CAPACITY = 2.0
"""Torque of the clutch over the full-load peak."""
TIMES = (0.02, 0.05, 0.1, 0.2, 0.4, 0.8)
STOPS = (0.8, 1.0, 1.2, 1.4)
"""Torques at the stop over the full-load peak."""
AFTER = 0.4
"""How long the line is followed beyond the time of engagement [s], which begins after 0.2 s."""
GRID = 1e-3
"""Step of the times that histories are told at [s]."""
CONDITION = (
    "gear shift from {gears} at {speed:.0f} rpm without engine torque, one-stage DMF but for its stop torque, clutch "
    "of {capacity:.0f} Nm; each followed for 0.2 s from full engagement on"
)


def shift_of(model: Model) -> tuple[str, str]:
    """The gears of the shift: two steps up, into the third from the top; ModelError for less than three gears."""
    names = model.gear_names
    if len(names) < 3:
        raise ModelError(
            "a shift is asked of a gearbox with three gears or more", where="gearbox", found=str(len(names))
        )
    new = max(len(names) - 3, 1)
    return names[max(new - 2, 0)], names[new]


def speed_of(model: Model, up: float = UP) -> float:
    """Engine speed of a shift so far up the range [rpm]."""
    low, high = model.operation.speed
    return (low + up * (high - low)) / RPM


def settings_of(model: Model, up: float = UP) -> list[str]:
    """The shift as settings of the scenario: the vehicle rolls as fast as in the old gear."""
    old, new = shift_of(model)
    speed = speed_of(model, up)
    rolling = speed * model.gears[new].ratio / model.gears[old].ratio
    told = [f"gear={new}", f"speed={speed:.9g} rpm", f"clutch.capacity={CAPACITY * model.full_load_peak():g} Nm"]
    return [*told, "torque=0 Nm", f"vehicle_at={rolling!r} rpm"]


def stopped_at(model: Model, torque: float) -> Model:
    """A copy whose DMF meets its stop at a torque [Nm], its stiffness and that of the stop as before."""
    spring = model.landmarks.springs[0]
    law = hinged(model, spring)
    if not law.stops:
        raise ModelError("the springs have no stop, so none is met", where=spring, remedy="give absorber.stop_torque")
    hard = float(law.tangent(2 * max(law.stops)))
    return replaced(model, spring, law=Hinges.staged([(torque, stiffness(model, spring))], stop_stiffness=hard))


def engaged(model: Model, within: float, up: float = UP) -> xr.Dataset:
    """The springs of the DMF (torque, contacts with the stop) over time, the clutch fully pressed ``within`` [s]."""
    told = [*settings_of(model, up), f"duration={within + AFTER:g} s", f"clutch.within={within} s"]
    return run_plan(planned(load_scenario("clutch_engagement", told), model)).sel(element=model.landmarks.springs[0])


def peak(run: xr.Dataset) -> float:
    """The largest torque [Nm]."""
    return float(np.abs(run.torque.values).max())


def drawn(data: xr.Dataset) -> Picture:
    """Torque of the springs over time: engaged within different times, and at once with different stops."""
    from torsional.plots.histories import plot_histories

    return plot_histories(data.drop_vars("torque"))


@claim(
    "G3",
    "3.3",
    "A sudden load change can bottom the springs of the DMF, with a high peak torque; slower engagement and a higher "
    "stop torque help.",
    "a clutch engagement in time: engaged at once the springs meet the lowest stop with more than twice its torque, "
    "engaged slowly they meet none; the peak torque falls with every slower engagement, whatever the stop; engaged at "
    "once it falls with every higher stop torque; where it does not in a second, faster shift, that is the condition",
    varies="time within which the clutch engages, torque at the stop of the springs",
    picture=drawn,
    leading="peak torque over that of the lowest stop, engaged at once [-]",
    trucks=40,
)
def g3(trucks: Trucks) -> Finding:
    model = trucks.dmf
    stops = tuple(part * model.full_load_peak() for part in STOPS)
    runs = [[engaged(stopped_at(model, stop), time) for time in TIMES] for stop in stops]
    peaks = np.array([[peak(run) for run in row] for row in runs])
    contacts = np.array([[int(run.stop_contacts) for run in row] for row in runs])
    bottoms = bool(contacts[0, 0] > 0 and peaks[0, 0] > 2 * stops[0] and contacts[:, -1].max() == 0)
    slower, later = bool((np.diff(peaks, axis=1) < 0).all()), bool((np.diff(peaks[:, 0]) < 0).all())
    figures: dict[str, Figure] = {"engaged within [s]": TIMES, "stops at [Nm]": stops}
    for stop, row, count in zip(stops, peaks, contacts, strict=True):
        figures[f"stop at {stop:g} Nm: peak torque of the DMF [Nm]"] = floats(row)
        figures[f"stop at {stop:g} Nm: contacts"] = floats(count)
    figures["peak torque over that of the lowest stop, engaged at once [-]"] = float(peaks[0, 0] / stops[0])
    old, new = shift_of(model)
    speed, capacity = speed_of(model), CAPACITY * model.full_load_peak()
    faster = np.array([peak(engaged(stopped_at(model, stop), TIMES[0], FASTER)) for stop in stops])
    figures[f"engaged at once at {speed_of(model, FASTER):.0f} rpm, by stop: peak torque of the DMF [Nm]"] = floats(
        faster
    )
    told = CONDITION.format(gears=f"{old} to {new}", speed=speed, capacity=capacity)
    data = compared(model, stops, peaks, runs)
    good = bottoms and slower and later
    proviso = _harder(model, stops, faster) if good else ""
    return Finding(good, told, figures, _reason(bottoms, slower, later), data, proviso)


def _harder(model: Model, stops: tuple[float, ...], peaks: Array) -> str:
    """Which steps to a later stop do not help in the faster shift; nothing where all do."""
    rises = [f"from {stops[i]:.0f} to {stops[i + 1]:.0f} Nm" for i in np.flatnonzero(np.diff(peaks) >= 0)]
    if not rises:
        return ""
    shown = ", ".join(f"{value / 1e3:.1f}" for value in peaks)
    return (
        f"a later stop helps in this shift; at {speed_of(model, FASTER):.0f} rpm not {' and '.join(rises)} (peaks "
        f"{shown} kNm by stop): while the clutch drives the secondary harder than the springs hold, a later stop can "
        "be met faster"
    )


def compared(model: Model, stops: tuple[float, ...], peaks: Array, runs: list[list[xr.Dataset]]) -> xr.Dataset:
    """Peaks over stop and time of engagement, and the torque over time in the runs with the lowest stop, and in those
    engaged at once."""
    time = np.arange(0.0, TIMES[-1] + AFTER, GRID)
    slow, early = ([_told(run, time) for run in row] for row in (runs[0], [row[0] for row in runs]))
    found = labelled(
        {
            "torque": (("stop", "within"), peaks, "torque"),
            "slower": (("within", "time"), slow, "torque"),
            "later": (("stop", "time_at_once"), [row[: int((TIMES[0] + AFTER) / GRID)] for row in early], "torque"),
        },
        {
            "stop": (np.array(stops), "torque"),
            "within": (np.array(TIMES), "time"),
            "time": (time, "time"),
            "time_at_once": (time[: int((TIMES[0] + AFTER) / GRID)], "time"),
        },
        analysis="claim G3",
        model=model.name,
    )
    found.slower.attrs["panel"] = f"DMF torque, stop at {stops[0]:.0f} Nm"
    found.later.attrs["panel"] = f"DMF torque, engaged within {TIMES[0]:g} s"
    found["within"].attrs["words"] = "engaged within"
    found["stop"].attrs["words"] = "stop at"
    return found


def _told(run: xr.Dataset, time: Array) -> Array:
    return np.asarray(np.interp(time, run.time, run.torque, right=np.nan))


def _reason(bottoms: bool, slower: bool, later: bool) -> str:
    told = {"the springs do not bottom": bottoms, "a slower engagement does not always help": slower}
    told["a later stop does not always help"] = later
    return "; ".join(text for text, shown in told.items() if not shown)
