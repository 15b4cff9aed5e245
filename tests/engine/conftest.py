"""An engine of the representative truck's size."""

from __future__ import annotations

import numpy as np
import pytest

from torsional.engine import CrankLayout, Engine, FullLoad
from torsional.units import RPM


@pytest.fixture(scope="session")
def truck() -> Engine:
    speeds = RPM * np.array([600, 800, 900, 1300, 1500, 1700, 1900, 2000])
    return Engine(
        bore=0.131,
        stroke=0.158,
        rod_length=0.2675,
        reciprocating_mass=4.2,
        compression_ratio=18.1,
        layout=CrankLayout.inline((1, 5, 3, 6, 2, 4)),
        full_load=FullLoad(tuple(speeds), (1300, 1900, 2500, 2500, 2300, 2000, 1600, 0)),
    )
