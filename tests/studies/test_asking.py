"""Claims asked of many trucks: parameters, samples, verdicts, processes."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from tests.shipped import shipped

from torsional.errors import ModelError
from torsional.files import changed
from torsional.model import Model
from torsional.studies import asking
from torsional.studies.asking import asked
from torsional.studies.base import Finding
from torsional.studies.register import claims
from torsional.studies.robustness import PARAMETERS, Answer, Samples, judged, parameters_of, varied, wilson
from torsional.studies.trucks import Trucks

TRUCKS = Trucks.shipped()
DOUBLE = ("dmf", "pendulum", "planetary", "tva", "two_stage", "arc_spring")
EVERY = ("smf", "psva", *DOUBLE)


def figure(model: Model, name: str) -> float:
    """``part.field`` of a model in top gear; of a law its ``soft`` and ``hard`` stiffness, torque at its ``hinge`` and
    ``stop``."""
    part, _, field = name.partition(".")
    if part == "engine":
        engine = model.running_engine
        return engine.full_load.torques[2] if field == "full_load" and engine.full_load else getattr(engine, field)
    found: Any = {**model.components, **model.gears[model.top_gear].components}[part]
    if field in ("soft", "hard", "hinge", "stop"):
        law, first = found.law, min(abs(found.law.straight.gap), default=0.0)
        angle = {"soft": 0.0, "hard": 1.01 * first, "hinge": 0.999999 * first}.get(field, max(law.stops, default=0.0))
        return float((law.tangent if field in ("soft", "hard") else law.torque)(np.array(angle)))
    return float(found.switch.inertia if field == "switched" else getattr(found, field))


# Of each parameter: trucks, figures of their parts, and by how much these are more when it is 20 % more.
BUILT: dict[str, tuple[tuple[str, ...], tuple[str, ...], float]] = {
    "connecting rod length": (EVERY, ("engine.rod_length",), 1.2),
    "reciprocating mass": (EVERY, ("engine.reciprocating_mass",), 1.2),
    "full-load torque": (EVERY, ("engine.full_load",), 1.2),
    "crank damper ring inertia": (EVERY, ("damper_ring.inertia",), 1.2),
    "crank damper hub inertia": (EVERY, ("damper_hub.inertia",), 1.2),
    "crank damper stiffness": (EVERY, ("damper.stiffness",), 1.2),
    "crank damper damping": (EVERY, ("damper.damping",), 1.2),
    "crank throw inertia": (EVERY, tuple(f"throw{number}.inertia" for number in range(1, 7)), 1.2),
    "crankshaft stiffness": (EVERY, ("crank_front.stiffness", "crank1.stiffness", "crank5.stiffness"), 1.2),
    "crank flange stiffness": (EVERY, ("crank6.stiffness",), 1.2),
    "crankshaft damping, relative": (EVERY, ("crank1.damping", "crank6.damping"), 1.2),
    "crankshaft damping, absolute": (EVERY, ("throw1_bearing.damping", "throw6_bearing.damping"), 1.2),
    "SMF inertia": (("smf",), ("flywheel.inertia",), 1.2),
    "DMF primary inertia": (DOUBLE[:-1], ("primary.inertia",), 1.2),
    "DMF secondary inertia": (DOUBLE, ("secondary.inertia",), 1.2),
    "DMF spring stiffness": (("dmf", "pendulum", "planetary"), ("dmf.soft",), 1.2),
    "DMF first-stage stiffness": (("two_stage",), ("dmf.soft",), 1.2),
    "DMF second-stage stiffness": (("two_stage",), ("dmf.hard",), 1.2),
    "DMF transition torque": (("two_stage",), ("dmf.hinge",), 1.2),
    "DMF stop torque": (("dmf", "pendulum", "planetary", "two_stage"), ("dmf.stop",), 1.2),
    "DMF damping": (("dmf", "pendulum", "planetary", "two_stage"), ("dmf.damping",), 1.2),
    "planetary DMF planet inertia": (("planetary",), ("planets.inertia", "planets.switched"), 1.2),
    "pendulum mass": (("pendulum",), ("pendulum.mass",), 1.2),
    "PSVA primary inertia": (("psva",), ("primary.inertia",), 1.2),
    "PSVA secondary inertia": (("psva",), ("secondary.inertia",), 1.2),
    "PSVA output inertia": (("psva",), ("output.inertia",), 1.2),
    "PSVA planet inertia": (("psva",), ("planets.inertia",), 1.2),
    "planet ratio": (("psva", "planetary"), ("planets.ratio",), 1.2),
    # r = 1/1.3 becomes 1 − 1.2 (1 − r)
    "PSVA gear quotient, its distance from 1": (("psva",), ("power_split.ratio",), 0.94),
    "PSVA spring stiffness": (("psva",), ("springs.soft",), 1.2),
    "PSVA stop torque": (("psva",), ("springs.stop",), 1.2),
    "PSVA damping": (("psva",), ("springs.damping",), 1.2),
    "TVA flange inertia": (("tva",), ("flange.inertia",), 1.2),
    "TVA inertia": (("tva",), ("tva.inertia", "tva_spring.stiffness"), 1.2),
    "TVA tuning speed": (("tva",), ("tva_spring.stiffness",), 1.44),
    "TVA damping": (("tva",), ("tva_spring.damping",), 1.2),
    "clutch disc inertia": (EVERY, ("clutch_disc.inertia",), 1.2),
    "clutch damper stiffness": (EVERY, ("clutch.soft",), 1.2),
    "clutch damper damping": (EVERY, ("clutch.damping",), 1.2),
    "clutch hub stiffness": (EVERY, ("clutch_hub.stiffness",), 1.2),
    "gearbox input inertia": (EVERY, ("gearbox_input.inertia",), 1.2),
    "gearbox mesh inertia": (EVERY, ("gearbox_mesh.inertia",), 1.2),
    "gearbox output inertia": (EVERY, ("gearbox_output.inertia",), 1.2),
    "gearbox stiffness": (EVERY, ("gearbox.stiffness",), 1.2),
    "propeller shaft stiffness": (EVERY, ("propeller_shaft.stiffness",), 1.2),
    "axle inertia": (EVERY, ("axle.inertia",), 1.2),
    "final drive ratio": (EVERY, ("final_drive.ratio",), 1.2),
    "half shaft stiffness": (EVERY, ("half_shafts.stiffness",), 1.2),
    "wheel inertia": (EVERY, ("wheels.inertia",), 1.2),
    "tyre stiffness": (EVERY, ("tyres.stiffness",), 1.2),
    "tyre damping": (EVERY, ("tyres.damping",), 1.2),
    "vehicle mass": (EVERY, ("vehicle.mass",), 1.2),
}
TWO_ROWS = {"DMF spring stiffness": "soft", "DMF stop torque": "stop", "DMF damping": "damping"}


class TestParameters:
    """What stands where, and what a factor does to it."""

    def test_those_of_the_shipped_trucks_are_all_here(self) -> None:
        assert {each.name for each in parameters_of(TRUCKS)} == set(BUILT)
        of_others = {"TVA spring stiffness", "clutch friction torque"}
        assert {each.name for each in PARAMETERS} == set(BUILT) | of_others

    @pytest.mark.parametrize("name", BUILT)
    def test_each_changes_what_it_names_and_no_other_truck(self, name: str) -> None:
        concepts, figures, ratio = BUILT[name]
        changed_trucks = varied(TRUCKS, {name: 1.2})
        for concept in concepts:
            before, after = TRUCKS.models[concept], changed_trucks.models[concept]
            for told in figures:
                assert figure(after, told) == pytest.approx(ratio * figure(before, told), rel=1e-4), (concept, told)
        named = next(each for each in PARAMETERS if each.name == name).concepts
        for concept in set(EVERY) - named:
            assert repr(changed_trucks.models[concept].components) == repr(TRUCKS.models[concept].components)

    @pytest.mark.parametrize("name", TWO_ROWS)
    def test_both_rows_of_springs_of_a_flange_absorber_are_changed(self, name: str) -> None:
        after = varied(TRUCKS, {name: 1.2}).tva
        for row in ("primary_springs", "secondary_springs"):
            told = f"{row}.{TWO_ROWS[name]}"
            assert figure(after, told) == pytest.approx(1.2 * figure(TRUCKS.tva, told), rel=1e-9)

    def test_every_gear_is_changed(self) -> None:
        stiffer = varied(TRUCKS, {"gearbox stiffness": 1.2}).dmf
        for gear, parts in stiffer.gears.items():
            before: Any = TRUCKS.dmf.gears[gear].components["gearbox"]
            after: Any = parts.components["gearbox"]
            assert after.stiffness == pytest.approx(1.2 * before.stiffness, rel=1e-12)

    def test_no_factor_is_the_same_truck(self) -> None:
        same = varied(TRUCKS, {each.name: 1.0 for each in PARAMETERS})
        for concept, model in TRUCKS.models.items():
            assert repr(same.models[concept].components) == repr(model.components)
            assert same.models[concept].engine is model.engine

    def test_the_trucks_of_one_sample_share_one_engine(self) -> None:
        heavier = varied(TRUCKS, {"reciprocating mass": 1.1, "full-load torque": 0.9})
        assert len({id(model.engine) for model in heavier.models.values()}) == 1
        assert heavier.smf.full_load_peak() == pytest.approx(0.9 * 2500.0, rel=1e-12)

    def test_of_a_users_own_truck_what_is_not_there_is_left_out(self) -> None:
        car = Trucks.of(shipped("passenger_car_dmf"))
        names = {each.name for each in parameters_of(car)}
        assert "clutch damper stiffness" in names and names <= {each.name for each in PARAMETERS}
        staged = changed(shipped("truck_smf"), {"clutch.stiffness": None, "clutch.stages": STAGES})
        softer = varied(Trucks.of(staged), {"clutch damper stiffness": 0.8})
        assert [stage["stiffness"] for stage in softer.smf.document["clutch"]["stages"]] == [4000.0, 20000.0]


STAGES = [{"up_to": 300.0, "stiffness": 5000.0}, {"stiffness": 25000.0}]


class TestSamples:
    """The hypercube, and one at a time."""

    samples = Samples(("a", "b", "c"), 200)

    def test_every_parameter_is_spread_evenly_within_its_twenty_percent(self) -> None:
        drawn = self.samples.together
        assert drawn.shape == (200, 3) and drawn.min() > 0.8 and drawn.max() < 1.2
        for column in drawn.T:  # one truck in each of 200 slices
            assert sorted(np.floor((column - 0.8) / 0.4 * 200).astype(int)) == list(range(200))

    def test_the_same_every_time(self) -> None:
        assert np.array_equal(self.samples.together, Samples(("a", "b", "c"), 200).together)

    def test_one_at_a_time_comes_after(self) -> None:
        assert len(self.samples) == 206
        assert [dict(self.samples.factors(number)) for number in (200, 201, 205)] == [
            {"a": 0.8},
            {"a": 1.2},
            {"c": 1.2},
        ]


class TestVerdicts:
    """Answers as figures."""

    samples = Samples(("mass", "stiffness"), 40)

    def test_wilsons_interval(self) -> None:
        # 15 of 20: R. G. Newcombe, Statistics in Medicine 17, 1998, 857-872, method 3, gives 0.5313 to 0.8881
        low, high = wilson(15, 20)
        assert (round(low, 4), round(high, 4)) == (0.5313, 0.8881)
        assert wilson(0, 20)[0] == 0.0 and wilson(20, 20)[1] == 1.0

    def test_shares_turns_and_reasons(self) -> None:
        answers = {number: Answer(True, number < 3, float(number)) for number in range(38)}
        answers |= {38: Answer(False, leading=38.0), 39: Answer(None, error="no root")}
        answers |= {40: Answer(True), 41: Answer(False), 42: Answer(None, error="no root"), 43: Answer(True)}
        told = judged("X1", Answer(True), answers, self.samples, "amplitude")
        assert (told.asked, told.held, told.conditional, told.failed, told.alone) == (40, 38, 3, 1, 4)
        assert told.share == 0.95 and told.interval == wilson(38, 40)
        assert [(turn.parameter, turn.factor, turn.verdict) for turn in told.turns] == [
            ("mass", 1.2, "not reproduced"),
            ("stiffness", 0.8, "not answered"),
        ]
        assert told.reasons == {"no root": 2}
        assert told.spread == pytest.approx(np.quantile(np.arange(39.0), (0.05, 0.5, 0.95)))
        assert told.separates is None  # two trucks are too few

    def test_the_parameter_that_separates_is_found(self) -> None:
        stiff = self.samples.together[:, 1] > 1.0
        answers = {number: Answer(bool(held)) for number, held in enumerate(stiff)}
        told = judged("X1", Answer(True), answers, self.samples, "")
        assert told.separates is not None
        name, difference = told.separates
        assert name == "stiffness" and difference > 2.0

    def test_chance_separates_nothing(self) -> None:
        names = tuple(f"parameter {number}" for number in range(50))
        samples, found = Samples(names, 200), 0
        for seed in range(40):
            held = np.random.default_rng(seed).random(200) < 0.85
            answers = {number: Answer(bool(one)) for number, one in enumerate(held)}
            found += judged("X1", Answer(True), answers, samples, "").separates is not None
        assert found <= 6  # 2 expected of 40


@pytest.fixture
def smaller(monkeypatch: pytest.MonkeyPatch) -> None:
    """Four uncertain parameters only, one of which turns D1."""
    names = ("DMF spring stiffness", "TVA tuning speed", "pendulum mass")
    few = tuple(each for each in PARAMETERS if each.name in names)
    monkeypatch.setattr(asking, "parameters_of", lambda trucks: few)


class TestAsked:
    """Claims asked of few trucks, in this process and in others."""

    @pytest.mark.usefixtures("smaller")
    def test_the_figures_are_the_same_in_two_processes_and_in_one(self) -> None:
        seen: list[tuple[int, int]] = []
        here = asked(TRUCKS, ("A6", "D1"), many=3, processes=1, progress=lambda *done: seen.append(done))
        there = asked(TRUCKS, ("A6", "D1"), many=3, processes=2)
        assert here.robustness == there.robustness and here.hashes == there.hashes
        for id, outcome in here.outcomes.items():
            assert repr(outcome.finding.figures) == repr(there.outcomes[id].finding.figures)
        assert seen[-1] == (20, 20) and [done for done, _ in seen] == sorted(done for done, _ in seen)

    @pytest.mark.usefixtures("smaller")
    def test_a_fragile_claim_is_turned_by_the_parameter_it_hangs_on(self) -> None:
        told = asked(TRUCKS, ["D1"], many=2, processes=1).robustness["D1"]
        assert [(turn.parameter, turn.factor) for turn in told.turns] == [("TVA tuning speed", 0.8)]
        assert told.alone == 6 and told.asked == 2

    @pytest.mark.usefixtures("smaller")
    def test_a_dear_claim_is_asked_of_fewer_and_of_none_with_one_other_parameter(
        self, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        study = dataclasses.replace(claims()["D1"], trucks=2)
        monkeypatch.setattr(asking, "claims", lambda: {"D1": study})
        told = asked(TRUCKS, many=4, processes=1).robustness["D1"]
        assert (told.asked, told.alone, told.turns) == (2, 0, ())

    def test_without_other_trucks_there_are_outcomes_alone(self) -> None:
        found = asked(TRUCKS, ["A6"], many=0, processes=1)
        assert list(found.outcomes) == ["A6"] and not found.robustness and not found.parameters

    def test_an_unknown_claim_and_a_model_without_file_are_refused(self) -> None:
        with pytest.raises(ModelError, match="there is no claim 'A77'"):
            asked(TRUCKS, ["A77"], many=0, processes=1)
        bare = dataclasses.replace(TRUCKS, smf=TRUCKS.smf.replaced("clutch", damping=1.0))
        with pytest.raises(ModelError, match="came from files"):
            asked(bare, ["A6"], many=0, processes=1)

    @pytest.mark.usefixtures("smaller")
    def test_trucks_that_give_no_answer_are_told(self, monkeypatch: pytest.MonkeyPatch) -> None:
        def question(trucks: Trucks) -> Finding:
            if figure(trucks.dmf, "dmf.soft") < 13e3:
                raise ModelError("too soft for the question")
            return Finding(True, "", {"stiffness": figure(trucks.dmf, "dmf.soft")})

        study = dataclasses.replace(claims()["A6"], question=question, leading="stiffness")
        monkeypatch.setattr(asking, "claims", lambda: {"A6": study})
        told = asked(TRUCKS, many=4, processes=1).robustness["A6"]
        assert (told.asked, told.held, told.failed) == (4, 2, 2)
        assert told.reasons == {"too soft for the question": 3}
        assert [(turn.parameter, turn.factor, turn.verdict) for turn in told.turns] == [
            ("DMF spring stiffness", 0.8, "not answered")
        ]
        assert told.spread is not None and told.spread[0] > 13e3

    @pytest.mark.usefixtures("smaller")
    def test_a_defect_of_one_study_costs_no_other_its_answer(self, monkeypatch: pytest.MonkeyPatch) -> None:
        def question(trucks: Trucks) -> Finding:
            raise IndexError("list index out of range")

        known = {"A6": dataclasses.replace(claims()["A6"], question=question), "A7": claims()["A7"]}
        monkeypatch.setattr(asking, "claims", lambda: known)
        found = asked(TRUCKS, many=1, processes=1)
        assert found.outcomes["A6"].verdict == "not answered" and found.outcomes["A7"].verdict == "reproduced"
        assert "IndexError: list index out of range" in found.outcomes["A6"].finding.reason


def test_thorough_asks_dear_claims_of_all(monkeypatch: pytest.MonkeyPatch) -> None:
    """A claim that is asked of one truck is then asked of two, and of those with one other parameter."""
    known = {"A6": dataclasses.replace(claims()["A6"], trucks=1), "E1": claims()["E1"]}
    monkeypatch.setattr(asking, "claims", lambda: known)
    few, all_of_them = (
        asked(TRUCKS, ["A6"], many=2, thorough=way, processes=1).robustness["A6"] for way in (False, True)
    )
    assert (few.asked, few.alone) == (1, 0) and all_of_them.asked == 2 and all_of_them.alone > 100
    assert known["E1"].asked_of(200).trucks == 0
