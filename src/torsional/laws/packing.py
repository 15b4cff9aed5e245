"""Laws in a row, as compiled code reads them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from torsional.laws.base import Law
from torsional.laws.rows import HingeRows
from torsional.numerics.arrays import Array, IntArray


class PackedLaws(NamedTuple):
    """Parameters of all laws in a row and the place where each starts (laws + 1,); address of each kernel, its memory.

    ``address`` 0 stands for none: nothing, or hinges, whose ``values`` are k0 and rows of (gap, side, change).
    """

    values: Array
    start: IntArray
    address: IntArray
    remembers: IntArray


def packed(laws: Sequence[Law | HingeRows | None]) -> PackedLaws:
    """Laws, and hinges where the code that reads them has closed forms of those, in a row; None takes no place.

    >>> from torsional.laws import Hinges
    >>> packed([None, Hinges(5.0, (0.1,), (1.0,), (2.0,)).straight, Hinges(7.0).straight]).values.tolist()
    [5.0, 0.1, 1.0, 2.0, 7.0]
    """
    values = [np.zeros(0) if law is None else law.packed for law in laws]
    return PackedLaws(
        np.concatenate([np.zeros(0), *values]),
        np.append(0, np.cumsum([own.size for own in values])).astype(np.int64),
        np.array([0 if law is None else law.address for law in laws], dtype=np.int64),
        np.array([int(law is not None and law.remembers) for law in laws], dtype=np.int64),
    )
