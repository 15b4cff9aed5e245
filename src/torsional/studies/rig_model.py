"""A rig with a flywheel on it: any truck's absorber mounted, and up to which frequency its sensors tell the torque.

Between the torque sensor and the springs turn the fixture and the secondary flywheel, and both sides of the rig have
resonances of their own: what is measured there is the flywheel's torque at low frequencies alone.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from torsional.absorbers import Absorber
from torsional.arguments import checked
from torsional.components import Inertia
from torsional.engine import Excitation
from torsional.errors import ModelError, nearest
from torsional.files.edit import changed
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.results import labelled
from torsional.solvers.harmonic import harmonic_response
from torsional.solvers.operating import at_operating_point


class Instruments(NamedTuple):
    """A rig's own names: the node that is driven, the fixtures that carry encoders, and the torque sensor."""

    actuator: str = "actuator"
    drive: str = "drive_fixture"
    held: str = "held_fixture"
    sensor: str = "torque_sensor"


INSTRUMENTS = Instruments()
FREQUENCIES = np.geomspace(1.0, 400.0, 400)


@checked
def mounted_on_rig(rig: Model, truck: Model) -> Model:
    """The ``rig`` with the absorber of a ``truck`` in the place of its own.

    Where a file describes the truck's absorber and its ends are named as the rig's, the copy is described by a file
    too, so that values can be changed and looked for by key paths.  Raises ModelError where one of both has none.

    >>> from torsional.files import load_model
    >>> rig, truck = load_model("examples/rig_dmf.yaml"), load_model("examples/truck_dmf.yaml")
    >>> mounted_on_rig(rig, truck).components["dmf"].law.stiffness
    13000.0
    """
    for model in (rig, truck):
        if model.absorber is None:
            raise ModelError("there is no absorber to be mounted", where=model.name)
    assert rig.absorber is not None and truck.absorber is not None
    same = (rig.absorber.input, rig.absorber.output) == (truck.absorber.input, truck.absorber.output)
    if same and rig.document and "absorber" in truck.document:
        return changed(rig, {"absorber": truck.document["absorber"]})
    return _joined(rig, rig.absorber, truck.absorber)


def _joined(rig: Model, old: Absorber, new: Absorber) -> Model:
    """The rig's own parts at the ends of another absorber."""
    ends = {old.input: new.input, old.output: new.output}
    own = {name: _renamed(part, ends) for name, part in rig.components.items() if name not in old.components}
    marks = dataclasses.replace(rig.landmarks, crankshaft=new.input, springs=new.springs)
    return rig.replaced(components={**new.components, **own}, landmarks=marks, absorber=new)


def _renamed(part: Any, nodes: Mapping[str, str]) -> Any:
    """A component at nodes of other names."""
    named = {field.name: getattr(part, field.name) for field in dataclasses.fields(part)}
    ends = {key: nodes[value] for key, value in named.items() if isinstance(value, str) and value in nodes}
    return dataclasses.replace(part, **ends)


@checked
def held_inertia(rig: Model, instruments: Instruments = INSTRUMENTS) -> float:
    """Inertia [kgm²] between a rig's torque sensor and the springs: the fixture and the flywheel on its side."""
    assert rig.absorber is not None
    bodies = {instruments.held, rig.absorber.output}
    parts = [part for name, part in rig.components.items() if name in bodies and isinstance(part, Inertia)]
    return float(sum(part.inertia for part in parts))


@checked
def sensor_reach(
    rig: Model,
    within: float = 0.05,
    torque: float = 0.0,
    frequency: ArrayLike = FREQUENCIES,
    instruments: Instruments = INSTRUMENTS,
) -> xr.Dataset:
    """How the sensors of a rig tell the torque and the twist of its flywheel, over the ``frequency`` [Hz] of a swing.

    At the tangents under a mean ``torque`` [Nm], driven at the actuator.  Over ``frequency`` and complex: ``sensed``,
    the sensor's torque over that on the secondary flywheel; ``corrected``, the same with J θ̈ of what turns between,
    taken from the encoder's angle, added; ``twist_told``, the encoders' angle over the flywheel's twist.  ``reach``
    [Hz] over ``told`` is the frequency up to which each is right ``within`` a share, no number where it is not at the
    lowest one.  Raises ModelError for names that the rig does not have.

        T_secondary = T_clamp + J₂ θ̈₂,   corrected: T_sensor + (J_fixture + J₂) θ̈_fixture
    """
    assert rig.absorber is not None
    at = np.unique(np.asarray(frequency, dtype=float))
    if not 0 < within < 1 or at.size < 2 or at[0] <= 0:
        raise ModelError("a share below 1 and positive frequencies are wanted", where="within", found=f"{within:g}")
    _refuse_unknown(rig, instruments)
    system, _ = at_operating_point(rig, torque)
    omega = 2.0 * np.pi * at
    found = harmonic_response(system, Excitation.unit(instruments.actuator, [1.0], omega.tolist()))
    angle, element = found.angle.isel(order=0), found.torque.isel(order=0)
    first, last = (angle.sel(node=name).values for name in (rig.absorber.input, rig.absorber.output))
    drive, held = (angle.sel(node=name).values for name in (instruments.drive, instruments.held))
    told = element.sel(element=instruments.sensor).values
    own = _on_output(rig, angle, element, omega)
    acceleration = -(omega**2) * held
    ratios = {
        "sensed": told / own,
        "corrected": (told + held_inertia(rig, instruments) * acceleration) / own,
        "twist_told": (drive - held) / (first - last),
    }
    reach = [_reach(at, ratio, within) for ratio in ratios.values()]
    values = {name: (("frequency",), ratio, "ratio") for name, ratio in ratios.items()}
    return labelled(
        {**values, "reach": (("told",), reach, "frequency")},
        {"frequency": (at, "frequency"), "told": (np.array(list(ratios)), "")},
        analysis="reach of a rig's sensors",
        within=within,
        model=rig.name,
    )


def _on_output(rig: Model, angle: xr.DataArray, torque: xr.DataArray, omega: Array) -> Array:
    """The torque that the absorber puts on its output: what leaves it to the rig, and what accelerates its body."""
    assert rig.absorber is not None
    output = rig.absorber.output
    inner = set(rig.absorber.components)
    found = np.zeros(omega.size, dtype=complex)
    for name, part in rig.components.items():
        if name not in inner and name in torque.element.values:
            weight = next(iter(part.stamps(name))).weights.get(output, 0.0)
            found += weight * torque.sel(element=name).values
    body = rig.components.get(output)
    inertia = body.inertia if isinstance(body, Inertia) else 0.0
    return np.asarray(found - inertia * omega**2 * angle.sel(node=output).values)


def _reach(frequency: Array, ratio: Array, within: float) -> float:
    """The highest frequency up to which a ratio is one within a share; none where it is not at the first."""
    off = np.flatnonzero(np.abs(ratio - 1.0) > within)
    if off.size == 0:
        return float(frequency[-1])
    return float(frequency[off[0] - 1]) if off[0] else np.nan


def _refuse_unknown(rig: Model, instruments: Instruments) -> None:
    for name, known in (
        *((node, rig.powertrain().nodes) for node in instruments[:3]),
        (instruments.sensor, tuple(rig.components)),
    ):
        if name not in known:
            raise ModelError("the rig has no such part", where="instruments", found=name, remedy=nearest(name, known))
