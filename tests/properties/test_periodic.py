"""Invariants of periodic branches over random networks and random machines."""

from __future__ import annotations

import dataclasses

import numpy as np
import xarray as xr
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from tests.random_models import Network, random_network
from tests.solvers.periodic.machines import Machine, bifurcations, picked, respond
from tests.validation.periodic_reference import Stages

from torsional.components import Component, Coupling, GearPair, Inertia, Shaft
from torsional.engine import Excitation
from torsional.laws import Hinges, Jenkins, Law, LuGre, Polynomial
from torsional.powertrain import Powertrain
from torsional.solvers.harmonic import harmonic_response
from torsional.solvers.modal import natural_frequencies
from torsional.solvers.periodic import periodic_response
from torsional.system import System, assemble

networks = st.builds(
    lambda seed, nodes: random_network(np.random.default_rng(seed), nodes),
    st.integers(0, 2**32 - 1),
    st.integers(2, 15),
)
seeds = st.integers(0, 2**32 - 1)
shares = st.floats(0.05, 0.95)


# --- nothing that bends: the linear answer ---


def straight(kind: str, stiffness: float) -> Law:
    """A law that the nonlinear path takes and that is a plain spring all the same."""
    if kind == "stages":
        return Hinges(stiffness, (0.01, -0.02), (1.0, -1.0), (0.0, 0.0))
    if kind == "no gap":
        return Hinges(0.0, (0.0, 0.0), (1.0, -1.0), (stiffness, stiffness))
    return Polynomial((stiffness,))


def with_law(net: Network, number: int, law: Law) -> dict[str, Component]:
    parts = net.components()
    a, b, _, c = net.shafts[number]
    parts[f"s{number}"] = Coupling(f"n{a}", f"n{b}", law, c)
    return parts


def dense_error(plain: System, speed: float, expected: xr.Dataset) -> float:
    """How far a dense solve of the linear equations is off: the balance, which has such solves in it, is no better.

    1e-10 is met by all but the harshest networks (springs of 1e9 Nm/rad far above their resonance).
    """
    c, worst = plain.connections, 0.0
    for order, torque in ((1.0, 1.0), (2.0, 0.5j)):
        omega = order * speed
        z = plain.K + 1j * (omega * plain.C + plain.H) + speed**2 * plain.S - omega**2 * plain.M
        q = np.linalg.solve(z, torque * plain.T[plain.node_index("n0")])
        got = (c.stiffness * (1 + 1j * c.loss_factor) + 1j * omega * c.damping) * (c.weights @ q)
        want = expected.torque.sel(order=order).isel(speed=0).values
        worst = max(worst, float(np.abs(got - want).max() / np.abs(want).max()))
    return worst


@settings(max_examples=40)
@example(random_network(np.random.default_rng(13), 13), 0, 0.25, "polynomial")  # a twist of 1e-14 rad: mostly rounding
@given(networks, seeds, shares, st.sampled_from(["stages", "no gap", "polynomial"]))
def test_equal_stages_are_harmonic_response(net: Network, seed: int, share: float, kind: str) -> None:
    rng = np.random.default_rng(seed)
    number = int(rng.integers(len(net.shafts)))
    plain = assemble(net.powertrain())
    bent = assemble(Powertrain(with_law(net, number, straight(kind, net.shafts[number][2]))))
    omega = natural_frequencies(plain)
    elastic = omega[omega > 0]
    speed = float(np.exp(np.log(elastic[0]) - 1 + share * (np.log(elastic[-1] / elastic[0]) + 2)))
    load = Excitation(("n0",), [1.0, 2.0], 1.0, [[1.0, 0.5j]])
    names = [f"n{i}" for i in range(len(net.inertias))]
    found = periodic_response(
        bent, load, (0.999 * speed, 1.001 * speed), at=[speed], highest_order=4.0, depth=0, stability=False
    )
    expected = harmonic_response(plain, Excitation(("n0",), [1.0, 2.0], [speed], [[[1.0, 0.5j]]]))
    x = picked(found, speed)
    assert x.sizes["point"] == 1
    for quantity, over in (("angle", {"node": names}), ("torque", {})):
        got = x[quantity].sel(order=[1.0, 2.0], **over).isel(point=0)
        want = expected[quantity].sel(over).isel(speed=0)
        if quantity == "torque":
            got = got.sel(element=want.element.values)
        error = np.abs(got.values - want.values).max(axis=1) / np.abs(want.values).max(axis=1)
        assert (error <= max(1e-10, 10 * dense_error(plain, speed, expected))).all()
    assert not np.abs(x.twist.sel(order=[0.0, 3.0, 4.0]).values).max() > 1e-12 * np.abs(x.twist.values).max()


