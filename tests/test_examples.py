"""Every example runs, and one number of each is asserted."""

from __future__ import annotations

import importlib.util
from typing import Any

import pytest

from tests.shipped import ROOT

EXPECTED: dict[str, dict[Any, float]] = {
    # 768.6/20 Hz: third-order speed 769 rpm of the clutch mode, by an independent prototype
    "01_first_look": {"clutch_mode": 38.43},
    # the stiffer the damper the higher the mode; 654 rpm at 25 kNm/rad by an independent prototype
    "02_softer_clutch": {25.0: 654.1},
    # eigh of the three-disc chain written by hand, the discs behind the gear divided by its ratio squared
    "03_parts_by_hand": {"500 Nm": 12.10, "1500 Nm": 19.21},
    # the two medians are this program's own figures: they guard against a change, not against wrong physics
    "04_two_flywheels_compared": {"median": 0.15907},
    "05_maps_as_a_picture": {"median": 0.10825},
    # Newton's equations of the same truck integrated in time from stage to stage and closed by shooting: the speeds at
    # which a multiplier is −1, and order 1.5 of the motion of twice the period
    "06_one_and_a_half_orders": {"begins": 839.538, "ends": 963.283, "gearbox_input": 453.600},
    # folds of example 01 of NLvib (Krack and Gross, 2019), as other programs find them
    "07_own_law_periodic": {"run down": 1.11570025, "run up": 1.26960196, "at the fall": 2.82501671},
    # in time, as above: the mean torque and the stiffness at which a multiplier just reaches −1
    "08_region_of_half_orders": {"highest torque": 1416.96, "softest": 18675.0},
    # harmonic balance of the two stable motions, 24 orders, from which steps of 5e-5 s are off by 0.01 %
    # each asserts within itself, against a closed form or another solver; these guard against a change
    "10_peak_over_stiffness": {"softest": 648.0, "stiffest": 728.0},
    "11_second_damper_ring": {"best": 199.05, "twist": 6.27647},
    "12_one_order_three_gears": {"12": 652.5},
    # 0.1 arsinh 1.5
    "13_own_law_in_the_truck": {"twist": 0.119476},
    "14_own_absorber": {"quietest": 1200.0},
    "15_into_a_spreadsheet": {"rows": 116, "rpm": 600.0},
    # as 01 and 02
    "16_all_files_of_a_folder": {"truck_smf": 654.1, "truck_dmf": 768.6},
    # two discs by hand
    "17_two_propellers": {"first": 2.915333, "second": 18.741321},
    "18_beside_a_measurement": {"best": 27e3},
    # 1500 Nm over 13 kNm/rad
    "19_in_a_notebook": {"twist": 6.61108},
    "09_up_and_down_in_time": {"up": 0.024260, "down": 0.108034, "before": 0.024260, "after": 0.108034},
}


@pytest.fixture(autouse=True)
def _at_the_root(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)


def test_every_example_is_expected() -> None:
    assert sorted(path.stem for path in (ROOT / "examples").glob("*.py")) == sorted(EXPECTED)


@pytest.mark.parametrize("name", EXPECTED)
def test_example(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    spec = importlib.util.spec_from_file_location(name, ROOT / "examples" / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    found = module.main()
    for key, value in EXPECTED[name].items():
        assert found[key] == pytest.approx(value, rel=5e-4)
    assert capsys.readouterr().out.strip()
