"""Units: factors against their definitions, and the sentence for everything that is no value."""

from __future__ import annotations

import itertools
import math
import subprocess
import sys
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

from torsional.errors import ModelError
from torsional.units import QUANTITIES, UNITS, convert, plausible, read, read_range, show

DEG = math.pi / 180
RPM = 2 * math.pi / 60


@pytest.mark.parametrize(
    ("text", "quantity", "expected"),
    [
        ("25 kNm/rad", "stiffness", 25e3),
        ("25kNm/rad", "stiffness", 25e3),
        ("  25   kNm / rad ", "stiffness", 25e3),
        ("25 kN m/rad", "stiffness", 25e3),
        ("25 kN·m/rad", "stiffness", 25e3),
        ("25 kN⋅m/rad", "stiffness", 25e3),
        ("25 kN*m/rad", "stiffness", 25e3),
        ("25\u00a0kNm/rad", "stiffness", 25e3),
        ("3 MNm/rad", "stiffness", 3e6),
        ("100 Nm/deg", "stiffness", 100 / DEG),
        ("1 kNm/°", "stiffness", 1000 / DEG),
        ("1 Nm", "torque", 1.0),
        ("2.5 kNm", "torque", 2500.0),
        ("700 mNm", "torque", 0.7),
        ("700 Nmm", "torque", 0.7),
        ("1 MNm", "torque", 1e6),
        ("30 Nms/rad", "damping", 30.0),
        ("30 Nm s/rad", "damping", 30.0),
        ("30 N m s/rad", "damping", 30.0),
        ("30 Nm/(rad/s)", "damping", 30.0),
        ("1 Nms/deg", "damping", 1 / DEG),
        ("1 Nm/rpm", "damping", 60 / (2 * math.pi)),
        ("1.2 kgm²", "inertia", 1.2),
        ("1.2 kgm2", "inertia", 1.2),
        ("1.2 kg m^2", "inertia", 1.2),
        ("1.2 kg·m²", "inertia", 1.2),
        ("1.2 kg*m**2", "inertia", 1.2),
        ("450 kgcm²", "inertia", 0.045),
        ("45000 kg mm²", "inertia", 0.045),
        ("4.5e7 g mm²", "inertia", 0.045),
        ("450 gm2", "inertia", 0.45),
        ("1 Nms²", "inertia", 1.0),
        ("180 deg", "angle", math.pi),
        ("180°", "angle", math.pi),
        ("20 mrad", "relative_angle", 0.02),
        ("1 rev", "angle", 2 * math.pi),
        ("720 °CA", "crank_angle", 4 * math.pi),
        ("−12 deg", "angle", -12 * DEG),
        ("1500 rpm", "speed", 1500 * RPM),
        ("1500 1/min", "speed", 157.07963267948966),
        ("1500 min⁻¹", "speed", 1500 * RPM),
        ("1500 min^-1", "speed", 1500 * RPM),
        ("1500 U/min", "speed", 1500 * RPM),
        ("157 rad/s", "speed", 157.0),
        ("25 Hz", "speed", 2 * math.pi * 25),
        ("25 Hz", "frequency", 25.0),
        ("90 deg/s", "angular_velocity", math.pi / 2),
        ("500 rad/s²", "acceleration", 500.0),
        ("60 rpm/s", "acceleration", 2 * math.pi),
        ("131 mm", "length", 0.131),
        ("12.8 l", "volume", 0.0128),
        ("40 t", "mass", 40e3),
        ("20 bar", "pressure", 20e5),
        ("79.3 GPa", "shear_modulus", 79.3e9),
        ("250 N/mm²", "pressure", 250e6),
        ("375 kW", "power", 375e3),
        ("1 hp", "power", 550 * 0.3048 * 4.4482216152605),
        ("1 PS", "power", 75 * 9.80665),
        ("80 km/h", "velocity", 80 / 3.6),
        ("7850 kg/m³", "density", 7850.0),
        ("7.85 g/cm3", "density", 7850.0),
        ("5 ms", "time", 5e-3),
        ("12 N/mm", "spring_rate", 12e3),
        ("97 %", "efficiency", 0.97),
        ("2.85", "gear_ratio", 2.85),
        ("2.85 -", "gear_ratio", 2.85),
        ("25", "stiffness", 25.0),
        (".5e+3 kgm²", "centrifugal_stiffness", 500.0),
        ("2 Nm/rad/(rad/s)²", "centrifugal_stiffness", 2.0),
        ("2 Nm s²/rad", "centrifugal_stiffness", 2.0),
        ("5bar", "pressure", 5e5),
        ("0bar", "pressure", 0.0),
        ("1.N", "force", 1.0),
    ],
)
def test_what_engineers_type(text: str, quantity: str, expected: float) -> None:
    assert read(text, quantity) == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize("value", [7, 7.0, np.float64(7), np.int64(7), np.float32(7), Fraction(7)])
