"""The two-stage truck with little damping in its flywheel, run up and down in time: two motions at one speed."""

import numpy as np

import torsional as tv

HIGHEST = 36.0


def main() -> dict[str, float]:
    truck = tv.changed(tv.load_model("examples/truck_dmf_two_stage.yaml"), {"absorber.damping": 5.0})
    system = tv.assemble(truck.powertrain())

    def engine(speed: float) -> tv.Excitation:
        return tv.engine_drive(truck, speed, 1400.0, HIGHEST)

    speeds = np.arange(855, 906, 5) * tv.RPM
    found = tv.steady_sweep(system, engine, speeds, hold=truck.landmarks.load, highest_order=9.0, step=5e-5)
    up, down = abs(found.twist.sel(element="dmf", order=1.5)).values
    for speed, rising, falling in zip(speeds / tv.RPM, up, down, strict=True):
        print(f"{speed:4.0f} rpm: order 1.5 of the flywheel {rising:.4f} rad upwards, {falling:.4f} rad downwards")

    start = found.sel(direction="up").isel(value=int(np.flatnonzero(speeds == 880 * tv.RPM)[0]))
    knock = tv.TorqueHistory("gearbox_input", (0.0, 1.0, 1.0, 1.02, 1.02), (0.0, 0.0, -3000.0, -3000.0, 0.0))
    # the same speed and mean torque: a knock of 20 ms takes the line from the small motion to the large one
    drives = [engine(880 * tv.RPM), knock]
    run = tv.transient(system, drives, 8.0, start, hold=truck.landmarks.load, step=5e-5, output=1e-3)
    orders = tv.order_tracking(run.twist.sel(element="dmf"), run.crank_angle, [1.5])
    before, after = float(abs(orders[0, 0])), float(abs(orders[-1, 0]))
    print(f"at 880 rpm {before:.4f} rad before the knock and {after:.4f} rad after it")
    return {"up": float(up[5]), "down": float(down[5]), "before": before, "after": after}


if __name__ == "__main__":
    main()
