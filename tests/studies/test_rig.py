"""Loops of a rig: read from files, cleaned of noise, and a flywheel found in them; claims F1 and F2."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest

from torsional.absorbers import ArcSprings
from torsional.errors import ModelError
from torsional.numerics.arrays import Array
from torsional.solvers.hysteresis import Course, followed, hysteresis
from torsional.studies.base import Outcome
from torsional.studies.claims.identification import (
    POINTS,
    SENSORS,
    TRUTH,
    greased,
    identified_flywheel,
    misses,
    rig_flywheel,
    unknowns,
)
from torsional.studies.claims.rig_friction import VISCOUS, dry
from torsional.studies.estimates import Unknown
from torsional.studies.loop_torques import torques_in
from torsional.studies.records import Record, loops_of_file, loops_of_table, write_loops
from torsional.studies.rig import (
    Point,
    Sensors,
    found_on_rig,
    measured_on_rig,
    met,
    on_rig,
    torques_of,
    viscous_share,
    with_values,
)
from torsional.studies.trucks import Trucks
from torsional.units import RPM

FEW = tuple(Point(600 * RPM, float(np.radians(sweep)), load, 10.0) for sweep in (3.0, 6.0) for load in (0.0, 600.0))
EXACT = Sensors(noise=0.0)


def record(noise: float = 0.02, periods: float = 5.3, samples: int = 900) -> Record:
    """A hysteresis with corners: a spring of 100 Nm/rad and dry friction of 3 Nm."""
    draw = np.random.default_rng(5)
    time = np.linspace(0.0, periods / 7.0, samples)
    phase = 2.0 * np.pi * 7.0 * time + 0.4
    angle = 0.02 + 0.1 * np.sin(phase)
    torque = 100.0 * angle + 3.0 * np.sign(np.cos(phase))
    kicks = noise * draw.standard_normal((2, samples))
    return Record("loop", 100.0, time, angle + 0.1 * kicks[0], torque + 13.0 * kicks[1])


# --- records ---


def test_the_swing_out_of_noise() -> None:
    swing = record().swing
    assert swing.period == pytest.approx(1.0 / 7.0, rel=1e-3)
    assert swing.terms.size == 3 and swing.terms[0] == pytest.approx(0.02, abs=3e-4)
    assert np.hypot(*swing.terms[1:]) == pytest.approx(0.1, rel=5e-3)
    assert swing.begin * 7.0 % 1.0 == pytest.approx(1.0 - 0.4 / (2.0 * np.pi), abs=2e-3)
    course = record().course(100, offset=0.01)
    assert (course.centre, course.sweep) == pytest.approx((0.01, 0.1), rel=0.03)
    assert course.drive[24] == course.drive.max()


def test_a_triangle_keeps_its_corners() -> None:
    time = np.linspace(0.0, 6.2, 2000)
    angle = 0.1 * np.abs(4.0 * np.mod(time, 1.0) - 2.0) - 0.1
    swing = Record("sweep", 0.0, time, angle, angle).swing
    assert np.abs(swing.at(time) - angle).max() < 0.013 * 0.2  # the corner of 15 orders


@pytest.mark.parametrize("noise", [0.005, 0.02, 0.1])
def test_the_noise_of_the_torque_whatever_its_corners(noise: float) -> None:
    assert record(noise).noise == pytest.approx(13.0 * noise, rel=0.08)


def test_means_over_the_cycle() -> None:
    loop = record(noise=0.0)
    mean = loop.averaged(loop.angle, 20)
    exact = 0.02 + 0.1 * np.sin(2.0 * np.pi * (np.arange(20) + 0.5) / 20)
    assert np.abs(mean - exact).max() < 2e-3
    assert loop.of_cycle(loop.course(200).drive) == pytest.approx(loop.angle[loop.clear], abs=2e-4)


@pytest.mark.parametrize("noise", [0.0, 0.02])
def test_samples_beside_jumps_of_the_torque_are_left_out(noise: float) -> None:
    """Dry friction jumps where the swing turns, a quarter and three quarters of the way; a spring does not."""
    loop = record(noise)
    phase = np.mod((loop.time - loop.swing.begin) / loop.swing.period, 1.0)
    turned = np.abs(np.mod(phase, 0.5) - 0.25)
    assert not loop.clear[turned < 0.005].any() and loop.clear[turned > 0.03].all()
    assert dataclasses.replace(loop, torque=100.0 * loop.angle).clear.all()
    left, whole = (loop.averaged(values, 50) for values in (loop.torque[loop.clear], loop.torque))
    assert np.isnan(left).sum() == 2 and left[:10] == pytest.approx(whole[:10])


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"torque": lambda v: np.where(np.arange(v.size) == 7, np.nan, v)}, "must be finite; found 1 of torque"),
        ({"time": lambda v: v[:1], "angle": lambda v: v[:1], "torque": lambda v: v[:1]}, "too few samples"),
        ({"time": lambda v: v[:0], "angle": lambda v: v[:0], "torque": lambda v: v[:0]}, "too few samples"),
        ({"angle": lambda v: v[:-1]}, "too few samples"),
        ({"time": lambda v: v[::-1]}, "increasing times"),
        ({"angle": lambda v: 0.0 * v}, "stands still"),
        ({name: lambda v: v[:120] for name in ("time", "angle", "torque")}, "less than one cycle"),
    ],
)
def test_records_that_are_none(change: dict[str, object], told: str) -> None:
    loop = record(noise=0.0)
    values = {name: make(getattr(loop, name)) for name, make in change.items()}  # type: ignore[operator]
    with pytest.raises(ModelError, match=told):
        dataclasses.replace(loop, **values)


# --- files ---


def test_a_file_and_back(tmp_path: Path) -> None:
    loops = (record(), dataclasses.replace(record(0.05), speed=200.0))
    read = loops_of_file(write_loops(loops, tmp_path / "rig.csv"))
    assert [loop.name for loop in read] == ["loop 1", "loop 2"]
    for loop, again in zip(loops, read, strict=True):
        assert again.speed == pytest.approx(loop.speed, rel=1e-15)
        for name in ("time", "angle", "torque"):
            assert (getattr(again, name) == getattr(loop, name)).all()


def test_units_are_read_as_they_stand() -> None:
    loop = record()
    rows = zip(1e3 * loop.time, np.degrees(loop.angle), 1e-3 * loop.torque, strict=True)
    text = "torque [kNm];time [ms];speed [rpm];loop;angle [deg]\n" + "\n".join(
        f"{float(m)!r};{float(t)!r};600;3;{float(a)!r}" for t, a, m in rows
    )
    (again,) = loops_of_table(text)
    assert again.name == "loop 3" and again.speed == pytest.approx(600 * RPM)
    assert again.angle == pytest.approx(loop.angle) and again.torque == pytest.approx(loop.torque)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("loop,time [s],speed [rpm],angle [deg],torque [Nm]\n", "at least two rows"),
        ("loop,time [s],speed [rpm],angle [deg],torque [Nm]\n1,0,0,0,0\n1,1,0,0,nan\n", "line 3.*column 'torque'"),
        ("loop,time [s],speed [rpm],angle [deg],torque [Nm]\n1,0,0,0,0\n1,1,0,0,1\n", "loop 1: too few samples"),
        ("loop,time [s],angle [deg],torque [Nm]\n1,0,0,0\n1,1,0,0\n", "column 'speed' is missing"),
        ("loop,time,speed [rpm],angle [deg],torque [Nm]\n1,0,0,0,0\n1,1,0,0,1\n", "names no unit"),
        ("loop,time [s],speed [rpm],angle [deg],torque [Nm]\n1,0,0,0,0\n1,1,900,0,1\n", "not steady"),
    ],
)
def test_files_that_are_none(text: str, told: str, tmp_path: Path) -> None:
    path = tmp_path / "rig.csv"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError, match=told) as caught:
        loops_of_file(path)
    assert "rig.csv" in str(caught.value)


# --- the rig ---


def test_a_followed_triangle_is_the_sweep() -> None:
    """`followed` along the triangle of `hysteresis`: the same loop, but for its shorter settling."""
    system, sweep, samples = on_rig(rig_flywheel()), float(np.radians(4.0)), 720
    loops = hysteresis(system, "primary", "secondary", 100.0, sweep, rate=1.0, samples=samples)
    drive = np.asarray(loops.drive_angle.isel(sweep=0).values)
    (met_,) = followed(system, "primary", "secondary", [Course.through(100.0, drive, 4.0 * sweep)], miss=5e-4)
    closed = loops.drive_torque.isel(speed=0, sweep=0).sel(cycle="closed").values
    assert np.abs(met_.torque - closed).max() < 1e-6 * np.abs(closed).max()


@pytest.mark.parametrize("drive", [np.zeros(20), np.ones(3), np.array([0.0, np.nan] * 8)])
def test_courses_that_are_none(drive: Array) -> None:
    with pytest.raises(ModelError, match="course"):
        Course.through(0.0, drive, 1.0)


def test_viscous_share_of_grease_and_of_dry_friction() -> None:
    """All of it where nothing else rubs, none where nothing is viscous; in between what the two losses make of it."""
    point = FEW[1]
    grease = dataclasses.replace(rig_flywheel(), friction=None)
    coulomb = dry({"friction.sliding_coefficient": 0.08})
    course = Course.through(point.speed, 0.1 * np.sin(2 * np.pi * np.arange(1, 641) / 640), 0.1)
    for design, share in ((grease, 1.0), (coulomb, 0.0)):
        (loop,) = met(design, [course])
        assert viscous_share(on_rig(design), loop, 0.1) == pytest.approx(share, abs=0.02)


def test_numbers_of_a_design_by_name() -> None:
    made = with_values(rig_flywheel(), {"secondary_clearance": 0.01, "friction.sliding_coefficient": 0.04})
    assert made.secondary_clearance == (0.01, 0.01)
    assert made.friction is not None and made.friction.static == pytest.approx(0.05)
    both = with_values(made, {"friction.sliding_coefficient": 0.06, "friction.static_coefficient": 0.07})
    assert both.friction is not None and both.friction.static == 0.07
    for name in ("friction.slip", "grease", "radius.of"):
        with pytest.raises(ModelError, match="no such number"):
            with_values(rig_flywheel(), {name: 1.0})


def test_slopes_hardly_depend_on_the_step() -> None:
    """Friction bends predictions sharply; over the step that is used they still have a slope."""
    loops = measured_on_rig(rig_flywheel(), FEW, EXACT, seed=0)
    predicted = torques_of(greased, loops)
    base = np.concatenate(predicted(TRUTH))
    for name, true in TRUTH.items():
        near, far = (
            (np.concatenate(predicted({**TRUTH, name: true * (1 + step)})) - base) / step for step in (0.02, 0.06)
        )
        assert near @ far > 0.95 * np.linalg.norm(near) * np.linalg.norm(far), name


def test_noise_of_the_rig_is_found_in_its_loops() -> None:
    for loop, exact in zip(
        measured_on_rig(rig_flywheel(), FEW, SENSORS, seed=4),
        measured_on_rig(rig_flywheel(), FEW, EXACT, 4),
        strict=True,
    ):
        assert loop.noise == pytest.approx(0.02 * 0.5 * np.ptp(exact.torque), rel=0.05)


def test_a_flywheel_out_of_a_file(tmp_path: Path) -> None:
    """The way of real loops: nothing is known of them but the table."""
    path = write_loops(measured_on_rig(rig_flywheel(), FEW, SENSORS, seed=7), tmp_path / "rig.csv")
    names = ("spring.rate", "secondary_clearance", "friction.sliding_coefficient", "torque_offset", "angle_offset")
    asked = [unknowns()[name] for name in names]
    truth = {name: TRUTH[name] for name in VISCOUS}
    found = found_on_rig(lambda values: greased({**truth, **values}), loops_of_file(path), asked)
    for name in names[:3]:
        assert found.values[name] == pytest.approx(TRUTH[name], rel=0.02), name
    assert found.values["torque_offset"] == pytest.approx(12.0, abs=2.0)
    assert found.misfit == pytest.approx(1.0, abs=0.03) and not found.at_bounds()


def test_arc_springs_are_found_too(trucks: Trucks) -> None:
    design = arc_springs()
    points = [Point(speed * RPM, float(np.radians(4.0)), 0.0, 10.0) for speed in (0.0, 900.0)]
    loops = measured_on_rig(design, points, SENSORS, seed=3)
    asked = [Unknown("spring.rate", "spring_rate", 60e3, 30e3, 200e3)]
    asked += [Unknown("friction.sliding_coefficient", "friction_coefficient", 0.06, 0.03, 0.3)]
    asked += [unknowns()["torque_offset"], unknowns()["angle_offset"]]
    found = found_on_rig(lambda values: with_values(design, values), loops, asked)
    assert found.values["spring.rate"] == pytest.approx(89e3, rel=0.02)
    assert found.values["friction.sliding_coefficient"] == pytest.approx(0.09, rel=0.05)


def arc_springs() -> ArcSprings:
    from torsional.absorbers import CoilSpring, GuideFriction

    return ArcSprings(
        primary_inertia=1.1,
        secondary_inertia=1.0,
        channels=4,
        radius=0.15,
        channel_arc=1.3,
        stop_angle=0.3,
        spring=CoilSpring(rate=89e3, free_length=0.19, solid_length=0.1, mass=0.49),
        segments=6,
        friction=GuideFriction(0.09),
        grease_damping=0.1,
    )


@pytest.mark.parametrize("seed", [2, *(pytest.param(seed, marks=pytest.mark.full) for seed in range(3, 12))])
def test_all_parameters_are_recovered_whatever_the_noise(seed: int) -> None:
    found = identified_flywheel(measured_on_rig(rig_flywheel(), POINTS, SENSORS, seed))
    assert np.abs(misses(found)).max() < 0.05, found.values
    assert found.misfit < 1.05 and not found.at_bounds()


def test_a_dry_rig_needs_no_viscous_part() -> None:
    """The rejection of F2 is no habit: where the rig is dry Coulomb's friction explains it."""
    true = {"friction.sliding_coefficient": 0.08}
    loops = measured_on_rig(dry({**TRUTH, **true}), FEW, SENSORS, seed=2)
    asked = [each for name, each in unknowns().items() if name not in VISCOUS]
    found = found_on_rig(dry, loops, asked)
    assert found.misfit == pytest.approx(1.0, abs=0.02)
    assert found.values["friction.sliding_coefficient"] == pytest.approx(0.08, rel=0.02)


