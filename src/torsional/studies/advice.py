"""What engineers' studies say: a Dataset with its condition and findings, options checked against what there is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, TypeVar

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.errors import ModelError, nearest
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import of_model
from torsional.studies.swept import Along, Curve, swept
from torsional.studies.trucks import Trucks

if TYPE_CHECKING:
    from matplotlib.figure import Figure

T = TypeVar("T")
HALF = "half peak-to-peak"


def advised(data: xr.Dataset, study: str, model: Model, condition: str, findings: Sequence[str]) -> xr.Dataset:
    """The Dataset as the answer of a ``study`` on a ``model``."""
    told = {"analysis": f"study {study}", "condition": condition, "findings": "\n".join(findings)}
    return of_model(data.assign_attrs(told), model)


def over(along: Along, curves: Mapping[str, Curve], model: Model) -> xr.Dataset:
    """Curves over one parameter, for `drawn`."""
    return swept("", along, curves, model)


def drawn(data: xr.Dataset) -> Figure:
    """The picture of curves over one parameter."""
    from torsional.plots.sweeps import plot_sweep

    return plot_sweep(data)


def concept(trucks: Trucks, name: str) -> Model:
    """The truck with one absorber concept, by its name; ModelError for one that is not there."""
    return chosen(trucks.models, name, "absorber")


def chosen(table: Mapping[str, T], name: str, option: str) -> T:
    """What an option names; ModelError with the nearest name for what is not there."""
    key = name.strip().replace("-", "_")
    if key not in table:
        found, known = repr(name), [each.replace("_", "-") for each in table]
        raise ModelError("there is no such choice", where=option, found=found, remedy=nearest(name, known))
    return table[key]


def values_of(given: Sequence[float] | None, derived: ArrayLike, option: str, *, least: int = 2) -> Array:
    """Values of an option, or those derived from the truck, rising; ModelError for ones that are not positive."""
    values = np.unique(np.asarray(derived if given is None else given, dtype=float))
    if values.size < least or values.min() <= 0:
        found, allowed = ", ".join(f"{value:g}" for value in values), f"{least} or more different ones above zero"
        raise ModelError("the values cannot be asked", where=option, found=found or "none", allowed=allowed)
    return values


def positive(value: float | None, derived: float, option: str) -> float:
    """A value of an option, or the one derived from the truck; ModelError for one that is not above zero."""
    found = float(derived if value is None else value)
    if not (np.isfinite(found) and found > 0):
        raise ModelError("a value above zero is wanted", where=option, found=f"{found:g}")
    return found
