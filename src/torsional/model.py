"""Model: what a model file describes, from which powertrains are made gear by gear."""

from __future__ import annotations

import hashlib
import itertools
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from html import escape
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from torsional.absorbers import Absorber
from torsional.arguments import checked_fields
from torsional.components import Component
from torsional.engine import Engine, FullLoad
from torsional.engine.orders import HALF_ORDERS, BoolArray
from torsional.errors import ModelError, nearest
from torsional.notebook import components_table, html_table
from torsional.numerics.arrays import Array
from torsional.powertrain import Powertrain, exchanged, named
from torsional.units import RPM

NOTABLE = 0.05
"""Share of the main order below which an engine's order is not worth a line in a diagram."""


@dataclass(frozen=True)
@checked_fields
class Gear:
    """One gear: its ``ratio`` [-], input over output speed, and the ``components`` in the line while it is engaged."""

    ratio: float
    components: Mapping[str, Component]


@dataclass(frozen=True)
@checked_fields
class Operation:
    """Where the machine runs: ``idle`` and ``speed`` (from, to) [rad/s]; ``torque`` (from, to) [Nm] or None for
    zero to full load."""

    idle: float = 600 * RPM
    speed: tuple[float, float] = (600 * RPM, 2000 * RPM)
    torque: tuple[float, float] | None = None


@dataclass(frozen=True)
@checked_fields
class Landmarks:
    """The user's names for the places that analyses ask for; empty where the machine has none.

    ``throws``: nodes on which the cylinders act; ``crankshaft``: node that stands for the engine's speed; ``load``:
    node where the mean torque is taken up; ``input``: the node to be kept quiet (gearbox input); ``springs``: the
    absorber's connections; ``clutch``: the clutch damper.

    >>> Landmarks(crankshaft="throw6", input="gearbox_input").observed_nodes
    ('throw6', 'gearbox_input')
    """

    throws: tuple[str, ...] = ()
    crankshaft: str = ""
    load: str = ""
    input: str = ""
    springs: tuple[str, ...] = ()
    clutch: str = ""

    @property
    def observed_nodes(self) -> tuple[str, ...]:
        """Nodes that analyses look at by default: the crankshaft and the node to be kept quiet."""
        return tuple(node for node in dict.fromkeys((self.crankshaft, self.input)) if node)

    @property
    def observed_elements(self) -> tuple[str, ...]:
        """Connections that analyses look at by default: the absorber's springs and the clutch damper."""
        return tuple(name for name in dict.fromkeys((*self.springs, self.clutch)) if name)


