"""Piecewise-linear laws: stages, lash, clearances and stops as a sum of hinges."""
# mypy: disable-error-code="untyped-decorator"

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numba
import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked, checked_fields
from torsional.errors import ModelError
from torsional.laws.base import Law, Told, plain
from torsional.laws.checks import rising_points
from torsional.laws.rows import HingeRows
from torsional.numerics.arrays import Array, IntArray
from torsional.numerics.hinge import depth
from torsional.units import quoted


@numba.njit(cache=True, error_model="numpy")
def hinges_torque(parameters: Array, angle: float, rate: float, memory: float, step: float) -> Told:
    """f(φ) = k0 φ + Σ s Δk max(0, s (φ − g)); parameters are k0 followed by rows of (g, s, Δk)."""
    torque, tangent = parameters[0] * angle, parameters[0]
    for i in range(1, parameters.size, 3):
        side, change = parameters[i + 1], parameters[i + 2]
        beyond = depth(angle, 0.0, parameters[i], side, 0.0)
        if beyond > 0.0:
            torque += side * change * beyond
            tangent += change
    return plain(torque, tangent, 0.0)


def hinge_angles(parameters: Array, torque: Array) -> Array:
    """Angles [rad] (laws, torques) at which laws with ``parameters`` (laws, 1 + 3 hinges) carry torques [Nm]; in a free
    range, its middle.  Raises ModelError where no angle carries one.
    """
    sides, changes = parameters[:, 2::3], parameters[:, 3::3]
    edges, at = _corners(parameters)
    slope = [parameters[:, 0] + np.where(sides == side, changes, 0.0).sum(axis=1) for side in (-1.0, 1.0)]
    low, high = ((slope[end] <= 0)[:, None] for end in (0, 1))
    beyond = low & (torque < at[:, :1]) | high & (torque > at[:, -1:])
    if beyond.any():
        raise ModelError("no angle carries this torque", found=f"{torque[beyond.any(axis=0)][0]:g} Nm")
    left, right = ((at[:, :, None] < torque).sum(axis=1), (at[:, :, None] <= torque).sum(axis=1))
    last = edges.shape[1] - 1
    middle = 0.5 * (_taken(edges, np.minimum(left, last)) + _taken(edges, np.maximum(right - 1, 0)))
    before, behind = np.maximum(left - 1, 0), np.minimum(left, last)
    rise = _taken(at, behind) - _taken(at, before)
    with np.errstate(divide="ignore", invalid="ignore"):
        along = (torque - _taken(at, before)) / rise * (_taken(edges, behind) - _taken(edges, before))
        first = edges[:, :1] + (torque - at[:, :1]) / slope[0][:, None]
        above = edges[:, -1:] + (torque - at[:, -1:]) / slope[1][:, None]
    inside = np.where(left == 0, first, np.where(left > last, above, _taken(edges, before) + along))
    return np.where(right > left, middle, inside)


def hinge_tangents(parameters: Array, torque: Array) -> Array:
    """Tangent stiffnesses [Nm/rad] (laws, torques) of such laws where they carry torques [Nm]."""
    edges, at = _corners(parameters)
    outer = edges[:, :1] - 1.0, edges[:, -1:] + 1.0
    slopes = hinge_slopes(parameters, np.hstack([outer[0], 0.5 * (edges[:, 1:] + edges[:, :-1]), outer[1]]))
    passed, met = np.zeros((len(at), torque.size), dtype=np.intp), np.zeros((len(at), torque.size), dtype=bool)
    for corner in at.T:
        passed += corner[:, None] < torque
        met |= abs(corner[:, None] - torque) <= 1e-12 * abs(torque)
    found = _taken(slopes, passed)
    for value in np.unique(torque[met.any(axis=0)]):  # what rounding makes of a corner, as one law tells it
        alike = torque == value
        own = met[:, alike][:, 0]
        rows = parameters[own]
        found[np.ix_(own, alike)] = hinge_slopes(rows, hinge_angles(rows, np.array([value])))
    return found


def hinge_slopes(parameters: Array, angle: Array) -> Array:
    """Tangent stiffnesses [Nm/rad] (laws, angles) of such laws at angles [rad] (laws, angles)."""
    slopes = np.broadcast_to(parameters[:, :1], angle.shape).copy()
    for gap, side, change in (parameters[:, i : i + 3].T for i in range(1, parameters.shape[1], 3)):
        slopes += np.where(depth(angle, 0.0, gap[:, None], side[:, None], 0.0) > 0.0, change[:, None], 0.0)
    return slopes


def _corners(parameters: Array) -> tuple[Array, Array]:
    """Angles (laws, hinges + 1) at which slopes change, and zero, from left to right, with their torques."""
    edges = np.sort(np.hstack([parameters[:, 1::3], np.zeros((len(parameters), 1))]), axis=1)
    return edges, _torques(parameters, edges)


