"""What a report tells of periodic motions, and that it tells them for springs with stages alone."""

from __future__ import annotations

import pytest
from tests.report.conftest import example

from torsional.errors import ModelError
from torsional.laws import Hinges
from torsional.report import motions as module
from torsional.report.analysis import Comparison
from torsional.report.blocks import Heading, Picture, Table
from torsional.report.findings import findings
from torsional.report.motion_pictures import motion_blocks
from torsional.report.motions import Motions, has_stages, motion_findings, motions_of, sought
from torsional.units import RPM


@pytest.fixture(scope="module")
def found(trucks: Comparison) -> Motions:
    motions = trucks.first.motions
    assert motions is not None
    return motions


def test_only_springs_with_stages_have_motions_of_their_own(trucks: Comparison) -> None:
    assert trucks.variants[1].motions is None
    assert trucks.variants[1].unmoved == ""
    assert motion_blocks(trucks.variants[1]) == []
    assert not has_stages(None)
    assert not has_stages(Hinges.staged([(3500.0, 13e3)], stop_stiffness=1e6))
    assert has_stages(Hinges.staged([(1000.0, 8e3), (3500.0, 24e3)]))
    assert has_stages(Hinges.staged([(3500.0, 13e3)], lash=0.02))


def test_the_region_is_told_in_a_sentence(found: Motions, trucks: Comparison) -> None:
    """Round figures of the region, which `torsional subharmonic` tells as well."""
    (finding,) = [f for f in motion_findings(found) if f.kind == "sub-harmonic"]
    assert finding.values["amplitude"] == pytest.approx(644, abs=4)
    assert finding.values["speed"] / RPM == pytest.approx(910, abs=6)
    assert finding.values["mean_torque"] == pytest.approx(1250, abs=30)
    assert "order 1.5" in finding.text and "644 Nm (0-peak) in dmf" in finding.text
    assert finding.text in [f.text for _, group in findings(trucks) for f in group]


def test_each_motion_is_counted_once(found: Motions) -> None:
    """A branch that is followed beyond where it joins the one it left is counted twice: once as its own copy."""
    assert int(found.region.stable_solutions.max()) == 1
    assert int(found.region.solutions.max()) == 2
    assert set(found.region.boundary_kind.values) == {"period doubling"}


def test_jumps_at_full_load_are_told(found: Motions) -> None:
    (finding,) = [f for f in motion_findings(found) if f.kind == "jumps"]
    assert "925.9 rpm to 946.4 rpm" in finding.text


def test_blocks(trucks: Comparison) -> None:
    blocks = motion_blocks(trucks.first)
    assert [type(block) for block in blocks] == [Heading, Picture, Table, Picture, Picture]
    table = blocks[2]
    assert isinstance(table, Table)
    row = next(row for row in table.rows if row[0] == "1200 Nm")
    assert [float(end) for end in row[1:3]] == pytest.approx([839.5, 963.3], abs=0.15)


def test_where_there_is_none_it_is_said(found: Motions) -> None:
    calm = Motions(
        found.gear, found.element, found.law, 0.0, found.node, 1.5, found.region, found.full_load.isel(bifurcation=[])
    )
    assert calm.solutions is None
    assert "No stable vibration of order 1.5" in motion_findings(calm)[0].text


def test_motions_that_cannot_be_found_are_missing_and_nothing_else(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object, **__: object) -> None:
        raise ModelError("an inertia switches within the range", where="planets")

    monkeypatch.setattr(module, "sought_region", refused)
    told = sought(example("truck_dmf_two_stage"), (60.0, 200.0))
    assert told == (None, "Its periodic motions are not told: planets: an inertia switches within the range.")


def test_a_linear_model_has_none() -> None:
    assert motions_of(example("marine_line"), (60.0, 200.0)) is None
