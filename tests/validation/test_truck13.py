"""The shipped truck against an independent prototype: undamped modes, as third-order speeds 20 f [rpm].

The prototype was another program with its own assembly and eigenvalue solver; its figures are kept to the digits it
gave.  Eigenvalues are taken here by SciPy from the assembled matrices, so that no solver of the package stands between.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh
from tests.shipped import shipped

from torsional.files import changed
from torsional.model import Model
from torsional.solvers.operating import at_operating_point

SMF, DMF = (shipped(f"truck_{kind}") for kind in ("smf", "dmf"))


def modes(model: Model, gear: int) -> tuple[np.ndarray, list[str], np.ndarray]:
    """Third-order speeds [rpm], and by mode the element with most elastic energy and its share."""
    system, _ = at_operating_point(model, 1000.0, gear)
    squares, shapes = eigh(system.K, system.M)
    energy = system.connections.stiffness[:, None] * (system.connections.weights @ shapes) ** 2
    share = energy / energy.sum(axis=0)
    largest = share.argmax(axis=0)
    speeds = 20 * np.sqrt(np.abs(squares)) / (2 * np.pi)
    return speeds, [system.connections.names[i] for i in largest], share.max(axis=0)


@pytest.mark.parametrize(
    ("model", "gear", "speed", "element", "share"),
    [
        (SMF, 12, 654, "clutch", 0.58),
        (SMF, 10, 733, "clutch", None),
        (SMF, 8, 790, "clutch", None),
        (SMF, 4, 832, "clutch", None),
        (DMF, 12, 414, "dmf", 0.63),
        (DMF, 12, 769, "clutch", 0.61),
        (DMF, 8, 390, "dmf", None),
        (DMF, 8, 901, "clutch", None),
    ],
)
def test_modes_of_the_prototype(model: Model, gear: int, speed: float, element: str, share: float | None) -> None:
    speeds, elements, shares = modes(model, gear)
    nearest = int(np.abs(speeds - speed).argmin())
    assert round(speeds[nearest]) == pytest.approx(speed, abs=0.5)
    assert elements[nearest] == element
    assert share is None or round(shares[nearest], 2) == share


@pytest.mark.parametrize(("gear", "speed"), [(12, 1401), (8, 1849)])
def test_a_nearly_rigid_clutch_leaves_a_mode_in_range(gear: int, speed: float) -> None:
    speeds, _, _ = modes(changed(DMF, "clutch.stiffness=1000 kNm/rad"), gear)
    assert speeds[np.searchsorted(speeds, 600)] == pytest.approx(speed, abs=0.5)


def test_line_behind_the_flywheel_is_the_specified_one() -> None:
    line = DMF.powertrain(8)
    assert [line.speed_ratio(node) for node in ("wheels", "vehicle")] == pytest.approx(
        [1 / (2.70 * 2.85)] * 2, rel=1e-15
    )
    inertias = {name: line[name].inertia for name in ("clutch_disc", "gearbox_input", "gearbox_mesh", "axle", "wheels")}
    assert inertias == {"clutch_disc": 0.09, "gearbox_input": 0.12, "gearbox_mesh": 0.15, "axle": 0.3, "wheels": 70.0}
    assert line["vehicle"].mass * line["vehicle"].rolling_radius ** 2 == 10_000
    assert [DMF.powertrain(gear)["gearbox"].stiffness for gear in (1, 11, 12)] == [3.0e5, 3.0e5, 2.5e5]


def test_power_split_and_tuned_absorber_cancel_where_their_comments_say() -> None:
    psva = shipped("truck_psva").document["absorber"]
    j2, j3, g, r = 0.6, 0.010, psva["planet_ratio"], psva["gear_quotient"]
    assert 13e3 / (j2 * (1 - r) + j3 * g * (g - r)) == pytest.approx(282.3**2, rel=1e-3)
    tva = shipped("truck_dmf_tva").powertrain(12)
    frequency = np.sqrt(tva["tva_spring"].stiffness / tva["tva"].inertia) / (2 * np.pi)
    assert 20 * frequency == pytest.approx(650.0, rel=1e-14)


@pytest.mark.parametrize(("speed", "inertia", "order3"), [(900, 0.10, 811), (1200, 0.05, 1148)])
def test_switched_planets_cancel_at_two_speeds(speed: float, inertia: float, order3: float) -> None:
    """Without damping the secondary side stands still at ω² = k/(J3 g (g − 1)) with g = 2, shown by a dense solve."""
    system, _ = at_operating_point(shipped("truck_planetary_dmf"), 1000.0, 12)
    system = system.switched(speed * np.pi / 30)
    square = 13e3 / (inertia * 2)
    assert 20 * np.sqrt(square) / (2 * np.pi) == pytest.approx(order3, abs=1.0)
    force = system.T[system.node_index("throw3")]
    angles = system.T @ np.linalg.solve(system.K - square * system.M, force)
    assert abs(angles[system.node_index("secondary")]) < 1e-11 * abs(angles[system.node_index("primary")])
