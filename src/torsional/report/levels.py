"""Findings about the response of one variant: the largest vibration, irregularity, travel of springs."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from torsional.laws import Hinges
from torsional.quantities import order_share, swing
from torsional.report.analysis import Response, Variant
from torsional.report.finding import Finding
from torsional.report.labels import listed, told
from torsional.report.springs import Spring


def largest(variant: Variant, response: Response) -> Finding:
    """The largest swing of acceleration at or below full load, where it is, and the share of its strongest order."""
    value, at = peak(response)
    place = f"{told(at['speed'], 'speed')} and {told(at['torque'], 'torque')}"
    gear = f" in gear {at['gear']}" if at["gear"] else ""
    text = f"The largest acceleration at {response.node.replace('_', ' ')} is {told(value, 'acceleration')} "
    text += f"(half peak-to-peak) at {place}{gear}."
    here = response.grid.angle.sel(node=response.node, gear=at["gear"], speed=at["speed"], torque=at["torque"])
    share = order_share(here * here.order**2, 0.0 if variant.main_order is None else variant.main_order)
    told_share = f" Order {variant.main_order:g} has {_most(float(share))} of its mean square."
    values = {"acceleration": value, "speed": at["speed"], "torque": at["torque"], "share": float(share)}
    return Finding("largest", text + told_share, values)


def peak(response: Response) -> tuple[float, dict[str, Any]]:
    """The largest swing of acceleration [rad/s²] within full load, and its gear, torque and speed."""
    within = response.map.where(response.within)
    at = {str(key): within[key].values[int(i.values)].item() for key, i in within.argmax(...).items()}
    return float(within.max()), at


def irregularities(response: Response) -> list[Finding]:
    """Irregularity of the crankshaft at idle."""
    if response.idle is None:
        return []
    loads = [
        f"{100 * float(v):.2g} % at {told(float(t), 'torque')}"
        for v, t in zip(response.idle, response.idle.torque, strict=True)
    ]
    values = {
        str(load): float(value) for load, value in zip(response.idle["load"].values, response.idle.values, strict=True)
    }
    return [
        Finding(
            "irregularity", f"The crankshaft's cyclic irregularity at idle is {listed(loads)} of mean torque.", values
        )
    ]


def travel(variant: Variant, response: Response, spring: Spring) -> list[Finding]:
    """How far a spring is twisted at full load, its distance to the stop, and whether a stage is crossed."""
    gear, data = widest(response, spring.name)
    most = float(data.mean_twist.max())
    reach = data.mean_twist + data.swing
    extent, speed = float(reach.max()), float(data.speed[int(reach.argmax("speed"))])
    name = spring.name.replace("_", " ")
    text = f"At full load {name} is twisted by {told(most, 'relative_angle')} on average at most; with its swing by "
    text += f"{told(extent, 'relative_angle')}, at {told(speed, 'speed')}{f' in gear {gear}' if gear else ''}"
    values = {"mean": most, "extent": extent, "speed": speed}
    if spring.stop is None:
        return [Finding("travel", text + ".", values), *_stages(spring, data, name)]
    values["stop"] = spring.stop
    rest = spring.stop - extent
    if rest >= 0:
        text += f". Its stop is at {told(spring.stop, 'relative_angle')}: {told(rest, 'relative_angle')} are left."
    else:
        text += (
            f": {told(-rest, 'relative_angle')} beyond its stop at {told(spring.stop, 'relative_angle')}. There the "
        )
        text += "response linearised about the mean torque no longer holds; a nonlinear one is needed."
    return [Finding("travel", text, values), *_stages(spring, data, name)]


def widest(response: Response, element: str) -> tuple[str, xr.Dataset]:
    """The gear in which a spring reaches furthest at full load; its mean twist, swing and torque over speed."""
    twist = swing(response.full.twist.sel(element=element)).transpose("gear", "speed")
    mean = response.full.mean_twist.sel(element=element)
    gear = str(twist.gear.values[int((mean + twist).max("speed").argmax("gear"))])
    chosen = {
        "mean_twist": mean.sel(gear=gear),
        "swing": twist.sel(gear=gear),
        "mean_torque": response.full.mean_torque,
    }
    return gear, xr.Dataset(
        {key: value.drop_vars(("gear", "element"), errors="ignore") for key, value in chosen.items()}
    )


def _stages(spring: Spring, data: xr.Dataset, name: str) -> list[Finding]:
    """Speeds at which the swing at full load runs across a change of stiffness other than the stop."""
    edges = [gap for gap in spring.law.gaps if gap not in spring.law.stops] if isinstance(spring.law, Hinges) else []
    low, high = (data.mean_twist - data.swing).values, (data.mean_twist + data.swing).values
    crossed = np.any([(low < edge) & (edge < high) for edge in edges], axis=0) if edges else np.zeros(low.shape, bool)
    if not crossed.any():
        return []
    speeds = data.speed.values[crossed]
    span = (
        f"{told(float(speeds[0]), 'speed')} to {told(float(speeds[-1]), 'speed')}"
        if speeds.size > 1
        else told(float(speeds[0]), "speed")
    )
    text = (
        f"At full load {name} swings across a change of its stiffness at speeds from {span}: the linear response is an "
    )
    text += "approximation there, and sub-harmonic vibration is possible."
    return [Finding("stages", text, {"from": float(speeds[0]), "to": float(speeds[-1])})]


def unsolved(response: Response) -> list[Finding]:
    """Cells of the map without a solution."""
    count = int((response.grid.status != 0).any("order").sum())
    return (
        [Finding("unsolved", f"{count} cells of the map could not be solved and are left empty.", {"cells": count})]
        if count
        else []
    )


def _most(share: float) -> str:
    return f"{100 * share:.0f} %" if share < 0.995 else "more than 99 %"
