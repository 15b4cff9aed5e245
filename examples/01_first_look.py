"""Modes of the truck with a dual mass flywheel, and what reaches its gearbox at full load."""

import numpy as np

import torsional as tv


def main() -> dict[str, float]:
    truck = tv.load_model("examples/truck_dmf.yaml")
    system, point = tv.at_operating_point(truck, torque=2000.0, gear=12)  # linear about 2000 Nm in direct gear
    left = np.degrees(point.distance_to_stop("dmf"))
    print(f"dual mass flywheel in {point.stage('dmf')}, {left:.1f}° from its stop")
    modes = tv.modal(system)
    for frequency, twisted in zip(modes.frequency.values[1:6], tv.dominant_element(modes).values[1:6], strict=True):
        print(f"{frequency:6.2f} Hz, third order at {20 * frequency:5.0f} rpm, most energy in {twisted}")
    speed = np.linspace(600, 2000, 141) * tv.RPM
    torque = truck.engine.excitation(truck.landmarks.throws, speed, 2000.0, orders=[1.5, 3.0, 4.5, 6.0])
    response = tv.harmonic_response(system, torque)
    third = tv.amplitude(tv.acceleration(response.angle.sel(node="gearbox_input")), order=3.0)
    worst = third.speed.values[third.argmax("speed")] / tv.RPM
    print(f"third order at the gearbox input: {float(third.max()):.0f} rad/s² (0-peak) at {worst:.0f} rpm")
    return {"clutch_mode": float(modes.frequency[4]), "worst_speed": float(worst), "largest": float(third.max())}


if __name__ == "__main__":
    main()
