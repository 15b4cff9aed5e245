"""An arc spring that slides on its guide is a rope round a post: statics in closed form against its sections.

Along the arc α the friction takes the load times µ from the torque: dT/dα = −(q + µT), q = µ m R² Ω²/α_spring, from the
pushed end on.  Where nothing of T is left the spring sticks.  With κ = k R² α_spring the pushed end has gone

    φ = ∫ T/κ dα = [T0/µ − (q/µ²) ln(1 + µ T0/q)] / κ,      sliding over ln(1 + µ T0/q)/µ of the arc.
"""

from __future__ import annotations

import numpy as np
import pytest

from torsional.absorbers import ArcSprings, CoilSpring, GuideFriction, arc_spring_flywheel
from torsional.powertrain import Powertrain
from torsional.solvers.hysteresis import hysteresis
from torsional.system import assemble

FRICTION, RADIUS, LENGTH, MASS, RATE, SPEED = 0.12, 0.15, 0.24, 0.6, 60e3, 300.0
ARC = LENGTH / RADIUS
STRETCH = RATE * RADIUS**2 * ARC
PER_ARC = FRICTION * MASS / ARC * RADIUS**2 * SPEED**2


def pushed(segments: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Angle and torque of the first push at the speed, and the share of the sections' friction that slides then."""
    design = ArcSprings(
        primary_inertia=1.0,
        secondary_inertia=1.0,
        channels=1,
        radius=RADIUS,
        channel_arc=ARC,
        segments=segments,
        spring=CoilSpring(RATE, LENGTH, 0.05, MASS),
        stop_angle=1.0,
        friction=GuideFriction(FRICTION, presliding=1e-6, bristle_time=0.0, viscous_coefficient=0.0),
        tab_stiffness=1e9,
    )
    system = assemble(Powertrain(arc_spring_flywheel(design).components))
    loop = hysteresis(system, "primary", "secondary", SPEED, 0.03, samples=240, rate=1e-3)
    first = (
        loop.isel(speed=0, sweep=0).sel(cycle="first").isel(sample=slice(20, 60))
    )  # from where several sections slide
    names = [f"arc_1_{i}_guide" for i in range(1, segments + 2)]
    end = first.isel(sample=-1)
    resists = abs(end.torque.sel(element=names)) / (FRICTION * RADIUS * end.normal_load.sel(element=names))
    return first.drive_angle.values, first.drive_torque.values, float((resists > 0.99).mean())


@pytest.mark.parametrize(("segments", "error"), [(16, 3e-3), (32, 8e-4)])
def test_first_push_of_an_arc_spring(segments: int, error: float) -> None:
    angle, torque, slides = pushed(segments)
    behind = np.log1p(FRICTION * torque / PER_ARC)
    way = (torque / FRICTION - PER_ARC / FRICTION**2 * behind) / STRETCH
    np.testing.assert_allclose(way, angle, rtol=error)
    reached = behind[-1] / FRICTION / ARC
    assert 0.6 < reached < 0.8
    assert slides == pytest.approx(reached, abs=1.5 / segments)
    assert torque[-1] / angle[-1] > 1.2 * RATE * RADIUS**2  # what sticks takes no part, and the rest is stiffer
