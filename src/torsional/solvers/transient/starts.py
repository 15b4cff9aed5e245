"""Where a run in time begins: at rest, in equilibrium, vibrating already, from another run or a periodic motion."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from torsional.engine import SliderCrank
from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray
from torsional.numerics.linear.null_space import null_vectors
from torsional.numerics.stepping.state import State as Standing
from torsional.solvers.equilibrium import settled
from torsional.solvers.transient.acting import Acting, Crank, Source, row_of
from torsional.solvers.transient.profiles import Profile, through
from torsional.system import System

STARTS = "rest, equilibrium, vibrating, a MotionState, a result of transient, harmonic_response or periodic_response"
UNBALANCED = 1e-9
ENDING = ("angle", "speed", "memory", "integral")
SMALL, HARMONICS, SAMPLES = 1e-6, 40, 720


@dataclass(frozen=True, eq=False)
class MotionState:
    """A moment of a line: ``time`` [s], ``angle`` [rad] and ``speed`` [rad/s] of the coordinates as deviations,
    ``memory`` [rad] of the connections' laws (zero without), ``integral`` of the governors (empty: zero), ``reference``
    rotation that dampers count from [rad/s] (None: the reference node's), ``charge`` of the cylinders less one (None:
    full).  A march leaves besides its own ``standing`` and ``step``, from which it goes on to the last bit.

    >>> from torsional.components import Inertia
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> MotionState.at_rest(assemble(Powertrain({"disc": Inertia(1.0)}))).moved(0.1, [2.0]).speed.tolist()
    [2.0]
    """

    time: float
    angle: Array
    speed: Array
    memory: Array
    integral: Array
    reference: float | None = None
    standing: Standing | None = None
    step: float = 0.0
    charge: Array | None = None

    @classmethod
    def at_rest(cls, system: System, time: float = 0.0) -> MotionState:
        """No deviation and nothing remembered."""
        still = np.zeros(len(system.coordinates))
        return cls(time, still, still.copy(), np.zeros(len(system.connections.names)), np.zeros(0))

    def since(self, time: float) -> MotionState:
        """The same at another time [s]."""
        return replace(self, time=time, standing=None, step=0.0)

    def moved(self, angle: Array | float, speed: Array | float, memory: Array | float = 0.0) -> MotionState:
        """The state a little off, at the same time."""
        moved = (self.angle + angle, self.speed + speed, self.memory + memory)
        return MotionState(self.time, *moved, self.integral, self.reference, charge=self.charge)

    @classmethod
    def ending(cls, run: xr.Dataset, system: System) -> MotionState:
        """The last moment of a run, of a steady motion its crank angle zero; ModelError for one of another line."""
        if run.sizes["coordinate"] != len(system.coordinates) or run.end_angle.ndim > 1:
            remedy = "choose one run of several, of the same line"
            raise ModelError("the run does not fit the line", where="start", remedy=remedy)
        angle, speed, memory, integral = (np.asarray(run[f"end_{name}"].values, dtype=float) for name in ENDING)
        turning = float(run.attrs.get("end_reference", np.nan))
        reference = turning if np.isfinite(turning) else None
        charge = np.asarray(run.end_charge.values, dtype=float) if "end_charge" in run else None
        time = float(run.attrs.get("end_time", 0.0))
        return cls(time, angle, speed, memory, integral, reference, charge=charge)


def starting(start: object, system: System, acting: Acting, hold: str, speed: float) -> MotionState:
    """The state that ``start`` means; raises ModelError for what means none."""
    count = len(system.connections.names)
    if isinstance(start, MotionState):
        state = start
    elif isinstance(start, xr.Dataset) and "end_angle" in start:
        state = MotionState.ending(start, system)
    else:
        state = _found(start, system, acting, hold, speed)
        state = replace(state, memory=state.memory[: count - len(acting.drags)])
    if len(state.memory) == count:
        return state
    more = [drag.memory(state.speed, speed) for drag in acting.drags]
    return replace(state, memory=np.append(state.memory, more)[:count], standing=None)


def _found(start: object, system: System, acting: Acting, hold: str, speed: float) -> MotionState:
    """The state that a word or a motion means."""
    if isinstance(start, xr.Dataset):
        return _periodic_state(start, system, acting, hold)
    if start is None or start == "equilibrium":
        return _equilibrated(system, acting, hold, speed)
    if start == "vibrating":
        return vibrating(system, acting, hold, speed)
    if start == "rest":
        return MotionState.at_rest(system)
    raise ModelError("no start", where="start", found=repr(start)[:60], allowed=STARTS)


def _equilibrated(system: System, acting: Acting, hold: str, speed: float) -> MotionState:
    """Every spring twisted by the mean torques of the time zero, all nodes at one speed.

    A free line gets the rigid speed at which its drives let it go without drifting.
    """
    moving = vibrating(system, acting, hold, speed)
    v = np.full(len(system.coordinates), float((system.M @ moving.speed).sum() / system.M.sum()))
    still = MotionState.at_rest(system)
    angle = _mean_angles(system, acting, hold)
    return MotionState(0.0, angle, still.speed if grounded(system) else v, still.memory, still.integral)


def _mean_angles(system: System, acting: Acting, hold: str) -> Array:
    """Coordinates [rad] in equilibrium under the mean torques of the time zero, the node ``hold`` at rest."""
    load = _mean_load(acting, len(system.coordinates))
    if not np.abs(load).max(initial=0.0) > 0:
        return np.zeros(len(load))
    size = max((float(np.abs(source.row).max()) * _mean(source) for source in acting.sources), key=abs, default=0.0)
    return _angles_of(system, _balanced_twists(system, load, hold, abs(size)), hold)


def vibrating(system: System, acting: Acting, hold: str, speed: float) -> MotionState:
    """The steady response to the drives at the crank angle zero, each law a spring and a damper of its own slopes in
    equilibrium: close to where a steady run ends."""
    angle, still = _mean_angles(system, acting, hold), MotionState.at_rest(system)
    if speed <= 0:
        return MotionState(0.0, angle, still.speed, still.memory, still.integral)
    k, d = tangents(system, angle, speed)
    rows = system.connections.weights
    stiffness, damping = (rows.T * k) @ rows, (rows.T * d) @ rows
    moved, rate = np.zeros(len(angle)), np.zeros(len(angle))
    driven = harmonics(acting, len(angle), speed)
    w = np.array(list(driven))[:, None, None] * speed
    loads = np.array(list(driven.values())).reshape(len(w), len(angle), 1)
    q = np.linalg.solve(stiffness + 1j * w * damping - w * w * system.M, loads)[..., 0]
    for own, turning in zip(q, w[:, 0, 0], strict=True):
        moved, rate = moved + own.real, rate + (1j * turning * own).real
    return MotionState(0.0, angle + moved, rate, still.memory, still.integral)


def harmonics(acting: Acting, coordinates: int, speed: float) -> dict[float, ComplexArray]:
    """Complex 0-peak torques on the coordinates by order of the frame's rotation, at the levels of the time zero."""
    parts = [(s.row, s.profile, 1.0 if s.level is None else float(s.level.at(0.0)), s.phase) for s in acting.sources]
    cranks = {crank[2:]: _crank_profile(crank) for crank in acting.cranks}
    parts += [(c.row, cranks[c[2:]], speed**2, c.phase) for c in acting.cranks]
    told = [
        (row, *_lines(profile, level), phase) for row, profile, level, phase in parts if profile is not None and level
    ]
    places = {order: place for place, order in enumerate(dict.fromkeys(o for _, own, _, _ in told for o in own))}
    table = np.zeros((len(places), coordinates), dtype=complex)
    for row, orders, series, phase in told:
        turned = series * np.exp(1j * np.array(orders) * phase)
        table[[places[order] for order in orders]] += row * turned[:, None]
    return dict(zip(places, table, strict=True))


