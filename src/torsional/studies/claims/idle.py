"""The claim about a dual mass flywheel with lash at idle (B6)."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from torsional.components import GearPair
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.laws import Hinges
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.numerics.piecewise.motion import PiecewiseMotion, Trajectory
from torsional.solvers.harmonic import harmonic_response
from torsional.solvers.periodic.equations import Split
from torsional.solvers.periodic.stability import stage_bases
from torsional.solvers.transient import TorqueHistory
from torsional.studies.answers import by_peak, floats, main_order
from torsional.studies.base import Figure, Finding, claim, shown
from torsional.studies.settling import Stepped, reach_of, swing_of
from torsional.studies.swept import Along, Curve, swept
from torsional.studies.trucks import Trucks, hinged, reached, replaced, stiffness, within
from torsional.system import System, assemble

LASH = 2.0
"""Whole free angle [deg] of the case that is shown, with the model's stiffness and damping; a larger one of `LASHES`
where the free motion does not fit into it.  Angles at idle are torque over inertia and idle squared, alike on trucks of
all sizes."""
LASHES, DAMPINGS, ROOM = (1.5, 2.0, 3.0, 4.0, 6.0), (1.0, 0.5, 0.25), 1.2
"""Where sustained vibration is looked for: lash [deg] and damping over the model's; the lash that the free motion
wants, over its swing."""
PULSES = (250.0, 500.0, 1000.0)
"""Torque pulses on the crankshaft of the shipped truck [Nm], each for one period of the firing; they follow the peak of
full load."""
HARMONICS, BEFORE, SETTLING, SEEN = 6, 100, 800, 12
"""Multiples of the firing order, periods before the pulse, periods in which what follows settles, periods looked at."""
LONGEST, REPEATS = 6, 1e-6
"""Periods within which a motion must repeat itself, to which share of its largest state."""
CONDITION = (
    "one-stage DMF with lash, stiffness and damping as in the model, idle speed, gearbox in neutral, no mean torque; "
    "half peak-to-peak"
)


def neutral(model: Model, lash: float, damping: float) -> Model:
    """A copy with ``lash`` [rad] in its one-stage DMF and the gearbox in neutral: all behind the gears is left out."""
    spring = model.landmarks.springs[0]
    own = hinged(model, spring)
    listed = [(float(own.torque(max(own.stops))), stiffness(model, spring))]
    law = Hinges.staged(listed, lash=lash, stop_stiffness=float(own.tangent(2 * max(own.stops))))
    changed = replaced(model, spring, law=law, damping=damping)
    parts = {**changed.components, **changed.gears[changed.top_gear].components}
    whole = changed.replaced(components=parts, gears={}, document={})
    meshing = [name for name, part in changed.gears[changed.top_gear].components.items() if isinstance(part, GearPair)]
    nodes = reached(whole.powertrain(), [changed.landmarks.input], meshing)
    return whole.replaced(components=within(whole, nodes), document={})


@dataclass(frozen=True, eq=False)
class Idle:
    """A model in neutral with ``lash`` [rad], idling in time."""

    model: Model
    lash: float
    system: System
    timed: PiecewiseMotion

    @classmethod
    def of(cls, model: Model, lash: float, damping: float) -> Idle:
        """With lash [rad] and damping [Nms/rad] in the DMF."""
        standing = neutral(model, lash, damping)
        system, speed = assemble(standing.powertrain()), model.operation.idle
        load = _excited(standing)
        onto = np.array([system.T[system.node_index(node)] for node in load.nodes])
        torques = np.concatenate([np.zeros((1, len(onto[0]))), load.torque.T @ onto])
        timed = PiecewiseMotion(stage_bases(Split(system, speed)), torques, main_order(model) * speed)
        return cls(standing, lash, system, timed)

    @cached_property
    def inside(self) -> Array:
        """The state at the crank angle zero of the motion about the middle of the lash, which touches no spring."""
        spring = self.model.landmarks.springs[0]
        loose = assemble(replaced(self.model, spring, law=Hinges(0.0)).powertrain())
        found = harmonic_response(loose, _excited(self.model)).angle.isel(speed=0).transpose("order", "node").values
        q = np.linalg.lstsq(self.system.T, found.T, rcond=None)[0].T
        omega = self.timed.base_frequency * np.arange(1, HARMONICS + 1)[:, None]
        return self.timed.bases.coordinates.state(q.real.sum(axis=0), (1j * omega * q).real.sum(axis=0))

    @property
    def free(self) -> float:
        """Swing of the DMF's angle [rad], peak-to-peak, of the motion that touches no spring."""
        return float(np.ptp(self.twist(self.timed.run(self.inside, 1))))

    def pushed(self, state: Array, torque: float, settling: int = SETTLING) -> Array:
        """The state long after a pulse [Nm] on the crankshaft."""
        on = self.system.T[self.system.node_index(self.model.landmarks.crankshaft)] * torque
        return self.timed.flow(state, settling, pulse=(0.0, self.timed.period, on)).state

    def twist(self, motion: Trajectory) -> Array:
        """Angle of the DMF [rad] in time."""
        place = self.system.connections.names.index(self.model.landmarks.springs[0])
        return np.asarray(motion.angles @ self.system.connections.weights[place])

    def swing(self, motion: Trajectory, node: str) -> float:
        """Half the swing of a node's speed [rad/s]."""
        return float(np.ptp(motion.rates @ self.system.T[self.system.node_index(node)]) / 2)

    def repeats(self, state: Array) -> int:
        """After how many periods of the firing a motion repeats itself; 0 for none up to `LONGEST`."""
        strobes = [state]
        for _ in range(2 * LONGEST):
            strobes.append(self.timed.flow(strobes[-1], 1).state)
        seen = np.array(strobes)
        gaps = [np.abs(seen[n:] - seen[:-n]).max() / np.abs(seen).max() for n in range(1, LONGEST + 1)]
        return next((n for n, gap in enumerate(gaps, 1) if gap < REPEATS), 0)

    def sustained(self) -> float:
        """The smallest of `PULSES` after which the springs keep being met, or infinity."""
        free = self.free
        for torque in map(float, by_peak(self.model, np.array(PULSES))):
            end = self.pushed(self.inside, torque)
            if np.ptp(self.twist(self.timed.run(end, SEEN))) > max(1.2 * free, 1.001 * self.lash):
                return torque
        return np.inf


