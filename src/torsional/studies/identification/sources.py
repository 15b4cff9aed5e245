"""What was measured, as a plan names it: loops of a rig, order curves, histories; each with what a model predicts."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal, Protocol

import numpy as np

from torsional.errors import ModelError
from torsional.files.scenario_blocks import Scenario
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.solvers.hysteresis import absorber_ends
from torsional.solvers.run_up import run_up_response
from torsional.studies.estimates import Measured
from torsional.studies.identify import Errors, Prediction
from torsional.studies.loop_torques import LoopTorques, torques_in
from torsional.studies.order_curves import curves_of_result
from torsional.studies.records import Record
from torsional.studies.rig import ROUGH_STEPS, STEPS
from torsional.studies.scenarios.running import run_scenario
from torsional.system import System, assemble

PARTS = 120
"""Parts of a cycle over which pictures show means of all cycles, at most."""
Making = Callable[[Mapping[str, float]], Model]
"""A model made of values by key path; names of other parameters are passed over."""

Use = Literal["search", "slopes", "residuals"]
"""What a prediction is for: a search may be rough, residuals at last are not."""


@dataclass(frozen=True, eq=False)
class Shown:
    """A point as pictures show it: ``values`` (samples,) of a ``quantity`` over an ``axis`` (samples,) of another."""

    axis: Array
    along: str
    values: Array
    quantity: str


class Source(Protocol):
    """Something measured: its ``points``, and what a model predicts of each."""

    @property
    def points(self) -> Sequence[Measured]:
        """What was measured, point by point."""

    def only(self, names: Sequence[str]) -> Source:
        """The same with some of its points."""

    def predicted(self, made: Making, use: Use) -> Prediction:
        """What models made of values would show."""

    def errors(self, made: Making) -> Errors:
        """What errors of measured angles do to it."""

    def shown(self, number: int, values: Array) -> Shown:
        """Values of a point, measured or predicted, over what they are drawn over."""


def exact(source: Source) -> Errors:
    """No errors of what the model is given."""
    return lambda values: [np.zeros((point.values.size, 0)) for point in source.points]


@dataclass(frozen=True, eq=False)
class Loops:
    """Loops of a rig between two nodes, the first one turned; weights by the loops' names."""

    records: tuple[Record, ...]
    ends: tuple[str, str]
    gear: str = ""
    weights: Mapping[str, float] | None = None

    @property
    def points(self) -> list[Measured]:
        """The torques, each over its own noise."""
        weight = self.weights or {}
        return [replace(point, weight=weight.get(point.name, 1.0)) for point in torques_in(self.records)]

    def only(self, names: Sequence[str]) -> Loops:
        """Some of the loops."""
        return replace(self, records=tuple(loop for loop in self.records if loop.name in names))

    def _torques(self, made: Making, steps: int) -> LoopTorques:
        def system(values: Mapping[str, float]) -> System:
            return assemble(made(values).detailed().powertrain(self.gear))

        return LoopTorques(system, self.ends, self.records, steps)

    def predicted(self, made: Making, use: Use) -> Prediction:
        """Torques along the measured angles, inertia left out."""
        torques = self._torques(made, ROUGH_STEPS if use == "search" else STEPS)
        return torques.extrapolated if use == "residuals" else torques

    def errors(self, made: Making) -> Errors:
        """What the encoders' noise does to them."""
        return self._torques(made, STEPS).errors

    def shown(self, number: int, values: Array) -> Shown:
        """Means of all cycles over the angle."""
        loop = self.records[number]
        a_cycle = loop.time.size * loop.swing.period / float(np.ptp(loop.time))
        parts = int(np.clip(a_cycle / 2, 16, PARTS))
        at, mean = (np.arange(parts) + 0.5) / parts, loop.averaged(values, parts)
        angle, there = loop.swing.at(loop.swing.begin + loop.swing.period * at), np.isfinite(mean)
        return Shown(angle[there], "relative_angle", mean[there], "torque")


