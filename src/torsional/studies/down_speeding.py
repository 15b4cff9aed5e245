"""Down-speeding at equal power, and the worst vibration that a truck then sends into its gearbox.

The engine's range moves down by Δ.  The full-load curve gives every speed n − Δ the power that n had,
T'(n − Δ) = T(n) n/(n − Δ), and the final drive keeps the vehicle's speed at one engine speed, that of cruising n_c:
i' = i (n_c − Δ)/n_c.  Idle stays where combustion and auxiliaries want it; the range moves down no further.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from torsional.components import Coupling, GearPair
from torsional.engine import FullLoad
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array, ComplexArray, size
from torsional.quantities import swing
from torsional.solvers.equilibrium import with_load_stiffness
from torsional.solvers.harmonic import response
from torsional.solvers.operating import mean_state
from torsional.studies.answers import STEP, main_order
from torsional.studies.trucks import reached, replaced
from torsional.system import System, assemble
from torsional.units import RPM, show_speed

LOADS = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Mean torques looked at, over full load.  The swing of a linear line is convex in the engine's torque, and the
engine's harmonics hardly bend over load, so that the worst is at one of the ends."""
FINE = 5 * RPM
"""Step in which a moved full-load curve is told [rad/s]: between its points power is kept to 5e-6 of the highest."""

LEVELS = 17
"""Mean torques between which a line is tried for straightness."""

SAMPLES = 180
"""Points of a cycle at which a swing is read."""

Factors = Mapping[tuple[str, str], Array]
"""Numbers of the line (name, field) times these factors, one a design."""


def cruise_speed(model: Model) -> float:
    """Engine speed [rad/s] at which the vehicle's speed is kept: where the full-load curve leaves its peak.

    There engines of trucks are matched to cruise; raises ModelError without a curve.
    """
    curve, peak = model.full_load_curve, model.full_load_peak()
    assert curve is not None
    return max(n for n, torque in zip(curve.speeds, curve.torques, strict=True) if torque >= peak * (1 - 1e-9))


def final_drive(model: Model) -> str:
    """The gear pair common to all gears that lies last on the way from the gearbox input to the load.

    Raises ModelError where there is none.
    """
    line, marks = model.powertrain(), model.landmarks
    pairs = [name for name, part in model.components.items() if isinstance(part, GearPair)]
    before = {name: reached(line, [marks.input], [name]) for name in pairs}
    between = [name for name in pairs if marks.load not in before[name]]
    if not between:
        remedy = "give the line a final drive (driveline.final_drive_ratio), or a GearPair in front of the wheels"
        raise ModelError("no final drive lies between the gearbox and the load", where=model.name, remedy=remedy)
    return max(between, key=lambda name: len(before[name]))


def moved(model: Model, by: float, cruise: float = 0.0) -> Model:
    """The truck down-speeded ``by`` Δ [rad/s] at equal power; itself where Δ is 0.

    ``cruise``: engine speed n_c [rad/s] before, at which the vehicle goes as fast afterwards (0: `cruise_speed`).
    Raises ModelError for a Δ that leaves no range above idle, and without full-load curve or final drive.
    """
    if by == 0:
        return model
    at, operation = cruise or cruise_speed(model), model.operation
    room = min(at, operation.speed[1]) - operation.idle
    if not 0 < by < room:
        allowed = f"0 to {show_speed(room)}, so that cruising stays above idle"
        raise ModelError("the range cannot move down so far", where="by", found=show_speed(by), allowed=allowed)
    low, high = operation.speed
    kept = dataclasses.replace(operation, speed=(max(low - by, min(low, operation.idle)), high - by))
    engine = dataclasses.replace(model.running_engine, full_load=_moved_curve(model, by))
    return _longer(model, (at - by) / at).replaced(engine=engine, operation=kept)


