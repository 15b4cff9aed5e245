"""Model files become models: what the blocks stand for, what is read from beside them, what is left open."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.shipped import EXAMPLES

from torsional.components import Coupling, Damper, GearPair, Inertia, PlanetSpin, Shaft
from torsional.engine import CombustionCycle, LoadTable, PressureTrace
from torsional.errors import ModelError
from torsional.files import load_model, model_from_document, warnings_of
from torsional.files.faults import SchemaError
from torsional.files.reader import read_tree
from torsional.laws import Hinges
from torsional.model import Model
from torsional.units import RPM

TRUCK = read_tree(EXAMPLES / "truck_dmf.yaml").data


def truck(**blocks: Any) -> Model:
    """The truck with some blocks changed key by key; None removes one."""
    document = copy.deepcopy(TRUCK)
    for key, block in blocks.items():
        document[key] = {**document.get(key, {}), **block} if isinstance(block, dict) else block
    return model_from_document({key: block for key, block in document.items() if block is not None}, EXAMPLES)


def absorber(**keys: Any) -> dict[str, Any]:
    """The components of an absorber block alone."""
    return dict(model_from_document({"torsional": 1, "name": "a", "absorber": keys}).components)


DUAL = {"type": "dual_mass_flywheel", "primary_inertia": 1.2, "secondary_inertia": 1.0}


class TestBlocks:
    def test_crankshaft(self) -> None:
        parts = truck().components
        assert parts["throw6"] == Inertia(0.11)
        assert parts["crank6"] == Shaft("primary", "throw6", 3.5e6, 10.0)
        assert parts["crank_front"] == Shaft("throw1", "damper_hub", 3.0e6, 10.0)
        assert parts["throw3_bearing"] == Damper("throw3", damping=0.8)

    def test_crankshaft_throw_by_throw(self) -> None:
        values = [0.1, 0.11, 0.12, 0.13, 0.14, "150 kgcm²"]
        parts = truck(crankshaft={"throw_inertia": values, "stiffness": [1e6, 2e6, 3e6, 4e6, 5e6]}).components
        assert [parts[f"throw{i}"].inertia for i in range(1, 7)] == pytest.approx([0.1, 0.11, 0.12, 0.13, 0.14, 0.015])
        assert parts["crank4"].stiffness == 4e6

    def test_rigid_crankshaft(self) -> None:
        model = truck(crankshaft=None).replaced(document={})
        lumped = model_from_document({**TRUCK, "crankshaft": {"lumped_inertia": 0.9}}, EXAMPLES)
        assert model.landmarks.throws == ("primary",)
        assert lumped.landmarks.throws == ("crankshaft",)
        assert lumped.landmarks.crankshaft == "primary"
        assert lumped.components["crank_flange"] == GearPair("crankshaft", "primary", 1.0)
        assert "crankshaft" not in [c for c in lumped.powertrain(12).structure.coordinates if c == "primary"]

    def test_lumped_crankshaft_on_its_flange(self) -> None:
        block = {"lumped_inertia": 0.9, "flange_stiffness": 3.5e6, "flange_damping": 10}
        model = model_from_document({**TRUCK, "crankshaft": block}, EXAMPLES)
        assert model.components["crank_flange"] == Shaft("primary", "crankshaft", 3.5e6, 10.0)

    def test_gears_by_name_share_what_is_equal(self) -> None:
        model = truck(gearbox={"ratios": {"low": 14.94, "high": "1"}, "stiffness": 3e5})
        assert model.gear_names == ("low", "high")
        assert dict(model.gears["high"].components) == {"gear": GearPair("gearbox_mesh", "gearbox_output", 1.0)}
        assert model.components["gearbox"] == Shaft("gearbox_mesh", "gearbox_input", 3e5)

    def test_a_reverse_gear(self) -> None:
        assert truck(gearbox={"ratios": [-15.2], "stiffness": 3e5}).powertrain().speed_ratio("wheels") < 0

    def test_clutch_stages_and_lash(self) -> None:
        stages = [{"up_to": "150 Nm", "stiffness": 2e3}, {"stiffness": 25e3}]
        document = copy.deepcopy(TRUCK)
        document["clutch"] = {"inertia": 0.09, "stages": stages, "lash": 0.02, "hub_stiffness": 1.5e5}
        law = model_from_document(document, EXAMPLES).components["clutch"].law  # type: ignore[attr-defined]
        assert law.torque([0.005, 0.085, 0.095]) == pytest.approx([0.0, 150.0, 400.0])

    def test_extra_components_join_the_blocks(self) -> None:
        ballast = {"ballast": {"type": "inertia", "inertia": 0.1, "node": "axle"}}
        assert truck(components=ballast).powertrain(3)["ballast"] == Inertia(0.1, "axle")

    def test_rest_of_a_line_may_be_left_out(self) -> None:
        model = truck(vehicle=None, driveline=None)
        assert model.landmarks.load == "gearbox_output"
        assert model.powertrain(1).nodes[-1] in ("gearbox_output", "gearbox_mesh")
        alone = truck(vehicle=None, driveline=None, gearbox=None, clutch=None)
        assert alone.landmarks.load == ""
        assert alone.gear_names == ("",)


class TestAbsorbers:
    def test_single_mass(self) -> None:
        assert absorber(type="single_mass_flywheel", inertia="1.9 kgm²") == {"flywheel": Inertia(1.9)}

    def test_single_stage_with_stop(self) -> None:
        law = absorber(**DUAL, stiffness=13e3, stop_torque=3500, stop_stiffness=1e6)["dmf"].law
        assert law.torque([-0.3, 0.1, 3500 / 13e3 + 0.001]) == pytest.approx(
            [-3500 - 1e6 * (0.3 - 3500 / 13e3), 1300, 4500]
        )
        assert law.stops == pytest.approx((-3500 / 13e3, 3500 / 13e3))

    def test_coast_stages(self) -> None:
        drive, coast = [{"stiffness": 8e3, "up_to": 100}, {"stiffness": 24e3}], [{"stiffness": 30e3}]
        law = absorber(**DUAL, stages=drive, coast_stages=coast)["dmf"].law
        assert law.torque([0.0125, 0.0225, -0.01]) == pytest.approx([100, 340, -300])

    def test_drive_is_positive_while_the_engine_drives(self) -> None:
        dmf = absorber(**DUAL, stiffness=13e3, lash=0.01)["dmf"]
        assert isinstance(dmf, Coupling)
        assert (dmf.a, dmf.b) == ("secondary", "primary")

    def test_power_split_is_the_equations(self) -> None:
        keys = {"primary_inertia": 1.8, "secondary_inertia": 0.5, "planet_inertia": 0.02, "output_inertia": 1.2}
        built = model_from_document(
            {
                "torsional": 1,
                "name": "p",
                "absorber": {
                    "type": "power_split",
                    **keys,
                    "planet_ratio": 2.5,
                    "gear_quotient": 0.6,
                    "stiffness": 20e3,
                },
                "components": {
                    "load": {"type": "inertia", "inertia": 8},
                    "line": {"type": "shaft", "a": "output", "b": "load", "stiffness": 60e3},
                },
            }
        )
        from torsional.system import assemble

        system = assemble(built.powertrain())
        square = np.linalg.eigvals(np.linalg.solve(system.M, system.K))
        found = np.sort(np.sqrt(np.abs(square)))[1:] / (2 * np.pi)
        assert found == pytest.approx([21.3016010963, 34.0479811608], rel=1e-11)

    def test_switch(self) -> None:
        keys = {"planet_inertia": 0.1, "planet_ratio": 2, "stiffness": 13e3}
        switch = {"above": "1000 rpm", "inertia": 0.05, "hysteresis": "50 rpm"}
        spin = absorber(**{**DUAL, "type": "planetary_dual_mass_flywheel"}, **keys, switch=switch)["planets"]
        assert isinstance(spin, PlanetSpin)
        assert spin.switch is not None
        assert spin.switch.above(1000 * RPM * 1.001)
        assert spin.switch.above(960 * RPM, rising=False)

    @pytest.mark.parametrize(
        "tva", [{"tuned_to": "650 rpm", "order": 3}, {"tuned_to": "32.5 Hz", "order": 1}, {"stiffness": 8339.815652}]
    )
    def test_tuned_absorber(self, tva: dict[str, Any]) -> None:
        kind = {**DUAL, "type": "dual_mass_flywheel_with_tuned_absorber"}
        for on, rows in (
            ("secondary", {"stiffness": 13e3}),
            (
                "flange",
                {"flange_inertia": 0.1, "primary_springs": {"stiffness": 2}, "secondary_springs": {"stiffness": 3}},
            ),
        ):
            parts = absorber(**kind, on=on, **rows, tva={"inertia": 0.2, **tva})
            assert np.sqrt(parts["tva_spring"].stiffness / 0.2) == pytest.approx(2 * np.pi * 32.5, rel=1e-6)
            assert parts["tva_spring"].a == on

    def test_pendulum_hangs_on_the_output_body(self) -> None:
        weights = {"mass": 4, "distance": "150 mm", "order": 3}
        assert absorber(**DUAL, stiffness=13e3, pendulum=weights)["pendulum"].carrier == "secondary"
        rollers = {"mass": 0.1, "inertia": 1e-5, "radius": "10 mm", "distance": "140 mm"}
        found = absorber(type="single_mass_flywheel", inertia=1, pendulum={**weights, "rollers": rollers})["pendulum"]
        assert (found.carrier, found.rollers.radius) == ("flywheel", 0.01)


class TestEngine:
    def test_built_in_cycle_has_the_defaults(self) -> None:
        motor = truck().engine
        assert motor is not None
        assert motor.gas == CombustionCycle()

    def test_combustion(self) -> None:
        settings = {
            "boost": {"mean_effective_pressure": ["0 bar", "20 bar"], "value": ["1 bar", "3 bar"]},
            "premixed_fraction": 0.1,
            "main": {"start": "-5 deg", "duration": "60 deg", "shape": 1.0},
            "exhaust_opening": "120 deg",
        }
        gas = truck(engine={"combustion": settings}).engine.gas  # type: ignore[union-attr]
        assert isinstance(gas, CombustionCycle)
        assert gas.boost == LoadTable(((0.0, 1e5), (20e5, 3e5)))
        assert (gas.premixed_fraction, gas.main.start) == (0.1, pytest.approx(np.radians(-5)))
        assert gas.premixed == CombustionCycle().premixed

    def test_vee(self) -> None:
        layout = {"layout": "vee-8", "bank_angle": "90 deg", "firing_order": [1, 5, 4, 8, 6, 3, 7, 2]}
        motor = truck(engine={**layout}, crankshaft=None).engine
        assert motor is not None
        assert (motor.layout.throw_count, motor.layout.cylinders) == (4, 8)

    def test_spread_and_deactivation(self) -> None:
        motor = truck(engine={"cylinder_spread": [1, 1.1, 1, 1, 1, 0.9], "deactivated": [2]}).engine
        assert motor is not None
        assert (motor.heat_spread[1], motor.deactivated) == (1.1, (2,))

    def test_full_load_in_the_file_or_beside_it(self) -> None:
        beside = truck().engine.full_load  # type: ignore[union-attr]
        inside = truck(engine={"full_load": {"speed": ["600 rpm", 200], "torque": ["1.3 kNm", 0]}}).engine.full_load  # type: ignore[union-attr]
        assert beside.speeds == pytest.approx(RPM * np.array([600, 800, 900, 1300, 1500, 1700, 1900, 2000]))
        assert (inside.speeds, inside.torques) == ((pytest.approx(600 * RPM), 200.0), (1300.0, 0.0))

    def test_pressure_trace_is_carried_along(self, tmp_path: Path) -> None:
        motor = truck().engine
        assert motor is not None
        angle = np.arange(0.0, 720.0, 0.5)
        pressure = motor.pressure(120.0, 1500.0, np.radians(angle))[0]
        rows = "\n".join(f"{a},{p / 1e5!r}" for a, p in zip(angle.tolist(), pressure.tolist(), strict=True))
        (tmp_path / "trace.csv").write_text("crank_angle [deg],pressure [bar]\n" + rows, encoding="utf-8")
        document = {**TRUCK, "engine": {**TRUCK["engine"], "full_load": None, "pressure_trace": "trace.csv"}}
        del document["engine"]["full_load"]
        (tmp_path / "model.json").write_text(json.dumps(document), encoding="utf-8")
        model = load_model(tmp_path / "model.json")
        assert model.engine is not None
        assert isinstance(model.engine.gas, PressureTrace)
        found = model.engine.harmonics(120.0, 1500.0, [0, 3]).sum(axis=0)
        assert found == pytest.approx(motor.harmonics(120.0, 1500.0, [0, 3]).sum(axis=0), rel=1e-3)
        (tmp_path / "trace.csv").unlink()
        assert model_from_document(model.document).hash == model.hash


class TestDocument:
    def test_hash_follows_the_files_beside_it(self, tmp_path: Path) -> None:
        for name in ("truck_dmf.yaml", "truck13_full_load.csv"):
            (tmp_path / name).write_bytes((EXAMPLES / name).read_bytes())
        first = load_model(tmp_path / "truck_dmf.yaml")
        assert first.hash == load_model(EXAMPLES / "truck_dmf.yaml").hash
        curve = tmp_path / "truck13_full_load.csv"
        curve.write_text(curve.read_text().replace("2300", "2200"))
        assert load_model(tmp_path / "truck_dmf.yaml").hash != first.hash

    def test_document_is_the_file_and_stands_alone(self) -> None:
        model = load_model(EXAMPLES / "truck_dmf.yaml")
        assert model.document["absorber"] == TRUCK["absorber"]
        assert "900,2500" in model.document["engine"]["full_load"]["text"]
        assert model_from_document(json.loads(json.dumps(model.document))).hash == model.hash

    def test_yaml_and_json_are_the_same_model(self, tmp_path: Path) -> None:
        path = tmp_path / "mwm.json"
        path.write_text(json.dumps(read_tree(EXAMPLES / "mwm_engine.yaml").data), encoding="utf-8")
        assert load_model(path).hash == load_model(EXAMPLES / "mwm_engine.yaml").hash

    def test_operation_has_defaults(self) -> None:
        operation = truck(operation=None).operation
        assert operation.speed == pytest.approx((600 * RPM, 2000 * RPM))
        assert operation.torque is None
        assert truck(operation={"torque": "0.1:2 kNm"}).operation.torque == (100.0, 2000.0)

    def test_landmarks_may_be_named(self) -> None:
        marks = truck(landmarks={"throws": "primary", "input": "axle", "springs": ["dmf", "clutch"]}).landmarks
        assert (marks.throws, marks.input, marks.springs) == (("primary",), "axle", ("dmf", "clutch"))
        assert marks.load == "vehicle"

    def test_hinges(self) -> None:
        rows = [{"angle": 0.1, "side": 1, "change": 1e4}, {"angle": -0.1, "side": -1, "change": 1e4}]
        law = model_from_document(
            {
                "torsional": 1,
                "name": "h",
                "components": {
                    "a": {"type": "inertia", "inertia": 1},
                    "b": {"type": "inertia", "inertia": 1},
                    "c": {"type": "coupling", "a": "a", "b": "b", "hinges": {"stiffness": 5e3, "changes": rows}},
                },
            }
        ).components["c"]
        assert isinstance(law, Coupling)
        assert law.law == Hinges(5e3, (0.1, -0.1), (1.0, -1.0), (1e4, 1e4))

    def test_own_gears(self) -> None:
        parts = {name: {"type": "inertia", "inertia": 1} for name in ("motor", "wheel")}
        pair = {"type": "gear_pair", "a": "motor", "b": "wheel"}
        gears = {str(n): {"ratio": r, "components": {"gear": {**pair, "ratio": r}}} for n, r in ((1, 9.0), (2, 5.0))}
        model = model_from_document({"torsional": 1, "name": "e", "components": parts, "gears": gears})
        assert [1 / model.powertrain(gear).speed_ratio("wheel") for gear in (1, 2)] == pytest.approx([9.0, 5.0])


class TestWarnings:
    @pytest.mark.parametrize(
        ("blocks", "sentence"),
        [
            ({"operation": {"idle": 650}}, ""),
            ({"operation": {"idle": 1900}}, "operation.idle: 1900 rad/s is unusual for a mean engine speed"),
            ({"vehicle": {"rolling_radius": 500}}, "vehicle.rolling_radius: 500 m is unusual for a length"),
            ({"absorber": {"primary_inertia": 1.2e9}}, "or gmm² was meant"),
            ({"gearbox": {"ratios": [14, 1494], "stiffness": 3e5}}, "gearbox.ratios.1: 1494 is unusual"),
            (
                {"components": {"x": {"type": "shaft", "a": "gearbox_input", "b": "clutch_disc", "stiffness": 20}}},
                "components.x.stiffness",
            ),
        ],
    )
    def test_values_that_look_like_another_unit(self, blocks: dict[str, Any], sentence: str) -> None:
        told = warnings_of(truck(**blocks))
        assert len(told) == bool(sentence)
        assert sentence in "".join(told)

    def test_speeds_and_torques_against_the_full_load_curve(self) -> None:
        assert warnings_of(truck(operation={"speed": "600:2200 rpm"})) == [
            "operation.speed: 600 rpm to 2200 rpm goes beyond the full-load curve (600 rpm to 2000 rpm)"
        ]
        assert warnings_of(truck(absorber={"stop_torque": 2400})) == [
            "absorber: the springs meet their stop at 2400 Nm, and full load is 2500 Nm"
        ]

    def test_a_model_from_no_file_has_none(self) -> None:
        assert warnings_of(truck().replaced(document={})) == []


class TestErrors:
    def test_a_giant_is_refused(self) -> None:
        discs = {name: {"type": "inertia", "inertia": 1} for name in "abc"}
        tube = {"type": "distributed_shaft", "length": 1, "outer_diameter": 0.1, "elements": 250}
        shafts = {"s": {**tube, "a": "a", "b": "b"}, "t": {**tube, "a": "b", "b": "c"}}
        with pytest.raises(
            ModelError, match="components: the machine has too many parts; found 503; allowed: at most 400"
        ):
            model_from_document({"torsional": 1, "name": "g", "components": {**discs, **shafts}})

    def test_several_findings_come_together(self, tmp_path: Path) -> None:
        text = (EXAMPLES / "truck_smf.yaml").read_text(encoding="utf-8")
        bad = text.replace("inertia: 1.9 kgm²", "inertia: 1.9 kg").replace("damping: 30 ", "damping: -30 ")
        path = tmp_path / "bad.yaml"
        path.write_text(bad.replace("mass: 40 t", "mas: 40 t"), encoding="utf-8")
        with pytest.raises(SchemaError) as caught:
            load_model(path)
        assert len(caught.value.errors) == 3
        lines = str(caught.value).splitlines()
        assert lines[0] == f"{path}: 3 things are not right"
        assert lines[1].startswith(
            "  absorber.inertia (line 41): kg is a mass, and an inertia is wanted; found '1.9 kg'"
        )
        assert lines[2].startswith("  clutch.damping (line 46): must not be negative")
        assert lines[3] == "  vehicle.mas (line 67): the key is unknown; did you mean 'mass'?"
        assert isinstance(caught.value.located(prefix="x"), ModelError)

    def test_more_than_five_are_counted(self) -> None:
        parts = {f"p{i}": {"type": "inertia", "inertia": -1} for i in range(9)}
        with pytest.raises(SchemaError, match=r"9 things are not right(.|\n)*and 4 more"):
            model_from_document({"torsional": 1, "name": "x", "components": parts})
