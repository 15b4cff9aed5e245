"""The steps of the time domain against others that share nothing with them: complementarity, exact motion, energies."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import simpson
from tests.validation import dmf_lcp
from tests.validation.test_contacts_exact import SPEED, flywheel, generalised_alpha, stepped

from torsional.numerics.explicit.march import explicit_march
from torsional.numerics.stepping.alpha_method import AlphaMethod
from torsional.numerics.stepping.marching import Entry, March, Settings, begin, march
from torsional.numerics.stepping.plan import prepare

REST = np.zeros(dmf_lcp.NODES)


def stepped_by_active_sets(h: float, end: float, stride: int = 1) -> March:
    plan = prepare(dmf_lcp.Flywheel(SPEED, SPEED).equations(4096))
    method, own = AlphaMethod.chung_hulbert(0.8), Settings(guard=False)
    return march(plan, method, h, round(end / h), begin(plan, REST, REST), stride=stride, settings=own)


@pytest.mark.parametrize("h", [1e-4, 2.5e-5])
def test_active_sets_take_the_steps_of_complementarity(h: float) -> None:
    """DMF-LCP-1 at 600 rpm over 0.05 s, every step certified: the same angles to 1e-13 rad."""
    angles, worst, _ = stepped(generalised_alpha(h), 0.05)
    found = stepped_by_active_sets(h, 0.05, round(5e-4 / h)).records.q
    np.testing.assert_allclose(found, angles, rtol=0.0, atol=1e-13)
    assert worst < 1e-12


def test_steps_are_of_second_order() -> None:
    """The error of flywheels, gearbox and vehicle over 0.1 s, against the exact motion."""
    exact, miss = flywheel()[2].run(np.linspace(0.0, 0.1, 201), REST, REST).angles, []
    for h in (5e-5, 2.5e-5, 1.25e-5, 6.25e-6):
        found = stepped_by_active_sets(h, 0.1, round(5e-4 / h)).records.q
        miss.append(np.abs(found - exact)[:, : dmf_lcp.FIRST_SHOE].max())
    assert miss[0] < 2e-5 * np.abs(exact[:, 0] - exact[:, 1]).max()
    assert np.log2(miss[0] / miss[-1]) / 3.0 > 1.9


def energies(end: float) -> dict[Entry, float]:
    """Shares of the energy by quadrature along an explicit integration of 2.5 µs: nothing of the ledger's own."""
    contacts, t = flywheel()[1], np.linspace(0.0, end, round(end / 2.5e-6) + 1)
    way = explicit_march(dmf_lcp.Flywheel(SPEED, SPEED).equations(4096), t, REST, REST, tolerance=1e-11)
    q, v = way.angles, way.rates
    drive = dmf_lcp.MEAN + dmf_lcp.SWING * np.sin(dmf_lcp.ORDER * SPEED * t)
    power = drive * v[:, dmf_lcp.PRIMARY] - dmf_lcp.MEAN * v[:, dmf_lcp.VEHICLE]
    twist, slip = (x[:, dmf_lcp.FIRST] - x[:, dmf_lcp.SECOND] for x in (q, v))
    gap, closing = contacts.gap + q @ contacts.directions, -v @ contacts.directions
    force = np.maximum(0.0, contacts.stiffness * (contacts.contact_time * closing - gap))
    kept = float(np.where(force[-1] > 0.0, 0.5 * contacts.stiffness * gap[-1] ** 2, 0.0).sum())
    return {
        Entry.WORKED: float(simpson(power, x=t)),
        Entry.DAMPED: float(simpson(slip**2 @ dmf_lcp.DAMPING, x=t)),
        Entry.STRUCK: float(simpson((force * closing).sum(axis=1), x=t)) - kept,
        Entry.KINETIC: float(0.5 * dmf_lcp.INERTIA @ v[-1] ** 2),
        Entry.STRAIN: float(0.5 * twist[-1] ** 2 @ dmf_lcp.STIFFNESS) + kept,
    }


def test_the_ledger_is_that_of_the_motion() -> None:
    """Work, losses and energies after 0.1 s by steps of 6.25 µs: within 3e-6 of the sources' 70 J."""
    end = 0.1
    exact = energies(end)
    found = stepped_by_active_sets(6.25e-6, end).state.ledger
    for share, value in exact.items():
        assert found[share] == pytest.approx(value, abs=3e-6 * exact[Entry.WORKED]), share
    assert 0.0 <= -found[Entry.MADE] < 3e-6 * exact[Entry.WORKED]
    assert exact[Entry.STRUCK] > 0.1 and exact[Entry.DAMPED] > 1.0
