"""Claims about period doubling of a dual mass flywheel with a stiffness step (B1 to B4)."""

from __future__ import annotations

import numpy as np

from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.powertrain import Powertrain
from torsional.solvers.modal import natural_frequencies
from torsional.studies.answers import floats, input_shaft, main_order
from torsional.studies.base import Figure, Finding, claim
from torsional.studies.claims.pictured import Line, branch_points, draw_motions, draw_peaks, peaks
from torsional.studies.motions import (
    INPUT_ACCELERATION,
    SHAFT,
    SPRING,
    TWIST,
    at_value,
    doubled,
    in_time,
    over_speed,
    over_torque,
    rest_of,
    state_of,
    twist_orders,
)
from torsional.studies.settling import Stepped, order_of
from torsional.studies.stiffness_step import (
    TIMES,
    Sweep,
    attained,
    carrying,
    mode_speed,
    sweeps,
    table,
    transition_torque,
)
from torsional.studies.strongest import Peak, Search
from torsional.studies.trucks import Trucks, reached, sprung, within
from torsional.system import assemble
from torsional.units import RPM

NAMES = {SPRING: "DMF torque", SHAFT: "input torque", INPUT_ACCELERATION: "input acceleration", TWIST: "DMF twist"}
UNITS = {SPRING: "Nm", SHAFT: "Nm", INPUT_ACCELERATION: "rad/s²", TWIST: "rad"}
KINDS = {SPRING: "torque", SHAFT: "torque", INPUT_ACCELERATION: "acceleration", TWIST: "relative_angle"}
JUDGED, JUDGED_SWEEPS, STRAIGHT = (SPRING, SHAFT), ("k2", "k1"), 0.97
CONDITION = (
    "two-stage DMF, transition {transition:.0f} Nm, {damping:.4g} Nms/rad, its stop left out, top gear; order "
    "{half:g}, 0-peak, each the largest over speed and mean torque; k2 varied at k1 = {soft:.4g} kNm/rad, k1 at "
    "k2 = {stiff:.4g} kNm/rad"
)
SETTLING = 400
"""Periods of the firing in which a motion in time settles."""
SATURATES = "torques grow almost in proportion, while the twist grows less and less as the second stage gets stiffer"
BELOW = (
    "at the model's damping; with {damping:.4g} Nms/rad, at small differences, the largest {quantities} lies at "
    "{lowest:.0f} Nm, below the transition. Near {speed:.0f} rpm order {half:g} meets a natural frequency of the line "
    "behind the clutch hub, which takes hardly any torque there"
)
BENT = (
    "for the torque in the DMF; that at the gearbox input is bent (R² {least:.3f}), as the speed of the largest moves "
    "along a resonance of the line behind the clutch hub (order {half:g} meets one near {speed:.0f} rpm)"
)
ASKED = (9, 10, 11, 12, 13, 14, 15)
"""Mean torques at which branches are followed over speed, in tenths of the transition's torque."""


def _straightness(x: Array, y: Array) -> float:
    """R² of a straight line through points.

    >>> _straightness(np.array([0.0, 1.0, 2.0]), np.array([1.0, 3.0, 5.0]))
    1.0
    """
    return float(np.corrcoef(x, y)[0, 1] ** 2)


