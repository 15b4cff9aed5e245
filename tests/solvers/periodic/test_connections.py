"""Two and three connections with laws, thirty nodes: against a harmonic balance over all coordinates, and in time."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import xarray as xr
from tests.solvers.periodic.machines import (
    Machine,
    balanced,
    clutch_machine,
    dmf12,
    geared,
    law_harmonics,
    picked,
    respond,
    thirty_nodes,
    three_laws,
    worst_leftover,
)
from tests.validation import periodic_reference as reference

# machine, span, speeds looked at, whether laws are met in more than one stage there
MACHINES: dict[str, tuple[Machine, tuple[float, float], tuple[float, ...]]] = {
    "one law": (dmf12(), (62.0, 125.0), (70.0, 98.0)),
    "flywheel and clutch": (clutch_machine(), (70.0, 150.0), (75.0, 130.0)),
    "flywheel and lash behind a gear": (geared(), (70.0, 160.0), (75.0, 125.0)),
    "three laws": (three_laws(), (77.0, 84.0), (77.5, 83.0)),
    "three laws without ground": (three_laws(grounded=False), (77.0, 84.0), (77.5, 83.0)),
    "thirty nodes": (thirty_nodes(), (75.0, 130.0), (76.0, 122.0)),
}


@cache
def answer(name: str) -> xr.Dataset:
    machine, span, at = MACHINES[name]
    return respond(machine, span, at=at, highest_order=18.0, depth=int(name == "one law"), stability=False)


def stages_met(machine: Machine, data: xr.Dataset, point: int) -> dict[str, int]:
    """How many stages of each law a point of a result swings across."""
    turns = np.exp(1j * np.outer(data.order.values, np.linspace(0, 4 * np.pi / data.order.values[1], 4001)))
    swing = {name: (data.twist.sel(element=name).values[point] @ turns).real for name in machine.laws}
    return {name: int(np.unique(np.searchsorted(machine.laws[name][2].edges, x)).size) for name, x in swing.items()}  # type: ignore[union-attr]


@pytest.mark.parametrize("name", MACHINES)
def test_every_law_is_at_work(name: str) -> None:
    """Each law changes its stage somewhere on the branches: otherwise nothing is tested here."""
    machine, data = MACHINES[name][0], answer(name)
    met = [stages_met(machine, data, point) for point in range(0, data.sizes["point"], 9)]
    assert all(max(point[law] for point in met) > 1 for law in machine.laws)


@pytest.mark.parametrize("name", MACHINES)
def test_newton_equations_are_met_at_every_point(name: str) -> None:
    """The judge integrates the laws kink by kink and puts their torques on all coordinates."""
    data = answer(name)
    assert worst_leftover(MACHINES[name][0], data, step=max(1, data.sizes["point"] // 60)) < 1e-7
    assert all(data.ended.values) and all(data.started.values)


@pytest.mark.parametrize("name", MACHINES)
def test_balance_over_all_coordinates(name: str) -> None:
    """Newton's method on every coordinate, started a little away."""
    machine, _, speeds = MACHINES[name]
    case, (_, kept), rng = machine.case(), machine.onto, np.random.default_rng(1)
    if not machine.grounded:
        pytest.skip("the judge's Newton method has no row for the reaction")
    for speed in speeds:
        data = picked(answer(name), speed)
        assert data.sizes["point"] > 0
        for point in range(data.sizes["point"]):
            step = data.base_order.values[int(data.branch[point])]
            q = data.angle.sel(node=list(machine.discs)).values[point][:, kept][:: round(step / data.order.values[1])]
            found = balanced(case, speed, q * (1 + 1e-5 * rng.normal(size=q.shape)), step / case.order)
            # sampled 8192 times a period, kinks leave 1e-7
            assert np.abs(found - q).max() <= 1e-6 * np.abs(q[1:]).max()


@pytest.mark.parametrize("name, speed", [("flywheel and clutch", 75.0), ("three laws", 100.0)])
def test_integration_in_time(name: str, speed: float) -> None:
    machine = MACHINES[name][0]
    data = respond(machine, (0.97 * speed, 1.03 * speed), at=[speed], highest_order=60.0, depth=0)
    data = picked(data, speed, "main")
    case, q = machine.case(), data.angle.sel(node=list(machine.discs)).values[0]
    steady = reference.time_steady(
        case, speed, reference.state_from_orders(data.order.values, q, speed), harmonics=len(q) - 1
    )
    assert np.abs(q - steady.angle).max() <= 1e-3 * np.abs(steady.angle[1:]).max()
    np.testing.assert_allclose(abs(data.multiplier.values[0, 0]), abs(steady.multipliers[0]), rtol=0.05)


def test_ground_takes_the_place_of_the_node_that_holds() -> None:
    """A vehicle of 60 kgm² on a soft road: what it stands on hardly matters to the line before it."""
    on, off = (picked(answer(name), 83.0, "main") for name in ("three laws", "three laws without ground"))
    for name in MACHINES["three laws"][0].laws:
        x, y = (data.twist.sel(element=name).values[0] for data in (on, off))
        assert np.abs(x - y).max() <= 0.02 * np.abs(x).max()


def test_the_node_that_holds_stands_still_in_the_mean() -> None:
    data = answer("three laws without ground")
    assert np.abs(data.angle.sel(node="vehicle", order=0.0).values).max() == 0.0
    # the mean torque of every part of the line is the engine's
    mean = data.torque.sel(order=0.0, element=["dmf", "clutch", "lash", "shaft", "drive"]).values.real
    np.testing.assert_allclose(mean, 100.0, rtol=1e-8)


def test_torques_of_a_line_are_those_of_its_laws_and_dampers() -> None:
    """Order by order: c times the rate beside the law's own torque."""
    machine, data = MACHINES["flywheel and clutch"][0], answer("flywheel and clutch")
    for point in range(0, data.sizes["point"], 25):
        for name, (_, _, law, c) in machine.laws.items():
            x = data.twist.sel(element=name).values[point]
            rate = 1j * data.order.values * float(data.speed[point]) * x
            expected = law_harmonics(law, x) + c * rate
            found = data.torque.sel(element=name).values[point]
            assert np.abs(found - expected).max() <= 1e-9 * np.abs(expected).max()