def _excited(model: Model) -> Excitation:
    """The engine's torques at idle without mean torque, in multiples of its firing order."""
    orders = main_order(model) * np.arange(1, HARMONICS + 1)
    return model.running_engine.excitation(model.landmarks.throws, model.operation.idle, 0.0, orders)


@claim(
    "B6",
    "3.3",
    "At idle inside the lash the secondary side is isolated; a torque disturbance can push the motion past the lash "
    "and start sub-harmonic vibration.",
    "runs in time with a torque pulse, exact between springs and by time steps: before it the springs are not met and "
    "the gearbox input swings by less than a quarter of the crankshaft; after it the springs keep being met, the "
    "motion repeats itself after two periods of the firing or more, and the input swings at least twice as much as "
    "before",
    varies="time, before and long after a torque pulse; lash 1.5° to 6° and damping × 1, 0.5, 0.25 for the region",
    leading="swing of the input, after over before [-]",
    trucks=40,
)
def b6(trucks: Trucks) -> Finding:
    model, spring = trucks.dmf, trucks.dmf.landmarks.springs[0]
    own = float(model.components[spring].damping)  # type: ignore[attr-defined]
    idle = roomy(model, own)
    start = idle.timed.flow(idle.inside, BEFORE)
    torque = idle.sustained()
    before, after = idle.timed.run(start.state, SEEN), None
    dampings = [share * own for share in DAMPINGS]
    region = {c: [Idle.of(model, np.deg2rad(lash), c).sustained() for lash in LASHES] for c in dampings}
    quiet, marks = idle.swing(before, model.landmarks.input), model.landmarks
    figures: dict[str, Figure] = {
        "lash [deg]": float(np.rad2deg(idle.lash)),
        "before: DMF twist [deg]": floats(np.rad2deg([idle.twist(before).min(), idle.twist(before).max()])),
        "before: crankshaft and input speed [rad/s]": (idle.swing(before, marks.crankshaft), quiet),
    }
    figures["swing of the input, after over before [-]"] = 1.0
    good = len(start.times) == 1 and quiet < 0.25 * idle.swing(before, marks.crankshaft)
    if np.isfinite(torque):
        end = idle.pushed(start.state, torque)
        after, count = idle.timed.run(end, SEEN), idle.repeats(end)
        loud = idle.swing(after, marks.input)
        figures |= {
            "pulse for one period of the firing [Nm]": torque,
            "after: DMF twist [deg]": floats(np.rad2deg([idle.twist(after).min(), idle.twist(after).max()])),
            "after: crankshaft and input speed [rad/s]": (idle.swing(after, marks.crankshaft), loud),
            "after: order of the slowest part [-]": main_order(model) / count if count else np.nan,
            "swing of the input, after over before [-]": loud / quiet,
        }
        steps = pulsed(idle, torque)
        figures |= {f"by time steps, {name}": value for name, value in told(idle, *steps).items()}
        good = good and count > 1 and loud > 2 * quiet and _as_said(idle, *steps)
    figures |= {f"{c:.3g} Nms/rad: lashes with sustained vibration [deg]": _met(told) for c, told in region.items()}
    return Finding(good and after is not None, CONDITION, figures, _reason(model, region), _drawn(idle, before, after))


