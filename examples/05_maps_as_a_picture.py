"""Two maps and their ratio in one picture, that of the README: `python examples/05_maps_as_a_picture.py`."""

from pathlib import Path

import numpy as np

import torsional as tv
from torsional.plots import panels, plot_map, plot_ratio_map, save_png


def main(target: Path = Path("out/maps.png")) -> dict[str, float]:
    shaken, within, limit = {}, None, None
    for kind in ("single", "dual"):
        truck = tv.load_model(f"examples/truck_{kind[0]}mf.yaml")
        result = tv.response_map(truck, speed=truck.speeds(71), torque=np.linspace(0.0, 2500.0, 51), gears=[12])
        shaken[kind] = tv.swing(tv.acceleration(result.angle.sel(node="gearbox_input", gear="12")))
        within = result.within_full_load
        limit = result.speed.copy(data=truck.engine.full_load_torque(result.speed.values))
    ratio = shaken["dual"] / shaken["single"]
    axes = panels(1, 3, (4.6, 3.6))
    both = (20.0, 5000.0)
    for place, kind in zip(axes, shaken, strict=False):
        plot_map(shaken[kind], within=within, full_load=limit, limits=both, title=f"{kind} mass flywheel", axes=place)
    plot_ratio_map(ratio, within=within, full_load=limit, title="dual over single", axes=axes[2])
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(save_png(axes[0].figure))
    print(f"written: {target}, median ratio {float(ratio.where(within).median()):.2f}")
    return {"median": float(ratio.where(within).median())}


if __name__ == "__main__":
    main()
