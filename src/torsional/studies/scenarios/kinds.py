"""From a scenario to its plan."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from torsional.files.scenario import adapted
from torsional.files.scenario_blocks import Scenario
from torsional.model import Model
from torsional.studies.scenarios import driving, shifting, starting
from torsional.studies.scenarios.plan import Plan

PLANNERS: dict[str, Callable[[Any, Model], Plan]] = {
    "engine_start": starting.engine_start,
    "engine_stop": starting.engine_stop,
    "tip_in": driving.tip,
    "tip_out": driving.tip,
    "clutch_engagement": driving.clutch_engagement,
    "gear_shift": shifting.gear_shift,
    "stall": driving.stall,
    "traction_loss": driving.traction_loss,
    "idle_pulse": starting.idle_pulse,
}


def planned(scenario: Scenario, model: Model) -> Plan:
    """The plan of a scenario for a model, the values that the scenario overrides changed in it.

    Raises ModelError, by key path, for gears, nodes and torques that the model does not have.
    """
    return PLANNERS[scenario.scenario](scenario, adapted(model, scenario))
