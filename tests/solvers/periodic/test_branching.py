"""What leaves a branch and what hangs together with none: switching, mirror copies, isolas, tori, two parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace

import numba
import numpy as np
import pytest

from torsional.components import Coupling, Inertia
from torsional.engine import Excitation
from torsional.errors import ModelError
from torsional.files import load_model
from torsional.laws import Hinges, Law, Polynomial, plain
from torsional.numerics.arrays import Array
from torsional.powertrain import Powertrain
from torsional.solvers.periodic import (
    Variation,
    periodic_response,
    subharmonic_boundary,
    subharmonic_map,
    varied_response,
)
from torsional.solvers.periodic.isolated import motion
from torsional.solvers.periodic.problem import HarmonicProblem
from torsional.solvers.periodic.response import Exploration, explorer_of
from torsional.solvers.periodic.start import _bent, _lighter, _raised
from torsional.solvers.periodic.subharmonic import read
from torsional.solvers.periodic.verdict import verdict
from torsional.system import System, assemble
from torsional.units import RPM

TRUCK = Path(__file__).parents[3] / "examples" / "truck_dmf_two_stage.yaml"


def oscillator(law: Law, damping: float = 0.01) -> System:
    return assemble(Powertrain({"disc": Inertia(1.0), "spring": Coupling("ground", "disc", law, damping=damping)}))


def driven(amplitude: float, mean: float = 0.0) -> Excitation:
    return Excitation(("disc",), [0.0, 1.0], 1.0, [[mean, amplitude]])


def two_stage(change: float = 2.0) -> Hinges:
    return Hinges(1.0, (1.0, -1.0), (1.0, -1.0), (change, change))


def one_sided(stiffness: float = 2.0, gap: float = 1.0) -> Hinges:
    return Hinges(1.0, (gap,), (1.0,), (stiffness - 1.0,))


def test_an_isola_at_a_third_of_the_frequency_is_found_from_motions_in_time() -> None:
    system = oscillator(two_stage())
    found = periodic_response(system, driven(4.0), (3.0, 6.0), highest_order=7, isolated=True)
    assert found.kind.values.tolist() == ["main", "isolated"]
    assert found.base_order.values[1] == pytest.approx(1 / 3)
    assert found.ended.values[1].startswith("The curve came back")
    folds = np.sort(found.bifurcation_value.values[found.bifurcation_type.values == "fold"])
    # motion in time settles on a third of the frequency at 3.3 … 4.4 from some starts, at 4.8 from none
    assert 3.0 < folds[0] < 3.3
    assert 4.4 < folds[1] < 4.8
    explorer = explorer_of(system, driven(4.0), (3.0, 6.0), Exploration(highest_order=7, stability=False))
    explorer.explored()
    timed = motion(explorer.setting, 1.0, 4.0)
    on = (found.branch == 1) & found.stable
    nearest = int(np.nanargmin(abs(found.speed.where(on) - 4.0).values))
    at = explorer.problem(1 / 3)
    z = at.point_of(found.twist.sel(element="spring").values[nearest][None], found.speed.values[nearest])
    harmonics = at.harmonics_of(at.at(z, 4.0).z)[0]
    x0, v0 = harmonics.real.sum(), (1j * np.arange(harmonics.size) * 4.0 / 3 * harmonics).real.sum()
    settled = timed.steady(timed.bases.coordinates.state([x0], [v0]), 3000, 1e-9, 3)
    assert settled.subharmonic == 3
    exact = timed.harmonics(settled.state, 8, 3)[:, 0]
    assert abs(abs(exact[1]) - abs(harmonics[1])) < 1e-3 * abs(exact[1])


def test_the_symmetric_motion_of_a_duffing_spring_breaks_and_its_mirror_copy_is_not_told_twice() -> None:
    system = oscillator(Polynomial((1.0, 0.0, 1.0)), damping=0.1)
    found = periodic_response(system, driven(8.0), (1.4, 2.2), highest_order=12, base_order=1.0, depth=1)
    broken = np.flatnonzero(found.kind.values == "symmetry breaking")
    points = found.bifurcation_value.values[found.bifurcation_type.values == "branch point"]
    assert len(points) >= 1
    assert len(broken) * 2 in (len(points), len(points) + 1)
    means = found.twist.sel(element="spring", order=0).real
    assert np.abs(means.values[found.branch.values == 0]).max() < 1e-6
    for number in broken:
        inside = means.values[found.branch.values == number][1:-1]
        assert (inside > 0).all() or (inside < 0).all()


@numba.njit(cache=True)
def van_der_pol(
    parameters: np.ndarray, angle: float, rate: float, memory: float, step: float
) -> tuple[float, float, float, float, float, float, float, float]:
    c, d = parameters[0], parameters[1]
    return plain(-c * rate + d * rate**3, 0.0, -c + 3 * d * rate**2)


class VanDerPol(Law):
    """Torque −c φ̇ + d φ̇³: drives small vibrations, damps large ones."""

    kernel = van_der_pol
    carries_mean_torque = False

    @property
    def parameters(self) -> np.ndarray:
        return np.array([0.1, 0.1 / 3])


def test_entrainment_is_lost_at_neimark_sacker_bifurcations() -> None:
    parts = {"disc": Inertia(1.0), "spring": Coupling("ground", "disc", Hinges(1.0))}
    system = assemble(Powertrain(parts | {"driver": Coupling("ground", "disc", VanDerPol())}))
    found = periodic_response(system, driven(0.3), (0.6, 1.5), highest_order=9)
    tori = found.bifurcation_value.values[found.bifurcation_type.values == "Neimark–Sacker"]
    assert len(tori) == 2
    # Between them the forced motion is stable; averaging puts the boundary of strong forcing where the amplitude a has
    # 2 c = 3 d (a Ω)², that is (a Ω)² = 2 for these values: the limit cycle's is 4
    for value in tori:
        nearest = int(np.abs(found.speed.values - value).argmin())
        assert abs(found.twist.sel(element="driver", order=1).values[nearest]) * value == pytest.approx(
            2**0.5, rel=0.03
        )
        assert np.abs(found.multiplier.values[nearest, 0]) == pytest.approx(1.0, abs=2e-3)
    between = (found.speed.values > tori.min()) & (found.speed.values < tori.max())
    assert found.stable.values[between].mean() > 0.9
    assert not found.stable.values[found.speed.values < tori.min() - 0.01].any()


def test_every_kind_of_parameter_leads_to_the_same_solutions() -> None:
    speed, mean, amplitude = 2.41, 1.0, 1.0
    system, load = oscillator(one_sided(), 0.04), driven(amplitude, mean)
    over_speed = periodic_response(system, load, (2.0, speed), highest_order=15)
    inside = periodic_response(system, load, (2.3, speed), highest_order=15)  # no bifurcation in this range
    assert not inside.sizes["bifurcation"]
    assert inside.kind.values.tolist() == ["main", "period doubling"]
    kinds: dict[str, tuple[object, tuple[float, float], float]] = {
        "mean_torque": ("mean_torque", (mean, 1.6), mean),
        "amplitude": ("amplitude", (0.2, amplitude), amplitude),
        "gap": (
            Variation("gap", "rad", lambda gap: oscillator(one_sided(gap=gap), 0.04)),
            (0.5, 1.0),
            1.0,
        ),
        "stiffness": (Variation("k2", "Nm/rad", lambda k: oscillator(one_sided(k), 0.04)), (1.1, 2.0), 2.0),
    }
    want = over_speed.twist.sel(element="spring").values[over_speed.value.values == speed]
    assert len(want) == 2  # the doubled branch and the unstable one it left
    for name, (parameter, span, value) in kinds.items():
        got = periodic_response(system, load, span, parameter=parameter, speed=speed, highest_order=15)  # type: ignore[arg-type]
        have = got.twist.sel(element="spring").values[np.isclose(got.value.values, value, rtol=1e-12)]
        for row in want:
            found = [r for r in have if np.abs(np.abs(r) - np.abs(row)).max() < 1e-8]
            assert found, name


def test_the_region_of_the_shipped_truck_has_one_closed_boundary_over_speed_and_torque() -> None:
    truck = load_model(TRUCK)
    found = subharmonic_boundary(truck, (500 * RPM, 1300 * RPM), (600.0, 2000.0))
    torque, speed = found.boundary_value.values, found.boundary_speed.values / RPM
    assert set(found.boundary_kind.values) == {"period doubling"}
    assert (torque[0], speed[0]) == (pytest.approx(torque[-1]), pytest.approx(speed[-1]))
    assert torque.min() == pytest.approx(896.45, abs=0.05)
    assert torque.max() == pytest.approx(1417.02, abs=0.05)
    grid = subharmonic_map(truck, np.linspace(700, 1000, 13) * RPM, np.linspace(850, 1450, 13), boundary=False)
    assert grid.solutions.values.min() >= 1
    for row, value in enumerate(grid.mean_torque.values):
        if abs(value - torque.min()) < 10 or abs(value - torque.max()) < 20:
            continue  # where the curve turns, straight lines between its points are too coarse
        inside = grid.amplitude.values[row] > 0
        crossed = crossings(torque, speed, value)
        at = grid.speed.values / RPM
        expected = (at > crossed[0]) & (at < crossed[-1]) if crossed.size else np.zeros(at.size, dtype=bool)
        assert (inside == expected).all(), value


def crossings(torque: np.ndarray, speed: np.ndarray, value: float) -> np.ndarray:
    """Speeds [rpm] at which a closed curve passes one torque."""
    i = np.flatnonzero((torque[:-1] - value) * (torque[1:] - value) < 0)
    share = (value - torque[i]) / (torque[i + 1] - torque[i])
    return np.sort(speed[i] + share * (speed[i + 1] - speed[i]))


def test_the_boundary_over_the_second_stiffness_is_where_branches_over_it_double() -> None:
    truck, path = load_model(TRUCK), "absorber.stages.1.stiffness"
    curve = subharmonic_boundary(truck, (800 * RPM, 1100 * RPM), (12e3, 40e3), path, torque=1200.0, places=4)
    k2, speed = curve.boundary_value.values, curve.boundary_speed.values
    along = varied_response(truck, path, (18e3, 24e3), 900 * RPM, 1200.0, depth=0, stability=False)
    doubled = along.bifurcation_value.values[along.bifurcation_type.values == "period doubling"]
    assert len(doubled) == 1
    i = np.flatnonzero((speed[:-1] - 900 * RPM) * (speed[1:] - 900 * RPM) < 0)
    share = (900 * RPM - speed[i]) / (speed[i + 1] - speed[i])
    crossed = k2[i] + share * (k2[i + 1] - k2[i])
    assert np.abs(crossed - doubled[0]).min() < 0.02 * doubled[0]  # a straight line between points of the curve


def test_a_linear_system_and_a_missing_speed_are_refused_in_words() -> None:
    with pytest.raises(ModelError, match="no connection with a law"):
        periodic_response(oscillator(Hinges(1.0)), driven(1.0), (1.0, 2.0))
    with pytest.raises(ModelError, match="the speed is missing"):
        periodic_response(oscillator(two_stage()), driven(1.0), (1.0, 2.0), parameter="amplitude")
    with pytest.raises(ModelError, match="no such parameter"):
        periodic_response(oscillator(two_stage()), driven(1.0), (1.0, 2.0), parameter="torqe", speed=1.0)
    with pytest.raises(ModelError, match="speeds are above zero"):
        periodic_response(oscillator(two_stage()), driven(1.0), (0.0, 2.0))


def test_an_amplitude_may_pass_zero() -> None:
    """Turned by half a period the motion of −a is that of a: in the first stage a straight line through rest."""
    given = {"parameter": "amplitude", "speed": 2.0, "highest_order": 3, "at": [-0.5, 0.5], "depth": 0}
    found = periodic_response(oscillator(two_stage()), driven(1.0), (-0.5, 0.5), **given)  # type: ignore[arg-type]
    low, high = (found.twist.sel(element="spring", order=1.0).values[found.value.values == v][0] for v in (-0.5, 0.5))
    assert abs(low + high) < 1e-12 < abs(high)
    assert abs(high) == pytest.approx(0.5 / abs(1 - 2.0**2 + 1j * 0.01 * 2.0), rel=1e-9)


# --- parts of it ---


def test_a_branch_is_read_wherever_it_passes_a_speed() -> None:
    """Along 3 p − 1 to the fold at 4 and back: straight lines between its points lie on it, each point counts once."""
    p, speeds = np.array([1.0, 2.0, 4.0, 3.0, 0.5]), np.array([5.0, 7.0, 15.0, 20.0, 35.0, 40.0, 45.0])
    scale = SimpleNamespace(scale=np.array([1.0, 10.0]))
    branch = SimpleNamespace(scaled=np.stack([3 * p - 1, p], axis=1), problem=scale)
    guesses, columns, stretch = read(branch, speeds)  # type: ignore[arg-type]
    assert np.bincount(columns, minlength=7).tolist() == [1, 1, 2, 2, 2, 1, 0]
    assert guesses[:, 1] == pytest.approx(speeds[columns] / 10)
    assert guesses[:, 0] == pytest.approx(3 * guesses[:, 1] - 1)
    assert (np.minimum(p[stretch], p[stretch + 1]) <= guesses[:, 1]).all()


def test_where_determinants_contradict_the_multipliers_decide_and_it_is_said() -> None:
    explorer = explorer_of(
        oscillator(Polynomial((1.0, 0.0, 0.1)), damping=0.05), driven(0.18), (0.8, 1.6), Exploration(highest_order=5)
    )
    explorer.explored()
    branch = explorer.branches[0]
    quiet = [point for point in branch.points if not point.event]
    plain = verdict(branch.problem, quiet)
    clear = np.abs(plain.multipliers - 1).min(axis=1) > 0.05
    assert plain.confirmed[clear].all() and 0 < plain.stable[clear].mean() < 1
    turned = verdict(branch.problem, [point._replace(values=-point.values) for point in quiet])
    assert not turned.confirmed[clear].any()
    np.testing.assert_array_equal(turned.stable[clear], plain.stable[clear])


@pytest.mark.parametrize("way", [_bent, _raised, _lighter])
def test_each_way_to_a_first_solution_ends_on_one(way: Callable[[HarmonicProblem, float], Iterator[Array]]) -> None:
    system = oscillator(Hinges(3.0, (0.5, -0.2), (1.0, -1.0), (4.0, 6.0)), damping=0.3)
    problem = explorer_of(system, driven(2.0, 1.0), (1.0, 4.0), Exploration(highest_order=7)).problem(1.0)
    guesses = list(way(problem, 2.0))
    assert guesses
    for guess in guesses:
        found = problem.at(guess, 2.0)
        assert found.converged and np.abs(found.z - guess).max() < 1e-8
        assert np.abs(problem.linearised(guess)[0]).max() < 1e-8


def test_a_correction_where_there_is_no_solution_does_not_converge() -> None:
    """A spring that yields at k Nm holds no mean torque of 2 Nm with k = 1."""
    spring = Variation("k", "Nm/rad", lambda k: oscillator(Hinges(k, (1.0,), (1.0,), (-k,))))
    asked = Exploration(parameter=spring, speed=3.0, highest_order=3)
    problem = explorer_of(spring.build(3.0), driven(0.1, 2.0), (2.5, 3.5), asked).problem(1.0)
    held = problem.at(problem.point_of(np.array([[2.0 / 3.0, 0.0]], dtype=complex), 3.0), 3.0)
    assert held.converged and problem.harmonics_of(held.z)[0, 0].real == pytest.approx(2.0 / 3.0)
    assert not problem.at(held.z, 1.0).converged


def test_points_asked_for_are_judged_alike_where_the_parameter_runs_backwards() -> None:
    system = oscillator(Polynomial((1.0, 0.0, 0.1)), damping=0.05)
    load = driven(0.18)
    asked = periodic_response(system, load, (0.6, 1.6), highest_order=7, at=[1.2, 1.2 * (1 + 1e-15)])
    there = np.flatnonzero(np.isclose(asked.value.values, 1.2, rtol=1e-12))
    amplitude = np.abs(asked.twist.sel(element="spring", order=1).values[there])
    assert len(there) == 3  # between the folds at 1.1157 and 1.2696
    assert asked.stable.values[there][np.argsort(amplitude)].tolist() == [True, False, True]
    assert asked.confirmed.values[there].all()
