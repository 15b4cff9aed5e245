"""Claims about dry friction in the clutch damper (A5, A9)."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import xarray as xr

from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.answers import at_input, by_idle, falling, floats, main_order, mean_torque, rising
from torsional.studies.base import Figure, Finding, claim, shown
from torsional.studies.friction import ORDERS, Curve, answered, least_torque, washed
from torsional.studies.settling import Stepped
from torsional.studies.swept import Along, swept
from torsional.studies.swept import Curve as Drawn
from torsional.studies.trucks import Trucks
from torsional.units import RPM

SWEEP = np.array([10.0, 30.0, 60.0, 90.0, 120.0, 150.0])
"""Friction torques [Nm] of the sweep, the range of trucks' clutches and a little below it."""
FAR = 1500 * RPM
LIGHT = 0.2
"""Viscous damping left in a clutch that relies on its washer, over the shipped one."""
AROUND = (600 * RPM, 1000 * RPM)
"""Speeds among which the resonance is sought."""
MOST = 600.0
"""Largest friction torque [Nm] that is tried."""
TIMED, NEARBY = (30.0, 90.0, 150.0), np.array([-6.0, 0.0, 6.0]) * RPM
"""Friction torques [Nm] that are asked by time steps too, and at which speeds about the resonance [rad/s]."""
CYCLES, ALIKE = 16, 0.03
"""Periods of the firing over which a power is taken; how far time steps and harmonic balance may be apart."""
LEAST = 1.0
"""Friction torque [Nm] that stands for a clutch without a washer."""
LIMITS, HIGHER = (1200.0, 1500.0, 1800.0), (2500.0, 3000.0, 3500.0)
"""Amplitudes [rad/s²] under which the resonance is to be brought."""
CONDITION = (
    "mean torque 60 % of the peak, top gear; firing order's acceleration at the gearbox input, half peak-to-peak; a "
    "washer of 100 kNm/rad beside the clutch damper"
)
NAMES = (
    "largest amplitude [rad/s²]",
    "amplitude at 1500 rpm [rad/s²]",
    "friction power at the resonance [W]",
    "friction power at 1500 rpm [W]",
)
MECHANISM = (
    "where the clutch twists much the washer slips and takes energy out of the resonance; where it twists little the "
    "washer sticks for most of the time and is one more spring beside the damper's, which lets more through"
)
UNREACHED = (
    "with little viscous damping in the clutch a washer of {most:g} Nm leaves the single mass flywheel's resonance at "
    "{best:.0f} rad/s², above the lower limits: with much friction the washer sticks and takes hardly any energy"
)


def stepped(model: Model, speed: float) -> tuple[float, float]:
    """Amplitude [rad/s²] and power [W] by time steps: the firing order at the input in the motion that a run from
    equilibrium settles on, and friction in its ledger of energy."""
    order, line = main_order(model), Stepped.of(model, speed, mean_torque(model), ORDERS)
    found = line.settled()
    angle = abs(found.angle.sel(node=model.landmarks.input, order=order).item())
    return angle * (order * speed) ** 2, line.friction_power(found, CYCLES)


def timed(model: Model, resonance: float) -> Array:
    """By time steps: largest amplitude about the ``resonance`` [rad/s], that at 1500 rpm, the powers there (4,)."""
    speed = resonance + NEARBY
    near = Curve(speed, *np.array([stepped(model, float(at)) for at in speed]).T)
    far, far_power = stepped(model, FAR)
    return np.array([near.peak[0], far, near.at(near.peak[1], near.power), far_power])


def balanced(one: Curve) -> Array:
    """The same along a curve by harmonic balance."""
    far, far_power = (one.at(FAR, values) for values in (one.amplitude, one.power))
    return np.array([one.peak[0], far, one.at(one.peak[1], one.power), far_power])


FRICTION = Along("friction_torque", SWEEP, "torque", "friction torque of the washer")


def _both_ways(told: Array, steps: Array) -> dict[str, Drawn]:
    """What `NAMES` tell over friction, by harmonic balance and, where asked, by time steps."""
    curves, asked = dict[str, Drawn](), np.isin(SWEEP, TIMED)
    panels = ("gearbox input at the resonance", "gearbox input at 1500 rpm", "mean friction power")
    for place, (name, panel) in enumerate(zip(("peak", "far", "power"), panels, strict=True)):
        kind = "power" if name == "power" else "acceleration"
        panel, half = (panel, "") if name == "power" else (f"{panel}, acceleration", "half peak-to-peak")
        timed = np.full(SWEEP.size, np.nan)
        timed[asked] = steps[:, place]
        at = ", at the resonance" if name == "power" else ""
        curves[name] = Drawn(told[:, place], kind, f"harmonic balance{at}", panel, half)
        curves[f"{name}_timed"] = Drawn(timed, kind, f"time steps{at}", panel, half, points=True)
    curves["far_power"] = Drawn(told[:, 3], "power", "harmonic balance, at 1500 rpm", panels[2])
    return curves


