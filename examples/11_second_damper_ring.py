"""A second ring, in silicone oil, at the free end of the crank: how viscous should the oil be?"""

import numpy as np

import torsional as tv

INERTIA = 0.15


def crank_twist(truck: tv.Model, damping: float, inertia: float = INERTIA) -> tuple[np.ndarray, np.ndarray]:
    """Twist from the free end to the flywheel for 1 Nm of excitation at throw 1, over frequency."""
    ring = {"ring": tv.Inertia(inertia), "silicone": tv.Damper("ring", "damper_hub", damping)} if inertia else {}
    system, _ = tv.at_operating_point(truck.joined(ring), torque=1500.0, gear=12)
    frequency = np.linspace(150.0, 420.0, 1081)
    angle = tv.harmonic_response(system, tv.Excitation.unit("throw1", [1.0], 2 * np.pi * frequency)).angle
    return frequency, abs(angle.sel(node="damper_hub") - angle.sel(node="primary")).values[:, 0]


def main() -> dict[str, float]:
    truck = tv.load_model("examples/truck_dmf.yaml")
    truck = tv.changed(truck, {"crankshaft.damper.damping": 5.0, "crankshaft.damping": 1.0})  # the rubber ring is tired
    peak = {}
    for damping in np.geomspace(5.0, 5000.0, 31):
        peak[damping] = crank_twist(truck, damping)[1].max()
    best = min(peak, key=peak.__getitem__)
    for damping in (5.0, best, 5000.0):
        print(f"{damping:6.0f} Nms/rad: largest twist {1e6 * peak[damping]:.2f} µrad/Nm")
    # loose it is not there, stuck it is a heavier hub
    assert np.allclose(crank_twist(truck, 1e-6)[1], crank_twist(truck, 0.0, 0.0)[1], rtol=1e-5)
    heavier = truck.replaced("damper_hub", inertia=truck.components["damper_hub"].inertia + INERTIA)
    assert np.allclose(crank_twist(truck, 1e9)[1], crank_twist(heavier, 0.0, 0.0)[1], rtol=1e-5)
    return {"best": float(best), "twist": float(1e6 * peak[best])}


if __name__ == "__main__":
    main()
