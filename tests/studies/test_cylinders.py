"""G4 and the engines it compares: some cylinders without fuel, or fewer of them, against plain combustion sums."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping

import numpy as np
import pytest
from tests.shipped import shipped

from torsional.engine import CombustionCycle, CrankLayout
from torsional.errors import ModelError
from torsional.files import changed
from torsional.model import Model
from torsional.solvers.modal import natural_frequencies
from torsional.solvers.operating import at_operating_point
from torsional.studies import cylinders as asked
from torsional.studies.base import Outcome
from torsional.studies.cylinders import SECOND, SHORTER, WHOLE
from torsional.studies.trucks import lumped
from torsional.system import assemble
from torsional.units import RPM

SPEED = 900 * RPM


def test_every_second_fires_like_an_engine_of_half_the_cylinders() -> None:
    """Shut cylinders are gas springs: of the halved firing order they have nothing, so that it is that of three
    cylinders which give the same work; and they hold no mean torque but their friction."""
    truck = shipped("truck_smf")
    gas = CombustionCycle(boost=2e5)  # the same whatever the load
    six = truck.replaced(engine=dataclasses.replace(truck.running_engine, gas=gas))
    half = asked.deactivated(six, asked.every_second(six.running_engine.layout)).running_engine
    net = half.mean_torque_split(SPEED, 800.0).net
    firing = [place for place in range(6) if place + 1 not in half.deactivated]
    assert (np.delete(net, firing) < 0).all()
    three = asked.downsized(six, 3).running_engine
    own = three.harmonics(SPEED, net[firing].sum(), [1.5])
    assert abs(half.harmonics(SPEED, 800.0, [1.5]).sum(axis=-2)) == pytest.approx(abs(own.sum(axis=-2)), rel=1e-12)


def test_breathing_cylinders_take_their_compression_out_of_the_order() -> None:
    six = shipped("truck_smf")
    second = asked.every_second(six.running_engine.layout)
    shut, breathing = (
        float(abs(asked.deactivated(six, second, v).running_engine.harmonics(SPEED, 800.0, [1.5]).sum()))
        for v in ("closed", "working")
    )
    assert breathing < 0.8 * shut


def test_a_shorter_engine_is_the_one_of_the_model_file() -> None:
    """The same truck with an engine block of four cylinders has the same modes and the same torques."""
    six = shipped("truck_dmf")
    written = changed(six, "engine.layout=inline-4", "engine.firing_order=[1, 3, 4, 2]")
    four = asked.downsized(six, 4)
    pair = [natural_frequencies(at_operating_point(m, 0.0)[0])[1:] for m in (written, four)]
    assert pair[1] == pytest.approx(pair[0], rel=1e-12)
    told = [m.running_engine.harmonics(SPEED, 800.0, [2.0, 4.0]) for m in (written, four)]
    assert np.abs(told[1] - told[0]).max() < 1e-9
    assert four.full_load_peak() == pytest.approx(six.full_load_peak() * 4 / 6)
    assert len(four.landmarks.throws) == 4 and four.name == six.name


def test_two_throws_weigh_as_much_as_is_missing() -> None:
    whole, short = (assemble(m.powertrain()).M.sum() for m in _six_and_four())
    assert whole - short == pytest.approx(2 * 0.11)


def _six_and_four() -> tuple[Model, Model]:
    return shipped("truck_smf"), asked.downsized(shipped("truck_smf"), 4)


def test_a_rigid_engine_keeps_its_line() -> None:
    rigid = lumped(shipped("truck_smf"))
    assert asked.downsized(rigid, 4).components == rigid.components


def test_orders_of_a_passenger_car() -> None:
    car = shipped("passenger_car_dmf")
    models = {"DMF": asked.engines(car)}
    data = asked.compared(models, asked.part_loads(car)[:1] * 0 + 150.0, asked.part_loads(car))
    assert data.firing_order.values.tolist() == [2.0, 1.0, 1.0, 1.5]
    met = data.resonance.sel(concept="DMF")
    ratio = met.sel(engine=SECOND) / met.sel(engine=WHOLE)
    assert ratio.values == pytest.approx(2.0, rel=1e-12)


def test_g4_on_the_shipped_truck(outcomes: Mapping[str, Outcome]) -> None:
    figures = outcomes["G4"].finding.figures
    orders = {name: [figures[f"{c}, {name}: strongest order [-]"] for c in ("SMF", "DMF")] for name in _NAMES}
    assert orders == {WHOLE: [3.0, 3.0], SECOND: [1.5, 1.5], SHORTER: [2.0, 2.0]}
    assert figures[f"DMF, {SECOND}: DMF mode met at [rpm]"] == pytest.approx(828.8, abs=0.1)  # twice that of order 3
    assert figures[f"DMF, {SECOND}: largest swing at [rpm]"] == pytest.approx(825.0)
    assert figures[f"DMF, {SECOND}: largest swing over that of all cylinders [-]"] > 5  # type: ignore[operator]
    assert "valves of deactivated cylinders shut" in outcomes["G4"].finding.condition


_NAMES = (WHOLE, SECOND, SHORTER)


def test_cells_beyond_half_of_full_load_are_left_out(outcomes: Mapping[str, Outcome]) -> None:
    data = outcomes["G4"].finding.dataset
    assert data is not None
    inside = np.isfinite(data.swing.isel(concept=0, engine=0).values)
    half = shipped("truck_smf").full_load(data.speed.values) / 2
    assert (inside == (data.mean_torque.values[:, None] <= half)).all()


def test_refusals() -> None:
    with pytest.raises(ModelError, match="odd number"):
        asked.every_second(CrankLayout.inline((1, 2, 4, 5, 3)))
    with pytest.raises(ModelError, match="fewer cylinders"):
        asked.downsized(shipped("truck_smf"), 6)
    vee = CrankLayout.vee((1, 4, 2, 5, 3, 6), np.radians(120.0))
    six = shipped("truck_smf")
    with pytest.raises(ModelError, match="engines in line"):
        asked.downsized(six.replaced(engine=dataclasses.replace(six.running_engine, layout=vee)), 4)
    marks = dataclasses.replace(six.landmarks, throws=("throw1", "throw3", "throw5", "throw2", "throw4", "throw6"))
    with pytest.raises(ModelError, match="one shaft joins"):
        asked.downsized(six.replaced(landmarks=marks), 5)
