"""Invariants of linear analyses over random networks of many orders of magnitude."""

from __future__ import annotations

import dataclasses

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from tests.numerics.modes.counting import count_below
from tests.random_models import Network, random_network

from torsional.absorbers import (
    dual_mass_flywheel,
    planetary_dual_mass_flywheel,
    power_split_absorber,
    tuned_flange_flywheel,
    tuned_secondary_flywheel,
)
from torsional.components import Component, Coupling, GearPair, Inertia, Shaft
from torsional.engine import Excitation
from torsional.laws import Hinges
from torsional.powertrain import Powertrain
from torsional.solvers.equilibrium import equilibrium, linearize
from torsional.solvers.harmonic import harmonic_response
from torsional.solvers.modal import modal, natural_frequencies
from torsional.system import System, assemble

networks = st.builds(
    lambda seed, nodes: random_network(np.random.default_rng(seed), nodes),
    st.integers(0, 2**32 - 1),
    st.integers(2, 20),
)
undamped = st.builds(
    lambda seed, nodes: random_network(np.random.default_rng(seed), nodes, damped=False),
    st.integers(0, 2**32 - 1),
    st.integers(2, 20),
)
shares = st.floats(0.05, 0.95)
inertias = st.floats(0.01, 10.0)
springs = st.floats(1e3, 1e6)


def between_modes(system: System, share: float) -> float:
    """An angular frequency inside the range of the elastic modes, off every one of them."""
    omega = natural_frequencies(system)
    elastic = omega[omega > 0]
    low, high = np.log(elastic[0]) - 1, np.log(elastic[-1]) + 1
    found = float(np.exp(low + share * (high - low)))
    while np.abs(np.log(elastic / found)).min() < 1e-3:
        found *= 1.01
    return found


def receptances(system: System, omega: float, names: list[str]) -> np.ndarray:
    """Angles (loaded, read) of nodes under 1 Nm at each of them."""
    rows = [harmonic_response(system, Excitation.unit(name, [1.0], [omega])).angle.sel(node=names) for name in names]
    return np.array([row.values[0, 0] for row in rows])


@given(networks, shares)
def test_reciprocity_and_passivity(net: Network, share: float) -> None:
    system = assemble(net.powertrain())
    omega = between_modes(system, share)
    h = receptances(system, omega, [f"n{i}" for i in range(min(len(net.inertias), 6))])
    assert (np.abs(h - h.T) <= 1e-11 * np.maximum(np.abs(h), np.abs(h.T))).all()
    drive = np.diag(h)
    assert ((1j * omega * drive).real >= -1e-13 * np.abs(omega * drive)).all()


@given(networks, shares, st.floats(0.01, 100), st.floats(-100, -0.01))
def test_superposition(net: Network, share: float, one: float, two: float) -> None:
    system = assemble(net.powertrain())
    omega, nodes = between_modes(system, share), ("n0", f"n{len(net.inertias) - 1}")

    def angles(a: complex, b: complex) -> np.ndarray:
        load = Excitation(nodes, np.array([1.0]), np.array([omega]), np.array([[[a], [b]]]))
        return harmonic_response(system, load).angle.values.ravel()

    apart = angles(one, 0), angles(0, 1j * two)
    scale = np.abs(apart[0]) + np.abs(apart[1])
    assert (np.abs(angles(one, 1j * two) - apart[0] - apart[1]) <= 1e-12 * scale).all()


@given(st.lists(networks, min_size=1, max_size=3))
def test_zero_modes_are_the_connected_parts(nets: list[Network]) -> None:
    parts: dict[str, Component] = {}
    for number, net in enumerate(nets):
        for name, part in net.components().items():
            renamed = {f.name: f"p{number}{getattr(part, f.name)}" for f in dataclasses.fields(part) if f.name in "ab"}  # type: ignore[arg-type]
            parts[f"p{number}{name}"] = dataclasses.replace(part, **renamed)  # type: ignore[type-var]
    omega = natural_frequencies(assemble(Powertrain(parts, parts=len(nets))))
    assert np.count_nonzero(omega == 0.0) == len(nets)
    assert (omega[len(nets) :] > 0).all()


