"""The two-stage dual mass flywheel with other stiffnesses, and where its sub-harmonic vibration is strongest then."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from torsional.errors import ModelError
from torsional.laws import Hinges
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.answers import by_peak, main_order, mode_of, modes
from torsional.studies.motions import SPRING, at_value, doubled, over_torque, twist_swing
from torsional.studies.strongest import HIGHEST_ORDER, Peak, Search, onset
from torsional.studies.trucks import hinged, replaced, sprung

SOFT, STIFF = 8e3, 24e3
"""Stiffnesses [Nm/rad] that are held while the other one is varied; they move with the peak of the full-load curve."""
TIMES = {"k2": (1.2, 3.0, 7), "k1": (1.2, 2.0, 7), "light": (1.6, 3.6, 6)}
"""Differences that are asked, evenly spaced: from and to how many times the one at the onset, and how many."""
SOFTEST = 0.1
"""Least stiffness of the first stage, over the second's."""
LIGHT = 0.25
"""A second, light damping, over the model's own."""
TORQUE_SHARES = (0.7, 2.3)
"""Mean torques that are searched, over the torque at the transition."""
LOADED = 0.95
"""How far they go of full load's peak with the stop in its place."""
LOOKS = 12
"""Speeds from which the strongest vibration is climbed to."""


def stages(model: Model) -> tuple[float, float]:
    """Stiffnesses [Nm/rad] before and after the transition of a two-stage model."""
    law = hinged(model, model.landmarks.springs[0])
    return float(law.tangent(0.0)), float(law.tangent(1.001 * law.nearest_edge))


def carrying(model: Model) -> tuple[float, float]:
    """The same; raises ModelError where the first stage is free play, which leaves no torque at the transition."""
    if stages(model)[0] <= 0 or transition_torque(model) <= 0:
        remedy = "leave the free play out of absorber.stages, or ask subharmonic_map, which takes any stages"
        raise ModelError("the first stage carries no torque", where=model.landmarks.springs[0], remedy=remedy)
    return stages(model)


def mode_speed(model: Model) -> float:
    """Order speed [rad/s] of the mode that lives in the springs of the DMF."""
    found = modes(model)
    return float(found.order_speed[mode_of(found, *model.landmarks.springs)])


def transition_torque(model: Model) -> float:
    """Torque [Nm] at which the second stage of a two-stage model begins."""
    law = hinged(model, model.landmarks.springs[0])
    return float(law.torque(law.nearest_edge))


def stepped(model: Model, first: float, second: float, damping: float | None = None, *, stop: bool = True) -> Model:
    """A copy of a two-stage model with other stiffnesses [Nm/rad], the same torques at transition and stop, and, if
    given, another damping [Nms/rad]; without its ``stop`` the second stage goes on."""
    spring = model.landmarks.springs[0]
    own = hinged(model, spring)
    listed = [(transition_torque(model), first), (stop_torque(model), second)]
    law = Hinges.staged(listed, stop_stiffness=float(own.tangent(2 * max(own.stops))) if stop else 0.0)
    changed = replaced(model, spring, law=law)
    return changed if damping is None else replaced(changed, spring, damping=float(damping))


def stop_torque(model: Model) -> float:
    """Torque [Nm] at which the springs meet their stop."""
    law = hinged(model, model.landmarks.springs[0])
    return float(law.torque(max(law.stops)))


def searched(model: Model, transition: float | None = None) -> Search:
    """Where the strongest vibration of half the firing order is looked for: mean torques about that of the transition,
    speeds about twice the order speeds of the springs' mode in either stage."""
    spring, at = model.landmarks.springs[0], transition or transition_torque(model)
    twice = [2 * mode_speed(sprung(model, spring, k)) for k in stages(model)]
    low, high = model.operation.speed
    looks = np.linspace(max(0.95 * twice[0], 0.8 * low), min(1.1 * twice[1], high), LOOKS)
    return Search(model, main_order(model) / 2, (TORQUE_SHARES[0] * at, TORQUE_SHARES[1] * at), looks)


def attained(model: Model) -> Search:
    """The same, as far as the engine has the mean torques; raises ModelError where nothing doubles its period there."""
    search = searched(model)
    low, high = search.torques
    search = replace(search, torques=(low, min(high, LOADED * model.full_load_peak())))
    if search.torques[1] <= low or not max(search.at(float(speed))[0, SPRING] for speed in search.first_look):
        found = f"transition at {transition_torque(model):.0f} Nm, full load's peak {model.full_load_peak():.0f} Nm"
        remedy = "ask a model with less damping beside the springs, or with a larger step"
        told = {"where": model.landmarks.springs[0], "found": found, "remedy": remedy}
        raise ModelError("no motion doubles its period about the transition", **told)
    return search


