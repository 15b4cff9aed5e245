"""Names of variants and numbers in sentences."""

from __future__ import annotations

import pytest

from torsional.absorbers import Absorber
from torsional.model import Landmarks, Model
from torsional.report.labels import gears_told, labels, rounded, told


def models(*names: str) -> list[Model]:
    return [Model(name, {}, Landmarks()) for name in names]


@pytest.mark.parametrize(
    ("names", "short"),
    [
        (("truck with a DMF", "truck with an SMF"), ["a DMF", "an SMF"]),
        (("truck with a DMF", "truck with a two-stage DMF"), ["DMF", "two-stage DMF"]),
        (("truck", "truck DMF"), ["truck", "truck DMF"]),
        (("truck", "truck"), ["truck (1)", "truck (2)"]),
        (("My truck", "My truck"), ["My truck (1)", "My truck (2)"]),
        (("truck DMF",), ["truck DMF"]),
        (("", "b"), ["model", "b"]),
    ],
)
def test_labels_are_what_tells_models_apart(names: tuple[str, ...], short: list[str]) -> None:
    assert labels(models(*names)) == short


def test_copies_of_a_model_are_told_apart_by_their_absorbers() -> None:
    kinds = ["dual mass flywheel", "power split absorber"]
    assert (
        labels([Model("My truck", {}, Landmarks(), absorber=Absorber(kind, {}, "a", "b")) for kind in kinds]) == kinds
    )


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.0, "0"), (999.6, "1000"), (99.96, "100"), (1.0, "1"), (0.02749, "0.0275"), (float("nan"), "–")],
)
def test_three_digits(value: float, text: str) -> None:
    assert rounded(value) == text


def test_values_are_told_in_the_units_engineers_expect() -> None:
    assert told(80.5, "speed") == "769 rpm"
    assert told(0.1923, "relative_angle") == "11°"
    assert told(-2500.0, "torque") == "-2500 Nm"


def test_gears_are_told_as_ranges() -> None:
    known = [str(i) for i in range(1, 13)]
    assert gears_told(known, known) == "all 12 gears"
    assert gears_told(["1", "2", "3", "5", "6"], known) == "gears 1 to 3, 5 and 6"
    assert gears_told(["8"], known) == "gear 8"
    assert gears_told([""], [""]) == ""
