"""An absorber alone as a unit: torques on its sides against formulas by hand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.exchange.compiled import needs_compiler
from tests.shipped import shipped

import torsional as tv
from torsional.absorbers import Absorber
from torsional.errors import ModelError
from torsional.laws import Hinges

fmpy = pytest.importorskip("fmpy")
MORE = [pytest.param(f"truck_{name}", marks=pytest.mark.full) for name in ("psva", "dmf_tva", "dmf_pendulum")]


def turned(motion: dict[str, float], time: np.ndarray) -> np.ndarray:
    """Inputs that go on with the accelerations, rates and angles at the time zero."""
    columns = {"time": time}
    for side in {name.rpartition(".")[0] for name in motion}:
        angle, rate, more = (motion.get(f"{side}.{name}", 0.0) for name in ("angle", "speed", "acceleration"))
        columns[f"{side}.angle"] = angle + rate * time + 0.5 * more * time**2
        columns[f"{side}.speed"], columns[f"{side}.acceleration"] = rate + more * time, np.full_like(time, more)
    rows = np.zeros(time.size, dtype=[(name, float) for name in columns])
    for name, values in columns.items():
        rows[name] = values
    return rows


def torques(absorber: Absorber, folder: Path, motion: dict[str, float], time: float = 1e-3) -> Any:
    """The unit's outputs at every step while its sides go on with a motion."""
    path = folder / "absorber.fmu"
    if not path.exists():
        tv.export_fmu(absorber, path)
    signals = turned(motion, np.linspace(0.0, time, round(time / 1e-4) + 1))
    return fmpy.simulate_fmu(str(path), stop_time=time, step_size=1e-4, output_interval=1e-4, input=signals)


@needs_compiler
def test_springs_and_damper_of_a_dual_mass_flywheel(tmp_path: Path) -> None:
    law = Hinges.staged([(1000.0, 8e3), (3500.0, 24e3)])
    absorber = tv.dual_mass_flywheel(1.2, 1.0, law, damping=20.0)
    found = torques(absorber, tmp_path, {"primary.angle": 0.15, "primary.speed": 3.0, "secondary.speed": 1.0})
    twist = 0.15 + 2.0 * found["time"]
    expected = 1000.0 + 24e3 * (twist - 0.125) + 20.0 * 2.0
    np.testing.assert_allclose(found["secondary.torque"], expected, rtol=1e-12)
    np.testing.assert_allclose(found["primary.torque"], -expected, rtol=1e-12)


@needs_compiler
def test_inertia_that_both_sides_turn_answers_to_their_accelerations(tmp_path: Path) -> None:
    g, inertia = 2.5, 0.02
    absorber = tv.planetary_dual_mass_flywheel(1.2, 1.0, inertia, Hinges(1e4), planet_ratio=g)
    first, last = 300.0, -100.0
    motion = {f"{side}.acceleration": a for side, a in zip(absorber_sides(absorber), (first, last), strict=True)}
    found = torques(absorber, tmp_path, motion, 1e-4)[-1]
    spun = inertia * ((1 - g) * first + g * last)
    twist = 0.5 * (first - last) * 1e-8
    assert found[f"{absorber.input}.torque"] == pytest.approx(-(1 - g) * spun - 1e4 * twist, rel=1e-9)
    assert found[f"{absorber.output}.torque"] == pytest.approx(-g * spun + 1e4 * twist, rel=1e-9)


def absorber_sides(absorber: Absorber) -> tuple[str, str]:
    return absorber.input, absorber.output


@needs_compiler
@pytest.mark.parametrize("name", ["truck_dmf_straight_spring", *MORE])
def test_sides_that_turn_together_are_hardly_loaded(tmp_path: Path, name: str) -> None:
    absorber = shipped(name).absorber
    assert absorber is not None
    sides = absorber_sides(absorber)
    found = torques(absorber, tmp_path, {f"{side}.speed": 100.0 for side in sides}, 2e-3)
    loads = [np.abs(found[f"{side}.torque"]).max() for side in sides]
    assert max(loads) < 20.0  # shoes that move outwards; nothing else
    twisted = torques(absorber, tmp_path, {f"{sides[0]}.angle": 0.1}, 2e-3)
    assert twisted[f"{sides[1]}.torque"][-1] > 300.0


def test_flywheels_stay_outside_and_are_told(tmp_path: Path) -> None:
    absorber = shipped("truck_dmf_two_stage").absorber
    assert absorber is not None
    tv.export_fmu(absorber, tmp_path / "a.fmu", compiled=False)
    described = fmpy.read_model_description(str(tmp_path / "a.fmu"))
    assert described.description.endswith("without primary of 1.2 kg.m2, secondary of 1 kg.m2")
    assert {v.name for v in described.modelVariables if v.causality == "parameter"} == {
        "dmf.stiffness_factor",
        "dmf.damping",
        "step",
    }


def test_a_single_flywheel_is_no_absorber_with_two_sides(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="both sides of the absorber are one node"):
        tv.export_fmu(tv.single_mass_flywheel(1.9), tmp_path / "a.fmu")