@claim(
    "B1",
    "6.1",
    "With a stiffness step, vibration of order 1.5 occurs where the third order is near twice the frequency of the DMF "
    "mode, at low operating speeds.",
    "continuation from the third-order motion finds a branch of twice the period; its speeds lie in the lower half of "
    "the range, between twice the mode's order speeds in the soft and in the stiff stage; runs in time from rest, "
    "exact between hinges and by time steps, have its amplitude within 2 %",
    varies="engine speed over the operating range, followed along branches; mean torque from 0.9 to 1.5 times "
    "that of the transition in steps of 0.1",
    picture=draw_motions,
    leading="DMF torque there [Nm]",
    trucks=100,
)
def b1(trucks: Trucks) -> Finding:
    model, spring = trucks.two_stage, trucks.two_stage.landmarks.springs[0]
    twice = [2 * mode_speed(sprung(model, spring, k)) for k in carrying(model)]
    torques = [transition_torque(model) * tenths / 10 for tenths in ASKED]
    every = {torque: over_speed(model, model.operation.speed, torque) for torque in torques}
    at = {torque: doubled(explorer)[:1] for torque, explorer in every.items()}
    ends = {torque: (branch.values.min(), branch.values.max()) for torque, found in at.items() for branch in found}
    search = attained(model)
    strongest = search.peak(SPRING)
    told = confirmed(search, strongest)
    figures: dict[str, Figure] = {
        "mean torques with a doubled branch [Nm]": tuple(ends),
        "its speeds [rpm]": tuple(f"{low / RPM:.0f}–{high / RPM:.0f}" for low, high in ends.values()),
        "twice the DMF mode's order speed, soft and stiff [rpm]": floats(np.array(twice) / RPM),
        "strongest at [rpm]": strongest.speed / RPM,
        "strongest at [Nm]": strongest.torque,
        "DMF torque there [Nm]": strongest.amplitude,
        **{f"DMF twist there, {way} [rad]": size for way, size in told.items()},
    }
    low, high = model.operation.speed
    speeds = np.array(list(ends.values()))
    good = bool(ends) and twice[0] < speeds.min() and speeds.max() < min(twice[1], 0.5 * (low + high))
    shown = min(ends, key=lambda torque: abs(torque - strongest.torque)) if ends else torques[0]
    lines = [Line(every[shown].branches[0], f"{shown:g} Nm, period of the firing")]
    lines += [Line(found[0], f"{torque:g} Nm, doubled period") for torque, found in at.items() if found]
    bands = {"twice the DMF mode's order speed, soft to stiff stage": twice}
    data = branch_points("B1", model, lines, ("speed", "speed"), SPRING, "torque", bands=bands)
    condition = f"two-stage DMF as in the model, top gear; order {_half(model):g}, 0-peak"
    good &= all(abs(size / told["balance"] - 1) < 0.02 for size in told.values())
    return Finding(bool(good), condition, figures, dataset=data)


def confirmed(search: Search, peak: Peak) -> dict[str, float]:
    """DMF twist of half the firing order [rad] at a peak: by harmonic balance, in time from rest and by time steps."""
    model = search.model
    explorer = over_torque(model, peak.speed, search.torques)
    found = [(branch, z) for branch in doubled(explorer) for z in at_value(branch, peak.torque)]
    if not found:
        where, at = "harmonic balance", f"none at {peak.torque:.0f} Nm and {peak.speed / RPM:.0f} rpm"
        raise ModelError("the strongest motion is not there with more harmonics", where=where, found=at)
    branch, z = max(found, key=lambda one: abs(one[0].problem.harmonics_of(one[1])[0, 1]))
    timed = in_time(explorer, peak.torque)
    rest = rest_of(explorer.branches[0].problem, at_value(explorer.branches[0], peak.torque)[0], timed)
    stepped_line = Stepped.of(model, peak.speed, peak.torque)
    spring, half = model.landmarks.springs[0], main_order(model) / 2
    starts = {"rest": rest, "the doubled motion": state_of(branch.problem, z, timed)}
    steps = {name: stepped_line.settled(stepped_line.begun(timed, state)) for name, state in starts.items()}
    return {
        "balance": float(abs(branch.problem.harmonics_of(z)[0, 1])),
        "in time from rest": float(twist_orders(timed, timed.flow(rest, SETTLING).state, 2)[1]),
        **{f"by time steps from {name}": order_of(found, spring, half) for name, found in steps.items()},
    }


