"""Laws that are sums of hinges, as the arrays of those."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from torsional.numerics.arrays import Array


class HingeRows(NamedTuple):
    """A law as hinges: s max(0, Δk (s (φ − g) + τ s φ̇)) each, beside a spring k0: arrays of one length."""

    stiffness: float
    gap: Array
    side: Array
    change: Array
    contact_time: Array

    @property
    def address(self) -> int:
        """Zero: code that finds no kernel here has closed forms of its own."""
        return 0

    @property
    def remembers(self) -> bool:
        """Never."""
        return False

    @property
    def packed(self) -> Array:
        """k0, then (gap, side, change of stiffness) of every hinge, as closed forms of the angle read them."""
        return np.concatenate([[self.stiffness], np.stack([self.gap, self.side, self.change], axis=1).ravel()])
