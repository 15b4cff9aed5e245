from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from torsional.engine import ChenFlynn, CrankLayout, Engine, Excitation, FullLoad
from torsional.engine.orders import crank_angle_grid
from torsional.errors import ModelError
from torsional.units import RPM

ORDERS = np.arange(0.0, 12.5, 0.5)
CROSS_PLANE = (1, 5, 4, 8, 6, 3, 7, 2)


def with_layout(truck: Engine, layout: CrankLayout) -> Engine:
    return dataclasses.replace(truck, layout=layout, full_load=None)


def test_mean_torque_is_the_wanted_one_over_the_whole_map(truck: Engine) -> None:
    speed, torque = truck.torque_grid(RPM * np.linspace(600, 1990, 23), np.linspace(0.02, 1, 17))
    mean = truck.harmonics(speed, torque, [0]).sum(axis=-2)[..., 0]
    assert np.abs(mean - torque).max() < 1e-10 * 2500


def test_time_domain_mean_is_the_wanted_one(truck: Engine) -> None:
    sample = truck.torque([60.0, 150.0], [100.0, 1500.0], crank_angle_grid())
    assert sample.shape == (2, 6, 1440)
    assert sample.sum(axis=1).mean(axis=-1) == pytest.approx([100.0, 1500.0], rel=1e-10)


@pytest.mark.parametrize("cylinders", range(1, 17))
def test_even_firing_leaves_only_the_firing_orders(truck: Engine, cylinders: int) -> None:
    engine = with_layout(truck, CrankLayout.inline(range(1, cylinders + 1)))
    total = engine.harmonics(110.0, 300.0 * cylinders, ORDERS).sum(axis=0)
    other = ORDERS % (cylinders / 2) != 0
    assert np.abs(total[other]).max(initial=0.0) < 1e-12 * 300 * cylinders + 1e-10
    assert np.abs(total[~other]).min() > 1.0


def test_brute_force_fourier_of_the_waveform(truck: Engine) -> None:
    """Each coefficient by its integral, from the waveform at other angles than those of the solver's samples."""
    angle = 4 * np.pi * (np.arange(11520) + 0.3) / 11520
    wave = truck.torque(140.0, 1700.0, angle)
    kernel = np.exp(-1j * np.multiply.outer(ORDERS, angle))
    expected = wave @ kernel.T * (2 / angle.size)
    expected[:, 0] /= 2
    found = truck.harmonics(140.0, 1700.0, ORDERS)
    assert np.abs(found - expected).max() < 2e-4 * np.abs(found).max()


def test_synthesis_and_parseval(truck: Engine) -> None:
    orders = np.arange(0, 180.5, 0.5)
    wave = truck.torque(140.0, 1700.0, crank_angle_grid())
    excitation = truck.excitation([f"throw {i}" for i in range(6)], 140.0, 1700.0, orders)
    assert np.abs(excitation.waveform(crank_angle_grid()) - wave).max() < 2e-3 * np.abs(wave).max()
    power = np.abs(excitation.torque) ** 2 / 2
    power[:, 0] *= 2
    assert power.sum(axis=1) == pytest.approx((wave**2).mean(axis=1), rel=1e-7)


def test_a_cylinder_lags_by_its_firing_angle(truck: Engine) -> None:
    h, phi = truck.harmonics(100.0, 1000.0, ORDERS), truck.layout.firing_angles
    assert h == pytest.approx(h[0] * np.exp(-1j * np.multiply.outer(phi, ORDERS)), abs=1e-9)
    angle = np.linspace(0, 4 * np.pi, 50)
    wave = truck.torque(100.0, 1000.0, angle)
    assert wave[4] == pytest.approx(truck.torque(100.0, 1000.0, angle - phi[4])[0], abs=1e-8)
    assert np.degrees(angle[np.argmax(wave[0])]) < 60  # cylinder 1 pushes just after its firing


def test_reciprocating_torque_opposes_the_gas_at_speed(truck: Engine) -> None:
    """The third order falls with speed, the mass term growing with its square as in the classical series."""
    light = dataclasses.replace(truck, reciprocating_mass=0.0)
    mass = (truck.harmonics(150.0, 1000.0, [3]) - light.harmonics(150.0, 1000.0, [3])).sum()
    ratio = 0.079 / 0.2675
    b3 = -(3 * ratio / 4 + 9 * ratio**3 / 32 + 81 * ratio**5 / 512)
    assert mass == pytest.approx(-6j * b3 * 4.2 * 0.079**2 * 150**2, rel=1e-3)
    assert abs(truck.harmonics(150.0, 1000.0, [3]).sum()) < abs(light.harmonics(150.0, 1000.0, [3]).sum())


