"""What a notebook shows: run these lines in cells of their own; models, systems and results are shown as tables."""

import numpy as np

import torsional as tv


def main() -> dict[str, float]:
    truck = tv.load_model("examples/truck_dmf.yaml")
    system, point = tv.at_operating_point(truck, torque=1500.0)
    modes = tv.modal(system)
    for name, shown in {"truck": truck, "system": system, "point": point, "modes": modes}.items():
        print(f"{name:7s} a page of {len(shown._repr_html_())} letters, in a line: {repr(shown)[:70].splitlines()[0]}")
    # the last expression of a cell is shown by its _repr_html_; 1500 Nm twist 13 kNm/rad by
    twist = np.degrees(1500 / 13e3)
    assert f"<td>dmf</td><td>1500 Nm</td><td>{twist:.4f} deg</td>" in point._repr_html_()
    return {"twist": twist}


if __name__ == "__main__":
    main()
