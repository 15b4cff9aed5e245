"""Elastic and damping connections that are linear."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

from torsional import checks
from torsional.arguments import checked_fields
from torsional.stamps import Connection, Mass, Stamp


@dataclass(frozen=True)
@checked_fields
class Shaft:
    """A torsion spring from node ``a`` to node ``b``: torque k (1 + iη)(θ_b − θ_a) + c (θ̇_b − θ̇_a).

    ``stiffness`` k [Nm/rad], relative ``damping`` c [Nms/rad], ``loss_factor`` η [-] (hysteretic, frequency domain).
    Raises ModelError unless k > 0, c ≥ 0 and η ≥ 0.

    >>> next(Shaft(a="clutch", b="input", stiffness=25e3).stamps("damper")).weights
    {'clutch': -1.0, 'input': 1.0}
    """

    a: str
    b: str
    stiffness: float
    damping: float = 0.0
    loss_factor: float = 0.0

    def __post_init__(self) -> None:
        checks.distinct(self.a, self.b)
        checks.positive(self.stiffness, "stiffness", "stiffness")
        checks.not_negative(self.damping, "damping", "damping")
        checks.not_negative(self.loss_factor, "loss_factor", "loss_factor")

    def stamps(self, name: str) -> Iterator[Connection]:
        """One connection along θ_b − θ_a."""
        weights = {self.a: -1.0, self.b: 1.0}
        yield Connection(name, weights, float(self.stiffness), float(self.damping), float(self.loss_factor))


class Tyre(Shaft):
    """The torsional spring and damper between rim (``a``) and tread (``b``); a Shaft by another name.

    ``stiffness`` [Nm/rad], ``damping`` [Nms/rad], ``loss_factor`` [-]; raises ModelError as a `Shaft` does.

    >>> Tyre(a="wheels", b="vehicle", stiffness=1.6e5, damping=1500).damping
    1500
    """


@dataclass(frozen=True)
@checked_fields
class Damper:
    """A viscous damper from node ``a`` to node ``b`` (default: ground, an absolute damper), ``damping`` c [Nms/rad].

    It acts on the deviation from the mean rotation: steady drag belongs to the friction mean pressure or road load.

    >>> next(Damper("throw1", damping=0.8).stamps("bearing")).damping
    0.8
    """

    a: str
    b: str = "ground"
    damping: float = 0.0

    def __post_init__(self) -> None:
        checks.distinct(self.a, self.b)
        checks.positive(self.damping, "damping", "damping")

    def stamps(self, name: str) -> Iterator[Connection]:
        """One connection along θ_b − θ_a that has damping only."""
        yield Connection(name, {self.a: -1.0, self.b: 1.0}, damping=float(self.damping))


@dataclass(frozen=True)
@checked_fields
class DistributedShaft:
    """A uniform shaft from ``a`` to ``b`` in ``elements`` finite elements with consistent mass.

    Element matrices k [[1, −1], [−1, 1]] and J/6 [[2, 1], [1, 2]] with k = G I_p / l, J = ρ I_p l,
    I_p = π (D⁴ − d⁴)/32 (Friswell, Penny, Garvey, Lees: Dynamics of Rotating Machines, 2010, §9.4).  ``length`` [m],
    ``outer_diameter`` D and ``inner_diameter`` d [m], ``density`` ρ [kg/m³], ``shear_modulus`` G [Pa],
    ``loss_factor`` η [-].

    >>> shaft = DistributedShaft("a", "b", length=1.0, outer_diameter=0.1, elements=4)
    >>> len(list(shaft.stamps("tube")))
    16
    """

    a: str
    b: str
    length: float
    outer_diameter: float
    inner_diameter: float = 0.0
    elements: int = 10
    shear_modulus: float = 80e9
    density: float = 7850.0
    loss_factor: float = 0.0

    def __post_init__(self) -> None:
        checks.distinct(self.a, self.b)
        checks.positive(self.length, "length", "length")
        checks.not_negative(self.inner_diameter, "inner_diameter", "length")
        checks.positive(self.outer_diameter - self.inner_diameter, "outer_diameter - inner_diameter", "length")
        checks.positive(self.shear_modulus, "shear_modulus", "shear_modulus")
        checks.positive(self.density, "density", "density")
        checks.not_negative(self.loss_factor, "loss_factor", "loss_factor")
        checks.positive(self.elements, "elements", "number")

    @property
    def polar_moment(self) -> float:
        """I_p = π (D⁴ − d⁴)/32 [m⁴]."""
        return math.pi * (self.outer_diameter**4 - self.inner_diameter**4) / 32

    def stamps(self, name: str) -> Iterator[Stamp]:
        """Springs between inner nodes ``name.1`` …; J/6 [[2, 1], [1, 2]] as three squares."""
        step = self.length / self.elements
        stiffness = self.shear_modulus * self.polar_moment / step
        sixth = self.density * self.polar_moment * step / 6
        nodes = [self.a, *(f"{name}.{i}" for i in range(1, self.elements)), self.b]
        for i, (left, right) in enumerate(itertools.pairwise(nodes), 1):
            part = f"{name}.{i}"
            yield Connection(part, {left: -1.0, right: 1.0}, stiffness, loss_factor=self.loss_factor)
            yield Mass(f"{part}.left", {left: 1.0}, sixth)
            yield Mass(f"{part}.right", {right: 1.0}, sixth)
            yield Mass(f"{part}.both", {left: 1.0, right: 1.0}, sixth)
