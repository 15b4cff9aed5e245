"""Results as a table that any spreadsheet opens: one quantity, its units in the headings."""

import csv
from pathlib import Path

import torsional as tv


def main(target: Path = Path("out/third_order.csv")) -> dict[str, float]:
    truck = tv.load_model("examples/truck_dmf.yaml")
    result = tv.response_map(truck, truck.speeds(29), [500.0, 1500.0], gears=["11", "12"], orders=[3.0])
    third = tv.amplitude(tv.acceleration(result.angle), 3.0)
    target.parent.mkdir(parents=True, exist_ok=True)
    tv.save_results(third, target)  # all of ``result`` goes into one table too; with .nc nothing is lost
    with target.open(encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    print(f"{len(rows)} rows in {target}: {', '.join(rows[0])}")
    column = "acceleration gearbox_input [rad/s²]"
    worst = max(rows, key=lambda row: float(row[column]))
    print(f"most in gear {worst['gear']} at {float(worst['speed [rpm]']):.0f} rpm: {float(worst[column]):.0f} rad/s²")
    assert float(worst[column]) == float(third.sel(node="gearbox_input").max())  # every digit is kept
    return {"rows": len(rows), "rpm": float(worst["speed [rpm]"])}


if __name__ == "__main__":
    main()
