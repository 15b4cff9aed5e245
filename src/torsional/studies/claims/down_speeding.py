"""The claim that a dual mass flywheel matched with its clutch allows down-speeding (A16)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from torsional.engine.orders import HALF_ORDERS
from torsional.model import Model
from torsional.results import labelled
from torsional.studies.answers import floats
from torsional.studies.attaining import SLACK
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.down_speeding import Bench, Worst, cruise_speed, moved, worst
from torsional.studies.matching import Match, concepts, matched
from torsional.studies.trucks import Trucks, stiffness
from torsional.units import RPM

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Picture

BY = 100 * RPM
SIGNIFICANT = 1.1
"""Rise of the worst case that counts as significant: a tenth, 0.8 dB, is about what trucks of one series differ by, and
below what an ear tells."""
CYCLE = 30 * RPM
"""Step of speeds in which the swing of all half orders is looked at [rad/s]."""
TODAY, MOVED, OWN, OWN_MOVED, KEPT, MATCHED = (
    "SMF, range of today",
    "SMF, moved",
    "DMF as it is, range of today",
    "DMF as it is, moved",
    "matched DMF, range of today",
    "matched DMF, moved",
)
"""Cases, a pair for each absorber."""


def _drawn(data: xr.Dataset) -> Picture:
    from torsional.plots.down_speeding import plot_worst_by_gear

    return plot_worst_by_gear(data)


@claim(
    "A16",
    "6.1",
    "With a matched dual mass flywheel and clutch the engine can run 100 rpm slower at equal power with no significant "
    "increase of the vibration into the gearbox, all gears considered.",
    "worst firing-order acceleration at the gearbox input over speeds and mean torques within full load: in every gear "
    "the matched dual mass flywheel's in the range moved down is at most 1.1 of the worst of today's truck, a single "
    "mass flywheel in the range of today, its springs off their stops; with the condition told where it is more than "
    "1.1 of the same dual mass flywheel's, unmatched, in the range of today",
    varies="range of speeds and full-load torque at equal power, final drive, gear; springs of the dual mass flywheel, "
    "stiffness and damping of the clutch damper within their limits",
    picture=_drawn,
    leading="matched DMF, moved, over SMF in the range of today [-]",
    trucks=60,
)
def a16(trucks: Trucks) -> Finding:
    concept = concepts(trucks)["DMF"]
    choice = matched(concept, BY)
    found = {
        TODAY: worst(trucks.smf),
        MOVED: worst(moved(trucks.smf, BY)),
        OWN: worst(trucks.dmf),
        OWN_MOVED: worst(moved(trucks.dmf, BY)),
        KEPT: worst(matched(concept).model),
        MATCHED: worst(choice.model),
    }
    size = {name: one.acceleration for name, one in found.items()}
    good = size[MATCHED] <= SIGNIFICANT * size[TODAY] and found[MATCHED].reach <= SLACK
    own = size[MATCHED] / size[OWN]
    proviso = "" if own <= SIGNIFICANT else f"against a single mass flywheel; {own:.2f} of the unmatched dual one's"
    condition = (
        f"{BY / RPM:.0f} rpm down at equal power, vehicle as fast at {_rpm(cruise_speed(trucks.dmf))}, idle kept"
    )
    return Finding(good, condition, _figures(trucks, found, choice), _reason(found), _dataset(trucks, found), proviso)


def _figures(trucks: Trucks, found: dict[str, Worst], choice: Match) -> dict[str, Figure]:
    told: dict[str, Figure] = {f"{name}: worst [rad/s²]": one.acceleration for name, one in found.items()}
    told |= {f"{name}: worst in": where(one) for name, one in found.items()}
    over = {name: found[MATCHED].acceleration / found[name].acceleration for name in (TODAY, OWN, KEPT)}
    model, marks = choice.model, choice.model.landmarks
    return told | {
        "matched DMF, moved, over SMF in the range of today [-]": over[TODAY],
        "matched DMF, moved, over DMF as it is in the range of today [-]": over[OWN],
        "matched DMF, moved, over matched DMF in the range of today [-]": over[KEPT],
        "SMF, moved, over range of today [-]": found[MOVED].acceleration / found[TODAY].acceleration,
        "matched DMF, moved, over SMF in the range of today, by gear [-]": floats(
            found[MATCHED].by_gear / found[TODAY].by_gear
        ),
        "swing over the cycle: matched DMF, moved, over SMF in the range of today [-]": _cycle(model)
        / _cycle(trucks.smf),
        "matched: springs [Nm/rad]": tuple(stiffness(model, name) for name in marks.springs),
        "matched: clutch damper [Nm/rad]": stiffness(model, marks.clutch),
        "matched: over the truck's own": tuple(f"{name} × {factor:.2f}" for name, factor in choice.factors.items()),
        "matched: twist over the way to the stop [-]": found[MATCHED].reach,
        "peak of full load, moved over today [-]": model.full_load_peak() / trucks.dmf.full_load_peak(),
    }


def where(one: Worst) -> str:
    """Gear, speed and mean torque of a worst case in words."""
    gear = f"gear {one.gear}, " if one.gear else ""
    return f"{gear}{_rpm(one.speed)}, {one.torque:.0f} Nm"


def _rpm(speed: float) -> str:
    return f"{speed / RPM:.0f} rpm"


def _cycle(model: Model) -> float:
    """The worst half swing over an engine cycle of all half orders [rad/s²], on a coarser grid, at full load."""
    return Bench(model, CYCLE, (1.0,), orders=HALF_ORDERS.tolist(), stops={}).worst().acceleration


def _reason(found: dict[str, Worst]) -> str:
    """What moving down costs a flywheel that is matched for either range."""
    rise = found[MATCHED].acceleration / found[KEPT].acceleration
    if rise <= SIGNIFICANT:
        return ""
    torque = found[MATCHED].torque / found[KEPT].torque
    return (
        f"moving down is not free: matched for the range of today the same one has {1 / rise:.2f} of it, for springs "
        f"that carry the raised torque on the same way cannot be as soft, and at the worst point the mean torque was "
        f"{1 / torque:.2f} of this one"
    )


def _dataset(trucks: Trucks, found: dict[str, Worst]) -> xr.Dataset:
    table = np.array([one.by_gear for one in found.values()])
    at = np.array([one.speed_by_gear for one in found.values()])
    return labelled(
        {"worst": (("case", "gear"), table, "acceleration"), "worst_speed": (("case", "gear"), at, "speed")},
        {"case": (np.array(list(found)), ""), "gear": (np.array(trucks.dmf.gear_names), "")},
        analysis="claim A16",
        limit=SIGNIFICANT * found[TODAY].acceleration,
    )
