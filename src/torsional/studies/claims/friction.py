"""Claims about dry friction in the clutch damper (A5, A9)."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import xarray as xr

from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.answers import at_input, by_idle, by_peak, falling, floats, main_order, mean_torque, rising
from torsional.studies.base import Figure, Finding, claim, shown
from torsional.studies.concepts import Scale
from torsional.studies.friction import ORDERS, STICKING, Curve, answered, around, clutch_speed, least_torque, washed
from torsional.studies.settling import Stepped
from torsional.studies.swept import Along, swept
from torsional.studies.swept import Curve as Drawn
from torsional.studies.trucks import Trucks
from torsional.units import RPM

SWEEP = np.array([10.0, 30.0, 60.0, 90.0, 120.0, 150.0])
"""Friction torques [Nm] of the sweep, the range of trucks' clutches and a little below it.  This and all torques below
are those of the shipped truck; they follow the peak of full load, speeds follow idle."""
FAR = 1500 * RPM
"""Speed [rad/s] far from the resonance."""
LIGHT = 0.2
"""Viscous damping left in a clutch that relies on its washer, over the shipped one."""
BEYOND, HARDLY = 2.0, 1e-3
"""Least far speed over that of the clutch mode; a power that is smaller than this share of the largest is none."""
MOST = 600.0
"""Largest friction torque [Nm] that is tried."""
TIMED, NEARBY = (30.0, 90.0, 150.0), np.array([-6.0, 0.0, 6.0]) * RPM
"""Friction torques [Nm] that are asked by time steps too, and at which speeds about the resonance [rad/s]."""
CYCLES, ALIKE = 16, 0.03
"""Periods of the firing over which a power is taken; how far time steps and harmonic balance may be apart."""
LEAST = 1.0
"""Friction torque [Nm] that stands for a clutch without a washer."""
LIMITS, HIGHER = (1200.0, 1500.0, 1800.0), (2500.0, 3000.0, 3500.0)
"""Amplitudes [rad/s²] under which the resonance is to be brought.  They follow torque over inertia, where inertias keep
the modes at the same multiples of idle, so (firing order · idle)²: a faster engine shakes what it drives by so much
more, and a limit that takes no account of it would lie far below or above all that friction does there."""
CONDITION = (
    "mean torque 60 % of the peak, top gear; firing order's acceleration at the gearbox input, half peak-to-peak; a "
    "washer of {washer:.3g} kNm/rad beside the clutch damper"
)
MECHANISM = (
    "where the clutch twists much the washer slips and takes energy out of the resonance; where it twists little the "
    "washer sticks for most of the time and is one more spring beside the damper's, which lets more through"
)
UNREACHED = (
    "with little viscous damping in the clutch a washer of {most:g} Nm leaves the single mass flywheel's resonance at "
    "{best:.0f} rad/s², above the lower limits"
)
STUCK = ": it sticks for most of the time and takes {power:.0f} W, one of {less:.4g} Nm {more:.0f} W"
LOUDER = "with hardly any friction the DMF's resonance has {double:.0f} rad/s², the SMF's {single:.0f} rad/s²"


def names(model: Model) -> tuple[str, str, str, str]:
    """What is told over friction."""
    at = far_words(model)
    return (
        "largest amplitude [rad/s²]",
        f"amplitude {at} [rad/s²]",
        "friction power at the resonance [W]",
        f"friction power {at} [W]",
    )


def far(model: Model) -> float:
    """The speed [rad/s] far from the resonance, within the truck's range."""
    return float(min(max(by_idle(model, FAR), BEYOND * clutch_speed(model)), model.operation.speed[1]))


def far_words(model: Model) -> str:
    """That speed in words."""
    return f"at {far(model) / RPM:.0f} rpm"


def condition(model: Model) -> str:
    """Under what both claims are asked."""
    return CONDITION.format(washer=by_peak(model, STICKING) / 1e3)