def test_each_loop_weighs_by_its_own_noise() -> None:
    loops = measured_on_rig(rig_flywheel(), FEW[:2], SENSORS, seed=1)
    assert [point.noise for point in torques_in(loops)] == [loop.noise for loop in loops]


# --- claims ---


def test_what_f1_recovers(outcomes: Mapping[str, Outcome]) -> None:
    finding = outcomes["F1"].finding
    assert finding.dataset is not None
    assert finding.dataset.miss.size == 5 and float(np.abs(finding.dataset.miss).max()) < 0.05
    assert any("channel_arc and secondary_clearance" in str(value) for value in finding.figures.values())


def test_what_f2_compares(outcomes: Mapping[str, Outcome]) -> None:
    finding = outcomes["F2"].finding
    told = {name: value for name, value in finding.figures.items() if isinstance(value, float)}
    full, coulomb, grease = (
        told[f"{name}: residuals over the noise, RMS [-]"]
        for name in ("viscous and dry friction", "Coulomb's friction", "grease alone")
    )
    assert full == pytest.approx(1.0, abs=0.01) and coulomb > 1.2 and grease > coulomb
    data = finding.dataset
    assert data is not None and (data.unloaded > data.loaded).all()
    assert (data.unloaded.diff("pace") > 0).all() and "0 rpm and ±1° from 20 Hz on" in finding.proviso
