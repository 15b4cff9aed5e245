"""B1 to B5: period doubling of the two-stage dual mass flywheel, beside motions in time and closed forms."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from torsional.errors import ModelError
from torsional.studies.base import MANY, Outcome
from torsional.studies.claims.subharmonic import quiet_speed
from torsional.studies.motions import (
    SPRING,
    TWIST,
    amplitudes,
    at_value,
    distinct,
    doubled,
    in_time,
    over_speed,
    over_torque,
    rest_of,
    stable,
    state_of,
    twist_orders,
)
from torsional.studies.register import claims
from torsional.studies.robustness import Samples, parameters_of, varied
from torsional.studies.stiffness_step import searched, stages, stepped, sweeps, transition_torque
from torsional.studies.strongest import crest
from torsional.studies.trucks import Trucks, hinged, replaced
from torsional.units import RPM


@pytest.mark.parametrize(("rpm", "vibrates"), [(825, False), (855, True), (945, True), (980, False)])
def test_b1_a_motion_in_time_from_rest(trucks: Trucks, rpm: float, vibrates: bool) -> None:
    """At 1200 Nm order 1.5 grows from rest within 840–963 rpm and dies out beside it."""
    explorer = over_torque(trucks.two_stage, rpm * RPM, (800.0, 1500.0))
    main = explorer.branches[0]
    timed = in_time(explorer, 1200.0)
    state = rest_of(main.problem, at_value(main, 1200.0)[0], timed)
    half, third = twist_orders(timed, timed.flow(state, 1500).state, 2)[[1, 2]]
    assert third > 0.01
    if vibrates:
        (branch,) = doubled(explorer)
        (z,) = at_value(branch, 1200.0)
        assert half == pytest.approx(abs(branch.problem.harmonics_of(z)[0, 1]), rel=1e-3)
        assert half > 0.005
    else:
        assert half < 1e-4


def test_b1_figures(outcomes: Mapping[str, Outcome]) -> None:
    """Twice the mode of the soft and of the stiff stage enclose all speeds at which the period doubles."""
    figures = outcomes["B1"].finding.figures
    soft, stiff = figures["twice the DMF mode's order speed, soft and stiff [rpm]"]
    speeds = [float(rpm) for span in figures["its speeds [rpm]"] for rpm in span.split("–")]
    assert soft < min(speeds) and max(speeds) < stiff
    balanced = figures["DMF twist there, balance [rad]"]
    assert figures["DMF twist there, in time from rest [rad]"] == pytest.approx(balanced, rel=1e-3)


def test_the_stiffness_step(trucks: Trucks) -> None:
    model = stepped(trucks.two_stage, 6e3, 30e3, 5.0)
    law = hinged(model, "dmf")
    assert stages(model) == (6e3, 30e3) and transition_torque(model) == pytest.approx(1000.0)
    assert float(law.torque(max(law.stops))) == pytest.approx(3500.0)
    assert float(law.tangent(1.0)) == pytest.approx(1e6)
    assert model.components["dmf"].damping == 5.0
    same = hinged(stepped(trucks.two_stage, *stages(trucks.two_stage)), "dmf")
    assert same.parameters == pytest.approx(hinged(trucks.two_stage, "dmf").parameters)


def test_crest_of_a_parabola() -> None:
    at = np.array([1.0, 2.5, 3.0])
    assert crest(at, 7.0 - 2.0 * (at - 2.2) ** 2) == pytest.approx(2.2)


def test_the_peak_is_the_highest_of_branches_over_speed(trucks: Trucks) -> None:
    """Found over mean torque at fixed speeds; beside it branches over speed at fixed mean torques."""
    model = trucks.two_stage
    peak = searched(model).peak(SPRING)
    tops = {}
    for torque in (peak.torque - 40, peak.torque, peak.torque + 40):
        (branch,) = doubled(over_speed(model, (750 * RPM, 1050 * RPM), torque))
        tops[torque] = amplitudes(model, branch, 1.5)[SPRING].max()
    assert tops[peak.torque] == pytest.approx(peak.amplitude, rel=1e-3)
    assert max(tops.values()) == tops[peak.torque] < peak.amplitude * 1.0005


def test_the_line_behind_the_hub_alone() -> None:
    """Natural frequency of the chain from gearbox input to vehicle in direct gear, written out."""
    i = 2.85
    J = np.array([0.12, 0.15 + 0.25, 0.3, 70 / i**2, 10e3 / i**2])
    k = np.array([2.5e5, 1.2e5, 1e5 / i**2, 1.6e5 / i**2])
    difference = np.diff(np.eye(5), axis=0)
    K = difference.T @ np.diag(k) @ difference
    omega = np.sqrt(np.sort(np.linalg.eigvals(K / J[:, None]).real)[1:])
    assert omega[1] / 1.5 / RPM == pytest.approx(805, abs=1)


def test_b3_the_exception_is_where_the_line_takes_no_torque(trucks: Trucks, outcomes: Mapping[str, Outcome]) -> None:
    assert quiet_speed(trucks.two_stage) / RPM == pytest.approx(805, abs=1)
    assert outcomes["B3"].verdict == "reproduced with a condition"
    assert all(told in outcomes["B3"].finding.proviso for told in ("805 rpm", "input torque", "5 Nms/rad"))
    figures = outcomes["B3"].finding.figures
    lowest = [value for key, value in figures.items() if key.startswith(("k1", "k2"))]
    assert len(lowest) == 8 and min(lowest) > figures["transition torque [Nm]"]
    assert (
        figures["5 Nms/rad, k2 varied: lowest for the input torque [Nm]"]
        < 1000
        < min(
            figures[f"5 Nms/rad, k2 varied: lowest for the {name} [Nm]"]
            for name in ("DMF torque", "input acceleration")
        )
    )


def test_b2_figures(outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["B2"].finding.figures
    for name in ("k1", "k2"):
        x = np.asarray(figures[f"{name} varied: differences [kNm/rad]"])
        y = np.asarray(figures[f"{name} varied: DMF torque [Nm]"])
        line = np.polyval(np.polyfit(x, y, 1), x)
        expected = 1 - ((y - line) ** 2).sum() / ((y - y.mean()) ** 2).sum()
        assert figures[f"{name} varied: DMF torque, R²"] == pytest.approx(expected)
        assert len(x) >= 6 and x.min() == pytest.approx(1.2 * figures[f"{name} varied: onset [kNm/rad]"])
    assert figures["k2 varied: DMF twist, R²"] < figures["k2 varied: DMF torque, R²"]
    assert figures["largest twist over the stop's [-]"] < 1


@pytest.mark.parametrize(("damping", "name"), [(20.0, "k2 varied"), (5.0, "5 Nms/rad, k2 varied")])
def test_b2_onset(trucks: Trucks, outcomes: Mapping[str, Outcome], damping: float, name: str) -> None:
    """A little above the onset some third-order motion is unstable, a little below none is; by Floquet multipliers."""
    onset = 1e3 * outcomes["B2"].finding.figures[f"{name}: onset [kNm/rad]"]
    speeds = np.arange(720.0, 881.0, 8.0) * RPM

    def steady(difference: float) -> bool:
        model = stepped(trucks.two_stage, 8e3, 8e3 + difference, damping)
        return all(_all_stable(model, float(speed)) for speed in speeds)

    assert steady(onset - 300) and not steady(onset + 300)


def _all_stable(model: object, speed: float) -> bool:
    explorer = over_torque(model, speed, (800.0, 1300.0), depth=0, highest_order=12.0)  # type: ignore[arg-type]
    return all(stable(branch.problem, branch.scaled).all() for branch in explorer.branches)


def test_b2_on_a_truck_whose_line_takes_part(trucks: Trucks) -> None:
    """The fifth truck of the hypercube: straight for the DMF's torque, not for that at the gearbox input."""
    samples = Samples(tuple(each.name for each in parameters_of(trucks)), MANY)
    found = claims()["B2"].tried(varied(trucks, samples.factors(4)))
    shaft, spring = (found.finding.figures[f"lowest R² of the {name} torque [-]"] for name in ("input", "DMF"))
    assert found.verdict == "reproduced with a condition" and shaft < 0.97 < spring
    assert f"R² {shaft:.3f}" in found.finding.proviso


