"""Normal loads of friction: checks, what linear and periodic analyses take, and the whole speed of a brake."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from torsional.components import Coupling, Damper, Inertia, Shaft
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.laws import Coulomb, Hinges, LuGre, Polynomial
from torsional.powertrain import Powertrain
from torsional.solvers.equilibrium import equilibrium, linearize
from torsional.solvers.harmonic import harmonic_response
from torsional.solvers.periodic import periodic_response
from torsional.stamps import Connection, NormalLoad
from torsional.system import System, assemble

BRISTLES = LuGre(500.0, 0.5, 0.02, breakaway_torque=0.03, stribeck_rate=0.5, viscous_damping=0.1, grease_damping=3.0)


def line(**more: Any) -> dict[str, Any]:
    """Two flywheels on a spring with friction beside it."""
    return {
        "engine": Inertia(1.0),
        "spring": Shaft("disc", "engine", 1e4, damping=3.0),
        "rub": Coupling("disc", "engine", BRISTLES, **more),
        "disc": Inertia(2.0),
    }


def system(**more: Any) -> System:
    return assemble(Powertrain(line(**more)))


def test_a_constant_load_is_the_laws_own() -> None:
    pressed = system(load=NormalLoad(constant=20.0))
    assert pressed.connections.loads == (None, None)
    plain = assemble(Powertrain(line() | {"rub": Coupling("disc", "engine", BRISTLES.loaded(20.0))}))
    assert pressed.hash == plain.hash != system().hash


def test_hash_tells_loads_and_whole_speed_apart() -> None:
    found = {
        system(**more).hash
        for more in (
            {},
            {"load": NormalLoad(centrifugal=0.1)},
            {"load": NormalLoad(centrifugal=0.2)},
            {"load": NormalLoad(centrifugal=0.1, shares={"spring": 0.1})},
            {"load": NormalLoad(1.0, level="pedal")},
            {"whole_speed": True},
        )
    }
    assert len(found) == 6
    same = NormalLoad(shares={"spring": 1}) == NormalLoad(shares=(("spring", 1.0),))
    assert same and len({NormalLoad(1.0), NormalLoad(1.0)}) == 1


def test_loads_refer_to_the_reference_node() -> None:
    from torsional.components import GearPair

    parts = line() | {
        "wheel": Inertia(1.0),
        "gear": GearPair("disc", "wheel", ratio=2.0),
        "drum": Inertia(0.5),
        "belt": Shaft("wheel", "drum", 1e3),
        "shoe": Coupling("wheel", "drum", BRISTLES, load=NormalLoad(centrifugal=0.4, carrier="wheel")),
    }
    (load,) = (load for load in assemble(Powertrain(parts)).connections.loads if load)
    assert load.centrifugal == pytest.approx(0.1) and load.carrier == ""


def test_settled_loads() -> None:
    rubbing = system(load=NormalLoad(5.0, 0.02, {"spring": 0.1}, level="pedal"))
    with pytest.raises(ModelError, match=r"rub: the normal load follows a torque; found a share .* 'spring'"):
        rubbing.loaded(100.0)
    law: Any = rubbing.loaded(100.0, {"spring": -50.0}).connections.laws[1]
    assert law.normal_load == pytest.approx(5.0 + 200.0 + 5.0)
    assert NormalLoad(-5.0).at(0.0, {}) == 0.0


def test_linear_analyses_take_the_load_at_mean_speed_and_mean_torque() -> None:
    """Beside a system whose law has that load for good; the bristles' own damping is that of standstill."""
    loose = LuGre(500.0, 0.0, 0.02, breakaway_torque=0.03, stribeck_rate=0.5, grease_damping=3.0)
    parts = line() | {"rub": Coupling("disc", "engine", loose, load=NormalLoad(7.0, 0.02, {"spring": 0.1}))}
    moving = assemble(Powertrain(parts))
    point = equilibrium(moving, {"engine": 300.0}, hold="disc")
    spring = abs(float(point.torque[point.names.index("spring")]))
    assert spring == pytest.approx(300.0)
    linear = linearize(moving, point)
    for speed in (50.0, 150.0):
        still = moving.loaded(speed, dict(zip(point.names, point.torque, strict=True)))
        settled = linearize(still, equilibrium(still, {"engine": 300.0}, hold="disc"))
        at = Excitation.unit("engine", [1.0, 3.0], [speed])
        one, two = (harmonic_response(s, at).angle.values for s in (linear, settled))
        np.testing.assert_allclose(one, two, rtol=1e-11)
    assert linear.connections.centrifugal_stiffness.max() == pytest.approx(0.02 * 500.0)
    with pytest.raises(ModelError, match="falls with speed"):
        linearize(system(load=NormalLoad(9.0, -0.01)), point)


