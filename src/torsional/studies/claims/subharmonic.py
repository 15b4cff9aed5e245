"""Claims about period doubling of a dual mass flywheel with a stiffness step (B1 to B4)."""

from __future__ import annotations

from functools import partial

import numpy as np

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
    LIGHT,
    SOFT,
    Case,
    cases,
    mode_speed,
    stages,
    stepped,
    table,
    transition_torque,
)
from torsional.studies.strongest import TORQUES, Peak, Search, onset
from torsional.studies.trucks import Trucks, reached, sprung, within
from torsional.system import assemble
from torsional.units import RPM

NAMES = {SPRING: "DMF torque", SHAFT: "input torque", INPUT_ACCELERATION: "input acceleration", TWIST: "DMF twist"}
UNITS = {SPRING: "Nm", SHAFT: "Nm", INPUT_ACCELERATION: "rad/s²", TWIST: "rad"}
KINDS = {SPRING: "torque", SHAFT: "torque", INPUT_ACCELERATION: "acceleration", TWIST: "relative_angle"}
JUDGED = (SPRING, SHAFT)
CONDITION = (
    "two-stage DMF, transition 1000 Nm, top gear; order 1.5, 0-peak, each the largest over speed and mean torque; "
    "k2 varied at k1 = 8 kNm/rad, k1 at k2 = 24 kNm/rad"
)
SETTLING = 400
"""Periods of the firing in which a motion in time settles."""
SATURATES = "torques grow almost in proportion, while the twist grows less and less as the second stage gets stiffer"
BELOW = (
    "at the model's damping; with {damping:g} Nms/rad, at small differences, the largest {quantities} lies at "
    "{lowest:.0f} Nm, below the transition. Near {speed:.0f} rpm order 1.5 meets a natural frequency of the line "
    "behind the clutch hub, which takes hardly any torque there"
)
ASKED = (900.0, 1000.0, 1100.0, 1200.0, 1300.0, 1400.0, 1500.0)


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
    varies="engine speed over the operating range, followed along branches; mean torque from 900 to 1500 Nm in steps "
    "of 100",
    picture=draw_motions,
    leading="DMF torque there [Nm]",
    trucks=100,
)
def b1(trucks: Trucks) -> Finding:
    model = trucks.two_stage
    every = {torque: over_speed(model, model.operation.speed, torque) for torque in ASKED}
    at = {torque: doubled(explorer)[:1] for torque, explorer in every.items()}
    ends = {torque: (branch.values.min(), branch.values.max()) for torque, found in at.items() for branch in found}
    spring, order = model.landmarks.springs[0], main_order(model)
    twice = [2 * mode_speed(sprung(model, spring, k)) for k in stages(model)]
    strongest = Search(model, order / 2).peak(SPRING)
    told = confirmed(model, strongest)
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
    shown = min(ends, key=lambda torque: abs(torque - strongest.torque)) if ends else ASKED[0]
    lines = [Line(every[shown].branches[0], f"{shown:g} Nm, period of the firing")]
    lines += [Line(found[0], f"{torque:g} Nm, doubled period") for torque, found in at.items() if found]
    bands = {"twice the DMF mode's order speed, soft to stiff stage": twice}
    data = branch_points("B1", model, lines, ("speed", "speed"), SPRING, "torque", bands=bands)
    condition = "two-stage DMF as shipped, top gear; order 1.5, 0-peak"
    good &= all(abs(size / told["balance"] - 1) < 0.02 for size in told.values())
    return Finding(bool(good), condition, figures, dataset=data)


def confirmed(model: Model, peak: Peak) -> dict[str, float]:
    """DMF twist of half the firing order [rad] at a peak: by harmonic balance, in time from rest and by time steps."""
    explorer = over_torque(model, peak.speed, TORQUES)
    branch = doubled(explorer)[0]
    z = max(at_value(branch, peak.torque), key=lambda point: abs(branch.problem.harmonics_of(point)[0, 1]))
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


@claim(
    "B2",
    "6.1",
    "The largest vibration of order 1.5 is almost linear in the difference of the two stiffnesses.",
    "torque in the DMF and torque at the gearbox input over at least six differences above the onset: R² above 0.97, "
    "k2 varied and k1 varied; acceleration, twist, a second damping and the onset reported",
    varies="stiffness of the second stage from 18 to 34 kNm/rad at 8 before it, of the first from 5 to 12 at 24 after "
    "it; a second damping of 5 Nms/rad",
    picture=draw_peaks,
    leading="lowest R² of what is judged [-]",
    trucks=40,
)
def b2(trucks: Trucks) -> Finding:
    found = cases(trucks.two_stage)
    figures: dict[str, Figure] = {}
    for name in ("k2", "k1"):
        differences, sizes, _ = table(found[name])
        figures[f"{name} varied: differences [kNm/rad]"] = floats(differences / 1e3)
        for quantity, told in NAMES.items():
            figures[f"{name} varied: {told} [{UNITS[quantity]}]"] = floats(sizes[:, quantity])
            figures[f"{name} varied: {told}, R²"] = _straightness(differences, sizes[:, quantity])
    figures |= _lightly(found["light"]) | _onsets(trucks.two_stage)
    figures["largest twist over the stop's [-]"] = max(one.travel for one in (*found["k2"], *found["k1"]))
    straight = [_straightness(x, y[:, q]) for x, y, _ in (table(found[n]) for n in ("k2", "k1")) for q in JUDGED]
    figures["lowest R² of what is judged [-]"] = min(straight)
    data = peaks(
        "B2", found, _kinds(1), 1, [NAMES[q] for q in JUDGED], regression=1, amplitude="0-peak", told="order 1.5,"
    )
    reason = SATURATES if _bent(found["k2"], TWIST) < _bent(found["k2"], SPRING) else ""
    return Finding(min(straight) > 0.97, CONDITION, figures, reason, data)


