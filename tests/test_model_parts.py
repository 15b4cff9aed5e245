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