@dataclass(frozen=True, eq=False)
@checked_fields
class Model:
    """A machine: ``components`` common to all gears, ``gears`` by name, engine, operating range, landmarks.

    ``absorber`` is the one whose parts stand among the components, None without; ``document`` the parsed model file
    (for provenance and changed copies), empty once anything else was changed in Python.

    >>> from torsional.components import Inertia, Shaft
    >>> pair = {"a": Inertia(1.8), "b": Inertia(1.2), "s": Shaft("a", "b", 12e3)}
    >>> Model("pair", pair, Landmarks()).replaced("s", stiffness=10e3).powertrain()["s"].stiffness
    10000.0
    """

    name: str
    components: Mapping[str, Component]
    landmarks: Landmarks
    gears: Mapping[str, Gear] = field(default_factory=dict)
    engine: Engine | None = None
    operation: Operation = Operation()
    absorber: Absorber | None = None
    document: Mapping[str, Any] = field(default_factory=dict)
    parts: int = 1

    @property
    def detail(self) -> Mapping[str, Component]:
        """The absorber's inner parts (shoes, segments, their friction), which take their places with `detailed`."""
        return self.absorber.detail if self.absorber else {}

    @property
    def gear_names(self) -> tuple[str, ...]:
        """The gears, first to last; one nameless gear where the model has none."""
        return tuple(self.gears) or ("",)

    @property
    def top_gear(self) -> str:
        """The last gear listed, the analyses' default."""
        return self.gear_names[-1]

    @property
    def absorber_mode(self) -> str:
        """What engineers call the mode in which the absorber's springs work."""
        known = {"dual mass": "DMF mode", "planetary dual mass": "DMF mode", "power split": "PSVA mode"}
        own = self.absorber.kind if self.absorber else ""
        return next((name for kind, name in known.items() if own.startswith(kind)), "absorber mode")

    @property
    def mode_groups(self) -> dict[str, tuple[str, ...]]:
        """Names of modes by the connections that hold most of their elastic energy, for `named_modes`.

        Friction that sticks beside a spring counts with it.
        """
        marks = self.landmarks
        found = {self.absorber_mode: marks.springs, "clutch mode": (marks.clutch,) if marks.clutch else ()}
        rubbing = {name: [f"{member}_friction" for member in members] for name, members in found.items()}
        beside = {name: tuple(part for part in parts if part in self.components) for name, parts in rubbing.items()}
        return {name: (*members, *beside[name]) for name, members in found.items() if members}

    def gear_name(self, gear: str | int | None = None) -> str:
        """The name of one gear (default, or where empty: the last listed); raises ModelError for one it has not."""
        name = self.top_gear if gear is None or gear == "" else str(gear)
        if name not in self.gear_names:
            raise ModelError(f"there is no gear '{name}'", where="gear", remedy=nearest(name, self.gear_names))
        return name

    def chosen_gears(self, gears: Sequence[str | int] | None = None) -> list[str]:
        """The names of some gears (default: all of them), as asked for; raises ModelError for one it has not."""
        return list(self.gear_names) if gears is None else [self.gear_name(gear) for gear in gears]

    def powertrain(self, gear: str | int | None = None) -> Powertrain:
        """The powertrain with one gear engaged (default, or where empty: the last listed)."""
        name = self.gear_name(gear)
        engaged = self.gears[name].components if name else {}
        return Powertrain([*self.components.items(), *engaged.items()], self.parts, self.landmarks.crankshaft)

    def speeds(self, count: int) -> Array:
        """Evenly spaced mean speeds of the operating range [rad/s]."""
        return np.linspace(*self.operation.speed, count)

    def torques(self, count: int) -> Array:
        """Evenly spaced mean torques [Nm]: the stated range, or up to the highest full-load torque."""
        low, high = self.operation.torque or (0.0, self.full_load_peak())
        return np.linspace(low, high, count)

    def full_load_peak(self) -> float:
        """The highest torque of the full-load curve [Nm]; raises ModelError without one."""
        curve = self.full_load_curve
        if curve is None:
            raise ModelError(
                "the model has no full-load curve", where="engine.full_load", remedy="give operation.torque"
            )
        return float(np.max(curve.torques))

    @property
    def running_engine(self) -> Engine:
        """The engine; raises ModelError for a model without one."""
        if self.engine is None:
            remedy = "add an engine block"
            raise ModelError("the model has no engine, so nothing excites it", where="engine", remedy=remedy)
        return self.engine

    @property
    def full_load_curve(self) -> FullLoad | None:
        """The engine's full-load curve, None where there is none."""
        return None if self.engine is None else self.engine.full_load

    def full_load(self, speeds: ArrayLike) -> Array:
        """Mean torque [Nm] at full load at each speed [rad/s]; without a curve `typical_torque` at each.

        Raises ModelError where the curve does not reach a speed.
        """
        curve = self.full_load_curve
        return np.full(np.shape(speeds), self.typical_torque()) if curve is None else curve(speeds)

    def within_full_load(self, speeds: Array, torques: Array) -> BoolArray:
        """Whether the engine reaches each torque [Nm] at each speed [rad/s], (torques, speeds), by its full-load curve.

        Nowhere at speeds that the curve does not reach, everywhere where there is no curve.
        """
        if self.engine is None or self.engine.full_load is None:
            return np.ones((len(torques), len(speeds)), dtype=bool)
        return self.engine.within_full_load(speeds[None, :], torques[:, None])

    def typical_torque(self) -> float:
        """Mean engine torque [Nm] for modes: the full-load curve's highest, else the operating range's, else zero."""
        if self.full_load_curve is not None:
            return self.full_load_peak()
        return float(self.operation.torque[1]) if self.operation.torque else 0.0

    def engine_orders(self, count: int = 4) -> tuple[float, ...]:
        """The strongest orders of the torques of all cylinders together, strongest first; the first is the main order.

        Judged by the mean amplitude over the operating range at full load (without a curve: at `typical_torque`);
        orders below a twentieth of the main one are left out.  A model without an engine has none.

        >>> from torsional.engine import CrankLayout
        >>> engine = Engine(bore=0.131, stroke=0.158, rod_length=0.2675, reciprocating_mass=4.2,
        ...                 compression_ratio=18.1, layout=CrankLayout.inline((1, 5, 3, 6, 2, 4)))
        >>> Model("six", {}, Landmarks(), engine=engine).engine_orders()[:2]
        (3.0, 6.0)
        """
        if self.engine is None:
            return ()
        speeds = self.speeds(15)
        size = np.abs(self.engine.harmonics(speeds, self.full_load(speeds), HALF_ORDERS).sum(axis=-2)).mean(axis=0)
        ranked = np.argsort(-size, kind="stable")[:count]
        return tuple(float(HALF_ORDERS[i]) for i in ranked if size[i] >= NOTABLE * size[ranked[0]])

    def detailed(self) -> Model:
        """The model as time-domain analyses take it, the absorber's inner parts in place; itself where it has none."""
        if self.absorber is None or not self.detail:
            return self
        whole = replace(self.absorber, components={**self.absorber.components, **self.detail}, detail={})
        return replace(self, components={**self.components, **self.detail}, absorber=whole)

    def replaced(self, part: str = "", component: Component | None = None, /, **changes: Any) -> Model:
        """A copy with one component exchanged or some of its fields changed, by its name; else with own fields changed.

        ``truck.replaced("dmf", law=springs)`` gives the coupling "dmf" another law.  Parts that stand in one gear alone
        belong to ``gears``.  No model file describes the copy: `torsional.changed` comes first, parts afterwards.
        Raises ModelError for a part or a field that is not there.
        """
        own = {"components": exchanged(self.components, part, component, changes)} if part else changes
        return replace(self, **{"document": {}, **own})

    def joined(self, parts: Mapping[str, Component]) -> Model:
        """A copy with more components, in every gear; raises ModelError for a name that is taken."""
        taken = {*self.components, *(name for gear in self.gears.values() for name in gear.components)} & {*parts}
        if taken:
            raise ModelError("the name is taken", where=min(taken), remedy="choose another name, or use replaced")
        return self.replaced(components={**self.components, **parts})

    def without(self, *names: str) -> Model:
        """A copy without some components, in every gear; raises ModelError for a name that is not there."""
        for name in names:
            _ = named(self.components, name)
        return self.replaced(components={name: c for name, c in self.components.items() if name not in names})

    def with_absorber(self, absorber: Absorber) -> Model:
        """A copy with another absorber in the place of its own, in every gear; its springs become the landmark.

        Crankshaft and clutch keep their nodes: where the absorber's ends are named otherwise, see `Absorber.between`.
        What else stood on bodies of the old one goes by `without` first.  Raises ModelError for a model without an
        absorber, for names that are taken, and for springs between crankshaft and clutch where both are on one node.
        """
        old = self.absorber
        if old is None:
            raise ModelError("the model has no absorber to replace", where="absorber", remedy="use joined")
        fitted = absorber.between(old.input, old.output)
        rest = self.without(*(name for name in self.components if name in old.components))
        whole = rest.joined(fitted.components).components
        before = itertools.takewhile(lambda name: name not in old.components, self.components)
        ordered = {name: whole[name] for name in [*before, *fitted.components]}
        marks = replace(self.landmarks, springs=fitted.springs)
        return self.replaced(components={**ordered, **whole}, landmarks=marks, absorber=fitted)

    def __repr__(self) -> str:
        gears = f", gears {', '.join(self.gears)}" if self.gears else ""
        kind = f", {self.absorber.kind}" if self.absorber else ""
        return f"<Model '{self.name}': {len(self.components)} components{kind}{gears}>"

    def _repr_html_(self) -> str:
        marks = ((key, value) for key, value in vars(self.landmarks).items() if value)
        rows = [[key, ", ".join([value] if isinstance(value, str) else value)] for key, value in marks]
        places = html_table("Landmarks", ["of analyses", "where"], rows)
        parts = components_table("Components in every gear", self.components)
        return f"<p>{escape(repr(self)[1:-1])}</p>{places}{parts}"

    @property
    def hash(self) -> str:
        """Sixteen hexadecimal digits that tell this model from every other (of its document, or of its parts)."""
        told = json.dumps(self.document, sort_keys=True, default=str) if self.document else repr(self._values())
        return hashlib.sha256(told.encode()).hexdigest()[:16]

    def _values(self) -> list[object]:
        return [getattr(self, told.name) for told in fields(self)]
