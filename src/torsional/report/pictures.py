"""Pictures of the machine and its modes, each with its caption and a text in its stead."""

from __future__ import annotations

import numpy as np
import xarray as xr

from torsional import plots
from torsional.report.analysis import Variant
from torsional.report.blocks import Picture, picture
from torsional.solvers.modal import modal
from torsional.solvers.operating import at_operating_point


def in_gear(gear: str) -> str:
    """' in gear 8', or nothing for a machine without gears."""
    return f" in gear {gear}" if gear else ""


def chain_picture(variant: Variant, gear: str) -> Picture:
    """The powertrain as discs and springs."""
    marks, powertrain = variant.model.landmarks, variant.model.powertrain(gear)
    figure = plots.plot_chain(powertrain, absorber=marks.springs, clutch=marks.clutch, throws=marks.throws)
    caption = (
        f"The powertrain{in_gear(gear)}. A disc's height is the fourth root of its inertia referred to the speed of "
    )
    caption += (
        "the first part, the diameter of a disc of one thickness; inertias are written so referred, stiffnesses as "
    )
    caption += (
        "they are. Absorber springs in orange, the clutch in green, throws of the crankshaft in blue, gears dotted."
    )
    return picture(
        figure, caption, f"{len(powertrain.nodes)} nodes joined by springs and gears, drawn from engine to load."
    )


def shape_picture(variant: Variant, gear: str) -> Picture:
    """Mode shapes of one gear."""
    modes = _shaped(variant, gear)
    names = variant.names[gear]
    figure = plots.plot_mode_shapes(modes, variant.model.powertrain(gear), names=names)
    caption = (
        f"The lowest mode shapes{in_gear(gear)}. A steep step between two neighbours is a spring that is strained; a "
    )
    caption += "flat part turns as one. Angles are referred to engine speed, so that gears leave no step."
    return picture(figure, caption, f"Lines of the angle of every node in {modes.attrs['drawn']} modes.")


def _shaped(variant: Variant, gear: str) -> xr.Dataset:
    """The modes with their shapes, linearised as the interference diagram is."""
    system, _ = at_operating_point(variant.model, float(variant.interference.attrs["mean_torque"]), gear)
    modes = modal(system, float(variant.modes(gear).speed))
    return modes.assign_attrs(drawn=min(5, int((modes.frequency > 0).sum())))


def shares_picture(variant: Variant, gear: str) -> Picture:
    """Elastic energy by mode."""
    modes = variant.modes(gear)
    modes = modes.isel(mode=np.isfinite(modes.frequency.values))
    figure = plots.plot_energy_shares(modes, names=variant.names[gear])
    caption = (
        f"Where the elastic energy of each mode lies{in_gear(gear)}: a change of a connection moves the modes in which "
    )
    caption += "its share is large, by half its share in frequency per share of stiffness."
    return picture(figure, caption, "One bar a mode, divided by the connections that hold its energy.")


def campbell_picture(variant: Variant) -> Picture:
    """Interference diagram."""
    result, operation = variant.interference, variant.model.operation
    figure = plots.plot_campbell(result, variant.names, speed=operation.speed, idle=operation.idle)
    caption = (
        "Interference diagram: natural frequencies of every gear and engine orders over speed. A circle marks where "
    )
    caption += "the main order meets a mode in the operating range: expect a resonance there."
    if not result.order.size:
        caption = "Natural frequencies over speed; without an engine there are no orders to meet them."
    return picture(figure, caption, f"Natural frequencies as lines over speed, orders {_orders(result)} as rays.")


def _orders(result: xr.Dataset) -> str:
    return ", ".join(f"{order:g}" for order in result.order.values) or "none"


def resonance_picture(variant: Variant) -> Picture:
    """Speeds at which the main order meets modes, by gear."""
    operation = variant.model.operation
    figure = plots.plot_resonance_speeds(
        variant.interference, variant.names, speed=operation.speed, idle=operation.idle
    )
    caption = f"The same for order {variant.main_order:g} alone: every mark in the shaded range is a speed to watch."
    return picture(figure, caption, "A row for each gear with marks at the speeds where the main order meets a mode.")
