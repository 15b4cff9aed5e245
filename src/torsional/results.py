"""Results: xarray Datasets with named dimensions, units and provenance; saved as netCDF or CSV, and loaded again."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from torsional.arguments import checked
from torsional.errors import ModelError, nearest
from torsional.model import Model
from torsional.spreadsheet import BYTE_ORDER_MARK, csv_text
from torsional.units import QUANTITIES

Variable = tuple[tuple[str, ...], Any, str]
"""Dimensions, values, and the quantity's name in the nomenclature."""

SCHEMA = 1
COMPLEX = "real_imaginary"
ANY = "*"
"""The quantity of what may be of any."""


class Named(NamedTuple):
    """What a variable or coordinate by some name is: its quantity's name in the nomenclature ("" if none), in words."""

    quantity: str
    meaning: str


NAMES: dict[str, Named] = {
    "gear": Named("", "gears by name"),
    "node": Named("", "nodes by name"),
    "element": Named("", "connections by name: springs, shafts, dampers, friction"),
    "mass": Named("", "inertias by name"),
    "mode": Named("", "modes, rigid rotations first"),
    "order": Named("engine_order", "orders of the engine's revolution; 0 is the mean"),
    "speed": Named("speed", "mean speed of the engine"),
    "time": Named("time", "time"),
    "crank_angle": Named("crank_angle", "angle that the engine has turned by at its mean speed"),
    "speed_ratio": Named("gear_ratio", "mean speed of a node over the engine's"),
    "value": Named(ANY, "whatever is continued or varied"),
    "mean_torque": Named("torque", "mean torque of the engine; of a map, its axis"),
    "engine_torque": Named("torque", "orders of the torque of all cylinders together"),
    "angle": Named("angle", "angles of nodes"),
    "angular_velocity": Named("angular_velocity", "speeds of nodes, the mean included"),
    "acceleration": Named("acceleration", "accelerations of nodes"),
    "twist": Named("relative_angle", "relative angles of connections"),
    "mean_twist": Named("relative_angle", "relative angles of connections under the mean torque alone"),
    "torque": Named("torque", "torques of connections, their dampers' share included"),
    "normal_load": Named("force", "what presses connections that rub"),
    "memory": Named("relative_angle", "what friction with memory remembers, an angle that slides along"),
    "irregularity": Named("irregularity", "cyclic irregularity of nodes"),
    "acceleration_swing": Named("acceleration", "half the peak-to-peak of all orders together"),
    "acceleration_bound": Named("acceleration", "the sum of all orders' amplitudes"),
    "torque_swing": Named("torque", "half the peak-to-peak of all orders together"),
    "torque_bound": Named("torque", "the sum of all orders' amplitudes"),
    "status": Named("", "0 where an order was solved; of a motion in time, what it settled on"),
    "unsolved": Named("", "whether some order was not solved"),
    "within_full_load": Named("", "whether the engine reaches the torque at the speed"),
    "frequency": Named("frequency", "natural frequencies"),
    "damping_ratio": Named("damping_ratio", "damping of modes, by energies or of the damped mode"),
    "eigenvalue": Named("eigenvalue", "of damped modes"),
    "shape": Named("mode_shape", "mode shapes, largest angle one"),
    "elastic_share": Named("energy_share", "share of connections in a mode's elastic energy"),
    "kinetic_share": Named("energy_share", "share of inertias in a mode's kinetic energy"),
    "crossing": Named("speed", "speed at which an order meets a mode"),
    "order_speed": Named("speed", "speed at which the main order meets a mode"),
    "name": Named("", "of a mode, by where its elastic energy is"),
    "damped_frequency": Named("frequency", "of the damped mode like it"),
    "damped_ratio": Named("damping_ratio", "of the damped mode like it"),
    "point": Named("", "points of all branches, one branch after the other"),
    "branch": Named("", "number of the branch a point is on"),
    "direction": Named("", "whether a sweep in time goes up or down"),
    "periods": Named("", "periods of the drive after which a motion repeats itself, 0 if never"),
    "exponent": Named("", "largest Lyapunov exponent, in one over the period"),
    "method_share": Named("", "energy that time steps made or lost of their own, over all that passed through"),
    "notes": Named("", "what else is to be said of a motion in time: guarded contacts, halved steps"),
    "residual": Named("", "what is left of the scaled equations"),
    "iterations": Named("", "corrections a point took"),
    "event": Named("", "what a point is: fold, period doubling, an end on another branch; of a run, what was done"),
    "multiplier": Named("", "Floquet multipliers over the branch's period"),
    "stable": Named("", "whether all multipliers lie within the unit circle"),
    "confirmed": Named("", "whether determinants agree with the verdict on stability"),
    "kind": Named("", "of a branch or a motion, in words"),
    "base_order": Named("engine_order", "lowest order of a branch"),
    "parent": Named("", "branch that a branch left"),
    "started": Named("", "why a branch begins"),
    "ended": Named("", "why a branch ends"),
    "bifurcation_type": Named("", "fold, period doubling, branch point, Neimark–Sacker"),
    "bifurcation_speed": Named("speed", "where it is"),
    "bifurcation_mean_torque": Named("torque", "where it is"),
    "bifurcation_value": Named(ANY, "where it is"),
    "on_branch": Named("", "number of its branch"),
    "amplitude": Named("torque", "largest stable sub-harmonic torque of a connection, 0-peak"),
    "twist_amplitude": Named("relative_angle", "largest stable sub-harmonic twist of a connection, 0-peak"),
    "solutions": Named("", "how many motions there are"),
    "stable_solutions": Named("", "how many of them are stable"),
    "boundary_speed": Named("speed", "where a boundary passes"),
    "boundary_mean_torque": Named("torque", "where a boundary passes"),
    "boundary_value": Named(ANY, "where a boundary passes"),
    "boundary_kind": Named("", "period doubling of the main branch or fold of a doubled one"),
    "boundary_curve": Named("", "number of the boundary"),
    "sweep": Named("relative_angle", "half swings of slow sweeps"),
    "cycle": Named("", "first or closed"),
    "rubs": Named("", "which connections rub"),
    "drive_torque": Named("torque", "torque at the turned node"),
    "drive_angle": Named("relative_angle", "its angle against the held one"),
    "loss": Named("energy", "area of the closed loop"),
    "stiffness": Named("stiffness", "of the chord between the loop's ends"),
    "harmonic_stiffness": Named("stiffness", "of the loop's first harmonic"),
    "loss_factor": Named("loss_factor", "loss over the energy of the chord"),
    "element_loss": Named("energy", "loss of connections in the closed loop"),
    "slides": Named("number", "which connections slide"),
    "sliding": Named("number", "how many connections slide"),
    "cycles": Named("number", "how many cycles were run"),
    "closure": Named("ratio", "by what the last two cycles differ, over the largest torque"),
    "share": Named("", "where energy is or went"),
    "energy": Named("energy", "stored, supplied and lost, by share"),
    "friction_loss": Named("energy", "what each part that rubs has lost"),
    "friction": Named("", "connections with a memory, by name"),
    "loaded": Named("", "connections that are pressed, by name"),
    "rubbing": Named("", "connections that rub, by name"),
    "rate": Named("angular_velocity", "at which a twist passes an end of a stage"),
    "stage": Named("", "that a spring comes into"),
    "end_angle": Named("angle", "last angles, from which a run goes on"),
    "end_speed": Named("angular_velocity", "last speeds, from which a run goes on"),
    "end_memory": Named("relative_angle", "last memories, from which a run goes on"),
    "end_integral": Named("", "last integrals of governors, from which a run goes on"),
    "end_charge": Named("", "last charges of cylinders less one, from which a run goes on"),
    "end_standing": Named("", "all that a march stands on, from which a run goes on to the last bit"),
    "torque_lowest": Named("torque", "extreme of a run"),
    "torque_highest": Named("torque", "extreme of a run"),
    "peak_time": Named("time", "when the torque was largest"),
    "twist_lowest": Named("relative_angle", "extreme of a run"),
    "twist_highest": Named("relative_angle", "extreme of a run"),
    "stop_below": Named("relative_angle", "stop for negative torque"),
    "stop_above": Named("relative_angle", "stop for positive torque"),
    "stop_contacts": Named("", "how often stops were met"),
    "schedule": Named(ANY, "what was done, by event"),
    "phase": Named("", "what happened one after the other"),
    "phase_begin": Named("time", "when a phase began"),
    "phase_end": Named("time", "when a phase ended"),
    "phase_speed": Named("angular_velocity", "of nodes, at the end of a phase"),
}
"""Every variable and coordinate of results: one name for one thing, in all analyses."""


