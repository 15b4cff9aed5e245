"""Slow sweeps against closed forms: springs with washers, rows of sliding shoes, loads that follow the speed."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import solve_ivp

from torsional.components import Component, Coupling, GearPair, Inertia, Shaft
from torsional.components.shaft import Damper
from torsional.errors import ModelError
from torsional.laws import Contacts, Hinges, Jenkins, Law, LuGre
from torsional.numerics.arrays import Array
from torsional.numerics.quasi_static.loops import loss_per_cycle, secant_stiffness
from torsional.powertrain import Powertrain
from torsional.solvers.hysteresis import hysteresis, on_bench
from torsional.solvers.hysteresis.parts import parts_of
from torsional.stamps import NormalLoad
from torsional.system import System, assemble

STIFFNESS, FRICTION, SPRINGS = 6e3, 10.0, 6
STUCK = 1e9
"""Stiffness [Nm/rad] of a shoe that sticks: as good as rigid beside the springs."""


def pair(**between: Component) -> System:
    return assemble(Powertrain({"a": Inertia(1.0), "b": Inertia(2.0), **between}))


def shoes(law: Law, load: NormalLoad | None = None, rows: int = 1) -> System:
    """Rows of springs from the primary to the secondary, the shoes between them sliding on the primary."""
    parts: dict[str, Component] = {"primary": Inertia(1.0), "secondary": Inertia(1.0)}
    for row in range(rows):
        names = ["primary", *(f"shoe_{row}_{i}" for i in range(1, SPRINGS)), "secondary"]
        for name in names[1:-1]:
            parts[name] = Inertia(1e-3)
            parts[f"{name}_guide"] = Coupling("primary", name, law, load=load)
        for i in range(SPRINGS):
            parts[f"spring_{row}_{i + 1}"] = Shaft(names[i + 1], names[i], STIFFNESS)
    return assemble(Powertrain(parts))


def loading(angle: Array, friction: float = FRICTION) -> Array:
    """Torque of the row as it is first loaded: each shoe that gives way lets one spring more take part.

    With n shoes sliding the springs carry T, T − F, …, T − nF, and their twists add up to the angle.
    """
    sliding = np.arange(SPRINGS)[:, None]
    torque = (STIFFNESS * np.abs(angle) + friction * sliding * (sliding + 1) / 2) / (sliding + 1)
    fits = (torque <= (sliding + 1) * friction) | (sliding == SPRINGS - 1)
    return np.asarray(np.sign(angle) * np.take_along_axis(torque, fits.argmax(axis=0)[None], 0)[0])


def branches(loop: xr.Dataset) -> tuple[Array, Array, Array]:
    """Angle, first and closed torque of a single loop."""
    one = loop.isel(speed=0, sweep=0)
    return one.drive_angle.values, one.drive_torque.values[0], one.drive_torque.values[1]


# --- closed forms ---


def test_spring_with_stages_beside_a_washer() -> None:
    law, limit, stuck, sweep = Hinges.staged([(500.0, 1e4), (2000.0, 4e4)], lash=0.02), 40.0, 1e5, 0.08
    loop = hysteresis(
        pair(spring=Coupling("b", "a", law), washer=Coupling("b", "a", Jenkins(limit, stuck))), "a", "b", 0.0, sweep
    )
    angle, first, closed = branches(loop)
    quarter = angle.size // 4
    assert first[:quarter] == pytest.approx(law.torque(angle[:quarter]) + np.minimum(stuck * angle[:quarter], limit))
    down = slice(quarter, 3 * quarter)
    washer = np.maximum(limit - stuck * (sweep - angle[down]), -limit)
    assert closed[down] == pytest.approx(law.torque(angle[down]) + washer, abs=1e-9)
    assert loop.loss.item() == pytest.approx(4 * limit * (sweep - limit / stuck), rel=1e-3)
    assert loop.element_loss.sel(element="spring").item() == pytest.approx(0.0, abs=1e-9)
    assert loop.stiffness.item() == pytest.approx((float(law.torque(sweep)) + limit) / sweep, rel=1e-12)
    assert loop.sliding.item() == 1 and loop.cycles.item() == 2


@pytest.mark.parametrize("sweep", [1e-3, 0.01, 0.05, 0.1])
def test_row_of_shoes(sweep: float) -> None:
    """First loading in closed form, the closed loop by Masing's rule: the same curve, twice as large."""
    loop = hysteresis(shoes(Jenkins(FRICTION, STUCK)), "primary", "secondary", 0.0, sweep)
    angle, first, closed = branches(loop)
    quarter, top = angle.size // 4, float(loading(np.array([sweep]))[0])
    assert first[:quarter] == pytest.approx(loading(angle[:quarter]), abs=2e-4)
    down = slice(quarter, 3 * quarter)
    assert closed[down] == pytest.approx(top - 2 * loading(0.5 * (sweep - angle[down])), abs=4e-4)
    fine = np.linspace(0, sweep, 100_001)
    assert loop.loss.item() == pytest.approx(
        8 * np.trapezoid(loading(fine), fine) - 4 * top * sweep, rel=1e-3, abs=1e-6
    )
    assert loop.sliding.item() == np.count_nonzero(top > FRICTION * (1 + np.arange(SPRINGS - 1)))


