"""A powertrain from components: no file, any parts, names of one's own."""

import numpy as np

import torsional as tv


def main() -> dict[str, float]:
    stages = tv.Hinges.staged([(1000.0, 8e3), (3500.0, 24e3)])
    line = tv.Powertrain(
        {
            "engine": tv.Inertia(1.8),
            "springs": tv.Coupling("flywheel", "engine", stages, damping=20.0),
            "flywheel": tv.Inertia(1.0),
            "shaft": tv.Shaft("pinion", "flywheel", stiffness=6e4, damping=2.0),
            "pinion": tv.Inertia(0.1),
            "gear": tv.GearPair("pinion", "wheel", ratio=3.5),
            "wheel": tv.Inertia(40.0),
        }
    )
    system = tv.assemble(line)
    found = {}
    for torque in (500.0, 1500.0):
        point = tv.equilibrium(system, {"engine": torque}, hold="wheel")
        linear = tv.linearize(system, point)
        found[f"{torque:g} Nm"] = float(tv.modal(linear).frequency[1])
        twist = np.degrees(point.angle[point.names.index("springs")])
        print(f"{torque:6.0f} Nm: twist {twist:4.1f}°, first elastic mode {found[f'{torque:g} Nm']:5.2f} Hz")
    return found


if __name__ == "__main__":
    main()
