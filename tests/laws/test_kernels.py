"""What holds for the kernel of every law: its derivatives, its way through an address, a law of one's own."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numba
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from torsional.components import Coupling, Inertia, Shaft
from torsional.errors import ModelError
from torsional.laws import (
    Contacts,
    Coulomb,
    Hinges,
    Jenkins,
    Karnopp,
    Law,
    LuGre,
    Polynomial,
    Stribeck,
    Table,
    packed,
    plain,
)
from torsional.numerics.callbacks import law_at
from torsional.powertrain import Powertrain
from torsional.solvers.equilibrium import equilibrium, linearize
from torsional.system import assemble

LAWS: dict[str, Law] = {
    "hinges": Hinges.staged([(1000.0, 8e3), (3500.0, 24e3)], lash=0.02, stop_stiffness=1e6),
    "contacts": Contacts((0.05, -0.1), (1.0, -1.0), (2e4, 3e4), (0.0, 0.0)),
    "cut": Contacts.lash(0.02, 2e4, 1e-3, damper="cut"),
    "limited": Contacts.lash(0.02, 2e4, 1e-3, damper="limited"),
    "polynomial": Polynomial((2e3, -500.0, 4e4)),
    "table": Table(((-0.2, -300.0), (-0.1, -50.0), (0.0, 0.0), (0.05, 0.0), (0.1, 80.0), (0.3, 1000.0))),
    "coulomb": Coulomb(50.0, regularisation_rate=0.1),
    "jenkins": Jenkins(50.0, 25e3),
    "stribeck": Stribeck(40.0, 60.0, 0.5, 0.05, normal_load=1.3, grease_damping=3.0),
    "karnopp": Karnopp(40.0, 60.0, 0.5, 4e4, 2.0, normal_load=1.3, grease_damping=3.0),
    "lugre": LuGre(
        3e4,
        15.0,
        40.0,
        breakaway_torque=60.0,
        stribeck_rate=0.5,
        viscous_damping=2.0,
        normal_load=1.3,
        grease_damping=3.0,
    ),
}
KINKS = {
    "cut": np.array([0.01, -0.01]),
    "limited": np.array([0.01, -0.01]),
    "contacts": np.array([0.05, -0.1]),
    "hinges": np.array(LAWS["hinges"].gaps),  # type: ignore[attr-defined]
    "table": np.array([x for x, _ in LAWS["table"].points]),  # type: ignore[attr-defined]
}
rates = st.floats(1e-3, 30.0).flatmap(lambda size: st.sampled_from([size, -size]))


def told(law: Law, *arguments: float) -> np.ndarray[Any, np.dtype[np.float64]]:
    """The kernel's eight numbers."""
    kernel: Any = type(law).kernel
    return np.array(kernel.py_func(law.parameters, *arguments))


@pytest.mark.parametrize("name", LAWS)
@given(angle=st.floats(-0.3, 0.3), rate=rates, share=st.floats(-1.0, 1.0), step=st.floats(1e-6, 0.1) | st.just(0.0))
def test_derivatives_are_those_of_the_values(name: str, angle: float, rate: float, share: float, step: float) -> None:
    law, point = LAWS[name], [angle, rate, 0.002 * share, step]
    exact = told(law, *point)
    if not law.remembers:
        assert (exact[3:] == 0).all()
    h = (1e-7, 1e-6 * max(abs(rate), 0.1), 1e-9)
    assume(abs(KINKS.get(name, np.array([np.inf])) - angle).min() > 2 * h[0])
    if name == "jenkins":
        assume(abs(abs(point[2] + rate * step) - 0.002) > 1e-8 + 1e-6 * abs(rate * step))
    if name == "karnopp":
        held = abs(float(law.steady(rate)) - 3.0 * rate)  # type: ignore[attr-defined]
        bent = 4e4 * (point[2] + rate * step) + 2.0 * rate
        assume(abs(abs(bent) - held) > 1e-3 * (1.0 + abs(bent)))
        assume(min(abs(abs(rate) - 0.5), abs(abs(rate) - 1.0)) > 1e-5)
    for i, column in enumerate((1, 2, 3)):
        if law.remembers and i == 0 and step == 0:
            continue  # by agreement those of sticking, see below
        above, below = (told(law, *(p + s * h[i] * (j == i) for j, p in enumerate(point))) for s in (1, -1))
        slopes = (above - below) / (2 * h[i])
        for value, derivative in ((0, column), (4, 4 + column)):
            scale = max(abs(exact[value]), 1e-3 if value else 10.0) * 1e-9 / h[i] + 1e-5 * abs(exact[derivative])
            assert slopes[value] == pytest.approx(exact[derivative], abs=scale + 1e-9 / h[i] ** 0.5)