@dataclass(frozen=True)
class Case:
    """Two stiffnesses [Nm/rad] and the peaks of the quantities (of `NAMES`); ``travel``: the largest twist at the
    strongest torque over that at the stop."""

    first: float
    second: float
    peaks: tuple[Peak, ...]
    travel: float

    @property
    def difference(self) -> float:
        """k2 − k1 [Nm/rad]."""
        return self.second - self.first


@dataclass(frozen=True)
class Sweep:
    """Cases by rising difference: the stiffness [Nm/rad] that was ``held``, the ``damping`` [Nms/rad] beside the
    springs, the difference [Nm/rad] at the ``onset``."""

    held: float
    damping: float
    onset: float
    cases: tuple[Case, ...]


class Step:
    """A model whose steps are asked, without their stop: what vibrates there vibrates by the step alone."""

    def __init__(self, model: Model, pair: Callable[[float], tuple[float, float]], damping: float) -> None:
        self.model, self.pair, self.damping = model, pair, damping
        self.transition, self.stop = transition_torque(model), stop_torque(model)

    def search(self, difference: float) -> Search:
        """Where to look, with a difference of the stiffnesses [Nm/rad]."""
        return searched(stepped(self.model, *self.pair(difference), self.damping, stop=False), self.transition)

    def cases(self, differences: Array, begin: float) -> tuple[Case, ...]:
        """All of them, each sought where the ones before it lead to; the first from a speed [rad/s]."""
        found: list[Case] = []
        for difference in differences:
            near = np.full(4, begin) if not found else _speeds(found[-1])
            if len(found) > 1:
                near = 2 * near - _speeds(found[-2])
            found.append(self.case(float(difference), near))
        return tuple(found)

    def case(self, difference: float, near: Array) -> Case:
        """The peaks with one difference [Nm/rad], sought ``near`` speeds (4,) [rad/s]."""
        search, (first, second) = self.search(difference), self.pair(difference)
        peaks = tuple(search.peak(quantity, float(near[quantity])) for quantity in range(4))
        at_stop = self.transition / first + (self.stop - self.transition) / second
        return Case(first, second, peaks, _reach(search, peaks[SPRING]) / at_stop)


def _speeds(case: Case) -> Array:
    return np.array([peak.speed for peak in case.peaks])


def _reach(search: Search, peak: Peak) -> float:
    """The largest twist [rad] of the motion at a peak."""
    explorer = over_torque(search.model, peak.speed, search.torques, highest_order=HIGHEST_ORDER)
    found = [(branch, z) for branch in doubled(explorer) for z in at_value(branch, peak.torque)]
    return max((twist_swing(branch.problem, z)[1] for branch, z in found), default=np.nan)


@lru_cache(maxsize=2)
def sweeps(model: Model) -> dict[str, Sweep]:
    """All sweeps of a two-stage model: k2 varied, k1 varied, and k2 varied at light damping.

    Raises ModelError where no step has a motion of twice the period.
    """
    carrying(model)
    soft, stiff = (float(by_peak(model, k)) for k in (SOFT, STIFF))
    own = float(model.components[model.landmarks.springs[0]].damping)  # type: ignore[attr-defined]

    def from_soft(difference: float) -> tuple[float, float]:
        return soft, soft + difference

    def from_stiff(difference: float) -> tuple[float, float]:
        return stiff - difference, stiff

    return {
        "k2": _swept("k2", Step(model, from_soft, own), soft, (0.5 * soft, 4 * soft)),
        "k1": _swept("k1", Step(model, from_stiff, own), stiff, (0.2 * stiff, (1 - SOFTEST) * stiff)),
        "light": _swept("light", Step(model, from_soft, LIGHT * own), soft, (0.1 * soft, soft)),
    }


def _swept(name: str, step: Step, held: float, between: tuple[float, float]) -> Sweep:
    begins = onset(step.search, *between)
    low, high, count = TIMES[name]
    if name == "k1":
        high = min(high, between[1] / begins.difference)
    found = step.cases(np.linspace(low, high, count) * begins.difference, begins.speed)
    return Sweep(held, step.damping, begins.difference, found)


def table(found: tuple[Case, ...]) -> tuple[Array, Array, Array]:
    """Differences (n,), amplitudes (n, 4) and mean torques (n, 4) of a sweep."""
    peaks = np.array([[(peak.amplitude, peak.torque) for peak in one.peaks] for one in found])
    return np.array([one.difference for one in found]), peaks[..., 0], peaks[..., 1]
