"""Claims about where the resonances of the single and the dual mass flywheel truck lie (A2 to A4, A6 to A8)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from torsional.components import Coupling, GearPair
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.solvers.operating import at_operating_point
from torsional.studies.answers import (
    by_gear,
    by_idle,
    floats,
    input_shaft,
    mean_torque,
    mode_of,
    modes,
    rising,
    tracked,
)
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.swept import Along, Curve, over_gears, swept
from torsional.studies.trucks import Trucks, lumped, reached, replaced, sprung, stiffness, within
from torsional.units import RPM

SOFTEST = 0.5
"""Softest feasible clutch damper over the shipped one: a truck's damper ends near 0.2 rad, where it must carry the peak
of the full-load curve."""
LOW = np.array([500.0, 900.0])
"""Low engine speed [rpm], of the shipped truck."""
SOFTENED, STIFFENED = 0.5, 1.5
"""How much softer and stiffer the shafts behind the gearbox are asked."""
MODES = "undamped modes about 60 % of the peak torque; order speed: where the firing order meets the mode"


def twists(model: Model, gear: str, place: int) -> dict[str, float]:
    """Twist of every spring in one mode, referred to engine speed, the largest being one."""
    system, _ = at_operating_point(model, mean_torque(model), gear)
    c, share = system.connections, modes(model, gear).elastic_share.isel(mode=place).values
    spring = c.stiffness > 0
    twist = np.sqrt(share[spring] / c.stiffness[spring]) / np.abs(c.weights[spring]).max(axis=1)
    names = [name for name, kept in zip(c.names, spring, strict=True) if kept]
    return dict(zip(names, (twist / twist.max()).tolist(), strict=True))


def stiffened(model: Model, factors: Array, gear: str) -> Array:
    """Order speed [rpm] of the clutch mode over factors on the clutch damper's stiffness."""
    place = mode_of(modes(model, gear), model.landmarks.clutch)
    own = stiffness(model, model.landmarks.clutch)
    return np.array([tracked(sprung(model, model.landmarks.clutch, own * f), gear, place) for f in factors])


def without_damper(model: Model) -> Model:
    """A copy whose clutch disc is rigid on the flywheel."""
    name = model.landmarks.clutch
    old = model.components[name]
    assert isinstance(old, Coupling)
    return replaced(model, name, GearPair(old.a, old.b, 1.0))


def inside(model: Model, rpm: Array) -> tuple[str, ...]:
    """Gears whose order speed lies in the operating range."""
    low, high = model.operation.speed
    return tuple(gear for gear, n in zip(model.gear_names, rpm, strict=True) if low <= n * RPM <= high)


@claim(
    "A2",
    "2.1",
    "With a single mass flywheel a torsional resonance meets the third order at low engine speed.",
    "in top gear an elastic mode with its order speed in 500–900 rpm (5/6 to 3/2 of idle), its largest twist in clutch "
    "or driveline",
    varies="the connections of the line in top gear, in each mode whose order speed lies in 5/6 to 3/2 of idle",
    leading="clutch mode's order speed [rpm]",
)
def a2(trucks: Trucks) -> Finding:
    gear, found = trucks.smf.top_gear, modes(trucks.smf)
    rpm = found.order_speed.values / RPM
    low, high = by_idle(trucks.smf, LOW)
    places = np.flatnonzero((rpm > low) & (rpm < high))
    largest = [max(t, key=lambda name: t[name]) for t in (twists(trucks.smf, gear, int(p)) for p in places)]
    line = {stamp.name for stamp in lumped(trucks.smf).powertrain(gear).stamps}
    figures: dict[str, Figure] = {
        "order speeds [rpm]": floats(rpm[places]),
        "largest twist in": tuple(largest),
        "energy in the clutch [-]": floats(found.elastic_share.sel(element=trucks.smf.landmarks.clutch)[places]),
        "clutch mode's order speed [rpm]": float(rpm[mode_of(found, trucks.smf.landmarks.clutch)]),
    }
    good = bool(largest) and set(largest) <= line
    return Finding(good, f"gear {gear}; {MODES}", figures, dataset=_mode_pictures(trucks.smf, gear, places.tolist()))