@given(networks, shares, st.floats(0.1, 20.0))
def test_referring_through_a_gear(net: Network, share: float, ratio: float) -> None:
    """Everything behind a gear of ratio i, referred: J/i², k/i², c/i²; angles there times i."""
    behind = dataclasses.replace(
        net,
        inertias=tuple(j / ratio**2 for j in net.inertias),
        shafts=tuple((a, b, k / ratio**2, c / ratio**2) for a, b, k, c in net.shafts),
    )
    front: dict[str, Component] = {
        "front": Inertia(1.0),
        "pinion": Inertia(0.5),
        "drive": Shaft("front", "pinion", 1e4),
    }
    geared = assemble(Powertrain({**front, **net.components(), "gear": GearPair("pinion", "n0", ratio)}))
    referred = assemble(Powertrain({**front, **behind.components(), "joint": GearPair("pinion", "n0", 1.0)}))
    omega = natural_frequencies(geared), natural_frequencies(referred)
    assert (np.abs(omega[0] - omega[1]) <= 1e-12 * omega[1]).all()
    at = Excitation.unit("front", [1.0], [between_modes(geared, share)])
    x, y = (harmonic_response(s, at).angle.sel(node=["front", "n0", "n1"]).values.ravel() for s in (geared, referred))
    assert (np.abs(x * [1, ratio, ratio] - y) <= 1e-11 * np.abs(y)).all()


@given(inertias, inertias, inertias, inertias, springs, st.floats(1.1, 5.0), st.floats(0.0, 100.0), shares)
def test_power_split_of_quotient_one_is_the_planetary_flywheel(
    j1: float, j2: float, j3: float, j4: float, k: float, g: float, c: float, share: float
) -> None:
    law = Hinges(k)
    split = power_split_absorber(j1, j2, j3, j4, law, planet_ratio=g, gear_quotient=1.0, damping=c)
    plain = planetary_dual_mass_flywheel(j1, j2 + j4, j3, law, planet_ratio=g, damping=c)
    tail: dict[str, Component] = {"load": Inertia(8.0)}
    one = assemble(Powertrain({**split.components, **tail, "shaft": Shaft(split.output, "load", 6e4, 1.0)}))
    two = assemble(Powertrain({**plain.components, **tail, "shaft": Shaft(plain.output, "load", 6e4, 1.0)}))
    at = Excitation.unit("primary", [1.0], [between_modes(two, share)])
    x, y = (harmonic_response(s, at).angle.sel(node=["primary", "secondary", "load"]).values for s in (one, two))
    assert (np.abs(x - y) <= 1e-11 * np.abs(y)).all()


@given(inertias, inertias, inertias, springs, springs, st.floats(0.01, 1.0), springs, shares)
def test_absorber_without_inertia_is_none_and_notch_is_exact(
    j1: float, jm: float, j2: float, k1: float, k2: float, ja: float, ka: float, share: float
) -> None:
    def flange(inertia: float, c: float) -> System:
        a = tuned_flange_flywheel(j1, jm, j2, Hinges(k1), Hinges(k2), tva_inertia=inertia, tva_stiffness=ka, damping=c)
        return assemble(Powertrain({**a.components, "load": Inertia(8.0), "shaft": Shaft("secondary", "load", 6e4, c)}))

    bare = {
        "primary": Inertia(j1),
        "a": Shaft("primary", "flange", k1, 5.0),
        "flange": Inertia(jm),
        "b": Shaft("flange", "secondary", k2, 5.0),
        "secondary": Inertia(j2),
        "load": Inertia(8.0),
        "shaft": Shaft("secondary", "load", 6e4, 5.0),
    }
    plain, nodes = assemble(Powertrain(bare)), ["primary", "flange", "secondary", "load"]
    at = Excitation.unit("primary", [1.0], [between_modes(plain, share)])
    x, y = (harmonic_response(s, at).angle.sel(node=nodes).values for s in (flange(0.0, 5.0), plain))
    assert (np.abs(x - y) <= 1e-12 * np.abs(y)).all()
    tuned, undamped_system = np.sqrt(ka / ja), flange(ja, 0.0)
    modes = natural_frequencies(undamped_system)[1:]
    assume(np.abs(modes / tuned - 1).min() > 1e-3)  # a mode at the notch has an infinite response beside the zero
    notch = Excitation.unit("primary", [1.0], [tuned])
    angle = harmonic_response(undamped_system, notch).angle.sel(node=nodes).values.ravel()
    assert np.abs(angle[1:]).max() <= 1e-10 * np.abs(angle[0])


