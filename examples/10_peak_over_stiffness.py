"""One response peak over one stiffness: what the clutch damper's spring does to the third order in the driveline."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import torsional as tv


def main(target: Path = Path("out/peak_over_stiffness.png")) -> dict[str, float]:
    truck = tv.load_model("examples/truck_smf.yaml")
    stiffnesses = np.arange(24e3, 37e3, 4e3)
    at, peaks, expected = [], [], []
    for stiffness in stiffnesses:
        changed = tv.changed(truck, {"clutch.stiffness": stiffness})
        result = tv.response_map(changed, truck.speeds(351), [1000.0], gears=[12], orders=[3.0])
        torque = tv.amplitude(result.torque.sel(element="clutch"), 3.0).squeeze()
        at.append(float(torque.speed[int(torque.argmax("speed"))]) / tv.RPM)
        peaks.append(float(torque.max()))
        system, _ = tv.at_operating_point(changed, torque=1000.0, gear=12)
        modes = tv.modal(system)
        clutch = int(modes.elastic_share.sel(element="clutch").argmax("mode"))  # the mode in which it works most
        expected.append(float(tv.order_speed(modes.frequency[clutch], 3)) / tv.RPM)
        print(f"{stiffness / 1e3:4.0f} kNm/rad: {peaks[-1]:5.0f} Nm at {at[-1]:.0f} rpm, mode {expected[-1]:.0f}")

    figure = Figure(figsize=(6, 3.5), layout="constrained")
    axes = figure.subplots()
    axes.plot(stiffnesses / 1e3, peaks, "o-")
    axes.set(xlabel="clutch damper [kNm/rad]", ylabel="largest order 3 in it [Nm], 0-peak")
    target.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(target)
    print(f"written: {target}")
    assert np.allclose(at, expected, rtol=0.015)  # the peak lies where the third order meets the undamped mode
    return {"softest": at[0], "stiffest": at[-1]}


if __name__ == "__main__":
    main()
