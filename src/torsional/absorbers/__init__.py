"""Absorber concepts: functions that return named components between the crankshaft and the clutch."""

from torsional.absorbers.base import Absorber
from torsional.absorbers.dual_mass import dual_mass_flywheel
from torsional.absorbers.friction import with_friction
from torsional.absorbers.pendulum import CentrifugalPendulum, Rollers, with_pendulum
from torsional.absorbers.planetary import planetary_dual_mass_flywheel
from torsional.absorbers.power_split import cancellation_frequency, power_split_absorber
from torsional.absorbers.single_mass import single_mass_flywheel
from torsional.absorbers.tuned import tuned_flange_flywheel, tuned_secondary_flywheel, tuned_stiffness

__all__ = [
    "Absorber",
    "CentrifugalPendulum",
    "Rollers",
    "cancellation_frequency",
    "dual_mass_flywheel",
    "planetary_dual_mass_flywheel",
    "power_split_absorber",
    "single_mass_flywheel",
    "tuned_flange_flywheel",
    "tuned_secondary_flywheel",
    "tuned_stiffness",
    "with_friction",
    "with_pendulum",
]