def quiet_speed(model: Model) -> float:
    """Speed [rad/s] at which half the firing order meets the line behind the clutch hub, free at its front end."""
    parts = {**model.components, **model.gears[model.top_gear].components}
    whole = model.replaced(components=parts, gears={}, document={})
    nodes = reached(whole.powertrain(), [model.landmarks.input], [input_shaft(model)])
    omega = natural_frequencies(assemble(Powertrain(within(whole, nodes))))
    speed = omega / (0.5 * main_order(model))
    return float(speed[speed > model.operation.idle].min())


VARIED = (
    "stiffness of the second stage, so that the difference goes from {k2[0]:g} to {k2[1]:g} times that at which "
    "periods begin to double, of the first from {k1[0]:g} to {k1[1]:g} times; a quarter of the damping"
).format(**TIMES)


@claim(
    "B2",
    "6.1",
    "The largest vibration of order 1.5 is almost linear in the difference of the two stiffnesses.",
    "torque in the DMF and torque at the gearbox input over seven differences from 1.2 times that at the onset on: R² "
    "above 0.97, k2 varied and k1 varied; where only the DMF's is so, that is the condition; acceleration, twist, a "
    "second damping and the onset reported",
    varies=VARIED,
    picture=draw_peaks,
    leading="lowest R² of the DMF torque [-]",
    trucks=40,
)
def b2(trucks: Trucks) -> Finding:
    model, found = trucks.two_stage, sweeps(trucks.two_stage)
    figures: dict[str, Figure] = {}
    for name, sweep in found.items():
        differences, sizes, _ = table(sweep.cases)
        told = _told(name, sweep)
        figures[f"{told}: onset [kNm/rad]"] = sweep.onset / 1e3
        figures[f"{told}: differences [kNm/rad]"] = floats(differences / 1e3)
        for quantity, words in NAMES.items():
            figures[f"{told}: {words} [{UNITS[quantity]}]"] = floats(sizes[:, quantity])
            figures[f"{told}: {words}, R²"] = _straightness(differences, sizes[:, quantity])
    judged = {name: found[name] for name in JUDGED_SWEEPS}
    figures["largest twist over the stop's [-]"] = max(one.travel for sweep in judged.values() for one in sweep.cases)
    spring, shaft = (min(_straight(sweep, q) for sweep in judged.values()) for q in JUDGED)
    figures["lowest R² of the DMF torque [-]"], figures["lowest R² of the input torque [-]"] = spring, shaft
    data = peaks(
        "B2",
        found,
        _kinds(1),
        1,
        [NAMES[q] for q in JUDGED],
        regression=1,
        amplitude="0-peak",
        told=f"order {_half(model):g},",
    )
    good, bent = spring > STRAIGHT, shaft <= STRAIGHT
    reason = SATURATES if _bent(found["k2"], TWIST) < _bent(found["k2"], SPRING) else ""
    reason = reason if good else f"the torque in the springs is no straight line (R² {spring:.3f})"
    at = {"speed": quiet_speed(model) / RPM, "half": _half(model)}
    return Finding(
        good, _condition(model), figures, reason, data, BENT.format(least=shaft, **at) if good and bent else ""
    )


def _half(model: Model) -> float:
    return main_order(model) / 2


def _condition(model: Model) -> str:
    found = sweeps(model)
    held = {"soft": found["k2"].held / 1e3, "stiff": found["k1"].held / 1e3, "damping": found["k2"].damping}
    return CONDITION.format(transition=transition_torque(model), half=_half(model), **held)


def _told(name: str, sweep: Sweep) -> str:
    return f"{sweep.damping:.4g} Nms/rad, k2 varied" if name == "light" else f"{name} varied"


def _straight(sweep: Sweep, quantity: int) -> float:
    differences, sizes, _ = table(sweep.cases)
    return _straightness(differences, sizes[:, quantity])


