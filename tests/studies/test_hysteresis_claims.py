"""F3, F4: what arc springs lose, beside friction in closed form."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from torsional.components import Component, Coupling, Inertia, Shaft
from torsional.files.scenario import load_scenario
from torsional.laws import Jenkins
from torsional.model import Model
from torsional.powertrain import Powertrain
from torsional.solvers.hysteresis import hysteresis
from torsional.studies.answers import mean_torque
from torsional.studies.base import Outcome
from torsional.studies.claims import arc_losses
from torsional.studies.claims.arc_losses import PARTLY, WHOLLY, driven, looped, rubbed
from torsional.studies.claims.hysteresis import long_arcs, truck_loops
from torsional.studies.scenarios.kinds import planned
from torsional.studies.scenarios.running import run_plan
from torsional.studies.trucks import Trucks, hinged
from torsional.system import assemble
from torsional.units import RPM


def test_springs_that_slide_freely_need_the_friction_of_their_weight(trucks: Trucks) -> None:
    """Where a relaxed spring is pushed along its channel the torque is µ m R² Ω² of all springs, µ that of sliding or
    of breaking loose, more by what the curvature adds: less than a rope's e^µα."""
    speed = 4000 * RPM
    loop = truck_loops(trucks.arc_spring, np.array([speed]), np.radians([13.0])).isel(speed=0, sweep=0)
    block = trucks.arc_spring.document["absorber"]
    mass = block["channels"] * (0.49 + 0.17)
    assert (block["spring"]["mass"], block["inner_spring"]["mass"]) == ("0.49 kg", "0.17 kg")
    weight = mass * 0.150**2 * speed**2
    angle, torque = np.degrees(loop.drive_angle.values), loop.drive_torque.sel(cycle="closed").values
    pushed = (np.arange(angle.size) < angle.size // 4) & (angle > 1.0) & (angle < 4.0)
    assert 0.09 * weight < torque[pushed].min() and torque[pushed].max() < 0.11 * weight * np.exp(
        0.11 * np.radians(72.8)
    )


def test_long_arcs_at_standstill_are_springs_on_a_post() -> None:
    """An elastic rope round a post: the torque falls as e^−µα along it, so that k becomes k µα/(1 − e^−µα).

    Two springs of 8 kN/m at 115 mm, a degree from the tabs of the flange and half a degree from those of the channel;
    so slow that µ is that of breaking loose.
    """
    loop = hysteresis(long_arcs(), "primary", "secondary", 0.0, np.radians(10.0), rate=1e-6)
    rope = 0.11 * np.radians(164.0)
    rate = 2 * 8e3 * 0.115**2 * rope / (1 - np.exp(-rope))
    assert loop.stiffness.item() == pytest.approx(rate * (10.0 - 1.0 - 0.5) / 10.0, rel=2e-3)


def test_a_long_row_that_slides_in_part() -> None:
    """Its loss factor is near 4/(3π) whatever the sweep, which is what stands against F4."""
    count, stiffness = 41, 4e4
    parts: dict[str, Component] = {"primary": Inertia(1.0), "secondary": Inertia(1.0)}
    names = ["primary", *(f"shoe{i}" for i in range(1, count)), "secondary"]
    for name in names[1:-1]:
        parts |= {name: Inertia(1e-3), f"{name}_guide": Coupling("primary", name, Jenkins(1.0, 1e9))}
    parts |= {f"spring{i}": Shaft(names[i + 1], names[i], stiffness) for i in range(count)}
    loops = hysteresis(assemble(Powertrain(parts)), "primary", "secondary", 0.0, [0.003, 0.01])
    assert (loops.sliding.values[0] > 10).all() and (loops.sliding.values[0] < 30).all()
    assert loops.loss_factor.values[0] == pytest.approx([PARTLY, PARTLY], rel=0.1)


def test_rows_that_slide_as_a_whole_lose_by_their_arc_alone() -> None:
    """A wedge from k a/(e^a − 1) to k a/(1 − e^−a), a = µα: (1 − e^−a)/π, less what play and the way back take."""
    loop = hysteresis(long_arcs(), "primary", "secondary", 0.0, np.radians(60.0), rate=1e-3)
    whole = (1 - np.exp(-0.11 * np.radians(164.0))) / np.pi
    assert 0.8 * whole < loop.loss_factor.item() < whole < WHOLLY


def test_friction_in_time_is_that_of_the_loop(trucks: Trucks) -> None:
    """Power of friction in driving beside the loop's at the same angle, which knows no inertia and one order."""
    motion = driven(trucks.arc_spring, 1400.0, 0.6)
    loop = looped(trucks.arc_spring, 1400.0, motion.swing, motion.middle)
    assert motion.power == pytest.approx(loop.power, rel=0.1)
    law = hinged(trucks.arc_spring, "dmf")
    assert float(law.torque(motion.middle)) == pytest.approx(mean_torque(trucks.arc_spring), rel=0.1)


def test_loss_rises_with_the_square_of_speed_at_large_sweeps(outcomes: Mapping[str, Outcome]) -> None:
    """What rotation adds to the loss at 4000 rpm is about four times that at 2000 rpm."""
    figures = outcomes["F3"].finding.figures
    losses = [value for name, value in figures.items() if "loss per cycle" in name]
    assert len(losses) == 2
    for loss in losses:
        assert isinstance(loss, tuple)
        low, middle, high = (float(value) for value in loss)
        assert (high - low) / (middle - low) == pytest.approx(4.0, rel=0.2)


def test_start_up_is_soft_and_loses_energy_but_not_over_what_is_stored(outcomes: Mapping[str, Outcome]) -> None:
    finding = outcomes["F4"].finding
    assert (
        not finding.reproduced and "softer" in finding.reason and "more energy from every vibration" in finding.reason
    )
    told = {name: np.array(value, dtype=float) for name, value in finding.figures.items()}
    assert told["start-up: loss per vibration [J]"].min() > 3 * told["driving: loss per vibration [J]"].max()
    for name in ("loss factor [-]", "viscous coefficient of the same loss [Nms/rad]"):
        assert told[f"start-up: {name}"].max() < told[f"driving: {name}"].min()
    for times in ("0.5", "2"):
        losses, factors = (
            told[f"friction times {times}, start-up and driving: {name}"]
            for name in ("loss per vibration [J]", "loss factor [-]")
        )
        assert losses[0] > losses[1] and factors[0] < factors[1]
    assert np.diff(told["the same: loss factor [-]"]) > 0
    assert (np.diff(told["driving at 1800 rpm, ±0.1, 0.01°: loss factor [-]"]) < 0).all()
    assert 0 < float(finding.figures["loss factor, lowest at start-up over highest in driving [-]"]) < 1  # type: ignore[arg-type]


def test_loops_and_runs_are_fine_enough(trucks: Trucks, monkeypatch: pytest.MonkeyPatch) -> None:
    """Four times the samples, half the step and longer runs tell the same within what the module says."""
    coarse = looped(trucks.arc_spring, 200.0, np.radians(10.0))
    motion = driven(trucks.arc_spring, 1400.0, 0.6)
    monkeypatch.setattr(arc_losses, "SAMPLES", 4 * arc_losses.SAMPLES)
    monkeypatch.setattr(arc_losses, "STEP", 0.5 * arc_losses.STEP)
    monkeypatch.setattr(arc_losses, "LASTING", 1.0)
    fine, longer = looped(trucks.arc_spring, 200.0, np.radians(10.0)), driven(trucks.arc_spring, 1400.0, 0.6)
    assert coarse.loss == pytest.approx(fine.loss, rel=0.01) and coarse.loss != fine.loss
    assert motion.swing == pytest.approx(longer.swing, rel=3e-3)
    assert motion.power == pytest.approx(longer.power, rel=5e-3)


def test_friction_takes_little_from_an_engine_start(trucks: Trucks) -> None:
    """A hundred times the friction takes a fifth of the torque that is passed on."""
    torque = [_passed_on(rubbed(trucks.arc_spring, times)) for times in (0.02, 2.0)]
    assert 0.8 * torque[0] > 0.8 * torque[1] > 0.6 * torque[0]


def _passed_on(model: Model) -> float:
    """The largest torque [Nm] of the clutch in an engine start in neutral."""
    run = run_plan(planned(load_scenario("engine_start", ["duration=1.5 s", "firing_from=0.65 s"]), model))
    return float(np.abs(run.torque.sel(element=model.landmarks.clutch).values).max())