def _moved_curve(model: Model, by: float) -> FullLoad:
    """T'(n − Δ) = T(n) n/(n − Δ) on the points of the curve and finely between them."""
    curve = model.full_load_curve
    assert curve is not None
    ends = curve.speeds[0], curve.speeds[-1]
    inner = np.linspace(*ends, round((ends[1] - ends[0]) / FINE) + 1)
    n = np.unique(np.concatenate([curve.speeds, inner[np.abs(inner[:, None] - curve.speeds).min(axis=1) > 1e-6]]))
    n = n[n - by > FINE]
    return FullLoad(tuple((n - by).tolist()), tuple((curve(n) * n / (n - by)).tolist()))


def _longer(model: Model, factor: float) -> Model:
    """A copy whose final drive turns the wheels 1/``factor`` times as fast at the same engine speed."""
    name = final_drive(model)
    pair: Any = model.components[name]
    front = pair.a in reached(model.powertrain(), [model.landmarks.input], [name])
    return replaced(model, name, ratio=pair.ratio * factor if front else pair.ratio / factor)


def travels(model: Model) -> dict[str, float]:
    """The twist [rad] under driving torque at which each absorber spring meets its stop, where it has one."""
    found: dict[str, float] = {}
    for name in model.landmarks.springs:
        part = model.components[name]
        stops = getattr(part.law, "stops", ()) if isinstance(part, Coupling) else ()
        found |= {name: float(max(stops))} if stops else {}
    return found


@dataclass(frozen=True)
class Worst:
    """The worst of a truck within full load: ``acceleration`` [rad/s²] at the gearbox input in ``gear`` at ``speed``
    [rad/s] and mean ``torque`` [Nm]; ``by_gear`` and ``speed_by_gear`` in every gear; ``reach``: the largest twist of
    an absorber spring, vibration included, over the way to its stop (0 where none has one)."""

    acceleration: float
    gear: str
    speed: float
    torque: float
    by_gear: Array
    speed_by_gear: Array
    reach: float


class Bench:
    """A truck at all its operating points, ready to answer for many designs at once.

    Speeds from the low end of the range in ``step`` [rad/s] up to the high end, at each of them shares of full load.
    Each point has its own tangents.  The angle at the gearbox input under unit torques on the throws is that of the
    throws under a unit torque at the gearbox input (reciprocity: all matrices are symmetric), so that one solution
    answers for every mean torque that shares its tangents.  ``stops``: ways of the springs to their stops (default:
    `travels`); ``speed``: other speeds [rad/s] than those in steps.
    """

    def __init__(
        self,
        model: Model,
        step: float = STEP,
        loads: Sequence[float] = LOADS,
        orders: Sequence[float] = (),
        stops: Mapping[str, float] | None = None,
        gears: Sequence[str] = (),
        speed: Array | None = None,
    ) -> None:
        self.model, self.gears = model, tuple(gears or model.gear_names)
        self.speed = looked_at(model, step) if speed is None else speed
        self.torque = np.multiply.outer(np.array(loads), model.full_load(self.speed))
        self.orders = np.array(orders or (main_order(model),), dtype=float)
        self.stops = travels(model) if stops is None else dict(stops)
        drive = model.running_engine.harmonics(self.speed, self.torque, self.orders)
        self._drive = drive if len(model.landmarks.throws) > 1 else drive.sum(axis=-2, keepdims=True)
        self._lines = [_Line(self, gear) for gear in self.gears]

    def accelerations(self, factors: Factors | None = None) -> tuple[ComplexArray, Array]:
        """Complex 0-peak orders of the acceleration at the gearbox input, (designs, gears, loads, speeds, orders), and
        the reach of the springs, (designs,)."""
        found, twist, _ = self.answers(factors)
        return found, (twist / np.array(list(self.stops.values()))).max(axis=1, initial=0.0)

    def answers(self, factors: Factors | None = None) -> tuple[ComplexArray, Array, Array]:
        """The accelerations; the largest twist [rad] of each of ``stops``, mean and vibration together, and the largest
        mean power [W] that its damper takes, (designs, springs) each."""
        lines = [(line, line.solved(factors or {}, self._drive)) for line in self._lines]
        angle = np.stack([found[:, 0] for _, found in lines], axis=1)
        omega = np.multiply.outer(self.speed, self.orders)
        twist, loss = zip(*(line.springs(factors or {}, found[:, 1:]) for line, found in lines), strict=True)
        return -np.square(omega) * angle, np.max(twist, axis=0), np.max(loss, axis=0)

    def worst(self) -> Worst:
        """The worst of the model as it is: of one order its amplitude, of several half the swing over a cycle."""
        found, reach = self.accelerations()
        size = half_swing(found[0], self.orders)
        flat = size.reshape(len(self.gears), -1)
        by_gear, places = flat.max(axis=1), flat.argmax(axis=1) % self.speed.size
        g, load, s = np.unravel_index(int(size.argmax()), size.shape)
        at = self.speed[places]
        mean = float(self.torque[load, s])
        return Worst(float(by_gear[g]), self.gears[g], float(self.speed[s]), mean, by_gear, at, float(reach[0]))


