"""What cannot be a powertrain is refused by name; what can is changed by copies."""

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest

from torsional.absorbers import CentrifugalPendulum
from torsional.components import Coupling, Damper, GearPair, Inertia, PlanetaryGear, Shaft, Superposition
from torsional.errors import ModelError
from torsional.laws import Hinges
from torsional.powertrain import Powertrain
from torsional.stamps import Constraint
from torsional.system import assemble


def discs(*names: str) -> dict[str, Inertia]:
    return {name: Inertia(1.0) for name in names}


class Brake:
    """A node locked to the ground."""

    def __init__(self, node: str) -> None:
        self.node = node

    def stamps(self, name: str) -> list[Constraint]:
        return [Constraint(name, {self.node: 1.0, "ground": -1.0})]


REFUSED: list[tuple[str, Callable[[], object], str]] = [
    ("misspelt node", lambda: Powertrain({**discs("flywheel", "b"), "s": Shaft("flywheeel", "b", 1.0)}), "'flywheel'"),
    ("no inertia", lambda: Powertrain({**discs("a"), "s": Shaft("a", "zz", 1.0)}), "'zz' has no inertia"),
    (
        "massless geared node",
        lambda: Powertrain({**discs("a"), "s": Shaft("a", "x", 1.0), "g": GearPair("x", "y", 2.0)}),
        "has no inertia",
    ),
    ("two parts", lambda: Powertrain(discs("a", "b")), "2 parts: {a}; {b}"),
    ("empty", lambda: Powertrain({}), "at least one inertia"),
    ("repeated name", lambda: Powertrain([("a", Inertia(1.0)), ("a", Inertia(2.0))]), "same name"),
    ("a name with a colon", lambda: Powertrain({"a:b": Inertia(1.0)}), "component's name"),
    ("ground as a name", lambda: Powertrain({"ground": Inertia(1.0)}), "never moves"),
    ("not a component", lambda: Powertrain({"a": 3.0}), "is not a component"),  # type: ignore[dict-item]
    (
        "contradictory pair",
        lambda: Powertrain({**discs("a", "b"), "g": GearPair("a", "b", 2.0), "h": GearPair("a", "b", 2.1)}),
        "'g', 'h' contradict",
    ),
    (
        "contradiction through a shaft",
        lambda: Powertrain(
            {
                **discs("a", "b", "c", "d"),
                "g": GearPair("a", "b", 2.0),
                "h": GearPair("c", "d", 2.1),
                "s": Shaft("a", "c", 1.0),
                "t": Shaft("b", "d", 1.0),
            }
        ),
        "cannot turn together",
    ),
    (
        "contradiction through shafts, bearings on the ground",
        lambda: Powertrain(
            {
                **discs("a", "b", "c"),
                "bearing": Damper("a", damping=1.0),
                "s": Shaft("a", "b", 1.0),
                "t": Shaft("b", "c", 1.0),
                "g": GearPair("a", "c", 3.0),
            }
        ),
        "cannot turn together",
    ),
    (
        "everything held",
        lambda: Powertrain({**discs("a"), "brake": Brake("a")}),  # type: ignore[dict-item]
        "every node is held",
    ),
    ("self-loop", lambda: Shaft("a", "a", 1.0), "with itself"),
    ("zero stiffness", lambda: Shaft("a", "b", 0.0), "must be positive"),
    ("negative damping", lambda: Shaft("a", "b", 1.0, damping=-1.0), "must not be negative"),
    ("ratio zero", lambda: GearPair("a", "b", 0.0), "must not be zero"),
    ("boolean", lambda: Inertia(True), "finite number"),
    ("infinite", lambda: Inertia(float("inf")), "finite number"),
    ("text", lambda: Inertia("1.9"), "finite number"),  # type: ignore[arg-type]
]


@pytest.mark.parametrize(("make", "said"), [case[1:] for case in REFUSED], ids=[case[0] for case in REFUSED])
def test_refused(make: Callable[[], object], said: str) -> None:
    with pytest.raises(ModelError) as caught:
        make()
    assert said in str(caught.value)


