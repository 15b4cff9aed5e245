"""Interference analysis against published frequencies, closed forms and an independent prototype."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from tests.shipped import shipped

from torsional.absorbers import CentrifugalPendulum
from torsional.components import Inertia, Shaft
from torsional.engine import CrankLayout
from torsional.errors import ModelError
from torsional.model import Landmarks, Model
from torsional.powertrain import Powertrain
from torsional.solvers.campbell import _met, campbell
from torsional.solvers.map import response_map
from torsional.solvers.run_up import full_load_response
from torsional.system import assemble
from torsional.units import RPM


def example(name: str) -> Model:
    return shipped(name)


def test_published_crankshaft() -> None:
    """Mendes, Meirelles, Zampieri (2008): 216.5836, 592.7405 and 984.9230 Hz."""
    found = campbell(example("mwm_engine"), orders=[1.5, 3.0])
    published = np.array([216.5836, 592.7405, 984.9230])
    assert found.frequency.isel(gear=0, speed=0).values[1:4] == pytest.approx(published, rel=2e-6)
    met = found.crossing.isel(gear=0).sel(order=1.5).values[1:4]
    assert met / RPM == pytest.approx(60 * published / 1.5, rel=2e-6)


@pytest.mark.parametrize(
    ("name", "gear", "speeds"),
    [
        ("truck_dmf", "12", (414, 769)),
        ("truck_dmf", "8", (390, 901)),
        ("truck_smf", "12", (654,)),
        ("truck_smf", "10", (733,)),
        ("truck_smf", "8", (790,)),
        ("truck_smf", "4", (832,)),
    ],
)
def test_third_order_speeds_of_the_truck(name: str, gear: str, speeds: tuple[int, ...]) -> None:
    """Rounded speeds of an independent prototype of the same trucks, undamped."""
    found = campbell(example(name), gears=[gear]).crossing.sel(gear=gear, order=3.0).values / RPM
    in_question = found[(found > 300) & (found < 1000)]
    assert in_question == pytest.approx(speeds, abs=0.6)


def test_pendulum_meets_the_order_where_it_acts_as_a_fixed_inertia() -> None:
    """At order N the pendulum of order n is the inertia I n²/(n² − N²) on its carrier, at every speed."""
    inertia, n, order, k = 3.0 * 0.12**2, 3.4, 3.0, 2.0e4
    parts = {"a": Inertia(1.5), "b": Inertia(0.9), "s": Shaft("a", "b", k)}
    model = Model("pair", parts | {"p": CentrifugalPendulum("b", 3.0, 0.12, n)}, Landmarks())
    found = campbell(model, orders=[order], speeds=np.linspace(5.0, 200.0, 60))
    carried = 0.9 + inertia * n**2 / (n**2 - order**2)
    expected = np.sqrt(k * (1 / 1.5 + 1 / carried)) / order
    met = found.crossing.values[np.isfinite(found.crossing.values)]
    assert met == pytest.approx([expected], rel=1e-9)


def test_modes_of_a_pendulum_alone_rise_with_speed() -> None:
    """A free disc J with a pendulum I of order n: ω = n Ω √(1 + I/J)."""
    inertia = 2.0 * 0.1**2
    model = Model("p", {"disc": Inertia(0.5), "p": CentrifugalPendulum("disc", 2.0, 0.1, 3.0)}, Landmarks())
    found = campbell(model, orders=[3.0], speeds=[50.0, 100.0])
    expected = 3.0 * found.speed.values * np.sqrt(1 + inertia / 0.5) / (2 * np.pi)
    assert found.frequency.isel(gear=0, mode=1).values == pytest.approx(expected, rel=1e-12)
    assert not np.isfinite(found.crossing.values).any()


def test_an_order_that_is_not_met_where_it_seems_to_be_is_told() -> None:
    """Frequencies that are not those of the line: nothing is made up between them."""
    parts = {"disc": Inertia(1.0), "spring": Shaft("ground", "disc", 100.0)}
    line, speeds = assemble(Powertrain(parts)), np.array([20.0, 30.0])
    assert _met(line, np.array([5.0, 30.0]), np.full(2, 10.0), 0, 0.5) == pytest.approx(20.0)
    with pytest.raises(ModelError, match="the speed at which an order meets a mode was not found"):
        _met(line, speeds, np.full(2, 25.0), 0, 1.0)


def test_shares_add_up_and_gears_are_kept_apart() -> None:
    found = campbell(example("truck_dmf"), gears=[8, 12], speeds=[100.0])
    assert found.gear.values.tolist() == ["8", "12"]
    assert found.elastic_share.sum("element").values[:, 0, 1:] == pytest.approx(1.0)
    assert float(found.attrs["mean_torque"]) == 2500.0


@pytest.mark.parametrize(
    ("layout", "main"),
    [
        (CrankLayout.inline((1, 3, 4, 2)), 2.0),
        (CrankLayout.inline((1, 5, 3, 6, 2, 4)), 3.0),
        (CrankLayout.inline((1, 2, 4, 5, 3)), 2.5),
    ],
)
def test_main_order_is_half_the_number_of_evenly_fired_cylinders(layout: CrankLayout, main: float) -> None:
    truck = example("truck_dmf")
    assert truck.engine is not None
    engine = dataclasses.replace(truck.engine, layout=layout)
    assert truck.replaced(engine=engine).engine_orders()[0] == main


def test_three_of_six_cylinders_halve_the_main_order() -> None:
    truck = example("truck_dmf")
    assert truck.engine is not None
    engine = dataclasses.replace(truck.engine, deactivated=(2, 3, 1), full_load=None)
    operation = dataclasses.replace(truck.operation, torque=(0.0, 800.0))
    half = truck.replaced(engine=engine, operation=operation)
    assert half.typical_torque() == 800.0
    assert half.engine_orders()[0] == 1.5


def test_a_model_without_an_engine_has_no_orders() -> None:
    found = campbell(example("mwm_engine"))
    assert example("mwm_engine").engine_orders() == ()
    assert found.crossing.shape == (1, 9, 0)


def test_an_unknown_gear_is_named() -> None:
    with pytest.raises(ModelError, match="no gear '13'"):
        campbell(example("truck_dmf"), gears=[13])


def test_full_load_response_is_the_diagonal_of_the_map() -> None:
    """A second way: a map with one mean torque for each speed, of which the pairs that belong together are taken."""
    model = example("truck_dmf_two_stage")
    speeds = np.array([650.0, 900.0, 1450.0, 1980.0]) * RPM
    along = full_load_response(model, speeds, gears=["9"], orders=[1.5, 3.0])
    torque = along.mean_torque.values
    grid = response_map(model, speeds, torque, ["9"], [1.5, 3.0])
    for i in range(speeds.size):
        expected = grid.angle.isel(gear=0, mean_torque=i, speed=i).values
        assert np.abs(along.angle.isel(gear=0, speed=i).values - expected).max() < 1e-12 * np.abs(expected).max()


def test_twists_at_full_load() -> None:
    """The mean twist of one linear stage is T/k; the absorber's twist times its stiffness and damping is its torque."""
    model = example("truck_dmf")
    speeds = np.array([900.0, 1200.0]) * RPM
    found = full_load_response(model, speeds, gears=["12"], orders=[3.0])
    assert found.mean_twist.sel(element="dmf").values == pytest.approx(np.full((1, 2), 2500 / 13e3))
    torque = response_map(model, speeds, [2500.0], ["12"], [3.0]).torque.sel(element="dmf").values[0, 0, :, 0]
    twist = found.twist.sel(element="dmf").values[0, :, 0]
    assert np.abs((13e3 + 1j * 3.0 * speeds * 20.0) * twist - torque).max() < 1e-9 * np.abs(torque).max()
