"""Claims about the power split absorber (C1 to C3, C6)."""

from __future__ import annotations

import numpy as np

from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.answers import (
    INPUT,
    at_input,
    falling,
    floats,
    main_order,
    mean_torque,
    responded,
    rising,
    speeds,
)
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.power_split import Parts, cancelled, damped
from torsional.studies.swept import Along, Curve, over_speed, swept
from torsional.studies.trucks import Trucks, merged, replaced, sprung
from torsional.units import RPM


def paths(model: Model, speed: float) -> tuple[complex, complex, complex]:
    """`paths_over` at one speed."""
    return paths_over(model, np.array([speed]))[0]


def paths_over(model: Model, speed: Array) -> list[tuple[complex, complex, complex]]:
    """Torques on the output [Nm] by springs and by gears, and the engine's torque, complex 0-peak, at each speed.

    Work on body 2 gives the output's torque λ = T_s/r − (J2 θ̈2 + g J3 θ̈3)/r: the springs' part, and the part that the
    gears pass on beside it.
    """
    parts, n = Parts.of(model), main_order(model)
    found = responded(model, speed).isel(order=0)
    first, second, _ = (found.angle.sel(node=node).values for node in parts.nodes)
    third = (1 - parts.g) * first + parts.g * second
    inertial = -((n * speed) ** 2) * (parts.J2 * second + parts.g * parts.J3 * third)
    engine = model.running_engine.harmonics(speed, mean_torque(model) + 0 * speed, [n]).sum(axis=-2)[:, 0]
    spring = found.torque.sel(element=parts.springs).values / parts.r
    return [tuple(map(complex, row)) for row in zip(spring, -inertial / parts.r, engine, strict=True)]  # type: ignore[misc]


def degrees(value: complex, reference: complex) -> float:
    """Phase against a reference, 0 to 180 degrees either way."""
    return float(abs(np.degrees(np.angle(value / reference))))


@claim(
    "C1",
    "2.2.2, 6.1",
    "A power split absorber cancels vibration near one speed: its spring path turns by about 180°, its gear path not.",
    "anti-resonance found in the range; there the spring path's torque on the output is within 30° of opposite to the "
    "engine's, the gear path's within 30° of it; amplitude below that of the corresponding dual mass flywheel",
    varies="engine speed over the operating range in steps of 10 rpm",
    leading="amplitude over corresponding DMF there [-]",
)
def c1(trucks: Trucks) -> Finding:
    model, speed = trucks.psva, speeds(trucks.psva)
    at = cancelled(model)
    spring, gear, engine = paths(model, at)
    own, plain = at_input(model, speed), at_input(merged(model), speed)
    there = np.array([at])
    ratio = float(at_input(model, there)[0] / at_input(merged(model), there)[0])
    figures: dict[str, Figure] = {
        "cancellation found [rpm]": at / RPM,
        "cancellation by closed form [rpm]": Parts.of(model).cancellation() / main_order(model) / RPM,
        "phase of the spring path [°]": degrees(spring, engine),
        "phase of the gear path [°]": degrees(gear, engine),
        "amplitude over corresponding DMF there [-]": ratio,
        "better than the DMF at [rpm]": floats(speed[own < plain][[0, -1]] / RPM),
    }
    low, high = model.operation.speed
    good = low < at < high and degrees(spring, engine) > 150 and degrees(gear, engine) < 30 and ratio < 1
    return Finding(good, INPUT, figures, dataset=swept("C1", over_speed(speed), _paths_drawn(model, speed, own, plain)))


BETTER = "criterion: below 1 at the cancellation"


def _paths_drawn(model: Model, speed: Array, own: Array, plain: Array) -> dict[str, Curve]:
    """Amplitudes with and without the gears, and the phases of both paths against the engine."""
    told = [[degrees(path, engine) for path in (spring, gear)] for spring, gear, engine in paths_over(model, speed)]
    spring, gear = np.radians(told).T
    panel, phase = "gearbox input, acceleration", "phase of the torque on the output against the engine's"
    half = "half peak-to-peak"
    ratio = Curve(own / plain, "ratio", panel="amplitude over the DMF's", limit=1.0, limit_words=BETTER, scale="log")
    limits = {"spring": (5 * np.pi / 6, "criterion: above 150°"), "gear": (np.pi / 6, "criterion: below 30°")}
    curves = {
        "psva": Curve(own, "acceleration", "power split absorber", panel, half, scale="log"),
        "dmf": Curve(plain, "acceleration", "corresponding DMF", panel, half, scale="log"),
        "ratio": ratio,
    }
    for name, path in (("spring", spring), ("gear", gear)):
        at, words = limits[name]
        curves[name] = Curve(path, "angle", f"{name} path", phase, limit=at, limit_words=f"{name} path, {words}")
    return curves