@settings(max_examples=15)
@given(seeds, st.sampled_from([Jenkins(0.0, 4e3), LuGre(4e3, 2.0, 1e-9, 1e-9, 1.0), None]))
def test_no_friction_is_no_friction(seed: int, law: Law | None) -> None:
    """A washer without torque beside a spring changes nothing; a staged spring without lash is its plain spring."""
    rng = np.random.default_rng(seed)
    k, c, speed = 10 ** rng.uniform(3, 5), 10 ** rng.uniform(0, 1.5), float(rng.uniform(20.0, 200.0))
    parts: dict[str, Component] = {
        "a": Inertia(float(rng.uniform(0.2, 2.0))),
        "b": Inertia(float(rng.uniform(0.2, 2.0))),
        "end": Inertia(20.0),
        "spring": Shaft("b", "a", k, c),
        "drive": Shaft("end", "b", 2e4, 20.0),
    }
    plain = assemble(Powertrain(parts))
    added = Coupling("b", "a", law) if law else Coupling("b", "a", Hinges(0.0, (0.1, -0.1), (1.0, -1.0), (0.0, 0.0)))
    bent = assemble(Powertrain({**parts, "washer": added}))
    found = periodic_response(
        bent,
        Excitation(("a",), [1.0], 1.0, [[10.0]]),
        (0.99 * speed, 1.01 * speed),
        at=[speed],
        highest_order=5.0,
        depth=0,
        stability=False,
    )
    expected = harmonic_response(plain, Excitation(("a",), [1.0], [speed], [[[10.0]]])).angle
    got = picked(found, speed).angle.sel(order=1.0, node=expected.node.values).values[0]
    # the bristles' torque was taken as 1e-9 of the excitation's tenth, since it must be above zero
    np.testing.assert_allclose(got, expected.values[0, 0], atol=1e-10 * np.abs(expected.values).max())


# --- the same machine told in other words ---


def random_machine(rng: np.random.Generator) -> Machine:
    """Engine, flywheel of two stages, clutch of two stages and driveline of random size, excited in third order."""
    k1, gap = 10 ** rng.uniform(3.5, 4.3), rng.uniform(0.03, 0.1)
    stages = Stages((-gap, gap), (float(rng.uniform(1.5, 5)) * k1, k1, float(rng.uniform(1.5, 5)) * k1))
    clutch = Stages((0.02,), (2e3, 2e4))
    discs = {
        "engine": float(rng.uniform(1.0, 2.5)),
        "secondary": float(rng.uniform(0.4, 1.0)),
        "gearbox": 0.1,
        "axle": 0.8,
        "vehicle": 120.0,
    }
    springs = {
        "prop": ("axle", "gearbox", float(rng.uniform(2e4, 4e4)), 10.0),
        "drive": ("vehicle", "axle", 8e3, 40.0),
        "road": ("ground", "vehicle", 900.0, 20.0),
    }
    laws = {
        "dmf": ("secondary", "engine", stages, float(rng.uniform(8.0, 25.0))),
        "clutch": ("gearbox", "secondary", clutch, 15.0),
    }
    mean = float(rng.uniform(0.6, 1.2)) * k1 * gap
    return Machine(discs, springs, laws, torques={"engine": {0.0: mean, 3.0: 4.0 * mean}}, hold="vehicle")


SPAN = (60.0, 140.0)
AT = np.array([65.0, 80.0, 100.0, 123.0])


def answer(machine: Machine, **changed: object) -> xr.Dataset:
    return respond(machine, SPAN, **{"at": AT, "highest_order": 15.0, "depth": 1, **changed})


