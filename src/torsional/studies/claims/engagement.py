"""The claim about a sudden load change (G3)."""

from __future__ import annotations

import numpy as np

from torsional.files.scenario import load_scenario
from torsional.laws import Hinges
from torsional.model import Model
from torsional.results import labelled
from torsional.studies.answers import floats
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.scenarios.kinds import planned
from torsional.studies.scenarios.running import run_plan
from torsional.studies.trucks import Trucks, hinged, replaced, stiffness

GEARS, SPEED = ("8", "10"), 1400
SETTINGS = (f"gear={GEARS[1]}", f"speed={SPEED} rpm", "clutch.capacity=5000 Nm", "duration=1.2 s", "torque=0 Nm")
TIMES = (0.02, 0.05, 0.1, 0.2, 0.4, 0.8)
STOPS = (2000.0, 2500.0, 3000.0, 3500.0)
CONDITION = (
    "gear shift from 8 to 10 at 1400 rpm without engine torque, one-stage DMF as shipped but for its stop torque, "
    "clutch of 5000 Nm"
)


def stopped_at(model: Model, torque: float) -> Model:
    """A copy whose DMF meets its stop at a torque [Nm], its stiffness and that of the stop as before."""
    spring = model.landmarks.springs[0]
    hard = float(hinged(model, spring).tangent(2 * max(hinged(model, spring).stops)))
    return replaced(model, spring, law=Hinges.staged([(torque, stiffness(model, spring))], stop_stiffness=hard))


def rolling(model: Model) -> str:
    """The setting by which the vehicle rolls as fast as in the old gear."""
    before, after = (model.gears[gear].ratio for gear in GEARS)
    return f"vehicle_at={SPEED * after / before!r} rpm"


def engaged(model: Model, within: float) -> tuple[float, int]:
    """Peak torque of the DMF [Nm] and contacts with its stop, the clutch fully pressed ``within`` [s]."""
    run = run_plan(
        planned(load_scenario("clutch_engagement", [*SETTINGS, rolling(model), f"clutch.within={within} s"]), model)
    )
    one = run.sel(element=model.landmarks.springs[0])
    return float(np.abs(one.torque.values).max()), int(one.stop_contacts)


@claim(
    "G3",
    "3.3",
    "A sudden load change can bottom the springs of the DMF, with a high peak torque; slower engagement and a higher "
    "stop torque help.",
    "a clutch engagement in time: engaged at once the springs meet the lowest stop with more than twice its torque, "
    "engaged slowly they meet none; the peak torque falls with every slower engagement, whatever the stop; engaged at "
    "once it falls with every higher stop torque",
)
def g3(trucks: Trucks) -> Finding:
    met = {stop: [engaged(stopped_at(trucks.dmf, stop), time) for time in TIMES] for stop in STOPS}
    peaks = np.array([[peak for peak, _ in row] for row in met.values()])
    contacts = np.array([[count for _, count in row] for row in met.values()])
    bottoms = bool(contacts[0, 0] > 0 and peaks[0, 0] > 2 * STOPS[0] and contacts[:, -1].max() == 0)
    slower, later = bool((np.diff(peaks, axis=1) < 0).all()), bool((np.diff(peaks[:, 0]) < 0).all())
    figures: dict[str, Figure] = {"engaged within [s]": TIMES}
    for stop, row, count in zip(STOPS, peaks, contacts, strict=True):
        figures[f"stop at {stop:g} Nm: peak torque of the DMF [Nm]"] = floats(row)
        figures[f"stop at {stop:g} Nm: contacts"] = floats(count)
    drawn = labelled(
        {"torque": (("stop", "time"), peaks, "torque")},
        {"stop": (np.array(STOPS), "torque"), "time": (np.array(TIMES), "time")},
        analysis="claim G3",
    )
    return Finding(bottoms and slower and later, CONDITION, figures, _reason(bottoms, slower, later), drawn)


def _reason(bottoms: bool, slower: bool, later: bool) -> str:
    told = {"the springs do not bottom": bottoms, "a slower engagement does not always help": slower}
    told["a later stop does not always help"] = later
    return "; ".join(text for text, shown in told.items() if not shown)
