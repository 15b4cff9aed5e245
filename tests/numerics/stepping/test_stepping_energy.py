"""The ledger of time steps: nothing is lost, nothing is made, and where a method makes energy it is told."""

from __future__ import annotations

import numpy as np
import pytest
from tests.numerics.stepping.stepping_models import Crank, Link, Push, equations, sine
from tests.numerics.stepping.test_stepping import MEMBERS, marched, rattling, smooth_chain, wall

from torsional.laws import Coulomb, Jenkins, Karnopp, LuGre, Polynomial, Table
from torsional.numerics.arrays import Array
from torsional.numerics.motion.data import Equations
from torsional.numerics.stepping.marching import Count, Entry, March, Settings, Status, begin, march, produced
from torsional.numerics.stepping.plan import prepare

BRISTLES = LuGre(1e3, 3.0, 2.0, breakaway_torque=3.0, stribeck_rate=0.1, viscous_damping=0.4, grease_damping=0.1)
DRIVE = Push([1.0, 0.0], level=((0.0,), (20.0,)), samples=sine(0.2), multiple=9.0)


def with_law(law: object, **more: object) -> Equations:
    links = [Link([1.0, -1.0], 400.0, 0.4), Link([0.0, 1.0], 50.0, 1.0), Link([1.0, -1.0], law=law, **more)]  # type: ignore[arg-type]
    return equations([1.0, 0.5], links, [DRIVE])


def turning() -> Equations:
    """Centrifugal stiffness, dampers that count from rotations, a crank's piston, a connection of three."""
    links = [
        Link([1.0, -2.0, 1.0], 400.0, 0.4, hinges=[wall(0.01, 1e3, 1e-3)], centrifugal=0.1),
        Link([0.0, 1.0, 0.0], 50.0, 1.0, follow=1.0),
        Link([0.0, 0.0, 1.0], 50.0, 1.0, mean_rate=1.0),
    ]
    push = Push([1.0, 0.0, 0.0], level=((0.0, 0.5), (20.0, 40.0)), samples=sine(0.2), feedback=1.0)
    rows = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.5], [0.2, 0.0, 1.0]]
    crank = Crank([1.0, 0.0, 0.0], 2.0, 0.05, 0.15, 0.3, 0.001)
    return equations([0.05, 0.5, 0.3], links, [push], [crank], speed=30.0, reference_time=0.1, mass_rows=rows)


def imbalance(found: March) -> float:
    """What the ledger does not explain, over the throughput."""
    ledger: Array = found.records.ledger
    stored = ledger[:, Entry.KINETIC] + ledger[:, Entry.STRAIN]
    lost = ledger[:, Entry.DAMPED] + ledger[:, Entry.STRUCK] + ledger[:, Entry.RUBBED]
    open_ = stored - ledger[:, Entry.WORKED] + lost - ledger[:, Entry.MADE]
    return float(np.abs(open_ - open_[0]).max() / ledger[-1, Entry.THROUGHPUT])


SYSTEMS = {
    "smooth": smooth_chain(),
    "rattling": rattling(),
    "turning": turning(),
    "polynomial": with_law(Polynomial((10.0, 0.0, 1e3))),
    "coulomb": with_law(Coulomb(3.0, 0.05)),
    "jenkins": with_law(Jenkins(4.0, 500.0)),
    "karnopp": with_law(Karnopp(2.0, 3.0, 0.05, 800.0)),
    "bristles": with_law(BRISTLES),
    "pressed bristles": with_law(BRISTLES, load=(0.2, 0.0, [(0, 0.05)])),
}


@pytest.mark.parametrize("method", ["newmark", "chung_hulbert_0.8", "bossak_0"])
@pytest.mark.parametrize("name", SYSTEMS)
def test_the_ledger_is_closed(name: str, method: str) -> None:
    n = SYSTEMS[name].coordinates
    found = marched(SYSTEMS[name], 0.0, np.zeros(n), 2.0, 4000, MEMBERS[method], stride=10)
    assert found.status == Status.DONE
    assert imbalance(found) <= 1e-11
    made, through = np.abs(found.records.ledger[-1, [Entry.MADE, Entry.THROUGHPUT]])
    assert made <= 2e-3 * through, "a ledger that books its own errors as the method's is closed as well"
    for lost in (Entry.DAMPED, Entry.STRUCK):
        assert (np.diff(found.records.ledger[:, lost]) >= -1e-9 * through).all()


