"""Parts of a model changed in Python: they stay, and nothing speaks of a file that no longer describes them."""

import pytest

import torsional as tv
from tests.shipped import shipped


@pytest.fixture(scope="module")
def truck() -> tv.Model:
    return shipped("truck_dmf")


def test_joined_parts_are_in_every_gear_and_in_the_hash(truck: tv.Model) -> None:
    ring = {"ring": tv.Inertia(0.2), "silicone": tv.Damper("ring", "damper_hub", damping=50.0)}
    more = truck.joined(ring)
    assert all("ring" in more.powertrain(gear).nodes for gear in more.gear_names)
    assert more.hash != truck.hash
    assert more.without("ring", "silicone").components == truck.components


def test_a_value_of_the_file_cannot_be_changed_after_a_part(truck: tv.Model) -> None:
    # it used to be built anew from the file, without the ring
    more = truck.joined({"ring": tv.Inertia(0.2, "damper_hub")})
    with pytest.raises(tv.ModelError, match="no model file describes this model; change values of the file first"):
        tv.changed(more, "clutch.stiffness=10 kNm/rad")
    first = tv.changed(truck, "clutch.stiffness=10 kNm/rad").joined({"ring": tv.Inertia(0.2, "damper_hub")})
    assert first.components["clutch"].law.stiffness == 10e3  # type: ignore[attr-defined]


def test_one_part_exchanged(truck: tv.Model) -> None:
    assert truck.replaced("dmf", damping=3.0).components["dmf"].damping == 3.0  # type: ignore[attr-defined]
    assert truck.replaced("primary", tv.Inertia(2.0)).components["primary"] == tv.Inertia(2.0)
    assert list(truck.replaced("dmf", damping=3.0).components) == list(truck.components)
    assert truck.replaced(name="other").name == "other"


def test_refused(truck: tv.Model) -> None:
    with pytest.raises(tv.ModelError, match="no component 'dnf'; did you mean 'dmf'"):
        truck.without("dnf")
    with pytest.raises(tv.ModelError, match="the name is taken"):
        truck.joined({"gearbox": tv.Inertia(1.0)})  # it stands in the gears
    with pytest.raises(tv.ModelError, match="'dmf' has no field 'dampin'; did you mean 'damping'"):
        truck.replaced("dmf", dampin=3.0)


def test_another_absorber_takes_the_place_of_the_shipped_one(truck: tv.Model) -> None:
    """The truck's file with an arc spring flywheel and the truck given one in Python are the same in every gear."""
    arc = shipped("truck_dmf_arc_spring")
    own = truck.with_absorber(arc.absorber)
    assert (own.landmarks, own.absorber, own.detail) == (arc.landmarks, arc.absorber, arc.detail)
    for gear in arc.gear_names:
        assert tv.assemble(own.powertrain(gear)).hash == tv.assemble(arc.powertrain(gear)).hash
    assert own.detailed().with_absorber(truck.absorber).components.keys() == truck.components.keys()
    with pytest.raises(tv.ModelError, match="no model file describes"):
        tv.changed(own, {"clutch.damping": 1.0})


def test_ends_of_other_names_are_joined_rigidly(truck: tv.Model) -> None:
    single = shipped("truck_smf")
    own = truck.with_absorber(single.absorber)
    assert own.landmarks.springs == ()
    assert (own.absorber.kind, own.absorber_mode) == ("single mass flywheel", "absorber mode")
    for gear in (1, 12):
        pair = [tv.modal(tv.at_operating_point(m, 1500.0, gear)[0]).frequency.values for m in (own, single)]
        assert pair[0] == pytest.approx(pair[1], rel=1e-9, abs=1e-6)
    back = own.with_absorber(truck.absorber)
    assert tv.at_operating_point(back, 0.0)[0].hash == tv.at_operating_point(truck, 0.0)[0].hash


def test_absorbers_refused(truck: tv.Model) -> None:
    single = shipped("truck_smf")
    with pytest.raises(tv.ModelError, match="one node would be both ends"):
        single.with_absorber(truck.absorber)
    with pytest.raises(tv.ModelError, match="no absorber to replace"):
        tv.Model("bare", {}, tv.Landmarks()).with_absorber(truck.absorber)
    odd = tv.Absorber("odd", {"primary": tv.Inertia(1.0)}, "outer", "secondary")
    with pytest.raises(tv.ModelError, match="another node by this name"):
        truck.with_absorber(odd)
    with pytest.raises(tv.ModelError, match="the name is taken"):
        truck.with_absorber(tv.Absorber("odd", {"clutch": tv.Inertia(1.0)}, "primary", "primary"))
