"""The engine's cylinders as a drive in time: gas torque over the crank's own angle, reciprocating masses, friction."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from torsional.arguments import checked_fields
from torsional.engine import CombustionCycle, Engine
from torsional.engine.excitation import checked_nodes
from torsional.engine.orders import CYCLE, crank_angle_grid
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.solvers.operating import torque_places
from torsional.solvers.transient.acting import Acting, Crank, Leak, Source, row_of
from torsional.solvers.transient.drags import Drag, taken
from torsional.solvers.transient.drives import at_start
from torsional.solvers.transient.profiles import Level, Profile, level_of, through
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.system import System

RECIPROCATING = ("exact", "half-share", "none")
SAMPLES = 2880
"""Crank angles of one cycle at which the engine is asked: every quarter of a degree."""
SQUARES = 33
"""Knots of the square of a speed that changes."""
ABOVE = 1e-9
KEPT = 8
"""Operating points that are kept worked out, some 2 MB each."""
NOTHING = Level(np.zeros(1), np.zeros(1))


@dataclass(frozen=True, eq=False)
@checked_fields
class CylinderTorques:
    """Cylinders of an ``engine`` on ``nodes`` (one a throw, or one for all) as they burn at a mean ``speed`` [rad/s]
    and brake ``torque`` [Nm].

    ``level`` over ``level_times`` [s] is the heat of combustion: 1 that of the operating point, 0 a motored engine
    (with the intake pressure of no load), between them in proportion, with the friction that its pressure adds.  The
    friction of the motored engine acts against the crank's own speed, see `friction`, and holds it at standstill.
    ``feedback``: the crank's own motion moves the events, friction grows with it, and cylinders that stand lose their
    charge past the rings within the engine's ``leakage_time``.  ``reciprocating``: "exact" gives
    −m x'(x'' θ̇² + x' θ̈) with the instantaneous speed, less the half-share m r²/2 that is in the throw's inertia;
    "half-share" −m x' x'' Ω² at the mean speed, as in the frequency domain; "none" leaves it out.
    Raises ModelError for anything else, and as `Engine.operated` does.

    >>> import torsional
    >>> truck = torsional.load_model("examples/truck_dmf.yaml")
    >>> drive = CylinderTorques(truck.engine, truck.landmarks.throws, 1000 * torsional.RPM, 2000.0)
    >>> len(drive.nodes), drive.torque
    (6, 2000.0)
    """

    engine: Engine
    nodes: tuple[str, ...]
    speed: float
    torque: float
    level: tuple[float, ...] = (1.0,)
    level_times: tuple[float, ...] = (0.0,)
    feedback: bool = True
    reciprocating: str = "exact"

    def __post_init__(self) -> None:
        for name in ("level", "level_times"):
            object.__setattr__(self, name, tuple(float(v) for v in np.atleast_1d(getattr(self, name))))
        object.__setattr__(self, "nodes", checked_nodes(self.nodes, self.engine.layout.throw_count))
        level_of(self.level_times, self.level, "level")
        if self.reciprocating not in RECIPROCATING:
            allowed = ", ".join(RECIPROCATING)
            raise ModelError("unknown way", where="reciprocating", found=self.reciprocating, allowed=allowed)

    @classmethod
    def of(
        cls,
        model: Model,
        speed: float,
        torque: float,
        *,
        level: Sequence[float] = (1.0,),
        level_times: Sequence[float] = (0.0,),
        feedback: bool = True,
        reciprocating: str = "exact",
    ) -> CylinderTorques:
        """The engine of a ``model`` on its throws."""
        engine, throws = model.running_engine, torque_places(model).throws
        given = tuple(level), tuple(level_times)
        return cls(engine, throws, speed, torque, *given, feedback, reciprocating)

    def acting(self, system: System, speed: SpeedProfile) -> Acting:
        """Two sources a throw, motored and burnt; one crank a cylinder, or one more source a throw."""
        rows = [row_of(system, node) for node in self.nodes]
        gas = self._gas(rows)
        found = Acting(gas, taken_up=at_start(Acting(gas)), leaks=self._leaks(rows))
        found = found.joined(self._rubbing(rows, speed))
        if self.reciprocating == "exact":
            return found.joined(Acting(cranks=self._cranks(rows)))
        if self.reciprocating == "half-share":
            return found.joined(Acting(self._masses(rows, speed)))
        return found

    def profiles(self) -> tuple[tuple[Profile, ...], tuple[Profile, ...]]:
        """Gas torque of each node, motored, and what combustion adds to it, less what that adds to friction."""
        worked = self._worked
        return worked.motored, worked.burning

    @property
    def _worked(self) -> _Worked:
        """What the operating point comes to; models that share an engine share it."""
        return _worked_out(_Same(self.engine), self.speed, self.torque, len(self.nodes) > 1)

    def friction(self) -> tuple[Array, Array]:
        """Friction of the motored engine on each node: dry [Nm], and growing with the whole speed [Nms/rad].

        FMEP V/4π; dry is what it has at standstill, the rest a straight line from there to ``speed``.  Without
        ``feedback`` all of it is dry, so that it damps no vibration.
        """
        dry, more = self._worked.friction
        if not (self.feedback and self.speed):
            return dry + more, np.zeros_like(more)
        return dry, more / self.speed

    def _rubbing(self, rows: Sequence[Array], speed: SpeedProfile) -> Acting:
        """Friction of every node, and the mean torque that it takes."""
        frame, start = speed.level, float(speed.at(0.0))
        drags, taken_up = [], []
        for node, row, dry, damping in zip(self.nodes, rows, *self.friction(), strict=True):
            ratio = float(row.sum())
            drags.append(Drag(f"friction_{node}", row, dry, damping, float(taken(dry, damping, ratio * start))))
            taken_up.append((row, Level(frame.time, -taken(dry, damping, ratio * frame.value))))
        return Acting(taken_up=tuple(taken_up), drags=tuple(drags))

    def _gas(self, rows: Sequence[Array]) -> tuple[Source, ...]:
        motored, burnt = self.profiles()
        level = Level(np.array(self.level_times), np.array(self.level))
        follows = float(self.feedback)
        still = [Source(row, p, None, follows) for row, p in zip(rows, motored, strict=True)]
        hot = [Source(row, p, level, follows, governed=True) for row, p in zip(rows, burnt, strict=True)]
        return (*still, *hot)

    def _leaks(self, rows: Sequence[Array]) -> tuple[Leak, ...]:
        """The charge of each cylinder, (c − 1) A x' p being its torque beyond that of the motored engine."""
        if not self.feedback:
            return ()
        engine, layout, (shapes, ratios) = self.engine, self.engine.layout, self._worked.charge
        gas = engine.gas if isinstance(engine.gas, CombustionCycle) else CombustionCycle()
        window = gas.exhaust_opening, CYCLE + gas.intake_closing
        found = []
        for throw, angle, g in zip(layout.throws, layout.firing_angles, engine.groups.of_cylinder, strict=True):
            source = Source(self._of_throw(rows, throw), shapes[g], NOTHING, 1.0, -float(angle))
            found.append(Leak(source, ratios[g], 1.0 / engine.leakage_time, *window))
        return tuple(found)

    def _of_throw(self, rows: Sequence[Array], throw: int) -> Array:
        """The row of a throw, or that of the one node for all."""
        return rows[throw - 1 if len(rows) > 1 else 0]

    def _cranks(self, rows: Sequence[Array]) -> tuple[Crank, ...]:
        engine, crank = self.engine, self.engine.crank
        mass = engine.reciprocating_mass
        lengths = crank.crank_radius, crank.rod_length, crank.pin_offset
        on = [self._of_throw(rows, throw) for throw in engine.layout.throws]
        included = crank.half_share(mass)
        firing = engine.layout.firing_angles
        return tuple(Crank(row, -float(angle), mass, *lengths, included) for row, angle in zip(on, firing, strict=True))

    def _masses(self, rows: Sequence[Array], speed: SpeedProfile) -> tuple[Source, ...]:
        engine, alpha = self.engine, crank_angle_grid(SAMPLES)
        throws = np.zeros((engine.layout.throw_count, SAMPLES))
        for throw, firing in zip(engine.layout.throws, engine.layout.firing_angles, strict=True):
            throws[throw - 1] += engine.crank.reciprocating_torque(engine.reciprocating_mass, 1.0, alpha - firing)
        time = speed.crossings(np.linspace(*speed.range, SQUARES))
        level = Level(time, speed.at(time) ** 2)
        follows = float(self.feedback)
        profiles = [through(torque, 2.0) for torque in _on_nodes(throws, len(self.nodes) > 1)]
        return tuple(Source(row, p, level, follows) for row, p in zip(rows, profiles, strict=True))


