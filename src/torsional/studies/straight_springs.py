"""The flywheel of straight springs with sliding shoes that claims take into time steps and onto a rig."""

from __future__ import annotations

import math

from torsional.absorbers import CoilSpring, StraightSprings

DESIGN = StraightSprings(
    primary_inertia=1.035,
    secondary_inertia=1.0,
    channels=3,
    radius=0.15,
    channel_arc=math.radians(113.0),
    springs_per_row=4,
    spring=CoilSpring(rate=777e3, free_length=0.060, solid_length=0.049, mass=0.45),
    shoe_mass=0.15,
    shoe_width=0.012,
    end_shoe_mass=0.10,
    end_shoe_width=0.009,
    secondary_clearance=(math.radians(0.3), math.radians(0.3)),
    stop_angle=math.radians(15.98),
    grease_damping=0.3,
    play_factors=(1.0, 1.2, 1.4),
)
"""The flywheel's springs in three channels with 0.7°, 0.84° and 0.98° of play, greased, without dry friction."""