def test_third_order_at_full_load_is_that_of_a_heavy_diesel(truck: Engine) -> None:
    third = np.abs(truck.harmonics(RPM * np.array([900, 1200, 1300]), 2500.0, [3]).sum(axis=-2))[:, 0]
    assert (third > 1.2 * 2500).all()
    assert (third < 2.0 * 2500).all()


@pytest.mark.parametrize("valves", ["closed", "working"])
def test_three_of_six_cylinders_bring_the_order_one_and_a_half(truck: Engine, valves: str) -> None:
    half = dataclasses.replace(truck, deactivated=(1, 2, 3), deactivated_valves=valves)
    total = half.harmonics(100.0, 800.0, ORDERS).sum(axis=0)
    assert total[0].real == pytest.approx(800.0, rel=1e-12)
    assert abs(total[3]) > 800.0
    assert np.abs(total[ORDERS % 1.5 != 0]).max() < 1e-9
    assert abs(truck.harmonics(100.0, 800.0, [1.5]).sum()) < 1e-9


def test_closed_cylinder_is_a_gas_spring(truck: Engine) -> None:
    half = dataclasses.replace(truck, deactivated=(2,))
    top = half.pressure(100.0, 800.0, half.layout.firing_angles[1] + np.array([0.0, 2 * np.pi]))[1]
    assert top == pytest.approx([1e5 * 18.1**1.35] * 2, rel=1e-12)
    split = half.mean_torque_split(100.0, 800.0)
    assert split.gas[1] == pytest.approx(0.0, abs=1e-10)
    assert split.net.sum() == pytest.approx(800.0, rel=1e-12)


def test_spread_brings_half_orders_and_keeps_the_mean(truck: Engine) -> None:
    uneven = dataclasses.replace(truck, heat_spread=(1.0, 1.05, 1.0, 0.95, 1.0, 1.0))
    total = uneven.harmonics(100.0, [800.0, 2000.0], [0, 0.5, 3]).sum(axis=-2)
    assert total[:, 0].real == pytest.approx([800.0, 2000.0], rel=1e-12)
    assert np.abs(total[:, 1]).min() > 5.0
    peak = uneven.peak_pressure(100.0, 2000.0)
    assert peak[1] > peak[0] > peak[3]


def test_vee_eight_even_and_uneven(truck: Engine) -> None:
    even = with_layout(truck, CrankLayout.vee(CROSS_PLANE, np.radians(90)))
    total = even.harmonics(100.0, 2400.0, ORDERS)
    assert total.shape == (4, len(ORDERS))
    assert np.abs(total.sum(axis=0)[ORDERS % 4 != 0]).max() < 1e-9
    steps = np.radians([75, 105, 75, 90, 105, 75, 105, 90])
    uneven = with_layout(truck, CrankLayout.vee(CROSS_PLANE, np.radians(75), tuple(steps)))
    assert abs(uneven.harmonics(100.0, 2400.0, [1.5]).sum()) > 10.0
    assert uneven.harmonics(100.0, 2400.0, [0]).sum() == pytest.approx(2400.0)


def test_pin_offset_moves_the_first_order_of_the_masses(truck: Engine) -> None:
    offset = dataclasses.replace(truck, pin_offset=0.01)
    assert offset.harmonics(100.0, 900.0, [0]).sum() == pytest.approx(900.0)
    assert np.abs(offset.crank.reciprocating_harmonics(1.0, [1]).real).max() > 1e-5


def test_one_call_for_a_map_is_the_calls_for_its_points(truck: Engine) -> None:
    speed, torque = truck.torque_grid(RPM * np.array([700.0, 1500.0]), [0.1, 0.6, 1.0])
    whole = truck.harmonics(speed, torque, ORDERS)
    assert whole.shape == (2, 3, 6, len(ORDERS))
    for i, j in np.ndindex(2, 3):
        single = truck.harmonics(speed[i, 0], torque[i, j], ORDERS)
        assert np.abs(whole[i, j] - single).max() < 1e-10 * np.abs(single).max()


def test_peak_pressure_friction_is_solved_not_lagged(truck: Engine) -> None:
    stiff = dataclasses.replace(truck, friction=ChenFlynn(peak_pressure_factor=0.02))
    found = stiff.mean_torque_split(100.0, np.linspace(-100, 2500, 40))
    assert found.net.sum(axis=-1) == pytest.approx(np.linspace(-100, 2500, 40), abs=1e-9)


