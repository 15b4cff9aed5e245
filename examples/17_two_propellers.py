"""One engine, two propellers through two gear branches: modes alike on both sides and against each other."""

import numpy as np

import torsional as tv

CLUTCH, RATIO, SHAFT = 5e5, 3.75, 1e6
PINION, WHEEL, PROPELLER = 20.0, 300.0, 2600.0


def branch(side: str) -> dict[str, object]:
    """Rubber coupling, gears, shaft and propeller of one side; its names begin with the side."""
    return {
        f"{side}_rubber": tv.Shaft(f"{side}_pinion", "flywheel", CLUTCH, loss_factor=0.1),
        f"{side}_pinion": tv.Inertia(PINION),
        f"{side}_gears": tv.GearPair(f"{side}_pinion", f"{side}_wheel", RATIO),
        f"{side}_wheel": tv.Inertia(WHEEL),
        f"{side}_shaft": tv.Shaft(f"{side}_propeller", f"{side}_wheel", SHAFT),
        f"{side}_propeller": tv.Inertia(PROPELLER),
    }


def main() -> dict[str, float]:
    engine = {"engine": tv.Inertia(330.0), "crank": tv.Shaft("flywheel", "engine", 20e6), "flywheel": tv.Inertia(400.0)}
    modes = tv.modal(tv.assemble(tv.Powertrain({**engine, **branch("port"), **branch("starboard")})))
    port, starboard = (modes.shape.sel(node=f"{side}_propeller").values for side in ("port", "starboard"))
    opposed = [mode for mode in range(1, 6) if port[mode] * starboard[mode] < 0]
    for mode in range(1, 6):
        kind = "against each other" if mode in opposed else "alike"
        print(f"{float(modes.frequency[mode]):6.2f} Hz, propellers {kind}")
    # moving against each other they leave the engine at rest: each side by itself, its coupling held at the flywheel,
    # referred to the propeller: (k - ω² J) of two discs, by hand
    inertia = np.diag([WHEEL + RATIO**2 * PINION, PROPELLER])
    stiffness = np.array([[SHAFT + RATIO**2 * CLUTCH, -SHAFT], [-SHAFT, SHAFT]])
    by_hand = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(inertia, stiffness)).real)) / (2 * np.pi)
    assert np.allclose(modes.frequency.values[opposed], by_hand, rtol=1e-10)
    return {"first": float(modes.frequency[opposed[0]]), "second": float(modes.frequency[opposed[1]])}


if __name__ == "__main__":
    main()
