"""Invariants of motion in time over random networks with stages, lash, contacts, friction, gears and planetary sets."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr
from tests.properties.test_periodic import random_machine
from tests.random_models import Network, random_network
from tests.solvers.periodic.machines import picked, respond

from torsional.components import Component, Coupling, GearPair, Inertia, PlanetaryGear, Shaft
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.laws import Contacts, Hinges, Jenkins, Law, LuGre, Table, hinge_rows
from torsional.numerics.contacts.exact import ExactContacts
from torsional.numerics.contacts.step import OneSided
from torsional.numerics.stepping.alpha_method import AlphaMethod
from torsional.numerics.stepping.marching import Entry, Settings, Status, begin, march
from torsional.powertrain import Powertrain
from torsional.solvers.harmonic import harmonic_response
from torsional.solvers.transient import MotionState, TorqueHistory, transient
from torsional.solvers.transient.marching import LEDGER, Accuracy, marched
from torsional.solvers.transient.problem import Problem
from torsional.system import System, assemble

LOSSES = ["dampers", "contacts", "friction"]
GAP = 1e-3
Mirror = Callable[[Law], Law]


def gentle(rng: np.random.Generator, nodes: int, *, damped: bool = True) -> Network:
    """A network of the same shape whose natural frequencies a step of a tenth of a millisecond can follow."""
    net = random_network(rng, nodes, damped=damped)
    inertias = tuple(float(10 ** rng.uniform(-1, 1)) for _ in net.inertias)
    springs = 10 ** rng.uniform(3, 4.5, len(net.shafts))
    dampers = rng.uniform(0.5, 3, len(net.shafts)) * damped
    shafts = zip(net.shafts, springs.tolist(), dampers.tolist(), strict=True)
    return Network(inertias, tuple((a, b, k, c) for (a, b, *_), k, c in shafts), net.gears)


def hinges(rng: np.random.Generator, k: float) -> Law:
    """Stages, play, or play whose contacts take time, none of them symmetrical."""
    low, high = float(rng.uniform(0.2, 1.0)) * GAP, float(rng.uniform(0.2, 1.0)) * GAP
    kind = int(rng.integers(3))
    if kind == 0:
        return Hinges(k, (high, -low), (1.0, -1.0), (2.0 * k, 0.5 * k))
    if kind == 1:
        return Hinges(0.0, (high, -low), (1.0, -1.0), (k, k))
    return Contacts.between(-low, high, k, 2e-5)


def friction(rng: np.random.Generator, k: float) -> Law:
    """A washer or bristles that slide at the torques of a gap or two."""
    limit = float(rng.uniform(0.1, 1.0)) * k * GAP
    if rng.integers(2):
        return Jenkins(limit, 3.0 * k)
    return LuGre(3.0 * k, 3e-3 * k, limit, 1.3 * limit, 0.05, 1e-5 * k)


def machine(net: Network, seed: int, *, rub: bool = True, of: Mirror = lambda law: law) -> dict[str, Component]:
    """The network with laws in place of most shafts, friction beside some, and a planetary set at its first disc."""
    rng, parts = np.random.default_rng(seed), net.components()
    for s, (a, b, k, c) in enumerate(net.shafts):
        bends, law, rubs, beside = rng.random() < 0.6, hinges(rng, k), rng.random() < 0.4, friction(rng, k)
        if bends:
            parts[f"s{s}"] = Coupling(f"n{a}", f"n{b}", of(law), c)
        if rubs and rub:
            parts[f"f{s}"] = Coupling(f"n{a}", f"n{b}", beside)
    parts |= {
        "ring": Inertia(0.4),
        "sun": Inertia(0.1),
        "set": PlanetaryGear("sun", "ring", "n0", standing_ratio=-2.5, planet_inertia=0.02, planet_ratio=1.7),
        "hold": Shaft("ring", "n0", 2e4, 2.0 if net.shafts[0][3] else 0.0),
    }
    return parts


def thrown(system: System, seed: int, speed: float = 1.0) -> MotionState:
    """A start with random rates [rad/s] of the coordinates."""
    rates = np.random.default_rng(seed + 7).standard_normal(len(system.coordinates)) * speed
    return MotionState.at_rest(system).moved(0.0, rates)


def energy(net: Network, run: xr.Dataset) -> np.ndarray:
    """Kinetic and strain energy [J] of a network of shafts and gears, by its own numbers."""
    names = [f"n{i}" for i in range(len(net.inertias))]
    rates = run.angular_velocity.sel(node=names).values
    twists = run.twist.sel(element=[f"s{s}" for s in range(len(net.shafts))]).values
    return np.asarray(0.5 * (rates**2 @ np.array(net.inertias) + twists**2 @ np.array([s[2] for s in net.shafts])))


def left_over(run: xr.Dataset) -> float:
    """What the ledger leaves over, of all that was stored, worked and lost."""
    share = (run.energy - run.energy.isel(time=0)).sel(share=list(LEDGER))
    stored = share.sel(share=["kinetic", "strain"]).sum("share")
    left = stored - share.sel(share=["sources", "method"]).sum("share") + share.sel(share=LOSSES).sum("share")
    return float(abs(left).max() / abs(run.energy).max())


def run_of(system: System, seed: int, span: float = 0.1, load: float = 50.0, **given: object) -> xr.Dataset:
    """A run from random rates under a third order at the first disc."""
    unit = Excitation(("n0",), [1.0, 3.0], 60.0, [[0.0, load]])
    start = given.pop("start", None) or thrown(system, seed)
    return transient(system, unit, span, start, speed=60.0, **given)  # type: ignore[arg-type]


def apart(one: np.ndarray, two: np.ndarray) -> float:
    return float(np.abs(one - two).max() / np.abs(two).max())


# --- energy ---


@pytest.mark.parametrize("seed", range(6))
def test_a_free_run_keeps_its_energy(seed: int) -> None:
    """Average acceleration without damping, 1e5 steps: neither scatter nor trend, over eight orders of magnitude."""
    net = random_network(np.random.default_rng(seed), 2 + 3 * seed, damped=False)
    system = assemble(net.powertrain())
    run = transient(system, (), 10.0, thrown(system, seed), speed=0.0, method="newmark", output=0.01)
    held = energy(net, run)
    assert np.abs(held / held[0] - 1.0).max() <= 1e-9
    assert abs(np.polyfit(run.time.values / 10.0, held / held[0], 1)[0]) <= 1e-10


@pytest.mark.parametrize("radius", [1.0, 0.8, 0.0])
@pytest.mark.parametrize("seed", range(8))
def test_the_ledger_balances(seed: int, radius: float) -> None:
    """Stages, play, contacts, friction, gears: what is stored is what was given less what is lost."""
    net = gentle(np.random.default_rng(seed), 3 + seed)
    run = run_of(assemble(Powertrain(machine(net, seed))), seed, 0.2, spectral_radius=radius)
    assert left_over(run) <= 1e-10
    assert abs(run.attrs["method_share"]) < 1e-3
    largest = float(abs(run.energy).max())
    assert float(run.energy.sel(share=LOSSES).diff("time").min()) > -1e-6 * largest


@pytest.mark.parametrize("seed", range(4))
def test_losses_are_those_of_the_linear_response(seed: int) -> None:
    """Ten periods of steady motion: each share of the ledger against ½ Σ c ω² |φ|² of the frequency domain."""
    system, load, motion = steady(seed)
    span, shares = 20 * np.pi / 60.0, []
    for steps in (3000, 6000):
        run = transient(system, load, span, motion, speed=60.0, step=span / steps, spectral_radius=1.0)
        shares.append(run.energy.isel(time=-1).sel(share=["sources", "dampers"]).values)
    omega = 60.0 * motion.order.values[:, None]
    stiffness, damping = system.connections.stiffness, system.connections.damping
    rate = omega * np.abs(motion.torque.values / (stiffness + 1j * omega * damping))
    lost = 0.5 * span * (damping * rate**2).sum()
    coarse, fine = (np.abs(np.array(share) / lost - 1.0).max() for share in shares)
    assert fine < 5e-3 and coarse / fine == pytest.approx(4.0, rel=0.1)


# --- the frequency domain and exact motions ---


def steady(seed: int) -> tuple[System, Excitation, xr.Dataset]:
    """A linear network with a planetary set, its load and its response."""
    net = gentle(np.random.default_rng(seed), 3 + seed)
    planetary = {name: part for name, part in machine(net, seed).items() if name in ("ring", "sun", "set", "hold")}
    system = assemble(Powertrain({**net.components(), **planetary}))
    load = Excitation(("n0",), [1.0, 3.0], [60.0], [[[10.0j, 50.0]]])
    return system, load, harmonic_response(system, load).isel(speed=0)


@pytest.mark.parametrize("seed", range(8))
def test_the_distance_to_the_linear_response_falls_with_the_square_of_the_step(seed: int) -> None:
    system, load, motion = steady(seed)
    missed = []
    for h in (4e-4, 2e-4, 1e-4):
        run = transient(system, load, 0.2, motion, speed=60.0, step=h)
        turns = np.exp(60j * np.multiply.outer(run.time.values, motion.order.values))
        missed.append(apart(run.angle.values, (turns @ motion.angle.values).real))
    assert missed[-1] < 1e-3
    np.testing.assert_allclose(np.log2(np.array(missed[:-1]) / missed[1:]), 2.0, atol=0.02)


def exact(system: System, start: MotionState, times: np.ndarray) -> tuple[np.ndarray, int]:
    """Node angles from event to event, and how many events there were."""
    K, rows, numbers = system.K.copy(), [], []
    for row, law in zip(system.connections.weights, system.connections.laws, strict=True):
        if (found := hinge_rows(law)) is not None:
            K += found.stiffness * np.outer(row, row)
            rows += [-side * row for side in found.side]
            numbers += list(zip(found.side * found.gap, found.change, found.contact_time, strict=True))
    gap, k, tau = np.array(numbers).T
    load = np.zeros((4, len(K)), dtype=complex)
    load[3] = 50.0 * system.T[system.node_index("n0")]
    contacts = OneSided(np.array(rows).T, gap, k, tau)
    way = ExactContacts(system.M, system.C, K, contacts, load, 60.0).run(times, start.angle, start.speed)
    return way.angles @ system.T.T, len(way.events)


@pytest.mark.parametrize("seed", range(10))
def test_stages_play_and_contacts_are_met_to_second_order(seed: int) -> None:
    """Four halvings of the step against the motion from event to event."""
    net = gentle(np.random.default_rng(seed), 3 + seed // 2)
    system = assemble(Powertrain(machine(net, seed, rub=False)))
    angles, events = exact(system, thrown(system, seed), np.linspace(0.0, 0.05, 51))
    assert events >= 3
    steps = [1e-4 / 2**i for i in range(5)]
    missed = [apart(run_of(system, seed, 0.05, step=h, output=1e-3).angle.values, angles) for h in steps]
    assert missed[-1] < 3e-6
    assert np.log2(missed[0] / missed[-1]) / 4.0 >= 1.9


@pytest.mark.parametrize("seed", range(4))
def test_runs_keep_to_motions_of_harmonic_balance(seed: int) -> None:
    """Stages on a random machine: four turns from a stable motion, nearer to it the more orders it has."""
    of = random_machine(np.random.default_rng(seed))
    left = []
    for highest in (15.0, 60.0):
        found = respond(dataclasses.replace(of, hold=""), (60.0, 140.0), at=np.array([100.0]), highest_order=highest)
        point = picked(found, 100.0, "main").isel(point=0)
        run = transient(of.system, of.excitation, 0.08 * np.pi, point, speed=100.0, step=1e-5, spectral_radius=0.9)
        turns = np.exp(100j * np.multiply.outer(run.time.values, point.order.values))
        balanced = (turns @ point.twist.sel(element="dmf").values).real
        off = np.abs(run.twist.sel(element="dmf").values - balanced).max()
        left.append(off / np.abs(balanced - balanced.mean()).max())
    assert left[1] < 1e-3 and left[1] < max(0.5 * left[0], 1e-5)  # one machine of them never leaves its stage


@pytest.mark.parametrize("seed", range(8))
def test_friction_is_met_by_explicit_integration(seed: int) -> None:
    """Washers and bristles beside stages and play; where a washer lets go inside a step the order is a little less."""
    net = gentle(np.random.default_rng(seed), 3 + seed)
    system = assemble(Powertrain(machine(net, seed)))
    tight = run_of(system, seed, 0.05, method="explicit", tolerance=1e-11, step=1e-3, output=1e-3).angle.values
    steps = [1e-4, 1.25e-5]
    missed = [apart(run_of(system, seed, 0.05, step=h, output=1e-3).angle.values, tight) for h in steps]
    assert missed[1] < 2e-5
    assert np.log2(missed[0] / missed[1]) / 3.0 >= 1.65


# --- the same machine told in other words ---


def mirrored(law: Law) -> Law:
    """−f(−φ)."""
    assert isinstance(law, Hinges | Contacts)
    return dataclasses.replace(law, gaps=tuple(-g for g in law.gaps), sides=tuple(-s for s in law.sides))


@pytest.mark.parametrize("seed", range(8))
def test_sign(seed: int) -> None:
    net = gentle(np.random.default_rng(seed), 3 + seed)
    one, two = (assemble(Powertrain(machine(net, seed, of=of))) for of in (lambda law: law, mirrored))
    backward = MotionState.at_rest(two).moved(0.0, -thrown(one, seed).speed)
    x, y = run_of(one, seed), run_of(two, seed, load=-50.0, start=backward)
    for name in ("angle", "torque", "acceleration"):
        assert apart(x[name].values, -y[name].values) <= 1e-12
    assert apart(x.energy.values, y.energy.values) <= 1e-12


@pytest.mark.parametrize("seed", range(8))
def test_order_of_parts(seed: int) -> None:
    net = gentle(np.random.default_rng(seed), 3 + seed)
    parts = machine(net, seed)
    names = list(parts)
    np.random.default_rng(seed).shuffle(names)
    one, two = assemble(Powertrain(parts)), assemble(Powertrain({name: parts[name] for name in names}))
    rates = one.T @ thrown(one, seed).speed
    at = [two.node_index(node) for node in one.nodes]
    start = MotionState.at_rest(two).moved(0.0, np.linalg.lstsq(two.T[at], rates, rcond=None)[0])
    x, y = run_of(one, seed), run_of(two, seed, start=start)
    assert apart(y.angle.sel(node=x.node.values).values, x.angle.values) <= 1e-12


def referred(part: Component, i: float) -> Component:
    """A part behind a gear of ratio i as one in front of it: J/i², k/i², c/i², torques/i, angles and rates times i."""
    match part:
        case Inertia():
            return Inertia(part.inertia / i**2)
        case Shaft():
            return Shaft(part.a, part.b, part.stiffness / i**2, part.damping / i**2)
        case Coupling():
            return Coupling(part.a, part.b, referred_law(part.law, i), part.damping / i**2)
        case PlanetaryGear():
            return dataclasses.replace(part, planet_inertia=part.planet_inertia / i**2)
    return part


def referred_law(law: Law, i: float) -> Law:
    match law:
        case Hinges():
            changes = tuple(k / i**2 for k in law.changes)
            return Hinges(law.stiffness / i**2, tuple(g * i for g in law.gaps), law.sides, changes)
        case Contacts():
            stiffnesses = tuple(k / i**2 for k in law.stiffnesses)
            return dataclasses.replace(law, gaps=tuple(g * i for g in law.gaps), stiffnesses=stiffnesses)
        case Jenkins():
            return Jenkins(law.limit_torque / i, law.stiffness / i**2)
    assert isinstance(law, LuGre)
    k, c, v = law.bristle_stiffness / i**2, law.bristle_damping / i**2, law.viscous_damping / i**2
    return LuGre(k, c, law.sliding_torque / i, law.breakaway_torque / i, law.stribeck_rate * i, v)


@pytest.mark.parametrize("rub, bar", [(False, 1e-12), (True, 1e-9)])
@pytest.mark.parametrize("seed", range(8))
def test_referring_through_a_gear(seed: int, rub: bool, bar: float) -> None:
    """Torques of friction agree with the motion to 1e-10, and no closer."""
    i = float(10 ** np.random.default_rng(seed).uniform(-1, np.log10(20)))
    parts = machine(gentle(np.random.default_rng(seed), 3 + seed), seed, rub=rub)
    front = {"front": Inertia(1.0), "pinion": Inertia(0.5), "drive": Shaft("front", "pinion", 1e4, 2.0)}
    load = Excitation(("front",), [1.0, 3.0], 60.0, [[0.0, 80.0]])
    geared = assemble(Powertrain({**front, **parts, "gear": GearPair("pinion", "n0", i)}))
    behind = {name: referred(part, i) for name, part in parts.items()}
    plain = assemble(Powertrain({**front, **behind, "joint": GearPair("pinion", "n0", 1.0)}))
    nodes, scale = ["front", "n0", "n1", "sun"], [1.0, i, i, i]
    x, y = (transient(s, load, 0.1, "rest", speed=60.0).angle.sel(node=nodes).values for s in (geared, plain))
    assert apart(x * scale, y) <= bar


# --- pieces ---


@pytest.mark.parametrize("seed", range(4))
def test_pieces_are_the_whole(seed: int) -> None:
    """Bits from one call for all steps and from calls of odd lengths; the memory of friction and the ledger too."""
    system = assemble(Powertrain(machine(gentle(np.random.default_rng(seed), 3 + seed), seed)))
    unit = Excitation(("n0",), [1.0, 3.0], 60.0, [[0.0, 50.0]])
    problem = Problem.of(system, unit, 60.0)
    whole = marched(problem, thrown(system, seed), 1000, Accuracy())
    state, parts = thrown(system, seed), []
    for steps in (1, 7, 92, 400, 500):
        parts.append(marched(problem, state, steps, Accuracy()))
        state = parts[-1].end
    for name in ("angle", "speed", "acceleration", "torque", "memory", "energy"):
        pieces = [getattr(parts[0], name), *(getattr(part, name)[1:] for part in parts[1:])]
        np.testing.assert_array_equal(np.concatenate(pieces), getattr(whole, name))


@pytest.mark.parametrize("seed", range(4))
def test_a_run_goes_on_from_its_result(seed: int) -> None:
    """A Dataset holds all that the next step needs: the run goes on as if it had not been cut, to the last bit."""
    system = assemble(Powertrain(machine(gentle(np.random.default_rng(seed), 3 + seed), seed)))
    whole = run_of(system, seed, 0.1, output=1e-3)
    half = run_of(system, seed, 0.05, output=1e-3)
    rest = run_of(system, seed, 0.05, output=1e-3, start=half)
    np.testing.assert_allclose(rest.time.values, whole.time.values[50:], rtol=0, atol=1e-12)
    assert (rest.angle.values == whole.angle.values[50:]).all()


# --- energy that steps make of their own ---

STOPS = Hinges(0.0, (0.01, -0.01), (1.0, -1.0), (1e8, 1e8))


def between_stops(law: Law) -> tuple[System, MotionState]:
    """0.003 kgm² at 1 rad/s."""
    system = assemble(Powertrain({"mass": Inertia(0.003), "stops": Coupling("ground", "mass", law)}))
    return system, MotionState.at_rest(system).moved(0.0, np.ones(1))


@pytest.mark.parametrize("radius", [1.0, 0.8, 0.5])
def test_stops_that_pump_energy_are_found_out(radius: float) -> None:
    """Stiff elastic stops, steps of 2e-5 s for 1 s: without the guard the energy grows past all bounds."""
    system, start = between_stops(STOPS)
    problem = Problem.of(system, (), 0.0)
    state = begin(problem.plan, start.angle, start.speed)
    told = march(problem.plan, AlphaMethod.chung_hulbert(radius), 2e-5, 50_000, state, settings=Settings(guard=False))
    assert told.status == Status.PRODUCES
    assert told.records.ledger[:, Entry.KINETIC].max() > 100 * 0.0015


@pytest.mark.parametrize("method, radius", [("newmark", 1.0), ("chung_hulbert", 0.8), ("hht", 0.5), ("bossak", 0.5)])
def test_the_guard_bounds_what_stops_throw_back(method: str, radius: float) -> None:
    system, start = between_stops(STOPS)
    run = transient(system, (), 1.0, start, speed=0.0, step=2e-5, method=method, spectral_radius=radius)
    kinetic = run.energy.sel(share="kinetic").values
    assert run.attrs["status"] == "complete"
    assert kinetic.max() <= 1.01 * 0.0015 and abs(run.angle.values).max() < 0.0101


@pytest.mark.parametrize("seed", range(6))
def test_bristles_create_no_energy(seed: int) -> None:
    """Free motion of a mass on a spring and bristles: what is stored never exceeds what was, cycle by cycle."""
    rng = np.random.default_rng(seed)
    k, sliding = float(10 ** rng.uniform(1, 3)), float(10 ** rng.uniform(-3, -1))
    law = LuGre(float(10 ** rng.uniform(3, 5)), 1.0, sliding, float(rng.uniform(1, 1.5)) * sliding, 0.01)
    parts = {"m": Inertia(1.0), "s": Shaft("ground", "m", k), "f": Coupling("ground", "m", law)}
    system = assemble(Powertrain(parts))
    run = transient(system, (), 2.0, MotionState.at_rest(system).moved(0.1, 0.0), speed=0.0, spectral_radius=1.0)
    z, q, v = run.memory.values[:, 0], run.angle.values[:, 0], run.angular_velocity.values[:, 0]
    stored = 0.5 * (v**2 + k * q**2 + law.bristle_stiffness * z**2)
    cycle = round(2 * np.pi / np.sqrt(k) / 1e-4)
    assert (stored[cycle:] <= stored[:-cycle] + 1e-12 * stored[0]).all()
    lost, made = (float(run.energy.sel(share=share)[-1]) for share in ("friction", "method"))
    turns = 2.0 * np.sqrt(k) / (2 * np.pi)
    assert lost - made == pytest.approx(stored[0] - stored[-1], abs=1e-10 * turns * stored[0])
    assert lost > 1e-4 * stored[0] and abs(made) < 1e-6 * lost


def never_more(
    system: System, start: MotionState, energy_of: Callable[[xr.Dataset], np.ndarray], **given: object
) -> None:
    """A free run is refused or ends with no more energy than it began with, give or take the 1 % that is told."""
    try:
        run = transient(system, (), 1.0, start, speed=0.0, **given)  # type: ignore[arg-type]
    except ModelError as refused:
        assert "no step was small enough" in str(refused)
        return
    held = energy_of(run)
    assert held[-1] <= 1.02 * held[0]


@pytest.mark.parametrize("radius", [1.0, 0.8])
@pytest.mark.parametrize("step", [2e-5, 1e-4, 1e-3])
def test_walls_given_as_a_table_are_no_source_of_energy(step: float, radius: float) -> None:
    """Their strain is the integral of the curve, whatever the steps make of it."""
    law = Table(((-0.02, -1e6), (-0.01, 0.0), (0.0, 0.0), (0.01, 0.0), (0.02, 1e6)))
    system, start = between_stops(law)

    def energy_of(run: xr.Dataset) -> np.ndarray:
        past = np.linspace(0.0, 1.0, 41) * run.angle.values
        strain = np.trapezoid(law.torque(past), past, axis=1)
        return np.asarray(0.0015 * run.angular_velocity.values[:, 0] ** 2 + strain)

    never_more(system, start, energy_of, step=step, spectral_radius=radius)


@pytest.mark.parametrize("radius", [1.0, 0.8])
@pytest.mark.parametrize("step", [1e-4, 1e-2])
@pytest.mark.parametrize("stiffness", [1e5, 1e8, 1e11])
def test_bristles_that_a_step_cannot_follow_are_no_source_of_energy(
    stiffness: float, step: float, radius: float
) -> None:
    law = LuGre(stiffness, stiffness**0.5, 1.0, 1.5, 0.001)
    parts = {"m": Inertia(1.0), "s": Shaft("ground", "m", 100.0), "f": Coupling("ground", "m", law)}
    system = assemble(Powertrain(parts))

    def energy_of(run: xr.Dataset) -> np.ndarray:
        q, v = run.angle.values[:, 0], run.angular_velocity.values[:, 0]
        return np.asarray(0.5 * (v**2 + 100.0 * q**2))

    never_more(system, MotionState.at_rest(system).moved(0.0, 1.0), energy_of, step=step, spectral_radius=radius)


# --- what would only come back as numbers that are none ---


@pytest.mark.parametrize(
    "given, told",
    [
        ({"step": np.nan}, "step"),
        ({"spectral_radius": np.nan}, "spectral_radius"),
        ({"speed": np.inf}, "speed"),
        ({"reference_time": -0.1}, "reference_time"),
        ({"angle_error": np.nan}, "angle_error"),
        ({"output": np.inf}, "output"),
        ({"hold": "nobody"}, "nobody"),
        ({"reference": "nobody"}, "nobody"),
    ],
)
def test_settings_that_are_none_are_refused(given: dict[str, object], told: str) -> None:
    system, start = between_stops(STOPS)
    with pytest.raises(ModelError) as caught:
        transient(system, (), 0.01, start, **({"speed": 0.0} | given))  # type: ignore[arg-type]
    assert told in str(caught.value)


@pytest.mark.parametrize("time", [0.0, -1.0, np.nan, np.inf])
def test_no_time_is_no_run(time: float) -> None:
    system, start = between_stops(STOPS)
    with pytest.raises(ModelError):
        transient(system, (), time, start, speed=0.0)


def test_starts_and_torques_that_are_no_numbers_are_refused() -> None:
    system, start = between_stops(STOPS)
    for angle in (np.nan, np.inf):
        with pytest.raises(ModelError):
            transient(system, (), 0.01, start.moved(angle, 0.0), speed=0.0)
    with pytest.raises(ModelError):
        TorqueHistory("mass", (0.0, 1.0), (0.0, np.nan))


def test_energy_beyond_all_numbers_is_refused() -> None:
    system = assemble(Powertrain({"m": Inertia(1.0), "s": Shaft("ground", "m", 100.0)}))
    with pytest.raises(ModelError):
        transient(system, (), 0.01, MotionState.at_rest(system).moved(0.0, 1e160), speed=0.0)


@pytest.mark.parametrize("deep", [0.001, 1.0])
def test_a_start_deep_in_a_stop_gets_out_with_no_more_energy_than_it_had(deep: float) -> None:
    system, _ = between_stops(STOPS)
    start = MotionState.at_rest(system).moved(0.01 + deep, 0.0)
    try:
        run = transient(system, (), 0.01, start, speed=0.0, step=1e-4)
    except ModelError as refused:
        assert "no step was small enough" in str(refused)
        return
    kept = run.energy.sel(share=["kinetic", "strain"]).sum("share").values
    assert kept.max() <= 1.01 * 0.5e8 * deep**2