def test_b1_where_more_harmonics_take_the_motion_away(trucks: Trucks) -> None:
    """The 24th truck of the hypercube: a refusal in words, not a failure."""
    samples = Samples(tuple(each.name for each in parameters_of(trucks)), MANY)
    found = claims()["B1"].tried(varied(trucks, samples.factors(23)))
    assert found.verdict == "not answered" and "not there with more harmonics" in found.finding.reason


def test_no_step_doubles_the_period_where_damping_is_high(trucks: Trucks) -> None:
    damped = replaced(trucks.two_stage, "dmf", damping=60.0)
    with pytest.raises(ModelError, match=r"no motion doubles its period.*none up to a difference of 21\.6 kNm"):
        sweeps(damped)


def test_without_its_stop_the_second_stage_goes_on(trucks: Trucks) -> None:
    law = hinged(stepped(trucks.two_stage, 6e3, 30e3, stop=False), "dmf")
    assert law.stops == () and float(law.tangent(10.0)) == 30e3


def test_b4_straight_lines(outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["B4"].finding.figures
    assert figures["k1 varied: slope [Nm per kNm/rad]"] == pytest.approx(43, abs=2)
    assert figures["k2 varied: slope [Nm per kNm/rad]"] == pytest.approx(26, abs=2)
    assert min(figures["k1 varied: R² for the DMF torque"], figures["k2 varied: R² for the DMF torque"]) > 0.995


def test_a_motion_moved_by_a_period_is_no_other(trucks: Trucks) -> None:
    explorer = over_torque(trucks.two_stage, 900 * RPM, (900.0, 1500.0))
    explorer.branches += doubled(explorer)
    found = distinct(explorer, 1200.0)
    assert sorted(problem.base_order for problem, _ in found) == [1.5, 3.0]
    assert [bool(stable(problem, z[None])[0]) for problem, z in found] == [
        problem.base_order == 1.5 for problem, _ in found
    ]


def test_states_of_solutions_close_in_time(trucks: Trucks) -> None:
    """The state that a solution gives comes back after two periods, in the twist and in all else."""
    explorer = over_torque(trucks.two_stage, 900 * RPM, (900.0, 1500.0))
    timed = in_time(explorer, 1200.0)
    for problem, z in distinct(explorer, 1200.0):
        state = state_of(problem, z, timed)
        assert timed.flow(state, 2).state == pytest.approx(state, abs=3e-4 * np.abs(state).max())


def test_b5_figures(outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["B5"].finding.figures
    assert figures["20 Nms/rad: where"] == figures["15 Nms/rad: where"] == ()
    assert len(figures["10 Nms/rad: where"]) >= 4
    small, large = figures["DMF twist of order 1.5 [rad]"]
    assert small == 0 and large > 0.05
    assert max(figures["largest twist over the stop's [-]"]) < 1
    assert outcomes["B5"].verdict == "reproduced with a condition"
    assert all(told in outcomes["B5"].finding.proviso for told in ("20 Nms/rad", "10 Nms/rad", "0.990"))
    assert max(figures["difference to the run in time [%]"]) < 0.1


def test_amplitudes_are_those_of_the_twist(trucks: Trucks) -> None:
    explorer = over_torque(trucks.two_stage, 900 * RPM, (900.0, 1500.0))
    (branch,) = doubled(explorer)
    found = amplitudes(trucks.two_stage, branch, 1.5)[TWIST]
    assert found == pytest.approx(np.abs(branch.problem.harmonics_of(branch.scaled)[:, 0, 1]))
