"""Structure and statics against plain linear algebra on all nodes: Lagrange multipliers, null spaces, minimisation."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh, null_space
from scipy.optimize import minimize_scalar

import torsional as tv
from torsional.solvers.campbell import campbell

Parts = dict[str, object]
J = tv.Inertia


def unreduced(line: tv.Powertrain, speeds: dict[str, float], speed: float) -> tuple[np.ndarray, ...]:
    """M, C, K (complex, lifted by the square of each carrier's mean speed) and the rows of gears on all nodes."""
    place = {node: i for i, node in enumerate(line.nodes)}
    n = len(place)
    m, c, k, gears = np.zeros((n, n)), np.zeros((n, n)), np.zeros((n, n), complex), []
    for stamp in line.stamps:
        row = np.zeros(n)
        for node, weight in stamp.weights.items():
            if node != "ground":
                row[place[node]] += weight
        if isinstance(stamp, tv.Mass):
            m += stamp.inertia * np.outer(row, row)
        elif isinstance(stamp, tv.Constraint):
            gears.append(row)
        else:
            lift = stamp.centrifugal_stiffness * (speeds.get(stamp.carrier, 0.0) * speed) ** 2
            k += (stamp.stiffness * (1 + 1j * stamp.loss_factor) + lift) * np.outer(row, row)
            c += stamp.damping * np.outer(row, row)
    return m, c, k, np.array(gears).reshape(-1, n)


GEARED: Parts = {"e": J(1.0), "s": tv.Shaft("e", "sun", 2e4, 3.0), "sun": J(0.2), "ring": J(0.5), "car": J(0.7)}
GEARED |= {"set": tv.PlanetaryGear("sun", "ring", "car", -2.5, 0.003, 1.4), "out": tv.Shaft("car", "v", 4e3, 5.0)}
GEARED |= {"v": J(20.0)}
SLOW = {"e": 1.0, "sun": 1.0, "ring": 0.0, "car": 1 / 3.5, "v": 1 / 3.5}


def hung(carrier: str) -> Parts:
    return {"p": tv.CentrifugalPendulum(carrier, 1.0, 0.12, 3.0, 0.2)}


LINES: dict[str, tuple[Parts, dict[str, float], int]] = {
    "pendulum on a reversed wheel": (
        {"e": J(1.0), "p1": J(0.2), "w": J(2.0), "v": J(20.0), "s": tv.Shaft("e", "p1", 2e4, 3.0, 0.02)}
        | {"g": tv.GearPair("p1", "w", -0.5), "s2": tv.Shaft("w", "v", 4e3, 5.0), **hung("w")},
        {"e": 1, "p1": 1, "w": -2, "v": -2, "p": -2},
        1,
    ),
    "ring braked rigidly": (
        GEARED | {"brake": tv.GearPair("ring", "ground", 1.0), **hung("car")},
        SLOW | {"p": 1 / 3.5},
        1,
    ),
    "ring braked by a spring": (
        GEARED | {"brake": tv.Shaft("ring", "ground", 5e4, 7.0), **hung("car")},
        SLOW | {"p": 1 / 3.5},
        1,
    ),
    "sun and ring joined by a spring": (
        GEARED | {"lock": tv.Shaft("sun", "ring", 5e3, 2.0), **hung("ring")},
        dict.fromkeys(("e", "sun", "ring", "car", "v", "p"), 1.0),
        1,
    ),
    "spring to the ground": (
        {"e": J(1.0), "v": J(20.0), "s": tv.Shaft("e", "v", 4e3, 5.0), "b": tv.Shaft("v", "ground", 1e3, 1.0)},
        {"e": 1, "v": 1},
        1,
    ),
    "loop through two gears": (
        {"e": J(1.0), "b": J(0.5), "c": J(0.3), "d": J(0.8), "g": tv.GearPair("e", "b", 2.0)}
        | {"h": tv.GearPair("c", "d", 2.0), "s": tv.Shaft("e", "c", 1e4, 2.0), "t": tv.Shaft("b", "d", 3e4, 4.0)},
        {"e": 1, "c": 1, "b": 0.5, "d": 0.5},
        1,
    ),
    "one gear too many": (
        {"e": J(1.0), "b": J(0.5), "c": J(0.3), "d": J(0.8), "g": tv.GearPair("e", "b", 2.0)}
        | {"h": tv.GearPair("b", "c", 1.5), "i": tv.GearPair("e", "c", 3.0), "s": tv.Shaft("c", "d", 1e4, 2.0)},
        {"e": 1, "b": 0.5, "c": 1 / 3, "d": 1 / 3},
        1,
    ),
    "two parts": (
        {"e": J(1.0), "b": J(0.5), "w": J(0.1), "c": J(0.3), "d": J(0.8), "s": tv.Shaft("e", "b", 1e4, 2.0)}
        | {"g": tv.GearPair("b", "w", -3.0), "t": tv.Shaft("c", "d", 1e4, 2.0), **hung("w")},
        {"e": 1, "b": 1, "w": -1 / 3, "p": -1 / 3, "c": 1, "d": 1},
        2,
    ),
}


@pytest.mark.parametrize("name", LINES)
def test_speeds_responses_and_frequencies(name: str) -> None:
    parts, speeds, count = LINES[name]
    line, speed, order = tv.Powertrain(parts, count), 80.0, 2.5
    assert [line.speed_ratio(node) for node in line.nodes] == pytest.approx([speeds[n] for n in line.nodes], abs=1e-14)
    m, c, k, gears = unreduced(line, speeds, speed)
    omega, n, g = order * speed, len(m), len(gears)
    full = np.block([[k + 1j * omega * c - omega**2 * m, gears.T], [gears, np.zeros((g, g))]])
    wanted = np.linalg.lstsq(full, np.eye(n + g)[line.nodes.index("e")], rcond=1e-13)[0][:n]
    system = tv.assemble(line)
    found = tv.harmonic_response(system, tv.Excitation.unit("e", [order], [speed])).angle.isel(speed=0, order=0)
    assert found.sel(node=list(line.nodes)).values == pytest.approx(wanted, rel=0, abs=1e-9 * np.abs(wanted).max())
    free = null_space(gears, rcond=1e-10) if g else np.eye(n)
    squares = eigh(free.T @ k.real @ free, free.T @ m @ free, eigvals_only=True)
    frequencies = 2 * np.pi * tv.modal(system, speed).frequency.values
    assert frequencies**2 == pytest.approx(squares, rel=1e-9, abs=1e-9 * squares.max())


# --- planetary gears from their teeth ---


def turned(radius_sun: float, radius_planet: float, sun: float, carrier: float) -> tuple[float, float]:
    """Speeds of planet and ring from no slip at both teeth, for speeds of sun and carrier."""
    arm = radius_sun + radius_planet
    planet = (arm * carrier - radius_sun * sun) / radius_planet
    return planet, (arm * carrier + radius_planet * planet) / (radius_sun + 2 * radius_planet)


def test_planetary_gear_rolls() -> None:
    """Any two speeds give the third and the planets' spin."""
    sun_teeth, planet_teeth = 30, 21
    standing = -(sun_teeth + 2 * planet_teeth) / sun_teeth
    set_ = tv.PlanetaryGear("s", "r", "c", standing, 0.01, sun_teeth / planet_teeth)
    condition, spin = set_.stamps("set")
    for sun, carrier in ((1.0, 0.0), (0.0, 1.0), (2.3, -0.7)):
        planet, ring = turned(sun_teeth, planet_teeth, sun, carrier)
        speeds = {"s": sun, "r": ring, "c": carrier}
        assert sum(w * speeds[node] for node, w in condition.weights.items()) == pytest.approx(0.0, abs=1e-14)
        assert sum(w * speeds[node] for node, w in spin.weights.items()) == pytest.approx(planet, rel=1e-13)


def test_power_split_from_its_teeth() -> None:
    """Sun on the crankshaft, ring behind the springs, carrier to the clutch: the same as by the quotients g and r."""
    sun_teeth, planet_teeth, k = 30, 21, tv.Hinges(2e4)
    _, ring = turned(sun_teeth, planet_teeth, 1.0, 1.0)
    assert ring == pytest.approx(1.0)
    # the carrier's speed for sun 0 and ring 1 is r, the planets' then g: from speeds (0, 1) of sun and carrier
    planet, ring = turned(sun_teeth, planet_teeth, 0.0, 1.0)
    r, g = 1 / ring, planet / ring
    split = tv.power_split_absorber(1.8, 0.5, 0.02, 1.2, k, planet_ratio=g, gear_quotient=r, damping=4.0).components
    teeth: Parts = {"primary": J(1.8), "secondary": J(0.5), "output": J(1.2)}
    teeth |= {"springs": tv.Coupling("secondary", "primary", k, 4.0)}
    ratios = -(sun_teeth + 2 * planet_teeth) / sun_teeth, 0.02, sun_teeth / planet_teeth
    teeth |= {"set": tv.PlanetaryGear("primary", "secondary", "output", *ratios)}
    tail: Parts = {"load": J(8.0), "shaft": tv.Shaft("load", "output", 6e4, 2.0)}
    both = [tv.assemble(tv.Powertrain({**parts, **tail})) for parts in (split, teeth)]
    at = tv.Excitation.unit("primary", [0.5, 3.0, 6.0], [60.0, 100.0])
    nodes = ["primary", "secondary", "output", "load"]
    one, two = (tv.harmonic_response(system, at).angle.sel(node=nodes).values for system in both)
    assert np.abs(one - two).max() < 1e-12 * np.abs(two).max()
    point = tv.equilibrium(both[1], {"primary": 1000.0}, hold="load")
    assert dict(zip(point.names, point.torque, strict=True))["springs"] == pytest.approx(1000.0 * r, rel=1e-12)


# --- equilibrium ---


@pytest.mark.parametrize(
    ("driven", "held", "brake", "out"),
    [("sun", "v", 250.0, -350.0), ("sun", "car", 250.0, 0.0), ("car", "v", 0.0, -100.0), ("ring", "v", -100.0, 0.0)],
)
def test_statics_of_a_set_with_a_spring_brake(driven: str, held: str, brake: float, out: float) -> None:
    """Torques of sun, ring and carrier are as 1 : 2.5 : −3.5; what stands still takes no part in the balance."""
    line = {name: part for name, part in GEARED.items() if name not in ("e", "s")}
    line |= {"brake": tv.Shaft("ring", "ground", 5e4)}
    point = tv.equilibrium(tv.assemble(tv.Powertrain(line)), {driven: 100.0}, hold=held)
    told = dict(zip(point.names, point.torque, strict=True))
    assert told == pytest.approx({"brake": brake, "out": out}, abs=1e-10)


def staged(rng: np.random.Generator) -> tv.Hinges:
    """Stages, coast, free play and stops of all sizes."""

    def rows() -> list[tuple[float, float]]:
        torques = np.cumsum(10 ** rng.uniform(0, 3, rng.integers(1, 4)))
        return [(float(t), float(10 ** rng.uniform(2, 6))) for t in torques]

    coast = rows() if rng.random() < 0.5 else None
    lash, stop = float(rng.choice([0, 0.02, 0.1, 0.5])), float(rng.choice([0, 1e6]))
    return tv.Hinges.staged(rows(), coast=coast, lash=lash, stop_stiffness=stop)


@pytest.mark.parametrize("seed", range(60))
def test_springs_side_by_side_find_their_balance(seed: int) -> None:
    """Lines of two staged springs side by side, with free play: every body is in balance, the laws are obeyed."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 6))
    parts: Parts = {f"n{i}": J(1.0) for i in range(count)}
    for i in range(count - 1):
        parts |= {f"c{i}{j}": tv.Coupling(f"n{i}", f"n{i + 1}", staged(rng)) for j in range(rng.integers(1, 3))}
    parts["over"] = tv.Coupling("n0", f"n{count - 1}", staged(rng))
    torque = float(rng.normal() * 10 ** rng.uniform(0, 4))
    point = tv.equilibrium(tv.assemble(tv.Powertrain(parts)), {"n0": torque}, hold=f"n{count - 1}")
    sums = {f"n{i}": 0.0 for i in range(count)} | {"n0": torque}
    sums[f"n{count - 1}"] -= torque
    for name, carried, angle in zip(point.names, point.torque, point.angle, strict=True):
        part = parts[name]
        assert isinstance(part, tv.Coupling)
        sums[part.a], sums[part.b] = sums[part.a] + carried, sums[part.b] - carried
        assert carried == pytest.approx(float(part.law.torque(angle)), rel=1e-9, abs=1e-9)
    assert max(map(abs, sums.values())) < 1e-9 * max(1.0, abs(torque))


def test_two_laws_with_free_play_by_lowest_potential() -> None:
    """k = 1000 beyond ±0.01 beside k = 3000 beyond ±0.05 under 50 and 150 Nm: the lowest place of the potential."""
    one, two = tv.Hinges.staged([(500.0, 1e3)], lash=0.02), tv.Hinges.staged([(500.0, 3e3)], lash=0.1)
    parts: Parts = {"a": J(1.0), "b": J(1.0), "one": tv.Coupling("b", "a", one), "two": tv.Coupling("b", "a", two)}
    point = tv.equilibrium(tv.assemble(tv.Powertrain(parts)), {"a": [50.0, 150.0]}, hold="b")
    for torque, angle in zip((50.0, 150.0), point.angle[:, 0], strict=True):

        def potential(x: float, torque: float = torque) -> float:
            return 500 * max(0.0, x - 0.01) ** 2 + 1500 * max(0.0, x - 0.05) ** 2 - torque * x

        assert angle == pytest.approx(minimize_scalar(potential, bounds=(0, 1), options={"xatol": 1e-10}).x, abs=1e-6)


# --- inertias that switch with speed ---


def switching(low: float, high: float) -> tv.Powertrain:
    planets = tv.PlanetSpin("a", "b", 2.0, low, tv.SpeedSwitch(high, 40.0, 3.0))
    return tv.Powertrain({"a": J(1.0), "b": J(1.0), "s": tv.Shaft("a", "b", 1e4, 5.0), "planets": planets})


def test_response_on_each_side_of_a_switch() -> None:
    """Fixed inertias on either side; falling speed keeps the second one down to the hysteresis."""
    at = tv.Excitation.unit("a", [2.0, 3.0], [30.0, 40.0, 40.001, 60.0])
    found = tv.harmonic_response(tv.assemble(switching(0.2, 0.02)), at).angle.values
    fixed = [tv.PlanetSpin("a", "b", 2.0, value) for value in (0.2, 0.02)]
    low, high = (
        tv.harmonic_response(tv.assemble(switching(1, 1).replaced("planets", part)), at).angle.values for part in fixed
    )
    assert np.array_equal(found[:2], low[:2])
    assert np.array_equal(found[2:], high[2:])
    assert not np.allclose(low, high, rtol=1e-3)
    system = tv.assemble(switching(0.2, 0.02))
    falling = [system.switched(speed, rising=False).masses.inertia.min() for speed in (36.9, 37.1, 39.9)]
    assert falling == [0.2, 0.02, 0.02]


@pytest.mark.parametrize("low, high", [(0.2, 0.02), (0.02, 0.2)])
@pytest.mark.parametrize("first", [1.0, 35.0])
@pytest.mark.parametrize("order", [2.0, 2.5, 3.0, 3.5])
def test_an_order_does_not_meet_the_jump(low: float, high: float, first: float, order: float) -> None:
    """ω² = k (1/J1 + 1/J2) of two discs with planets, by the 2 by 2 determinant, on either side of the switch."""

    def frequency(j: float) -> float:
        # ½ j (2 b − a)²: masses [[1 + j, −2 j], [−2 j, 1 + 4 j]]
        return float(np.sqrt(1e4 * (2 + j) / ((1 + j) * (1 + 4 * j) - 4 * j**2)))

    meets = [frequency(low) / order, frequency(high) / order]
    true = [v for v, below in zip(meets, (True, False), strict=True) if (v <= 40) == below and v >= first]
    model = tv.Model("planets", switching(low, high).components, tv.Landmarks())
    found = float(campbell(model, speeds=np.linspace(first, 100, 40), orders=[order]).crossing[0, 1, 0])
    assert found == pytest.approx(min(true), rel=1e-9) if true else np.isnan(found)