def test_tuned_secondary_without_inertia_is_the_plain_flywheel() -> None:
    one = tuned_secondary_flywheel(1.2, 1.0, Hinges(13e3), tva_inertia=0.0, tva_stiffness=1e4, damping=20.0)
    assert one.components == dual_mass_flywheel(1.2, 1.0, Hinges(13e3), 20.0).components


@given(springs, st.floats(0.0, 50.0), st.floats(-3000.0, 3000.0), shares)
def test_equal_stages_and_no_lash_are_a_plain_spring(k: float, c: float, torque: float, share: float) -> None:
    law = Hinges(k, (0.01, -0.02), (1.0, -1.0), (0.0, 0.0))
    ends: dict[str, Component] = {"a": Inertia(1.2), "b": Inertia(1.0)}
    staged = assemble(Powertrain({**ends, "s": Coupling("b", "a", law, c)}))
    plain = assemble(Powertrain({**ends, "s": Shaft("b", "a", k, c)}))
    linear = linearize(staged, equilibrium(staged, {"a": torque}, hold="b"))
    at = Excitation.unit("a", [1.0], [between_modes(plain, share)])
    x, y = (harmonic_response(s, at).angle.values for s in (linear, plain))
    assert (np.abs(x - y) <= 1e-10 * np.abs(y)).all()


@given(networks, shares, st.randoms(use_true_random=False))
def test_permutation_sign_and_units(net: Network, share: float, random: object) -> None:
    order = list(range(len(net.inertias)))
    random.shuffle(order)  # type: ignore[attr-defined]
    base = net.powertrain()
    omega = between_modes(assemble(base), share)
    turned = dataclasses.replace(net, shafts=tuple((b, a, k, c) for a, b, k, c in net.shafts))
    # the same machine in units of a metre and a newton that are 2^10 times as large
    scaled = dataclasses.replace(
        net,
        inertias=tuple(j / 1024 for j in net.inertias),
        shafts=tuple((a, b, k / 1024, c / 1024) for a, b, k, c in net.shafts),
    )
    names = [f"n{i}" for i in range(len(net.inertias))]
    at = Excitation.unit("n0", [1.0], [omega])

    def angles(line: Powertrain) -> np.ndarray:
        return np.asarray(harmonic_response(assemble(line), at).angle.sel(node=names).values.ravel())

    wanted = angles(base)
    # the reference of speeds changes with the order of nodes, angles of nodes do not
    for other, factor in ((net.powertrain(tuple(order)), 1), (turned.powertrain(), 1), (scaled.powertrain(), 1024)):
        assert (np.abs(angles(other) - factor * wanted) <= 1e-12 * np.abs(factor * wanted)).all()


@settings(max_examples=60)
@given(undamped, st.data())
def test_stiffer_is_never_lower_and_heavier_never_higher(net: Network, data: st.DataObject) -> None:
    base = natural_frequencies(assemble(net.powertrain()))
    which = data.draw(st.integers(0, len(net.shafts) - 1))
    factor = data.draw(st.floats(1.0, 100.0))
    stiffer = tuple((a, b, k * (factor if s == which else 1), c) for s, (a, b, k, c) in enumerate(net.shafts))
    raised = natural_frequencies(assemble(dataclasses.replace(net, shafts=stiffer).powertrain()))
    assert (raised >= base * (1 - 1e-12)).all()
    disc = data.draw(st.integers(0, len(net.inertias) - 1))
    heavier = tuple(j * (factor if i == disc else 1) for i, j in enumerate(net.inertias))
    lowered = natural_frequencies(assemble(dataclasses.replace(net, inertias=heavier).powertrain()))
    assert (lowered <= base * (1 + 1e-12)).all()


@given(undamped, shares)
def test_negative_pivots_count_the_modes_below(net: Network, share: float) -> None:
    system = assemble(net.powertrain())
    omega, sigma = natural_frequencies(system), between_modes(system, share)
    c, m = system.connections, system.masses
    assert count_below(sigma, c.weights, c.stiffness, m.weights, m.inertia) == np.count_nonzero(omega < sigma)


@given(networks)
def test_energy_shares_add_up(net: Network) -> None:
    found = modal(assemble(net.powertrain()))
    elastic = found.frequency.values > 0
    assert np.allclose(found.elastic_share.sum("element").values[elastic], 1.0, rtol=0, atol=1e-9)
    assert np.allclose(found.kinetic_share.sum("mass").values, 1.0, rtol=0, atol=1e-9)