def test_nothing_is_made_in_a_linear_chain_by_the_average_acceleration() -> None:
    found = marched(smooth_chain(), 0.0, 0.0, 10.0, 20_000, MEMBERS["newmark"], stride=100)
    assert abs(found.records.ledger[-1, Entry.MADE]) <= 1e-13 * found.records.ledger[-1, Entry.THROUGHPUT]
    assert found.records.ledger[-1, Entry.DAMPED] > 0.1 * found.records.ledger[-1, Entry.THROUGHPUT]


def test_energy_of_a_free_run_of_a_million_steps() -> None:
    links = [Link([1.0, -1.0, 0.0], 400.0), Link([0.0, 1.0, -1.0], 900.0), Link([0.0, 0.0, 1.0], 50.0)]
    free = equations([1.0, 0.5, 2.0], links)
    start = [0.1, -0.05, 0.02], [0.0, 1.0, 0.0]
    found = marched(free, *start, 1e4, 1_000_000, MEMBERS["newmark"], stride=1000)
    energy = found.records.ledger[:, Entry.KINETIC] + found.records.ledger[:, Entry.STRAIN]
    assert np.abs(energy / energy[0] - 1.0).max() <= 1e-9
    slope = np.polyfit(found.records.time, energy / energy[0], 1)[0]
    assert abs(slope) * 1e4 <= 1e-10


@pytest.mark.parametrize("method", ["newmark", "chung_hulbert_0.8", "chung_hulbert_0.5"])
def test_stiff_elastic_stops_make_energy_unless_guarded(method: str) -> None:
    stops = equations([0.003], [Link([1.0], hinges=[wall(0.01, 1e8), wall(0.01, 1e8, side=-1.0)])])
    wild = marched(stops, 0.0, 1.0, 1.0, 50_000, MEMBERS[method], stride=50_000, settings=Settings(guard=False))
    assert wild.status == Status.PRODUCES
    assert wild.records.ledger[-1, Entry.KINETIC] > 10 * wild.records.ledger[0, Entry.KINETIC]
    held = marched(stops, 0.0, 1.0, 1.0, 50_000, MEMBERS[method], stride=10)
    energy = held.records.ledger[:, Entry.KINETIC] + held.records.ledger[:, Entry.STRAIN]
    assert held.status == Status.DONE
    assert energy.max() <= 1.05 * energy[0] and energy[-1] < energy[0]


def test_soft_contacts_are_not_guarded() -> None:
    runs = [
        marched(rattling(), 0.0, 0.0, 1.0, 4000, MEMBERS["newmark"], settings=Settings(guard=guard))
        for guard in (True, False)
    ]
    assert np.array_equal(runs[0].records.q, runs[1].records.q), "h·pace is 0.03 at most"
    stiff = equations([1.0], [Link([1.0], 1.0, hinges=[wall(0.0, 1e6)])])
    runs = [
        marched(stiff, -0.01, 1.0, 0.1, 100, MEMBERS["newmark"], settings=Settings(guard=guard))
        for guard in (True, False)
    ]
    assert not np.array_equal(runs[0].records.q, runs[1].records.q), "h·pace is 1"


def test_bristles_stick_and_slip() -> None:
    """A unit mass on a spring of 2, whose other end is pulled at 0.1: by what cannot be held, a mass of 1e12."""
    law = LuGre(1e5, 1e5**0.5, 1.0, breakaway_torque=1.5, stribeck_rate=0.001, viscous_damping=0.4)
    pulled = equations([1.0, 1e12], [Link([1.0, -1.0], 2.0), Link([1.0, 0.0], law=law)])
    found = marched(pulled, 0.0, [0.0, 0.1], 40.0, 200_000, MEMBERS["chung_hulbert_0.8"])
    v, t = found.records.v[:, 0], found.records.time
    up = np.flatnonzero((v[1:] > 0.02) & (v[:-1] <= 0.02))
    slips = t[up] + (0.02 - v[up]) / (v[up + 1] - v[up]) * (t[1] - t[0])
    assert slips.size >= 5
    np.testing.assert_allclose(np.diff(slips), 6.363, atol=1e-3)
    assert found.count(Count.SOLVES) < 1.1 * found.count(Count.STEPS)


