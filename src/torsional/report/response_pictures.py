"""Pictures of the excitation and of the response to it."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr

from torsional import plots
from torsional.engine.orders import HALF_ORDERS
from torsional.plots import style
from torsional.plots.maps import colour_limits
from torsional.quantities import order_sum, swing
from torsional.report.analysis import Comparison, Response, Variant
from torsional.report.blocks import Picture, picture
from torsional.report.labels import rounded, told
from torsional.report.levels import peak
from torsional.report.pictures import in_gear
from torsional.report.springs import Spring
from torsional.report.travels import widest
from torsional.results import dataset


def engine_pictures(variant: Variant) -> list[Picture]:
    """Full-load curve and torque orders."""
    response, engine = variant.response, variant.model.engine
    assert response is not None and engine is not None
    curve = response.curve
    chosen = np.unique([curve.speed[0], curve.speed[int(curve.argmax("speed"))], curve.speed[int(0.75 * curve.size)]])
    size = engine.harmonics(chosen, variant.model.full_load(chosen), HALF_ORDERS).sum(axis=-2)
    harmonics = dataset(
        {"engine_torque": (("speed", "order"), size, "torque")},
        {"speed": (chosen, "speed"), "order": (HALF_ORDERS, "engine_order")},
        analysis="engine orders",
    ).engine_torque
    main = float(np.abs(size[:, variant.main_order == HALF_ORDERS]).max())
    orders = picture(
        plots.plot_engine_orders(harmonics),
        f"Torque of all cylinders together by order at full load. Order {variant.main_order:g} is the main one, up to "
        f"{told(main, 'torque')}; orders at which the cylinders cancel each other still strain the crankshaft.",
        "Bars of the torque amplitude over the order.",
    )
    if engine.full_load is None:
        return [orders]
    top = told(float(curve.max()), "torque")
    line = plots.plot_full_load(curve, idle=variant.model.operation.idle)
    return [
        picture(line, f"Full load: torque up to {top}, and its power (dashed).", "Torque and power over speed."),
        orders,
    ]


def gears_picture(variant: Variant, response: Response) -> Picture:
    """The main order at the quiet node in every gear."""
    assert variant.main_order is not None
    main = variant.main_order
    figure = plots.plot_gears(response.orders, main, idle=variant.model.operation.idle)
    most = float(np.abs(response.orders.sel(order=main)).max())
    caption = (
        f"{variant.label}: order {main:g} of the acceleration at {response.node.replace('_', ' ')} at full load, up to "
    )
    caption += f"{told(most, 'acceleration')} (0-peak)."
    return picture(figure, caption, "A line for each gear over speed.")


@style.styled
def cuts_picture(comparison: Comparison) -> Picture:
    """Orders of every variant, a panel a gear, all on one scale."""
    answered = comparison.answered
    gears = [str(gear) for gear in answered[0][1].orders.gear.values]
    columns = min(3, len(gears))
    axes = plots.panels(math.ceil(len(gears) / columns), columns, (4.0, 2.5), sharex=True, sharey=True)
    shown = _cut_orders(comparison)
    for drawn, gear in zip(axes, gears, strict=False):
        held = {v.label: r.orders for v, r in answered if gear in r.orders.gear.values}
        plots.plot_order_cuts(held, gear, shown, axes=drawn)
        drawn.set_title(f"gear {style.plain(gear, 20)}" if gear else "")
        drawn.label_outer()
    for spare in axes[len(gears) :]:
        spare.set_axis_off()
    figure = style.figure_of(axes[0])
    handles, names = axes[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside upper left", ncols=len(answered))
    caption = "Orders of the acceleration at full load, gear by gear on one scale: a colour for each variant, the main "
    caption += "order as a full line."
    return picture(figure, caption, "Panels of amplitude over speed, one a gear.")


def _cut_orders(comparison: Comparison) -> list[float]:
    """The main order and the two that are next in what is felt at the quiet node of the first variant."""
    variant, response = comparison.answered[0]
    size = abs(response.orders).max(("gear", "speed"))
    ranked = [float(n) for n in response.orders.order.values[np.argsort(-size.values, kind="stable")]]
    assert variant.main_order is not None
    return [variant.main_order, *[n for n in ranked if n != variant.main_order][:2]]


@style.styled
def map_picture(comparison: Comparison, gear: str) -> Picture:
    """Maps of all variants that have a gear, and the ratio of the first to each other."""
    held = [(v, r) for v, r in comparison.answered if gear in r.map.gear.values]
    limits = colour_limits(*[style.shown(r.map.sel(gear=gear).where(r.within)) for _, r in held])
    ratios = [(v, ratio) for v, _ in held if v is not comparison.first and (ratio := comparison.ratio(v)) is not None]
    ratios = [(v, ratio) for v, ratio in ratios if gear in ratio.gear.values]
    count = len(held) + len(ratios)
    columns = 2 if count == 4 else min(count, 3)
    axes = plots.panels(math.ceil(count / columns), columns, (4.4, 3.6))
    for drawn, (variant, response) in zip(axes, held, strict=False):
        look = {"within": response.within, "full_load": response.curve, "limits": limits, "title": variant.label}
        plots.plot_map(response.map.sel(gear=gear), axes=drawn, **look)  # type: ignore[arg-type]
    for drawn, (variant, _) in zip(axes[len(held) :], ratios, strict=False):
        title = f"ratio to {variant.label}" if len(ratios) > 1 else "ratio of the first to the second"
        whole, both, curve = comparison.overlaid(variant)
        plots.plot_ratio_map(whole.sel(gear=gear), within=both, full_load=curve, title=title, axes=drawn)
    for spare in axes[count:]:
        spare.set_axis_off()
    return picture(
        style.figure_of(axes[0]), _map_caption(comparison, gear, ratios), "Colour maps over speed and torque."
    )


def _map_caption(comparison: Comparison, gear: str, ratios: list[tuple[Variant, xr.DataArray]]) -> str:
    told_peaks = []
    for variant, response in comparison.answered:
        if gear in response.map.gear.values:
            most = float(response.map.sel(gear=gear).where(response.within).max())
            told_peaks.append(f"{variant.label} up to {told(most, 'acceleration')}")
    caption = f"Acceleration{in_gear(gear)}, half peak-to-peak over the cycle with all orders in phase as they are: "
    caption += "; ".join(told_peaks) + ". What lies above full load is hatched."
    for variant, ratio in ratios:
        median = float(ratio.sel(gear=gear).median())
        caption += f" Ratio to {variant.label}: median {rounded(median)}; blue is quieter, red louder."
    return caption


def spring_pictures(variant: Variant, response: Response, spring: Spring) -> list[Picture]:
    """Characteristic with operating points, and travel over speed, in the gear in which it reaches furthest."""
    gear, data = widest(response, spring.name)
    name = spring.name.replace("_", " ")
    figure = plots.plot_characteristic(data, spring.law, stiffness=spring.stiffness)
    caption = (
        f"{variant.label}: characteristic of {name} with operating points at full load{in_gear(gear)}, the gear in "
    )
    caption += "which it reaches furthest; for each torque the point with the widest swing."
    over = plots.plot_travel(data, stop=spring.stop, transition=spring.transition)
    band = f"{variant.label}: twist of {name} over speed at full load{in_gear(gear)}; the band is its swing."
    return [
        picture(figure, caption, "Torque over twist, with the operating points as dots and their swing as bars."),
        picture(over, band, "Mean twist over speed with a band, and the stop as a line."),
    ]


def cycle_pictures(comparison: Comparison) -> list[Picture]:
    """The signal at each variant's own loudest point."""
    drawn = []
    for variant, response in comparison.answered:
        _, at = peak(response)
        here = response.grid.angle.sel(node=response.node, **at)
        orders = (-((here.order * here.speed) ** 2) * here).assign_attrs(response.orders.attrs)
        assert variant.main_order is not None
        place = f"{told(at['speed'], 'speed')}, {told(at['mean_torque'], 'torque')}{in_gear(str(at['gear']))}"
        figure = plots.plot_cycle(orders, shown=[variant.main_order], title=f"{variant.label}, {place}")
        half, most = float(swing(orders)), float(order_sum(orders))
        caption = f"{variant.label} at its loudest point within full load ({place}): half the peak-to-peak is "
        caption += (
            f"{told(half, 'acceleration')}, {rounded(100 * half / most)} % of the sum of the orders' amplitudes, which "
        )
        caption += "is a bound and not what happens."
        drawn.append(picture(figure, caption, "The acceleration over 720 degrees of crank angle between the bounds."))
    return drawn