def test_plain_numbers_are_si(value: object) -> None:
    read_value = read(value, "torque")
    assert read_value == 7.0
    assert type(read_value) is float


@pytest.mark.parametrize(
    ("value", "quantity", "sentence"),
    [
        ("25 kNm", "stiffness", "k: kNm is a torque, and a stiffness is wanted; found '25 kNm'; allowed: Nm/rad,"),
        ("25 Hz", "inertia", "Hz is an angular velocity or a frequency, and an inertia is wanted"),
        ("25 knm/rad", "stiffness", "the unit 'knm/rad' is unknown; found '25 knm/rad'; allowed: Nm/rad, "),
        ("25 knm/rad", "stiffness", "did you mean 'kNm/rad'?"),
        ("1.2 kg/m2", "inertia", "did you mean 'kgm²'?"),
        ("25 furlongs", "length", "the unit 'furlongs' is unknown"),
        ("5 m m", "length", "the unit 'm m' is unknown"),
        ("5 m s", "time", "the unit 'm s' is unknown"),
        ("1,500 rpm", "speed", "a comma is neither a decimal point nor a thousands separator here; write 1.5 or 1500"),
        ("1,5", "ratio", "a comma is neither"),
        ("1_500 rpm", "speed", "digits are not grouped by underscores"),
        ("1 500 rpm", "speed", "digits are not grouped by blanks"),
        ("12:30:00", "time", "one number is wanted, not a clock time or a range"),
        ("0x1F", "number", "numbers are decimal; hexadecimal"),
        ("0b11", "number", "numbers are decimal"),
        ("0o17", "number", "numbers are decimal"),
        ("nan", "torque", "a finite number is wanted; found 'nan'"),
        ("-inf Nm", "torque", "a finite number is wanted"),
        (".inf", "torque", "a finite number is wanted"),
        ("1e999 Nm", "torque", "a finite number is wanted; found '1e999 Nm'"),
        ("1e308 MNm", "torque", "a finite number is wanted"),
        (math.nan, "torque", "k: a finite number is wanted; found nan"),
        (math.inf, "torque", "a finite number is wanted; found inf"),
        (10**400, "torque", "a number this large is not read"),
        (True, "torque", "a torque is wanted: a number, or a text such as '1.5 Nm'; found True (bool)"),
        (np.bool_(True), "torque", "a torque is wanted"),
        (None, "gear_ratio", "a number is wanted: a number, or a text such as '1.5'; found None (NoneType)"),
        ([1.0], "torque", "found [1.0] (list)"),
        ({"a": 1}, "inertia", "an inertia is wanted: a number, or a text such as '1.5 kgm²'"),
        (1 + 0j, "torque", "(complex)"),
        (Decimal(1), "torque", "(Decimal)"),
        (b"1 Nm", "torque", "(bytes)"),
        ("", "torque", "a number is wanted, with or without a unit after it; found ''"),
        ("Nm", "torque", "a number is wanted"),
        ("--1 Nm", "torque", "a number is wanted"),
        ("1.2.3 Nm", "torque", "a number is wanted"),
        ("1/3", "ratio", "the unit '/3' is unknown"),
        ("1e", "ratio", "the unit 'e' is unknown"),
        ("٣ Nm", "torque", "a number is wanted"),
        ("1" * 200, "torque", "a number is wanted"),
        ("=1+1", "torque", "a number is wanted"),
        ("20 °C", "temperature", "the unit '°C' is unknown; found '20 °C'; allowed: K"),
    ],
)
def test_refused_with_a_sentence(value: object, quantity: str, sentence: str) -> None:
    with pytest.raises(ModelError) as caught:
        read(value, quantity, where="k")
    assert str(caught.value).startswith("k: ")
    assert sentence in str(caught.value)
    assert len(str(caught.value)) < 400


def test_control_characters_are_escaped_in_the_sentence() -> None:
    with pytest.raises(ModelError) as caught:
        read("1 \x1b[31mNm", "torque")
    assert str(caught.value).isprintable()


def test_an_unknown_quantity_is_named() -> None:
    with pytest.raises(ModelError, match="'stifness' is no quantity of the nomenclature; did you mean 'stiffness'"):
        read(1.0, "stifness")


def test_every_quantity_has_its_units() -> None:
    for name, quantity in QUANTITIES.items():
        assert quantity.name == name
        assert read(f"1 {quantity.unit}", name) == 1.0
        assert read(show(0.3, name), name) == pytest.approx(0.3, rel=1e-4)
        assert quantity.low < quantity.high


def test_every_spelling_converts_there_and_back() -> None:
    for table in UNITS.values():
        for old, new in itertools.permutations(table, 2):
            assert convert(convert(3.7, old, new), new, old) == pytest.approx(3.7, rel=1e-14)


