"""The report's sections, in the order in which they are read."""

from __future__ import annotations

from torsional.report import pictures, response_pictures, tables
from torsional.report.analysis import Comparison, Variant
from torsional.report.blocks import Block, Heading, Items, Picture, Section, Text
from torsional.report.findings import findings
from torsional.report.labels import listed, told
from torsional.report.motion_pictures import motion_blocks
from torsional.report.springs import springs_of


def sections(comparison: Comparison) -> list[Section]:
    """All sections that have something to tell."""
    made = [summary(comparison), *[machine(comparison, v, i) for i, v in enumerate(comparison.variants)]]
    made += [interference(comparison), excitation(comparison), cuts(comparison), maps(comparison)]
    made += [springs(comparison), motions(comparison), _synthesis(comparison), conventions(comparison)]
    return [section for section in made if section.blocks]


def summary(comparison: Comparison) -> Section:
    """What is found, in sentences."""
    groups = [Items(title, tuple(f.text for f in found)) for title, found in findings(comparison)]
    return Section("findings", "Findings", tuple(groups))


def machine(comparison: Comparison, variant: Variant, number: int) -> Section:
    """One variant: data, drawing, modes."""
    gear = variant.model.top_gear
    chosen = [g for g in dict.fromkeys((gear, *comparison.gears)) if g in variant.names]
    blocks: list[Block] = [
        tables.summary_table(variant),
        pictures.chain_picture(variant, gear),
        tables.inertia_table(variant, gear),
        tables.connection_table(variant, gear),
        *[tables.mode_table(variant, each, folded=each != gear) for each in chosen],
        pictures.shape_picture(variant, gear),
        *[pictures.shares_picture(variant, each) for each in chosen],
    ]
    title = variant.label[:1].upper() + variant.label[1:]
    return Section(f"machine-{number + 1}", title, tuple(blocks))


def interference(comparison: Comparison) -> Section:
    """Interference diagrams and resonance tables."""
    blocks: list[Block] = []
    for variant in comparison.variants:
        torque = told(float(variant.interference.attrs["mean_torque"]), "torque", 4)
        blocks.append(Heading(f"{variant.label}, modes under a mean engine torque of {torque}"))
        blocks.append(pictures.campbell_picture(variant))
        if variant.main_order is not None:
            blocks.append(pictures.resonance_picture(variant))
        made = tables.resonance_table(variant)
        blocks += [made] if made else []
    return Section("interference", "Interference of orders and modes", tuple(blocks))


def excitation(comparison: Comparison) -> Section:
    """What the engine does; told once where all variants have the same engine."""
    groups: list[list[Variant]] = []
    for variant, _ in comparison.answered:
        alike = [g for g in groups if _engine(g[0]) == _engine(variant)]
        alike[0].append(variant) if alike else groups.append([variant])
    blocks: list[Block] = []
    for group in groups:
        blocks += [Heading(listed([variant.label for variant in group]))] if len(groups) > 1 else []
        blocks += response_pictures.engine_pictures(group[0])
    return Section("excitation", "Excitation by the engine", tuple(blocks))


def _engine(variant: Variant) -> object:
    return variant.model.engine, variant.model.operation


def cuts(comparison: Comparison) -> Section:
    """Orders over speed."""
    if not comparison.answered:
        return Section("orders", "", ())
    each: list[Picture] = [response_pictures.gears_picture(v, r) for v, r in comparison.answered if v.model.gears]
    return Section("orders", "Order cuts at full load", (*each, response_pictures.cuts_picture(comparison)))


def maps(comparison: Comparison) -> Section:
    """Maps over speed and torque for the chosen gears."""
    if not comparison.answered:
        return Section("maps", "", ())
    held = [g for g in comparison.gears if any(g in r.map.gear.values for _, r in comparison.answered)]
    return Section(
        "maps", "Maps over speed and torque", tuple(response_pictures.map_picture(comparison, g) for g in held)
    )


def springs(comparison: Comparison) -> Section:
    """Travel of absorber springs and clutch."""
    blocks: list[Block] = []
    for variant, response in comparison.answered:
        for spring in springs_of(variant):
            blocks += response_pictures.spring_pictures(variant, response, spring)
    return Section("travel", "Travel of the springs", tuple(blocks))


def motions(comparison: Comparison) -> Section:
    """Periodic motions of springs with stages."""
    blocks = [block for variant in comparison.variants for block in motion_blocks(variant)]
    return Section("motions", "Periodic motions, springs as they are", tuple(blocks))


def _synthesis(comparison: Comparison) -> Section:
    """The signal over the cycle."""
    return Section("cycle", "Over one engine cycle", tuple(response_pictures.cycle_pictures(comparison)))


def conventions(comparison: Comparison) -> Section:
    """How figures are to be read and what they come from."""
    texts = [
        "Orders are complex amplitudes, 0-peak. A swing is half the difference of the largest and the smallest value "
        "over one cycle of 720° crank angle, all orders added with their phases. The crank angle is zero at firing of "
        "cylinder 1. Twists and torques of springs are positive while the engine drives.",
        "Every mean torque has its own equilibrium; vibration is linear about it, with the tangent stiffness there. "
        "Where a spring swings across a change of its stiffness, that is an approximation; periodic motions are not "
        "linearised, and told for springs with stages in the last gear.",
    ]
    for variant, response in comparison.answered:
        speeds, torques, orders = response.map.speed, response.map.mean_torque, response.orders.order
        texts.append(
            f"{variant.label}: maps of {speeds.size} speeds from {told(float(speeds[0]), 'speed', 4)} to "
            f"{told(float(speeds[-1]), 'speed', 4)} by {torques.size} mean torques up to "
            f"{told(float(torques[-1]), 'torque', 4)}, orders {orders.values[0]:g} to {orders.values[-1]:g}; along "
            f"full load {response.orders.speed.size} speeds."
        )
    return Section("conventions", "How to read the figures", tuple(Text(text, "note") for text in texts))
