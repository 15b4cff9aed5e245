"""Stops and several pendulums: between the stops nothing changes, and all of them together are one."""

from __future__ import annotations

import numpy as np
import pytest

from torsional.absorbers import CentrifugalPendulum
from torsional.components import Inertia, Shaft
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.powertrain import Powertrain
from torsional.solvers.equilibrium import equilibrium, linearize
from torsional.solvers.harmonic import harmonic_response
from torsional.system import System, assemble

DISTANCE = 0.1 * (1 + 1 / 9)


def line(**options: object) -> System:
    pendulum = CentrifugalPendulum("rotor", 1.0, DISTANCE, 3.0, **options)  # type: ignore[arg-type]
    parts = {"rotor": Inertia(0.5), "load": Inertia(3.0), "shaft": Shaft("rotor", "load", 1e4), "pendulum": pendulum}
    return assemble(Powertrain(parts))


@pytest.mark.parametrize("torque", [0.0, 100.0])
@pytest.mark.parametrize("options", [{"stop": 0.008}, {"count": 3}, {"count": 4, "stop": 0.008}])
def test_between_its_stops_a_pendulum_is_as_without(options: dict[str, object], torque: float) -> None:
    found = []
    for system in (line(), line(**options)):
        plain = linearize(system, equilibrium(system, {"rotor": torque}, hold="load"))
        data = harmonic_response(plain, Excitation.unit("rotor", [2.5, 3.0, 4.0], [100.0]))
        found.append(data.angle.sel(node=["rotor", "load"]).values)
    np.testing.assert_allclose(found[1], found[0], rtol=1e-12, atol=1e-18)
    assert np.abs(found[1][0, 1, 0]) < 1e-15  # the rotor stands still at order 3


def test_the_stop_lies_on_the_path() -> None:
    with pytest.raises(ModelError, match="path ends before the stop"):
        CentrifugalPendulum("rotor", 1.0, DISTANCE, 3.0, path="cycloid", stop=0.012)
    with pytest.raises(ModelError, match="whole number"):
        CentrifugalPendulum("rotor", 1.0, DISTANCE, 3.0, count=0)
    with pytest.raises(ModelError, match="stop"):
        CentrifugalPendulum("rotor", 1.0, DISTANCE, 3.0, stop=-0.001)
