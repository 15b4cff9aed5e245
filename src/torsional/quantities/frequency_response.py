"""Frequency responses of measured signals: H1 and coherence, averaged over segments."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from torsional.arguments import checked
from torsional.errors import ModelError
from torsional.numerics.arrays import Array, ComplexArray

LEAST = 64
"""Samples of a segment at least."""


class FrequencyResponse(NamedTuple):
    """Over ``frequency`` [Hz] the ``response`` output over input, its ``coherence`` and relative standard
    ``deviation``; the number of ``segments`` that were averaged."""

    frequency: Array
    response: ComplexArray
    coherence: Array
    deviation: Array
    segments: int


@checked
def frequency_response(time: Array, given: Array, met: Array, segment: float) -> FrequencyResponse:
    """H1 = S_xy/S_xx of what is ``met`` over what is ``given``, (samples,) at even ``time`` [s], in segments [s] that
    overlap by half, under Hann's window.

    Noise of the output averages out, that of the input makes H1 too small by 1 + its share.  γ² = |S_xy|²/(S_xx S_yy);
    the deviation is √((1 − γ²)/(2 n γ²)), n the segments (J. Bendat, A. Piersol, Random Data, 4th ed. 2010, table 9.6).
    Raises ModelError for times that are not even, and for less than two segments.

    >>> time, draw = np.arange(8000) / 1000.0, np.random.default_rng(1)
    >>> given = draw.standard_normal(8000)
    >>> told = frequency_response(time, given, 3.0 * given + 0.1 * draw.standard_normal(8000), 1.0)
    >>> told.segments, bool(abs(told.response[1:-1] - 3.0).max() < 0.2), bool(told.coherence[1:-1].min() > 0.99)
    (15, True, True)
    """
    from scipy import signal

    step = float(time[-1] - time[0]) / (time.size - 1)
    if np.abs(np.diff(time) - step).max() > 1e-3 * step:
        raise ModelError("even times are wanted", where="time", remedy="resample the measurement first")
    length = round(segment / step)
    if length < LEAST or time.size < 1.5 * length:
        found, allowed = f"{time.size} samples in segments of {length}", f"two segments of {LEAST} and more"
        raise ModelError("too few samples for a frequency response", where="segment", found=found, allowed=allowed)
    settings = {"fs": 1.0 / step, "window": "hann", "nperseg": length, "detrend": "constant"}
    frequency, cross = signal.csd(given, met, **settings)
    _, x = signal.welch(given, **settings)
    _, y = signal.welch(met, **settings)
    coherence = np.abs(cross) ** 2 / np.maximum(x * y, np.finfo(float).tiny)
    count = (time.size - length) // (length - length // 2) + 1
    deviation = np.sqrt(np.maximum(1.0 - coherence, 0.0) / (2.0 * count * np.maximum(coherence, 1e-12)))
    return FrequencyResponse(frequency, cross / np.maximum(x, np.finfo(float).tiny), coherence, deviation, count)
