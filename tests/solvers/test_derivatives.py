"""Exact derivatives of the order response, against finite differences of the response itself."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import torsional as tv
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.files.edit import changed
from torsional.model import Model
from torsional.solvers.derivatives import Slope, response_derivatives
from torsional.solvers.operating import at_operating_point
from torsional.studies.trucks import Trucks
from torsional.system import System

TRUCKS = Trucks.shipped()
SPEED = np.array([620.0, 900.0, 1730.0]) * tv.RPM
CASES = [
    ("dmf", "absorber.primary_inertia", 1.2),
    ("dmf", "absorber.stiffness", 13e3),
    ("dmf", "absorber.damping", 20.0),
    ("dmf", "clutch.stiffness", 25e3),
    ("dmf", "driveline.final_drive_ratio", 2.85),
    ("psva", "absorber.gear_quotient", 1 / 1.3),
    ("psva", "absorber.planet_ratio", 2.0),
    ("tva", "absorber.tva.tuned_to", 650 * tv.RPM),
    ("pendulum", "absorber.pendulum.mass", 4.0),
    ("pendulum", "absorber.pendulum.order", 3.0),
]


def linear(model: Model, changes: dict[str, Any]) -> System:
    return at_operating_point(changed(model, changes), 1500.0)[0]


@pytest.mark.parametrize(("concept", "path", "value"), CASES)
def test_derivatives_are_those_of_the_response(concept: str, path: str, value: float) -> None:
    """Small central differences by Richardson's rule; slopes are taken over a large step and exact all the same."""
    model = TRUCKS.models[concept]
    drive = model.running_engine.excitation(model.landmarks.throws, SPEED, np.full(3, 1500.0), [1.5, 3.0])
    wide = 1e-4 if "final_drive" in path else 0.1  # referred through a ratio, values go with its inverse squares
    ends = [linear(model, {path: value * (1 + d * wide)}) for d in (-1, 1)]
    found = response_derivatives(linear(model, {}), drive, {path: Slope.between(*ends, 2 * wide * value)})

    def difference(step: float) -> Any:
        sides = [response_derivatives(linear(model, {path: value * (1 + d * step)}), drive, {}) for d in (1, -1)]
        return (sides[0].angle - sides[1].angle).values / (2 * value * step)

    known = (4 * difference(1e-4) - difference(2e-4)) / 3
    error = np.abs(found.angle_derivative.values[0] - known).max() / np.abs(known).max()
    assert error < 1e-6


def test_many_parameters_at_once_are_each_alone() -> None:
    model = TRUCKS.dmf
    drive = model.running_engine.excitation(model.landmarks.throws, SPEED, np.full(3, 1500.0), [3.0])
    slopes = {
        path: Slope.between(*(linear(model, {path: value * (1 + d)}) for d in (-0.1, 0.1)), 0.2 * value)
        for concept, path, value in CASES[:4]
    }
    both = response_derivatives(linear(model, {}), drive, slopes)
    for path, slope in slopes.items():
        alone = response_derivatives(linear(model, {}), drive, {path: slope})
        np.testing.assert_array_equal(both.angle_derivative.sel(parameter=path), alone.angle_derivative[0])
    assert both.angle_derivative.dims == ("parameter", "speed", "order", "node")


def test_what_has_no_derivative_is_refused() -> None:
    system = linear(TRUCKS.planetary, {})
    with pytest.raises(ModelError, match="switches over speed"):
        response_derivatives(system, Excitation.unit("primary", [3.0], SPEED), {"x": Slope.between(system, system, 1)})
    with pytest.raises(ModelError, match="differ in more than a value"):
        Slope.between(system, linear(TRUCKS.smf, {}), 1.0)
