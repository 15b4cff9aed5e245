"""An absorber of one's own: a dual mass flywheel with an inerter, a mass turned by the twist, beside its springs."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

import torsional as tv


@dataclass(frozen=True)
class Inerter:
    """A disc geared to the relative angle of ``a`` and ``b``: kinetic energy ½ J (θ̇_b − θ̇_a)²."""

    a: str
    b: str
    inertia: float

    def stamps(self, name: str) -> Iterator[tv.Mass]:
        yield tv.Mass(name, {self.a: -1.0, self.b: 1.0}, self.inertia)


def inerter_flywheel(primary: float, secondary: float, stiffness: float, inerter: float) -> tv.Absorber:
    """Primary and secondary flywheel [kgm²], spring [Nm/rad] and an inerter [kgm²] between them."""
    parts = {
        "primary": tv.Inertia(primary),
        "springs": tv.Shaft("secondary", "primary", stiffness),
        "inerter": Inerter("secondary", "primary", inerter),
        "secondary": tv.Inertia(secondary),
    }
    return tv.Absorber("flywheel with inerter", parts, "primary", "secondary", springs=("springs",))


def main() -> dict[str, float]:
    truck = tv.load_model("examples/truck_dmf.yaml")
    notch = 1200 * tv.RPM  # where the third order shall be cancelled
    absorber = inerter_flywheel(1.2, 1.0, 13e3, inerter=13e3 / (3 * notch) ** 2)
    own = truck.with_absorber(absorber)
    speed = np.arange(600, 2001, 5) * tv.RPM
    shaken = {}
    for name, model in (("shipped", truck), ("own", own)):
        response = tv.run_up_response(model, speed, 1500.0, 12, orders=[3.0])
        shaken[name] = tv.amplitude(tv.acceleration(response.angle.sel(node="gearbox_input")), 3.0)
    ratio = shaken["own"] / shaken["shipped"]
    quietest = float(ratio.speed[int(ratio.argmin("speed"))]) / tv.RPM
    print(f"inerter of {absorber.components['inerter'].inertia:.4f} kgm²: quietest at {quietest:.0f} rpm")
    print(f"there {float(ratio.min()):.1e} of the shipped flywheel's, at 2000 rpm {float(ratio[-1]):.2f}")
    # at ω² = k/J spring and inerter cancel each other: nothing passes, whatever hangs behind
    assert quietest == 1200 and float(ratio.min()) < 1e-6
    return {"quietest": quietest, "far": float(ratio[-1])}


if __name__ == "__main__":
    main()
