"""Centrifugal pendulum vibration absorber (CPVA): a stiffness that grows with Ω², and in time its exact path."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from torsional import checks
from torsional.absorbers.base import Absorber
from torsional.arguments import checked, checked_fields
from torsional.errors import ModelError
from torsional.laws import Contacts, Law
from torsional.stamps import Connection, Mass, Stamp, Swing

Path = Literal["circular", "cycloid", "epicycloid", "tautochrone"]


@dataclass(frozen=True)
@checked_fields
class Rollers:
    """Rollers of a bifilar pendulum: ``mass`` [kg] and spin ``inertia`` [kgm²] of all, ``radius`` [m], ``distance``
    [m] of their centres from the axis.  A roller's centre makes half the pendulum's way and turns by −s/(2r).

    They move the tuned order off that of the path: see `CentrifugalPendulum.tuned_order`.

    >>> rollers = Rollers(mass=0.1, inertia=1e-5, radius=0.01, distance=0.09)
    >>> round(CentrifugalPendulum("rotor", mass=1.0, distance=0.1, order=3.0, rollers=rollers).tuned_order, 6)
    2.996029
    """

    mass: float
    inertia: float
    radius: float
    distance: float

    def __post_init__(self) -> None:
        checks.positive(self.mass, "rollers.mass", "mass")
        checks.not_negative(self.inertia, "rollers.inertia", "inertia")
        checks.positive(self.radius, "rollers.radius", "length")
        checks.positive(self.distance, "rollers.distance", "length")


@dataclass(frozen=True)
@checked_fields
class CentrifugalPendulum:
    """Pendulums of ``mass`` m [kg] in all, their centre at ``distance`` c [m] from the axis, tuned to ``order`` n.

    From T = ½Jθ̇² + ½m(ṡ² + R²θ̇² + 2Gṡθ̇) at small s follow the inertia m c² and the stiffness m c² n² Ω² between
    ``carrier`` and pendulum (its angle is θ + s/c); every ``path`` has the same order at small amplitude
    n² = c/ρ0 − 1, ρ0 the radius of curvature at rest (Denman, J. Sound Vib. 159 (1992) 251).  ``damping`` [Nms/rad].
    With ``rollers`` ``order`` stays that of the path.

    In time the motion along the path is exact.  ``count`` pendulums, evenly placed, share the mass and move each on its
    own, as weight makes them at low speed (nodes ``pendulum_1``, … instead of one); one alone stands for all of them.
    ``stop`` [m]: way along the path to the stops, of ``stop_stiffness`` [N/m] and contact time ``stop_time`` [s].

    >>> p = CentrifugalPendulum("rotor", mass=1.0, distance=0.1 * (1 + 1 / 9), order=3.0)
    >>> round(p.curvature_radius, 9)
    0.011111111
    """

    carrier: str
    mass: float
    distance: float
    order: float
    damping: float = 0.0
    path: Path = "circular"
    rollers: Rollers | None = None
    count: int = 1
    stop: float | None = None
    stop_stiffness: float = 1e7
    stop_time: float = 1e-5

    def __post_init__(self) -> None:
        self._check_stops()
        checks.positive(self.mass, "mass", "mass")
        checks.positive(self.distance, "distance", "length")
        checks.positive(self.order, "order", "engine_order")
        checks.not_negative(self.damping, "damping", "damping")
        if self.path not in ("circular", "cycloid", "epicycloid", "tautochrone"):
            allowed = "circular, cycloid, epicycloid, tautochrone"
            raise ModelError("no such pendulum path", where="path", found=repr(self.path), allowed=allowed)

    @property
    def curvature_radius(self) -> float:
        """ρ0 = c/(1 + n²) [m]."""
        return self.distance / (1 + self.order**2)

    @property
    def tuned_order(self) -> float:
        """The order at which the carrier stands still, without damping: that of the path, or with rollers:

        n_t² = (m n² + m_r (d − ρ0/2)/(2 ρ0)) / (m + m_r/4 + I_r/(4 r²)),  d their distance from the axis.

        >>> rollers = Rollers(mass=0.1, inertia=5e-6, radius=0.01, distance=0.11)
        >>> round(CentrifugalPendulum("rotor", mass=1.0, distance=0.11, order=3.0, rollers=rollers).tuned_order, 4)
        3.022
        """
        moment = self.mass * self.distance**2
        if self.rollers:
            moment += self.distance**2 / 4 * (self.rollers.mass + self.rollers.inertia / self.rollers.radius**2)
        return math.sqrt(self._stiffness / moment)

    @property
    def _stiffness(self) -> float:
        """Centrifugal stiffness over Ω² [kg m²], along ψ − θ."""
        stiffness = self.mass * self.distance**2 * self.order**2
        if self.rollers:
            rho = self.curvature_radius
            stiffness += self.rollers.mass * self.distance**2 * (self.rollers.distance - rho / 2) / (2 * rho)
        return stiffness

    def stamps(self, name: str) -> Iterator[Stamp]:
        """½ m c² ψ̇² and the centrifugal spring m c² n² Ω² along ψ − θ; rollers as two more masses."""
        for number in range(self.count):
            own = name if self.count == 1 else f"{name}_{number + 1}"
            yield from self._one(own, 2.0 * math.pi * number / self.count)

    def _one(self, name: str, place: float) -> Iterator[Stamp]:
        share = 1.0 / self.count
        along = {self.carrier: -1.0, name: 1.0}
        yield Mass(name, {name: 1.0}, share * self.mass * self.distance**2)
        if self.rollers:
            half, spin = self.distance / 2, self.distance / (2 * self.rollers.radius)
            way = {self.carrier: self.rollers.distance - half, name: half}
            turn = {self.carrier: 1.0 + spin, name: -spin}
            yield Mass(f"{name}.rollers", way, share * self.rollers.mass)
            yield Mass(f"{name}.roller_spin", turn, share * self.rollers.inertia)
        bend = flattening(self.path, self.order)
        yield Connection(
            f"{name}.suspension",
            along,
            damping=share * self.damping,
            centrifugal_stiffness=share * self._stiffness,
            carrier=self.carrier,
            law=self._stops,
            swing=Swing(self.carrier, share * self.mass, self.distance, self.curvature_radius, bend, place),
        )

    @property
    def _stops(self) -> Law | None:
        """The end stops of one pendulum, along ψ − θ = s/c."""
        if self.stop is None:
            return None
        reach, stiffness = self.stop / self.distance, self.stop_stiffness * self.distance**2
        return Contacts.between(-reach, reach, stiffness, self.stop_time)

    def _check_stops(self) -> None:
        if self.count != int(self.count) or self.count < 1:
            raise ModelError("a whole number of pendulums is wanted", where="count", found=f"{self.count}")
        if self.stop is None:
            return
        checks.positive(self.stop, "stop", "length")
        checks.positive(self.stop_stiffness, "stop_stiffness", "spring_rate")
        checks.not_negative(self.stop_time, "stop_time", "time")
        end = path_end(self.path, self.order, self.distance)
        if self.stop >= end:
            found, allowed = f"{self.stop:g} m", f"less than {end:g} m"
            raise ModelError("the path ends before the stop", where="stop", found=found, allowed=allowed)


def tuning_order(path: Path, order: float, distance: float, amplitude: float) -> float:
    """Order of free oscillation at arc ``amplitude`` [m] of a pendulum tuned to ``order`` at small amplitude.

    At constant Ω, ½ṡ² − ½R²(s)Ω² is conserved, so the period is a quadrature over the path's R²(s).  The circle:
    n(φ0)/n0 = π / (2 K(sin²(φ0/2))).  Raises ModelError beyond the end of the path.

    >>> rho = 0.1 / 10
    >>> round(tuning_order("circular", 3.0, 0.1, rho * math.radians(30)) / 3.0, 8)
    0.98288908
    """
    from scipy.integrate import quad  # imported where used: scipy takes longer to import than a whole modal analysis
    from scipy.special import ellipk

    rho, end = distance / (1 + order**2), path_end(path, order, distance)
    if not 0 < amplitude <= end:
        found, allowed = f"{amplitude:g} m", f"above 0, up to {end:g} m"
        raise ModelError("the pendulum's path ends before", where="amplitude", found=found, allowed=allowed)
    if path == "circular":
        return order * math.pi / (2 * float(ellipk(math.sin(amplitude / rho / 2) ** 2)))
    if path in ("tautochrone", "epicycloid"):
        return order

    def integrand(u: float) -> float:
        s = amplitude * math.sin(u)
        return amplitude * math.cos(u) / math.sqrt(squared_distance(path, order, distance, s) - rest)

    rest = squared_distance(path, order, distance, amplitude)
    cut = math.pi / 2 - 1e-4  # beyond it the root is a difference of equal numbers and the integrand is even
    quarter = quad(integrand, 0.0, cut, epsrel=1e-11)[0] + (math.pi / 2 - cut) * integrand(cut)
    return math.pi / 2 / float(quarter)


def squared_distance(path: Path, order: float, distance: float, arc: float) -> float:
    """R²(s) [m²] of the pendulum from the axis at arc length s [m] along the path with ρ² = ρ0² − λ² s².

    >>> round(squared_distance("tautochrone", 3.0, 0.1, 0.005), 9) == round(0.1**2 - 3.0**2 * 0.005**2, 9)
    True
    """
    from torsional.numerics.motion.pendulum_path import path_at  # imported where used: it imports numba

    x, y, *_ = path_at(distance / (1 + order**2), flattening(path, order), distance, arc)
    return float(x * x + y * y)


def path_end(path: Path, order: float, distance: float) -> float:
    """Arc length [m] at which a path ends: the circle where it meets itself, the others where their curvature does.

    >>> round(path_end("cycloid", 3.0, 0.1), 12)
    0.01
    """
    rho = distance / (1 + order**2)
    return {"circular": math.pi * rho, "cycloid": rho}.get(path, distance / (order * math.sqrt(1 + order**2)))


def flattening(path: Path, order: float) -> float:
    """λ of a path: 0 circle, 1 cycloid, n/sqrt(1 + n²) the epicycloid, which is the tautochrone R² = c² − n² s².

    >>> flattening("cycloid", 3.0)
    1.0
    """
    return {"circular": 0.0, "cycloid": 1.0}.get(path, order / math.sqrt(1 + order**2))


@checked
def with_pendulum(absorber: Absorber, pendulum: CentrifugalPendulum) -> Absorber:
    """Any absorber with a pendulum on one of its bodies.

    >>> from torsional.absorbers.single_mass import single_mass_flywheel
    >>> with_pendulum(single_mass_flywheel(1.9), CentrifugalPendulum("flywheel", 3.0, 0.12, 3.0)).kind
    'single mass flywheel with pendulum'
    """
    if pendulum.carrier not in absorber.nodes:
        raise ModelError(
            "the pendulum's carrier is not a body of the absorber",
            where="pendulum.carrier",
            found=repr(pendulum.carrier),
            allowed=", ".join(absorber.nodes),
        )
    return absorber.joined({"pendulum": pendulum}, kind=f"{absorber.kind} with pendulum")