def dataset(
    variables: Mapping[str, Variable],
    coordinates: Mapping[str, tuple[Any, str] | tuple[Any, str, str]],
    means: Mapping[str, str] = MappingProxyType({}),
    /,
    *,
    analysis: str,
    **provenance: object,
) -> xr.Dataset:
    """The result of an analysis: a `labelled` Dataset with names that mean the same in every analysis, see ``NAMES``.

    ``means``: {name: meaning} of variables and coordinates that no other analysis has.  Raises ModelError for a name
    that is in neither, and for a quantity that the name does not stand for.

    >>> ds = dataset({"torque": (("speed",), [1.0], "torque")}, {"speed": ([100.0], "speed")}, analysis="example")
    >>> ds.torque.attrs["units"], ds.speed.attrs["units"]
    ('Nm', 'rad/s')
    """
    told = [(name, quantity) for name, (_, _, quantity) in variables.items()]
    for name, given in coordinates.items():
        if not isinstance(given[1], str):
            remedy = "dimensions stand before the values of a variable, not of a coordinate"
            raise ModelError("a coordinate is (values, quantity)", where=name, found=repr(given)[:60], remedy=remedy)
    for name, quantity in [*told, *((name, given[1]) for name, given in coordinates.items())]:
        if name not in means:
            _known(name, quantity)
    return labelled(variables, coordinates, analysis=analysis, **provenance)


