"""Measured cylinder pressure, resampled to exact half orders and scaled to a wanted mean torque."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from torsional import checks
from torsional.arguments import checked, checked_fields
from torsional.engine.cylinder import Cylinder
from torsional.engine.gas import PressureShapes
from torsional.engine.orders import CYCLE, SAMPLES, FloatArray, crank_angle_grid, periodic_spline
from torsional.engine.trace_file import pressure_table, text_of
from torsional.errors import ModelError

COARSEST = np.radians(6.0)
EXPONENTS = (1.0, 1.7)
ANCHOR = np.radians((-90.0, -40.0))


@dataclass(frozen=True, eq=False)
@checked_fields
class PressureTrace:
    """Absolute cylinder pressure [Pa] over one cycle, shape (1 or cylinders, 1440), every half degree from 0 to 719.5°.

    With one row all cylinders burn alike, and 0° is the cylinder's own firing top dead centre.  With a row a cylinder
    the crank angle is the engine's, zero at firing of cylinder 1, unless ``own_angle`` says that each row counts from
    the firing of its own cylinder.

    A wanted mean torque is met by scaling the combustion part alone: what the pressure has above the motored
    polytrope, fitted to the trace between 90° and 40° before firing and carried on to 180° after it.  Gas
    exchange and compression stay as measured, so a trace serves best near the load it was measured at.  Rows of
    cylinders that did not fire stay as they are.

    Raises ModelError for pressures that are not finite, absolute and below 1000 bar, or of another shape.

    >>> PressureTrace(np.full((1, 1440), 2e5)).pressure.shape
    (1, 1440)
    """

    pressure: FloatArray
    own_angle: bool = False

    def __post_init__(self) -> None:
        values = np.array(self.pressure, dtype=float, ndmin=2)
        if values.ndim != 2 or values.shape[1] != SAMPLES or not 1 <= values.shape[0] <= 16:
            allowed = f"(1 to 16 cylinders, {SAMPLES} samples)"
            remedy = "PressureTrace.sampled resamples any record"
            raise ModelError(
                "the array has another shape", where="pressure", found=str(values.shape), allowed=allowed, remedy=remedy
            )
        _check_pressures(values)
        values.setflags(write=False)
        object.__setattr__(self, "pressure", values)

    @classmethod
    @checked
    def from_csv(
        cls, path: str | Path, *, speed: float | None = None, offset: float = 0.0, own_angle: bool = False
    ) -> PressureTrace:
        """Read a file as `from_text` reads its text; ModelError names the file."""
        text = text_of(path)
        try:
            return cls.from_text(text, speed=speed, offset=offset, own_angle=own_angle)
        except ModelError as error:
            raise error.located(file=str(path)) from None

    @classmethod
    @checked
    def from_text(
        cls, text: str, *, speed: float | None = None, offset: float = 0.0, own_angle: bool = False
    ) -> PressureTrace:
        """Read a table of crank angle or time and pressure; see ``trace_file.pressure_table`` for its form.

        ``speed`` [rad/s] turns time into crank angle; ``offset`` [rad] is added to the angle so that 0 becomes the
        firing top dead centre.  Raises ModelError for a malformed table or record.

        >>> rows = "\\n".join(f"{i},{2 + (i < 20 or i > 700)}" for i in range(720))
        >>> PressureTrace.from_text("crank_angle [deg],pressure [bar]\\n" + rows).pressure[0, 0].round().item()
        300000.0
        """
        table = pressure_table(text)
        if table.angle is not None:
            angle = table.angle
        elif speed is None:
            raise ModelError("a record over time needs the engine speed", where="speed", remedy="give speed [rad/s]")
        else:
            assert table.time is not None
            angle = table.time * checks.positive(speed, "speed", "speed")
        return cls.sampled(angle, table.pressure, offset=offset, own_angle=own_angle)

    @classmethod
    @checked
    def sampled(
        cls, crank_angle: ArrayLike, pressure: ArrayLike, *, offset: float = 0.0, own_angle: bool = False
    ) -> PressureTrace:
        """Resample records pressure [Pa] (rows,) or (cylinders, rows) over rising crank angles [rad] (rows,).

        Whole cycles are averaged, a rest is left out and so is a repeated end point; an angle that starts again after
        each cycle is carried on.  Between samples a periodic cubic spline is drawn.
        Raises ModelError for less than one cycle, angles that do not rise, or steps above 6°.
        """
        angle, values = np.asarray(crank_angle, dtype=float), np.array(pressure, dtype=float, ndmin=2)
        if angle.ndim != 1 or angle.size < 2 or values.shape[-1] != angle.size or values.ndim != 2:
            found = f"{angle.shape} angles, {values.shape} pressures"
            raise ModelError("angles and pressures do not belong together", where="pressure", found=found)
        if not np.isfinite(angle).all():
            raise ModelError("the crank angle must be finite", where="crank_angle")
        _check_pressures(values)
        angle, values = _unwrapped(angle, values)
        cycles, kept = _whole_cycles(angle)
        knots = np.append(angle[kept], angle[0] + cycles * CYCLE) + checks.number(offset, "offset")
        spline = periodic_spline(knots, values[:, kept])
        grid = crank_angle_grid() + CYCLE * np.arange(cycles)[:, None]
        return cls(spline(grid).mean(axis=1), own_angle)

    def pressure_shapes(self, cylinder: Cylinder, firing_angles: FloatArray) -> PressureShapes:
        """Rows of motored and combustion pressure; heat 1 is the trace as measured."""
        rows = self._from_own_firing(firing_angles)
        motored = np.array([_motored(row, cylinder, f"pressure {number}") for number, row in enumerate(rows, 1)])
        work = ((rows - motored) * cylinder.lever).mean(axis=1) * CYCLE
        firing = work > 0.05e5 * cylinder.displacement
        if not firing.any():
            remedy = "a motored trace cannot be scaled to a torque: give one of a firing cylinder"
            raise ModelError("the trace does no work above its motored part", where="pressure", remedy=remedy)
        return PressureShapes(np.concatenate([motored, (rows - motored) * firing[:, None]]), self._coefficients)

    def _coefficients(self, mean_effective_pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        rows = len(self.pressure)
        one, none = np.eye(rows), np.zeros((rows, rows))
        shape = (len(mean_effective_pressure), rows, 2 * rows)
        return np.broadcast_to(np.hstack([one, none]), shape), np.broadcast_to(np.hstack([none, one]), shape)

    def _from_own_firing(self, firing_angles: FloatArray) -> FloatArray:
        """The rows with 0 at each cylinder's firing, the largest pressure near it or the angles are refused."""
        count = len(self.pressure)
        if count not in (1, len(firing_angles)):
            allowed = f"1, or one for each of the {len(firing_angles)} cylinders"
            raise ModelError(
                "the number of pressure columns does not fit", where="pressure", found=str(count), allowed=allowed
            )
        rows = self.pressure
        if count > 1 and not self.own_angle:
            knots = np.append(crank_angle_grid(), CYCLE)
            spline = periodic_spline(knots, rows)
            shifted = np.mod(crank_angle_grid() + firing_angles[:, None], CYCLE)
            rows = np.array([spline(angles)[number] for number, angles in enumerate(shifted)])
        for number, row in enumerate(rows, 1):
            peak = np.degrees(_signed()[int(np.argmax(row))])
            if abs(peak) > 90.0 and not _is_sealed(row):
                remedy = "0° must be firing top dead centre: give offset, or own_angle, or check the firing order"
                found = f"{peak:g}° from firing"
                raise ModelError(
                    "the peak pressure is far from firing", where=f"pressure {number}", found=found, remedy=remedy
                )
        return rows


