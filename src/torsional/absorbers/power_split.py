"""Power split vibration absorber (PSVA): springs and planetary gears side by side."""

from __future__ import annotations

import math

from torsional.absorbers.base import Absorber
from torsional.arguments import checked
from torsional.checks import number
from torsional.components import Component, Coupling, Inertia, PlanetSpin, Superposition
from torsional.errors import ModelError
from torsional.laws import Law


@checked
def power_split_absorber(
    primary_inertia: float,
    secondary_inertia: float,
    planet_inertia: float,
    output_inertia: float,
    law: Law,
    *,
    planet_ratio: float,
    gear_quotient: float,
    damping: float = 0.0,
) -> Absorber:
    """Bodies 1 primary, 2 secondary, 3 planets, 4 output [kgm²]; springs between 1 and 2.

    θ3 = (1 − g) θ1 + g θ2 and θ4 = (1 − r) θ1 + r θ2 with ``planet_ratio`` g and ``gear_quotient``
    r = (θ4 − θ1)/(θ2 − θ1), 0 < r ≤ 1; the springs carry the share r of the output torque.  The planets' orbiting
    mass belongs to the body that carries them.  After Fischer et al. (VDI, Friedrichshafen, 2013); Wramner
    (Chalmers, 2020, §2.2.2).

    >>> from torsional.laws import Hinges
    >>> power_split_absorber(1.8, 0.5, 0.02, 1.2, Hinges(20e3), planet_ratio=2.5, gear_quotient=0.6).output
    'output'
    """
    if not 0 < number(gear_quotient, "gear_quotient") <= 1:
        raise ModelError(
            "the gear quotient of a power split absorber is above 0 and at most 1",
            where="gear_quotient",
            found=f"{gear_quotient:g}",
            remedy="a quotient above 1 of other authors is 1/r",
        )
    components: dict[str, Component] = {
        "primary": Inertia(primary_inertia),
        "springs": Coupling("secondary", "primary", law, damping),
        "secondary": Inertia(secondary_inertia),
        "planets": PlanetSpin("primary", "secondary", planet_ratio, planet_inertia),
        "output": Inertia(output_inertia),
        "power_split": Superposition("output", "primary", "secondary", gear_quotient),
    }
    nodes = ("primary", "secondary", "output")
    return Absorber("power split absorber", components, "primary", "output", ("springs",), nodes)


@checked
def cancellation_frequency(
    stiffness: float, secondary_inertia: float, planet_inertia: float, planet_ratio: float, gear_quotient: float
) -> float:
    """Angular frequency [rad/s] at which the output stands still, without damping.

    ω_c² = k / (J2 (1 − r) + J3 g (g − r)), for any linear driveline behind it and any J1, J4; from the gear conditions
    of `power_split_absorber` (Wramner, Chalmers, 2020, §2.2.2).

    >>> round(cancellation_frequency(20e3, 0.5, 0.02, 2.5, 0.6) / 2 / math.pi, 7)
    41.4404174
    """
    g, r = planet_ratio, gear_quotient
    return math.sqrt(stiffness / (secondary_inertia * (1 - r) + planet_inertia * g * (g - r)))