def _lines(profile: Profile, level: float) -> tuple[list[float], ComplexArray]:
    """The orders of a profile at a level that count, above 0, and their complex 0-peak torques."""
    series = level * np.fft.rfft(profile.coefficients[:, 0]) * 2 / len(profile.coefficients)
    size = np.abs(series)
    counts = np.flatnonzero((size > SMALL * size.max(initial=0.0))[: len(series) - 1])[: 2 * HARMONICS]
    counts = counts[counts > 0]
    return [round(h / profile.period, 9) for h in counts.tolist()], series[counts]


def _crank_profile(crank: Crank) -> Profile:
    """Torque of a reciprocating mass at a steady speed over Ω² [kgm²]."""
    alpha = 2 * np.pi * np.arange(SAMPLES) / SAMPLES
    shape = SliderCrank(crank.radius, crank.rod, crank.offset)
    return through(shape.reciprocating_torque(crank.mass, 1.0, alpha), 1.0)


def tangents(system: System, angle: Array, speed: float) -> tuple[ComplexArray, Array]:
    """Slopes of all connections at rest at the coordinates ``angle``: stiffness [Nm/rad], its hysteretic part the
    imaginary one and the centrifugal part in it, and damping [Nms/rad]; laws of the whole speed slide and have none."""
    c = system.connections
    twist = c.weights @ angle
    k, d = c.stiffness * (1 + 1j * c.loss_factor) + speed**2 * c.centrifugal_stiffness, c.damping.copy()
    for i, law in enumerate(c.laws):
        if law is not None and not c.whole_speed[i]:
            told = law.evaluate(twist[i])
            k[i], d[i] = k[i] + float(told[1]), d[i] + float(told[2])
    return np.asarray(k), d


