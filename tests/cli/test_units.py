"""Plain numbers at the command line are rpm, degrees, Nm and seconds, in every command, and its help says so."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from torsional.cli.app import command
from torsional.cli.hysteresis import listed
from torsional.cli.runs import seconds
from torsional.cli.spans import asked
from torsional.cli.transient import speed_over
from torsional.files import load_model

Run = Callable[..., Any]
RPM = np.pi / 30

SAME = [
    ("modes --speed 900 --torque 1200", "modes --speed 900rpm --torque 1.2kNm"),
    ("respond --speed 600:1000:100", "respond --speed 600rpm:1000:100rpm"),
    ("map --speed 600:1000:200 --torque 500:1500:500", "map --speed 600:1000:200rpm --torque 0.5:1.5:0.5kNm"),
    ("campbell --speed 600:2000:350 --torque 900", "campbell --speed 600:2000:350rpm --torque 900Nm"),
    ("hysteresis --speed 0,900 --sweep 5 --rate 3", "hysteresis --speed 0,900rpm --sweep 5deg --rate 3deg/s"),
]


@pytest.mark.parametrize(("plain", "written"), SAME, ids=lambda line: line.split()[0])
def test_a_plain_number_is_in_the_unit_of_the_help(torsional: Run, truck: str, plain: str, written: str) -> None:
    told, meant = (torsional(line[0], truck, *line[1:]) for line in (plain.split(), written.split()))
    assert (told.code, told.err) == (0, "")
    assert told.out == meant.out


def test_ranges_to_follow_and_times(truck: str) -> None:
    model = load_model(truck)
    span = asked(model, "600:1200", "1500", "")
    assert (span.low, span.high, span.torque) == (pytest.approx(600 * RPM), pytest.approx(1200 * RPM), 1500.0)
    assert span.value("900") == pytest.approx(900 * RPM)
    followed = asked(model, "900", "1200", "absorber.damping=2:20")  # as in the file
    assert (followed.low, followed.high, followed.value("5")) == (2.0, 20.0, 5.0)
    assert speed_over(model, "600:1200", 2.0)[0].range == pytest.approx((600 * RPM, 1200 * RPM))
    assert speed_over(model, "900", 2.0)[0].range[0] == pytest.approx(900 * RPM)
    assert seconds("3", "--duration", 1.0) == 3.0
    assert listed("5,60", "relative_angle", "--sweep") == pytest.approx(np.radians([5, 60]))


UNITS = {"--speed": "rpm", "--torque": "Nm", "--sweep": "degrees", "--rate": "deg/s", "--about": "degrees"}
UNITS |= {"--duration": " in s", "--step": " in s", "--set": "SI", "--setting": "SI", "--parameter": "SI"}


@pytest.mark.parametrize("name", sorted(command().commands))
def test_help_names_the_unit_of_plain_numbers(name: str) -> None:
    for option in command().commands[name].params:
        for flag in set(option.opts) & set(UNITS):
            assert UNITS[flag] in option.help, (name, flag)
