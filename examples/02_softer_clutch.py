"""How the stiffness of the clutch damper moves the clutch mode: a design change is a path in the model file."""

import torsional as tv


def main() -> dict[float, float]:
    truck = tv.load_model("examples/truck_smf.yaml")
    found = {}
    for stiffness in (12.5, 25.0, 50.0):
        changed = tv.changed(truck, f"clutch.stiffness={stiffness} kNm/rad")
        system, _ = tv.at_operating_point(changed, torque=1500.0, gear=12)
        modes = tv.modal(system)
        clutch = modes.elastic_share.sel(element="clutch").argmax("mode")
        found[stiffness] = 20 * float(modes.frequency[clutch])
        print(f"{stiffness:5.1f} kNm/rad: third order meets the clutch mode at {found[stiffness]:4.0f} rpm")
    return found


if __name__ == "__main__":
    main()
