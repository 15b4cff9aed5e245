"""A system as arrays of a time step: the same matrices, the same torques, whose speeds."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from torsional.components import Coupling, Damper, GearPair, Inertia, Shaft
from torsional.errors import ModelError
from torsional.laws import Contacts, Hinges, LuGre, Polynomial, Stribeck, hinge_rows
from torsional.numerics.explicit.march import explicit_march
from torsional.numerics.motion.data import DAMPER, FOLLOW, MEAN_RATE, SPRING, Connected, Rows
from torsional.powertrain import Powertrain
from torsional.solvers.transient.arrays import connected, masses, with_viscous_losses
from torsional.solvers.transient.problem import Problem
from torsional.stamps import Mass, NormalLoad, SpeedSwitch
from torsional.system import System, assemble

STAGES = Hinges.staged([(500.0, 1e4), (1500.0, 3e4)], coast=[(400.0, 2e4)], stop_stiffness=1e6)
BRISTLES = LuGre(500.0, 0.5, 0.02, breakaway_torque=0.03, stribeck_rate=0.5)
FLOWS = {BRISTLES.address: BRISTLES.flow_address}
PRESSED = NormalLoad(4.0, 0.02, {"shaft": 0.25, "flywheel": 0.5}, carrier="wheel", level="pedal")


class Wheel:
    """A wheel that carries more above 100 rad/s."""

    def stamps(self, name: str) -> Any:
        """One mass."""
        yield Mass(name, {name: 1.0}, 3.0, SpeedSwitch(4.0, 100.0))


PARTS: dict[str, Any] = {
    "engine": Inertia(1.0),
    "flywheel": Coupling("pinion", "engine", STAGES, damping=5.0),
    "pinion": Inertia(0.1),
    "bearing": Damper("pinion", damping=7.0),
    "wheel": Wheel(),
    "gear": GearPair("pinion", "wheel", ratio=-2.0),
    "shaft": Shaft("wheel", "vehicle", 1e5, damping=40.0),
    "rub": Coupling("pinion", "engine", BRISTLES, load=PRESSED),
    "drag": Coupling("ground", "vehicle", Polynomial((0.0, 1.0, 2.0)), whole_speed=True),
    "teeth": Coupling("vehicle", "trailer", Contacts.lash(0.01, 2e5, 1e-4), damping=1.0),
    "vehicle": Inertia(50.0),
    "trailer": Inertia(10.0),
}


def line(**more: Any) -> System:
    return assemble(Powertrain(PARTS | more))


def dense(rows: Rows, count: int) -> Any:
    """Rows as a matrix."""
    out = np.zeros((rows.start.size - 1, count))
    for i in range(len(out)):
        span = slice(rows.start[i], rows.start[i + 1])
        out[i, rows.column[span]] = rows.weight[span]
    return out


def test_masses_are_those_of_the_system() -> None:
    system = line()
    for speed in (50.0, 150.0):
        rows, inertia = masses(system, speed)
        v = dense(rows, len(system.coordinates))
        np.testing.assert_array_equal((v.T * inertia) @ v, system.switched(speed).M)
    assert masses(system, 100.0, rising=False)[1].max() == masses(system, 99.0)[1].max() == 50.0


def test_springs_dampers_and_hinges() -> None:
    system = line()
    found, c = connected(system, {"pedal": 0}), system.connections
    w = dense(found.rows, len(system.coordinates))
    np.testing.assert_array_equal(w, c.weights)
    np.testing.assert_array_equal((w.T * found.constants[DAMPER]) @ w, system.C)
    place = c.names.index("flywheel")
    springs = found.constants[SPRING]
    assert springs[place] == STAGES.stiffness and springs[c.names.index("shaft")] == 1e5
    angles = np.linspace(-0.3, 0.3, 61)
    for name, law in (("flywheel", STAGES), ("teeth", PARTS["teeth"].law)):
        np.testing.assert_allclose(summed(found, c.names.index(name), angles), law.torque(angles, 2.0), atol=1e-9)
    assert found.laws.of.tolist() == [c.names.index("rub"), c.names.index("drag")]


def summed(found: Connected, e: int, angle: Any) -> Any:
    """The torque that the arrays of one connection say, its damper left out, at the rate 2."""
    torque = found.constants[SPRING, e] * angle
    for gap, side, change, time in found.hinges.values.T[found.hinges.of == e]:
        pressed = side * (angle - gap) + time * side * 2.0
        torque = torque + side * change * np.maximum(0.0, pressed)
    return torque


def test_whose_speed_a_connection_sees() -> None:
    """A bearing the deviation from the mean rotation, a road load the whole, a shaft neither."""
    system = line()
    found, names = connected(system, {"pedal": 0}), system.connections.names
    ones = np.ones(len(system.coordinates))
    expected = {name: float(system.connections.weights[i] @ ones) for i, name in enumerate(names)}
    assert expected["bearing"] == -1.0 and expected["drag"] == pytest.approx(-0.5)
    for i, name in enumerate(names):
        assert found.constants[FOLLOW, i] == pytest.approx(expected[name] if name == "bearing" else 0.0, abs=0)
        assert found.constants[MEAN_RATE, i] == pytest.approx(expected[name] if name == "drag" else 0.0, abs=0)


def test_laws_and_their_loads() -> None:
    system = line()
    found, names = connected(system, {"other": 0, "pedal": 1}), system.connections.names
    laws, drag = found.laws, PARTS["drag"].law
    (rub, other), count = laws.places.T.tolist(), BRISTLES.parameters.size
    assert laws.values.tolist() == [*BRISTLES.parameters, *drag.parameters]
    assert rub == [names.index("rub"), BRISTLES.address, 1, 0, count, LuGre.load_place, 1, 0, 2]
    assert other == [names.index("drag"), drag.address, 0, count, laws.values.size, -1, -1, 2, 2]
    assert laws.loads.T.tolist() == [[4.0, pytest.approx(0.02 / 4)], [0.0, 0.0]]
    told = {names[j]: share for j, share in zip(laws.load_of, laws.shares, strict=True)}
    assert told == {"shaft": 0.25, "flywheel": 0.5}


def test_a_linear_line_has_empty_arrays_of_the_right_kinds() -> None:
    found = connected(assemble(Powertrain({"a": Inertia(1.0), "b": Inertia(2.0), "s": Shaft("a", "b", 1e4)})))
    kinds = [array.dtype.char for array in (found.constants, *found.hinges, *found.laws)]
    shapes = [array.shape for array in (found.constants, *found.hinges, *found.laws)]
    assert "".join(kinds) == "dIdlddId"
    assert shapes == [(5, 1), (0,), (4, 0), (9, 0), (0,), (2, 0), (0,), (0,)]


def test_loss_factors_are_refused_or_made_dampers() -> None:
    lossy = line(shaft=Shaft("wheel", "vehicle", 1e5, damping=40.0, loss_factor=0.02))
    with pytest.raises(ModelError, match=r"shaft: a loss factor .* found loss_factor 0.02; .*with_viscous_losses"):
        connected(lossy, {"pedal": 0})
    taken = with_viscous_losses(lossy, 25.0)
    place = lossy.connections.names.index("shaft")
    assert connected(taken, {"pedal": 0}).constants[DAMPER, place] == pytest.approx(40.0 + 0.02 * 1e5 / (50 * np.pi))
    with pytest.raises(ModelError, match="frequency"):
        with_viscous_losses(lossy, 0.0)
    parts = {"a": Inertia(1.0), "b": Inertia(2.0), "c": Inertia(1.0), "soft": Shaft("a", "b", 1e4, loss_factor=0.1)}
    both = assemble(Powertrain({**parts, "stiff": Shaft("b", "c", 1e5, loss_factor=0.01)}))
    with pytest.raises(ModelError, match=r"soft: .* found loss_factor 0.1, and more in stiff; "):  # all at once
        connected(both)


def test_loads_refused() -> None:
    with pytest.raises(ModelError, match=r"rub: no level .* found pedal; did you mean 'peda'"):
        connected(line(), {"peda": 0})
    curved = line(flywheel=Coupling("pinion", "engine", Polynomial((1e4,)), damping=5.0))
    with pytest.raises(ModelError, match=r"torque of 'flywheel', which is neither .* found Polynomial"):
        connected(curved, {"pedal": 0})


def test_hinge_rows_are_a_property_of_the_data() -> None:
    assert hinge_rows(None) is None and hinge_rows(BRISTLES) is None
    assert hinge_rows(Contacts.lash(0.01, 1e5, 1e-3, damper="cut")) is None


# --- motion ---

FOLLOWING = 0.02


def independent(system: System, speed: float, times: Any, start: Any) -> Any:
    """The same line by a stiff integrator over the System's own matrices, laws and loads."""
    from scipy.integrate import solve_ivp

    c, n = system.connections, len(system.coordinates)
    settled = system.switched(speed)
    rub: Any = c.names.index("rub")
    load: Any = c.loads[rub]

    def flow(t: float, y: Any) -> Any:
        q, v, (z, turning) = y[:n], y[n : 2 * n], y[2 * n :]
        along = np.where(np.abs(c.weights.sum(axis=1)) < 1e-12, 0.0, c.weights.sum(axis=1))
        twist = c.weights @ q
        rate = c.weights @ v + along * np.where(c.whole_speed, speed, speed - turning)
        torque = c.stiffness * twist + c.damping * rate
        for i, law in enumerate(c.laws):
            if law is not None and i != rub:
                torque[i] += float(law.torque(twist[i], rate[i]))
        pressed = NormalLoad(min(t / 0.02, 1.0) * load.constant, load.centrifugal, load.shares)
        n_now = pressed.at(speed + v[0], dict(zip(c.names, torque, strict=True)))
        curve = 0.02 + 0.01 * np.exp(-((rate[rub] / 0.5) ** 2))
        bending = rate[rub] - 500.0 * abs(rate[rub]) / curve * z
        torque[rub] += n_now * (500.0 * z + 0.5 * bending)
        return np.concatenate(
            [v, np.linalg.solve(settled.M, -c.weights.T @ torque), [bending, (speed + v[0] - turning) / FOLLOWING]]
        )

    found = solve_ivp(flow, (times[0], times[-1]), start, "LSODA", times, rtol=1e-9, atol=1e-11, max_step=1e-4)
    return found.y


def test_the_arrays_move_as_the_system_does() -> None:
    """Stages, lash, a gear, a rising pedal, friction under loads, a brake and a bearing: from rest in the frame."""
    system = line(drag=Coupling("ground", "vehicle", Stribeck(30.0, 40.0, 5.0, 1.0), whole_speed=True))
    levels = {"pedal": ([0.0, 0.02], [0.0, 1.0])}
    problem = Problem.of(system, (), 80.0, levels=levels, reference_time=FOLLOWING)
    n, times = len(system.coordinates), np.linspace(0.0, 0.05, 11)
    start = np.concatenate([np.linspace(0.08, -0.02, n), np.zeros(n), [0.0, 80.0]])
    marched = explicit_march(problem.equations, times, start[:n], start[n : 2 * n], tolerance=1e-9, flows=FLOWS)
    expected = independent(system, 80.0, times, start)
    scale = np.abs(expected).max(axis=1)
    np.testing.assert_allclose(marched.angles.T, expected[:n], atol=2e-7 * scale[:n].max())
    np.testing.assert_allclose(marched.rates.T, expected[n : 2 * n], atol=1e-6 * scale[n : 2 * n].max())
    assert np.abs(expected[2 * n]).max() > 1e-5  # the bristles bend