class _Line:
    """One gear of a bench: its system, the tangents that occur, and which of them each operating point has."""

    def __init__(self, bench: Bench, gear: str) -> None:
        model = bench.model
        self.bench, line = bench, model.powertrain(gear)
        self.system: System = with_load_stiffness(assemble(line))
        self.angle, tangents = mean_states(model, self.system, bench.torque)
        kinds, which = np.unique(tangents.reshape(bench.torque.size, -1), axis=0, return_inverse=True)
        self.tangents = kinds.reshape(len(kinds), 2, -1)
        self.which = which.reshape(bench.torque.shape)
        weights = {stamp.name: stamp.weights for stamp in line.stamps}
        self.probes: list[Mapping[str, float]] = [{model.landmarks.input: 1.0}, *(weights[n] for n in bench.stops)]
        self.nodes = list(dict.fromkeys(node for probe in self.probes for node in probe))
        self.throws = self.system.T[[self.system.node_index(node) for node in model.landmarks.throws]]

    def solved(self, factors: Factors, drive: ComplexArray) -> ComplexArray:
        """Angle at the input and twists of the springs, (designs, 1 + springs, loads, speeds, orders)."""
        designs = max((np.size(value) for value in factors.values()), default=1)
        shape = (designs, len(self.probes), *self.which.shape, self.bench.orders.size)
        found = np.empty(shape, dtype=complex)
        for kind, (stiffness, damping) in enumerate(self.tangents):
            at = (self.which == kind).any(axis=0)
            values = self._values(factors, designs, stiffness, damping)
            seen = np.einsum("dpsot,lsto->dplso", self._probed(values, designs, at), drive[:, at])
            found[:, :, :, at] = np.where((self.which[:, at] == kind)[..., None], seen, found[:, :, :, at])
        return found

    def _values(self, factors: Factors, designs: int, stiffness: Array, damping: Array) -> dict[str, Array]:
        plain = {"stiffness": stiffness, "damping": damping}
        if any(field == "inertia" for _, field in factors):  # else inertias may switch over speed
            plain["inertia"] = self.system.masses.inertia
        values = {field: np.tile(value, (designs, 1)) for field, value in plain.items()}
        for (name, field), factor in factors.items():
            owner = self.system.masses if field == "inertia" else self.system.connections
            values[field][:, owner.names.index(name)] *= factor
        return values

    def _probed(self, values: dict[str, Array], designs: int, at: Array) -> ComplexArray:
        """Angles of the throws under a unit torque on each probe, (designs, probes, speeds, orders, throws)."""
        speed, orders, probes = self.bench.speed[at], self.bench.orders, len(self.probes)
        omega, turning = np.outer(speed, orders).ravel(), np.repeat(speed, orders.size)
        rows = np.array([[probe.get(node, 0.0) for node in self.nodes] for probe in self.probes], dtype=complex)
        loads = np.broadcast_to(rows[:, None, :], (probes, omega.size, len(self.nodes)))
        each = {field: np.repeat(value, probes, axis=0) for field, value in values.items()}
        q, _ = response(self.system, omega, turning, self.nodes, np.tile(loads, (designs, 1, 1)), each)
        return np.asarray((q @ self.throws.T).reshape(designs, probes, speed.size, orders.size, -1))

    def springs(self, factors: Factors, twist: ComplexArray) -> tuple[Array, Array]:
        """Largest twist, the mean one included, and largest mean power ½ c |ωφ|² of their dampers, (designs, springs);
        ``twist`` (designs, springs, loads, speeds, orders)."""
        largest, power = np.empty((2, *twist.shape[:2]))
        omega = np.multiply.outer(self.bench.speed, self.bench.orders)
        for place, name in enumerate(self.bench.stops):
            at = self.system.connections.names.index(name)
            stiffer, damper = (np.atleast_1d(factors.get((name, f), np.ones(1))) for f in ("stiffness", "damping"))
            mean = np.abs(self.angle[..., at]) / stiffer[:, None, None]
            largest[:, place] = (mean + np.abs(twist[:, place]).sum(axis=-1)).max(axis=(1, 2))
            lost = (self.tangents[self.which][..., 1, at, None] * np.abs(omega * twist[:, place]) ** 2).sum(axis=-1)
            power[:, place] = 0.5 * damper * lost.max(axis=(1, 2))
        return largest, power