def test_two_parts_when_meant() -> None:
    assert len(Powertrain(discs("a", "b"), parts=2).structure.parts) == 2


def test_consistent_loop_of_gears_is_fine() -> None:
    loop = {**discs("a", "b", "c"), "g": GearPair("a", "b", 2.0), "h": GearPair("b", "c", 3.0)}
    line = Powertrain({**loop, "i": GearPair("a", "c", 6.0)})
    assert line.speed_ratio("c") == pytest.approx(1 / 6)
    assert assemble(line).M[0, 0] == pytest.approx(1 + 1 / 4 + 1 / 36)


def test_copies() -> None:
    line = Powertrain({**discs("a", "b"), "s": Shaft("a", "b", 1e3)})
    assert line.replaced("s", stiffness=2e3)["s"].stiffness == 2e3
    assert line["s"].stiffness == 1e3
    assert "d" in line.joined({"d": Damper("a", damping=1.0)}).components
    with pytest.raises(ModelError, match="did you mean 'stiffness'"):
        line.replaced("s", stifness=2e3)
    with pytest.raises(ModelError, match=r"s\.stiffness: must be positive"):
        line.replaced("s", stiffness=-2e3)
    with pytest.raises(ModelError, match="same name"):
        line.joined({"a": Inertia(1.0)})


def test_planetary_with_ring_held_is_a_plain_ratio() -> None:
    """Ring held: ω_carrier = ω_sun/(1 − i0); the carrier's inertia seen at the sun is J/(1 − i0)²."""
    parts = {**discs("sun", "carrier"), "set": PlanetaryGear("sun", "ring", "carrier", standing_ratio=-2.0)}
    line = Powertrain({**parts, "ring": Inertia(5.0), "brake": Brake("ring")})  # type: ignore[dict-item]
    assert line.speed_ratio("carrier") == pytest.approx(1 / 3)
    assert float(assemble(line).M.sum()) == pytest.approx(1 + 1 / 9)


def test_planets_spin_with_the_carrier_when_locked() -> None:
    """With sun and carrier turning as one, planets do not spin relative to them: inertia J at speed one."""
    parts = {
        **discs("sun", "ring", "carrier"),
        "set": PlanetaryGear("sun", "ring", "carrier", -2.0, planet_inertia=0.5, planet_ratio=1.7),
        "lock": GearPair("sun", "carrier", 1.0),
    }
    assert float(assemble(Powertrain(parts)).M.sum()) == pytest.approx(3.5)


def test_superposition_weights_sum_to_one() -> None:
    line = Powertrain({**discs("a", "b", "c"), "g": Superposition("c", "a", "b", 0.7), "s": Shaft("a", "b", 1e3)})
    assert np.allclose(line.structure.speed_ratio, 1.0)


def test_picked_connections_are_whole() -> None:
    """Every field of the chosen ones, in the order asked for; with other weights where such are given."""
    parts = {
        "disc": Inertia(1.0),
        "mount": Shaft("ground", "disc", 1e4, damping=3.0, loss_factor=0.1),
        "pendulum": CentrifugalPendulum("disc", mass=1.0, distance=0.1, order=1.5, damping=0.02),
        "stop": Coupling("ground", "disc", Hinges(0.0, (0.1,), (1.0,), (2.0,))),
    }
    c = assemble(Powertrain(parts)).connections
    some, turned = c.picked([2, 0]), c.picked([1], np.array([[3.0, 4.0]]))
    for field in dataclasses.fields(c):
        told = getattr(c, field.name)
        assert list(map(repr, getattr(some, field.name))) == [repr(told[2]), repr(told[0])], field.name
    assert turned.weights.tolist() == [[3.0, 4.0]] and turned.swings == (c.swings[1],) != (None,)
    assert c.values[0].tolist() == [1e4, 3.0, 0.1, 0.0]
