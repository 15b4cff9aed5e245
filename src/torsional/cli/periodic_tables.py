"""What `torsional periodic` tells people: branches, bifurcations, coexisting and largest motions, those at a value."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import xarray as xr

from torsional.cli.tables import Column, Table
from torsional.laws import Law
from torsional.quantities import acceleration, swing, waveform
from torsional.quantities.branches import (
    SHARE_SAMPLES,
    bifurcation_points,
    branch_numbers,
    coexisting,
    letter,
    stable_ranges,
    stage_shares,
)
from torsional.units import show

Laws = Mapping[str, Law | None]


def _parameter_column(result: xr.Dataset, quantity: str, name: str = "") -> Column:
    """A column of values of the continued parameter."""
    return Column(name or {"speed": "speed", "mean_torque": "torque"}.get(str(result.parameter), "value"), quantity)


def branch_table(result: xr.Dataset, quantity: str, title: str) -> Table:
    """Every branch: how it came about, where it lies, where it is stable, why it ends."""
    columns = [Column("branch", "number"), Column("kind"), Column("base order", "engine_order")]
    columns += [Column("from", quantity), Column("to", quantity), Column("stable"), Column("ends because")]
    rows = []
    for number in branch_numbers(result):
        value = result.value.values[result.branch.values == number]
        stable = (
            ", ".join(_span(low, high, quantity) for low, high in sorted(stable_ranges(result, number))) or "nowhere"
        )
        ended = str(result.ended.values[number]).split(";")[0].rstrip(".")
        kind = str(result.kind.values[number])
        parent = int(result.parent[number])
        told = kind if parent < 0 else f"{kind} of {parent}"
        rows.append([number, told, float(result.base_order[number]), value.min(), value.max(), stable, ended])
    return Table(title, columns, rows)


def _span(low: float, high: float, quantity: str) -> str:
    first, last = (show(value, quantity).split(" ")[0] for value in (low, high))
    return first if first == last else f"{first} to {last}"


def bifurcation_table(
    result: xr.Dataset, quantity: str, places: Sequence[xr.DataArray], orders: Sequence[float]
) -> Table:
    """Every bifurcation with the amplitude of the highest order asked for at each place."""
    at = bifurcation_points(result)
    main = max(orders)
    columns = [Column("bifurcation"), Column("of branch", "number"), _parameter_column(result, quantity, "at")]
    columns += [Column(f"{_place(p)}, order {main:g} 0-peak", _quantity(p)) for p in places]
    rows = [
        [
            str(result.bifurcation_type.values[i]),
            int(result.on_branch[i]),
            float(result.bifurcation_value[i]),
            *(float(abs(p.sel(order=main).isel(point=point))) for p in places),
        ]
        for i, point in enumerate(at)
    ]
    return Table("Where motions change their stability or their kind", columns, rows)


def coexisting_table(result: xr.Dataset, quantity: str) -> Table:
    """Ranges in which the way one came decides which motion is met."""
    columns = [
        Column("from", quantity),
        Column("to", quantity),
        Column("stable motions", "number"),
        Column("on branches"),
    ]
    rows = [
        [low, high, len(here), ", ".join(str(n) for n in sorted(set(here)))] for (low, high), here in coexisting(result)
    ]
    return Table("Several stable motions: which one is met depends on how one came there", columns, rows)


def largest_tables(
    result: xr.Dataset, quantity: str, places: Sequence[xr.DataArray], orders: Sequence[float]
) -> list[Table]:
    """The largest stable amplitudes of the orders and of all together, a table for each kind of place."""
    tables = []
    for kind in dict.fromkeys(_quantity(place) for place in places):
        columns = [
            Column("at"),
            Column("of"),
            Column("largest", kind),
            _parameter_column(result, quantity),
            Column("branch", "number"),
        ]
        chosen = [place for place in places if _quantity(place) == kind]
        rows = [row for place in chosen for row in _largest(result, place, orders)]
        tables.append(Table(f"Largest stable {kind}", columns, rows))
    return tables


def _largest(result: xr.Dataset, place: xr.DataArray, orders: Sequence[float]) -> Iterator[list[object]]:
    kinds = [(f"order {n:g}, 0-peak", np.abs(place.sel(order=n).values)) for n in orders]
    kinds.append(("all orders, half peak-to-peak", swing(place).values))
    for name, size in kinds:
        kept = np.where(result.stable.values, size, -np.inf)
        at = int(kept.argmax())
        if not np.isfinite(kept[at]):
            yield [_place(place), name, None, None, None]
        elif kept[at] <= 1e-9 * float(abs(place).max()):
            yield [_place(place), name, 0.0, None, None]
        else:
            yield [_place(place), name, float(size[at]), float(result.value[at]), int(result.branch[at])]


def motion_tables(
    motions: xr.Dataset, places: Sequence[xr.DataArray], orders: Sequence[float], laws: Laws, title: str
) -> list[Table]:
    """The motions at one value, a table for each place: orders and swing, and of a spring its mean twist and stages."""
    return [_motions(motions, place, orders, laws, title) for place in places]


def _motions(motions: xr.Dataset, place: xr.DataArray, orders: Sequence[float], laws: Laws, title: str) -> Table:
    name, kind = _place(place), _quantity(place)
    spring = "element" in place.coords
    columns = [Column("motion"), Column("branch", "number"), Column("stable"), Column("|multiplier|", "number")]
    columns += [Column(f"order {n:g} 0-peak", kind) for n in orders] + [Column("half p-p", kind)]
    columns += [Column("mean twist", "relative_angle"), Column("time in")] if spring else []
    half = swing(place).values
    rows: list[list[object]] = []
    for i in range(motions.sizes["point"]):
        row = [letter(i), int(motions.branch[i]), "yes" if bool(motions.stable[i]) else "no"]
        row += [float(np.abs(motions.multiplier.values[i]).max())]
        row += [*(float(abs(place.sel(order=n)[i])) for n in orders), float(half[i])]
        rows.append(row + (_spring(motions.twist.sel(element=name).isel(point=i), laws.get(name)) if spring else []))
    return Table(f"Motions at {title}: {kind} of {name}", columns, rows)


def _spring(twist: xr.DataArray, law: Law | None) -> list[object]:
    """Mean twist, and the share of time in each stage."""
    shares = stage_shares(law, waveform(twist, SHARE_SAMPLES).values)
    told = ", ".join(f"{name} {100 * share:.1f} %" for name, share in shares.items())
    return [float(twist.sel(order=0.0).real), told]


def places_of(result: xr.Dataset, nodes: Sequence[str], elements: Sequence[str]) -> list[xr.DataArray]:
    """Complex orders (point, order) of the torques of connections, then of the accelerations of nodes."""
    torques = [result.torque.sel(element=name) for name in elements]
    return [*torques, *(acceleration(result.angle.sel(node=name)) for name in nodes)]


def _place(orders: xr.DataArray) -> str:
    return str((orders.element if "element" in orders.coords else orders.node).values)


def _quantity(orders: xr.DataArray) -> str:
    return str(orders.attrs["quantity"])
