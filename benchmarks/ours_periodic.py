"""This project at periodic motions: DMF12 as a user writes it, and the shipped truck with a two-stage flywheel.

A line is assembled for every round beforehand, so that no round gains from what another has remembered.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import cycle
from pathlib import Path

import dmf12
import numpy as np
from ledger import Floor

SPAN = dmf12.SLOWEST * dmf12.RPM, dmf12.FASTEST * dmf12.RPM
HIGHEST = dmf12.BASE * dmf12.HARMONICS
NODES = tuple(f"disc_{number}" for number in range(dmf12.INERTIA.size))
SPRINGS = "flywheel_springs"
ROUNDS = 61

TRUCK = Path(__file__).parents[1] / "examples" / "truck_dmf_two_stage.yaml"
SPEEDS, TORQUES = np.linspace(500.0, 1300.0, 100) * dmf12.RPM, np.linspace(500.0, 2500.0, 100)


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


def excitation():
    """Mean torque and third order, shared by the throws."""
    from torsional import Excitation

    torque = np.tile([dmf12.MEAN, dmf12.THIRD], (len(dmf12.THROWS), 1)) / len(dmf12.THROWS)
    return Excitation([NODES[i] for i in dmf12.THROWS], [0, 3], 1.0, torque)


def _afresh(follow) -> Callable[[], object]:
    """``follow`` of an assembled line and its load, of another copy in each round."""
    pairs = cycle([(system(), excitation()) for _ in range(ROUNDS + 2)])
    return lambda: follow(*next(pairs))


def response(stability: bool) -> Callable[[], object]:
    """The public call with its dataset; Floquet multipliers at every point where ``stability``."""
    from torsional.solvers.periodic import periodic_response

    return _afresh(
        lambda line, load: periodic_response(line, load, SPAN, highest_order=HIGHEST, depth=0, stability=stability)
    )


def branch(stability: bool) -> Callable[[], object]:
    """From the assembled line to the branch with its bifurcations located, without a dataset."""
    from torsional.solvers.periodic.response import Exploration, explorer_of

    asked = Exploration(highest_order=HIGHEST, depth=0, stability=stability)

    return _afresh(lambda line, load: explorer_of(line, load, SPAN, asked).explored()[0])


def told_of_response(found) -> dict:
    """What the benchmark compares: speeds and doublings [rpm], order 3 at the first point, the multipliers."""
    doubled = found.bifurcation_type.values == "period doubling"
    return {
        "speed": found.speed.values / dmf12.RPM,
        "amplitude": float(abs(found.twist.sel(element=SPRINGS, order=3.0)[0])),
        "doublings": found.bifurcation_speed.values[doubled] / dmf12.RPM,
        "multipliers": found.multiplier.values if "multiplier" in found else None,
    }


def told_of_branch(found) -> dict:
    """The same of a branch."""
    doublings = [event.parameter / dmf12.RPM for event in found.events if event.event == "period doubling"]
    return {
        "speed": found.values / dmf12.RPM,
        "amplitude": float(abs(found.problem.harmonics_of(found.scaled)[0, 0, 1])),
        "doublings": doublings,
        "multipliers": found.verdict.multipliers,
    }


def region() -> Callable[[], object]:
    """The map of the shipped truck: every branch at 100 mean torques read at 100 speeds, and the boundary curve."""
    from torsional.files import load_model
    from torsional.solvers.periodic import subharmonic_map

    model = load_model(TRUCK)
    return lambda: subharmonic_map(model, SPEEDS, TORQUES)


# --- counted arithmetic ---

NODES_COUNT, POLES, HARMONICS = dmf12.INERTIA.size, 2 * dmf12.INERTIA.size, 4  # harmonics of order 3 up to 13.5
UNKNOWNS, ODD, CROSSINGS = 2 * HARMONICS + 1, 5, 2


def _correction() -> float:
    """One Newton step, additions and multiplications of the formulas.

    Poles: 1/(iω − λ) 7, residue over it and over its square 16, the same with the load of one harmonic 22.  The motion
    at 64 angles; each crossing polished twice at 13 a harmonic; spectra of the engaged arcs, 14 an index and crossing.
    Force and Jacobian G dF: 4 and 6 a complex entry, 4 for the force.  Factors and solution of the bordered matrix.
    """
    poles = POLES * (23 * HARMONICS + 22)
    crossings = 64 * (2 * UNKNOWNS - 1) + CROSSINGS * (2 * 13 * HARMONICS + 14 * UNKNOWNS)
    entries = (HARMONICS + 1) * UNKNOWNS
    n = UNKNOWNS + 1
    return poles + crossings + 14 * entries + 2 / 3 * n**3 + 2 * n**2


def _doubling() -> float:
    """The determinant of the odd half orders: receptances 15 a pole, entries 20 a complex pair, factors."""
    return POLES * 15 * ODD + 20 * ODD**2 + 2 / 3 * (2 * ODD) ** 3


def floor(points: int) -> Floor:
    """A branch: the poles once, at each point two Newton steps, the tangent and the test, its harmonics written.

    Eigenvectors of a matrix take 25 n³, the undamped modes before them 20 n³ (Golub and Van Loan).
    """
    poles = 25 * POLES**3 + 20 * NODES_COUNT**3
    each = 2 * _correction() + 2 * (UNKNOWNS + 1) ** 2 + _doubling()
    return Floor(flops=poles + points * each, bytes=16 * points * (HARMONICS + 1) * 3 * NODES_COUNT)


def floor_with_multipliers(points: int) -> Floor:
    """One point of it: two segments, so a turn of 24 rows and a product of 24 × 24 twice, and 10 n³ for eigenvalues."""
    branch = floor(points)
    product = 2 * (2 * POLES**3 + 3 * POLES**2) + 10 * POLES**3
    return Floor(branch.flops / points + product, branch.bytes / points + 16 * POLES)
