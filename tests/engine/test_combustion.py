from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from torsional.engine import CombustionCycle, Cylinder, Engine, LoadTable, SliderCrank, Wiebe
from torsional.engine.orders import crank_angle_grid
from torsional.errors import ModelError

CYLINDER = Cylinder(0.131, 18.1, SliderCrank(0.079, 0.2675, 0.002))
ALL = np.zeros(1)


def pressure(cycle: CombustionCycle, heat: float) -> np.ndarray:
    shapes = cycle.pressure_shapes(CYLINDER, ALL)
    unfired, fired = shapes.coefficients(np.array([10e5]))
    return ((unfired + heat * fired) @ shapes.shapes)[0, 0]


def test_wiebe() -> None:
    wiebe = Wiebe(start=-0.1, duration=1.2, shape=1.0)
    assert wiebe.burnt([-0.2, -0.1, 1.1, 0.5]) == pytest.approx([0, 0, 0.999, 1 - np.exp(-6.908 / 4)], abs=1e-6)


def test_motored_pressure_is_the_polytrope() -> None:
    cycle = CombustionCycle(boost=2e5)
    ratio = CYLINDER.volume(cycle.intake_closing) / CYLINDER.clearance
    assert pressure(cycle, 0.0)[0] == pytest.approx(2e5 * ratio**1.35, rel=1e-13)


def test_constant_volume_combustion() -> None:
    """A burn within a hundredth of a radian after dead centre: Δp = (κ − 1) Q/V_c, then the polytrope."""
    flash = Wiebe(start=0.0, duration=0.01, shape=1.0)
    cycle = CombustionCycle(boost=2e5, compression_exponent=1.3, main=flash, premixed_fraction=0.0)
    added = pressure(cycle, 5e3) - pressure(cycle, 0.0)
    late = 180  # 90° after firing
    fall = (CYLINDER.clearance / CYLINDER.volume(np.pi / 2)) ** 1.3
    assert added[late] == pytest.approx(0.999 * 0.3 * 5e3 / CYLINDER.clearance * fall, rel=2e-3)


def test_first_law_integrated_by_a_general_solver() -> None:
    """dp = (κ − 1)/V dQ − κ p/V dV, stepped from intake closing to exhaust opening."""
    cycle = CombustionCycle(boost=2e5, compression_exponent=1.3, premixed_fraction=0.2)
    heat, h = 7e3, 1e-6

    def rate(angle: float, p: np.ndarray) -> np.ndarray:
        burnt = [0.2 * cycle.premixed.burnt(angle + s) + 0.8 * cycle.main.burnt(angle + s) for s in (h, -h)]
        gained = 0.3 * heat * (burnt[0] - burnt[1]) / (2 * h)
        volume, slope = CYLINDER.volume(angle), CYLINDER.area * CYLINDER.crank.velocity_ratio(angle)
        return (gained - 1.3 * p * slope) / volume

    ends = cycle.intake_closing, cycle.exhaust_opening
    asked = np.radians([-60, 0, 5, 10, 20, 40, 80, 120])
    solved = solve_ivp(rate, ends, [2e5], t_eval=asked, rtol=1e-9, atol=1.0, max_step=0.005).y[0]
    found = pressure(cycle, heat)[np.round(np.degrees(asked) * 2).astype(int) % 1440]
    assert found == pytest.approx(solved, rel=3e-5)


def test_pressure_is_continuous_and_breathes() -> None:
    cycle = CombustionCycle()
    p = pressure(cycle, 8e3)
    steps = np.abs(np.diff(np.append(p, p[0])))
    assert steps.max() < 0.035 * p.max()
    degrees = np.degrees(crank_angle_grid())
    assert p[degrees == 300.0] == pytest.approx(1.8e5 + 0.2e5, rel=1e-2)  # exhaust stroke
    assert p[degrees == 500.0] == pytest.approx(1.8e5, rel=1e-12)  # intake stroke


@pytest.mark.parametrize("torque", [0.0, 800.0, 2500.0])
def test_work_of_the_cycle_is_the_mean_torque(truck: Engine, torque: float) -> None:
    """∮ p dV of six cylinders less friction is 4π times the brake torque; another quadrature than the solver's."""
    angle = np.radians(np.arange(0.0, 720.0 + 0.05, 0.05))
    p = truck.pressure(120.0, torque, angle)[0]
    work = 6 * np.trapezoid(p, truck.cylinder.volume(angle))
    split = truck.mean_torque_split(120.0, torque)
    assert work / (4 * np.pi) == pytest.approx(split.gas.sum(), rel=1e-5)
    assert split.net.sum() == pytest.approx(torque, abs=1e-10 * 2500)
    highest = p[::10].max()  # the largest of the half-degree samples
    friction = truck.friction.pressure(highest, truck.mean_piston_speed(120.0)) * truck.displacement / (4 * np.pi)
    assert split.friction.sum() == pytest.approx(friction, rel=1e-10)


def test_truck_at_full_load_has_a_heavy_diesels_pressures(truck: Engine) -> None:
    peak = truck.peak_pressure(1200 * np.pi / 30, 2500.0)
    assert (peak > 180e5).all()
    assert (peak < 220e5).all()
    heat = truck.operated(1200 * np.pi / 30, 2500.0).heat[0]
    assert 0.42 < 2500 * 4 * np.pi / 6 / heat < 0.55  # brake work over net heat


def test_double_wiebe_changes_the_rise_but_not_the_mean(truck: Engine) -> None:
    sharp = dataclasses.replace(truck, gas=CombustionCycle(premixed_fraction=LoadTable(((0.0, 0.6), (10e5, 0.0)))))
    high = np.array([6.0, 9.0, 12.0])
    assert (
        np.abs(sharp.harmonics(80.0, 200.0, high).sum(0)).sum()
        > np.abs(truck.harmonics(80.0, 200.0, high).sum(0)).sum()
    )
    assert sharp.harmonics(80.0, 200.0, [0]).sum() == pytest.approx(200.0)


@pytest.mark.parametrize(
    ("build", "where"),
    [
        (lambda: Wiebe(0.0, 0.0, 1.0), "duration"),
        (lambda: Wiebe(0.0, 1.0, -1.0), "shape"),
        (lambda: CombustionCycle(main=Wiebe(2.5, 1.0, 1.0)), "main.start"),
        (lambda: CombustionCycle(boost=2.0), "boost"),
        (lambda: CombustionCycle(premixed_fraction=1.5), "premixed_fraction"),
        (lambda: CombustionCycle(compression_exponent=0.9), "compression_exponent"),
        (lambda: CombustionCycle(exhaust_opening=float("inf")), "exhaust_opening"),
        (lambda: LoadTable(((0.0, 1.0), (0.0, 2.0))), "mean_effective_pressure"),
        (lambda: LoadTable(()), "mean_effective_pressure"),
        (lambda: Cylinder(-1.0, 18.0, CYLINDER.crank), "bore"),
        (lambda: Cylinder(0.1, 1.0, CYLINDER.crank), "compression_ratio"),
    ],
)
def test_refused(build, where: str) -> None:
    with pytest.raises(ModelError) as caught:
        build()
    assert caught.value.where == where
