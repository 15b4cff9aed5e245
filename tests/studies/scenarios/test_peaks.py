"""What is seen of a run while it goes on, against the whole run and its signals."""

from __future__ import annotations

import numpy as np
import pytest

import torsional as tv
from torsional.errors import ModelError
from torsional.files.scenario import load_scenario
from torsional.solvers.transient import run as running
from torsional.studies.scenarios.peaks import spring_peaks
from torsional.studies.scenarios.running import run_scenario

TRUCK = tv.load_model("examples/truck_dmf.yaml")
ENDS = ("lowest", "highest")


@pytest.mark.parametrize(
    ("name", "kind", "changes"),
    [
        ("truck_dmf", "tip_in", ("duration=0.6 s",)),
        ("truck_dmf", "engine_start", ("starter.until=1.5 s", "duration=1.6 s")),
        ("truck_dmf", "gear_shift", ("duration=1.6 s",)),
        ("truck_dmf_straight_spring", "tip_out", ("duration=0.4 s",)),
    ],
    ids=["a pedal", "a starter that would push again", "three lines", "springs in detail"],
)
def test_peaks_are_those_of_the_whole_run(name: str, kind: str, changes: tuple[str, ...]) -> None:
    """Twists are summed up in another order, which is all that tells them apart."""
    model, scenario = tv.load_model(f"examples/{name}.yaml"), load_scenario(kind, changes)
    whole, seen = run_scenario(model, scenario), spring_peaks(model, scenario)
    assert seen.springs == model.landmarks.springs
    for signal, ends in (("torque", seen.torque), ("twist", seen.twist)):
        for row, end in enumerate(ENDS):
            told = whole[f"{signal}_{end}"].sel(element=list(seen.springs)).values
            np.testing.assert_allclose(ends[row], told, rtol=1e-12, atol=0.0)
    assert (seen.torque[1] > seen.torque[0] + 100.0).all()


def test_what_happens_before_the_time_zero_is_not_looked_at() -> None:
    """A torque that falls is highest at the time zero: a vibration that settles under it for a second is no peak."""
    scenario = load_scenario("tip_out", ["duration=0.5 s", "at=0.2 s"])
    late = run_scenario(TRUCK, scenario)
    assert float(late.time[0]) == pytest.approx(0.0, abs=1e-9)
    assert spring_peaks(TRUCK, scenario).torque[1, 0] == pytest.approx(float(late.torque.sel(element="dmf").max()))


def test_steps_that_are_too_large_are_refused_as_ever() -> None:
    for scenario in (load_scenario("tip_in", ["step=5 ms"]), load_scenario("engine_start", ["step=1.5 ms"])):
        reasons = []
        for asked in (run_scenario, spring_peaks):
            with pytest.raises(ModelError) as refused:
                asked(TRUCK, scenario)
            reasons.append(str(refused.value))
        assert reasons[0] == reasons[1] and "step" in reasons[0]


def test_an_interrupted_run_has_no_peaks(monkeypatch: pytest.MonkeyPatch) -> None:
    """A run for the screen keeps what was reached; a figure of half a run would pass for one of the whole."""
    scenario, whole, pieces = load_scenario("tip_in", ["duration=1 s"]), running.marched, []

    def interrupted(*arguments: object, **settings: object) -> object:
        pieces.append(1)
        if len(pieces) > 12:
            raise KeyboardInterrupt
        return whole(*arguments, **settings)  # type: ignore[arg-type]

    monkeypatch.setattr(running, "marched", interrupted)
    assert "interrupted" in run_scenario(TRUCK, scenario).attrs["status"]
    with pytest.raises(KeyboardInterrupt):
        spring_peaks(TRUCK, scenario)