def assert_alike(one: xr.Dataset, two: xr.Dataset, tolerance: float, angle: float = 1.0, torque: float = 1.0) -> None:
    """The same points at the same speeds, twists and torques a factor apart, and the same bifurcations."""
    assert one.kind.values.tolist() == two.kind.values.tolist()
    for value in AT:
        x, y = picked(one, value), picked(two, value)
        assert x.sizes["point"] == y.sizes["point"]
        for quantity, factor in (("twist", angle), ("torque", torque)):
            a, b = x[quantity], y[quantity].sel(element=one.element.values) / factor
            later = np.exp(2j * np.pi * x.order.values / 3.0)[:, None]  # a period of the excitation later
            apart = [np.abs(a.values - other).max(axis=(1, 2)) for other in (b.values, b.values * later)]
            assert np.minimum(*apart).max() <= tolerance * np.abs(a.values).max()
        np.testing.assert_array_equal(x.stable.values, y.stable.values)
    for name in ("fold", "period doubling"):
        np.testing.assert_allclose(bifurcations(one, name), bifurcations(two, name), rtol=1e-8)


@settings(max_examples=15)
@given(seeds)
def test_sign(seed: int) -> None:
    machine = random_machine(np.random.default_rng(seed))
    mirrored = {
        name: (a, b, Stages(tuple(-e for e in law.edges[::-1]), law.slopes[::-1]), c)
        for name, (a, b, law, c) in machine.laws.items()
    }
    torques = {node: {n: -t for n, t in given_.items()} for node, given_ in machine.torques.items()}
    other = dataclasses.replace(machine, laws=mirrored, torques=torques)
    assert_alike(answer(machine), answer(other), 1e-12, -1.0, -1.0)


@settings(max_examples=15)
@given(seeds)
def test_order_and_direction_of_parts(seed: int) -> None:
    rng = np.random.default_rng(seed)
    machine = random_machine(rng)
    discs, springs = list(machine.discs.items()), list(machine.springs.items())
    rng.shuffle(discs)
    rng.shuffle(springs)
    other = dataclasses.replace(
        machine,
        discs={str(n): float(j) for n, j in discs},
        springs={str(n): s if "ground" in s[:2] else (s[1], s[0], *s[2:]) for n, s in springs},
        laws=dict(reversed(machine.laws.items())),
    )
    one, two = answer(machine), answer(other)
    for name in ("prop", "drive"):  # listed from the other end
        two.twist.loc[{"element": name}] *= -1
        two.torque.loc[{"element": name}] *= -1
    assert_alike(one, two, 1e-11)


@settings(max_examples=15)
@given(seeds, st.integers(-4, 4))
def test_unit_of_torque(seed: int, power: int) -> None:
    """Inertias, stiffnesses, dampings and torques times a power of four: not one bit of an angle changes."""
    f, machine = 4.0**power, random_machine(np.random.default_rng(seed))
    other = dataclasses.replace(
        machine,
        discs={name: j * f for name, j in machine.discs.items()},
        springs={name: (a, b, k * f, c * f) for name, (a, b, k, c) in machine.springs.items()},
        laws={
            name: (a, b, Stages(law.edges, tuple(k * f for k in law.slopes)), c * f)
            for name, (a, b, law, c) in machine.laws.items()
        },
        torques={node: {n: t * f for n, t in given_.items()} for node, given_ in machine.torques.items()},
    )
    one, two = answer(machine), answer(other)
    np.testing.assert_array_equal(one.twist.values, two.twist.values)
    np.testing.assert_array_equal(one.torque.values * f, two.torque.values)


@settings(max_examples=15)
@given(seeds, st.integers(-4, 4))
def test_size_of_angles(seed: int, power: int) -> None:
    """Gaps and torques times one factor, and so are all angles."""
    f, machine = 2.0**power, random_machine(np.random.default_rng(seed))
    other = dataclasses.replace(
        machine,
        laws={
            name: (a, b, Stages(tuple(e * f for e in law.edges), law.slopes), c)
            for name, (a, b, law, c) in machine.laws.items()
        },
        torques={node: {n: t * f for n, t in given_.items()} for node, given_ in machine.torques.items()},
    )
    one, two = answer(machine), answer(other)
    np.testing.assert_array_equal(one.twist.values * f, two.twist.values)


