"""The space above a piston."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from torsional.arguments import checked_fields
from torsional.checks import positive, within
from torsional.engine.orders import FloatArray, crank_angle_grid
from torsional.engine.slider_crank import SliderCrank


@dataclass(frozen=True)
@checked_fields
class Cylinder:
    """Bore [m], compression ratio [-] and the slider-crank below.

    Raises ModelError for a bore that is not positive or a compression ratio outside 2 to 40.

    >>> round(Cylinder(0.131, 18.1, SliderCrank(0.079, 0.2675)).displacement * 6e3, 2)  # litres of six
    12.78
    """

    bore: float
    compression_ratio: float
    crank: SliderCrank

    def __post_init__(self) -> None:
        positive(self.bore, "bore", "length")
        within(self.compression_ratio, 2.0, 40.0, "compression_ratio", "number")

    @property
    def area(self) -> float:
        """Area of the piston [m²]."""
        return 0.25 * np.pi * self.bore**2

    @property
    def displacement(self) -> float:
        """Swept volume [m³]."""
        return self.area * self.crank.stroke

    @property
    def clearance(self) -> float:
        """Volume at top dead centre [m³]."""
        return self.displacement / (self.compression_ratio - 1.0)

    def volume(self, crank_angle: ArrayLike) -> FloatArray:
        """Volume above the piston V(θ) [m³], in the shape of the crank angle [rad]."""
        return np.asarray(self.clearance + self.area * self.crank.position(crank_angle))

    @cached_property
    def lever(self) -> FloatArray:
        """Torque per pressure A x'(θ) = dV/dθ [m³/rad] on the grid of crank angles."""
        return np.asarray(self.area * self.crank.velocity_ratio(crank_angle_grid()))
