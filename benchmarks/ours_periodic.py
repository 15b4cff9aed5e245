"""This project at DMF12's periodic motions, by its public call."""

from __future__ import annotations

from collections.abc import Callable

import dmf12
import numpy as np
from ledger import Floor

SPAN = dmf12.SLOWEST * dmf12.RPM, dmf12.FASTEST * dmf12.RPM
HIGHEST = dmf12.BASE * dmf12.HARMONICS
NODES = tuple(f"disc_{number}" for number in range(dmf12.INERTIA.size))
SPRINGS = "flywheel_springs"


def system():
    """DMF12 as a user writes it."""
    from torsional import Coupling, Inertia, Powertrain, Shaft, assemble
    from torsional.laws import Hinges

    first, second = float(dmf12.STIFFNESS[dmf12.PRIMARY]), dmf12.SECOND_STAGE
    law = Hinges(first, (dmf12.GAP, -dmf12.GAP), (1.0, -1.0), (second - first, second - first))
    parts = {name: Inertia(float(J)) for name, J in zip(NODES, dmf12.INERTIA, strict=True)}
    for i, (k, c) in enumerate(zip(dmf12.STIFFNESS.tolist(), dmf12.DAMPING.tolist(), strict=True)):
        ends = NODES[i], NODES[i + 1]
        if i == dmf12.PRIMARY:
            parts[SPRINGS] = Coupling(*ends, law, damping=c)
        else:
            parts[f"shaft_{i}"] = Shaft(*ends, k, c)
    parts["mount"] = Shaft("ground", NODES[-1], dmf12.GROUND_STIFFNESS)
    return assemble(Powertrain(parts))


def excitation(mean: float = dmf12.MEAN):
    """Mean torque and third order, shared by the throws."""
    from torsional import Excitation

    torque = np.tile([mean, dmf12.THIRD], (len(dmf12.THROWS), 1)) / len(dmf12.THROWS)
    return Excitation([NODES[i] for i in dmf12.THROWS], [0, 3], 1.0, torque)


def branch(stability: bool) -> Callable[[], dict]:
    """The main branch with its bifurcations; Floquet multipliers at every point where ``stability``."""
    from torsional.solvers.periodic import periodic_response

    line, load = system(), excitation()
    return lambda: told(periodic_response(line, load, SPAN, highest_order=HIGHEST, depth=0, stability=stability))


def bare_branch() -> Callable[[], dict]:
    """The same without its dataset: speeds and bifurcations only."""
    from torsional.solvers.periodic.response import explored

    line, load = system(), excitation()

    def follow() -> dict:
        found = explored(line, load, SPAN, highest_order=HIGHEST, depth=0).explored()[0]
        return {
            "speed": found.values / dmf12.RPM,
            "doublings": [event.parameter / dmf12.RPM for event in found.events if event.event == "period doubling"],
        }

    return follow


def told(found) -> dict:
    """What the benchmark compares: speeds and doublings [rpm], order 3 at the first point, the multipliers."""
    doubled = found.bifurcation_type.values == "period doubling"
    return {
        "speed": found.speed.values / dmf12.RPM,
        "amplitude": float(abs(found.twist.sel(element=SPRINGS, order=3.0)[0])),
        "doublings": found.bifurcation_speed.values[doubled] / dmf12.RPM,
        "multipliers": found.multiplier.values if "multiplier" in found else None,
    }


def region(means: np.ndarray) -> Callable[[], list]:
    """Every branch over speed at each mean torque: where the doublings lie is the boundary of the 1.5-order region."""
    from torsional.solvers.periodic import periodic_response

    line, loads = system(), [excitation(mean) for mean in means.tolist()]
    return lambda: [periodic_response(line, load, SPAN, highest_order=HIGHEST, stability=False) for load in loads]


def floor(points: int) -> Floor:
    """Arithmetic of a branch of this form: two corrections a point, and the results written once.

    A correction: receptances, loads and their derivatives as sums over 24 poles at 5 harmonics, 16 operations a term;
    the wave at 64 angles, 4 harmonics of 8 each; coefficients of two stages, 20 each of 9; products and factors of a
    9 × 9 matrix.
    """
    m, poles, harmonics = 9, 24, 5
    correction = 2 * 2 * 16 * poles * harmonics + 64 * 4 * 8 + 2 * 9 * 20 + 2 * m**2 * harmonics + m**3 * 2 / 3
    return Floor(flops=2 * points * correction, bytes=16 * points * harmonics * (12 + 12 + 12))
