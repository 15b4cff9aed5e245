"""A computed order beside a measured one: both in one picture, and the stiffness that deviates least."""

import csv
import io
from pathlib import Path

import numpy as np
import xarray as xr

import torsional as tv
from torsional.plots import plot_order_cuts, save_png

# As a measuring system exports it; here computed with 27 kNm/rad, with 3 % of noise.
MEASURED = """rpm,rad/s2
600,2584
640,3785
680,4087
720,2554
760,1747
800,1201
840,867
880,696
920,553
"""


def computed(stiffness: float) -> xr.DataArray:
    """Orders at the gearbox input in direct gear at 1500 Nm."""
    truck = tv.changed(tv.load_model("examples/truck_smf.yaml"), {"clutch.stiffness": stiffness})
    result = tv.response_map(truck, np.arange(600, 931, 5) * tv.RPM, [1500.0], gears=["12"], orders=[3.0])
    return tv.acceleration(result.angle.sel(node="gearbox_input"))


def main(target: Path = Path("out/beside_a_measurement.png")) -> dict[str, float]:
    rows = list(csv.DictReader(io.StringIO(MEASURED)))  # with a file: Path("measured.csv").read_text()
    rpm, measured = (np.array([float(row[key]) for row in rows]) for key in ("rpm", "rad/s2"))
    deviation = {}
    for stiffness in np.arange(23e3, 32e3, 2e3):
        third = tv.amplitude(computed(stiffness), 3.0).squeeze()
        off = third.interp(speed=rpm * tv.RPM).values / measured - 1
        deviation[stiffness] = float(np.sqrt(np.mean(off**2)))
        print(f"{stiffness / 1e3:.0f} kNm/rad: off by {deviation[stiffness]:.1%} in the mean")
    best = min(deviation, key=deviation.__getitem__)
    figure = plot_order_cuts({"25 kNm/rad": computed(25e3), f"{best / 1e3:.0f} kNm/rad": computed(best)}, "12", [3.0])
    axes = figure.axes[0]
    axes.plot(rpm, measured, "ko", label="measured")
    axes.legend()
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(save_png(figure))
    print(f"written: {target}")
    assert best == 27e3 and deviation[best] < 0.04  # the stiffness it was made with, to its noise
    return {"best": float(best), "deviation": deviation[best]}


if __name__ == "__main__":
    main()