@dataclass(frozen=True, eq=False)
class Orders:
    """Measured ``curves`` {order: values (speeds,)}, complex or amplitudes, of a ``quantity`` at a ``place``, over
    ``speeds`` [rad/s] in one gear under a mean ``torque`` [Nm], None for full load; ``noise`` over their RMS."""

    name: str
    curves: Mapping[float, Array]
    speeds: Array
    place: str
    quantity: str
    gear: str
    torque: float | None
    noise: float
    weights: Mapping[str, float] | None = None

    def _named(self, order: float) -> str:
        return f"{self.name}, order {order:g}"

    @property
    def points(self) -> list[Measured]:
        """A point an order: amplitudes, or real and imaginary parts one behind the other."""
        weight = self.weights or {}
        found = []
        for order, values in self.curves.items():
            level = self.noise * float(np.sqrt(np.mean(np.abs(values) ** 2)))
            name = self._named(order)
            found.append(Measured(name, _real(values), level, weight.get(name, 1.0)))
        return found

    def only(self, names: Sequence[str]) -> Orders:
        """Some of the orders."""
        return replace(self, curves={n: values for n, values in self.curves.items() if self._named(n) in names})

    def predicted(self, made: Making, use: Use) -> Prediction:
        """The linear response at the operating point of every speed."""
        orders = list(self.curves)

        def told(values: Mapping[str, float]) -> list[Array]:
            model = made(values)
            mean = None if self.torque is None else np.full(self.speeds.size, self.torque)
            found = run_up_response(model, self.speeds, mean, self.gear or None, orders)
            own = curves_of_result(found, self.place, self.quantity)
            rows = [own.sel(order=order).values for order in orders]
            pairs = zip(rows, self.curves.values(), strict=True)
            return [_real(row if np.iscomplexobj(seen) else np.abs(row)) for row, seen in pairs]

        return told

    def errors(self, made: Making) -> Errors:
        """Speeds count as exact."""
        return exact(self)

    def shown(self, number: int, values: Array) -> Shown:
        """Amplitudes over speed."""
        told = values
        if values.size == 2 * self.speeds.size:
            told = np.hypot(values[: self.speeds.size], values[self.speeds.size :])
        return Shown(self.speeds, "speed", told, self.quantity)


def _real(values: Array) -> Array:
    return np.concatenate([values.real, values.imag]) if np.iscomplexobj(values) else np.asarray(values)


@dataclass(frozen=True, eq=False)
class History:
    """A signal in time: ``values`` of a ``quantity`` at a ``place`` at ``times`` [s] of a scenario, their ``noise``."""

    name: str
    times: Array
    values: Array
    place: str
    quantity: str
    scenario: Scenario
    noise: float
    weight: float = 1.0

    @property
    def points(self) -> list[Measured]:
        """One point."""
        return [Measured(self.name, self.values, self.noise, self.weight)]

    def only(self, names: Sequence[str]) -> History:
        """The same: there is but one."""
        return self

    def predicted(self, made: Making, use: Use) -> Prediction:
        """The signal of the scenario's run."""

        def told(values: Mapping[str, float]) -> list[Array]:
            return [self._of(made(values))]

        return told

    def _of(self, model: Model) -> Array:
        found = run_scenario(model, self.scenario)
        name = {"relative_angle": "twist"}.get(self.quantity, self.quantity)
        dim = "element" if name in ("twist", "torque") else "node"
        if name not in found or self.place not in found[dim].values:
            raise ModelError("the scenario records no such signal", where=self.name, found=f"{name} of {self.place}")
        own = found[name].sel({dim: self.place})
        if self.times[-1] > float(own.time[-1]) + 1e-9:
            found_, allowed = f"{self.times[-1]:g} s", f"up to {float(own.time[-1]):g} s"
            raise ModelError("the run ends before the measurement", where=self.name, found=found_, allowed=allowed)
        return np.asarray(np.interp(self.times, own.time.values, own.values))

    def errors(self, made: Making) -> Errors:
        """Times count as exact."""
        return exact(self)

    def shown(self, number: int, values: Array) -> Shown:
        """Over time."""
        return Shown(self.times, "time", values, self.quantity)


def ends_of(model: Model, turned: str, held: str) -> tuple[str, str]:
    """The nodes between which loops were measured; ModelError where neither the model nor the plan names them."""
    first, last = absorber_ends(model)
    if not first and model.absorber is not None:
        first = model.absorber.input
    if not last and model.absorber is not None:
        last = model.absorber.output
    ends = turned or first, held or last
    if not all(ends):
        remedy = "name two nodes by turned and held"
        raise ModelError("the model does not say where its absorber begins and ends", remedy=remedy)
    return ends