@settings(max_examples=12)
@given(seeds)
def test_unit_of_time(seed: int) -> None:
    """Twice the speed with a quarter of the inertia and half of the damping is the same path."""
    machine = random_machine(np.random.default_rng(seed))
    other = dataclasses.replace(
        machine,
        discs={name: j / 4 for name, j in machine.discs.items()},
        springs={name: (a, b, k, c / 2) for name, (a, b, k, c) in machine.springs.items()},
        laws={name: (a, b, law, c / 2) for name, (a, b, law, c) in machine.laws.items()},
    )
    one = answer(machine)
    two = respond(other, (2 * SPAN[0], 2 * SPAN[1]), at=2 * AT, highest_order=15.0, depth=1)
    moved = two.assign_coords(value=two.value / 2).assign(bifurcation_value=two.bifurcation_value / 2)
    assert_alike(one, moved, 1e-11)


@settings(max_examples=12)
@given(seeds, st.floats(-3.0, 3.0))
def test_origin_of_the_crank_angle(seed: int, turn: float) -> None:
    """Firing later by an angle turns every order by its number times that angle."""
    machine = random_machine(np.random.default_rng(seed))
    later = {node: {n: t * np.exp(-1j * n * turn) for n, t in g.items()} for node, g in machine.torques.items()}
    one, two = answer(machine), answer(machine.with_torques(later))
    turned = two.assign({name: two[name] * np.exp(1j * two.order * turn) for name in ("twist", "torque")})
    x, y = (picked(data, value, "main") for data in (one, turned) for value in AT[:1])
    assert np.abs(x.twist.values - y.twist.values).max() <= 1e-11 * np.abs(x.twist.values).max()
    for name in ("fold", "period doubling"):
        np.testing.assert_allclose(bifurcations(one, name), bifurcations(two, name), rtol=1e-8)


@settings(max_examples=12)
@given(seeds, st.floats(0.2, 5.0))
def test_referring_through_a_gear(seed: int, ratio: float) -> None:
    """A flywheel behind a gear of ratio i, referred: J/i², k/i², c/i², torques/i, angles and gaps times i."""
    rng = np.random.default_rng(seed)
    k1, gap, mean = 8e3, 0.06, 500.0
    stages = Stages((-gap, gap), (3 * k1, k1, 3 * k1))

    def parts(i: float) -> dict[str, Component]:
        law = Stages(tuple(e * i for e in stages.edges), tuple(k / i**2 for k in stages.slopes))
        machine = Machine(
            {"engine": 1.8 / i**2, "secondary": 0.7 / i**2, "end": 30.0 / i**2},
            {
                "drive": ("end", "secondary", 6e3 / i**2, 30.0 / i**2),
                "road": ("ground", "end", 500.0 / i**2, 9.0 / i**2),
            },
            {"dmf": ("secondary", "engine", law, 15.0 / i**2)},
        )
        return machine.components()

    front: dict[str, Component] = {
        "front": Inertia(0.3),
        "pinion": Inertia(0.1),
        "shaft": Shaft("pinion", "front", 5e4, 9.0),
    }
    load = Excitation(("front",), [0.0, 3.0], 1.0, [[mean, float(rng.uniform(0.8, 2.0)) * mean]])

    def run(system: System) -> xr.Dataset:
        return periodic_response(system, load, SPAN, at=AT, highest_order=15.0, depth=1, hold="end")

    geared = run(assemble(Powertrain({**front, **parts(1.0), "gear": GearPair("pinion", "engine", ratio)})))
    referred = run(assemble(Powertrain({**front, **parts(ratio), "joint": GearPair("pinion", "engine", 1.0)})))
    assume(geared.sizes["branches"] == referred.sizes["branches"])
    for value in AT:
        x, y = picked(geared, value, "main"), picked(referred, value, "main")
        for quantity, factor in (("twist", ratio), ("torque", 1 / ratio)):
            a, b = (data[quantity].sel(element="dmf").values for data in (x, y))
            assert np.abs(a * factor - b).max() <= 1e-10 * np.abs(b).max()
