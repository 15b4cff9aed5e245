"""The equations of the harmonic balance: derivatives against differences, blocks against the whole, scales."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.solvers.periodic.machines import DMF, TWO_STAGES, Machine, as_law, oscillator, three_laws
from tests.validation.periodic_reference import Cubic, Stages

from torsional.absorbers import CentrifugalPendulum
from torsional.components import Coupling, Inertia, Shaft
from torsional.engine import Excitation
from torsional.laws import Coulomb, Jenkins, Law, LuGre, Polynomial, Table
from torsional.numerics.balance.equations import corrected_at
from torsional.powertrain import Powertrain
from torsional.solvers.periodic.problem import HarmonicProblem
from torsional.solvers.periodic.response import Exploration, Variation, explorer_of
from torsional.system import System, assemble

LASH = Stages((-1.0, 1.0), (1.0, 0.0, 1.0))
CURVE = Table(((-0.2, -3e3), (-0.05, -400.0), (0.0, 0.0), (0.05, 600.0), (0.2, 4e3)))


def chain(law: Law, *, loss_factor: float = 0.0, pendulum: bool = False) -> System:
    """Four discs, a law in the middle, without ground; hysteresis and a pendulum take the poles away."""
    parts = {
        "front": Inertia(0.4),
        "primary": Inertia(1.2),
        "secondary": Inertia(0.7),
        "end": Inertia(5.0),
        "crank": Shaft("primary", "front", 4e5, 8.0),
        "beside": Shaft("secondary", "primary", 4e3),
        "law": Coupling("secondary", "primary", law, 6.0),
        "drive": Shaft("end", "secondary", 2e4, 15.0, loss_factor),
    }
    if pendulum:
        parts["pendulum"] = CentrifugalPendulum("secondary", mass=1.0, distance=0.1, order=1.5, damping=0.02)
    return assemble(Powertrain(parts))


EXCITED = Excitation(("front", "primary"), [0.0, 1.5, 3.0], 1.0, [[100.0, 60j, 300.0], [200.0, 40.0, 300.0 - 90j]])


def problem(system: System, order: float = 1.5, **changed: object) -> HarmonicProblem:
    given: dict[str, object] = {"hold": "end", "highest_order": 9.0} | changed
    span = given.pop("span", (50.0, 150.0))
    return explorer_of(system, EXCITED, span, Exploration(**given)).problem(order)  # type: ignore[arg-type]


def somewhere(of: HarmonicProblem, value: float, seed: int = 0) -> np.ndarray:
    """A scaled point that is no solution: harmonics that fall with their square."""
    rng, m = np.random.default_rng(seed), of.connections
    h = np.concatenate([np.zeros(m), np.repeat(np.arange(1, of.harmonics + 1), 2 * m)])
    z = rng.normal(size=of.scale.size - 1) / (1.0 + h) ** 2
    return np.append(z, value / of.scale[-1])


def differences(of: HarmonicProblem, z: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Jacobian and derivative by the parameter, both scaled, by central differences of fourth order."""

    def residual(at: np.ndarray) -> np.ndarray:
        return of.linearised(at)[0]

    columns = []
    for unit in np.eye(z.size) * step:
        near, far = residual(z + unit) - residual(z - unit), residual(z + 2 * unit) - residual(z - 2 * unit)
        columns.append((8 * near - far) / (12 * step))
    return np.array(columns[:-1]).T, columns[-1]


def assert_derivatives(of: HarmonicProblem, z: np.ndarray, tolerance: float = 1e-7, step: float = 1e-5) -> None:
    _, jacobian, slope, _ = of.linearised(z)
    by_angle, by_parameter = differences(of, z, step)
    np.testing.assert_allclose(jacobian * of.scale[:-1], by_angle, atol=tolerance * np.abs(by_angle).max())
    np.testing.assert_allclose(slope * of.scale[-1], by_parameter, atol=tolerance * np.abs(by_parameter).max())


LAWS: dict[str, Law] = {
    "stages": as_law(DMF),
    "cubic": Polynomial((5e3, 1e4, 4e6)),
    "curve": CURVE,
    "dry": Coulomb(80.0, 0.5),
}


