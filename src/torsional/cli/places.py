"""The nodes and connections that an analysis looks at, and what is told of all orders together there."""

from __future__ import annotations

from collections.abc import Sequence

import xarray as xr

from torsional.errors import ModelError, nearest
from torsional.model import Model
from torsional.quantities import acceleration, irregularity, order_sum, swing
from torsional.system import assemble


def chosen_places(
    model: Model, gear: str, nodes: Sequence[str] | None, elements: Sequence[str] | None
) -> tuple[list[str], list[str]]:
    """The nodes and connections named, or 'all'; if none is named, the model's landmarks."""
    marks, system = model.landmarks, assemble(model.powertrain(gear))
    if nodes or elements:
        found = (
            _known(nodes or (), system.nodes, "--node"),
            _known(elements or (), system.connections.names, "--element"),
        )
    else:
        found = list(marks.observed_nodes), list(marks.observed_elements)
    kept = [[name for name in dict.fromkeys(names) if name] for names in found]
    if not any(kept):
        remedy = "name some by --node and --element, or give the file landmarks"
        raise ModelError("the model does not say which places to look at", where="landmarks", remedy=remedy)
    return kept[0], kept[1]


def _known(asked: Sequence[str], known: Sequence[str], option: str) -> list[str]:
    if "all" in asked and "all" not in known:
        return list(known)
    for name in asked:
        if name not in known:
            kind = "node" if option == "--node" else "connection"
            raise ModelError(f"there is no {kind} '{name}'", where=option, remedy=nearest(name, known))
    return list(asked)


def together(angle: xr.DataArray, torque: xr.DataArray) -> dict[str, xr.DataArray]:
    """Half peak-to-peak swings of accelerations and torques, phases kept, beside their bounds, and irregularities.

    ``angle`` (…, node) and ``torque`` (…, element) over orders.
    """
    told: dict[str, xr.DataArray] = {}
    if angle.sizes["node"]:
        moved = acceleration(angle)
        told |= {"acceleration_swing": swing(moved), "acceleration_bound": order_sum(moved)}
        told["irregularity"] = irregularity(angle)
    if torque.sizes["element"]:
        told |= {"torque_swing": swing(torque), "torque_bound": order_sum(torque)}
    return told


def without_empty(data: xr.Dataset) -> xr.Dataset:
    """The result without the kind of place of which none is looked at."""
    return data.drop_dims([dim for dim in ("node", "element") if data.sizes.get(dim) == 0])
