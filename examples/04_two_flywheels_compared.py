"""Dual mass against single mass flywheel over speed, torque and every gear."""

import numpy as np

import torsional as tv


def main() -> dict[str, float]:
    shaken = {}
    for kind in ("smf", "dmf"):
        truck = tv.load_model(f"examples/truck_{kind}.yaml")
        result = tv.response_map(truck, speed=truck.speeds(29), torque=np.linspace(500.0, 2500.0, 9))
        at_input = tv.acceleration(result.angle.sel(node="gearbox_input"))
        shaken[kind] = tv.swing(at_input).where(result.within_full_load)
    ratio = shaken["dmf"] / shaken["smf"]
    above = int((ratio > 1).sum()) / int(ratio.notnull().sum())
    print(f"dual over single mass flywheel: median {float(ratio.median()):.2f}, above 1 in {above:.1%} of the map")
    return {"median": float(ratio.median()), "above": above}


if __name__ == "__main__":
    main()
