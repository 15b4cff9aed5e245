"""Pressure traces.  The records are calculated with the built-in cycle; none is a measurement."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from torsional.engine import Engine, PressureTrace
from torsional.errors import ModelError

SPEED, TORQUE = 125.0, 1500.0
ORDERS = np.arange(0.0, 12.5, 0.5)
HEADER = "crank_angle [deg],pressure [bar]\n"


def record(engine: Engine, speed: float, torque: float, degrees: np.ndarray) -> np.ndarray:
    """Pressure of each cylinder [Pa] at crank angles [deg], as an indicating system would write it."""
    return engine.pressure(speed, torque, np.radians(degrees))


def table(header: str, *columns: np.ndarray, separator: str = ",") -> str:
    rows = zip(*(np.asarray(column).tolist() for column in columns), strict=True)
    return header + "\n" + "\n".join(separator.join(repr(value) for value in row) for row in rows)


def traced(engine: Engine, trace: PressureTrace) -> np.ndarray:
    return dataclasses.replace(engine, gas=trace).harmonics(SPEED, TORQUE, ORDERS)


def test_a_trace_gives_back_the_cycle_it_came_from(truck: Engine) -> None:
    degrees = np.arange(0.0, 720.0, 0.5)
    text = table("crank_angle [deg],pressure [bar]", degrees, record(truck, SPEED, TORQUE, degrees)[0] / 1e5)
    engine = dataclasses.replace(truck, gas=PressureTrace.from_text(text))
    assert engine.operated(SPEED, TORQUE).heat == pytest.approx([1.0], abs=1e-9)
    assert engine.harmonics(SPEED, TORQUE, ORDERS) == pytest.approx(truck.harmonics(SPEED, TORQUE, ORDERS), abs=1e-6)


def test_other_loads_scale_the_combustion_alone(truck: Engine) -> None:
    degrees = np.arange(0.0, 720.0, 0.5)
    engine = dataclasses.replace(truck, gas=PressureTrace(record(truck, SPEED, TORQUE, degrees)[0]))
    assert engine.harmonics(SPEED, [300.0, 2000.0], [0]).sum(axis=-2)[:, 0].real == pytest.approx([300.0, 2000.0])
    before = np.radians([-60.0, -45.0])
    low, high = engine.pressure(SPEED, [300.0, 2000.0], before)[:, 0]
    assert low == pytest.approx(high, rel=1e-12)


def test_angle_and_time_tell_the_same(truck: Engine) -> None:
    degrees = np.arange(-360.0, 360.0, 0.5)
    p = record(truck, SPEED, TORQUE, degrees)[0]
    by_angle = PressureTrace.from_text(table("crank_angle [deg],p (kPa)", degrees, p / 1e3))
    time = np.radians(degrees + 360) / SPEED
    by_time = PressureTrace.from_text(
        table("t [ms];p [MPa]", time * 1e3, p / 1e6, separator=";"), speed=SPEED, offset=-2 * np.pi
    )
    assert traced(truck, by_time) == pytest.approx(traced(truck, by_angle), abs=1e-7)


@pytest.mark.parametrize("end", [719.5, 720.0, 2159.5, 2160.0, 2400.0])
def test_end_points_and_cycles(truck: Engine, end: float) -> None:
    """A repeated end point, several cycles and a rest of one must not shift an order."""
    degrees = np.arange(0.0, end + 0.25, 0.5)
    trace = PressureTrace.from_text(table("angle [deg],p [Pa]", degrees, record(truck, SPEED, TORQUE, degrees)[0]))
    assert traced(truck, trace) == pytest.approx(truck.harmonics(SPEED, TORQUE, ORDERS), abs=1e-6)


@pytest.mark.parametrize("last", [719.5, 720.0])
def test_an_angle_that_starts_again(truck: Engine, last: float) -> None:
    degrees = np.tile(np.arange(0.0, last + 0.25, 0.5), 3)
    trace = PressureTrace.from_text(table("angle [deg],p [Pa]", degrees, record(truck, SPEED, TORQUE, degrees)[0]))
    assert traced(truck, trace) == pytest.approx(truck.harmonics(SPEED, TORQUE, ORDERS), abs=1e-6)


def test_cycles_are_averaged(truck: Engine) -> None:
    degrees = np.arange(0.0, 1440.0, 0.5)
    p = record(truck, SPEED, TORQUE, degrees)[0]
    uneven = p * np.where(degrees < 720, 1.02, 0.98)
    assert PressureTrace.sampled(np.radians(degrees), uneven).pressure[0] == pytest.approx(p[:1440], rel=2e-3)


def test_other_steps_are_resampled(truck: Engine) -> None:
    exact = truck.harmonics(SPEED, TORQUE, ORDERS)
    degrees = np.arange(0.1, 720.0, 0.2)
    trace = PressureTrace.sampled(np.radians(degrees), record(truck, SPEED, TORQUE, degrees)[0])
    assert np.abs(traced(truck, trace) - exact).max() < 1e-4 * np.abs(exact).max()
    degrees = np.arange(0.0, 720.0, 1.0)
    trace = PressureTrace.sampled(np.radians(degrees), record(truck, SPEED, TORQUE, degrees)[0])
    assert np.abs(traced(truck, trace) - exact).max() < 2e-3 * np.abs(exact).max()


def test_one_column_a_cylinder(truck: Engine) -> None:
    spread = dataclasses.replace(truck, heat_spread=(1.0, 1.06, 0.97, 1.0, 1.02, 0.95))
    degrees = np.arange(0.0, 720.0, 0.5)
    p = record(spread, SPEED, TORQUE, degrees)
    mixed = [3, 1, 2, 6, 5, 4]
    header = "angle [deg]," + ",".join(f"cyl {number} [bar]" for number in mixed)
    trace = PressureTrace.from_text(table(header, degrees, *(p[number - 1] / 1e5 for number in mixed)))
    expected = spread.harmonics(SPEED, TORQUE, ORDERS)
    assert traced(truck, trace) == pytest.approx(expected, abs=1e-5)
    own = np.array(
        [np.roll(row, -round(2 * np.degrees(phi))) for row, phi in zip(p, truck.layout.firing_angles, strict=True)]
    )
    assert traced(truck, PressureTrace(own, own_angle=True)) == pytest.approx(expected, abs=1e-5)
    with pytest.raises(ModelError, match="far from firing"):
        dataclasses.replace(truck, gas=PressureTrace(p[::-1]))


def test_recorded_deactivation(truck: Engine) -> None:
    half = dataclasses.replace(truck, deactivated=(1, 2, 3))
    p = record(half, SPEED, 700.0, np.arange(0.0, 720.0, 0.5))
    found = dataclasses.replace(truck, gas=PressureTrace(p)).harmonics(SPEED, 700.0, ORDERS)
    assert found == pytest.approx(half.harmonics(SPEED, 700.0, ORDERS), abs=1e-5)


def test_names_as_measuring_systems_write_them(truck: Engine) -> None:
    """Headers in quotes, numbers after a mark, units in capitals: none is taken for a comment or refused."""
    degrees = np.arange(0.0, 720.0, 0.5)
    p = record(truck, SPEED, TORQUE, degrees)[0]
    header = '"angle (DEG)";"pressure #1 [BAR]"'
    trace = PressureTrace.from_text(table(header, degrees, p / 1e5, separator=";"))
    assert trace.pressure[0] == pytest.approx(p, rel=1e-12)


def test_from_a_file(truck: Engine, tmp_path: Path) -> None:
    degrees = np.arange(0.0, 720.0, 1.0)
    text = table(
        "# a comment\ncrank_angle [deg]\tpressure [bar]",
        degrees,
        record(truck, SPEED, TORQUE, degrees)[0] / 1e5,
        separator="\t",
    )
    path = tmp_path / "trace.csv"
    path.write_text("\ufeff" + text, encoding="utf-8")
    assert PressureTrace.from_csv(path).pressure == pytest.approx(PressureTrace.from_text(text).pressure)
    with pytest.raises(ModelError, match=r"trace\.csv.*shorter"):
        path.write_text(HEADER + "0,1\n1,1\n", encoding="utf-8")
        PressureTrace.from_csv(path)


def lines(count: int = 720, **changed: str) -> str:
    rows = [f"{i},{2 + 50 * (i < 20 or i > 700)}" for i in range(count)]
    for place, row in changed.items():
        rows[int(place[1:])] = row
    return "\n".join(rows)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "at least two rows; found no line"),
        ("\n\n# only this\n", "found no line"),
        (HEADER, "at least two rows"),
        ("0,1\n1,2\n2,3\n", "no unit that is known"),
        ("crank_angle,pressure\n" + lines(), "no unit that is known"),
        ("crank_angle [deg],pressure [atm]\n" + lines(), r"atm.*bar"),
        ("pressure 1 [bar],pressure 2 [bar]\n" + lines(), "missing"),
        ("crank_angle [deg],angle [rad]\n" + lines(), "missing"),
        ("a [deg],pressure 1 [bar],pressure 3 [bar]\n" + "0,1,1\n1,1,1", "numbered"),
        (HEADER + lines(_7="7,nan"), r"line 9.*pressure \[bar\].*plain number.*nan"),
        (HEADER + lines(_7="7,1e999"), "line 9.*a finite number"),
        (HEADER + lines(_7="7,=A1*2"), "line 9.*formulas"),
        (HEADER + lines(_7="7,"), "line 9.*found nothing"),
        (HEADER + lines(_7="7,1,5"), "line 9.*2 cells are wanted; found 3 cells"),
        (HEADER.replace(",", ";") + lines(_7="7;1,5").replace(",", ";", 7), "decimals with a point|columns"),
        (HEADER + lines(_7="7,\x00"), "line 9"),
        (HEADER + lines(_7="5,2"), "must rise"),
        (HEADER + lines(600), "shorter than one cycle"),
        (HEADER + lines(_7="7,-1"), "above zero.*absolute"),
        (HEADER + lines(_7="7,5000"), "1000 bar"),
        (HEADER.replace("deg", "rad") + lines(), "too far apart"),
        ("time [s],pressure [bar]\n" + lines(), "needs the engine speed"),
    ],
)
def test_malformed(text: str, told: str) -> None:
    with pytest.raises(ModelError, match=told):
        PressureTrace.from_text(text)


def test_not_text(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_bytes(b"\xff\xfe\x00\x01binary")
    for path in (tmp_path / "a.csv", tmp_path, "/nowhere/trace.csv"):
        with pytest.raises(ModelError, match="cannot be read"):
            PressureTrace.from_csv(path)


def test_traces_an_engine_cannot_use(truck: Engine) -> None:
    degrees = np.arange(0.0, 720.0, 0.5)
    p = record(truck, SPEED, TORQUE, degrees)[0]
    for trace, told in [
        (PressureTrace(np.roll(p, 720)), "far from firing"),
        (PressureTrace(np.full(1440, 2e5)), r"not compressed as a gas is; found a polytropic exponent of -?0\.00"),
        (PressureTrace(truck.pressure_shapes.shapes[0] * 1e5), "does no work"),
        (PressureTrace(np.tile(p, (4, 1))), "does not fit"),
    ]:
        with pytest.raises(ModelError, match=told):
            dataclasses.replace(truck, gas=trace)
    with pytest.raises(ModelError, match="another shape"):
        PressureTrace(p[:100])
    with pytest.raises(ModelError, match="belong together"):
        PressureTrace.sampled([0.0, 1.0], [1.0])
