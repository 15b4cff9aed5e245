"""The two-stage dual mass flywheel with other stiffnesses, and where its sub-harmonic vibration is strongest then."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import chain

import numpy as np

from torsional.laws import Hinges
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.studies.answers import main_order, mode_of, modes
from torsional.studies.motions import (
    INPUT_ACCELERATION,
    SHAFT,
    SPRING,
    TWIST,
    at_value,
    doubled,
    over_torque,
    twist_swing,
)
from torsional.studies.strongest import HIGHEST_ORDER, TORQUES, Peak, Search
from torsional.studies.trucks import hinged, replaced

SOFT, STIFF = 8e3, 24e3
"""Stiffnesses [Nm/rad] that are held while the other one is varied."""
STIFFER = (18e3, 20e3, 22e3, 24e3, 27e3, 30e3, 34e3)
SOFTER = (5e3, 6e3, 7e3, 8e3, 9e3, 10e3, 12e3)
LIGHT, LIGHTLY = 5.0, (12e3, 13e3, 14e3, 15e3, 16e3, 17e3)
"""A second, light damping [Nms/rad], and the second stiffnesses that are asked there."""


def stages(model: Model) -> tuple[float, float]:
    """Stiffnesses [Nm/rad] before and after the transition of a two-stage model."""
    law = hinged(model, model.landmarks.springs[0])
    return float(law.tangent(0.0)), float(law.tangent(1.001 * law.nearest_edge))


def mode_speed(model: Model) -> float:
    """Order speed [rad/s] of the mode that lives in the springs of the DMF."""
    found = modes(model)
    return float(found.order_speed[mode_of(found, *model.landmarks.springs)])


def transition_torque(model: Model) -> float:
    """Torque [Nm] at which the second stage of a two-stage model begins."""
    law = hinged(model, model.landmarks.springs[0])
    return float(law.torque(law.nearest_edge))


def stepped(model: Model, first: float, second: float, damping: float | None = None) -> Model:
    """A copy of a two-stage model with other stiffnesses [Nm/rad], the same torques at transition and stop, and, if
    given, another damping [Nms/rad]."""
    spring = model.landmarks.springs[0]
    own = hinged(model, spring)
    listed = [(transition_torque(model), first), (float(own.torque(max(own.stops))), second)]
    law = Hinges.staged(listed, stop_stiffness=float(own.tangent(2 * max(own.stops))))
    changed = replaced(model, spring, law=law)
    return changed if damping is None else replaced(changed, spring, damping=float(damping))


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


def case(model: Model, first: float, second: float, near: float | None) -> Case:
    """The peaks of one pair of stiffnesses."""
    search = Search(model, main_order(model) / 2)
    strongest = search.peak(SPRING, near)
    others = tuple(search.peak(quantity, strongest.speed) for quantity in (SHAFT, INPUT_ACCELERATION, TWIST))
    return Case(first, second, (strongest, *others), _travel(model, strongest))


def _travel(model: Model, peak: Peak) -> float:
    explorer = over_torque(model, peak.speed, TORQUES, highest_order=HIGHEST_ORDER)
    found = [(branch, z) for branch in doubled(explorer) for z in at_value(branch, peak.torque)]
    reach = max((twist_swing(branch.problem, z)[1] for branch, z in found), default=np.nan)
    return float(reach / max(hinged(model, model.landmarks.springs[0]).stops))


@lru_cache(maxsize=2)
def cases(model: Model) -> dict[str, tuple[Case, ...]]:
    """All cases: k2 varied, k1 varied, and k2 varied at light damping, by rising difference."""
    pairs = {"k2": [(SOFT, k) for k in STIFFER], "k1": [(k, STIFF) for k in reversed(SOFTER)]}
    found: dict[tuple[float, float], Case] = {}
    for first, second in chain(*pairs.values()):
        if (first, second) not in found:
            near = found[max(found)].peaks[SPRING].speed if found else None
            found[first, second] = case(stepped(model, first, second), first, second, near)
    told = {name: tuple(found[pair] for pair in chosen) for name, chosen in pairs.items()}
    light: list[Case] = []
    for second in LIGHTLY:
        near = light[-1].peaks[SPRING].speed if light else None
        light.append(case(stepped(model, SOFT, second, LIGHT), SOFT, second, near))
    return {**told, "light": tuple(light)}


def table(found: tuple[Case, ...]) -> tuple[Array, Array, Array]:
    """Differences (n,), amplitudes (n, 4) and mean torques (n, 4) of a sweep."""
    peaks = np.array([[(peak.amplitude, peak.torque) for peak in one.peaks] for one in found])
    return np.array([one.difference for one in found]), peaks[..., 0], peaks[..., 1]