@pytest.mark.parametrize(("name", "stuck"), [("jenkins", 25e3), ("karnopp", 4e4), ("lugre", 1.3 * 3e4)])
def test_with_no_step_friction_keeps_its_memory_and_has_the_stiffness_of_sticking(name: str, stuck: float) -> None:
    for memory in (0.0, 0.0007, -0.0012):
        torque, d_angle, _, d_memory, kept, m_angle, _, m_memory = told(LAWS[name], 0.4, 0.0, memory, 0.0)
        assert (torque, kept) == pytest.approx((stuck * memory, memory), rel=1e-12)
        assert (d_angle, d_memory, m_angle, m_memory) == (stuck, stuck, 1.0, 1.0)
        assert LAWS[name].evaluate(0.1, memory=memory)[1] == stuck


@pytest.mark.parametrize("name", LAWS)
def test_compiled_through_the_address_as_in_python(name: str) -> None:
    law, generator = LAWS[name], np.random.default_rng(7)
    angle, rate = generator.uniform(-0.3, 0.3, 4000), generator.uniform(-20.0, 20.0, 4000)
    compiled = law.evaluate(angle, rate, 0.001, 1e-4)
    for i in range(0, 4000, 371):
        expected = told(law, angle[i], rate[i], 0.001, 1e-4)[[0, 1, 2, 4]]
        assert [row[i] for row in compiled] == pytest.approx(expected, rel=1e-12, abs=1e-300)
    few = law.march(angle[:500], 1e-4, 0.0005)
    many = law.march(angle, 1e-4, 0.0005)
    for short, long in zip(few, many, strict=True):
        np.testing.assert_allclose(short, long[:500], rtol=1e-11, atol=1e-300)


@numba.njit(error_model="numpy")  # type: ignore[untyped-decorator]
def summed(address: int, parameters: Any, angles: Any) -> float:
    """A loop that knows no law."""
    torque, total = law_at(address), 0.0
    for angle in angles:
        total += torque(parameters, angle, 0.0, 0.0, 0.0)[0]
    return total


def test_one_compiled_loop_serves_all_laws() -> None:
    angles = np.linspace(-0.1, 0.2, 50)
    for law in LAWS.values():
        assert summed(law.address, law.parameters, angles) == pytest.approx(law.torque(angles).sum(), rel=1e-12)
    assert len(summed.signatures) == 1
    assert LAWS["hinges"].address == Hinges(1.0).address != LAWS["jenkins"].address


def test_importing_compiles_nothing_and_an_address_comes_from_the_disk() -> None:
    """In a process of its own: no kernel is compiled by the import, and none anew where it was kept."""
    code = (
        "import torsional.laws as laws\n"
        "kernels = [law.kernel for law in vars(laws).values() if hasattr(law, 'kernel')]\n"
        "assert len(kernels) == 9 and not any(kernel.overloads for kernel in kernels)\n"
        "laws.Jenkins(1.0, 1.0).address\n"
        "hits = laws.Jenkins.kernel.stats.cache_hits\n"
        "print(sum(hits.values()))\n"
    )
    _ = LAWS["jenkins"].address  # kept on disk by now
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, text=True)
    assert answer.stdout.strip() == "1"


# --- a law of one's own ---


@numba.njit  # type: ignore[untyped-decorator]
def cubed(parameters: Any, angle: float, rate: float, memory: float, step: float) -> Any:
    """One line."""
    return plain(parameters[0] * angle**3 + parameters[1] * rate, 3 * parameters[0] * angle**2, parameters[1])


@dataclass(frozen=True)
class Cubed(Law):
    """A spring of no stiffness at rest, and a damper."""

    stiffness: float
    drag: float = 0.0

    kernel: ClassVar[Callable[..., Any]] = cubed

    @property
    def parameters(self) -> Any:
        """k, c."""
        return np.array([self.stiffness, self.drag])


def test_a_law_of_ones_own() -> None:
    law = Cubed(8e5, drag=7.0)
    assert [float(v) for v in law.evaluate(0.1, 2.0)] == pytest.approx([814.0, 24e3, 7.0, 0.0])
    assert law.torque(np.full(3000, 0.1))[-1] == pytest.approx(800.0)
    assert summed(law.address, law.parameters, np.array([0.1, 0.2])) == pytest.approx(7200.0)
    assert law.stage_name(0.0) == "smooth" and np.isnan(law.distance_to_stop(0.1, 1.0))
    line = {"engine": Inertia(1.0), "spring": Coupling("disc", "engine", law, damping=2.0), "disc": Inertia(2.0)}
    system = assemble(Powertrain(line))
    point = equilibrium(system, {"engine": [0.0, 100.0, -100.0]}, hold="disc")
    assert point.angle[:, 0] == pytest.approx([0.0, 0.05, -0.05], abs=1e-15)
    assert point.stiffness[:, 0] == pytest.approx([0.0, 6e3, 6e3])
    linear = linearize(system, point.at(1)).connections
    assert (linear.stiffness.tolist(), linear.damping.tolist()) == (pytest.approx([6e3]), [9.0])