def _known(name: str, quantity: str) -> None:
    if name not in NAMES:
        remedy = nearest(name, NAMES, listed=False) or "tell its meaning as a third argument, {name: meaning}"
        raise ModelError("results have no such name", where=name, remedy=remedy)
    meant = NAMES[name].quantity
    if meant not in (quantity, ANY):
        raise ModelError("the name stands for another quantity", where=name, found=quantity or "none", allowed=meant)


def labelled(
    variables: Mapping[str, Variable],
    coordinates: Mapping[str, tuple[Any, str] | tuple[Any, str, str]],
    *,
    analysis: str,
    **provenance: object,
) -> xr.Dataset:
    """A Dataset by any names, whose every variable carries its unit and long name from the nomenclature.

    ``variables``: {name: (dimensions, values, quantity)}; ``coordinates``: {dimension: (values, quantity or "")}, with
    the dimension as a third entry where the coordinate only labels it;
    ``provenance`` is kept in the attributes (model, hash, settings) beside the analysis and the version.
    """
    from torsional import __version__

    data = {name: xr.Variable(dims, np.asarray(v), _described(q)) for name, (dims, v, q) in variables.items()}
    coords = {name: _coordinate(name, *given) for name, given in coordinates.items()}
    told = {key: v if isinstance(v, str | int | float) else json.dumps(v) for key, v in provenance.items()}
    return xr.Dataset(data, coords, {"analysis": analysis, "torsional_version": __version__, "schema": SCHEMA, **told})


def of_model(data: xr.Dataset, model: Model, gear: str | None = None) -> xr.Dataset:
    """The result with the model it is of in its attributes, and the ``gear`` where it is of one alone."""
    return data.assign_attrs(model=model.name, model_hash=model.hash, **({} if gear is None else {"gear": gear}))