def rubbed(model: Model, torque: float, viscous: float = 1.0) -> Model:
    """A copy with a washer [Nm] whose stiffness follows the truck's torque."""
    return washed(model, torque, viscous, float(by_peak(model, STICKING)))


def stepped(model: Model, speed: float) -> tuple[float, float]:
    """Amplitude [rad/s²] and power [W] by time steps: the firing order at the input in the motion that a run from
    equilibrium settles on, and friction in its ledger of energy."""
    order, line = main_order(model), Stepped.of(model, speed, mean_torque(model), ORDERS)
    found = line.settled()
    angle = abs(found.angle.sel(node=model.landmarks.input, order=order).item())
    return angle * (order * speed) ** 2, line.friction_power(found, CYCLES)


def timed(model: Model, resonance: float, far: float) -> Array:
    """By time steps: largest amplitude about the ``resonance`` [rad/s], that at ``far``, the powers there (4,)."""
    speed = resonance + by_idle(model, NEARBY)
    near = Curve(speed, *np.array([stepped(model, float(at)) for at in speed]).T)
    away, far_power = stepped(model, far)
    return np.array([near.peak[0], away, near.at(near.peak[1], near.power), far_power])


def balanced(one: Curve, far: float) -> Array:
    """The same along a curve by harmonic balance."""
    away, far_power = (one.at(far, values) for values in (one.amplitude, one.power))
    return np.array([one.peak[0], away, one.at(one.peak[1], one.power), far_power])


def _both_ways(told: Array, steps: Array, away: str) -> dict[str, Drawn]:
    """What `names` tell over friction, by harmonic balance and, where asked, by time steps."""
    curves, asked = dict[str, Drawn](), np.isin(SWEEP, TIMED)
    panels = ("gearbox input at the resonance", f"gearbox input {away}", "mean friction power")
    for place, (name, panel) in enumerate(zip(("peak", "far", "power"), panels, strict=True)):
        kind = "power" if name == "power" else "acceleration"
        panel, half = (panel, "") if name == "power" else (f"{panel}, acceleration", "half peak-to-peak")
        timed = np.full(SWEEP.size, np.nan)
        timed[asked] = steps[:, place]
        at = ", at the resonance" if name == "power" else ""
        curves[name] = Drawn(told[:, place], kind, f"harmonic balance{at}", panel, half)
        curves[f"{name}_timed"] = Drawn(timed, kind, f"time steps{at}", panel, half, points=True)
    curves["far_power"] = Drawn(told[:, 3], "power", f"harmonic balance, {away}", panels[2])
    return curves


@claim(
    "A5",
    "2.1",
    "Clutch friction limits the resonance of a single mass flywheel, but it costs power and raises vibration far from "
    "the resonance.",
    "over a sweep of the washer's friction torque the largest amplitude falls strictly, the amplitude at 5/2 of idle "
    "(1500 rpm) rises strictly, and the friction power at the resonance is positive and rises strictly; runs by time "
    "steps at three of the friction torques tell the same within 3 %",
    varies="friction torque of the washer from 0.4 to 6 % of full load's peak (10 to 150 Nm) in six steps",
    leading="largest amplitude, most over least friction [-]",
    trucks=60,
)
def a5(trucks: Trucks) -> Finding:
    model, end, away, called = trucks.smf, far(trucks.smf), far_words(trucks.smf), names(trucks.smf)
    sweep, chosen = by_peak(model, SWEEP), [list(SWEEP).index(torque) for torque in TIMED]
    found = [answered(rubbed(model, float(torque)), (around(model)[0], end)) for torque in sweep]
    told, place = np.array([balanced(one, end) for one in found]), [one.peak[1] for one in found]
    steps = np.array([timed(rubbed(model, float(sweep[one])), place[one], end) for one in chosen])
    off = apart(told[chosen], steps)
    bare = at_input(model, np.append(np.arange(*around(model), float(by_idle(model, RPM))), end))
    figures: dict[str, Figure] = {
        "friction torque [Nm]": floats(sweep),
        **dict(zip(called, map(floats, told.T), strict=True)),
        "speed of the largest [rpm]": floats(np.array(place) / RPM),
        f"without washer: largest, and {away} [rad/s²]": (float(bare[:-1].max()), float(bare[-1])),
        "by time steps: friction torque [Nm]": floats(sweep[chosen]),
        **{f"by time steps: {name}": floats(values) for name, values in zip(called, steps.T, strict=True)},
        "by time steps: largest difference [%]": float(100 * off.max()),
        "largest amplitude, most over least friction [-]": float(told[-1, 0] / told[0, 0]),
    }
    against = _against(told, steps, float(off.max()), away)
    friction = Along("friction_torque", sweep, "torque", "friction torque of the washer")
    data, beside = swept("A5", friction, _both_ways(told, steps, away)), "viscous damping as in the model beside it"
    return Finding(not against, f"{condition(model)}; {beside}", figures, against or MECHANISM, data)