def test_bristles_that_slide_steadily_bear_what_the_curve_tells() -> None:
    law = LuGre(1e5, 1e5**0.5, 1.0, breakaway_torque=1.5, stribeck_rate=0.001, viscous_damping=0.4)
    slid = equations([1e12], [Link([1.0], law=law)])
    found = marched(slid, 0.0, 0.001, 0.5, 5000, MEMBERS["chung_hulbert_0.8"])
    assert found.records.torque[-1, 0] == pytest.approx(1.1843397206, rel=1e-9)


def test_stiff_bristles_over_long_steps_give_no_energy() -> None:
    held = equations([1.0], [Link([1.0], 100.0), Link([1.0], law=LuGre(1e8, 1e4, 1.0, 1.5, 0.001))])
    found = marched(held, 0.0, 1.0, 1.0, 100, MEMBERS["newmark"])
    energy = found.records.ledger[:, Entry.KINETIC]
    assert energy.max() <= 1.01 * energy[0] or found.status == Status.PRODUCES
    assert energy.max() <= 2.0 * energy[0]


def test_production_of_a_part_of_a_march() -> None:
    ledger, before = np.zeros((2, len(Entry)))
    ledger[[Entry.MADE, Entry.THROUGHPUT]], before[Entry.MADE] = (-1.0, 100.0), -3.0
    assert produced(ledger) == 0.0 and produced(ledger, before) == pytest.approx(0.02)
    assert produced(before) == 0.0


def test_a_start_in_contact_and_with_memory_is_in_balance() -> None:
    plan = prepare(with_law(Jenkins(4.0, 500.0)))
    state = begin(plan, [0.1, 0.0], [0.0, 0.3], memory=[0.004])
    torque = np.array([400 * 0.1 - 0.4 * 0.3, 50 * 0.0 + 0.3, 500 * 0.004])
    pushed = 20.0 * np.sin(0.2)
    wanted = [(pushed - torque[0] - torque[2]) / 1.0, (torque[0] + torque[2] - torque[1]) / 0.5]
    np.testing.assert_allclose(state.coordinates[2], wanted, rtol=1e-7)
    first = march(plan, MEMBERS["newmark"], 1e-7, 1, state).records.acceleration[1]
    np.testing.assert_allclose(first, wanted, rtol=1e-4)


@pytest.mark.parametrize("step", [1e-3, 1e-4])
def test_a_stiff_curve_makes_energy_and_that_is_told(step: float) -> None:
    """Stops as a smooth law: what the mean torque misses of its integral is the method's own, not strain."""
    curve = Table(((-0.02, -1e6), (-0.01, 0.0), (0.0, 0.0), (0.01, 0.0), (0.02, 1e6)))
    stops = equations([0.003], [Link([1.0], law=curve)])
    steps = round(1.0 / step)
    found = marched(stops, 0.0, 1.0, 1.0, steps, MEMBERS["newmark"], stride=steps // 100)
    ledger = found.records.ledger
    gained = ledger[:, Entry.KINETIC].max() / ledger[0, Entry.KINETIC] - 1.0
    assert gained > 0.05, "the case makes energy"
    assert found.status == Status.PRODUCES
    most = ledger[:, Entry.KINETIC].max()
    assert imbalance(found) * ledger[-1, Entry.THROUGHPUT] <= 1e-9 * most
    assert ledger[:, Entry.STRAIN].min() >= -0.01 * most, "no energy is hidden as strain below nought"


def test_a_ledger_that_overflows_is_told() -> None:
    found = marched(equations([1.0], [Link([1.0], 100.0)]), 0.0, 1e160, 1.0, 100, MEMBERS["newmark"])
    assert found.status == Status.NOT_FINITE


@pytest.mark.parametrize(("own", "share"), [(0.0, 1.0), (2.5e-4, 0.5), (6e-4, 0.0)])
def test_what_the_guard_takes_is_told_apart_from_what_contacts_lose(own: float, share: float) -> None:
    """A contact that stays closed, ringing under a load: half a step of 1 ms, of which it has a part of its own."""
    pressed = equations([1.0], [Link([1.0], hinges=[wall(0.0, 1e6, own)])], [Push([1.0], level=((0.0,), (1e3,)))])
    found = marched(pressed, 1.5e-3, 0.0, 0.1, 100, MEMBERS["newmark"])
    struck, taken = found.records.ledger[-1, Entry.STRUCK], found.state.passed[2, 0]
    assert struck > 0.01
    assert taken == pytest.approx(share * struck, rel=1e-12)
