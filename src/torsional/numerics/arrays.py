"""Names for the array types used throughout."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
IntArray = NDArray[np.int64]
StatusArray = NDArray[np.int8]


def size(values: ComplexArray) -> Array:
    """Magnitudes, of the same bits whatever stands beside a value (NumPy's own depend on how it fills its registers).

    >>> size(np.array([3.0 + 4.0j])).tolist()
    [5.0]
    """
    return np.asarray(np.sqrt(values.real**2 + values.imag**2))