@claim(
    "A5",
    "2.1",
    "Clutch friction limits the resonance of a single mass flywheel, but it costs power and raises vibration far from "
    "the resonance.",
    "over a sweep of the washer's friction torque the largest amplitude falls strictly, the amplitude at 1500 rpm "
    "rises strictly, and the friction power at the resonance is positive and rises strictly; runs by time steps at "
    "three of the friction torques tell the same within 3 %",
    varies="friction torque of the washer from 10 to 150 Nm in six steps",
    leading="largest amplitude, most over least friction [-]",
    trucks=60,
)
def a5(trucks: Trucks) -> Finding:
    model, ends = trucks.smf, (AROUND[0], FAR)
    found = [answered(washed(model, float(torque)), ends) for torque in SWEEP]
    told = np.array([balanced(one) for one in found])
    place = {torque: one.peak[1] for torque, one in zip(map(float, SWEEP), found, strict=True)}
    steps = np.array([timed(washed(model, torque), place[torque]) for torque in TIMED])
    off = np.abs(steps / told[[list(SWEEP).index(torque) for torque in TIMED]] - 1)
    bare = at_input(model, np.append(np.arange(*AROUND, RPM), FAR))
    figures: dict[str, Figure] = {
        "friction torque [Nm]": floats(SWEEP),
        **dict(zip(NAMES, map(floats, told.T), strict=True)),
        "speed of the largest [rpm]": floats(np.array(list(place.values())) / RPM),
        "without washer: largest, and at 1500 rpm [rad/s²]": (float(bare[:-1].max()), float(bare[-1])),
        "by time steps: friction torque [Nm]": TIMED,
        **{f"by time steps: {name}": floats(values) for name, values in zip(NAMES, steps.T, strict=True)},
        "by time steps: largest difference [%]": float(100 * off.max()),
        "largest amplitude, most over least friction [-]": float(told[-1, 0] / told[0, 0]),
    }
    good = all(_as_said(values) for values in (told, steps)) and bool(off.max() < ALIKE)
    data = swept("A5", FRICTION, _both_ways(told, steps))
    return Finding(good, f"{CONDITION}; viscous damping as shipped beside it", figures, MECHANISM if good else "", data)


def _as_said(told: Array) -> bool:
    peak, far, power, _ = told.T
    return falling(peak) and rising(far) and rising(power) and bool((power > 0).all())


@lru_cache(maxsize=64)
def peak(model: Model, torque: float, viscous: float) -> tuple[float, float]:
    """The largest amplitude about the resonance [rad/s²] and its speed; kept, as one search goes where another went."""
    ends = float(by_idle(model, AROUND[0])), float(by_idle(model, AROUND[1]))
    return answered(washed(model, torque, viscous), ends).peak


def needed(model: Model, limit: float, viscous: float) -> float:
    """The friction torque [Nm] that brings the largest amplitude about the resonance under a limit [rad/s²]."""
    return least_torque(lambda torque: peak(model, torque, viscous)[0] - limit, LEAST, MOST)


@claim(
    "A9",
    "6.1",
    "The right clutch friction avoids severe excitation of the clutch mode with a dual mass flywheel, and less of it "
    "is needed than for the resonance with a single mass flywheel.",
    "friction torque that brings the largest amplitude about the resonance under common limits: smaller with the dual "
    "mass flywheel for every limit, in a clutch that relies on its washer",
    varies="amplitude that the resonance may have, 1200 to 3500 rad/s² in six steps; viscous damping × 0.2 and × 1",
    leading="friction needed, DMF over SMF, largest [-]",
    trucks=40,
)
def a9(trucks: Trucks) -> Finding:
    figures: dict[str, Figure] = {}
    good, share, asked = True, [0.0], dict[tuple[str, float], dict[float, float]]()
    for viscous, limits in ((LIGHT, LIMITS), (LIGHT, HIGHER), (1.0, HIGHER)):
        torques = {name: [needed(m, limit, viscous) for limit in limits] for name, m in _pair(trucks).items()}
        label = f"viscous damping × {viscous:g}, limits {', '.join(f'{limit:g}' for limit in limits)} rad/s²"
        figures |= {f"{label}: {name} [Nm]": tuple(map(_told, found)) for name, found in torques.items()}
        good &= all(double < single for single, double in zip(*torques.values(), strict=True))
        share += [
            double / min(single, MOST) if single else 1.0 for single, double in zip(*torques.values(), strict=True)
        ]
        for name, found in torques.items():
            asked.setdefault((name, viscous), {}).update(zip(limits, found, strict=True))
    figures["friction needed, DMF over SMF, largest [-]"] = float(max(share))
    bare = {name: peak(m, LEAST, LIGHT) for name, m in _pair(trucks).items()}
    figures |= {f"viscous damping × {LIGHT:g}: {name} with {LEAST:g} Nm [rad/s²]": p for name, (p, _) in bare.items()}
    figures |= {f"viscous damping × {LIGHT:g}: {name} at [rpm]": at / RPM for name, (_, at) in bare.items()}
    best = peak(trucks.smf, MOST, LIGHT)[0]
    figures[f"viscous damping × {LIGHT:g}: SMF with {MOST:g} Nm [rad/s²]"] = best
    reason = UNREACHED.format(most=MOST, best=best) if best > max(LIMITS) else ""
    return Finding(good, CONDITION, figures, reason, _over_limits(asked))


def _over_limits(asked: dict[tuple[str, float], dict[float, float]]) -> xr.Dataset:
    """Friction needed over the limit, of both flywheels; infinite where the most does not do."""
    limits = np.array(sorted({*LIMITS, *HIGHER}))
    curves = {
        f"{name}_{100 * viscous:.0f}".lower(): Drawn(
            [found.get(limit, np.nan) for limit in limits],
            "torque",
            f"{name}, viscous damping × {viscous:g}",
            f"friction torque needed (arrow: more than {MOST:g} Nm)",
        )
        for (name, viscous), found in asked.items()
    }
    return swept("A9", Along("limit", limits, "acceleration", "limit at the resonance, half peak-to-peak"), curves)


def _told(torque: float) -> str:
    return shown(torque) if np.isfinite(torque) else f"more than {MOST:g}"


def _pair(trucks: Trucks) -> dict[str, Model]:
    return {"SMF": trucks.smf, "DMF": trucks.dmf}
