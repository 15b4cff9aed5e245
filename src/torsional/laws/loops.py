"""Hysteresis loops of a law by itself."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from torsional.arguments import checked
from torsional.checks import positive
from torsional.laws.base import Law
from torsional.numerics.arrays import Array


class Loop(NamedTuple):
    """One closed cycle: ``angle`` [rad] and ``torque`` [Nm] (samples + 1), and what it loses, ``loss`` = ∮ f dφ [J]."""

    angle: Array
    torque: Array
    loss: float


@checked
def hysteresis_loop(
    law: Law, amplitude: float, *, centre: float = 0.0, frequency: float = 1.0, cycles: int = 2, samples: int = 4000
) -> Loop:
    """The last of several ``cycles`` of φ = centre + A sin 2πft with half-width ``amplitude`` A [rad], at a
    ``frequency`` f [Hz].

    The history starts relaxed at the centre; the ``loss`` is by trapezoids, its error falls with the square of
    ``samples`` a cycle.  Raises ModelError unless amplitude and frequency are positive.

    >>> from torsional.laws import Jenkins
    >>> loop = hysteresis_loop(Jenkins(50.0, 25e3), 0.01)
    >>> round(loop.loss, 3), 4 * 50.0 * (0.01 - 50.0 / 25e3)
    (1.6, 1.6)
    """
    positive(amplitude, "amplitude", "relative_angle")
    positive(frequency, "frequency", "frequency")
    phase = 2 * np.pi * np.arange(cycles * samples + 1) / samples
    angle = centre + amplitude * np.sin(phase)
    torque = law.march(angle, 1.0 / (frequency * samples))[0]
    last, after = angle[-samples - 1 :], torque[-samples - 1 :]
    return Loop(last, after, float((0.5 * (after[1:] + after[:-1]) * np.diff(last)).sum()))
