"""The command that tracks orders: what it finds, how it tells it, and what it refuses."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.measurements.run_ups import RPM, RunUp

import torsional as tv

Run = Callable[..., Any]
RUN = RunUp(800 * RPM, 200 * RPM, 3.0, {1.5: 5e-3 + 0j, 3.0: 2e-2 * np.exp(1j)})


@pytest.fixture
def record(table: str) -> str:
    Path("run.csv").write_text(table, encoding="utf-8")
    return "run.csv"


@pytest.fixture(scope="module")
def table() -> str:
    """A voltage of a 12−1 wheel, the torque behind it, the speed as it is told to all."""
    time = np.arange(0.0, 3.0, 1 / 8000)
    alpha = RUN.crank_angle(time)
    tooth = (alpha + RUN.vibration(alpha)) * 12 / (2 * np.pi)
    volts = 5.0 * (tooth % 1 < 0.5) * (np.floor(tooth) % 12 < 11)
    torque = 100 * np.cos(3 * alpha) + 20 * np.cos(1.5 * alpha + 0.5)
    columns = np.column_stack([time, volts, torque, RUN.speed(alpha) / RPM])
    text = io.StringIO()
    np.savetxt(text, columns, "%.7g", ",", header="time [s],tacho [V],M_gbx [Nm],n_mot [rpm]", comments="")
    return text.getvalue()


WHEEL = ("--tacho", "tacho", "--wheel", "12-1", "--orders", "1.5,3")


def test_orders_of_shaft_and_signal(torsional: Run, record: str) -> None:
    told = torsional("orders", record, *WHEEL, "-c", "M_gbx", "--json")
    assert (told.code, told.err) == (0, "")
    document = json.loads(told.out)
    variables = document["result"]["variables"]
    torque = np.array(variables["M_gbx"]["real"]) + 1j * np.array(variables["M_gbx"]["imaginary"])
    assert variables["M_gbx"]["dimensions"] == ["speed", "order"] and variables["M_gbx"]["units"] == "Nm"
    assert torque[:, 1] == pytest.approx(100.0, rel=5e-3)
    assert torque[:, 0] == pytest.approx(20.0 * np.exp(0.5j), rel=2e-2)
    angle = np.array(variables["angle"]["real"])[..., 0] + 1j * np.array(variables["angle"]["imaginary"])[..., 0]
    noise = np.array(variables["noise"]["values"])[:, 0]
    assert (abs(angle - [5e-3, 2e-2 * np.exp(1j)]) < 4 * noise[:, None]).all()
    assert document["shafts"]["tacho"] | {"speed_noise": 0} == {
        "source": "pulses", "teeth": 12, "speed_noise": 0, "gap": 54, "lost": 0, "extra": 0
    }  # fmt: skip


def test_tables_name_the_convention_and_the_noise(torsional: Run, record: str) -> None:
    told = torsional("orders", record, *WHEEL, "-c", "M_gbx", "--amplitude", "rms", "--as", "velocity")
    assert told.code == 0, told.err
    assert told.out.startswith("tacho: pulses, 2.9")
    assert "54 pulses in gaps put in; clock and counts make " in told.out
    assert (
        "tacho, torsional velocity [rpm]\norder  largest, RMS  at [rpm]  phase there [deg]  noise floor there\n"
        in told.out
    )
    rows = told.out.split("M_gbx\n")[1].splitlines()
    third = [float(cell) for cell in rows[3].split()]
    assert third[0] == 3.0 and third[1] == pytest.approx(100 / np.sqrt(2), rel=5e-3)


def test_files(torsional: Run, record: str) -> None:
    names = ["out.nc", "out.csv", "out.html", "out.png", "out.svg", "out.json"]
    outputs = [part for name in names for part in ("-o", name)]
    told = torsional("orders", record, *WHEEL, "-c", "M_gbx", "--amplitude", "peak-to-peak", *outputs)
    assert told.code == 0, told.err
    assert told.err.splitlines() == [f"written: {name}" for name in names]
    held = tv.load_results("out.nc")
    assert held.M_gbx.dims == ("speed", "order")
    with Path("out.csv").open(encoding="utf-8-sig", newline="") as file:
        header, *rows = csv.reader(file)
    column = header.index("M_gbx, peak-to-peak [Nm]")
    assert float(rows[1][column]) == pytest.approx(2 * abs(complex(held.M_gbx[0, 1])), rel=1e-12)
    page = Path("out.html").read_text(encoding="utf-8")
    assert page.count("<img ") == 1 + 2 + 4 + 1
    assert "amplitudes are peak-to-peak" in page


@pytest.mark.parametrize("picture", ["map", "waterfall", "frequencies", "speed"])
def test_pictures_by_name(torsional: Run, record: str, picture: str) -> None:
    told = torsional("orders", record, *WHEEL, "--picture", picture, "-o", "p.png", "-q")
    assert (told.code, told.out, told.err) == (0, "", "")
    assert Path("p.png").read_bytes().startswith(b"\x89PNG")


def test_the_only_channel_that_can_be_a_tacho_is_taken(torsional: Run, record: str) -> None:
    told = torsional("orders", record, "-c", "all", "-n", "3", "--json")
    assert told.code == 0, told.err
    found = json.loads(told.out)
    assert found["tacho"] == "n_mot"
    assert {"M_gbx", "tacho", "angle", "noise"} == set(found["result"]["variables"])


def test_usual_orders_are_those_that_all_channels_tell(torsional: Run, record: str) -> None:
    """12 teeth a turn, a tenth farther apart where it vibrates, at 2.56 a period: order 4.3 at the most."""
    told = torsional("orders", record, "--tacho", "tacho", "--wheel", "12-1", "--json")
    assert told.code == 0, told.err
    assert max(json.loads(told.out)["result"]["coordinates"]["order"]["values"]) == 4.0


def test_a_further_shaft(torsional: Run, record: str) -> None:
    told = torsional("orders", record, "--tacho", "n_mot", "--shaft", "tacho=12-1", "-n", "3", "--json")
    assert told.code == 0, told.err
    found = json.loads(told.out)["result"]
    assert found["coordinates"]["node"]["values"] == ["n_mot", "tacho"]


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (("--tacho", "tacho"), r"tacho: the number of teeth of this voltage's wheel is wanted; say it as --wheel 60"),
        (("--tacho", "taco", "--wheel", "60"), "--tacho: there is no channel 'taco'; did you mean 'tacho'?"),
        (("--tacho", "tacho", "--wheel", "12-2"), "it looks like a wheel of 12 teeth, 1 of them missing (12-1)"),
        (("--tacho", "tacho", "--wheel", "twelve"), "--wheel: teeth a turn are wanted; found 'twelve'"),
        ((*WHEEL, "-c", "M_gxb"), "--channel: there is no channel 'M_gxb'; did you mean 'M_gbx'?"),
        ((*WHEEL, "--amplitude", "peak"), "--amplitude: there is no such choice; found 'peak'; allowed: 0-peak, RMS"),
        ((*WHEEL, "--window", "hamming"), "--window: there is no such choice"),
        ((*WHEEL, "--cycles", "none"), "--cycles: a whole number is wanted"),
        ((*WHEEL, "--cycles", "1"), "no such window; found hann, 1 cycles"),
        (("--tacho", "tacho", "--wheel", "12-1", "-n", "1.3"), "orders: the window does not hold whole periods"),
        (("--tacho", "tacho", "--wheel", "12-1", "-n", "12"), "tacho: the channel is sampled too seldom"),
        ((*WHEEL, "--marks", "M_gbx"), "the marks stand at different crank angles"),
        ((*WHEEL, "-o", "out.xlsx"), "--output"),
        ((*WHEEL, "-o", "run.csv"), "this would overwrite an input file"),
        ((*WHEEL, "--shaft", "n_mot", "--ratio", "-1"), "ratio"),
        ((*WHEEL, "-n", "0"), "an engine order is positive"),
    ],
)
def test_what_cannot_be_is_refused(torsional: Run, record: str, line: tuple[str, ...], said: str) -> None:
    before = Path("run.csv").read_bytes()
    told = torsional("orders", record, *line)
    assert (told.code, told.out) == (2, "")
    assert said in told.err
    assert told.err.count("\n") == 1
    assert [path.name for path in Path().iterdir()] == ["run.csv"] and Path("run.csv").read_bytes() == before


def test_a_file_that_is_none(torsional: Run) -> None:
    told = torsional("orders", "nothing.csv", "--tacho", "n")
    assert told.code == 2
    assert "nothing.csv: there is no such file" in told.err
    Path("two.csv").write_text("time [s],a [Nm],b [Nm]\n0,1,1.5\n1,2,1\n2,2,2\n")
    told = torsional("orders", "two.csv")
    assert "--tacho: the channel that tells how the engine turns is wanted; allowed: a, b; as --tacho 'a'" in told.err
