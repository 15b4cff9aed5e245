"""The engine: torque of its throws over speed and mean torque."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked_fields
from torsional.checks import not_negative, positive, within
from torsional.engine.checks import check_deactivated, check_heat_spread
from torsional.engine.combustion import CombustionCycle
from torsional.engine.crankshaft import CrankLayout
from torsional.engine.cylinder import Cylinder
from torsional.engine.excitation import Excitation, checked_nodes
from torsional.engine.friction import ChenFlynn
from torsional.engine.full_load import FullLoad
from torsional.engine.gas import GasSource, PressureShapes
from torsional.engine.loading import Balance, Groups, MeanTorque, OperatingPoints, refuse_below_motored
from torsional.engine.orders import (
    CYCLE,
    BoolArray,
    ComplexArray,
    FloatArray,
    checked_orders,
    crank_angle_grid,
    half_order_series,
    periodic_spline,
    picked,
)
from torsional.engine.slider_crank import SliderCrank
from torsional.errors import ModelError

if TYPE_CHECKING:
    from scipy.interpolate import CubicSpline

SEALED_EXPONENT = 1.35
FASTEST_PISTON = 30.0


@dataclass(frozen=True)
@checked_fields
class Engine:
    """A four-stroke engine of 1 to 16 cylinders; SI units throughout.

    ``stroke`` is twice the crank radius.  ``gas`` is a ``CombustionCycle`` or a ``PressureTrace``; in both the heat is
    solved so that the brake torque (gas less friction) has the wanted mean.  ``deactivated`` cylinders get no fuel:
    with valves "closed" they are gas springs that hold ``trapped_pressure`` [Pa] at bottom dead centre, with valves
    "working" they breathe.  ``heat_spread`` gives a factor on each cylinder's heat, empty for equal cylinders.
    ``full_load`` may be left out where nobody asks for it.  ``leakage_time`` [s]: a cylinder that stands still loses
    its pressure past the rings with this time constant (in time alone; 1e9 s: it is tight).  The crank angle is zero at
    firing of cylinder 1.

    Raises ModelError that names the field for a value an engine cannot have.

    >>> engine = Engine(bore=0.131, stroke=0.158, rod_length=0.2675, reciprocating_mass=4.2, compression_ratio=18.1,
    ...                 layout=CrankLayout.inline((1, 5, 3, 6, 2, 4)))
    >>> engine.harmonics(125.0, 2000.0, [0, 3]).sum(axis=0)[0].real.round(6).item()
    2000.0
    """

    bore: float
    stroke: float
    rod_length: float
    reciprocating_mass: float
    compression_ratio: float
    layout: CrankLayout
    pin_offset: float = 0.0
    gas: GasSource = field(default_factory=CombustionCycle)
    friction: ChenFlynn = field(default_factory=ChenFlynn)
    crankcase_pressure: float = 1.0e5
    deactivated: tuple[int, ...] = ()
    deactivated_valves: str = "closed"
    trapped_pressure: float = 1.0e5
    heat_spread: tuple[float, ...] = ()
    full_load: FullLoad | None = None
    leakage_time: float = 1.0

    def __post_init__(self) -> None:
        positive(self.stroke, "stroke", "length")
        not_negative(self.reciprocating_mass, "reciprocating_mass", "mass")
        within(self.crankcase_pressure, 0.0, 1e6, "crankcase_pressure", "pressure")
        within(self.leakage_time, 1e-3, 1e9, "leakage_time", "time")
        within(self.trapped_pressure, 0.0, 2e6, "trapped_pressure", "pressure")
        for name in ("deactivated", "heat_spread"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        check_deactivated(self.deactivated, self.deactivated_valves, self.layout.cylinders)
        check_heat_spread(self.heat_spread, self.deactivated, self.layout.cylinders)
        _ = self.cylinder, self.pressure_shapes  # refuses wrong lengths and traces now, not at the first call

    # what does not depend on the operating point, worked out once

    @cached_property
    def crank(self) -> SliderCrank:
        """The slider-crank of every cylinder."""
        return SliderCrank(0.5 * self.stroke, self.rod_length, self.pin_offset)

    @cached_property
    def cylinder(self) -> Cylinder:
        """The space above every piston."""
        return Cylinder(self.bore, self.compression_ratio, self.crank)

    @property
    def displacement(self) -> float:
        """Swept volume of all cylinders [m³]."""
        return self.cylinder.displacement * self.layout.cylinders

    @cached_property
    def pressure_shapes(self) -> PressureShapes:
        """Pressure shapes of the gas source, the last one that of a sealed cylinder."""
        source = self.gas.pressure_shapes(self.cylinder, self.layout.firing_angles)
        volume = self.cylinder.volume(crank_angle_grid())
        largest = self.cylinder.clearance + self.cylinder.displacement
        sealed = self.trapped_pressure * (largest / volume) ** SEALED_EXPONENT
        return PressureShapes(np.vstack([source.shapes, sealed]), source.coefficients)

    @cached_property
    def groups(self) -> Groups:
        """Cylinders with one pressure taken together."""
        numbers = np.arange(1, self.layout.cylinders + 1)
        out = np.isin(numbers, self.deactivated)
        heat = np.where(out, 0.0, self.heat_spread or 1.0)
        columns = self.pressure_shapes.coefficients(np.zeros(1))[0].shape[1]
        return Groups.gathered(np.where(columns > 1, numbers - 1, 0), heat, out & (self.deactivated_valves == "closed"))

    @cached_property
    def _balance(self) -> Balance:
        shapes, angle = self.pressure_shapes.shapes, crank_angle_grid()
        near = np.cos(0.5 * angle) > np.cos(np.radians(50.0))  # peak pressures lie within 100° of firing
        arm = self.cylinder.displacement / CYCLE
        work = (shapes * self.cylinder.lever).mean(axis=1)
        return Balance(work, shapes[:, near], self.groups.count, arm, self.friction.peak_pressure_factor)

    @cached_property
    def _gas_series(self) -> ComplexArray:
        return half_order_series(self.pressure_shapes.shapes * self.cylinder.lever)

    @cached_property
    def _fixed_series(self) -> tuple[ComplexArray, ComplexArray]:
        """Series of the crankcase pressure's torque, and of the reciprocating mass's over Ω²."""
        mass = self.crank.reciprocating_torque(self.reciprocating_mass, 1.0, crank_angle_grid())
        return half_order_series(-self.crankcase_pressure * self.cylinder.lever), half_order_series(mass)

    @cached_property
    def _shape_splines(self) -> CubicSpline:
        return periodic_spline(np.append(crank_angle_grid(), CYCLE), self.pressure_shapes.shapes)

    # operating points

    def mean_piston_speed(self, speed: ArrayLike) -> FloatArray:
        """Mean piston speed [m/s] of the engine speed [rad/s]; ModelError where no engine runs that fast."""
        turning = np.asarray(speed, dtype=float)
        piston = self.crank.stroke * turning / np.pi
        wrong = ~((piston >= 0) & (piston <= FASTEST_PISTON))
        if wrong.any():
            found = f"{np.atleast_1d(turning)[np.atleast_1d(wrong)][0]:g} rad/s"
            fastest = f"{FASTEST_PISTON * np.pi / self.crank.stroke:.4g} rad/s"
            allowed = f"0 to {fastest}, a mean piston speed of {FASTEST_PISTON:g} m/s"
            remedy = "speeds are in rad/s: rpm times π/30"
            raise ModelError("no engine runs at this speed", where="speed", found=found, allowed=allowed, remedy=remedy)
        return np.asarray(piston)

    def operated(self, speed: ArrayLike, mean_torque: ArrayLike) -> OperatingPoints:
        """Operating points with the heat solved for the mean brake torque [Nm]; the arguments broadcast.

        Raises ModelError for a torque below that of the motored engine (``motored_torque``).
        """
        speeds, torques = np.broadcast_arrays(np.asarray(speed, dtype=float), np.asarray(mean_torque, dtype=float))
        turning, wanted = speeds.ravel(), torques.ravel()
        if not np.isfinite(wanted).all():
            raise ModelError("the mean torque must be finite", where="mean_torque")
        still, burning, base = self._prepared(turning, wanted)
        friction = base * self._balance.friction_arm
        needed = wanted + friction * self.layout.cylinders
        heat, peak = self._balance.heat(still, burning, needed)
        if (heat < 0).any():
            least = self._balance.unfired(still) - friction * self.layout.cylinders
            refuse_below_motored(wanted, least, turning)
        lost = self.friction.peak_pressure_factor * peak * self._balance.friction_arm + friction[:, None]
        return OperatingPoints(speeds.shape, turning, still + heat[:, None, None] * burning, heat, peak, lost)

    def _prepared(self, speed: FloatArray, mean_torque: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        firing = self.layout.cylinders - len(self.deactivated)
        mean_pressure = mean_torque * CYCLE / (self.cylinder.displacement * firing)
        still, burning = self.groups.coefficients(*self.pressure_shapes.coefficients(mean_pressure))
        return still, burning, self.friction.base(self.mean_piston_speed(speed))

    def motored_torque(self, speed: ArrayLike) -> FloatArray:
        """Mean torque [Nm] of the engine turned without fuel, negative, in the shape of the speed [rad/s].

        The intake pressure is that of zero load and below.
        """
        asked = np.asarray(speed, dtype=float)
        still, _, base = self._prepared(asked.ravel(), np.full(asked.size, -1.0))
        lost = base * self._balance.friction_arm * self.layout.cylinders
        return np.asarray((self._balance.unfired(still) - lost).reshape(asked.shape))

    def peak_pressure(self, speed: ArrayLike, mean_torque: ArrayLike) -> FloatArray:
        """Peak pressure of each cylinder [Pa], shape S + (cylinders,)."""
        points = self.operated(speed, mean_torque)
        return np.asarray(points.peak_pressure[:, self.groups.of_cylinder].reshape(*points.shape, -1))

    def mean_torque_split(self, speed: ArrayLike, mean_torque: ArrayLike) -> MeanTorque:
        """Mean torque of gas and friction by throw."""
        points = self.operated(speed, mean_torque)
        member = self.groups.of_cylinder
        seats, shape = self.layout.throw_members.T, (*points.shape, -1)
        gas = (points.coefficients @ self._balance.work)[:, member] @ seats
        return MeanTorque(gas.reshape(shape), (points.friction[:, member] @ seats).reshape(shape))

    def harmonics(self, speed: ArrayLike, mean_torque: ArrayLike, orders: ArrayLike) -> ComplexArray:
        """Complex 0-peak torque harmonics of gas and reciprocating mass by throw [Nm], shape S + (throws, orders).

        T(θ) = Re Σ_n T_n exp(i n θ) with θ zero at firing of cylinder 1; a cylinder that fires at φ has its own series
        times exp(−i n φ).  S is the broadcast shape of ``speed`` [rad/s] and ``mean_torque`` [Nm].  Order 0 is the mean
        torque with friction taken off.  Raises ModelError for orders that are no multiples of 0.5.
        """
        n, points = checked_orders(orders), self.operated(speed, mean_torque)
        by_group = self._phases(n)
        crankcase, mass = (picked(series, n) for series in self._fixed_series)
        own = points.coefficients @ picked(self._gas_series, n) + crankcase
        own[:, :, n == 0] -= points.friction[:, :, None]
        torque = np.einsum("bgn,tgn->btn", own, by_group)
        torque += np.square(points.speed)[:, None, None] * (mass * by_group.sum(axis=1))
        return np.asarray(torque.reshape(*points.shape, self.layout.throw_count, len(n)))

    def _phases(self, orders: FloatArray) -> ComplexArray:
        """Sum of exp(−i n φ) over the cylinders of a throw and a group, (throws, groups, orders)."""
        turned = np.exp(-1j * np.multiply.outer(self.layout.firing_angles, orders))
        grouped = self.groups.of_cylinder[:, None] == np.arange(len(self.groups.count))
        return np.asarray(np.einsum("tz,zg,zn->tgn", self.layout.throw_members, grouped.astype(float), turned))

    def torque(
        self, speed: ArrayLike, mean_torque: ArrayLike, crank_angle: ArrayLike, *, reciprocating: bool = True
    ) -> FloatArray:
        """Torque by throw over crank angle [rad], shape S + (throws,) + that of the crank angle [Nm].

        Gas torque less mean friction, and with ``reciprocating`` the torque of the reciprocating mass at steady speed.
        The kinematics are exact; pressures come from a cubic spline through the half-degree samples.
        """
        points, angle = self.operated(speed, mean_torque), np.asarray(crank_angle, dtype=float)
        result = np.zeros((len(points.speed), self.layout.throw_count, angle.size))
        for cylinder, (throw, group) in enumerate(zip(self.layout.throws, self.groups.of_cylinder, strict=True)):
            own = np.mod(angle.ravel() - self.layout.firing_angles[cylinder], CYCLE)
            pressure = points.coefficients[:, group] @ self._shape_splines(own)
            lever = self.cylinder.area * self.crank.velocity_ratio(own)
            result[:, throw - 1] += (pressure - self.crankcase_pressure) * lever - points.friction[:, group, None]
            if reciprocating:
                turning = points.speed[:, None]
                result[:, throw - 1] += self.crank.reciprocating_torque(self.reciprocating_mass, turning, own)
        return result.reshape(*points.shape, self.layout.throw_count, *angle.shape)

    def pressure(self, speed: ArrayLike, mean_torque: ArrayLike, crank_angle: ArrayLike) -> FloatArray:
        """Pressure in each cylinder [Pa], shape S + (cylinders,) + that of the crank angle [rad]."""
        points, angle = self.operated(speed, mean_torque), np.asarray(crank_angle, dtype=float)
        own = np.mod(angle.ravel() - self.layout.firing_angles[:, None], CYCLE)
        members = enumerate(self.groups.of_cylinder)
        rows = [points.coefficients[:, group] @ self._shape_splines(own[number]) for number, group in members]
        return np.stack(rows, axis=1).reshape(*points.shape, self.layout.cylinders, *angle.shape)

    def excitation(
        self, nodes: str | Sequence[str], speed: ArrayLike, mean_torque: ArrayLike, orders: ArrayLike
    ) -> Excitation:
        """The harmonics as an excitation of nodes: one a throw, in sequence, or a single node for the whole engine."""
        names = checked_nodes(nodes, self.layout.throw_count)
        torque = self.harmonics(speed, mean_torque, orders)
        if len(names) < self.layout.throw_count:
            torque = torque.sum(axis=-2, keepdims=True)
        speeds, _ = np.broadcast_arrays(np.asarray(speed, dtype=float), np.asarray(mean_torque, dtype=float))
        return Excitation(names, checked_orders(orders), speeds, torque)

    # full load

    def full_load_torque(self, speed: ArrayLike) -> FloatArray:
        """Full-load torque [Nm] at each speed [rad/s]; ModelError without a curve or outside it."""
        return self._curve()(speed)

    def torque_grid(self, speed: ArrayLike, load: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Speeds (speeds, 1) [rad/s] and mean torques (speeds, loads) [Nm], ``load`` being fractions of full load.

        The two broadcast, as ``harmonics`` wants them.
        """
        speeds = np.atleast_1d(np.asarray(speed, dtype=float))[:, None]
        return speeds, np.asarray(self.full_load_torque(speeds) * np.atleast_1d(np.asarray(load, dtype=float)))

    def within_full_load(self, speed: ArrayLike, mean_torque: ArrayLike) -> BoolArray:
        """Whether the torque [Nm] is at or below the full-load curve, boolean, in the broadcast shape.

        Speeds [rad/s] that the curve does not reach are beyond it.  Raises ModelError without a curve.
        """
        return self._curve().allows(speed, mean_torque)

    def _curve(self) -> FullLoad:
        if self.full_load is None:
            raise ModelError("the engine has no full-load curve", where="full_load", remedy="give speeds and torques")
        return self.full_load
