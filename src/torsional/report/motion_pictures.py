"""Pictures of periodic motions: the region of sub-harmonic vibration, branches, and motions over a cycle."""

from __future__ import annotations

from torsional import plots
from torsional.plots import style
from torsional.quantities.branches import stable_ranges
from torsional.quantities.region import stretches
from torsional.report.analysis import Variant
from torsional.report.blocks import Block, Heading, Picture, Table, picture, table
from torsional.report.labels import told
from torsional.report.motions import Motions
from torsional.report.pictures import in_gear
from torsional.studies.subharmonic import full_load_curve, within


def motion_blocks(variant: Variant) -> list[Block]:
    """Everything that is shown of one variant's periodic motions."""
    motions = variant.motions
    if motions is None:
        return []
    blocks: list[Block] = [Heading(variant.label)]
    if motions.at is not None:
        blocks += [_region_picture(variant, motions), _region_table(motions), _branch_picture(motions)]
    if motions.full_load.sizes["bifurcation"] or motions.at is None:
        blocks.append(_full_load_picture(motions))
    return blocks


@style.styled
def _region_picture(variant: Variant, motions: Motions) -> Picture:
    """Torque and acceleration of the sub-harmonic order over speed and mean torque."""
    region = motions.region
    curve = full_load_curve(variant.model, float(region.speed[0]), float(region.speed[-1]))
    axes = plots.panels(1, 2, (5.6, 4.4))
    for drawn, shown in zip(axes, ("amplitude", "acceleration"), strict=True):
        plots.plot_region(region, shown, full_load=curve, axes=drawn)
    caption = f"Where it vibrates at order {motions.order:g}{in_gear(motions.gear)}, half the engine's main order, and "
    caption += "how much (0-peak); white where it does not. On the line the motion with every ignition alike loses its "
    caption += "stability. What lies above full load is hatched."
    return picture(style.figure_of(axes[0]), caption, "Two colour maps over speed and mean torque with a boundary.")


def _region_table(motions: Motions) -> Table:
    """The speeds of the region at every mean torque."""
    inside = within(motions.region)
    rows = []
    for row, torque in enumerate(inside.mean_torque.values):
        for columns, low, high in stretches(inside, row):
            here = inside.isel(mean_torque=row, speed=columns)
            values = (float(here.amplitude.max()), "torque"), (float(here.acceleration.max()), "acceleration")
            ends = (f"{told(v, 'speed', 4).removesuffix(' rpm')}" for v in (low, high))
            rows.append((told(float(torque), "torque", 4), *ends, *(told(v, q) for v, q in values)))
    head = ("mean torque", "from [rpm]", "to [rpm]", "torque, 0-peak", "acceleration, 0-peak")
    caption = f"Speeds with vibration of order {motions.order:g} at each mean torque within full load"
    return table(caption, head, rows, numbers=(0, 1, 2, 3, 4), folded=True)


def _branch_picture(motions: Motions) -> Picture:
    """Branches at the mean torque of the largest sub-harmonic amplitude, and the motions at its speed."""
    branches, at = motions.branches, motions.at
    assert branches is not None and at is not None
    place = f"{told(at['speed'], 'speed')}, {told(at['mean_torque'], 'torque', 4)}{in_gear(motions.gear)}"
    figure = plots.plot_periodic(
        branches,
        [float(branches.attrs["main_order"]), motions.order, "swing"],
        elements=[motions.element],
        nodes=[motions.node],
        solutions=motions.solutions,
        laws={motions.element: motions.law},
        stiffness={motions.element: motions.stiffness},
        title=place,
    )
    caption = (
        f"Periodic motions at a mean torque of {told(at['mean_torque'], 'torque', 4)}{in_gear(motions.gear)}: stable "
    )
    caption += f"ones as full lines, unstable ones dashed. Below, those at {told(at['speed'], 'speed')} over crank "
    caption += "angle with the stage that the spring is in, and the loops they make about its characteristic."
    return picture(
        figure, caption, "Amplitudes over speed for every branch, and waveforms of the motions at one speed."
    )


def _full_load_picture(motions: Motions) -> Picture:
    """Branches along full load."""
    main = float(motions.full_load.attrs["main_order"])
    figure = plots.plot_periodic(motions.full_load, [main, "swing"], elements=[motions.element], nodes=[motions.node])
    parts = [stable_ranges(motions.full_load, number) for number in range(motions.full_load.sizes["branches"])]
    count = sum(map(len, parts))
    caption = f"Periodic motions along full load{in_gear(motions.gear)}, not linearised: "
    caption += "one stable motion at every speed." if count == 1 else "full lines are stable, dashed ones unstable."
    return picture(figure, caption, "Amplitudes over speed for every branch at full load.")