@pytest.mark.parametrize("pendulum", [False, True], ids=["poles", "solves"])
@pytest.mark.parametrize("name", LAWS)
def test_derivatives(name: str, pendulum: bool) -> None:
    of = problem(chain(LAWS[name], loss_factor=0.05 * pendulum, pendulum=pendulum))
    assert (of.balance.poles.size == 0) == pendulum
    for value in (60.0, 131.7):
        assert_derivatives(of, somewhere(of, value))


@pytest.mark.parametrize("parameter", ["mean_torque", "amplitude"])
def test_derivatives_by_other_parameters(parameter: str) -> None:
    of = problem(chain(Polynomial((5e3, 1e4, 4e6))), parameter=parameter, speed=90.0, span=(0.5, 400.0), base_order=1.5)
    assert_derivatives(of, somewhere(of, 250.0), step=1e-4)


def test_derivatives_by_a_quantity_of_the_system() -> None:
    varied = Variation("c3", "Nm/rad^3", lambda value: chain(Polynomial((5e3, 0.0, value))))
    of = problem(chain(CURVE), parameter=varied, speed=90.0, span=(1e6, 5e6), base_order=1.5)
    assert_derivatives(of, somewhere(of, 3e6), step=1e-4)


@pytest.mark.parametrize("law", [Jenkins(60.0, 2e4), LuGre(2e4, 20.0, 60.0, 80.0, 1.0)], ids=["washer", "bristles"])
def test_derivatives_of_laws_that_remember(law: Law) -> None:
    both = Powertrain(
        {
            "primary": Inertia(1.2),
            "secondary": Inertia(0.7),
            "end": Inertia(5.0),
            "spring": Coupling("secondary", "primary", as_law(DMF), 6.0),
            "friction": Coupling("secondary", "primary", law),
            "drive": Shaft("end", "secondary", 2e4, 15.0),
        }
    )
    load = Excitation(("primary",), [0.0, 3.0], 1.0, [[100.0, 700.0]])
    of = explorer_of(assemble(both), load, (50.0, 150.0), Exploration(hold="end", highest_order=9.0)).problem(3.0)
    assert_derivatives(of, somewhere(of, 97.0), 1e-6)


def doubled(of: HarmonicProblem, half: HarmonicProblem, z: np.ndarray) -> np.ndarray:
    """A point of one base order among the unknowns of half of it."""
    harmonics = of.harmonics_of(z)
    wide = np.zeros((harmonics.shape[0], 2 * harmonics.shape[1] - 1), dtype=complex)
    wide[:, ::2] = harmonics
    return half.point_of(wide, float(z[-1] * of.scale[-1]))


@pytest.mark.parametrize("pendulum", [False, True], ids=["poles", "solves"])
@pytest.mark.parametrize("name", LAWS)
def test_half_orders_are_the_odd_part_of_the_doubled_problem(name: str, pendulum: bool) -> None:
    system = chain(LAWS[name], loss_factor=0.05 * pendulum, pendulum=pendulum)
    whole = Excitation(EXCITED.nodes, [0.0, 3.0], 1.0, EXCITED.torque[:, [0, 2]])
    explorer = explorer_of(system, whole, (50.0, 150.0), Exploration(hold="end", highest_order=9.0))
    # as many samples a period for both, lest they differ by what sampling costs a law that is not smooth
    of, half = (HarmonicProblem(replace(explorer.setting, samples=n), order) for n, order in ((512, 3.0), (1024, 1.5)))
    z = somewhere(of, 97.0)
    _, jacobian, _, _ = half.linearised(doubled(of, half, z))
    m = of.connections
    odd = np.repeat(np.arange(1, half.harmonics + 1) % 2 == 1, 2 * m)
    odd = np.concatenate([np.zeros(m, bool), odd])
    # a motion of one period keeps even and odd multiples apart; the block is the odd part
    assert np.abs(jacobian[np.ix_(odd, ~odd)]).max() <= 1e-12 * np.abs(jacobian).max()
    block = of.half_order_block(z)
    assert block.shape == (odd.sum(), odd.sum())
    np.testing.assert_allclose(block, jacobian[np.ix_(odd, odd)], atol=1e-11 * np.abs(block).max())


