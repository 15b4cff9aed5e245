"""Parts an engineer names; each yields stamps."""

from torsional.components.base import Component
from torsional.components.coupling import Coupling
from torsional.components.gears import GearPair, PlanetaryGear, PlanetSpin, Superposition
from torsional.components.inertia import Inertia, Vehicle
from torsional.components.shaft import Damper, DistributedShaft, Shaft, Tyre

__all__ = [
    "Component",
    "Coupling",
    "Damper",
    "DistributedShaft",
    "GearPair",
    "Inertia",
    "PlanetSpin",
    "PlanetaryGear",
    "Shaft",
    "Superposition",
    "Tyre",
    "Vehicle",
]
