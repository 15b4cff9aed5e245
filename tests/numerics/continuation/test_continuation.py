"""Continuation against curves known in closed form, and against folds found by a second method."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import root

from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.numerics.continuation.following import (
    Corrected,
    End,
    Equations,
    Point,
    Settings,
    Trace,
    both_ways,
    branch_test,
    followed,
    steps,
)

ONES = [1.0, 1.0]


def scalar(function: Callable[[Any, Any], Any], scale: list[float] | None = None, **others: Any) -> Equations:
    """One equation in one unknown."""
    return Equations(lambda x, p: np.array([function(x[0], p)]), scale=scale or ONES, **others)


def circle(size: float = 1.0, **others: Any) -> Equations:
    return scalar(lambda x, p: x * x + p * p - 1.0, [size, size], **others)


def hysteresis(x: float, p: float) -> float:
    return x**3 - x - p


def named(trace: Trace) -> list[tuple[str, float]]:
    return [(point.event, point.parameter) for point in trace.events]


def turns(trace: Trace) -> Array:
    """Angles between the tangents of successive points."""
    tangents = np.array([point.tangent for point in trace.points])
    sines = 0.5 * np.linalg.norm(np.diff(tangents, axis=0), axis=1)
    return np.asarray(2.0 * np.arcsin(np.minimum(sines, 1.0)))


class Counted:
    """A problem that counts its corrections."""

    def __init__(self, problem: Equations) -> None:
        self.problem, self.scale, self.tests, self.corrections = problem, problem.scale, problem.tests, 0

    def correct(self, guess: Array, normal: Array) -> Corrected:
        self.corrections += 1
        return self.problem.correct(guess, normal)


# --- folds ---


@pytest.mark.parametrize("start", [(1.0, 0.0), (0.6, 0.8), (0.0, 1.0), (0.0, -1.0), (-0.8, 0.6)])
@pytest.mark.parametrize("direction", [1, -1])
def test_a_circle_closes_and_has_two_folds_wherever_it_is_entered(start: tuple[float, float], direction: int) -> None:
    trace = followed(circle(), np.array(start), direction)
    assert trace.end is End.CLOSED
    assert [point.event for point in trace.events] == ["fold", "fold"]
    np.testing.assert_allclose(sorted(trace.events, key=lambda e: e.parameter)[0].z, [0.0, -1.0], rtol=0, atol=1e-9)
    np.testing.assert_allclose(sorted(trace.events, key=lambda e: e.parameter)[1].z, [0.0, 1.0], rtol=0, atol=1e-9)
    assert max(point.within for point in trace.events) <= 1e-9
    np.testing.assert_allclose(trace.physical[-1], trace.physical[0], rtol=0, atol=1e-12)
    assert trace.points[-1].arclength == pytest.approx(2.0 * math.pi, rel=2e-5)
    assert turns(trace).max() <= Settings().largest_angle


def test_the_direction_is_that_of_the_parameter() -> None:
    up, down = (followed(circle(), np.array([1.0, 0.0]), direction) for direction in (1, -1))
    assert up.parameter[1] > 0.0 > down.parameter[1]
    assert [p for _, p in named(up)] == pytest.approx([1.0, -1.0], abs=1e-12)
    assert [p for _, p in named(down)] == pytest.approx([-1.0, 1.0], abs=1e-12)


def test_hysteresis_has_its_folds_in_both_directions() -> None:
    """p = x³ − x has folds at x = ∓1/√3, p = ±2/(3√3)."""
    problem, fold = scalar(hysteresis), 2.0 / (3.0 * math.sqrt(3.0))
    first = problem.correct(np.array([-1.6, -2.0]), np.array([0.0, 1.0])).z
    there = followed(problem, first, 1, (-2.0, 2.0))
    back = followed(problem, there.points[-1].z, -1, (-2.0, 2.0))
    np.testing.assert_allclose(there.parameter[[0, -1]], [-2.0, 2.0], rtol=0, atol=0)
    for trace, sign in ((there, 1.0), (back, -1.0)):
        assert trace.end is End.LEFT_RANGE
        expected = sign * np.array([[-1.0 / math.sqrt(3.0), fold], [1.0 / math.sqrt(3.0), -fold]])
        np.testing.assert_allclose([event.z for event in trace.events], expected, rtol=0, atol=1e-9)


@pytest.mark.parametrize("width", [1e-2, 1e-3, 1e-4])
def test_a_pair_of_folds_much_narrower_than_a_step_is_seen(width: float) -> None:
    """p = x³ − ε x is nearly the curve without folds; with ε = 1e-4 they are 0.012 apart, steps are 0.2."""
    problem = scalar(lambda x, p: x**3 - width * x - p)
    trace = both_ways(problem, problem.correct(np.array([0.9, 0.7]), np.array([0.0, 1.0])).z, (-1.0, 1.0))
    place = math.sqrt(width / 3.0)
    assert [point.event for point in trace.events] == ["fold", "fold"]
    assert sorted(abs(e.z[0]) for e in trace.events) == pytest.approx([place, place], rel=0, abs=1e-8)
    assert max(np.diff([point.arclength for point in trace.points])) > 0.1


def test_a_vertical_tangent_without_a_turn_is_no_fold() -> None:
    trace = both_ways(scalar(lambda x, p: x**3 - p), np.zeros(2), (-1.0, 1.0))
    assert (trace.began, trace.end, trace.events) == (End.LEFT_RANGE, End.LEFT_RANGE, ())


def test_an_event_costs_few_corrections() -> None:
    """Three for a fold, four for the zero of a test, beside the one of the step they were found in."""
    counted = Counted(scalar(hysteresis, tests={"level": lambda x, p: math.exp(x[0]) - 1.3}))
    costs, before = [], 0
    for point in steps(counted, np.array([-1.6, -2.0]), 1, (-2.0, 2.0)):
        costs += [(point.event, counted.corrections - before - 1)] if point.event else []
        before = counted.corrections
    assert [name for name, _ in costs] == ["fold", "level", "fold"]
    assert all(cost <= (3 if name == "fold" else 4) for name, cost in costs)


def bratu(intervals: int) -> Equations:
    """u″ + λ eᵘ = 0, u = 0 at both ends, by central differences."""
    square = (1.0 / intervals) ** 2
    second = (np.diag(np.ones(intervals - 2), 1) + np.diag(np.ones(intervals - 2), -1)) - 2.0 * np.eye(intervals - 1)

    def jacobian(u: Array, p: float) -> Array:
        return np.hstack([second / square + p * np.diag(np.exp(u)), np.exp(u)[:, np.newaxis]])

    return Equations(
        lambda u, p: second @ u / square + p * np.exp(u), jacobian, scale=np.r_[np.ones(intervals - 1), 3.0]
    )


def fold_of(intervals: int) -> Point:
    (fold,) = followed(bratu(intervals), np.zeros(intervals), 1, (0.0, 4.0), Settings(terminal=("fold",))).events
    return fold


def test_the_fold_of_a_system_of_ten_is_that_of_the_extended_equations() -> None:
    """Moore and Spence: F = 0, F_u v = 0, one entry of v fixed, solved from a rough guess by another solver."""
    problem, fold = bratu(11), fold_of(11)

    def extended(y: Array) -> Array:
        u, v, p = y[:10], y[10:20], y[20]
        F_u = problem._F_z(np.r_[u, p / 3.0])[:, :10]
        return np.r_[problem._F(np.r_[u, p / 3.0]), F_u @ v, v[4] - 1.0]

    arch = np.sin(np.linspace(0.0, np.pi, 12))[1:-1]
    found = root(extended, np.r_[1.2 * arch, arch, 3.5], tol=1e-13)
    assert found.success
    assert fold.parameter == pytest.approx(found.x[20], rel=1e-11)
    np.testing.assert_allclose(fold.z[:10], found.x[:10], rtol=1e-8)


def test_the_fold_tends_to_that_of_the_differential_equation() -> None:
    """λ* = 3.513830719 of the one-dimensional Bratu problem, by extrapolation in h² and h⁴."""
    coarse, middle, fine = (fold_of(intervals).parameter for intervals in (10, 20, 40))
    first, second = middle + (middle - coarse) / 3.0, fine + (fine - middle) / 3.0
    assert second + (second - first) / 15.0 == pytest.approx(3.513830719, rel=1e-7)


# --- branch points and other tests ---


def test_a_pitchfork_is_found_from_its_trivial_branch_and_left_by_a_heading() -> None:
    problem = scalar(lambda x, p: p * x - x**3, branch_points=True)
    for direction in (1, -1):
        trivial = followed(problem, np.array([0.0, -direction]), direction, (-1.0, 1.0))
        (event,) = trivial.events
        assert (event.event, trivial.end) == ("branch point", End.LEFT_RANGE)
        np.testing.assert_allclose(event.z, 0.0, rtol=0, atol=1e-9)
    for side in (1, -1):
        branch = followed(problem, np.array([0.02 * side, 0.0]), side, (-1.0, 1.0), heading=np.array([1.0, 0.0]))
        np.testing.assert_allclose(branch.physical[:, 0] ** 2, branch.parameter, rtol=0, atol=1e-9)
        assert branch.points[-1].z[0] == pytest.approx(side, abs=1e-9)


def test_a_transcritical_point_is_found_on_both_branches() -> None:
    """(x − p)(x + 2 p − p²) = 0, neither branch along an axis: they cross at the origin and at (3, 3)."""
    problem = scalar(lambda x, p: (x - p) * (x + 2.0 * p - p * p), branch_points=True)
    straight = followed(problem, np.array([-1.0, -1.0]), 1, (-1.0, 4.0))
    bent = followed(problem, np.array([3.0, -1.0]), 1, (-1.0, 4.0))
    np.testing.assert_allclose(straight.physical[:, 0], straight.parameter, rtol=0, atol=1e-9)
    np.testing.assert_allclose(bent.physical[:, 0], bent.parameter**2 - 2.0 * bent.parameter, rtol=0, atol=1e-9)
    for trace in (straight, bent):
        assert [name for name, _ in named(trace)] == ["branch point", "branch point"]
        np.testing.assert_allclose([point.z for point in trace.events], [[0.0, 0.0], [3.0, 3.0]], rtol=0, atol=1e-8)


def test_the_branch_test_crosses_zero_linearly_whatever_the_size_of_the_system() -> None:
    """Thirty equations x_k (p + k) = 0 along x = 0: the determinant would be of the order of 30!."""
    values = []
    for p in (-1e-3, -1e-4, 1e-4, 1e-3):
        F_z = np.hstack([np.diag(p + np.arange(30.0)), np.zeros((30, 1))])
        values.append(branch_test(F_z, np.eye(31)[-1]))
    np.testing.assert_allclose(np.array(values) * (29.0 + np.array([-1e-3, -1e-4, 1e-4, 1e-3])),
                               np.array([-1e-3, -1e-4, 1e-4, 1e-3]), rtol=1e-9)  # fmt: skip


def test_events_come_in_their_order_and_at_their_places() -> None:
    """On the circle the tests 2 x − p and p³ − 0.1 are zero where trigonometry says; several lie within one step."""
    problem = circle(tests={"steep": lambda x, p: 2.0 * x[0] - p, "cube": lambda x, p: p**3 - 0.1})
    trace = followed(problem, np.array([1.0, 0.0]), settings=Settings(largest_angle=1.2, first_step=0.4))
    cube, steep = math.asin(0.1 ** (1.0 / 3.0)), math.atan(2.0)
    expected = [("cube", cube), ("steep", steep), ("fold", math.pi / 2), ("cube", math.pi - cube)]
    expected += [("steep", math.pi + steep), ("fold", 1.5 * math.pi)]
    assert [point.event for point in trace.events] == [name for name, _ in expected]
    places = [math.atan2(point.z[1], point.z[0]) % (2.0 * math.pi) for point in trace.events]
    np.testing.assert_allclose(places, [angle for _, angle in expected], rtol=0, atol=2e-9)
    assert all(a.arclength < b.arclength for a, b in zip(trace.points, trace.points[1:], strict=False))


def test_a_pair_of_zeros_of_a_test_within_a_step_is_seen() -> None:
    problem = scalar(lambda x, p: x - p, tests={"band": lambda x, p: (p - 0.77) ** 2 - 1e-4})
    trace = followed(problem, np.zeros(2), 1, (0.0, 2.0))
    assert [name for name, _ in named(trace)] == ["band", "band"]
    assert [p for _, p in named(trace)] == pytest.approx([0.76, 0.78], abs=1e-9)
    assert max(np.diff(trace.parameter)) > 0.1


def test_a_jump_of_a_test_is_located_too() -> None:
    problem = scalar(lambda x, p: x - p, tests={"jump": lambda x, p: 1.0 if p < 0.3 else -2.0})
    (event,) = followed(problem, np.zeros(2), 1, (0.0, 1.0)).events
    assert event.parameter == pytest.approx(0.3, abs=2e-9)


def test_an_event_at_an_accepted_point_comes_once() -> None:
    line = scalar(lambda x, p: x - p)
    place = followed(line, np.zeros(2), 1, (0.0, 1.0)).points[4].parameter
    for sign in (1.0, -1.0):
        problem = scalar(lambda x, p: x - p, tests={"here": lambda x, p, sign=sign: sign * (p - place)})
        trace = followed(problem, np.zeros(2), 1, (0.0, 1.0))
        assert named(trace) == [("here", pytest.approx(place, abs=1e-12))]
        assert np.diff(trace.parameter).min() > 1e-3


def test_an_event_in_a_hole_of_the_equations_is_given_its_doubt() -> None:
    """No solution for |p − 0.3| < 1e-4, where a test is zero: the event is the nearest point that was found."""
    problem = scalar(
        lambda x, p: x - p if abs(p - 0.3) > 1e-4 else math.nan,
        jacobian=lambda x, p: np.array([[1.0, -1.0]]),
        tests={"hidden": lambda x, p: p - 0.3},
    )
    trace = followed(problem, np.zeros(2), 1, (0.0, 1.0))
    assert (trace.end, [name for name, _ in named(trace)]) == (End.LEFT_RANGE, ["hidden"])
    (event,) = trace.events
    assert 1e-4 <= abs(event.parameter - 0.3) <= event.within < 0.3
    assert event.z[0] == pytest.approx(event.parameter, abs=1e-12)


@pytest.mark.parametrize("times", [1, 2])
def test_an_event_is_located_although_a_correction_on_the_way_to_it_fails(times: int) -> None:
    class Refusing(Counted):
        farthest, refused = -math.inf, 0

        def correct(self, guess: Array, normal: Array) -> Corrected:
            got = super().correct(guess, normal)
            back, self.farthest = guess[-1] < self.farthest, max(self.farthest, guess[-1])
            self.refused += back
            return got._replace(converged=got.converged and not (back and self.refused <= times))

    problem = Refusing(scalar(lambda x, p: x - p, tests={"level": lambda x, p: math.exp(3.0 * p) - 2.0}))
    (event,) = followed(problem, np.zeros(2), 1, (0.0, 1.0)).events
    assert problem.refused > times
    assert event.parameter == pytest.approx(math.log(2.0) / 3.0, abs=1e-8) and event.within < 1e-7


def test_a_terminal_event_is_the_last_point() -> None:
    problem = circle(tests={"down": lambda x, p: x[0] + 0.5})
    trace = followed(problem, np.array([1.0, 0.0]), settings=Settings(terminal=("down",)))
    assert (trace.end, [name for name, _ in named(trace)]) == (End.TERMINAL, ["fold", "down"])
    assert trace.points[-1] is trace.events[-1]
    np.testing.assert_allclose(trace.points[-1].z, [-0.5, math.sqrt(0.75)], rtol=0, atol=1e-9)


def test_a_start_on_a_terminal_event_is_left() -> None:
    """A branch begins where a test is zero but for rounding; its other zero ends it."""
    problem = circle(tests={"level": lambda x, p: p - 1e-13})
    trace = followed(problem, np.array([1.0, 0.0]), settings=Settings(terminal=("level",)))
    assert (trace.end, [name for name, _ in named(trace)]) == (End.TERMINAL, ["level", "fold", "level"])
    np.testing.assert_allclose(trace.points[-1].z, [-1.0, 0.0], rtol=0, atol=1e-9)


@pytest.mark.parametrize("order", [("level", "apart"), ("apart", "level")])
def test_a_start_on_an_event_is_left_whatever_else_is_watched(order: tuple[str, str]) -> None:
    tests = {"level": lambda x, p: p - 1e-13, "apart": lambda x, p: x[0] + 3.0}
    problem = circle(tests={name: tests[name] for name in order})
    trace = followed(problem, np.array([1.0, 0.0]), settings=Settings(terminal=("level",)))
    assert (trace.end, [name for name, _ in named(trace)]) == (End.TERMINAL, ["level", "fold", "level"])


# --- the curve is not left ---


@settings(deadline=None, max_examples=40)
@given(
    st.floats(0.05, 20.0),
    st.floats(-3.0, 3.0),
    st.floats(0.0, 2.0 * math.pi),
    st.floats(0.05, 1.0),
    st.sampled_from([0.1, 1.0, 10.0]),
    st.sampled_from([1, -1]),
)
def test_every_point_lies_on_the_ellipse_and_none_comes_twice(
    stretch: float, slant: float, start: float, angle: float, scale: float, direction: int
) -> None:
    """x = stretch (cos t + slant sin t), p = sin t: closed, folds at p = ±1, whatever the scale and the steps."""
    problem = scalar(lambda x, p: (x / stretch - slant * p) ** 2 + p * p - 1.0, [scale * stretch, scale])
    z = np.array([math.cos(start) + slant * math.sin(start), math.sin(start)]) / scale
    trace = followed(problem, z, direction, settings=Settings(largest_angle=angle))
    assert trace.end is End.CLOSED
    assert sorted(p for _, p in named(trace)) == pytest.approx([-1.0, 1.0], abs=1e-9)
    x, p = trace.physical.T
    cosine = x / stretch - slant * p
    np.testing.assert_allclose(np.hypot(cosine, p), 1.0, rtol=0, atol=1e-10)
    t = np.unwrap(np.arctan2(p, cosine))
    forward = np.diff(t) * np.sign(t[-1] - t[0])
    assert abs(t[-1] - t[0]) == pytest.approx(2.0 * math.pi, abs=1e-9)
    assert forward.min() > 0.0
    assert turns(trace).max() <= angle + 1e-9


def test_a_scale_a_thousand_times_larger_gives_the_same_curve_and_events() -> None:
    plain, large = (followed(circle(size), np.array([1.0, 0.0]) / size) for size in (1.0, 1000.0))
    assert plain.end is large.end is End.CLOSED
    np.testing.assert_allclose(
        large.scale * [e.z for e in large.events], plain.scale * [e.z for e in plain.events], rtol=0, atol=1e-9
    )
    np.testing.assert_allclose(np.linalg.norm(large.physical, axis=1), 1.0, rtol=0, atol=1e-9)


@pytest.mark.parametrize(("gap", "angle"), [(0.3, 0.35), (0.1, 0.35), (0.02, 0.1), (0.005, 0.05)])
def test_a_step_does_not_reach_a_parallel_branch(gap: float, angle: float) -> None:
    """Three sines one above the other; the nearest are told apart by a smaller largest angle."""

    def residual(x: float, p: float) -> float:
        curve = math.sin(2.0 * p)
        return (x - curve) * (x - curve - gap) * (x - curve + gap)

    trace = followed(scalar(residual), np.zeros(2), 1, (0.0, 6.0), Settings(largest_angle=angle))
    assert trace.end is End.LEFT_RANGE
    np.testing.assert_allclose(trace.physical[:, 0], np.sin(2.0 * trace.parameter), rtol=0, atol=1e-9)


def test_an_isola_beside_another_branch_closes() -> None:
    """A thin ellipse around (1, 2), 0.05 above the branch x = 0.85."""
    problem = scalar(lambda x, p: (x - 0.85) * (((x - 1.0) / 0.1) ** 2 + (p - 2.0) ** 2 - 1.0))
    trace = followed(problem, np.array([1.1, 2.0]), 1, (0.0, 4.0))
    assert trace.end is End.CLOSED
    assert [p for _, p in named(trace)] == pytest.approx([3.0, 1.0], abs=1e-9)
    assert trace.physical[:, 0].min() == pytest.approx(0.9, abs=2e-3)


def test_a_helix_is_not_closed_when_it_comes_by_its_start() -> None:
    """The turns are 0.06 apart, less than a step."""
    problem = Equations(
        lambda x, p: np.array([x[0] - math.cos(p), x[1] - math.sin(p)]),
        lambda x, p: np.array([[1.0, 0.0, math.sin(p)], [0.0, 1.0, -math.cos(p)]]),
        scale=[1.0, 1.0, 100.0],
    )
    trace = followed(problem, np.array([1.0, 0.0, 0.0]), 1, (-1.0, 20.0))
    assert (trace.end, trace.parameter[-1]) == (End.LEFT_RANGE, 20.0)
    np.testing.assert_allclose(trace.physical[:, 0], np.cos(trace.parameter), rtol=0, atol=1e-9)


def test_a_corner_is_turned() -> None:
    """x = max(p, 0): the tangent turns by 45° at once."""
    problem = scalar(lambda x, p: x - max(p, 0.0), jacobian=lambda x, p: np.array([[1.0, -1.0 if p > 0.0 else 0.0]]))
    trace = followed(problem, np.array([0.0, -1.0]), 1, (-1.0, 1.0))
    assert trace.end is End.LEFT_RANGE
    np.testing.assert_allclose(trace.physical[:, 0], np.maximum(trace.parameter, 0.0), rtol=0, atol=1e-12)
    assert len(trace.points) < 40


# --- where a trace begins and ends ---


@pytest.mark.parametrize(("direction", "bound"), [(1, 0.6), (-1, -0.7)])
def test_the_last_point_is_exactly_on_the_bound(direction: int, bound: float) -> None:
    trace = followed(circle(), np.array([1.0, 0.0]), direction, (-0.7, 0.6))
    assert trace.end is End.LEFT_RANGE
    assert trace.points[-1].parameter == bound
    assert trace.points[-1].z[0] == pytest.approx(math.sqrt(1.0 - bound * bound), abs=1e-12)


def test_both_ways_joins_the_two_sides_in_order() -> None:
    trace = both_ways(circle(), np.array([-1.0, 0.0]), (-0.7, 0.6))
    assert (trace.began, trace.end) == (End.LEFT_RANGE, End.LEFT_RANGE)
    assert (trace.parameter[0], trace.parameter[-1]) == (-0.7, 0.6)
    assert np.diff(trace.parameter).min() > 0.0
    assert np.diff([point.arclength for point in trace.points]).min() > 0.0
    assert all(point.tangent[1] > 0.0 for point in trace.points)


@pytest.mark.parametrize("bound", [1.000001, 1.0])
@pytest.mark.parametrize("angle", [0.01, 1.0, 2.0, 3.0, 4.0])
def test_a_bound_that_a_fold_does_not_pass_is_not_left(bound: float, angle: float) -> None:
    for direction in (1, -1):
        trace = followed(circle(), np.array([math.cos(angle), math.sin(angle)]), direction, (-bound, bound))
        assert (trace.end, len(trace.events)) == (End.CLOSED, 2)


@pytest.mark.parametrize("before", [1e-2, 1e-4, 1e-6, 1e-8, 3e-9])
def test_a_bound_just_before_a_fold_is_left(before: float) -> None:
    trace = followed(circle(), np.array([1.0, 0.0]), 1, (-1.0, 1.0 - before))
    assert (trace.end, trace.events) == (End.LEFT_RANGE, ())
    assert trace.points[-1].parameter == 1.0 - before
    assert trace.points[-1].z[0] == pytest.approx(math.sqrt((2.0 - before) * before), abs=2e-9)


@pytest.mark.parametrize("bound", [0.3849002, 0.386, 0.39])
def test_a_bound_beyond_a_fold_does_not_lead_to_another_branch(bound: float) -> None:
    """With p held there only the far branch is left: the curve reaches it by both folds, not by a jump."""
    trace = followed(scalar(hysteresis), np.array([-1.2, -0.5]), 1, (-0.5, bound))
    assert [name for name, _ in named(trace)] == ["fold", "fold"]
    assert trace.points[-1].z[0] == pytest.approx(2.0 / math.sqrt(3.0), abs=5e-3)
    assert turns(trace).max() <= Settings().largest_angle


def test_a_bound_met_without_warning_is_met_exactly() -> None:
    """At the start of p = x² the first prediction does not grow; the point corrected from it is far outside."""
    trace = followed(scalar(lambda x, p: p - x * x), np.zeros(2), 1, (-1.0, 1e-4))
    assert (trace.end, trace.points[-1].parameter) == (End.LEFT_RANGE, 1e-4)
    assert abs(trace.points[-1].z[0]) == pytest.approx(1e-2, abs=1e-14)


@pytest.mark.parametrize("direction", [1, -1])
def test_equations_are_not_asked_beyond_the_bound_of_a_smooth_branch(direction: int) -> None:
    problem = scalar(
        lambda x, p: x - p**3 if abs(p) <= 1.0 else math.nan,
        jacobian=lambda x, p: np.array([[1.0, -3.0 * p * p]]),
    )
    trace = followed(problem, np.zeros(2), direction, (-1.0, 1.0))
    assert (trace.end, trace.points[-1].parameter) == (End.LEFT_RANGE, float(direction))
    assert len(trace.points) < 25


def test_a_corrector_that_cannot_hold_the_parameter_still_ends_on_the_bound() -> None:
    class Refusing(Counted):
        def correct(self, guess: Array, normal: Array) -> Corrected:
            got = super().correct(guess, normal)
            return got._replace(converged=abs(normal[-1]) < 1.0 or self.corrections == 1)

    trace = followed(Refusing(circle()), np.array([0.8, -0.6]), 1, (-0.7, 0.6))
    assert (trace.end, trace.points[-1].parameter) == (End.LEFT_RANGE, 0.6)
    assert trace.points[-1].z[0] == pytest.approx(0.8, abs=1e-9)


def test_a_start_on_the_bound_leads_in_or_ends_at_once() -> None:
    problem = scalar(lambda x, p: x - p)
    inward, outward = (followed(problem, np.ones(2), direction, (0.0, 1.0)) for direction in (-1, 1))
    assert (inward.end, inward.points[-1].parameter) == (End.LEFT_RANGE, 0.0)
    assert (outward.end, len(outward.points)) == (End.LEFT_RANGE, 1)


@given(st.floats(0.01, 100.0), st.floats(0.001, 1000.0))
def test_a_start_on_the_bound_is_inside_whatever_the_rounding(bound: float, scale: float) -> None:
    problem = scalar(lambda x, p: x - p, [bound, scale])
    for rounded in (bound / scale, bound * (1.0 / scale), np.nextafter(bound / scale, np.inf)):
        trace = followed(problem, np.array([1.0, rounded]), 1, (-bound, bound))
        assert (trace.end, len(trace.points)) == (End.LEFT_RANGE, 1)


def test_a_heading_out_of_the_span_ends_at_once() -> None:
    trace = both_ways(circle(), np.array([0.8, 0.5]), (-0.55, 0.55), heading=np.array([1.0, 0.0]))
    assert (trace.end, trace.began, len(trace.points)) == (End.LEFT_RANGE, None, 1)
    assert trace.points[0].parameter == pytest.approx(0.6, abs=1e-12)


def test_a_poor_start_is_corrected_at_its_parameter() -> None:
    first = next(steps(circle(), np.array([0.2, 0.5])))
    np.testing.assert_allclose(first.z, [math.sqrt(0.75), 0.5], rtol=0, atol=1e-12)


@pytest.mark.parametrize("start", [(0.05, 1.003), (-0.05, 1.003), (0.0, 1.001), (0.1, 1.01), (0.1, -1.01)])
def test_a_start_just_beyond_a_fold_begins_near_it_in_the_direction_asked_for(start: tuple[float, float]) -> None:
    for direction in (1, -1):
        trace = followed(circle(), np.array(start), direction)
        assert (trace.end, len(trace.events)) == (End.CLOSED, 2)
        assert direction * trace.points[0].tangent[1] > 0.0
        np.testing.assert_allclose(trace.points[0].z, start, rtol=0, atol=0.1)


def test_a_start_without_a_solution_fails() -> None:
    for problem in (scalar(lambda x, p: x * x + p * p + 1.0), scalar(lambda x, p: math.nan), circle()):
        trace = followed(problem, np.array([1.0, 3.0]))
        assert (trace.end, trace.points, trace.events, trace.physical.shape) == (End.START_FAILED, (), (), (0, 2))


def raising(x: float, p: float) -> float:
    return x - p + 0.0 * math.sqrt(0.3 - p)  # a ValueError beyond p = 0.3


def missing(x: float, p: float) -> float:
    return x - p if p < 0.4 else math.nan


@pytest.mark.parametrize(("function", "edge"), [(raising, 0.3), (missing, 0.4)])
def test_the_last_good_point_is_at_the_edge_of_the_equations(function: Any, edge: float) -> None:
    problem = scalar(function, jacobian=lambda x, p: np.array([[1.0, -1.0]]))
    trace = followed(problem, np.zeros(2), 1, (-1.0, 2.0))
    assert trace.end is End.STEP_TOO_SMALL
    assert 0.0 <= edge - trace.points[-1].parameter < 1e-6
    np.testing.assert_allclose(trace.physical[:, 0], trace.parameter, rtol=0, atol=1e-12)


def test_a_curve_is_followed_to_its_vertical_end() -> None:
    """x = √(1 − p) ends at p = 1, where its slope is infinite and its residual raises a ValueError beyond."""
    trace = followed(scalar(lambda x, p: x - math.sqrt(1.0 - p)), np.array([1.0, 0.0]), 1, (-1.0, 2.0))
    assert trace.end is End.STEP_TOO_SMALL
    np.testing.assert_allclose(trace.physical[:, 0] ** 2, 1.0 - trace.parameter, rtol=0, atol=1e-9)
    assert trace.points[-1].parameter > 0.999


def test_too_many_points_end_a_trace() -> None:
    trace = followed(circle(), np.array([1.0, 0.0]), settings=Settings(most_points=5))
    assert (trace.end, len(trace.points)) == (End.TOO_MANY_POINTS, 5)


def test_steps_can_be_taken_one_at_a_time_and_return_the_end() -> None:
    walk = steps(scalar(lambda x, p: x - p), np.zeros(2), 1, (0.0, 0.03))
    assert [round(next(walk).parameter, 12) for _ in range(2)] == [0.0, round(0.02 / math.sqrt(2.0), 12)]
    with pytest.raises(StopIteration) as stop:
        while True:
            next(walk)
    assert stop.value.value is End.LEFT_RANGE


def test_every_end_has_a_sentence_of_advice() -> None:
    assert all(end.advice.endswith(".") and ";" in end.advice for end in End)


# --- Python equations ---


def test_differences_and_a_given_jacobian_agree() -> None:
    problem = bratu(11)
    plain = Equations(lambda u, p: problem._F(np.r_[u, p / 3.0]), scale=problem.scale)
    z = np.r_[np.sin(np.linspace(0.3, 2.8, 10)), 0.7]
    np.testing.assert_allclose(plain._F_z(z), problem._F_z(z), rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize("angle", [0.3, math.pi / 2 - 1e-9, math.pi / 2, 2.0, -2.5])
def test_the_tangent_is_exact_also_where_the_parameter_can_hardly_be_held(angle: float) -> None:
    problem = circle(jacobian=lambda x, p: np.array([[2.0 * x[0], 2.0 * p]]))
    got = problem.correct(np.array([math.cos(angle), math.sin(angle)]), np.array([0.0, 1.0]))
    along = math.copysign(1.0, math.cos(angle))
    assert got.converged
    np.testing.assert_allclose(got.tangent, along * np.array([-math.sin(angle), math.cos(angle)]), rtol=0, atol=1e-9)


def test_a_users_mistake_is_passed_on() -> None:
    def refusing(x: Array, p: float) -> Array:
        raise ModelError("no such engine")

    with pytest.raises(ModelError, match="no such engine"):
        followed(Equations(refusing, scale=ONES), np.zeros(2))
    with pytest.raises(ModelError, match=r"residual: has a wrong shape; found \(2,\); allowed: \(1,\)"):
        followed(Equations(lambda x, p: np.zeros(2), scale=ONES), np.zeros(2))
    with pytest.raises(ModelError, match=r"jacobian: has a wrong shape; found \(1, 1\)"):
        followed(scalar(hysteresis, jacobian=lambda x, p: np.ones((1, 1))), np.zeros(2))
    with pytest.raises(ModelError, match=r"scale: .*-1"):
        scalar(hysteresis, scale=[1.0, -1.0])
    with pytest.raises(ModelError, match="tests: is taken; found fold"):
        scalar(hysteresis, tests={"fold": lambda x, p: p})


# --- settings ---


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"first_step": 0.0}, "first_step: must be a positive number; found 0.0"),
        ({"largest_step": math.inf}, "largest_step: must be a positive number; found inf"),
        ({"smallest_step": "1"}, "smallest_step: must be a positive number; found '1'"),
        ({"first_step": 0.7}, "first_step: .* found 0.7; allowed: 1e-07 to 0.5"),
        ({"largest_angle": 2.0}, "largest_angle: is too large; found 2.0; allowed: up to 1.5 rad"),
        ({"tolerance": 0.1}, "tolerance: is too large; found 0.1"),
        ({"most_points": 1}, "most_points: must be a whole number of at least 2; found 1"),
        ({"most_points": 10.5}, "most_points: .* found 10.5"),
        ({"terminal": "fold"}, "terminal: must be a tuple of names; found 'fold'"),
    ],
)
def test_settings_check_themselves(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ModelError, match=message):
        Settings(**given)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"start": np.zeros(3)}, "start: must be finite, one for each scale"),
        ({"start": np.array([0.0, math.nan])}, "start: must be finite"),
        ({"direction": 0}, "direction: must be 1 or -1; found 0"),
        ({"span": (1.0, 1.0)}, r"span: .* found \(1.0, 1.0\)"),
        ({"span": (0.5, 1.0)}, "start: lies outside of the span; found 0.0; allowed: 0.5 to 1.0"),
        ({"settings": Settings(terminal=("fald",))}, "terminal: .* found fald; did you mean 'fold'?"),
    ],
)
def test_what_steps_are_given_is_checked(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ModelError, match=message):
        followed(circle(), **{"start": np.array([1.0, 0.0]), **given})
