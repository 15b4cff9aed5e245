"""Speeds and torques at which the two-stage truck vibrates at order 1.5, and how stiff its second stage may be."""

from pathlib import Path

import numpy as np

import torsional as tv
from torsional.plots import plot_region, save_png


def main(target: Path = Path("out/region_of_half_orders.png")) -> dict[str, float]:
    truck = tv.load_model("examples/truck_dmf_two_stage.yaml")
    region = tv.subharmonic_map(truck, np.arange(740, 981, 5) * tv.RPM, np.arange(860.0, 1441.0, 20.0))
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(save_png(plot_region(region, "acceleration")))
    highest = float(region.boundary_mean_torque.max())
    print(f"order 1.5 from {float(region.boundary_mean_torque.min()):.0f} to {highest:.0f} Nm; written: {target}")

    path = "absorber.stages.1.stiffness"
    edge = tv.subharmonic_boundary(truck, (700 * tv.RPM, 1300 * tv.RPM), (12e3, 36e3), path, torque=1200.0, places=3)
    softest = float(edge.boundary_value.min())
    print(f"at 1200 Nm there is none with a second stage below {softest / 1e3:.1f} kNm/rad, 24 as shipped")
    return {"highest torque": highest, "softest": softest}


if __name__ == "__main__":
    main()
