"""Periodic response of a system with force laws: every branch that hangs together with the main one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.arguments import checked, checked_fields
from torsional.engine import Excitation
from torsional.engine.orders import HIGHEST_ORDER
from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.numerics.continuation.following import Settings
from torsional.solvers.periodic.branches import TRACING, Explorer
from torsional.solvers.periodic.equations import Split
from torsional.solvers.periodic.isolated import seek_doubled, seek_isolated
from torsional.solvers.periodic.load import Load
from torsional.solvers.periodic.presented import presented
from torsional.solvers.periodic.problem import HarmonicProblem, Setting
from torsional.solvers.periodic.refined import refined
from torsional.solvers.periodic.varied import VariedProblem
from torsional.system import System

SIZED = 5
"""Values of the parameter at which the size of the angles is estimated."""

RESOLVED = 1e-5
"""Share of the motion of its ends below which a twist is given to fewer digits."""

_LOADS: dict[str, Callable[[Excitation], Load]] = {
    "speed": Load.over_speed,
    "mean_torque": Load.over_mean_torque,
    "amplitude": Load.over_amplitude,
}


@dataclass(frozen=True)
@checked_fields
class Variation:
    """A quantity of the system to be continued: its ``name``, its ``unit`` and how to ``build`` the system for a value.

    >>> Variation("dmf.stiffness", "Nm/rad", lambda stiffness: None).name
    'dmf.stiffness'
    """

    name: str
    unit: str
    build: Callable[[float], System]


@dataclass(frozen=True, kw_only=True)
class Exploration:
    """What is asked of an exploration, each as `periodic_response` explains it."""

    parameter: str | Variation = "speed"
    hold: str = ""
    speed: float | None = None
    highest_order: float = HIGHEST_ORDER
    base_order: float | None = None
    depth: int = 2
    stability: bool = True
    isolated: bool = False
    settings: Settings = TRACING
    at: ArrayLike = ()


@checked
def periodic_response(
    system: System,
    excitation: Excitation | Load,
    span: tuple[float, float],
    *,
    parameter: str | Variation = "speed",
    hold: str = "",
    speed: float | None = None,
    highest_order: float = HIGHEST_ORDER,
    base_order: float | None = None,
    depth: int = 2,
    stability: bool = True,
    isolated: bool = False,
    settings: Settings = TRACING,
    at: ArrayLike = (),
) -> xr.Dataset:
    """Branches of periodic motion of a ``system`` with laws over a ``span`` of the ``parameter``; no guess is needed.

    ``parameter``: "speed" [rad/s], "mean_torque" [Nm] (the sum of the order-0 torques), "amplitude" (a factor on all
    orders above 0) or a `Variation`; all but the first need the ``speed`` [rad/s].  ``excitation``: torque harmonics
    with order 0 as the mean, at one operating point or over speeds; ``hold``: the node that takes up the mean torque.
    Harmonics go up to ``highest_order``, in multiples of ``base_order`` (default: the largest that fits).
    ``depth``: how many times a branch may leave a branch.  Stability by Floquet multipliers where ``stability``.
    Normal loads that follow the speed are settled at a given ``speed``; over speed, or where they follow torques, the
    system wants ``loaded`` first.
    ``at``: values of the parameter at which every branch that passes them gets a point.
    ``isolated``: branches that hang together with none of these are sought as well, by continuation in torque and
    amplitude and from motions in time.

    Dimensions: ``point`` along all branches in turn with coordinates speed, mean_torque, value and branch; ``angle``
    (point, order, node) [rad], ``twist`` [rad] and ``torque`` [Nm] (point, order, element) complex 0-peak with order 0
    the mean, ``stable``, ``multiplier``, ``residual``; tables of ``branches`` and of ``bifurcation``.
    Raises ModelError for a system without laws, without excitation, or where no first solution is found.

    x_h + G_h(ω) F_h(x) = b_h(ω) on the connections with laws; Krack and Gross, Harmonic Balance for Nonlinear Vibration
    Problems, Springer 2019, doi 10.1007/978-3-030-14023-6.

    >>> from torsional.components import Coupling, Inertia
    >>> from torsional.laws import Hinges
    >>> from torsional.powertrain import Powertrain
    >>> from torsional.system import assemble
    >>> law = Hinges(1.0, (1.0,), (1.0,), (1.0,))
    >>> one = assemble(Powertrain({"disc": Inertia(1.0), "spring": Coupling("ground", "disc", law, damping=0.04)}))
    >>> found = periodic_response(one, Excitation(("disc",), [0, 1], 1.0, [[1.0, 1.0]]), (2.0, 3.0), highest_order=12)
    >>> abs(found.twist.sel(element="spring", order=1)).values[found.speed.values == 3.0].round(4)
    array([0.1309])
    """
    asked = Exploration(
        parameter=parameter,
        hold=hold,
        speed=speed,
        highest_order=highest_order,
        base_order=base_order,
        depth=depth,
        stability=stability,
        isolated=isolated,
        settings=settings,
        at=at,
    )
    return answered(system, excitation, span, asked)


def answered(
    system: System, excitation: Excitation | Load, span: tuple[float, float], asked: Exploration
) -> xr.Dataset:
    """What `periodic_response` gives back, of an exploration that is asked for as one thing."""
    explorer, parameter = explorer_of(system, excitation, span, asked), asked.parameter
    explorer.explored()
    if asked.depth:
        seek_doubled(explorer)
    if asked.isolated:
        seek_isolated(explorer)
    explorer.branches = [refined(branch, asked.at) for branch in explorer.branches]
    name, unit = (parameter.name, parameter.unit) if isinstance(parameter, Variation) else (parameter, "")
    return presented(explorer, name, unit, asked.stability)


def explorer_of(
    system: System, excitation: Excitation | Load, span: tuple[float, float], asked: Exploration
) -> Explorer:
    """The explorer that follows the branches, which has followed none yet."""
    low, high = _checked_span(span, asked)
    parameter, speed, highest = asked.parameter, asked.speed, asked.highest_order
    load = _load(excitation, parameter, low)
    order = asked.base_order or load.base_order
    load.refuse_others(order)
    make: Callable[[Setting, float], HarmonicProblem] = HarmonicProblem
    if isinstance(parameter, Variation):
        system, make = parameter.build(low), partial(VariedProblem, build=parameter.build)
    turning = 0.5 * (low + high) if speed is None else speed
    _refuse_switch(system, low, high, speed)
    split = Split(system if speed is None else system.loaded(speed), turning)
    fixed = None if parameter == "speed" else speed
    unit = low if low > 0.05 * high else max(abs(low), abs(high))
    setting = Setting(split, load, asked.hold, fixed, highest, np.ones(len(split.laws)), unit, main_order=order)
    if setting.harmonics(order) * order < order or order > highest:
        raise ModelError("the highest order is below the base order", where="highest_order", found=f"{highest:g}")
    unscaled = make(setting, order)
    setting = replace(setting, angle_scale=_angle_scale(unscaled, (low, high)))
    known = {order: unscaled.rescaled(setting)}
    return Explorer(
        setting, order, (low, high), asked.settings, asked.depth, asked.stability, make=make, problems=known
    )


def _checked_span(span: tuple[float, float], asked: Exploration) -> tuple[float, float]:
    """The ends of the parameter, refused unless they and the speed are what it wants."""
    low, high = float(span[0]), float(span[1])
    if not low < high or not np.isfinite([low, high]).all():
        raise ModelError("the span goes from a lower to a higher value", where="span", found=f"{low:g} to {high:g}")
    if asked.parameter == "speed" and low <= 0:
        raise ModelError("speeds are above zero", where="span", found=f"{low:g} rad/s")
    if asked.parameter != "speed" and not (asked.speed and asked.speed > 0):
        raise ModelError("the speed is missing", where="speed", remedy="all parameters but the speed need one")
    return low, high


def _load(excitation: Excitation | Load, parameter: str | Variation, value: float) -> Load:
    if isinstance(excitation, Load):
        return excitation
    if isinstance(parameter, Variation):
        one = Load.over_speed(excitation)
        if len(one.breaks) > 2:
            raise ModelError("one operating point is wanted", where="excitation", found=f"{len(one.breaks)} speeds")
        return one
    if parameter not in _LOADS:
        raise ModelError(
            "there is no such parameter",
            where="parameter",
            found=str(parameter),
            allowed=", ".join(_LOADS),
            remedy="give a Variation for any other quantity",
        )
    return _LOADS[parameter](excitation)


def _refuse_switch(system: System, low: float, high: float, speed: float | None) -> None:
    """A switched inertia must keep its state over the span."""
    for name, switch in zip(system.masses.names, system.masses.switches, strict=True):
        if switch is not None and speed is None and low <= switch.speed <= high:
            raise ModelError(
                "an inertia switches within the range",
                where=name,
                found=f"{switch.speed:g} rad/s",
                remedy="analyse the speeds below and above it one after the other",
            )


def _angle_scale(problem: HarmonicProblem, span: tuple[float, float]) -> Array:
    """Sizes of the angles (m,) to be expected: static twist, linear response, the nearest hinge, what is resolved."""
    values = [float(value) for value in np.linspace(*span, SIZED)]
    sizes = [np.abs(part) for value in values for part in problem.linear_size(value)]
    sizes += [RESOLVED * problem.part_motion(value) for value in values]
    sizes.append(np.array([law.nearest_edge for law in problem.setting.split.laws]))
    size = np.max(sizes, axis=0)
    return np.where(size > 0, size, size.max(initial=0.0) or 1.0)
