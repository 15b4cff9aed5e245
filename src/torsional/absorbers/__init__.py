"""Absorber concepts: functions that return named components between the crankshaft and the clutch."""

from torsional.absorbers.arc_spring import ArcSprings, arc_spring_flywheel
from torsional.absorbers.base import Absorber
from torsional.absorbers.dual_mass import dual_mass_flywheel
from torsional.absorbers.friction import with_friction
from torsional.absorbers.pendulum import CentrifugalPendulum, Rollers, with_pendulum
from torsional.absorbers.planetary import planetary_dual_mass_flywheel
from torsional.absorbers.power_split import cancellation_frequency, power_split_absorber
from torsional.absorbers.single_mass import single_mass_flywheel
from torsional.absorbers.spring_design import condensed_flywheel, spring_characteristic
from torsional.absorbers.spring_parts import CoilSpring, GuideFriction
from torsional.absorbers.straight_spring import StraightSprings, straight_spring_flywheel
from torsional.absorbers.tuned import tuned_flange_flywheel, tuned_secondary_flywheel, tuned_stiffness

__all__ = [
    "Absorber",
    "ArcSprings",
    "CentrifugalPendulum",
    "CoilSpring",
    "GuideFriction",
    "Rollers",
    "StraightSprings",
    "arc_spring_flywheel",
    "cancellation_frequency",
    "condensed_flywheel",
    "dual_mass_flywheel",
    "planetary_dual_mass_flywheel",
    "power_split_absorber",
    "single_mass_flywheel",
    "spring_characteristic",
    "straight_spring_flywheel",
    "tuned_flange_flywheel",
    "tuned_secondary_flywheel",
    "tuned_stiffness",
    "with_friction",
    "with_pendulum",
]
