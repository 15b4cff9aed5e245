"""How far a truck can be down-speeded until its gearbox input shakes more than a limit or its springs meet a stop."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
from scipy.optimize import brentq

from torsional.studies.down_speeding import Worst, moved, worst
from torsional.studies.matching import HELD, Concept, Match, matched
from torsional.units import RPM

CLOSE = 2.0 * RPM
"""To how much the attainable down-speeding is found [rad/s]."""
NEAR = 30 * RPM
"""Between down-speedings so close a search starts from the other's designs [rad/s]."""


SLACK = 1.005
"""Twist over the way to the stop up to which springs count as free: a search ends this close."""


def attained(look: Callable[[float], Worst], limit: float, cap: float) -> float:
    """The largest down-speeding [rad/s], up to ``cap``, at which a truck keeps a ``limit`` [rad/s²] and its springs
    keep off their stops; not a number where it does not even in its own range.

    ``look`` gives the worst at a down-speeding; between none and the attainable one it is taken to rise.
    """

    def beyond(by: float) -> float:
        found = look(by)
        cost = found.acceleration + HELD * max(found.reach - SLACK, 0.0)
        return float(np.log(cost / limit)) - 1e-12  # the truck whose own worst is the limit keeps it

    if beyond(0.0) > 0:
        return float("nan")
    if beyond(cap) <= 0:
        return cap
    return float(brentq(beyond, 0.0, cap, xtol=CLOSE, rtol=1e-6))


def as_it_is(concept: Concept, cruise: float = 0.0) -> Callable[[float], Worst]:
    """The worst over down-speeding of a concept whose absorber and clutch stay what they are."""
    return cache(lambda by: worst(moved(concept.model, by, cruise)))


def rematched(concept: Concept, cruise: float = 0.0) -> Callable[[float], Worst]:
    """The worst over down-speeding of a concept matched anew for each; searches start from one near by, if any."""
    known: dict[float, Match] = {}

    def look(by: float) -> Worst:
        nearest = min(known, key=lambda other: abs(other - by), default=np.inf)
        known[by] = matched(concept, by, cruise, known[nearest] if abs(nearest - by) < NEAR else None)
        return worst(known[by].model)

    return cache(look)