def _mean_load(acting: Acting, coordinates: int) -> Array:
    """Mean torques on the coordinates at the time zero [Nm]."""
    load = np.zeros(coordinates)
    for source in acting.sources:
        load += source.row * _mean(source)
    for drag in acting.drags:
        load -= drag.row * drag.mean
    return load


def _mean(source: Source) -> float:
    """Mean torque of one source at the time zero [Nm]."""
    mean = source.profile.mean if source.profile is not None else 1.0
    return mean * (float(source.level.at(0.0)) if source.level is not None else 1.0)


def _balanced_twists(system: System, load: Array, hold: str, size: float) -> Array:
    """Angles of the connections under a load that must be balanced, but for rounding of torques of some ``size``."""
    free = null_vectors(system.connections.weights[_carrying(system)])
    left = np.abs(load @ free).max(initial=0.0)
    if left > UNBALANCED * max(size, np.abs(load).max()):
        raise ModelError(
            "the mean torques are not in balance, so there is no equilibrium to start from",
            where="start",
            found=f"{left:g} Nm too much",
            remedy="name the node that takes them up (hold=), or start at 'rest'" if not hold else "start at 'rest'",
        )
    return settled(system, load - free @ np.linalg.lstsq(free, load, rcond=None)[0] if free.size else load)


def _carrying(system: System) -> NDArray[np.bool_]:
    c = system.connections
    return np.asarray(
        (c.stiffness > 0) | np.array([law is not None and law.carries_mean_torque for law in c.laws], dtype=bool)
    )


def _angles_of(system: System, twist: Array, hold: str) -> Array:
    """Coordinates [rad] with given twists of the connections (smallest ones where friction alone says them), pendulums
    in the middle of their paths, the node ``hold`` at rest."""
    c = system.connections
    told = _carrying(system) | (c.centrifugal_stiffness > 0)
    q = np.asarray(np.linalg.lstsq(c.weights[told], twist[told], rcond=None)[0])
    return at_rest(system, q, hold)


def at_rest(system: System, q: Array, hold: str) -> Array:
    """The same with a node ``hold`` at rest by a rigid rotation."""
    if not hold:
        return q
    held = row_of(system, hold)
    return np.asarray(q - (held @ q) / held.sum()) if not grounded(system) else q


def grounded(system: System) -> bool:
    """Whether springs hold the line to the ground."""
    return bool(np.abs(system.connections.weights[_carrying(system)].sum(axis=1)).max(initial=0.0) > 1e-9)


def _periodic_state(found: xr.Dataset, system: System, acting: Acting, hold: str) -> MotionState:
    """The state at crank angle zero of one motion: orders of node angles at one speed, or one point of a branch.

    Without order 0 the mean is the equilibrium.  Raises ModelError where several motions are left to choose from.
    """
    if "angle" not in found or "order" not in found.angle.dims:
        raise ModelError("the dataset holds no motion", where="start", allowed=STARTS)
    single = [str(dim) for dim, size in found.sizes.items() if size == 1 and dim not in ("order", "node", "element")]
    data = found.isel(dict.fromkeys(single, 0))
    more = [str(dim) for dim in data.angle.dims if dim not in ("order", "node")]
    if more:
        remedy = f"choose one: data.isel({more[0]}=0)"
        raise ModelError("the dataset holds several motions", where="start", found=", ".join(more), remedy=remedy)
    angle = data.angle.transpose("order", "node").values
    order = np.asarray(data.order.values, dtype=float)
    rate = 1j * order * float(data.speed)
    places = [system.node_index(node) for node in system.coordinates]
    scale = system.T[places, np.arange(len(places))]
    at = [list(data.node.values).index(node) for node in system.coordinates]
    q, v = (((values[:, at] / scale).sum(axis=0)).real for values in (angle, rate[:, None] * angle))
    state = MotionState.at_rest(system)
    if 0.0 not in order:
        q = q + _mean_angles(system, acting, hold)
    return MotionState(0.0, np.asarray(q), np.asarray(v), state.memory, state.integral)