def test_periodic_motion_takes_the_load_at_its_speed_or_refuses() -> None:
    exciting = Excitation(("engine",), [0, 1], 1.0, [[0.0, 40.0]])
    moving = system(load=NormalLoad(7.0, 0.002))
    settings: Any = {"parameter": "amplitude", "speed": 100.0, "highest_order": 5, "stability": False}
    one, two = (periodic_response(s, exciting, (0.5, 1.0), **settings) for s in (moving, moving.loaded(100.0)))
    np.testing.assert_array_equal(one.twist.values, two.twist.values)
    with pytest.raises(ModelError, match=r"rub: the normal load follows .*loaded\(speed"):
        periodic_response(moving, exciting, (90.0, 110.0), highest_order=5)
    with pytest.raises(ModelError, match="follows a torque"):
        periodic_response(system(load=NormalLoad(shares={"spring": 1.0})), exciting, (0.5, 1.0), **settings)
    with pytest.raises(ModelError, match="whole speed"):
        periodic_response(system(whole_speed=True), exciting, (90.0, 110.0), highest_order=5)


def test_a_brake_holds_nothing_and_linear_analyses_leave_it_out() -> None:
    parts = line() | {"brake": Coupling("ground", "disc", Polynomial((0.0, 2.0)), damping=1.0, whole_speed=True)}
    braked = assemble(Powertrain(parts))
    drag = assemble(Powertrain(line() | {"brake": Damper("disc", damping=1.0)}))
    assert braked.speed_ratio.tolist() == [1.0, 1.0]
    one, two = (linearize(s, equilibrium(s, {"engine": 50.0}, hold="disc")) for s in (braked, drag))
    np.testing.assert_allclose(one.K, two.K)
    np.testing.assert_allclose(one.C, two.C)


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: NormalLoad(), "the normal load is nought"),
        (lambda: NormalLoad(float("nan")), "constant: a finite number is wanted; found nan"),
        (lambda: Coupling("a", "b", Hinges(1.0, (1.0,), (1.0,), (1.0,)), load=NormalLoad(1.0)), "found Hinges"),
        (lambda: Coupling("a", "b", Hinges(1.0), load=NormalLoad(1.0)), "found no law"),
        (lambda: Coupling("a", "b", Coulomb(1.0, 1.0), load=3.0), "a NormalLoad is wanted"),  # type: ignore[arg-type]
        (lambda: Connection("x", {}, law=BRISTLES.loaded(2.0), load=NormalLoad(1.0)), "x: .*given twice; found 2 N"),
        (lambda: Hinges(1.0).loaded(1.0), "no normal load"),
        (lambda: system(load=NormalLoad(shares={"sprin": 1.0})), "rub.load.shares: .*did you mean 'spring'"),
        (lambda: system(load=NormalLoad(shares={"rub": 1.0})), "would follow itself"),
        (lambda: system(load=NormalLoad(centrifugal=1.0, carrier="dics")), "did you mean 'disc'"),
    ],
)
def test_refused(make: Any, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        make()
