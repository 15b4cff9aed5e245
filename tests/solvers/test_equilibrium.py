"""Mean torques: statics, free ranges, springs side by side."""

import numpy as np
import pytest

from torsional.components import Coupling, GearPair, Inertia, Shaft
from torsional.errors import ModelError
from torsional.laws import Coulomb, Hinges, Jenkins, Karnopp, LuGre, Stribeck
from torsional.powertrain import Powertrain
from torsional.solvers.equilibrium import equilibrium, linearize
from torsional.system import assemble

TWO_STAGE = Hinges.staged([(1000.0, 8e3), (3500.0, 24e3)], lash=0.02)
LINE = {
    "engine": Inertia(1.2),
    "dmf": Coupling("secondary", "engine", TWO_STAGE),
    "secondary": Inertia(1.0),
    "gear": GearPair("secondary", "output", 4.0),
    "output": Inertia(2.0),
    "shaft": Shaft("wheel", "output", 1e5),
    "wheel": Inertia(50.0),
}


def test_torques_through_stages_and_a_gear() -> None:
    point = equilibrium(assemble(Powertrain(LINE)), {"engine": [0.0, 500.0, 2000.0, -500.0]}, hold="wheel")
    assert point.names == ("dmf", "shaft")
    assert point.torque == pytest.approx(np.array([[0, 0], [500, 2000], [2000, 8000], [-500, -2000]]))
    assert point.angle[:, 0] == pytest.approx([0, 0.01 + 500 / 8e3, 0.01 + 1 / 8 + 1 / 24, -0.01 - 500 / 8e3])
    assert point.stiffness[:, 0].tolist() == [0.0, 8e3, 24e3, 8e3]


def test_springs_side_by_side_share_the_torque() -> None:
    """A second, linear path beside the law: k φ + f(φ) = T, solved by hand in the first stage."""
    line = Powertrain({**LINE, "bypass": Shaft("secondary", "engine", 2e3)})
    point = equilibrium(assemble(line), {"engine": 500.0}, hold="wheel")
    angle = (500 + 8e3 * 0.01) / 10e3
    told = dict(zip(point.names, point.angle, strict=True))
    assert told["dmf"] == pytest.approx(angle, rel=1e-9)
    assert point.torque.sum() == pytest.approx(500 + 2000, rel=1e-9)


FRICTION = {
    "washer": Jenkins(50.0, 25e3),
    "Coulomb": Coulomb(50.0, 0.01),
    "bristles": LuGre(1e5, 100.0, 40.0, 50.0, 0.05),
    "band": Karnopp(40.0, 50.0, 0.01, 1e5),
    "Stribeck": Stribeck(40.0, 50.0, 0.05, 0.001),
}


@pytest.mark.parametrize("name", FRICTION)
def test_friction_carries_no_mean_torque(name: str) -> None:
    """Vibration shakes it loose: a spring beside it holds 500 Nm alone, and without one nothing does."""
    line = Powertrain({**LINE, "friction": Coupling("secondary", "engine", FRICTION[name])})
    point = equilibrium(assemble(line), {"engine": 500.0}, hold="wheel")
    told = dict(zip(point.names, zip(point.angle, point.torque, strict=True), strict=True))
    assert told["dmf"] == pytest.approx((0.01 + 500 / 8e3, 500.0))
    assert told["friction"] == pytest.approx((0.01 + 500 / 8e3, 0.0))
    alone = Powertrain({**LINE, "dmf": Coupling("secondary", "engine", FRICTION[name])})
    with pytest.raises(ModelError, match="no spring carries the mean torque"):
        equilibrium(assemble(alone), {"engine": 500.0}, hold="wheel")


def test_linearized_has_the_tangent() -> None:
    system = assemble(Powertrain(LINE))
    linear = linearize(system, equilibrium(system, {"engine": 2000.0}, hold="wheel"))
    assert not linear.elements
    assert linear.connections.stiffness.tolist() == [24e3, 1e5]


def test_refused() -> None:
    system = assemble(Powertrain(LINE))
    with pytest.raises(ModelError, match="did you mean 'wheel'"):
        equilibrium(system, {"engine": 1.0}, hold="whel")
    limited = Powertrain({**LINE, "dmf": Coupling("secondary", "engine", Hinges(0.0, (0.1,), (1.0,), (1e3,)))})
    with pytest.raises(ModelError, match="dmf: no angle carries"):
        equilibrium(assemble(limited), {"engine": -10.0}, hold="wheel")


def test_stage_and_distance_to_stop() -> None:
    """Stop at 1000/8e3 + 2500/24e3 beyond half the lash; at 2000 Nm 1500/24e3 of the second stage are left."""
    law = Hinges.staged([(1000.0, 8e3), (3500.0, 24e3)], lash=0.02, stop_stiffness=1e6)
    system = assemble(Powertrain({**LINE, "dmf": Coupling("secondary", "engine", law)}))
    point = equilibrium(system, {"engine": 2000.0}, hold="wheel")
    assert (point.stage("dmf"), point.stage("shaft")) == ("stage 2", "linear")
    assert point.distance_to_stop("dmf") == pytest.approx(1500 / 24e3)
    assert np.isnan(point.distance_to_stop("shaft"))
    assert equilibrium(system, {"engine": 0.0}, hold="wheel").stage("dmf") == "free play"
    with pytest.raises(ModelError, match="did you mean 'dmf'"):
        point.stage("dmff")