def apart(told: Array, steps: Array) -> Array:
    """Relative differences of what `names` tell (sweep, 4); where next to nothing is told, over the largest."""
    largest = told.max(axis=0)
    little = told < HARDLY * largest
    return np.where(little, np.abs(steps - told) / largest, np.abs(steps / np.where(little, 1.0, told) - 1))


def _against(told: Array, steps: Array, off: float, away: str) -> str:
    """What stands against the claim, in words."""
    found = []
    for way, (peak, far, power, _) in (("", told.T), (" by time steps", steps.T)):
        found += [] if falling(peak) else [f"the largest amplitude does not fall with every step of friction{way}"]
        found += [] if rising(far) else [f"the amplitude {away} does not rise with every step{way}"]
        found += [] if rising(power) and (power > 0).all() else [f"nor does the friction power at the resonance{way}"]
    found += [] if off < ALIKE else [f"time steps and harmonic balance are up to {100 * off:.1f} % apart"]
    return "; ".join(found)


@lru_cache(maxsize=64)
def answer(model: Model, torque: float, viscous: float) -> Curve:
    """What a washer [Nm] makes of the line about its resonance; kept, as one search goes where another went."""
    return answered(rubbed(model, torque, viscous), around(model))


def peak(model: Model, torque: float, viscous: float) -> tuple[float, float]:
    """The largest amplitude about the resonance [rad/s²] and its speed."""
    return answer(model, torque, viscous).peak


def taken(model: Model, torque: float) -> float:
    """What a washer [Nm] takes at the resonance [W], with little viscous damping beside it."""
    one = answer(model, torque, LIGHT)
    return one.at(one.peak[1], one.power)


def needed(model: Model, limit: float, viscous: float) -> float:
    """The friction torque [Nm] that brings the largest amplitude about the resonance under a limit [rad/s²]."""
    least, most = (float(by_peak(model, torque)) for torque in (LEAST, MOST))
    return least_torque(lambda torque: peak(model, torque, viscous)[0] - limit, least, most)


def limits_of(model: Model, limits: tuple[float, ...]) -> tuple[float, ...]:
    """Limits [rad/s²] that follow a truck."""
    return tuple(Scale.of(model).acceleration * limit for limit in limits)


