"""Findings about the response of one variant: the largest vibration, irregularity at idle."""

from __future__ import annotations

from typing import Any

from torsional.quantities import order_share
from torsional.report.analysis import Response
from torsional.report.finding import Finding
from torsional.report.labels import listed, told


def largest(response: Response) -> Finding:
    """The largest swing of acceleration at or below full load, where it is, and the share of its strongest order."""
    value, at = peak(response)
    place = f"{told(at['speed'], 'speed')} and {told(at['mean_torque'], 'torque')}"
    gear = f" in gear {at['gear']}" if at["gear"] else ""
    text = f"The largest acceleration at {response.node.replace('_', ' ')} is {told(value, 'acceleration')} "
    text += f"(half peak-to-peak) at {place}{gear}."
    here = response.grid.angle.sel(
        node=response.node, gear=at["gear"], speed=at["speed"], mean_torque=at["mean_torque"]
    )
    orders = here * here.order**2
    strongest = float(here.order[int(abs(orders).argmax("order"))])
    share = float(order_share(orders, strongest))
    text += f" Order {strongest:g} has {_most(share)} of its mean square."
    values = {
        "acceleration": value,
        "speed": at["speed"],
        "mean_torque": at["mean_torque"],
        "order": strongest,
        "share": share,
    }
    return Finding("largest", text, values)


def peak(response: Response) -> tuple[float, dict[str, Any]]:
    """The largest swing of acceleration [rad/s²] within full load, and its gear, torque and speed."""
    within = response.map.where(response.within)
    at = {str(key): within[key].values[int(i.values)].item() for key, i in within.argmax(...).items()}
    return float(within.max()), at


def irregularities(response: Response) -> list[Finding]:
    """Irregularity of the crankshaft at idle."""
    idle = response.idle
    if idle is None:
        return []
    values = {str(load): float(value) for load, value in zip(idle["load"].values, idle.values, strict=True)}
    pairs = zip(idle.values, idle.mean_torque.values, strict=True)
    loads = listed([f"{100 * float(value):.2g} % at {told(float(torque), 'torque')}" for value, torque in pairs])
    return [Finding("irregularity", f"The crankshaft's cyclic irregularity at idle is {loads} of mean torque.", values)]


def unsolved(response: Response) -> list[Finding]:
    """Cells of the map without a solution."""
    count = int((response.grid.status != 0).any("order").sum())
    text = f"{count} cells of the map could not be solved and are left empty."
    return [Finding("unsolved", text, {"cells": count})] if count else []


def _most(share: float) -> str:
    return f"{100 * share:.0f} %" if share < 0.995 else "more than 99 %"