def test_balance_holds_and_losses_add_up() -> None:
    loop = hysteresis(shoes(Jenkins(FRICTION, STUCK)), "primary", "secondary", 0.0, [0.02, 0.1])
    assert loop.element_loss.sum("element").values == pytest.approx(loop.loss.values, rel=1e-7)
    last = loop.torque.sel(element=f"spring_0_{SPRINGS}")
    assert last.values == pytest.approx(loop.drive_torque.values, abs=1e-6)  # what arrives at the secondary


def test_turned_from_the_other_end() -> None:
    """The secondary turned against the primary: torque and angle change their signs, the loop stays."""
    one = hysteresis(shoes(Jenkins(FRICTION, STUCK)), "primary", "secondary", 0.0, 0.05)
    two = hysteresis(shoes(Jenkins(FRICTION, STUCK)), "secondary", "primary", 0.0, 0.05)
    assert two.drive_torque.values == pytest.approx(one.drive_torque.values, abs=1e-6)


def test_load_follows_the_square_of_the_speed() -> None:
    """Bristles under N = m r Ω² are the row with the friction µ N, whose loss is known."""
    mu, mass_radius, speeds, sweep = 0.02, 0.05, np.array([50.0, 100.0, 150.0]), 0.1
    law = LuGre(mu / 1e-7, 0.0, mu, mu, 0.1)
    loop = hysteresis(shoes(law, NormalLoad(centrifugal=mass_radius)), "primary", "secondary", speeds, sweep)
    fine = np.linspace(0, sweep, 100_001)
    for speed, loss in zip(speeds, loop.loss.values[:, 0], strict=True):
        friction = mu * mass_radius * speed**2
        curve = loading(fine, friction)
        assert loss == pytest.approx(8 * np.trapezoid(curve, fine) - 4 * curve[-1] * sweep, rel=2e-3)
    guides = loop.element.values[loop.rubs.values == 1]
    pressed = loop.normal_load.sel(element=guides).values
    assert pressed == pytest.approx(
        np.broadcast_to((mass_radius * speeds**2)[:, None, None, None, None], pressed.shape)
    )