def _coordinate(name: str, values: Any, quantity: str, dimension: str = "") -> xr.Variable:
    return xr.Variable((dimension or name,), np.asarray(values), _described(quantity))


def _described(quantity: str) -> dict[str, str]:
    if not quantity:
        return {}
    entry = QUANTITIES[quantity]
    return {"units": entry.unit, "long_name": entry.long_name, "quantity": quantity}


@checked
def save_results(result: xr.Dataset | xr.DataArray, path: str | Path) -> Path:
    """Write a result, or one quantity of it, whole as netCDF 4 (.nc) or as a table for spreadsheets (.csv).

    In netCDF complex values become a last dimension of real and imaginary part; `load_results` reads it back.  A table
    has a row for each place in the grid, a column for each variable and node or connection, and units in its headings:
    SI, speeds in rpm as well.  Its rows are those of the first variable; what lies over other dimensions is left out.

    The file appears whole or not at all: it is written beside its place and then moved there.  Raises ModelError for
    any other ending.

    >>> import tempfile
    >>> made = dataset({"mean_torque": (("speed",), [1e3], "torque")}, {"speed": ([90.0], "speed")}, analysis="example")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     save_results(made, f"{folder}/map.csv").read_text(encoding="utf-8-sig").splitlines()[-1]
    '90.0,859.4366926962349,1000.0'
    """
    target = Path(path)
    if target.suffix.lower() not in _WRITERS:
        told = {"found": repr(str(target)), "allowed": "a name ending in .nc, or in .csv for spreadsheets"}
        raise ModelError("results are saved as netCDF or CSV", where="path", **told)
    data = result.to_dataset(name=result.name or "value") if isinstance(result, xr.DataArray) else result
    partial = target.with_name(f".{target.name}.partial")
    try:
        _WRITERS[target.suffix.lower()](data, partial)
        partial.replace(target)
    finally:
        partial.unlink(missing_ok=True)
    return target


def _write_netcdf(data: xr.Dataset, target: Path) -> None:
    parts = {name: _split(v) if np.iscomplexobj(v) else v.variable for name, v in data.data_vars.items()}
    xr.Dataset(parts, data.coords, data.attrs).to_netcdf(target, engine="h5netcdf")


def _write_table(data: xr.Dataset, target: Path) -> None:
    target.write_text(BYTE_ORDER_MARK + csv_text(data), encoding="utf-8", newline="")


_WRITERS = {".nc": _write_netcdf, ".nc4": _write_netcdf, ".csv": _write_table}


def _split(values: xr.DataArray) -> xr.Variable:
    pair = np.stack([values.values.real, values.values.imag], axis=-1)
    return xr.Variable((*values.dims, COMPLEX), pair, {**values.attrs, "complex": "yes"})


@checked
def load_results(path: str | Path) -> xr.Dataset:
    """Read what `save_results` wrote, complex values joined again; raises ModelError for anything else.

    >>> import tempfile
    >>> made = dataset({"mean_torque": (("speed",), [1e3], "torque")}, {"speed": ([90.0], "speed")}, analysis="example")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     load_results(save_results(made, f"{folder}/map.nc")).mean_torque.values.tolist()
    [1000.0]
    """
    try:
        with xr.open_dataset(path, engine="h5netcdf") as opened:
            found = opened.load()
    except (OSError, ValueError, KeyError, RuntimeError) as error:
        raise ModelError("this is not a result file", file=str(path), remedy=str(error)[:120]) from None
    if found.attrs.get("schema") != SCHEMA:
        told = str(found.attrs.get("schema"))
        raise ModelError("the result file has another schema", file=str(path), found=told, allowed=f"schema {SCHEMA}")
    return found.assign({name: _joined(v) for name, v in found.data_vars.items() if COMPLEX in v.dims})


def _joined(values: xr.DataArray) -> xr.Variable:
    attrs = {key: value for key, value in values.attrs.items() if key != "complex"}
    return xr.Variable(values.dims[:-1], values.values[..., 0] + 1j * values.values[..., 1], attrs)