def looked_at(model: Model, step: float) -> Array:
    """Speeds [rad/s] from the low end of the range in steps, the high end, and where the full-load curve is highest."""
    (low, high), curve = model.operation.speed, model.full_load_curve
    peak = () if curve is None else (curve.speeds[int(np.argmax(curve.torques))],)
    inside = [n for n in peak if low < n < high]
    return np.unique(np.concatenate([np.arange(low, high - 0.01 * step, step), inside, [high]]))


def mean_states(model: Model, system: System, torque: Array) -> tuple[Array, Array]:
    """Twists [rad] of all connections under mean torques and their tangents (stiffness, damping), on further axes.

    Between two of a few levels at which every law has the same tangent, that of its chord, the line is straight and
    interpolation exact; elsewhere each torque has its own equilibrium.
    """
    levels = np.linspace(0.0, float(torque.max()), LEVELS)
    state = mean_state(model, system, levels)
    both = np.stack([state.stiffness, state.damping], axis=1)
    bent = np.array([law is not None for law in state.laws])
    chord = np.diff(state.torque, axis=0) - state.stiffness[:-1] * np.diff(state.angle, axis=0)
    straight = (both[1:] == both[:-1]).all(axis=(1, 2)) & (np.abs(chord)[:, bent] < 1e-9 * levels[-1]).all(axis=1)
    flat = torque.ravel()
    below = np.clip(np.searchsorted(levels, flat, side="right") - 1, 0, LEVELS - 2)
    share = ((flat - levels[below]) / levels[1])[:, None]
    angle, tangents = (1 - share) * state.angle[below] + share * state.angle[below + 1], both[below]
    if (own := ~straight[below]).any():
        exact = mean_state(model, system, flat[own])
        angle[own], tangents[own] = exact.angle, np.stack([exact.stiffness, exact.damping], axis=1)
    return angle.reshape(*torque.shape, -1), tangents.reshape(*torque.shape, 2, -1)


def half_swing(found: ComplexArray, orders: Array) -> Array:
    """Half the peak-to-peak over an engine cycle, ``orders`` on the last axis; of a single one its amplitude."""
    if orders.size == 1:
        return size(found[..., 0])
    dims = [f"axis{i}" for i in range(found.ndim - 1)]
    return np.asarray(swing(xr.DataArray(found, dims=[*dims, "order"], coords={"order": orders}), SAMPLES).values)


def worst(model: Model) -> Worst:
    """The worst firing-order acceleration at the gearbox input over speeds, loads within full load and gears."""
    return Bench(model).worst()
