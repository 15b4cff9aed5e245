from __future__ import annotations

import numpy as np
import pytest

from torsional.engine import CrankLayout
from torsional.errors import ModelError

CROSS_PLANE = (1, 5, 4, 8, 6, 3, 7, 2)


def degrees(*angles: float) -> tuple[float, ...]:
    return tuple(np.radians(angles))


def test_six_in_line() -> None:
    six = CrankLayout.inline((1, 5, 3, 6, 2, 4))
    assert np.degrees(six.firing_angles) == pytest.approx([0, 480, 240, 600, 120, 360])
    # throws 1 and 6, 2 and 5, 3 and 4 point the same way
    assert np.degrees(six.throw_angles) == pytest.approx([0, 120, 240, 240, 120, 0])


def test_vee_eight_cross_plane_fires_evenly() -> None:
    eight = CrankLayout.vee(CROSS_PLANE, np.radians(90))
    assert eight.throw_count == 4
    assert np.degrees(eight.throw_angles) == pytest.approx([0, 270, 90, 180])
    assert eight.throw_members.sum(axis=1).tolist() == [2, 2, 2, 2]


def test_vee_eight_of_75_degrees_needs_uneven_firing() -> None:
    with pytest.raises(ModelError, match="throw 1 do not fire one bank angle apart; found 90°"):
        CrankLayout.vee(CROSS_PLANE, np.radians(75))
    uneven = CrankLayout.vee(CROSS_PLANE, np.radians(75), degrees(75, 105, 75, 90, 105, 75, 105, 90))
    assert np.degrees(uneven.firing_angles) == pytest.approx([0, 630, 450, 180, 75, 345, 525, 255])


def test_vee_six_with_split_pins() -> None:
    order = (1, 4, 2, 5, 3, 6)
    with pytest.raises(ModelError, match="bank_angle"):
        CrankLayout.vee(order, np.radians(90))
    assert CrankLayout.vee(order, np.radians(90), pin_split=np.radians(30)).throw_count == 3
    assert CrankLayout.vee(order, np.radians(60), degrees(60, 180, 60, 180, 60, 180)).throw_count == 3


def test_banks_by_throws_given() -> None:
    # left bank odd, right bank even, as on many American engines: 1-8-4-3-6-5-7-2
    eight = CrankLayout.vee((1, 8, 4, 3, 6, 5, 7, 2), np.radians(90), throws=(1, 1, 2, 2, 3, 3, 4, 4))
    assert eight.banks == (1, 2) * 4


@pytest.mark.parametrize(
    ("build", "where", "told"),
    [
        (lambda: CrankLayout.inline(()), "firing_order", "1 to 16"),
        (lambda: CrankLayout.inline(range(1, 18)), "firing_order", "17"),
        (lambda: CrankLayout.inline((1, 2, 2)), "firing_order", "1, 2, 2"),
        (lambda: CrankLayout.inline((1.0, 2.0)), "firing_order", "each a whole number"),
        (lambda: CrankLayout.inline("132"), "firing_order", "each a whole number"),
        (lambda: CrankLayout.inline((2, 1)), "firing_order", "begin with 1"),
        (lambda: CrankLayout.inline((1, 2), (360.0, 360.0)), "firing_intervals", "radians"),
        (lambda: CrankLayout.inline((1, 2), degrees(300, 300)), "firing_intervals", "600°"),
        (lambda: CrankLayout.inline((1, 2), degrees(720)), "firing_intervals", "one interval a firing"),
        (lambda: CrankLayout.inline((1, 2), (float("nan"), 1.0)), "firing_intervals", "finite"),
        (lambda: CrankLayout.vee((1, 2, 3), 1.0), "firing_order", "even number"),
        (lambda: CrankLayout.vee((1, 2), 0.0, throws=(1, 3)), "throws", "leave out no throw"),
        (lambda: CrankLayout.vee((1, 2, 3, 4), 0.0, throws=(1, 1, 1, 2)), "throws", "one of each bank"),
    ],
)
def test_refused(build, where: str, told: str) -> None:
    with pytest.raises(ModelError, match=told) as caught:
        build()
    assert caught.value.where == where
