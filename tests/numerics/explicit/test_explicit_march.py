"""The explicit integrator against closed forms, exact piecewise motion and scipy's DOP853."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from tests.numerics.stepping.stepping_arrays import Connection, Governor, Source, equations
from tests.validation import dmf_lcp

from torsional.engine import SliderCrank
from torsional.errors import ModelError
from torsional.laws import Jenkins, LuGre, Table
from torsional.numerics.explicit.march import explicit_march
from torsional.numerics.motion.data import rows_of
from torsional.numerics.piecewise.basis import StageBases
from torsional.numerics.piecewise.motion import PiecewiseMotion

TWO_PI = 2.0 * np.pi
COSINE = (np.cos(TWO_PI * np.arange(4096) / 4096), 1.0)


# --- closed forms ----------------------------------------------------------------------------------------------------


def test_a_damped_oscillator() -> None:
    """J 2, k 50, c 1: e^−Dt (cos ωt + …), to the tolerance and no worse for a long run."""
    found = explicit_march(equations([2.0], [Connection([1.0], 50.0, 1.0)]), [0.0, 1.0, 20.0], [0.1], [0.0])
    omega, decay = np.sqrt(25.0 - 0.0625), 0.25
    t = found.times
    exact = 0.1 * np.exp(-decay * t) * (np.cos(omega * t) + decay / omega * np.sin(omega * t))
    np.testing.assert_allclose(found.angles[:, 0], exact, atol=2e-9 * 0.1)


def test_the_error_follows_the_tolerance() -> None:
    free, exact, miss = equations([1.0], [Connection([1.0], 1.0)]), [np.cos(30.0), -np.sin(30.0)], []
    for tolerance in (1e-6, 1e-8, 1e-10):
        end = explicit_march(free, [0.0, 30.0], [1.0], [0.0], tolerance=tolerance).states[-1, :2]
        miss.append(np.hypot(*(end - exact)))
        assert miss[-1] < 30.0 * tolerance
    assert miss[0] > 30.0 * miss[1] > 900.0 * miss[2]


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_contact_of_pi_tenths(side: float) -> None:
    """m = 1, k = 100, gap 0.1, v = 1: contact lasts π/10 s and gives v = −1."""
    wall = equations([1.0], [Connection([1.0], hinges=[(0.1 * side, side, 100.0, 0.0)])])
    found = explicit_march(wall, [0.0, 0.1 + 0.1 * np.pi, 0.8], [0.0], [side], tolerance=1e-12)
    np.testing.assert_allclose(found.rates[1:, 0], [-side, -side], atol=1e-9)
    np.testing.assert_allclose(found.angles[1:, 0], [0.1 * side, side * (0.2 + 0.1 * np.pi - 0.8)], atol=1e-9)


def test_a_load_that_jumps_and_a_frame_that_speeds_up() -> None:
    """The frame moves the sources alone; a jump stands at the end of a step, whatever the times asked for."""
    system = equations(
        [2.0], [Connection([1.0])],
        sources=[Source([1.0], level=0), Source([1.0], level=1, profile=0, multiple=3.0, phase=0.5)],
        levels=[([0.0, 0.3, 0.3], [4.0, 4.0, -8.0]), (0.0, 10.0)], profiles=[COSINE], frame=([0.0, 1.0], [7.0, 7.0]),
    )  # fmt: skip
    found = explicit_march(system, [0.0, 1.0], [0.0], [0.0], tolerance=1e-12)
    exact = (4.0 * 0.3 - 8.0 * 0.7 + 10.0 / 21.0 * (np.sin(21.5) - np.sin(0.5))) / 2.0
    assert found.rates[-1, 0] == pytest.approx(exact, rel=1e-11)
    assert found.steps < 2000


def test_the_reference_rotation_follows_the_first_coordinate() -> None:
    """J v' = −c (v − δ), δ' = (v − δ)/T with δ = Ω_r − Ω_f: v − δ fades with c/J + 1/T."""
    drag = Connection([1.0], damping=3.0, follow=1.0)
    system = equations([2.0], [drag], reference_time=0.5, frame=([0.0], [100.0]))
    found = explicit_march(system, [0.0, 0.4], [0.0], [5.0], tolerance=1e-12, reference_speed=100.0)
    rate = 3.0 / 2.0 + 2.0
    exact = 5.0 - 1.5 * 5.0 / rate * (1.0 - np.exp(-rate * 0.4))
    assert found.rates[-1, 0] == pytest.approx(exact, rel=1e-10)
    along = explicit_march(system, [0.0, 0.4], [0.0], [5.0])
    assert along.rates[-1, 0] == 5.0 and along.references.tolist() == [105.0, 105.0]
    held = explicit_march(equations([2.0], [drag], frame=([0.0], [100.0])), [0.0, 0.4], [0.0], [5.0])
    assert held.rates[-1, 0] == pytest.approx(5.0 * np.exp(-0.6), rel=1e-9)


def test_a_brake_acts_on_the_whole_speed() -> None:
    system = equations([2.0], [Connection([1.0], damping=3.0, mean_rate=1.0)], frame=([0.0], [100.0]))
    found = explicit_march(system, [0.0, 0.4], [0.0], [0.0], tolerance=1e-12)
    assert found.rates[-1, 0] == pytest.approx(100.0 * (np.exp(-0.6) - 1.0), rel=1e-10)


def test_a_rotating_spring_stiffens_with_the_square_of_speed() -> None:
    """Against ground from a reference of its own that nothing disturbs: ω² = (k + k' Ω²)/J."""
    system = equations([1e9, 2.0], [Connection([0.0, 1.0], 10.0, centrifugal=0.02)], frame=([0.0], [50.0]))
    found = explicit_march(system, [0.0, 3.0], [0.0, 0.1], [10.0, 0.0], tolerance=1e-11)
    assert found.angles[-1, 1] == pytest.approx(0.1 * np.cos(3.0 * np.sqrt((10.0 + 0.02 * 60.0**2) / 2.0)), abs=1e-8)


def test_a_governor_is_a_second_order_system() -> None:
    """J e' = −k_p e − ∫ k_i e: roots of J s² + k_p s + k_i, here 1 and 2 1/s."""
    governor = Governor([1.0], [1.0], 0, proportional=6.0, integral=4.0)
    system = equations([2.0], [Connection([1.0])], governors=[governor], levels=[(0.0, 60.0)], frame=([0.0], [50.0]))
    found = explicit_march(system, [0.0, 0.7], [0.0], [0.0], tolerance=1e-12)
    error = 60.0 - 50.0 - found.rates[-1, 0]
    assert error == pytest.approx(10.0 * (2.0 * np.exp(-1.4) - np.exp(-0.7)), rel=1e-9)
    limited = Governor([1.0], [1.0], 0, proportional=6.0, integral=4.0, limit=5.0)
    system = equations([2.0], [Connection([1.0])], governors=[limited], levels=[(0.0, 60.0)], frame=([0.0], [50.0]))
    assert explicit_march(system, [0.0, 0.7], [0.0], [0.0]).rates[-1, 0] == pytest.approx(2.5 * 0.7, rel=1e-10)


def test_a_governor_adds_to_the_levels_of_its_sources() -> None:
    governor = Governor([1.0], [0.0], 1, proportional=6.0, integral=0.0, sources=[0])
    system = equations([2.0], [Connection([1.0])], sources=[Source([1.0], level=0)], governors=[governor],
                       levels=[(0.0, 3.0), (0.0, 10.0)])  # fmt: skip
    found = explicit_march(system, [0.0, 0.4], [0.0], [0.0], tolerance=1e-12)
    assert found.rates[-1, 0] == pytest.approx(10.5 * (1.0 - np.exp(-3.0 * 0.4)), rel=1e-10)


def test_a_free_crank_keeps_its_energy() -> None:
    """½ (J + m x'²) θ̇² of one piston on a light rotor, an offset pin, and half the mass in the rotor already."""
    crank, mass = SliderCrank(0.08, 0.25, 0.01), 4.0
    included = crank.half_share(mass)
    piston = ([1.0], 1.0, 0.4, mass, 0.08, 0.25, 0.01, included)
    system = equations([0.05 + included], [Connection([1.0])], cranks=[piston], frame=([0.0], [100.0]))
    found = explicit_march(system, np.linspace(0.0, 0.5, 40), [0.0], [3.0], tolerance=1e-12)
    angle = 100.0 * found.times + found.angles[:, 0] + 0.4
    energy = (0.05 + crank.inertia(mass, angle)) * (100.0 + found.rates[:, 0]) ** 2
    np.testing.assert_allclose(energy, energy[0], rtol=2e-9)
    assert np.ptp(found.rates) > 10.0


# --- laws ------------------------------------------------------------------------------------------------------------


def test_a_law_without_memory_is_its_kernel() -> None:
    """A table's torque on one mass: energy of the swing, by the integral of the table."""
    law = Table(((-1.0, -50.0), (0.0, 0.0), (1.0, 30.0), (2.0, 200.0)))
    found = explicit_march(equations([2.0], [Connection([1.0], law=law)]), [0.0, 1.3], [0.8], [0.0], tolerance=1e-12)
    x = np.linspace(found.angles[-1, 0], 0.8, 200_001)
    work = np.trapezoid(law.torque(x), x)
    assert found.rates[-1, 0] ** 2 == pytest.approx(work, rel=1e-8)


BRISTLES = LuGre(1e5, 1e5**0.5, 1.0, breakaway_torque=1.5, stribeck_rate=0.001, viscous_damping=0.4)
FLOWS = {BRISTLES.address: BRISTLES.flow_address}


def test_stick_and_slip_of_bristles() -> None:
    """A unit mass on a spring of 2 pulled at 0.1: a period of 6.363 s (± 0.001); z is a state here."""
    pulled = [Connection([1.0], 2.0), Connection([1.0], law=BRISTLES, mean_rate=1.0)]
    system = equations([1.0], pulled, frame=([0.0], [0.1]))
    times = np.arange(0.0, 28.0, 1e-3)
    found = explicit_march(system, times, [0.0], [-0.1], tolerance=1e-8, flows=FLOWS)
    speed = found.rates[:, 0] + 0.1
    jumps = times[1:][(speed[1:] > 0.1) & (speed[:-1] <= 0.1)]
    np.testing.assert_allclose(np.diff(jumps), 6.363, atol=1e-3)


def test_bristles_under_a_changing_normal_load_against_scipy() -> None:
    """N = max(0, 2 + 0.5 sin-like level + 1e-3 Ω² + 0.3 |spring|) on one rotor."""
    friction = Connection([1.0, -1.0], law=BRISTLES, load=(2.0, 0, 1e-3), load_of=[(0, 0.3)])
    parts = [Connection([1.0, -1.0], 300.0, 0.5), friction]
    system = equations([2.0, 1.0], parts, sources=[Source([0.0, 1.0], level=1)],
                       levels=[([0.0, 1.0], [1.0, 0.2]), ([0.0, 1.0], [0.0, 40.0])], frame=([0.0], [30.0]))  # fmt: skip

    def rates(t: float, y: np.ndarray) -> list[float]:
        angle, u, z = y[0] - y[1], y[2] - y[3], y[4]
        elastic = 300.0 * angle + 0.5 * u
        load = max(0.0, 2.0 * (1.0 - 0.8 * t) + 1e-3 * (30.0 + y[2]) ** 2 + 0.3 * abs(elastic))
        curve = 1.0 + 0.5 * np.exp(-((u / 0.001) ** 2))
        bent = u - 1e5 * abs(u) / curve * z
        torque = elastic + load * (1e5 * z + 1e5**0.5 * bent + 0.4 * u)
        return [y[2], y[3], -torque / 2.0, torque + 40.0 * t, bent]

    exact = solve_ivp(rates, (0.0, 1.0), np.array([0.0, 0.0, 0.0, 1.0, 0.0]), method="LSODA", rtol=1e-10, atol=1e-13)
    found = explicit_march(system, [0.0, 1.0], [0.0, 0.0], [0.0, 1.0], tolerance=1e-9, flows=FLOWS)
    np.testing.assert_allclose(found.states[-1, :4], exact.y[:4, -1], rtol=1e-6)
    assert found.states[-1, -1] == pytest.approx(exact.y[4, -1], rel=1e-6)


def test_a_spring_that_sticks_and_slides() -> None:
    """J 1 on a spring of 100 from −1 beside a slider of 5 and 1000: while it slides, J φ″ = −k φ ± F; at the end of the
    first swing the spring has lost what the slider took."""
    washer = Jenkins(5.0, 1000.0)
    system = equations([1.0], [Connection([1.0], 100.0), Connection([1.0], law=washer)])
    times = np.linspace(0.0, 0.25, 26)
    found = explicit_march(system, times, [-1.0], [0.0], tolerance=1e-9, flows={washer.address: washer.flow_address})
    stuck = np.sqrt(1100.0)  # from rest, about −1 + 100/1100, to the deflection 0.005
    slips = np.arccos(1.0 - 0.005 * 1100.0 / 100.0) / stuck
    speed = 100.0 / stuck * np.sin(stuck * slips)
    later = times[times > slips]
    turned = 10.0 * (later - slips)
    exact = 0.05 * -1.0 + (-0.995 + 0.05) * np.cos(turned) + 0.1 * speed * np.sin(turned)
    np.testing.assert_allclose(found.angles[times > slips, 0], exact, atol=1e-6)
    np.testing.assert_allclose(found.memories[times > slips, 1], 0.005, rtol=1e-6)
    np.testing.assert_allclose(found.accelerations[0], [100.0])


def test_a_march_goes_on_from_where_another_ended() -> None:
    """Memory, the governor's integral and the reference rotation are part of the state."""
    governor = Governor([1.0, 0.0], [1.0, 0.0], 0, proportional=6.0, integral=4.0)
    parts = [
        Connection([1.0, -1.0], 300.0),
        Connection([1.0, -1.0], law=BRISTLES),
        Connection([0.0, 1.0], 0.0, 2.0, follow=1.0),
    ]
    system = equations([2.0, 1.0], parts, governors=[governor], levels=[(0.0, 60.0)], frame=([0.0], [50.0]),
                       reference_time=0.3)  # fmt: skip
    options = {"tolerance": 1e-10, "flows": FLOWS}
    whole = explicit_march(system, [0.0, 0.2, 0.4], [0.0, 0.0], [0.0, 3.0], **options)
    second = explicit_march(system, [0.2, 0.4], whole.angles[1], whole.rates[1], **options, integral=whole.integrals[1],
                            reference_speed=whole.references[1], memory=whole.memories[1])  # fmt: skip
    np.testing.assert_allclose(second.states[-1], whole.states[-1], rtol=1e-7)
    assert np.abs(whole.memories[1, 1]) > 1e-7 and whole.integrals[1, 0] > 1.0 and whole.references[1] > 50.1


# --- other integrators -----------------------------------------------------------------------------------------------


def test_exact_motion_of_hinges() -> None:
    """Two masses on a staged spring with lash under a mean load and a cosine, from rest, over 20 periods."""
    law, omega = [0.0, 0.02, 1.0, 900.0, -0.02, -1.0, 900.0, 0.1, 1.0, 2000.0], 25.0
    mass, damping, stiffness = np.diag([1.0, 2.0]), [[0.4, 0.0], [0.0, 0.0]], [[50.0, 0.0], [0.0, 0.0]]
    bases = StageBases(mass, damping, stiffness, [[-1.0, 1.0]], [law])
    loads = np.array([[0.0, 30.0], [60.0, 0.0]])
    exact = PiecewiseMotion(bases, loads, omega)
    end = exact.flow(np.zeros(bases.coordinates.size), 20).state
    hinges = [(0.02, 1.0, 900.0, 0.0), (-0.02, -1.0, 900.0, 0.0), (0.1, 1.0, 2000.0, 0.0)]
    system = equations(
        [1.0, 2.0], [Connection([1.0, 0.0], 50.0, 0.4), Connection([-1.0, 1.0], hinges=hinges)],
        sources=[Source([1.0, 0.0], level=0, profile=0), Source([0.0, 1.0], level=1)],
        levels=[(0.0, 60.0), (0.0, 30.0)], profiles=[COSINE], frame=([0.0], [omega]),
    )  # fmt: skip
    found = explicit_march(system, [0.0, 20 * TWO_PI / omega], [0.0, 0.0], [0.0, 0.0], tolerance=1e-12)
    np.testing.assert_allclose(found.angles[-1], bases.coordinates.angles(end), atol=1e-9)
    np.testing.assert_allclose(found.rates[-1], bases.coordinates.rates(end), atol=1e-8)


def test_two_channels_of_shoes() -> None:
    """DMF-LCP-1 at 0.02, 0.05 and 0.10 s: the published figures, and scipy's DOP853 to more digits."""
    rest, times = np.zeros(dmf_lcp.NODES), [0.0, 0.02, 0.05, 0.1]
    found = explicit_march(dmf_lcp.Flywheel().equations(4096), times, rest, rest, tolerance=1e-12)
    seen = dmf_lcp.observed(found.states)
    np.testing.assert_allclose(seen[1:], np.array(dmf_lcp.REFERENCE)[:, 1:], rtol=3e-9, atol=1e-12)
    np.testing.assert_allclose(seen[1:, :3], np.array(dmf_lcp.REFERENCE)[:, 1:4], rtol=2e-11)
    start = np.zeros(2 * dmf_lcp.NODES)
    exact = solve_ivp(dmf_lcp.right_hand_side, (0.0, 0.02), start, method="DOP853", rtol=1e-12, atol=1e-14)
    np.testing.assert_allclose(found.angles[1], exact.y[: dmf_lcp.NODES, -1], atol=2e-11)
    np.testing.assert_allclose(found.rates[1], exact.y[dmf_lcp.NODES :, -1], atol=1e-7)


# --- refusals --------------------------------------------------------------------------------------------------------


def test_what_cannot_be_integrated_is_refused() -> None:
    with pytest.raises(ModelError, match="memory has no rate"):
        explicit_march(equations([1.0], [Connection([1.0], law=Jenkins(10.0, 1.0))]), [0.0, 1.0], [0.0], [0.0])
    light = equations([1.0, 1.0], [Connection([1.0, -1.0], 1.0)])._replace(mass_rows=rows_of(np.array([[1.0, 0.0]])))
    with pytest.raises(ModelError, match="mass at every coordinate"):
        explicit_march(light._replace(inertia=np.ones(1)), [0.0, 1.0], [0.0, 0.0], [0.0, 0.0])
    oscillator = equations([1.0], [Connection([1.0], 1.0)])
    with pytest.raises(ModelError, match="times must rise"):
        explicit_march(oscillator, [0.0, 0.0], [0.0], [0.0])
    with pytest.raises(ModelError, match="did not arrive"):
        explicit_march(oscillator, [0.0, 1e3], [1.0], [0.0], most_steps=50)