@claim(
    "A9",
    "6.1",
    "The right clutch friction avoids severe excitation of the clutch mode with a dual mass flywheel, and less of it "
    "is needed than for the resonance with a single mass flywheel.",
    "friction torque that brings the largest amplitude about the resonance under common limits: smaller with the dual "
    "mass flywheel for every limit, in a clutch that relies on its washer; limits that neither needs friction for say "
    "nothing",
    varies="amplitude that the resonance may have, 1200 to 3500 rad/s² in six steps on the shipped truck, with the "
    "square of the firing frequency at idle on others; viscous damping × 0.2 and × 1",
    leading="friction needed, DMF over SMF, largest [-]",
    trucks=40,
)
def a9(trucks: Trucks) -> Finding:
    figures: dict[str, Figure] = {}
    model, most, least = trucks.smf, float(by_peak(trucks.smf, MOST)), float(by_peak(trucks.smf, LEAST))
    asked, pairs = dict[tuple[str, float], dict[float, float]](), list[tuple[float, float]]()
    for viscous, chosen in ((LIGHT, LIMITS), (LIGHT, HIGHER), (1.0, HIGHER)):
        limits = limits_of(model, chosen)
        torques = {name: [needed(m, limit, viscous) for limit in limits] for name, m in _pair(trucks).items()}
        label = f"viscous damping × {viscous:g}, limits {', '.join(f'{limit:.4g}' for limit in limits)} rad/s²"
        figures |= {f"{label}: {name} [Nm]": tuple(_told(t, most) for t in found) for name, found in torques.items()}
        pairs += [pair for pair in zip(*torques.values(), strict=True) if any(pair)]
        for name, found in torques.items():
            asked.setdefault((name, viscous), {}).update(zip(limits, found, strict=True))
    if not pairs:
        raise ModelError(
            "neither flywheel needs friction to keep any of the limits", where="clutch", found=_lowest(trucks, least)
        )
    share = [double / min(single, most) if single else 1.0 for single, double in pairs]
    figures["friction needed, DMF over SMF, largest [-]"] = float(max(0.0, *share))
    bare = {name: peak(m, least, LIGHT) for name, m in _pair(trucks).items()}
    at = f"viscous damping × {LIGHT:g}"
    figures |= {f"{at}: {name} with {least:.3g} Nm [rad/s²]": p for name, (p, _) in bare.items()}
    figures |= {f"{at}: {name} at [rpm]": speed / RPM for name, (_, speed) in bare.items()}
    best = peak(model, most, LIGHT)[0]
    figures[f"{at}: SMF with {most:.4g} Nm [rad/s²]"] = best
    good = all(double < single for single, double in pairs)
    told = [_unreached(model, most)] if best > max(limits_of(model, LIMITS)) else []
    loud = bare["DMF"][0] > bare["SMF"][0]
    told += [LOUDER.format(double=bare["DMF"][0], single=bare["SMF"][0])] if loud and not good else []
    return Finding(good, condition(model), figures, "; ".join(told), _over_limits(asked, most))


def _unreached(model: Model, most: float) -> str:
    """That the most friction does not do, and the mechanism where it shows: less of it takes more power."""
    power, more = taken(model, most), taken(model, 0.5 * most)
    told = UNREACHED.format(most=most, best=peak(model, most, LIGHT)[0])
    return told + (STUCK.format(power=power, less=0.5 * most, more=more) if power < more else "")


def _lowest(trucks: Trucks, least: float) -> str:
    told = (f"{name} {peak(m, least, LIGHT)[0]:.0f} rad/s²" for name, m in _pair(trucks).items())
    return f"with {least:.3g} Nm and little viscous damping {', '.join(told)}"


def _over_limits(asked: dict[tuple[str, float], dict[float, float]], most: float) -> xr.Dataset:
    """Friction needed over the limit, of both flywheels; infinite where the most does not do."""
    limits = np.array(sorted({limit for found in asked.values() for limit in found}))
    curves = {
        f"{name}_{100 * viscous:.0f}".lower(): Drawn(
            [found.get(limit, np.nan) for limit in limits.tolist()],
            "torque",
            f"{name}, viscous damping × {viscous:g}",
            f"friction torque needed (arrow: more than {most:.4g} Nm)",
        )
        for (name, viscous), found in asked.items()
    }
    return swept("A9", Along("limit", limits, "acceleration", "limit at the resonance, half peak-to-peak"), curves)


def _told(torque: float, most: float) -> str:
    return shown(torque) if np.isfinite(torque) else f"more than {most:.4g}"


def _pair(trucks: Trucks) -> dict[str, Model]:
    return {"SMF": trucks.smf, "DMF": trucks.dmf}