def _mode_pictures(model: Model, gear: str, places: Sequence[int]) -> xr.Dataset | None:
    """Where the springs twist and store energy in some modes; None without a mode."""
    found, curves, names = modes(model, gear), dict[str, Curve](), list[str]()
    for place in places:
        twist, words = twists(model, gear, place), f"mode with order speed {found.order_speed[place] / RPM:.0f} rpm"
        names = list(twist)
        energy = found.elastic_share.isel(mode=place).sel(element=names).values
        panel = "twist referred to engine speed, over the largest"
        curves[f"twist_{place}"] = Curve(list(twist.values()), "ratio", words, panel)
        curves[f"energy_{place}"] = Curve(energy, "energy_share", words, "share of the mode's elastic energy")
    return swept("A2", Along("element", names, "", "connection of the line"), curves) if names else None


def behind_gears(model: Model) -> dict[str, float]:
    """Stiffness [Nm/rad] of the shafts behind the gearbox; raises ModelError where there is none."""
    top, marks = model.gears[model.top_gear].components, model.landmarks
    nodes = reached(model.powertrain(), [marks.load], [marks.clutch, input_shaft(model), *top])
    parts: dict[str, Any] = within(model, nodes)
    found = {name: float(part.stiffness) for name, part in parts.items() if getattr(part, "stiffness", 0)}
    if not found:
        raise ModelError("there is no shaft behind the gearbox", where=model.name, remedy="give the driveline")
    return found


def softened(model: Model, shaft: str, gear: str) -> float:
    """The larger change [-] of the clutch mode's order speed by a shaft that is half softer, or half stiffer."""
    found, own = modes(model, gear), behind_gears(model)[shaft]
    place = mode_of(found, model.landmarks.clutch)
    other = [tracked(replaced(model, shaft, stiffness=f * own), gear, place) for f in (SOFTENED, STIFFENED)]
    return float(np.abs(np.array(other) / (float(found.order_speed[place]) / RPM) - 1).max())


@claim(
    "A3",
    "2.1",
    "That resonance depends on the gear and on the driveline.",
    "order speed of the clutch mode over all gears reported; more than 5 % between top gear and a low gear, and more "
    "than 5 % in top gear by one of the shafts behind the gearbox, its stiffness ± 50 %; gears in which that does less "
    "are named",
    varies="all gears; stiffness of each shaft behind the gearbox × 0.5 and 1.5 in top gear, of the one that does most "
    "in all gears",
    leading="spread against top gear [%]",
)
def a3(trucks: Trucks) -> Finding:
    model = trucks.smf
    rpm, share, _ = by_gear(model, model.landmarks.clutch)
    spread = float(np.max(np.abs(rpm / rpm[-1] - 1)))
    shafts = {name: softened(model, name, model.top_gear) for name in behind_gears(model)}
    most = max(shafts, key=lambda name: shafts[name])
    moved = np.array([softened(model, most, gear) for gear in model.gear_names])
    figures: dict[str, Figure] = {
        "order speed by gear [rpm]": floats(rpm),
        "spread against top gear [%]": 100 * spread,
        **{f"top gear: change by {name} ± 50 % [%]": 100 * change for name, change in shafts.items()},
        f"by gear: change by {most} ± 50 % [%]": floats(100 * moved),
    }
    data = swept("A3", over_gears(model), _spread(rpm, share, moved, most), model)
    good, hardly = spread > 0.05 and shafts[most] > 0.05, moved <= 0.05
    names = ", ".join(gear for gear, less in zip(model.gear_names, hardly, strict=True) if less)
    proviso = f"of the driveline's shafts {most} does most, and less than 5 % in gears {names}" if hardly.any() else ""
    reason = f"of the driveline's shafts {most} does most: {100 * shafts[most]:.1f} % in top gear"
    return Finding(good, MODES, figures, "" if good else reason, data, proviso if good else "")


