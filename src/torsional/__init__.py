"""Torsional vibrations of vehicle powertrains and the absorbers that tame them.

Names are imported when they are first used, so that ``import torsional`` costs next to nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_HOMES = {
    "absorbers": "ArcSprings CentrifugalPendulum CoilSpring GuideFriction Rollers StraightSprings arc_spring_flywheel "
    "cancellation_frequency characteristic condensed dual_mass_flywheel planetary_dual_mass_flywheel "
    "power_split_absorber single_mass_flywheel straight_spring_flywheel tuned_flange_flywheel tuned_secondary_flywheel "
    "with_friction with_pendulum",
    "components.slip_clutch": "SlipClutch",
    "components": "Coupling Damper DistributedShaft GearPair Inertia PlanetSpin PlanetaryGear Shaft Superposition "
    "Tyre Vehicle",
    "engine": "ChenFlynn CombustionCycle CrankLayout Engine Excitation FullLoad PressureTrace SliderCrank Wiebe",
    "errors": "ModelError TorsionalError",
    "files": "changed expanded load_model",
    "files.scenario": "load_scenario",
    "laws": "Contacts Coulomb Hinges Jenkins Karnopp Law LuGre Polynomial Stribeck Table contact_time hysteresis_loop",
    "model": "Gear Landmarks Model Operation",
    "powertrain": "Powertrain",
    "quantities": "acceleration amplitude angular_velocity bound dominant_element irregularity named_modes order_share "
    "order_speed swing waveform",
    "report": "write_report",
    "results": "load_results save_results",
    "solvers.campbell": "campbell",
    "solvers.equilibrium": "OperatingPoint equilibrium linearize",
    "solvers.harmonic": "harmonic_response",
    "solvers.hysteresis": "hysteresis model_hysteresis",
    "solvers.modal": "damped_modes modal",
    "solvers.map": "response_map",
    "solvers.operating": "operated",
    "solvers.periodic": "Load Variation model_response periodic_response subharmonic_boundary subharmonic_map "
    "varied_response",
    "solvers.run_up": "full_load_response run_up_response",
    "solvers.transient": "CylinderTorques Governor OrderTorques SpeedProfile State TorqueHistory crank_angle_of "
    "engine_drive orders_in_time stage_changes steady_map steady_state swept transient windowed_rms",
    "studies.scenarios.run_up": "run_up",
    "studies.scenarios.running": "run_scenario",
    "stamps": "Connection Constraint Mass NormalLoad SpeedSwitch",
    "system": "System assemble",
}
_WHERE = {name: home for home, names in _HOMES.items() for name in names.split()}

__all__ = sorted(_WHERE)


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module 'torsional' has no attribute '{name}'")
    value = getattr(import_module(f"torsional.{_WHERE[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