def test_overrun_ends_at_the_motored_torque(truck: Engine) -> None:
    least = truck.motored_torque([80.0, 160.0])
    assert (least < -50.0).all()
    assert truck.operated([80.0, 160.0], least).heat == pytest.approx([0, 0], abs=1e-6)
    with pytest.raises(ModelError, match="below that of the motored engine"):
        truck.harmonics(80.0, least[0] - 1.0, [3])


def test_full_load_and_grid(truck: Engine) -> None:
    assert truck.full_load_torque(RPM * np.array([600, 700, 1100, 1950])) == pytest.approx([1300, 1600, 2500, 800])
    with pytest.raises(ModelError, match="does not reach"):
        truck.full_load_torque(RPM * 2100)
    assert truck.within_full_load(RPM * 1000, [2500.0, 2501.0]).tolist() == [True, False]
    with pytest.raises(ModelError, match="no full-load curve"):
        dataclasses.replace(truck, full_load=None).full_load_torque(100.0)


def test_excitation_of_throws_or_of_one_node(truck: Engine) -> None:
    six = truck.excitation([f"t{i}" for i in range(1, 7)], [90.0, 100.0], 900.0, [1.5, 3])
    one = truck.excitation("crank", [90.0, 100.0], 900.0, [1.5, 3])
    assert six.torque.shape == (2, 6, 2)
    assert one.torque.shape == (2, 1, 2)
    assert six.lumped("crank").torque == pytest.approx(one.torque)
    assert six.at("t3") == pytest.approx(six.torque[:, 2])
    assert six.selected([3]).torque == pytest.approx(six.torque[..., 1:])


@pytest.mark.parametrize(
    ("change", "where"),
    [
        ({"bore": 0.0}, "bore"),
        ({"stroke": float("nan")}, "stroke"),
        ({"rod_length": 0.05}, "rod_length"),
        ({"reciprocating_mass": -1.0}, "reciprocating_mass"),
        ({"deactivated": (7,)}, "deactivated"),
        ({"deactivated": (1, 2, 3, 4, 5, 6)}, "deactivated"),
        ({"deactivated": (1,), "deactivated_valves": "open"}, "deactivated_valves"),
        ({"heat_spread": (1.0, 1.0)}, "heat_spread"),
        ({"heat_spread": (1.0, 1.0, 1.0, 1.0, 1.0, -1.0)}, "heat_spread.6"),
        ({"crankcase_pressure": -1.0}, "crankcase_pressure"),
    ],
)
def test_refused_engines(truck: Engine, change: dict, where: str) -> None:
    with pytest.raises(ModelError) as caught:
        dataclasses.replace(truck, **change)
    assert caught.value.where == where


@pytest.mark.parametrize(
    ("arguments", "where", "told"),
    [
        ((100.0, 500.0, [1.4]), "orders", "1.4"),
        ((100.0, 500.0, [0.499]), "orders", "0.499"),
        ((100.0, 500.0, [-0.5]), "orders", "multiples of 0.5"),
        ((100.0, 500.0, [3, 3]), "orders", "twice"),
        ((100.0, 500.0, []), "orders", "list of orders"),
        ((100.0, 500.0, [1000]), "orders", "1000"),
        ((1200.0, 500.0, [3]), "speed", "rpm times"),
        ((float("nan"), 500.0, [3]), "speed", "nan"),
        ((-10.0, 500.0, [3]), "speed", "-10"),
        ((100.0, float("inf"), [3]), "mean_torque", "finite"),
    ],
)
def test_refused_calls(truck: Engine, arguments: tuple, where: str, told: str) -> None:
    with pytest.raises(ModelError, match=told) as caught:
        truck.harmonics(*arguments)
    assert caught.value.where == where


@pytest.mark.parametrize(
    ("build", "where"),
    [
        (lambda: FullLoad((1.0,), (1.0,)), "full_load"),
        (lambda: FullLoad((1.0, 1.0), (1.0, 2.0)), "full_load"),
        (lambda: FullLoad((1.0, 2.0), (1.0, -2.0)), "full_load"),
        (lambda: ChenFlynn(constant=-1.0), "constant"),
        (lambda: Excitation(("a", "a"), [3.0], 1.0, np.ones((2, 1))), "nodes"),
        (lambda: Excitation(("a",), [3.0], 1.0, np.ones((2, 1))), "torque"),
        (lambda: Excitation(("a",), [3.0], 1.0, np.full((1, 1), np.nan)), "torque"),
        (lambda: Excitation.unit("crank", [3.0], 1.0).at("crnk"), "crnk"),
        (lambda: Excitation.unit("crank", [3.0], 1.0).selected([6]), "orders"),
    ],
)
def test_refused_values(build, where: str) -> None:
    with pytest.raises(ModelError) as caught:
        build()
    assert caught.value.where == where