def _bent(found: tuple[Case, ...], quantity: int) -> float:
    """Growth of a quantity per stiffness at the end of a sweep over that at its beginning."""
    differences, sizes, _ = table(found)
    growth = np.diff(sizes[:, quantity]) / np.diff(differences)
    return float(growth[-1] / growth[0])


def _lightly(found: tuple[Case, ...]) -> dict[str, Figure]:
    differences, sizes, _ = table(found)
    told: dict[str, Figure] = {f"{LIGHT:g} Nms/rad, k2 varied: differences [kNm/rad]": floats(differences / 1e3)}
    for quantity, name in NAMES.items():
        told[f"{LIGHT:g} Nms/rad: {name} [{UNITS[quantity]}]"] = floats(sizes[:, quantity])
        told[f"{LIGHT:g} Nms/rad: {name}, R²"] = _straightness(differences, sizes[:, quantity])
    return told


def _onsets(model: Model) -> dict[str, Figure]:
    def built(difference: float, damping: float | None) -> Model:
        return stepped(model, SOFT, SOFT + difference, damping)

    return {
        "onset, shipped damping [kNm/rad]": onset(partial(built, damping=None), 2e3, 14e3) / 1e3,
        f"onset, {LIGHT:g} Nms/rad [kNm/rad]": onset(partial(built, damping=LIGHT), 1e3, 8e3) / 1e3,
    }


def _kinds(which: int) -> dict[str, tuple[int, str]]:
    """Of every quantity its place and what is told of it: amplitudes (1) or the mean torques they occur at (2)."""
    return {name: (q, KINDS[q] if which == 1 else "torque") for q, name in NAMES.items()}


@claim(
    "B3",
    "6.1",
    "The mean torque of the largest vibration of order 1.5 lies above the transition between the stages.",
    "strictly above in every case of B2 at the model's damping, for all quantities; where the second, light damping "
    "has cases that lie below, that is the condition",
    varies="the stiffnesses and the damping as in B2",
    picture=draw_peaks,
    leading="lowest mean torque over the transition's [-]",
    trucks=40,
)
def b3(trucks: Trucks) -> Finding:
    found = cases(trucks.two_stage)
    transition = transition_torque(trucks.two_stage)
    lowest = {name: table(found[name])[2].min(axis=0) for name in found}
    figures: dict[str, Figure] = {"transition torque [Nm]": transition}
    for name, told in (("k2", "k2 varied"), ("k1", "k1 varied"), ("light", f"{LIGHT:g} Nms/rad, k2 varied")):
        figures |= {f"{told}: lowest for the {NAMES[q]} [Nm]": float(lowest[name][q]) for q in NAMES}
    least = float(np.concatenate([lowest["k2"], lowest["k1"]]).min())
    figures["lowest mean torque over the transition's [-]"] = least / transition
    good = least > transition
    below = [NAMES[q] for q in NAMES if lowest["light"][q] <= transition]
    at = {"damping": LIGHT, "speed": quiet_speed(trucks.two_stage) / RPM, "lowest": float(lowest["light"].min())}
    proviso = BELOW.format(quantities=" and ".join(below), **at) if below and good else ""
    reason = "" if good else f"the lowest lies at {least / transition:.3f} of the transition's torque"
    limit = {"limit": transition, "limit_words": "transition between the stages"}
    data = peaks("B3", found, _kinds(2), 2, list(NAMES.values()), told="mean torque of the largest", **limit)
    return Finding(good, CONDITION, figures, reason, data, proviso)


@claim(
    "B4",
    "6.1",
    "That mean torque varies almost linearly with the difference of the stiffnesses.",
    "R² above 0.95, k2 varied and k1 varied, the largest torque in the DMF located along branches to about 2 Nm",
    varies="the stiffnesses and the damping as in B2",
    picture=draw_peaks,
    leading="lowest R² of what is judged [-]",
    trucks=40,
)
def b4(trucks: Trucks) -> Finding:
    found = cases(trucks.two_stage)
    figures: dict[str, Figure] = {}
    straight = []
    for name in ("k2", "k1"):
        differences, _, torques = table(found[name])
        slope = np.polyfit(differences / 1e3, torques[:, SPRING], 1)[0]
        figures[f"{name} varied: differences [kNm/rad]"] = floats(differences / 1e3)
        figures[f"{name} varied: mean torque [Nm]"] = floats(torques[:, SPRING])
        figures[f"{name} varied: slope [Nm per kNm/rad]"] = float(slope)
        figures |= {f"{name} varied: R² for the {NAMES[q]}": _straightness(differences, torques[:, q]) for q in NAMES}
        straight.append(_straightness(differences, torques[:, SPRING]))
    light = table(found["light"])
    figures[f"{LIGHT:g} Nms/rad, k2 varied: mean torque [Nm]"] = floats(light[2][:, SPRING])
    figures[f"{LIGHT:g} Nms/rad, k2 varied: R²"] = _straightness(light[0], light[2][:, SPRING])
    figures["lowest R² of what is judged [-]"] = min(straight)
    told = "mean torque of the largest"
    data = peaks("B4", found, _kinds(2), 2, [NAMES[SPRING]], regression=1, told=told)
    return Finding(min(straight) > 0.95, CONDITION, figures, dataset=data)