def _is_sealed(row: FloatArray) -> bool:
    """Whether valves stay closed: the pressure rises about as high at both top dead centres."""
    peaks = row[np.abs(_signed()) < np.pi / 2].max(), row[np.abs(_signed()) > 3 * np.pi / 2].max()
    return bool(min(peaks) > 0.75 * max(peaks) > 1.5 * float(row.min()))


def _signed() -> FloatArray:
    grid = crank_angle_grid()
    return np.asarray(np.where(grid < CYCLE / 2, grid, grid - CYCLE))


def _motored(row: FloatArray, cylinder: Cylinder, where: str) -> FloatArray:
    """The trace with its combustion replaced by the polytrope of its own compression."""
    angle, volume = _signed(), np.log(cylinder.volume(crank_angle_grid()))
    fitted = (angle >= ANCHOR[0]) & (angle <= ANCHOR[1])
    exponent = -np.polyfit(volume[fitted], np.log(row[fitted]), 1)[0]
    if not EXPONENTS[0] <= exponent <= EXPONENTS[1]:
        found = f"a polytropic exponent of {exponent:.2f} between 90° and 40° before firing"
        remedy = "check the top dead centre (offset), the zero of the pressure, and bore, stroke and compression ratio"
        allowed = f"{EXPONENTS[0]:g} to {EXPONENTS[1]:g}"
        problem = "the trace is not compressed as a gas is"
        raise ModelError(problem, where=where, found=found, allowed=allowed, remedy=remedy)
    level = np.mean(np.log(row[fitted]) + exponent * volume[fitted])
    polytrope = np.exp(level - exponent * volume)
    return np.asarray(np.where((angle > ANCHOR[1]) & (angle <= np.pi), polytrope, row))