def test_a_law_of_ones_own_beside_another_spring() -> None:
    """k φ + k3 φ³ = T, whose root is known."""
    line = {
        "engine": Inertia(1.0),
        "soft": Coupling("disc", "engine", Cubed(8e5)),
        "shaft": Shaft("disc", "engine", 3e3),
        "disc": Inertia(2.0),
    }
    point = equilibrium(assemble(Powertrain(line)), {"engine": 8e5 * 0.04**3 + 3e3 * 0.04}, hold="disc")
    assert point.angle == pytest.approx([0.04, 0.04], rel=1e-10)


def test_kernels_that_are_none_are_refused() -> None:
    class Bare(Cubed):
        kernel = staticmethod(cubed.py_func)

    class Short(Cubed):
        kernel = numba.njit(lambda p, angle, rate, memory, step: (angle, 1.0, 0.0, memory))

    class Wrong(Cubed):
        kernel = numba.njit(lambda p, angle, rate, memory, step: plain("a", p, 0.0))

    assert Bare(1.0).torque(np.full(2100, 2.0))[0] == 8.0  # slow, yet right
    for law, said in (
        (Bare(1.0), "no compiled function"),
        (Short(1.0), "does not compile"),
        (Wrong(1.0), "does not compile"),
    ):
        with pytest.raises(ModelError, match=said):
            _ = law.address


def test_a_kernel_that_is_none_is_told_at_its_first_torque() -> None:
    class Short(Cubed):
        kernel = numba.njit(lambda p, angle: p[0] * angle)

    class Method(Cubed):
        def kernel(parameters, angle, rate, memory, step):  # type: ignore[no-untyped-def, override]  # noqa: N805
            return parameters[0] * angle, parameters[0], 0.0

    for law, said in ((Short(1.0), "does not compile"), (Method(1.0), "no compiled function")):
        with pytest.raises(ModelError, match=said):
            law.torque(0.1)


def test_wrong_slopes_are_found() -> None:
    class Slipped(Cubed):
        kernel = numba.njit(lambda p, angle, rate, memory, step: plain(p[0] * angle**3, 2 * p[0] * angle**2, p[1]))

    angle = np.linspace(-0.3, 0.2, 11)
    assert Cubed(8e5, drag=7.0).slope_error(angle, 2.0) < 1e-8
    # told is 2 where 3 is right, a third too little of the largest; and no torque goes with the drag
    assert Slipped(8e5, drag=0.0).slope_error(angle) == pytest.approx(1 / 3, rel=1e-6)
    assert Slipped(8e5, drag=7.0).slope_error(angle) == pytest.approx(7.0, rel=1e-6)


def test_parameters_may_be_any_sequence() -> None:
    class Listed(Cubed):
        @property
        def parameters(self) -> Any:
            return [self.stiffness, int(self.drag)]

    assert Listed(8e5, drag=7.0).packed.tolist() == [8e5, 7.0]
    assert packed((Listed(8e5), Listed(2.0)))[0].tolist() == [8e5, 0.0, 2.0, 0.0]


def test_what_a_kernel_raises_is_passed_on() -> None:
    class Failing(Cubed):
        kernel = numba.njit(lambda p, angle, rate, memory, step: plain(p[0] / (angle * 0.0), 0.0, 0.0))

    with pytest.raises(ZeroDivisionError):
        Failing(1.0).torque(np.full(3000, 0.5))


def test_a_law_without_kernel_or_row_of_parameters_is_told_where_it_is_put_in() -> None:
    class Bare(Law):
        parameters = np.ones(1)  # type: ignore[assignment]

    class Unsaid(Law):
        kernel = plain

    class Method(Law):
        kernel = plain

        def parameters(self) -> list[float]:  # type: ignore[override]
            return [1.0]

    class Single(Unsaid):
        parameters = 5.0  # type: ignore[assignment]

    told = {Bare: "Bare: a law's kernel is missing", Unsaid: "Unsaid: a law's parameters are missing"}
    told |= {Method: r"Method.parameters: a row of numbers is wanted; found <bound method", Single: "found 5.0"}
    for kind, sentence in told.items():
        with pytest.raises(ModelError, match=sentence):
            Coupling("a", "b", kind())