def test_load_follows_the_springs() -> None:
    """One spring in series with one that presses the shoe: the torque is F = k φ/(2 ∓ 2s) while the shoe slides.

    T₁ in the spring at the primary, T₂ at the secondary, µ s (|T₁| + |T₂|) between them, the twists adding to φ.
    """
    mu, share, stiffness, sweep = 0.1, 2.0, 5e3, 0.1
    parts: dict[str, Component] = {name: Inertia(1.0) for name in ("a", "b", "shoe")}
    parts |= {"one": Shaft("shoe", "a", stiffness), "two": Shaft("b", "shoe", stiffness)}
    load = NormalLoad(shares={"one": share, "two": share})
    parts["guide"] = Coupling("a", "shoe", LuGre(mu / 1e-7, 0.0, mu, mu, 0.1), load=load)
    loop = hysteresis(assemble(Powertrain(parts)), "a", "b", 0.0, sweep)
    angle, first, _ = branches(loop)
    kept = mu * share
    ratio = (1 - kept) / (1 + kept)  # of the torques on both sides of the shoe
    up = slice(5, angle.size // 4)
    assert first[up] == pytest.approx(stiffness * angle[up] / (1 + ratio), rel=1e-3)


def test_free_play_between_contacts() -> None:
    """A body between two stops is carried along; the torque is that of the springs in series beyond the play."""
    parts: dict[str, Component] = {name: Inertia(1.0) for name in ("a", "b", "body")}
    parts["left"] = Coupling("body", "a", Contacts.lash(0.02, 1e4))
    parts["right"] = Coupling("b", "body", Contacts.lash(0.04, 1e4))
    loop = hysteresis(assemble(Powertrain(parts)), "a", "b", 0.0, 0.1)
    angle, _, closed = branches(loop)
    expected = 5e3 * np.sign(angle) * np.maximum(np.abs(angle) - 0.03, 0.0)
    assert closed == pytest.approx(expected, abs=1e-6)
    assert abs(loop.loss.item()) < 1e-6 and loop.rubs.sum() == 0


def test_what_acts_elsewhere_is_left_out() -> None:
    """What hangs on one side alone is left out, as is what is tied to the ground."""
    plain = pair(spring=Shaft("b", "a", 1e3))
    more: dict[str, Component] = {"c": Inertia(1.0), "d": Inertia(1.0), "drag": Damper("a", damping=5.0)}
    more |= {"left": Coupling("a", "c", Contacts.lash(0.1, 1e3)), "right": Shaft("b", "d", 500.0)}
    loaded = pair(spring=Shaft("b", "a", 1e3), **more)
    loops = [hysteresis(system, "a", "b", 100.0, 0.1) for system in (plain, loaded)]
    assert loops[1].element.values.tolist() == ["spring"]
    assert loops[1].drive_torque.values == pytest.approx(loops[0].drive_torque.values, abs=1e-9)


# --- integration in time ---


@pytest.mark.parametrize(("rate", "half", "stiffness", "viscous"), [(0.3, 0.03, 6e3, 0.02), (0.02, 0.06, 2e3, 0.05)])
def test_two_shoes_integrated_with_their_inertia(rate: float, half: float, stiffness: float, viscous: float) -> None:
    """Shoes so light that their inertia hardly counts, by LSODA: at the fast pace they slide, at the slow one they
    stick and slip, since friction falls from 1.3 to 1 at rates above 0.05 rad/s."""
    load, inertia, bristles, width = 10.0, 1e-6 if rate < 0.1 else 1e-5, 5e3, 0.05
    law = LuGre(bristles, 1e-4 * bristles, 1.0, 1.3, width, viscous_damping=viscous)
    parts: dict[str, Component] = {"a": Inertia(1.0), "b": Inertia(1.0)}
    for name in ("s1", "s2"):
        parts |= {name: Inertia(inertia), f"{name}_guide": Coupling("a", name, law, load=NormalLoad(constant=load))}
    for name, ends in {"k1": ("s1", "a"), "k2": ("s2", "s1"), "k3": ("b", "s2")}.items():
        parts[name] = Shaft(*ends, stiffness)
    loop = hysteresis(assemble(Powertrain(parts)), "a", "b", 0.0, half, rate=rate)
    period = 4 * half / rate

    def angle(time: Array) -> Array:
        return np.asarray(half * 2 / np.pi * np.arcsin(np.sin(2 * np.pi * time / period)))

    def rates(time: float, state: Array) -> list[float]:
        turned, pace = float(angle(np.array(time))), rate * np.sign(np.cos(2 * np.pi * time / period))
        torques = stiffness * np.diff([turned, state[0], state[3], 0.0])
        found: list[float] = []
        for i, (_, speed, bent) in enumerate(state.reshape(2, 3)):
            slide = speed - pace
            bending = slide - bristles * abs(slide) * bent / (1.0 + 0.3 * np.exp(-((slide / width) ** 2)))
            friction = load * (bristles * bent + 1e-4 * bristles * bending + viscous * slide)
            found += [speed, (torques[i + 1] - torques[i] - friction) / inertia, bending]
        return found

    times = np.linspace(period, 2 * period, 2881)
    run = solve_ivp(rates, (0, 2 * period), np.zeros(6), "LSODA", times, rtol=1e-7, atol=1e-9, max_step=period / 400)
    closed, torque = angle(times), stiffness * run.y[3]
    assert loop.loss.item() == pytest.approx(float(loss_per_cycle(closed, torque)), rel=1e-3)
    assert loop.stiffness.item() == pytest.approx(float(secant_stiffness(closed, torque)), rel=1e-6)


# --- numbers of the method ---


def test_breakaway_above_sliding_does_not_depend_on_the_step() -> None:
    """Stick-slip jumps lose what the law says, however many steps a cycle has."""
    law = LuGre(1.0 / 2e-4, 1.0 / 2e-4 * 1e-5, 1.0, 1.3, 0.1, viscous_damping=0.05)
    system = shoes(law, NormalLoad(constant=20.0))
    found = [hysteresis(system, "primary", "secondary", 0.0, 0.1, samples=n) for n in (360, 1440)]
    assert found[0].loss.item() == pytest.approx(found[1].loss.item(), rel=0.02)
    dry = hysteresis(shoes(Jenkins(20.0, 1e5)), "primary", "secondary", 0.0, 0.1).loss.item()
    assert dry < found[1].loss.item() < 1.3 * dry


def test_rows_alike_are_solved_once_and_told_each() -> None:
    single, three = (shoes(Jenkins(FRICTION, STUCK), rows=n) for n in (1, 3))
    (part,) = parts_of(on_bench(three, "primary", "secondary").system.connections)
    assert part.elements.shape == (3, 2 * SPRINGS - 1) and part.columns.shape == (3, SPRINGS - 1)
    one, all_three = (hysteresis(s, "primary", "secondary", 0.0, 0.05) for s in (single, three))
    assert all_three.drive_torque.values == pytest.approx(3 * one.drive_torque.values, rel=1e-9, abs=1e-9)
    assert all_three.sliding.item() == 3 * one.sliding.item()
    named = [all_three.torque.sel(element=f"spring_{row}_2").values for row in range(3)]
    assert all((other == named[0]).all() for other in named)


def test_rows_that_differ_are_not_taken_for_alike() -> None:
    parts: dict[str, Component] = {"a": Inertia(1.0), "b": Inertia(1.0)}
    for row, limit in enumerate((5.0, 20.0)):
        parts[f"s{row}"] = Inertia(1e-3)
        parts |= {f"l{row}": Shaft(f"s{row}", "a", 1e3), f"r{row}": Shaft("b", f"s{row}", 1e3)}
        parts[f"g{row}"] = Coupling("a", f"s{row}", Jenkins(limit, STUCK))
    loop = hysteresis(assemble(Powertrain(parts)), "a", "b", 0.0, 0.1)
    assert len(parts_of(on_bench(assemble(Powertrain(parts)), "a", "b").system.connections)) == 2
    expected = [4 * f * (0.05 - 0.5 * f / 1e3) for f in (5.0, 20.0)]
    assert loop.element_loss.sel(element=["g0", "g1"]).values.ravel() == pytest.approx(expected, rel=5e-3)


def test_about_an_angle() -> None:
    law = Hinges.staged([(500.0, 1e4), (2000.0, 4e4)])
    loop = hysteresis(pair(spring=Coupling("b", "a", law)), "a", "b", 0.0, 0.005, centre=0.08)
    assert loop.stiffness.item() == pytest.approx(4e4)
    assert loop.drive_angle.values.min() == pytest.approx(0.075) and loop.drive_angle.values.max() == pytest.approx(
        0.085
    )


def test_slow_sweeps_lose_what_dampers_take() -> None:
    """c φ̇ with a triangle: the torque is ±c times the rate, 4 A c times the rate a cycle."""
    loop = hysteresis(pair(spring=Shaft("b", "a", 1e3, damping=50.0)), "a", "b", 0.0, 0.1, rate=0.2)
    assert loop.loss.item() == pytest.approx(4 * 0.1 * 50.0 * 0.2, rel=1e-2)


def test_within_the_free_play_there_is_no_loss_factor() -> None:
    parts: dict[str, Component] = {"a": Inertia(1.0), "b": Inertia(1.0), "c": Inertia(1.0)}
    parts |= {"play": Coupling("c", "a", Contacts.lash(0.1, 1e4)), "spring": Shaft("b", "c", 1e4, damping=1.0)}
    loop = hysteresis(assemble(Powertrain(parts)), "a", "b", 0.0, [0.04, 0.2])
    assert np.isnan(loop.loss_factor.values[0, 0]) and np.isfinite(loop.loss_factor.values[0, 1])


# --- refusals ---


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"sweep": -0.1}, "sweep"),
        ({"rate": 0.0}, "rate"),
        ({"speed": np.nan}, "speed"),
        ({"samples": 10}, "samples"),
        ({"held": "a"}, "turn as one"),
        ({"held": "nowhere"}, "nowhere"),
    ],
)
def test_refusals(change: dict[str, float], told: str) -> None:
    asked = {"turned": "a", "held": "b", "speed": 0.0, "sweep": 0.1, **change}
    with pytest.raises(ModelError, match=told):
        hysteresis(pair(spring=Shaft("b", "a", 1e3)), **asked)  # type: ignore[arg-type]


def test_nodes_of_different_speed_are_refused() -> None:
    parts = {"gear": GearPair("b", "c", 2.0), "c": Inertia(1.0), "spring": Shaft("b", "a", 1e3)}
    with pytest.raises(ModelError, match="different mean speeds"):
        hysteresis(pair(**parts), "a", "c", 0.0, 0.1)


def test_nothing_between_is_refused() -> None:
    separate = assemble(Powertrain({"a": Inertia(1.0), "b": Inertia(1.0)}, parts=2))
    with pytest.raises(ModelError, match="nothing acts between"):
        hysteresis(separate, "a", "b", 0.0, 0.1)
