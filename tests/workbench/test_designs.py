"""Designs: the models that they stand for, and the files that they are saved as."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import torsional
from torsional.errors import ModelError
from torsional.files.reader import parse_tree
from torsional.workbench.absorbers import choices
from torsional.workbench.designs import changed_document, design_of, missing, model_of, saved
from torsional.workbench.refusals import faults

Designed = Callable[..., dict[str, Any]]
PSVA = {"type": "power_split", "primary_inertia": "1.2 kgm²", "secondary_inertia": 0.6, "planet_inertia": 0.01}
PSVA |= {"output_inertia": 0.6, "planet_ratio": 2.0, "gear_quotient": 0.77, "stiffness": "13 kNm/rad", "damping": 10}


def test_a_change_is_that_of_the_command_line(design: Designed) -> None:
    ours = model_of(design_of(design(absorber__stiffness="10kNm/rad", operation__idle="650 rpm")))
    theirs = torsional.changed(
        torsional.load_model("examples/truck_dmf.yaml"), "absorber.stiffness=10kNm/rad", "operation.idle=650 rpm"
    )
    assert ours.hash == theirs.hash and dict(ours.components) == dict(theirs.components)


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"absorber.stiffness": "12 kNm/rad", "name": "Softer: yes, no # really"},
        {"gearbox.ratios.3": "7.1", "absorber.lash": "2 deg", "clutch.damping": 31.25},
        {"crankshaft.absolute_damping": None, "engine.firing_order": "[1, 5, 3, 6, 2, 4]"},
        {"absorber": PSVA, "absorber.stiffness": "12.5 kNm/rad"},
    ],
)
def test_a_saved_file_is_the_design(design: Designed, changes: dict[str, Any], tmp_path: Path) -> None:
    given = design_of({**design(), "changes": changes})
    text = saved(given)
    (tmp_path / "truck.yaml").write_text(text, encoding="utf-8")
    (tmp_path / "truck13_full_load.csv").write_text(given.files["truck13_full_load.csv"], encoding="utf-8")
    assert torsional.load_model(tmp_path / "truck.yaml").hash == model_of(given).hash
    comments = [line.partition("#")[2] for line in given.text.splitlines() if "#" in line and "rpm" in line]
    assert comments and all(comment in text for comment in comments)


def test_saving_touches_no_other_line(design: Designed) -> None:
    given = design_of(design(absorber__stiffness="12 kNm/rad"))
    before, after = given.text.splitlines(), saved(given).splitlines()
    assert [(a, b) for a, b in zip(before, after, strict=True) if a != b] == [
        (
            "  stiffness: 13 kNm/rad               # springs between the flywheels",
            "  stiffness: 12 kNm/rad               # springs between the flywheels",
        )
    ]


def test_a_json_file_stays_one(design: Designed) -> None:
    text = '{"torsional": 1, "name": "one disc", "components": {"disc": {"type": "inertia", "inertia": 0.2}}}'
    given = design_of({"text": text, "changes": {"components.disc.inertia": "0.3 kgm²"}})
    assert parse_tree(saved(given), json_only=True).data["components"]["disc"]["inertia"] == "0.3 kgm²"


def test_every_absorber_of_the_list_fits_the_shipped_trucks(design: Designed) -> None:
    model = model_of(design_of(design()))
    offered = choices(model)
    assert len(offered) >= 8 and len({str(block) for _, _, block in offered}) == len(offered)
    for _, _, block in offered:
        assert model_of(design_of({**design(), "changes": {"absorber": block}})).absorber is not None


def test_absorbers_are_scaled_to_a_small_engine(design: Designed) -> None:
    small = {name: block for name, _, block in choices(model_of(design_of(design("passenger_car_dmf"))))}
    assert 1000 < small["dmf"]["stiffness"] < 4000  # Nm/rad, where the truck's is 13000


@pytest.mark.parametrize(
    ("changes", "where", "told"),
    [
        ({"absorber.stiffness": "twelve"}, "absorber.stiffness", "a number is wanted"),
        ({"absorber.stiffness": "  "}, "absorber.stiffness", "a value is wanted"),
        ({"absorber.stifness": "12"}, "absorber.stifness", "the key is unknown"),
        ({"absorber.primary_inertia": "-1"}, "absorber.primary_inertia", "must be positive"),
        ({"absorber.primary_inertia": float("nan")}, "absorber.primary_inertia", "a finite number is wanted"),
        ({"gearbox.ratios.40": "1"}, "gearbox.ratios", "the list has no such item"),
        ({"absorber": "none"}, "absorber", "wanted"),
    ],
)
def test_what_is_wrong_is_told_at_its_key(design: Designed, changes: dict[str, Any], where: str, told: str) -> None:
    with pytest.raises(ModelError) as caught:
        model_of(design_of({**design(), "changes": changes}))
    (fault, *_) = faults(caught.value)
    assert fault["where"] == where and told in fault["problem"]


@pytest.mark.parametrize("name", ["/etc/passwd", "../README.md", "README.md", "examples/truck13_full_load.csv"])
def test_no_file_of_the_machine_is_read(design: Designed, name: str) -> None:
    for given in (
        {**design(), "changes": {"engine.full_load": name}},
        {**design(), "text": design()["text"].replace("truck13_full_load.csv", name)},
        {**design(), "changes": {"engine.pressure_trace": {"file": name}}},
    ):
        with pytest.raises(ModelError, match="not brought along"):
            model_of(design_of(given))


def test_files_that_are_missing_are_named(design: Designed) -> None:
    assert missing(design_of({"text": design()["text"]})) == ("truck13_full_load.csv",)
    assert missing(design_of(design())) == ()


@pytest.mark.parametrize("data", [None, [], {"text": 3}, {"file": "x"}, {"text": "a: 1", "changes": []}])
def test_what_is_no_design_is_refused(data: object) -> None:
    with pytest.raises(ModelError) as caught:
        design_of(data)
    assert faults(caught.value)[0]["where"].startswith("design")


def test_designs_do_not_share_what_they_change(design: Designed) -> None:
    first = changed_document(design_of(design()))
    first["absorber"]["stiffness"] = "1 Nm/rad"
    assert changed_document(design_of(design()))["absorber"]["stiffness"] == "13 kNm/rad"


def test_the_order_of_changes_counts(design: Designed) -> None:
    block = {"type": "dual_mass_flywheel", "primary_inertia": 1.2, "secondary_inertia": 1.0, "stiffness": 9e3}
    for changes in ({"absorber": block, "absorber.stiffness": "8e3"}, {"absorber.stiffness": "8e3", "absorber": block}):
        law = model_of(design_of({**design(), "changes": changes})).components["dmf"].law
        assert law.tangent(0.01) == (8e3 if next(iter(changes)) == "absorber" else 9e3)


def test_an_engine_that_stays_is_kept(design: Designed) -> None:
    engines = [model_of(design_of(design(absorber__damping=str(d)))).engine for d in (11, 12)]
    other = model_of(design_of(design(engine__bore="130 mm"))).engine
    again = model_of(design_of(design(absorber__damping="13"))).engine
    assert engines[0] is engines[1] and other is not engines[0] and other is not None and again is not None
    assert other.bore == 0.130 and again.bore == 0.131
