"""The report's tables."""

from __future__ import annotations

import math

import numpy as np

from torsional.model import Model
from torsional.plots.layout import chain
from torsional.report.analysis import Variant
from torsional.report.blocks import Table, table
from torsional.report.labels import rounded, told
from torsional.stamps import GROUND, Connection, Constraint, Mass
from torsional.units import show

MOST_ROWS = 24
RANGE = "in range"


def summary_table(variant: Variant) -> Table:
    """What the model is: engine, absorber, operation, provenance."""
    model = variant.model
    rows = [("name", model.name), ("model hash", model.hash)]
    rows += [("absorber", model.absorber.kind)] if model.absorber else []
    rows += _engine_rows(model)
    rows += [("gears", f"{len(model.gears)}, ratios {_ratios(model)}")] if model.gears else []
    low, high = model.operation.speed
    rows += [
        (
            "operating range",
            f"{told(low, 'speed')} to {told(high, 'speed')}, idle {told(model.operation.idle, 'speed')}",
        ),
        ("mean torque of the modes", told(float(variant.interference.attrs["mean_torque"]), "torque", 4)),
    ]
    rows += [(what, place.replace("_", " ")) for what, place in _places(model) if place]
    return table("The model", ("", ""), rows)


def _ratios(model: Model) -> str:
    return ", ".join(f"{gear.ratio:.4g}" for gear in model.gears.values())


def _places(model: Model) -> list[tuple[str, str]]:
    marks = model.landmarks
    return [("node to be kept quiet", marks.input), ("mean torque is taken up at", marks.load)]


def _engine_rows(model: Model) -> list[tuple[str, str]]:
    engine = model.engine
    if engine is None:
        return [("engine", "none: modes only")]
    order = "-".join(str(number) for number in engine.layout.firing_order)
    rows = [
        ("engine", f"{engine.layout.cylinders} cylinders, four-stroke, firing order {order}"),
        ("bore × stroke", f"{told(engine.bore, 'length', 4)} × {told(engine.stroke, 'length', 4)}"),
        ("displacement", f"{1e3 * engine.displacement:.4g} l, compression ratio {engine.compression_ratio:g}"),
    ]
    if engine.full_load is not None:
        top = int(np.argmax(engine.full_load.torques))
        at = told(engine.full_load.speeds[top], "speed", 4)
        rows.append(("largest torque", f"{told(engine.full_load.torques[top], 'torque', 4)} from {at}"))
    return rows


def inertia_table(variant: Variant, gear: str) -> Table:
    """Every mass with its own and its referred inertia."""
    powertrain = variant.model.powertrain(gear)
    referred = chain(powertrain)
    rows = []
    for stamp in powertrain.stamps:
        if isinstance(stamp, Mass):
            node = next(iter(stamp.weights))
            alone = len(stamp.weights) == 1
            ratio = referred.ratio[node] if alone else math.nan
            at = show(stamp.inertia * ratio**2, "inertia") if alone else "–"
            rows.append((_words(stamp.name), show(stamp.inertia, "inertia"), rounded(ratio, 4), at))
    head = ("mass", "inertia", "speed over engine speed", "referred to engine speed")
    return table(f"Inertias ({len(rows)})", head, rows, numbers=(1, 2, 3), folded=True)


def connection_table(variant: Variant, gear: str) -> Table:
    """Every connection with its stiffness and damping, and every gear."""
    powertrain = variant.model.powertrain(gear)
    stiff = {link.name: link.described for link in chain(powertrain).links}
    rows = []
    for stamp in powertrain.stamps:
        if isinstance(stamp, Connection):
            between = " – ".join(_words(node) for node in stamp.weights if node != GROUND)
            between += " – ground" if len(stamp.weights) == 1 or GROUND in stamp.weights else ""
            damping = show(stamp.damping, "damping") if stamp.damping else "–"
            loss = f"{stamp.loss_factor:g}" if stamp.loss_factor else "–"
            rows.append((_words(stamp.name), between, stiff.get(stamp.name) or "–", damping, loss))
        elif isinstance(stamp, Constraint):
            rows.append(
                (_words(stamp.name), " – ".join(_words(node) for node in stamp.weights), "rigid gear", "–", "–")
            )
    head = ("connection", "between", "stiffness", "damping", "loss factor")
    return table(f"Connections ({len(rows)})", head, rows, numbers=(2, 3, 4), folded=True)


def mode_table(variant: Variant, gear: str, folded: bool = False) -> Table:
    """The modes of one gear."""
    modes, names = variant.modes(gear), variant.names[gear]
    low, high = variant.model.operation.speed
    order = variant.main_order
    rows = []
    for mode, name in enumerate(names[:MOST_ROWS]):
        share = modes.elastic_share.isel(mode=mode)
        most = int(share.argmax("element"))
        rigid = float(modes.frequency[mode]) == 0
        at = math.nan if order is None else float(modes.crossing[mode, 0])
        place = RANGE if low <= at <= high else ""
        rows.append(
            (
                str(mode),
                name,
                f"{float(modes.frequency[mode]):.2f}",
                "–" if math.isnan(at) else f"{told(at, 'speed').removesuffix(' rpm')}",
                "–" if rigid else f"{100 * float(modes.damping_ratio[mode]):.1f}",
                "–" if rigid else f"{_words(str(share.element.values[most]))} {100 * float(share[most]):.0f} %",
                place,
            )
        )
    speed_head = "speed of main order [rpm]" if order is None else f"order {order:g} at [rpm]"
    head = ("no.", "mode", "frequency [Hz]", speed_head, "damping ratio [%]", "largest energy share", "operating range")
    where = f" in gear {gear}" if gear else ""
    more = f"; {len(names) - MOST_ROWS} higher ones are left out" if len(names) > MOST_ROWS else ""
    return table(
        f"Modes{where}, named by where their elastic energy is{more}", head, rows, numbers=(0, 2, 3, 4), folded=folded
    )


def resonance_table(variant: Variant) -> Table | None:
    """Resonances of the main order in the operating range, gear by gear; None without gears or without an engine."""
    order = variant.main_order
    if order is None or not variant.model.gears:
        return None
    low, high = variant.model.operation.speed
    rows = []
    for gear, names in variant.names.items():
        at = variant.interference.crossing.sel(gear=gear).isel(order=0).values
        spots = [f"{name} {told(float(v), 'speed')}" for name, v in zip(names, at, strict=False) if low <= v <= high]
        ratio = variant.model.gears[gear].ratio
        rows.append((gear, f"{ratio:.4g}", "; ".join(spots) or "none"))
    caption = f"Where order {order:g} meets a mode inside the operating range, gear by gear"
    return table(caption, ("gear", "ratio", "mode and speed"), rows, numbers=(1,))


def _words(name: str) -> str:
    return name.replace("_", " ")