def _torques(parameters: Array, angle: Array) -> Array:
    """Torques of such laws, as `hinges_torque` tells them."""
    torques = parameters[:, :1] * angle
    for gap, side, change in (parameters[:, i : i + 3].T[..., None] for i in range(1, parameters.shape[1], 3)):
        torques += side * change * np.maximum(depth(angle, 0.0, gap, side, 0.0), 0.0)
    return torques


def _taken(table: Array, index: IntArray) -> Array:
    return np.take_along_axis(table, index, axis=1)


@dataclass(frozen=True)
@checked_fields
class Hinges(Law):
    """Every piecewise-linear law: stages, lash, clearances, stops, as a sum of hinges.

    f(φ) = k0 φ + Σ_i s_i Δk_i max(0, s_i (φ − g_i)), with ``stiffness`` k0 [Nm/rad] and one hinge a (gap g [rad],
    side s = ±1, change of stiffness Δk [Nm/rad]).  ``stops`` names the angles [rad] that are end stops.
    Raises ModelError where the slope would be negative, since such a law stores no energy.

    >>> law = Hinges.staged([(1000.0, 8e3), (3500.0, 24e3)], stop_stiffness=1e6)
    >>> float(law.torque(0.125)), float(law.tangent(0.2))
    (1000.0, 24000.0)
    """

    stiffness: float
    gaps: tuple[float, ...] = ()
    sides: tuple[float, ...] = ()
    changes: tuple[float, ...] = ()
    stops: tuple[float, ...] = field(default=())

    kernel: ClassVar[Callable[..., Told]] = hinges_torque

    def __post_init__(self) -> None:
        if not len(self.gaps) == len(self.sides) == len(self.changes):
            raise ModelError("a hinge needs a gap, a side and a change of stiffness", found=repr(self))
        values = np.array([self.stiffness, *self.gaps, *self.sides, *self.changes], dtype=float)
        if not np.isfinite(values).all() or any(s not in (-1.0, 1.0) for s in self.sides):
            raise ModelError("hinges need finite values and sides of +1 or -1", found=repr(self))
        slope = self.slopes.min()
        if slope < -1e-9 * np.abs(values).max():
            raise ModelError("the stiffness must not be negative", found=f"{slope:g} Nm/rad in one stage")

    @classmethod
    def staged(
        cls,
        stages: Sequence[tuple[float, float]],
        *,
        coast: Sequence[tuple[float, float]] | None = None,
        lash: float = 0.0,
        stop_stiffness: float = 0.0,
    ) -> Hinges:
        """Stages as an engineer lists them: (up to this torque [Nm], stiffness [Nm/rad]), first to last.

        ``lash`` is the whole free angle [rad], half to each side.  ``coast`` lists the stages for negative torque
        (default: the same).  With ``stop_stiffness`` [Nm/rad] the last torque is where the stop is met; without it the
        last stage goes on.

        >>> Hinges.staged([(500.0, 1e4)], lash=0.02).torque([0.005, 0.02]).tolist()
        [0.0, 100.0]
        """
        sides = [
            (s, _checked_stages(given)) for s, given in ((1.0, stages), (-1.0, stages if coast is None else coast))
        ]
        plain = lash == 0 and sides[0][1][0][1] == sides[1][1][0][1]
        base = float(sides[0][1][0][1]) if plain else 0.0
        hinges: list[tuple[float, float, float]] = []
        stops: list[float] = []
        for side, listed in sides:
            at, carried, before = 0.5 * lash, 0.0, base
            for torque, stiffness in listed:
                if stiffness != before:
                    hinges.append((side * at, side, stiffness - before))
                at, carried, before = at + (torque - carried) / stiffness, torque, stiffness
            if stop_stiffness > 0:
                hinges.append((side * at, side, stop_stiffness - before))
                stops.append(side * at)
        gaps, signs, changes = zip(*hinges, strict=True) if hinges else ((), (), ())
        return cls(base, gaps, signs, changes, tuple(sorted(stops)))

    @classmethod
    @checked
    def through(cls, points: Sequence[tuple[float, float]]) -> Hinges:
        """Straight lines through points (angle [rad], torque [Nm]) with rising angles; the outer lines go on.

        Angles are counted from where the spring is free of torque, so that the lines pass through (0, 0); raises
        ModelError otherwise, and where the torque falls.

        >>> Hinges.through([(-0.1, -100.0), (0.0, 0.0), (0.1, 100.0), (0.2, 400.0)]).torque([-0.2, 0.3]).tolist()
        [-200.0, 700.0]
        """
        angles, torques = rising_points(points)
        slopes = np.diff(torques) / np.diff(angles)
        inner = angles[1:-1]
        middle = int(np.searchsorted(inner, 0.0))  # the line that passes through the angle zero
        at_zero = torques[middle] - slopes[middle] * angles[middle]
        if abs(at_zero) > 1e-9 * np.abs(torques).max():
            remedy = "count the angles from where the spring is free of torque"
            raise ModelError("the lines miss the point (0, 0)", found=f"{at_zero:g} Nm there", remedy=remedy)
        steps = np.diff(slopes)
        kinks = np.flatnonzero(np.abs(steps) > 1e-12 * slopes.max())
        sides = np.where(kinks < middle, -1.0, 1.0)
        changes = sides * steps[kinks]
        listed = (tuple(float(v) for v in values) for values in (inner[kinks], sides, changes))
        return cls(float(slopes[middle]), *listed)

    @property
    def parameters(self) -> Array:
        """k0, then (gap, side, change) of every hinge."""
        rows = np.array([self.gaps, self.sides, self.changes], dtype=float)
        return np.concatenate([[self.stiffness], rows.T.ravel()])

    def hinges(self) -> HingeRows:
        """The hinges as they were given, without contact times."""
        gap, side, change = (np.array(values, dtype=float) for values in (self.gaps, self.sides, self.changes))
        return HingeRows(float(self.stiffness), gap, side, change, np.zeros(gap.size))

    @property
    def edges(self) -> Array:
        """Angles [rad] at which the stiffness changes, from left to right."""
        return np.unique(self.gaps)

    def stage_name(self, angle: float) -> str:
        """Stages as an engineer counts them: stage 1 first; free play; stop.

        >>> law = Hinges.staged([(100.0, 1e3), (300.0, 4e3)], lash=0.02, stop_stiffness=1e6)
        >>> [law.stage_name(x) for x in (0.0, 0.05, -0.12, 0.2)]
        ['free play', 'stage 1', 'stage 2', 'stop']
        """
        if any(abs(angle) >= abs(stop) and angle * stop > 0 for stop in self.stops):
            return "stop"
        number = abs(int(self.stage(angle))) + (float(self.tangent(0.0)) > 0)
        return f"stage {number}" if number else "free play"

    def distance_to_stop(self, angle: float, torque: float) -> float:
        """The way [rad] left to the stop on the side of the torque: zero in it, not a number without one."""
        ahead = [abs(stop) for stop in self.stops if stop * (torque or 1.0) > 0]
        return max(min(ahead) - abs(angle), 0.0) if ahead else float("nan")

    def angle(self, torque: ArrayLike, beside: float = 0.0) -> Array:
        """The relative angle [rad] at which a torque [Nm] is carried; in a free range, its middle.

        With a stiffness ``beside`` it [Nm/rad] as any law has it, else in closed form.
        Raises ModelError where no angle carries it (a last stage without stiffness).
        """
        torque = np.asarray(torque, dtype=float)
        if beside != 0.0:
            return super().angle(torque, beside)
        return np.asarray(hinge_angles(self.parameters[None], torque.ravel())[0].reshape(torque.shape))

    def describing_function(self, centre: ArrayLike, amplitude: ArrayLike) -> tuple[Array, Array]:
        """Mean torque [Nm] and first-harmonic stiffness [Nm/rad] under φ = centre + amplitude cos ψ.

        Closed form of the Fourier integrals over the time each hinge is engaged (Krylov and Bogoliubov's
        equivalent linearisation; Magnus, Popp, Sextro: Schwingungen, 2016, ch. 3).

        >>> mean, stiffness = Hinges.staged([(1e4, 1e4)], lash=0.02).describing_function(0.0, 0.01)
        >>> float(stiffness)
        0.0
        """
        centre, amplitude = np.broadcast_arrays(np.asarray(centre, dtype=float), np.asarray(amplitude, dtype=float))
        mean, stiffness = self.stiffness * centre, np.full(centre.shape, self.stiffness)
        for gap, side, change in zip(self.gaps, self.sides, self.changes, strict=True):
            depth = side * (gap - centre)
            half = np.arccos(np.clip(depth / amplitude, -1.0, 1.0))
            mean = mean + side * change * (amplitude * np.sin(half) - depth * half) / np.pi
            share = half + 0.5 * np.sin(2 * half) - 2 * depth / amplitude * np.sin(half)
            stiffness = stiffness + change * share / np.pi
        return mean, stiffness


def _checked_stages(stages: Sequence[tuple[float, float]]) -> Sequence[tuple[float, float]]:
    """The stages, refused unless torques rise and stiffnesses are positive."""
    try:
        listed = [(float(torque), float(stiffness)) for torque, stiffness in stages]
    except (TypeError, ValueError):
        raise ModelError("pairs of a torque and a stiffness are wanted", where="stages", found=quoted(stages)) from None
    if not listed:
        raise ModelError("at least one stage is needed", where="stages")
    carried = 0.0
    for number, (torque, stiffness) in enumerate(listed):
        if not stiffness > 0 or not np.isfinite(stiffness):
            raise ModelError(
                "a stage needs a positive stiffness", where=f"stages.{number}.stiffness", found=f"{stiffness:g} Nm/rad"
            )
        if not torque > carried:
            raise ModelError(
                "stages are listed with rising torques",
                where=f"stages.{number}.up_to",
                found=f"{torque:g} Nm",
                allowed=f"more than {carried:g} Nm",
            )
        carried = torque
    return stages