def test_spellings_shared_by_kinds_agree_where_they_can_be_confused() -> None:
    assert convert(1.0, "Hz", "rad/s") == 2 * math.pi
    assert convert(1.0, "kHz", "Hz") == 1000.0
    with pytest.raises(ModelError, match="'Nm' cannot be converted to 'Nm/rad'"):
        convert(1.0, "Nm", "Nm/rad")


@pytest.mark.parametrize(
    ("value", "quantity", "unit", "expected"),
    [
        (25e3, "stiffness", None, "25 kNm/rad"),
        (25e3, "stiffness", "Nm/deg", "436.33 Nm/deg"),
        (1500 * RPM, "speed", None, "1500 rpm"),
        (math.pi, "angle", None, "180 deg"),
        (123456.0, "torque", None, "123456 Nm"),
        (-0.0, "torque", None, "0 Nm"),
        (2.85, "gear_ratio", None, "2.85"),
        (math.nan, "torque", None, "nan Nm"),
        (1.2, "inertia", "kgcm²", "12000 kgcm²"),
    ],
)
def test_shown_as_engineers_write(value: float, quantity: str, unit: str | None, expected: str) -> None:
    assert show(value, quantity, unit) == expected


def test_shown_in_a_unit_of_another_kind_is_refused() -> None:
    with pytest.raises(ModelError, match="rpm is an angular velocity, and a stiffness is wanted"):
        show(1.0, "stiffness", "rpm")


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("600:2000 rpm", (600, 2000)),
        ("600 : 2000 : 20 rpm", (600, 2000, 20)),
        ("600 rpm:2000 rpm", (600, 2000)),
        ("10 Hz:2000 rpm", (600, 2000)),
        (["600 rpm", "2000 rpm"], (600, 2000)),
        ([600 * RPM, "2000 1/min", "20 rpm"], (600, 2000, 20)),
    ],
)
def test_ranges(value: object, expected: tuple[float, ...]) -> None:
    assert read_range(value, "speed") == pytest.approx([RPM * part for part in expected], rel=1e-15)


@pytest.mark.parametrize(
    ("value", "sentence"),
    [
        ("2000:600 rpm", "a range must end above its start; found '2000:600 rpm'"),
        ("600:600 rpm", "a range must end above its start"),
        ("600:2000:0 rpm", "the step of a range must be positive"),
        ("600:2000:-5 rpm", "the step of a range must be positive"),
        ("600:2000:9000 rpm", "no longer than it"),
        ("600:2000:1e-9 rpm", "a range may have 1000000 points at most"),
        ("600 rpm", "a range is wanted; found '600 rpm'; allowed: '600:2000 rpm'"),
        ("1:2:3:4 rpm", "a range is wanted"),
        (600.0, "a range is wanted"),
        (True, "a range is wanted"),
        (None, "a range is wanted"),
        ([], "a range is wanted"),
        (":", "a number is wanted"),
        ("600: rpm", "a number is wanted"),
        ("600:nan rpm", "a finite number is wanted"),
        ("600:2000 Nm", "Nm is a torque, and an angular velocity is wanted"),
        ([1.0, [2.0]], "found [2.0] (list)"),
    ],
)
def test_ranges_refused(value: object, sentence: str) -> None:
    with pytest.raises(ModelError) as caught:
        read_range(value, "speed", where="operation.speed")
    assert str(caught.value).startswith("operation.speed: ")
    assert sentence in str(caught.value)


@pytest.mark.parametrize(
    ("value", "quantity", "hint"),
    [
        (45.0, "relative_angle", "45 rad is unusual for an angle of b relative to a (0 to 7 rad); if deg or "),
        (2000.0, "speed", "if rpm or deg/s was meant, write '2000 rpm'"),
        (8.0, "stiffness", "if kNm/rad or "),
        (1.2e6, "inertia", "kgmm²"),
        (131.0, "length", "if mm or cm or µm was meant, write '131 mm'"),
        (20.0, "pressure", "if bar or "),
        (40e6, "mass", "write '4e+07 g'"),
    ],
)
def test_slips_of_units_are_suspected(value: float, quantity: str, hint: str) -> None:
    (sentence,) = plausible(value, quantity)
    assert hint in sentence


@pytest.mark.parametrize(
    ("value", "quantity"),
    [
        (0.0, "stiffness"),
        (3.0e6, "stiffness"),
        (-2500.0, "torque"),
        (0.01, "inertia"),
        (1e4, "inertia"),
        (63.0, "speed"),
    ],
)
def test_a_truck_is_plausible(value: float, quantity: str) -> None:
    assert plausible(value, quantity) == ()


def test_reading_units_needs_no_numpy() -> None:
    code = "import sys, torsional.units; sys.exit('numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