def _spread(rpm: Array, share: Array, moved: Array, shaft: str) -> dict[str, Curve]:
    """The mode over the gears: where it lies, how far from that in top gear, what a shaft behind the gearbox does."""
    against, limit = "change of the mode's order speed", {"limit": 0.05, "limit_words": "criterion: above 5 %"}
    change = Curve(np.abs(rpm / rpm[-1] - 1), "relative_difference", "against top gear", against, **limit)  # type: ignore[arg-type]
    return {
        "order_speed": Curve(rpm * RPM, "speed", panel="clutch mode's order speed"),
        "difference": change,
        "driveline": Curve(moved, "relative_difference", f"by {shaft} ± 50 %", against),
        "clutch_share": Curve(share, "energy_share", panel="energy of the mode in the clutch damper"),
    }


@claim(
    "A4",
    "2.1",
    "A softer clutch damper lowers that resonance, yet within feasible stiffness it stays in range for some gears.",
    "order speed monotone over a 4:1 sweep of the damper's stiffness; at the softest feasible a gear is still inside",
    varies="stiffness of the clutch damper from half to twice the model's in five steps, all gears",
    leading="number of gears inside at the softest [-]",
)
def a4(trucks: Trucks) -> Finding:
    model, factors = trucks.smf, np.geomspace(SOFTEST, 4 * SOFTEST, 5)
    table = np.array([stiffened(model, factors, gear) for gear in model.gear_names])
    soft = inside(model, table[:, 0])
    own = stiffness(model, model.landmarks.clutch)
    figures: dict[str, Figure] = {
        "stiffness [Nm/rad]": floats(own * factors),
        "top gear's order speed [rpm]": floats(table[-1]),
        "first gear's order speed [rpm]": floats(table[0]),
        "gears inside at the softest": soft,
        "number of gears inside at the softest [-]": float(len(soft)),
    }
    chosen = dict.fromkeys((0, len(table) // 2, len(table) - 1))
    panel, names = "clutch mode's order speed", model.gear_names
    curves = {f"gear_{names[i]}": Curve(table[i] * RPM, "speed", f"gear {names[i]}", panel) for i in chosen}
    count = [float(len(inside(model, column))) for column in table.T]
    told = {"limit": 1.0, "limit_words": "criterion: at least one"}
    curves["inside"] = Curve(count, "number", panel="gears with the mode in range", **told)  # type: ignore[arg-type]
    data = swept("A4", Along("stiffness", own * factors, "stiffness", "stiffness of the clutch damper"), curves, model)
    return Finding(rising(table.T) and bool(soft), f"all gears; {MODES}", figures, dataset=data)


@claim(
    "A6",
    "2.2.1, 6.1",
    "The mode in which the two flywheels of a dual mass flywheel move against each other lies well below idle.",
    "in every gear its order speed is below 0.8 of idle, more than half of its elastic energy in the springs",
    varies="all gears",
    leading="highest order speed over 0.8 of idle [-]",
)
def a6(trucks: Trucks) -> Finding:
    model = trucks.dmf
    rpm, share, _ = by_gear(model, *model.landmarks.springs)
    idle = model.operation.idle / RPM
    figures: dict[str, Figure] = {
        "order speed by gear [rpm]": floats(rpm),
        "energy in the DMF by gear [-]": floats(share),
        "highest over idle [-]": float(rpm.max() / idle),
        "highest order speed over 0.8 of idle [-]": float(rpm.max() / (0.8 * idle)),
    }
    low: dict[str, Any] = {"limit": 0.8 * idle * RPM, "limit_words": "criterion: below 0.8 of idle"}
    half: dict[str, Any] = {"limit": 0.5, "limit_words": "criterion: above 50 %"}
    curves = {
        "order_speed": Curve(rpm * RPM, "speed", panel="DMF mode's order speed", **low),
        "spring_share": Curve(share, "energy_share", panel="energy of the mode in the DMF", **half),
    }
    data = swept("A6", over_gears(model), curves, model)
    return Finding(bool((rpm < 0.8 * idle).all() and (share > 0.5).all()), f"all gears; {MODES}", figures, dataset=data)


@claim(
    "A7",
    "6.1",
    "The clutch mode of the truck with a dual mass flywheel meets the third order in the operating range.",
    "in every gear its order speed is inside the range, the largest share of its elastic energy in the clutch damper",
    varies="all gears",
    leading="least distance from an end of the range, negative outside [rpm]",
)
def a7(trucks: Trucks) -> Finding:
    model = trucks.dmf
    rpm, share, dominant = by_gear(model, model.landmarks.clutch)
    good = len(inside(model, rpm)) == len(rpm) and set(dominant) == {model.landmarks.clutch}
    low, high = (end / RPM for end in model.operation.speed)
    figures: dict[str, Figure] = {
        "order speed by gear [rpm]": floats(rpm),
        "energy in the clutch by gear [-]": floats(share),
        "least distance from an end of the range, negative outside [rpm]": float(
            min(rpm.min() - low, high - rpm.max())
        ),
    }
    curves = {
        "order_speed": Curve(rpm * RPM, "speed", panel="clutch mode's order speed"),
        "clutch_share": Curve(share, "energy_share", panel="energy of the mode in the clutch damper"),
    }
    data = swept("A7", over_gears(model), curves, model)
    return Finding(good, f"all gears; {MODES}", figures, dataset=data)


@claim(
    "A8",
    "6.1",
    "A stiffer clutch damper raises the clutch mode but hardly out of range; without it a like mode stays in range.",
    "monotone over a 1:8 sweep; with a rigid clutch the mode of the same number is still inside in the upper half of "
    "the gears",
    varies="stiffness of the clutch damper × 1 to 8 in four steps, and a rigid clutch; all gears",
    leading="rigid clutch: highest order speed in the upper half of the gears [rpm]",
)
def a8(trucks: Trucks) -> Finding:
    model, factors = trucks.dmf, np.geomspace(1.0, 8.0, 4)
    table = np.array([stiffened(model, factors, gear) for gear in model.gear_names])
    places = [mode_of(modes(model, gear), model.landmarks.clutch) for gear in model.gear_names]
    bare = without_damper(model)
    rigid = np.array([tracked(bare, gear, place) for gear, place in zip(model.gear_names, places, strict=True)])
    kept = inside(model, rigid)
    figures: dict[str, Figure] = {
        "top gear over 1:8 [rpm]": floats(table[-1]),
        "rigid clutch, by gear [rpm]": floats(rigid),
        "gears inside with a rigid clutch": kept,
        "top gear's weakest part": twisted(bare, model.top_gear, places[-1]),
        "rigid clutch: highest order speed in the upper half of the gears [rpm]": float(rigid[len(rigid) // 2 :].max()),
    }
    good = rising(table.T) and set(model.gear_names[len(model.gear_names) // 2 :]) <= set(kept)
    low = tuple(gear for gear in model.gear_names if gear not in kept)
    reason = f"out of range in gears {', '.join(low)} with a rigid clutch" if low else ""
    told = {f"times_{f:.0f}": (row, f"clutch damper × {f:.0f}") for f, row in zip(factors, table.T, strict=True)}
    told |= {"rigid": (rigid, "rigid clutch")}
    panel = "order speed of the clutch mode"
    curves = {name: Curve(row * RPM, "speed", words, panel) for name, (row, words) in told.items()}
    data = swept("A8", over_gears(model), curves, model)
    return Finding(good, f"all gears; {MODES}", figures, reason, data)


def twisted(model: Model, gear: str, place: int) -> str:
    """The connection with the largest share of elastic energy in one mode."""
    share = modes(model, gear).elastic_share.isel(mode=place)
    return str(share.element.values[int(share.values.argmax())])