class _Worked(NamedTuple):
    """What an operating point of an engine comes to: profiles of each node ``motored`` and what is ``burning``, the
    ``friction`` of the motored engine on each node [Nm], at standstill and what its speed adds, and of each group of
    cylinders the torque of its ``charge`` and the crankcase's pressure over its own."""

    motored: tuple[Profile, ...]
    burning: tuple[Profile, ...]
    friction: tuple[Array, Array]
    charge: tuple[tuple[Profile, ...], tuple[Profile, ...]]


class _Same(NamedTuple):
    """An engine that is asked by what it is, not by what it holds."""

    engine: Engine

    def __hash__(self) -> int:
        return id(self.engine)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and other.engine is self.engine


@lru_cache(maxsize=KEPT)
def _worked_out(same: _Same, speed: float, torque: float, each: bool) -> _Worked:
    """The same for every throw, ``each`` on a node of its own, or for all of them on one."""
    engine, least = same.engine, float(same.engine.motored_torque(speed))
    nothing = least + ABOVE * abs(least)  # brake torque of the motored engine
    motored, burning = (
        _on_nodes(engine.torque(speed, brake, crank_angle_grid(SAMPLES), reciprocating=False), each)
        for brake in (nothing, torque)
    )
    friction = _friction(engine, speed, nothing, each)
    pressures = engine.operated(speed, nothing).coefficients[0] @ engine.pressure_shapes.shapes
    return _Worked(
        _profiles(motored + np.add(*friction)[:, None]),
        _profiles(burning - motored),
        friction,
        (_profiles(engine.cylinder.lever * pressures), _profiles(engine.crankcase_pressure / pressures)),
    )


def _friction(engine: Engine, speed: float, motored: float, each: bool) -> tuple[Array, Array]:
    """Friction of the motored engine on each node [Nm]: at standstill, and what its speed adds."""
    arm = engine.cylinder.displacement / CYCLE
    law = engine.friction
    own = arm * float(law.base(engine.mean_piston_speed(speed)) - law.base(0.0))
    whole = engine.mean_torque_split(speed, motored).friction
    more = own * engine.layout.throw_members.sum(axis=1)
    return _on_nodes(whole - more, each), _on_nodes(more, each)


def _on_nodes(torque: Array, each: bool) -> Array:
    """What the throws have (throws, …) as what the nodes have."""
    return torque if each else torque.sum(axis=0, keepdims=True)


def _profiles(rows: Array) -> tuple[Profile, ...]:
    return tuple(through(row, 2.0) for row in rows)
