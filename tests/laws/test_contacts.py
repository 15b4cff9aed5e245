"""Contacts against exact impacts and against hinges."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from torsional.components import Coupling, Inertia, Shaft
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.laws import Contacts, Hinges, Law, Polynomial, contact_time
from torsional.powertrain import Powertrain
from torsional.solvers.periodic import periodic_response
from torsional.system import assemble

SAME = (0.2, -0.2), (1.0, -1.0), (1.0, 1.0)


def test_without_contact_time_they_are_hinges() -> None:
    stops = Contacts.between(-0.2, 0.3, 1e5)
    same = Hinges(0.0, (0.3, -0.2), (1.0, -1.0), (1e5, 1e5), stops=(-0.2, 0.3))
    angle = np.linspace(-0.5, 0.5, 1001)
    np.testing.assert_allclose(stops.torque(angle, 7.0), same.torque(angle), atol=1e-9)
    np.testing.assert_array_equal(stops.tangent(angle), same.tangent(angle))
    for at, torque in ((0.1, 5.0), (0.1, -5.0), (0.6, 3.0)):
        assert stops.distance_to_stop(at, torque) == pytest.approx(
            max(0.3 - at, 0.0) if torque > 0 else at + 0.2, abs=1e-15
        )
    assert [stops.stage_name(x) for x in (-0.3, 0.0, 0.31)] == ["stop", "free play", "stop"]
    assert stops.changes_within([-0.1, 0.2], [0.1, 0.4]).tolist() == [False, True]
    teeth = Contacts.lash(0.02, 1e5)
    assert teeth.stage_name(0.011) == "contact" and math.isnan(teeth.distance_to_stop(0.0, 1.0))


@given(st.floats(-0.5, 0.5), st.floats(-50.0, 50.0), st.floats(0.0, 0.01))
def test_they_push_and_nothing_else(angle: float, rate: float, time: float) -> None:
    stops = Contacts.between(-0.2, 0.3, 1e5, time)
    expected = max(0.0, 1e5 * (angle - 0.3 + time * rate)) - max(0.0, -1e5 * (angle + 0.2 + time * rate))
    assert float(stops.torque(angle, rate)) == pytest.approx(expected, rel=1e-9, abs=1e-9)


def impact(law: Contacts, inertia: float, speed: float, start: float) -> tuple[float, float]:
    """Speed after meeting a contact from a place at a speed, and how long there was torque: an integrator at 1e-10."""
    from scipy.integrate import solve_ivp

    def flow(t: float, y: Any) -> Any:
        return [y[1], -float(law.torque(y[0], y[1])) / inertia]

    found = solve_ivp(flow, (0.0, 0.1), [start, speed], rtol=1e-10, atol=1e-13, max_step=2e-5)
    pressed = np.abs(law.torque(found.y[0], found.y[1])) > 0
    times = found.t[pressed]
    return float(found.y[1, -1]), float(times[-1] - times[0])


@pytest.mark.parametrize("damper", ["held", "cut"])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_damped_stop_gives_back_its_share(damper: str, side: float) -> None:
    """m = 0.5, k = 1e4, c = 10: exp(−πζ/√(1−ζ²)) = 0.8003536403, after half a damped swing, with either damper."""
    law = Contacts((0.1 * side,), (side,), (1e4,), (1e-3,), damper=damper)
    start = 0.1 - 10.0 * 1e-3 if damper == "held" else 0.1
    speed, lasted = impact(law, 0.5, 10.0 * side, (start - 1e-3) * side)
    assert speed == pytest.approx(-side * 8.003536403, rel=1e-6 if damper == "held" else 2e-4)
    assert lasted == pytest.approx(math.pi / math.sqrt(2e4 - 100.0), abs=5e-5)


def test_contact_times_of_restitutions() -> None:
    assert contact_time(0.8003536403, 1e4, 0.5) == pytest.approx(1e-3, rel=1e-9)
    assert contact_time(1.0, 1e4, 0.5) == 0.0


@given(
    st.floats(0.0, 5e-3),
    st.sampled_from(["held", "cut"]),
    st.floats(0.0, 0.4),
    st.floats(0.0, 1.0),
    st.floats(0.0, 6.3),
    st.floats(0.1, 100.0),
)
def test_closed_cycles_lose_energy_or_none(
    time: float, damper: str, size: float, second: float, phase: float, pace: float
) -> None:
    """Power at instants of a cycle of two harmonics."""
    law = Contacts((0.1, -0.05), (1.0, -1.0), (1e5, 3e4), (time, 2 * time), damper=damper)
    t = 2 * np.pi * np.arange(20000) / 20000
    angle = size * (np.sin(t) + second * np.sin(2 * t + phase))
    rate = pace * size * (np.cos(t) + 2 * second * np.cos(2 * t + phase))
    power = (law.torque(angle, rate) - law.torque(angle)) * rate
    assert power.min() >= -1e-9 * max(1.0, abs(power).max())


def test_periodic_motion_over_contacts_is_that_over_hinges() -> None:
    """Contacts with a damper are sampled, hinges are not; a damper that is felt makes the swing smaller."""
    drive = Excitation(("disc",), [0, 1], 1.0, [[0.0, 1.0]])

    def swing(law: Law) -> float:
        spring = Shaft("ground", "disc", 1.0, damping=0.04)
        parts = {"disc": Inertia(1.0), "spring": spring, "stops": Coupling("ground", "disc", law, damping=0.04)}
        found = periodic_response(
            assemble(Powertrain(parts)), drive, (0.7, 1.0), highest_order=9, at=[0.9], stability=False, depth=0
        )
        (at,) = np.flatnonzero(np.isclose(found.speed.values, 0.9))
        return float(abs(found.twist.sel(element="stops", order=1)).values[at])

    hinged = swing(Hinges(0.0, (0.5, -0.5), (1.0, -1.0), (2.0, 2.0)))
    assert swing(Contacts.between(-0.5, 0.5, 2.0, 1e-9)) == pytest.approx(hinged, rel=2e-5)
    assert 0.9 * hinged < swing(Contacts.between(-0.5, 0.5, 2.0, 0.2)) < 0.999 * hinged


def test_branches_over_contacts_without_time_are_those_over_hinges() -> None:
    """Nothing of them is sampled: every point, multiplier and bifurcation, also beside a law that is sampled."""
    drive = Excitation(("disc",), [0, 1], 1.0, [[0.3, 0.5]])

    def branches(law: Law, *beside: Law) -> xr.Dataset:
        parts = {"disc": Inertia(1.0), "mount": Shaft("ground", "disc", 0.05, damping=0.04)}
        parts |= {f"law_{i}": Coupling("ground", "disc", each) for i, each in enumerate((law, *beside))}
        return periodic_response(assemble(Powertrain(parts)), drive, (0.5, 1.2), highest_order=7)

    for beside in ((), (Polynomial((0.0, 0.0, 0.1)),)):
        one, other = (branches(law, *beside) for law in (Contacts.lash(0.4, 1.0), Hinges(0.0, *SAME)))
        assert one.sizes["bifurcation"] >= 2 and one.sizes == other.sizes
        for name in ("speed", "twist", "torque", "multiplier", "bifurcation_speed"):
            np.testing.assert_allclose(one[name].values, other[name].values, rtol=1e-9, atol=1e-9, err_msg=name)
        assert (one.stable.values == other.stable.values).all()


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: Contacts((), (), (), ()), "needs a gap"),
        (lambda: Contacts((0.1,), (1.0,), (1e5,), ()), "needs a gap"),
        (lambda: Contacts((0.1,), (0.5,), (1e5,), (0.0,)), "sides of"),
        (lambda: Contacts((0.1,), (1.0,), (0.0,), (0.0,)), "stiffnesses.0: must be positive"),
        (lambda: Contacts((0.1,), (1.0,), (1e5,), (-1.0,)), "contact_times.0: must not be negative"),
        (lambda: Contacts.lash(0.1, 1e5, damper="kut"), "damper: there is no such damper"),
        (lambda: Contacts.lash(-0.1, 1e5), "play: must not be negative"),
        (lambda: Contacts.between(0.1, 0.1, 1e5), "the lower stop"),
        (lambda: contact_time(1.2, 1.0, 1.0), "restitution"),
    ],
)
def test_refused(make: Any, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        make()
