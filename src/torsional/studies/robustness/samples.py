"""The trucks that are asked beside the given one: parameters one at a time, and all of them together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from torsional.numerics.arrays import Array
from torsional.studies.robustness.parameters import SPREAD
from torsional.studies.sweeps.designs import hypercube

SEED = 20
"""Of the Latin hypercube, so that every run asks the same trucks."""


@dataclass(frozen=True)
class Samples:
    """Factors on the named ``parameters``: ``many`` trucks of a Latin hypercube, then each parameter alone, down and
    up.

    A claim that is asked of fewer trucks is asked of the first ones.
    """

    parameters: tuple[str, ...]
    many: int
    seed: int = SEED

    @cached_property
    def together(self) -> Array:
        """Factors of the hypercube's trucks (truck, parameter) within 1 ± 0.2."""
        if not self.many or not self.parameters:
            return np.ones((self.many, len(self.parameters)))
        drawn = hypercube(self.many, len(self.parameters), self.seed)
        return np.asarray(1.0 + SPREAD * (2.0 * drawn - 1.0))

    def __len__(self) -> int:
        return self.many + 2 * len(self.parameters)

    def alone(self, number: int) -> tuple[str, float]:
        """The parameter that a truck after the hypercube's differs in, and its factor."""
        place, up = divmod(number - self.many, 2)
        return self.parameters[place], 1.0 + SPREAD if up else 1.0 - SPREAD

    def factors(self, number: int) -> Mapping[str, float]:
        """Factors of a truck by parameter.

        >>> Samples(("mass", "stiffness"), 0).factors(3)
        {'stiffness': 1.2}
        """
        if number < self.many:
            return dict(zip(self.parameters, self.together[number].tolist(), strict=True))
        return dict([self.alone(number)])