def _check_pressures(values: FloatArray) -> None:
    for number, row in enumerate(values, 1):
        if not np.isfinite(row).all():
            raise ModelError("the pressure must be finite", where=f"pressure {number}")
        if row.min() <= 0:
            remedy = "give absolute pressures (gauge plus about 1 bar)"
            found = f"{row.min() / 1e5:g} bar"
            raise ModelError("a pressure is not above zero", where=f"pressure {number}", found=found, remedy=remedy)
        if row.max() > 1e8:
            found = f"{row.max() / 1e5:g} bar"
            raise ModelError(
                "no engine reaches this pressure",
                where=f"pressure {number}",
                found=found,
                allowed="up to 1000 bar",
                remedy="check the unit",
            )


def _unwrapped(angle: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Angles carried on where they start again after a cycle, a doubled sample there left out."""
    steps = np.diff(angle)
    carried = angle + CYCLE * np.concatenate([[0.0], np.cumsum(steps < -CYCLE / 2)])
    doubled = np.concatenate([[False], (steps < -CYCLE / 2) & (np.abs(np.diff(carried)) < 1e-9)])
    carried, values = carried[~doubled], values[:, ~doubled]
    falling = np.diff(carried) <= 0
    if falling.any():
        index = int(np.argmax(falling))
        found = f"{np.degrees(carried[index + 1]):g}° after {np.degrees(carried[index]):g}°, sample {index + 2}"
        raise ModelError("the crank angle (or time) must rise", where="crank_angle", found=found)
    return carried, values


def _whole_cycles(angle: FloatArray) -> tuple[int, FloatArray]:
    """Number of whole cycles and the samples inside them; the repeated end point is outside."""
    steps = np.diff(angle)
    step = float(np.median(steps))
    cycles = int((angle[-1] - angle[0] + 1.5 * step) // CYCLE)
    if cycles < 1:
        found = f"{np.degrees(angle[-1] - angle[0]):g}°"
        remedy = "check the angle's unit, or the speed for a record over time"
        raise ModelError(
            "the record is shorter than one cycle of 720°", where="crank_angle", found=found, remedy=remedy
        )
    kept = angle < angle[0] + cycles * CYCLE - 0.25 * step
    gap = max(steps.max(), angle[0] + cycles * CYCLE - angle[kept][-1])
    if gap > COARSEST:
        found = f"a step of {np.degrees(gap):g}°"
        raise ModelError("the samples are too far apart", where="crank_angle", found=found, allowed="6° at most")
    return cycles, np.asarray(kept)