def solved(
    machine: Machine, value: float, span: tuple[float, float], **changed: object
) -> tuple[HarmonicProblem, np.ndarray]:
    """The solution on the main branch of a machine at one speed, from a coarse trace."""
    asked = Exploration(hold=machine.hold, stability=False, **changed)  # type: ignore[arg-type]
    explorer = explorer_of(machine.system, machine.excitation, span, asked)
    explorer.main()
    branch = explorer.branches[0]
    nearest = branch.points[int(np.argmin(np.abs(branch.values - value)))]
    found = branch.problem.at(nearest.z, value)
    assert found.converged
    return branch.problem, found.z


@pytest.mark.parametrize(
    "law, torques", [(TWO_STAGES, {0.0: 1.0, 1.0: 1.0}), (Cubic(0.4), {1.0: 1.0})], ids=["stages", "cubic"]
)
def test_the_reference_spring_and_damper_change_nothing(law: object, torques: dict[float, complex]) -> None:
    machine = oscillator(law, 0.05, torques, 0.7)  # type: ignore[arg-type]
    of, z = solved(machine, 2.4, (2.0, 3.0), highest_order=9.0)
    for stiffness, damping in ((0.3, 1.0), (20.0, 1e-4), (1.0, 0.0)):
        split = replace(of.setting.split)
        split.__dict__["reference_stiffness"] = np.array([stiffness])
        split.__dict__["reference_damping"] = np.array([damping])
        other = HarmonicProblem(replace(of.setting, split=split), of.base_order)
        found = other.at(z, 2.4)
        assert found.converged and found.iterations <= 2
        np.testing.assert_allclose(found.z, z, atol=1e-12)
        # neither do the places where a branch may leave: determinants differ by a factor, not by their zeros
        values = [np.linalg.svd(p.half_order_block(z))[1][-1] for p in (of, other)]
        assert (values[0] < 1e-6) == (values[1] < 1e-6)


def test_samples_change_nothing_of_piecewise_linear_laws() -> None:
    of, z = solved(three_laws(100.0, 800.0), 110.0, (90.0, 120.0), highest_order=30.0)
    for samples in (64, 1024):
        other = HarmonicProblem(replace(of.setting, samples=samples), of.base_order)
        found = other.at(z, 110.0)
        assert found.converged
        np.testing.assert_allclose(found.z, z, atol=1e-11)


def test_samples_change_nothing_of_smooth_laws() -> None:
    """A cubic of H harmonics has 3 H of them: beyond 4 H samples none is taken for another."""
    of, z = solved(oscillator(Cubic(0.4), 0.05, {1.0: 1.0}, 1.0), 2.4, (2.0, 3.0), highest_order=9.0)
    for samples in (64, 1024):
        found = HarmonicProblem(replace(of.setting, samples=samples), of.base_order).at(z, 2.4)
        np.testing.assert_allclose(found.z, z, atol=1e-13)


def test_many_guesses_at_once() -> None:
    of, z = solved(three_laws(100.0, 800.0), 110.0, (90.0, 120.0))
    guesses = np.array([z, z * 1.001, np.full_like(z, np.nan)])
    guesses[:, -1] = z[-1]
    found, good = corrected_at(of.balance, guesses)
    assert good.tolist() == [1.0, 1.0, 0.0]
    np.testing.assert_allclose(found[1], z, atol=1e-9)


def test_a_singular_matrix_is_told() -> None:
    """Inside of a lash nothing holds the mean: no solution there, and no crash."""
    machine = oscillator(LASH, 0.0, {0.0: 0.3, 1.0: 0.3})
    explorer = explorer_of(machine.system, machine.excitation, (2.0, 3.0), Exploration(highest_order=5.0))
    of = explorer.problem(1.0)
    z = np.zeros(of.scale.size)
    found = of.at(z, 2.0)
    assert not found.converged
