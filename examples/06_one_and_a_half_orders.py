"""The two-stage truck vibrates at one and a half orders, which no linear analysis tells: branches and a picture."""

from pathlib import Path

import numpy as np

import torsional as tv
from torsional.plots import plot_periodic, save_png


def main(target: Path = Path("out/one_and_a_half_orders.png")) -> dict[str, float]:
    truck = tv.load_model("examples/truck_dmf_two_stage.yaml")
    speed = np.linspace(700, 1200, 101) * tv.RPM
    found = tv.model_response(truck, (speed[0], speed[-1]), torque=1200.0, at=speed)
    low, high = np.sort(found.bifurcation_speed.values[found.bifurcation_type.values == "period doubling"]) / tv.RPM
    print(f"from {low:.1f} to {high:.1f} rpm the firing order's motion gives way to one of every second ignition")

    here = found.isel(point=np.flatnonzero(found.speed == speed[48]))
    half = tv.amplitude(tv.acceleration(here.angle.sel(node="gearbox_input")), 1.5)
    for stable, size in zip(here.stable.values, half.values, strict=True):
        print(f"940 rpm: order 1.5 at the gearbox input {size:5.1f} rad/s², {'stable' if stable else 'unstable'}")

    spring = truck.powertrain()["dmf"].law
    figure = plot_periodic(found, [3, 1.5], elements=["dmf"], solutions=here, laws={"dmf": spring}, title="940 rpm")
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(save_png(figure))
    print(f"written: {target}")
    return {"begins": low, "ends": high, "gearbox_input": float(half.max())}


if __name__ == "__main__":
    main()