@claim(
    "C2",
    "2.2.2, 6.1",
    "More inertia and less stiffness move the cancellation to lower speed.",
    "cancellation falls strictly with secondary and planet inertia and rises strictly with stiffness, each over 4:1",
    varies="inertia of secondary body, planets and output, and stiffness, each from half to twice in five steps",
    leading="least change from step to step, as said [%]",
)
def c2(trucks: Trucks) -> Finding:
    model, factors = trucks.psva, np.geomspace(0.5, 2.0, 5)
    p = Parts.of(model)
    bodies = {
        "secondary inertia": [replaced(model, p.nodes[1], inertia=f * p.J2) for f in factors],
        "planet inertia": [replaced(model, p.planets, inertia=f * p.J3) for f in factors],
        "stiffness": [sprung(model, p.springs, f * p.k) for f in factors],
        "output inertia": [replaced(model, p.nodes[2], inertia=f * p.J4) for f in factors],
    }
    rpm = {name: np.array([cancelled(m) for m in variants]) / RPM for name, variants in bodies.items()}
    figures: dict[str, Figure] = {f"over {name} × 0.5 to 2 [rpm]": floats(found) for name, found in rpm.items()}
    good = falling(rpm["secondary inertia"]) and falling(rpm["planet inertia"]) and rising(rpm["stiffness"])
    signs = {"secondary inertia": -1, "planet inertia": -1, "stiffness": 1}
    least = min(float((sign * np.diff(np.log(rpm[name]))).min()) for name, sign in signs.items())
    figures["least change from step to step, as said [%]"] = 100 * least
    panel = "speed at which the output stands still"
    told = {name.replace(" ", "_"): Curve(found * RPM, "speed", name, panel) for name, found in rpm.items()}
    condition = "speed at which the output of the undamped absorber stands still, top gear"
    data = swept("C2", Along("factor", factors, "ratio", "parameter over the model's", "log"), told)
    return Finding(good, condition, figures, dataset=data)


READINGS = (
    "§2.2.5 says that a lower quotient lowers the cancellation speed, §6.1 that a higher one does: they divide the two "
    "gear ratios the other way round. With r = (θ4 − θ1)/(θ2 − θ1), up to 1, it is the lower r, as in §2.2.5; 1/r, "
    "from 1 on, is the quotient of §6.1, and there it is the higher one. Both mean the same: the further apart the two "
    "ratios, the lower the cancellation and the more vibration at high speed"
)


@claim(
    "C3",
    "2.2.5, 6.1",
    "Moving the quotient of both gear ratios away from 1 lowers the cancellation and raises vibration at high speed.",
    "with r = (θ4 − θ1)/(θ2 − θ1) from 0.85 down to 0.5 (its inverse 1/r from 1.18 up to 2) the cancellation found "
    "falls and the amplitude at speeds a quarter above the highest cancellation rises, both strictly",
    varies="quotient r of the gear ratios from 0.85 to 0.5 in six steps (1/r from 1.18 to 2)",
    leading="cancellation at the lowest over that at the highest r [-]",
)
def c3(trucks: Trucks) -> Finding:
    p, quotient = Parts.of(trucks.psva), np.linspace(0.85, 0.5, 6)
    variants = [replaced(trucks.psva, p.gear, ratio=float(r)) for r in quotient]
    at = np.array([cancelled(model) for model in variants])
    speed = speeds(trucks.psva)
    speed = speed[speed > 1.25 * at[0]]
    if not speed.size:
        refused = {"found": f"cancellation up to {at[0] / RPM:.0f} rpm", "remedy": "widen operation.speed"}
        raise ModelError("no speed of the range lies well above the cancellation", where="operation.speed", **refused)
    table = np.array([at_input(model, speed) for model in variants])
    figures: dict[str, Figure] = {
        "r [-] (as in §2.2.5: lower lowers)": floats(quotient),
        "1/r [-] (as in §6.1: higher lowers)": floats(1 / quotient),
        "cancellation [rpm]": floats(at / RPM),
        "speeds above [rpm]": float(speed[0] / RPM),
        "mean amplitude there [rad/s²]": floats(table.mean(axis=1)),
        "cancellation at the lowest over that at the highest r [-]": float(at[-1] / at[0]),
    }
    told = {
        "cancellation": Curve(at, "speed", panel="speed at which the output stands still"),
        "amplitude": Curve(
            table.mean(axis=1),
            "acceleration",
            panel=f"gearbox input, mean from {speed[0] / RPM:.0f} rpm on, acceleration",
            amplitude="half peak-to-peak",
        ),
    }
    along = Along("gear_quotient", quotient, "ratio", "quotient r, as in §2.2.5", inverse="quotient 1/r, as in §6.1")
    data = swept("C3", along, told)
    good = falling(at) and rising(table)
    return Finding(good, INPUT, figures, READINGS if good else "", data)


@claim(
    "C6",
    "5 (Paper C)",
    "A power split absorber beats the corresponding dual mass flywheel significantly for a low level of damping only.",
    "lowest ratio to that flywheel, both with the same damping, rises strictly with damping, from below 0.1 without "
    "any to above 0.8 with much",
    varies="damping beside the springs from 0 to 160 Nms/rad in seven steps, of both alike",
    leading="damping at which the ratio is one half [Nms/rad]",
)
def c6(trucks: Trucks) -> Finding:
    model, damping = trucks.psva, np.array([0.0, 5.0, 10.0, 20.0, 40.0, 80.0, 160.0])
    speed = np.union1d(speeds(model), [cancelled(model)])
    pairs = [(at_input(damped(model, c), speed), at_input(damped(merged(model), c), speed)) for c in damping]
    ratio = np.array([own / plain for own, plain in pairs])
    depth = ratio.min(axis=1)
    half = float(np.interp(0.5, depth, damping))
    figures: dict[str, Figure] = {
        "damping [Nms/rad]": floats(damping),
        "lowest ratio to the DMF [-]": floats(depth),
        "damping at which the ratio is one half [Nms/rad]": half,
        "part of the range better than the DMF [%]": floats(100 * (ratio < 1).mean(axis=1)),
    }
    curves = {
        "lowest_ratio": Curve(
            depth, "ratio", panel="lowest amplitude over the corresponding DMF's", limit=1.0, limit_words="no advantage"
        ),
        "better": Curve((ratio < 1).mean(axis=1), "efficiency", panel="part of the range better than the DMF"),
    }
    data = swept("C6", Along("damping", damping, "damping", "damping beside the springs"), curves)
    return Finding(rising(depth) and depth[0] < 0.1 and depth[-1] > 0.8, INPUT, figures, dataset=data)
