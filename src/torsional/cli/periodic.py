"""`torsional periodic`: every periodic motion of a model whose springs have stages, with its stability."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from torsional.cli import inputs
from torsional.cli.answers import Answer, deliver, told_settings
from torsional.cli.documents import amount, described
from torsional.cli.failures import complain
from torsional.cli.modes import in_gear
from torsional.cli.periodic_tables import (
    bifurcation_table,
    branch_table,
    coexisting_table,
    largest_tables,
    motion_tables,
    places_of,
)
from torsional.cli.places import chosen_places
from torsional.cli.request import Request
from torsional.cli.spans import Span, asked
from torsional.cli.tables import Table
from torsional.components import Coupling
from torsional.errors import ModelError
from torsional.files import changed
from torsional.laws import Law
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities.branches import coexisting, solutions_at, without_stable
from torsional.solvers.periodic import model_response, varied_response
from torsional.system import assemble
from torsional.units import QUANTITIES, show

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BETWEEN = 201
"""Values at which every branch has a point beside those that the solver chooses, so that pictures are smooth."""

_WIDER = "a wider range, or --isolated, may show one"


@dataclass(frozen=True, eq=False)
class _View:
    """A response with what is looked at: nodes, connections, orders, and the motions at one value (None: no value)."""

    data: xr.Dataset
    nodes: Sequence[str]
    elements: Sequence[str]
    orders: Sequence[float]
    quantity: str
    laws: Mapping[str, Law | None]
    stiffness: Mapping[str, float]
    motions: xr.Dataset | None = None
    at: str = ""
    heading: str = ""


def run(
    request: Request,
    gear: str,
    torque: str,
    speed: str,
    parameter: str,
    at: str,
    isolated: bool,
    order: Sequence[str] | None,
    node: Sequence[str] | None,
    element: Sequence[str] | None,
) -> None:
    """Answer the command."""
    machine = request.model
    engaged, span = inputs.one_gear(machine, gear), asked(machine, speed, torque, parameter)
    chosen, wanted = span.value(at), inputs.orders(order, "")
    laws = laws_of(machine, engaged)
    nodes, elements = _places(machine, engaged, node, element, laws)
    data = solved(machine, engaged, span, chosen, isolated)
    if chosen is not None and span.name not in ("speed", "mean_torque"):
        machine = changed(machine, {span.name: chosen})  # the motions are those of the changed model
        laws = laws_of(machine, engaged)
    warn_unsettled(data, span)
    place = f"{in_gear(engaged)}, {span.told}"
    told = "" if chosen is None else show(chosen, span.quantity) + place
    motions = None if chosen is None else solutions_at(data, chosen)
    c = assemble(machine.powertrain(engaged)).connections
    stiffness = dict(zip(c.names, map(float, c.stiffness), strict=True))
    view = _View(
        data,
        nodes,
        elements,
        _orders(data, wanted),
        span.quantity,
        laws,
        stiffness,
        motions,
        told,
        f"Periodic motions{place}",
    )
    document = _document(request, engaged, span, chosen, view)
    kept = data.sel(node=nodes, element=elements)
    deliver(Answer("periodic", _tables(view), document, kept, data, lambda: _picture(view)), request)


def warn_unsettled(data: xr.Dataset, span: Span) -> None:
    """Say where the machine must do something else than what was found."""
    at = data.bifurcation_value.values[data.bifurcation_type.values == "Neimark–Sacker"]
    for low, high in without_stable(data):
        ends = " to ".join(show(value, span.quantity) for value in (low, high))
        turned = np.isclose(at[:, None], [low, high], rtol=1e-6).any()
        told = "the motion takes up a frequency there that is no order of the engine" if turned else _WIDER
        complain(f"no stable periodic motion was found from {ends}; {told}", kind="warning")


def _document(request: Request, gear: str, span: Span, at: float | None, view: _View) -> dict[str, object]:
    """How it was asked, and the motions at the value chosen."""
    followed = {"name": span.name, "from": amount(span.low, span.quantity), "to": amount(span.high, span.quantity)}
    given: dict[str, object] = {"speed": span.speed and amount(span.speed, "speed")}
    if span.name != "mean_torque":
        given["torque"] = "full load" if span.torque is None else amount(span.torque, "torque")
    if at is not None:
        given["at"] = amount(at, span.quantity)
    head = told_settings(request, gear=gear, parameter=followed, **given, orders=view.orders)
    if view.motions is None:
        return head
    return {**head, "motions": described(view.motions.sel(node=list(view.nodes), element=list(view.elements)))}


def _tables(view: _View) -> list[Table]:
    data, quantity = view.data, view.quantity
    places = places_of(data, view.nodes, view.elements)
    found = [branch_table(data, quantity, view.heading)]
    if data.sizes["bifurcation"]:
        found.append(bifurcation_table(data, quantity, places, view.orders))
    if coexisting(data):
        found.append(coexisting_table(data, quantity))
    found += largest_tables(data, quantity, places, view.orders)
    if view.motions is not None:
        at = places_of(view.motions, view.nodes, view.elements)
        found += motion_tables(view.motions, at, view.orders, view.laws, view.at)
    return found


def _picture(view: _View) -> Figure:
    from torsional.plots import plot_periodic

    return plot_periodic(
        view.data,
        [*view.orders, "swing"],
        elements=view.elements,
        nodes=view.nodes,
        solutions=view.motions,
        laws=view.laws,
        stiffness=view.stiffness,
        heading=view.heading,
        title=view.at,
    )


def laws_of(model: Model, gear: str) -> dict[str, Law | None]:
    """The laws of all connections; ModelError, with the springs that could have stages, for a model without any."""
    powertrain = model.powertrain(gear)
    c = assemble(powertrain).connections
    laws = dict(zip(c.names, c.laws, strict=True))
    if not any(law is not None for law in laws.values()):
        could = [name for name, part in powertrain.components.items() if isinstance(part, Coupling)]
        given = f"give {' or '.join(could[:4])} stages" if could else "give a coupling stages"
        raise ModelError(
            "all springs of this model are linear: it has one periodic motion, and that is its linear response",
            where=model.name,
            remedy=f"{given}, lash or a stop ({_example(model, could)}), or ask `torsional respond`",
        )
    return laws


def _example(model: Model, could: Sequence[str]) -> str:
    """How stages are given to the first spring that could have some."""
    stages = "stages=[{up_to: 1000 Nm, stiffness: 8 kNm/rad}, {stiffness: 24 kNm/rad}]"
    first = could[0] if could else ""
    block = "absorber" if first in model.landmarks.springs else "clutch" if first == model.landmarks.clutch else ""
    if block not in model.document:
        return f"in the file: {stages.replace('=', ': ')}"
    single = f" --set {block}.stiffness=null" if "stiffness" in model.document[block] else ""
    return f"--set '{block}.{stages}'{single}"


def solved(model: Model, gear: str, span: Span, at: float | None, isolated: bool) -> xr.Dataset:
    """All branches over the span, with points close together and one at the value asked for."""
    smooth = BETWEEN if span.name in ("speed", "mean_torque") else 0  # every value of the file is a model of its own
    values = np.append(np.linspace(span.low, span.high, smooth), [] if at is None else at)
    ends = (span.low, span.high)
    if span.name == "speed":
        return model_response(model, ends, span.torque, gear, at=values, isolated=isolated)
    path = "torque" if span.name == "mean_torque" else span.name
    assert span.speed is not None
    data = varied_response(model, path, ends, span.speed, span.torque or 0.0, gear, at=values, isolated=isolated)
    entry = QUANTITIES[span.quantity]
    told = {"quantity": entry.name, "units": entry.unit}
    return data.assign_coords(value=data.value.assign_attrs(told)).assign_attrs(parameter_unit=entry.unit)


def _orders(data: xr.Dataset, asked_for: Array | None) -> list[float]:
    """The orders to tell: those asked for, or the engine's main order and half of it where some branch has that."""
    main = float(data.attrs["main_order"])
    known = data.order.values
    if asked_for is None:
        return [n for n in (main, main / 2) if n in known]
    for n in asked_for:
        if n not in known:
            allowed = ", ".join(f"{k:g}" for k in known[known > 0])
            raise ModelError("no branch has this order", where="--order", found=f"{n:g}", allowed=allowed)
    return sorted(map(float, asked_for), reverse=True)


def _places(
    model: Model, gear: str, node: Sequence[str] | None, element: Sequence[str] | None, laws: dict[str, Law | None]
) -> tuple[list[str], list[str]]:
    """The places named, or else the springs with laws and the node to be kept quiet."""
    if node or element:
        return chosen_places(model, gear, node, element)
    return [n for n in [model.landmarks.input] if n], [name for name, law in laws.items() if law is not None]
