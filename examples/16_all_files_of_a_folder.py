"""One table about all model files of a folder: their first modes, and what reaches the gearbox."""

from pathlib import Path

import torsional as tv


def main(folder: Path = Path("examples")) -> dict[str, float]:
    clutch = {}
    for file in sorted(folder.glob("truck_*.yaml")):
        try:
            truck = tv.load_model(file)
        except tv.ModelError as error:  # one bad file is told and does not stop the others
            print(f"{file.name}: {error}")
            continue
        system, _ = tv.at_operating_point(truck, torque=1500.0)
        modes = tv.modal(system, speed=1200 * tv.RPM)  # the speed matters to pendulums alone
        mode = int(modes.elastic_share.sel(element="clutch").argmax("mode"))
        clutch[file.stem] = 20 * float(modes.frequency[mode])
        print(f"{file.name:33s} {truck.absorber.kind:37s} clutch mode met at {clutch[file.stem]:4.0f} rpm")
    # 654 and 769 rpm by an independent prototype, at 1500 and 2000 Nm: the flywheel's one stage is linear
    assert round(clutch["truck_smf"]) == 654 and round(clutch["truck_dmf"]) == 769
    return clutch


if __name__ == "__main__":
    main()
