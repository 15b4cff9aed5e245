"""One engine order in three gears in one picture, and where each gear's peak lies."""

from pathlib import Path

import torsional as tv
from torsional.plots import plot_gears, save_png

GEARS = ("8", "10", "12")


def main(target: Path = Path("out/three_gears.png")) -> dict[str, float]:
    truck = tv.load_model("examples/truck_smf.yaml")
    result = tv.response_map(truck, truck.speeds(561), [1500.0], gears=GEARS, orders=[3.0])
    shaken = tv.acceleration(result.angle.sel(node="gearbox_input"))
    third = tv.amplitude(shaken, 3.0).squeeze()
    peak = {gear: float(third.speed[int(third.sel(gear=gear).argmax("speed"))]) / tv.RPM for gear in GEARS}
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(save_png(plot_gears(shaken, 3.0, idle=truck.operation.idle)))
    print(f"written: {target}")
    for gear, rpm in peak.items():
        # the clutch mode of that gear, from the modes: 20 f rpm is the third order's speed
        modes = tv.modal(tv.at_operating_point(truck, 1500.0, gear)[0])
        mode = 20 * float(modes.frequency[int(modes.elastic_share.sel(element="clutch").argmax("mode"))])
        print(f"gear {gear:>2}: peak at {rpm:.0f} rpm, clutch mode at {mode:.0f} rpm")
        assert abs(rpm / mode - 1) < 0.03
    return peak


if __name__ == "__main__":
    main()