def _bent(sweep: Sweep, quantity: int) -> float:
    """Growth of a quantity per stiffness at the end of a sweep over that at its beginning."""
    differences, sizes, _ = table(sweep.cases)
    growth = np.diff(sizes[:, quantity]) / np.diff(differences)
    return float(growth[-1] / growth[0])


def _kinds(which: int) -> dict[str, tuple[int, str]]:
    """Of every quantity its place and what is told of it: amplitudes (1) or the mean torques they occur at (2)."""
    return {name: (q, KINDS[q] if which == 1 else "torque") for q, name in NAMES.items()}


@claim(
    "B3",
    "6.1",
    "The mean torque of the largest vibration of order 1.5 lies above the transition between the stages.",
    "strictly above in every case of B2 at the model's damping, for all quantities; where the second, light damping "
    "has cases that lie below, that is the condition",
    varies=VARIED,
    picture=draw_peaks,
    leading="lowest mean torque over the transition's [-]",
    trucks=40,
)
def b3(trucks: Trucks) -> Finding:
    model, found = trucks.two_stage, sweeps(trucks.two_stage)
    transition = transition_torque(model)
    lowest = {name: table(sweep.cases)[2].min(axis=0) for name, sweep in found.items()}
    figures: dict[str, Figure] = {"transition torque [Nm]": transition}
    for name, sweep in found.items():
        told = _told(name, sweep)
        figures |= {f"{told}: lowest for the {NAMES[q]} [Nm]": float(lowest[name][q]) for q in NAMES}
    least = float(np.concatenate([lowest[name] for name in JUDGED_SWEEPS]).min())
    figures["lowest mean torque over the transition's [-]"] = least / transition
    good = least > transition
    below = [NAMES[q] for q in NAMES if lowest["light"][q] <= transition]
    at = {"speed": quiet_speed(model) / RPM, "lowest": float(lowest["light"].min()), "half": _half(model)}
    quantities = {"quantities": " and ".join(below), "damping": found["light"].damping}
    proviso = BELOW.format(**quantities, **at) if below and good else ""
    reason = "" if good else f"the lowest lies at {least / transition:.3f} of the transition's torque"
    limit = {"limit": transition, "limit_words": "transition between the stages"}
    data = peaks("B3", found, _kinds(2), 2, list(NAMES.values()), told="mean torque of the largest", **limit)
    return Finding(good, _condition(model), figures, reason, data, proviso)


@claim(
    "B4",
    "6.1",
    "That mean torque varies almost linearly with the difference of the stiffnesses.",
    "R² above 0.95, k2 varied and k1 varied, the largest torque in the DMF located along branches to about 2 Nm",
    varies=VARIED,
    picture=draw_peaks,
    leading="lowest R² of what is judged [-]",
    trucks=40,
)
def b4(trucks: Trucks) -> Finding:
    model, found = trucks.two_stage, sweeps(trucks.two_stage)
    figures: dict[str, Figure] = {}
    straight = []
    for name, sweep in found.items():
        told = _told(name, sweep)
        differences, _, torques = table(sweep.cases)
        slope = np.polyfit(differences / 1e3, torques[:, SPRING], 1)[0]
        figures[f"{told}: differences [kNm/rad]"] = floats(differences / 1e3)
        figures[f"{told}: mean torque [Nm]"] = floats(torques[:, SPRING])
        figures[f"{told}: slope [Nm per kNm/rad]"] = float(slope)
        figures |= {f"{told}: R² for the {NAMES[q]}": _straightness(differences, torques[:, q]) for q in NAMES}
        straight += [_straightness(differences, torques[:, SPRING])] if name in JUDGED_SWEEPS else []
    figures["lowest R² of what is judged [-]"] = min(straight)
    told = "mean torque of the largest"
    data = peaks("B4", found, _kinds(2), 2, [NAMES[SPRING]], regression=1, told=told)
    return Finding(min(straight) > 0.95, _condition(model), figures, dataset=data)