def roomy(model: Model, damping: float) -> Idle:
    """Idle with the smallest lash, from `LASH` on, into which the free motion fits; ModelError where there is none."""
    for lash in (LASH, *(lash for lash in LASHES if lash > LASH)):
        idle = Idle.of(model, np.deg2rad(lash), damping)
        if ROOM * idle.free < idle.lash:
            return idle
    raise ModelError(
        "the motion at idle is wider than the lash, so the springs are always met",
        where=model.landmarks.springs[0],
        found=f"{np.rad2deg(idle.free):.1f} deg of free motion",
        allowed=f"up to {max(LASHES) / ROOM:g} deg",
        remedy="raise the inertia of the primary flywheel, or idle",
    )


def pulsed(idle: Idle, torque: float) -> tuple[xr.Dataset, xr.Dataset, int]:
    """Runs by time steps before a pulse [Nm] and long after it, and after how many periods of the firing the latter
    repeats itself (0: it does not)."""
    marks, line = idle.model.landmarks, Stepped(idle.system, _excited(idle.model))
    before = line.run("vibrating", BEFORE)
    begins, ends = before.attrs["end_time"], before.attrs["end_time"] + line.period
    on = TorqueHistory(marks.crankshaft, (begins, begins, ends, ends), (0.0, torque, torque, 0.0))
    settled = line.settled(line.run(before, SETTLING, on))
    return before, line.run(settled, SEEN), settled.attrs["periods"]


def told(idle: Idle, before: xr.Dataset, after: xr.Dataset, count: int) -> dict[str, Figure]:
    """The figures of runs by time steps."""
    marks, spring = idle.model.landmarks, idle.model.landmarks.springs[0]
    figures: dict[str, Figure] = {}
    for name, run in (("before", before), ("after", after)):
        figures[f"{name}: DMF twist [deg]"] = floats(np.rad2deg(reach_of(run, spring)))
        swings = [swing_of(run, node) for node in (marks.crankshaft, marks.input)]
        figures[f"{name}: crankshaft and input speed [rad/s]"] = floats(swings)
    slowest = main_order(idle.model) / count if count else np.nan
    return figures | {"after: order of the slowest part [-]": slowest}


def _as_said(idle: Idle, before: xr.Dataset, after: xr.Dataset, count: int) -> bool:
    """Whether the springs are met after the pulse alone, and what the input does is as the claim has it."""
    marks = idle.model.landmarks
    free, met = (np.abs(reach_of(run, marks.springs[0])).max() for run in (before, after))
    quiet, loud = (swing_of(run, marks.input) for run in (before, after))
    isolated = free < idle.lash / 2 and quiet < 0.25 * swing_of(before, marks.crankshaft)
    return bool(isolated and met > idle.lash / 2 and count > 1 and loud > 2 * quiet)


def _met(found: list[float]) -> tuple[float, ...]:
    return tuple(lash for lash, torque in zip(LASHES, found, strict=True) if np.isfinite(torque))


def _reason(model: Model, region: dict[float, list[float]]) -> str:
    """Where nothing lasts; and why, where it is so from some lash on, at a smaller one the more damping there is."""
    lasting = np.isfinite([found for _, found in sorted(region.items())])
    if lasting.all():
        return ""
    told = f"pulses of up to {by_peak(model, max(PULSES)):.4g} Nm leave no lasting vibration"
    if not lasting.any():
        return f"{told} at any lash and damping asked"
    if any((np.diff(lasting.astype(int), axis=axis) > 0).any() for axis in (0, 1)):
        met = (f"{shown(_met(found))}° with {c:.3g} Nms/rad" for c, found in region.items() if np.isfinite(found).any())
        return f"{told} but with lashes of {'; '.join(met)}"
    return (
        f"{told} where lash and damping are large: the damping beside the springs acts within the lash too, and brings "
        "the motion to rest there before it reaches the other side"
    )


def _drawn(idle: Idle, before: Trajectory, after: Trajectory | None) -> xr.Dataset:
    """Twist of the DMF with the ends of its lash, and the speed of the input about its mean, before and after."""
    told, curves = {"before": before} | ({"after": after} if after is not None else {}), dict[str, Curve]()
    words = {"before": "before the pulse", "after": "long after it"}
    lash: dict[str, Any] = {"limit": (-idle.lash / 2, idle.lash / 2), "limit_words": "ends of the lash"}
    times = before.times - before.times[0]
    row = idle.system.T[idle.system.node_index(idle.model.landmarks.input)]
    for name, motion in told.items():
        twist, more = _at(idle.twist(motion), motion, times), lash if name == "before" else {}
        curves[f"twist_{name}"] = Curve(twist, "relative_angle", words[name], "twist of the DMF", **more)
    for name, motion in told.items():
        speed = _at(motion.rates @ row, motion, times)
        curves[f"input_{name}"] = Curve(
            speed - speed.mean(), "angular_velocity", words[name], "speed of the gearbox input about its mean"
        )
    return swept("B6", Along("time", times, "time", "time, over some periods of the firing"), curves)


def _at(values: Array, motion: Trajectory, times: Array) -> Array:
    """Values at other times from the start of a motion."""
    return np.asarray(np.interp(times, motion.times - motion.times[0], values))
