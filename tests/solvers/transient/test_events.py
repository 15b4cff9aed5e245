"""Passages from stage to stage, at the times that closed forms say."""

from __future__ import annotations

import numpy as np
import pytest

from torsional.components import Coupling, Inertia
from torsional.errors import ModelError
from torsional.laws import Contacts, Hinges
from torsional.powertrain import Powertrain
from torsional.solvers.transient import MotionState, stage_changes, transient
from torsional.solvers.transient.events import _crossings
from torsional.system import assemble


def test_clearance_oscillator_closes_and_opens_in_time() -> None:
    """m = 1 between stops k = 100 at ±1, from 2 at rest: a quarter period π/20 in contact, then free at 10 rad/s."""
    law = Contacts.between(-1.0, 1.0, 100.0, 0.0)
    line = assemble(Powertrain({"mass": Inertia(1.0), "stops": Coupling("ground", "mass", law)}))
    run = transient(line, (), 1.0, MotionState.at_rest(line).moved(2.0, 0.0), speed=0.0, spectral_radius=1.0)
    events = stage_changes(line, run)
    opens, free, contact = np.pi / 20, 0.2, np.pi / 10
    times = [opens, opens + free, opens + free + contact, opens + 2 * free + contact]
    np.testing.assert_allclose(events.time.values, times, atol=2e-6)
    np.testing.assert_allclose(np.abs(events.rate.values), 10.0, rtol=1e-4)
    assert events.stage.values.tolist() == ["free play", "stop", "free play", "stop"]


def test_a_stage_that_is_only_touched_is_met_at_the_sample() -> None:
    """The cubic 2 (t − 2)³ has its threefold zero at the sample, which rounding puts a little beyond it."""
    ((time, rate),) = _crossings(np.arange(4.0), np.array([-12.0, -2.0, 0.0, -2.0]))
    assert time == pytest.approx(2.0, abs=1e-9) and rate == pytest.approx(0.0, abs=1e-9)


def test_stages_are_named_and_runs_of_other_lines_refused() -> None:
    law = Hinges.staged([(100.0, 1e3), (900.0, 4e3)])
    line = assemble(Powertrain({"mass": Inertia(1.0), "spring": Coupling("ground", "mass", law)}))
    run = transient(line, (), 0.05, MotionState.at_rest(line).moved(0.0, [6.0]), speed=0.0)
    events = stage_changes(line, run)
    assert events.stage.values.tolist()[0] == "stage 2" and set(events.element.values) == {"spring"}
    other = assemble(Powertrain({"mass": Inertia(1.0), "stop": Coupling("ground", "mass", law)}))
    with pytest.raises(ModelError, match="not of this system"):
        stage_changes(other, run)
