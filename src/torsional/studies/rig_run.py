"""A rig measured in time: what encoders and torque sensor tell, with their faults, and what is made of that."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from torsional.arguments import checked, checked_fields
from torsional.errors import ModelError
from torsional.model import Model
from torsional.numerics.arrays import Array
from torsional.quantities.frequency_response import frequency_response
from torsional.results import labelled
from torsional.solvers.transient import TorqueHistory, transient
from torsional.studies.records import Record
from torsional.studies.rig_model import INSTRUMENTS, Instruments
from torsional.system import System, assemble


@dataclass(frozen=True)
@checked_fields
class Encoder:
    """An encoder: ``counts`` of a turn (0: none are counted), ``turn_error`` [rad] of once-per-turn error, 0-peak, at
    the ``phase`` [rad], its ``zero`` [rad] and white ``noise`` [rad].

    >>> Encoder(counts=4).read(np.array([0.1, 1.6, 3.2]), np.random.default_rng(0)).round(3).tolist()
    [0.0, 1.571, 3.142]
    """

    counts: int = 0
    turn_error: float = 0.0
    phase: float = 0.0
    zero: float = 0.0
    noise: float = 0.0

    def read(self, angle: Array, draw: np.random.Generator) -> Array:
        """What it tells of a whole angle [rad]."""
        seen = angle + self.zero + self.turn_error * np.sin(angle + self.phase)
        seen = seen + self.noise * draw.standard_normal(angle.size)
        count = 2.0 * np.pi / self.counts if self.counts else 0.0
        return np.asarray(np.floor(seen / count) * count if count else seen)


@dataclass(frozen=True)
@checked_fields
class RigSensors:
    """The encoders of both fixtures, and ``torque_noise`` [Nm] and ``torque_zero`` [Nm] of the torque sensor."""

    drive: Encoder = Encoder()
    held: Encoder = Encoder()
    torque_noise: float = 0.0
    torque_zero: float = 0.0


EXACT = RigSensors()
"""Sensors without faults."""


@checked
def measured_run(
    rig: Model,
    time: Array,
    torque: Array,
    speed: float,
    sensors: RigSensors = EXACT,
    *,
    mean: float = 0.0,
    seed: int = 0,
    detailed: bool = False,
    step: float = 1e-4,
    instruments: Instruments = INSTRUMENTS,
) -> xr.Dataset:
    """A run of a rig as its channels tell it: ``torque`` [Nm] of the actuator over even ``time`` [s], about a ``mean``.

    The rig turns at a mean ``speed`` [rad/s]; the node that takes up the mean torque is its landmark ``load``.  With
    ``detailed`` the flywheel's inner bodies move.  Channels over ``time``: ``sensor_torque`` [Nm], ``drive_angle`` and
    ``held_angle`` [rad] of the encoders, the mean rotation taken away.
    """
    if time.size != torque.size or time.size < 2:
        raise ModelError("a torque is wanted at each time", where="torque", found=f"{torque.size} for {time.size}")
    system: System = assemble((rig.detailed() if detailed else rig).powertrain())
    drive = TorqueHistory(instruments.actuator, tuple(time.tolist()), tuple((mean + torque).tolist()))
    lasting = float(time[-1] - time[0])
    interval = lasting / (time.size - 1)
    keep = (instruments.drive, instruments.held, instruments.sensor)
    paced = {"step": min(step, interval), "output": interval}
    run = transient(system, drive, lasting, speed=speed, hold=rig.landmarks.load, keep=keep, **paced)  # type: ignore[arg-type]
    draw = np.random.default_rng(seed)
    at = run.time.values
    turned = speed * at
    read = {
        name: encoder.read(turned + run.angle.sel(node=node).values, draw) - turned
        for name, encoder, node in (
            ("drive_angle", sensors.drive, instruments.drive),
            ("held_angle", sensors.held, instruments.held),
        )
    }
    felt = run.torque.sel(element=instruments.sensor).values + sensors.torque_zero
    channels = {"sensor_torque": (("time",), felt + sensors.torque_noise * draw.standard_normal(at.size), "torque")}
    channels |= {name: (("time",), values, "angle") for name, values in read.items()}
    return labelled(channels, {"time": (at, "time")}, analysis="run of a rig", speed=speed, mean_torque=mean, seed=seed)


@checked
def dynamic_stiffness(run: xr.Dataset, segment: float, inertia: float = 0.0) -> xr.Dataset:
    """Dynamic stiffness and loss angle of the flywheel over ``frequency`` [Hz], from the channels of `measured_run`.

    K = H1 of the torque over the encoders' angle, in segments [s]; ``inertia`` [kgm²] between sensor and springs is
    corrected for by the held encoder, K − ω² J H1 of its angle.  ``dynamic_stiffness`` |K| [Nm/rad], ``loss_angle``
    arg K [rad], ``coherence`` and the relative standard ``deviation`` of |K|.
    """
    twist = run.drive_angle.values - run.held_angle.values
    time = run.time.values
    met = frequency_response(time, twist, run.sensor_torque.values, segment)
    held = frequency_response(time, twist, run.held_angle.values, segment)
    stiffness = met.response - (2.0 * np.pi * met.frequency) ** 2 * inertia * held.response
    over = ("frequency",)
    return labelled(
        {
            "dynamic_stiffness": (over, np.abs(stiffness), "stiffness"),
            "loss_angle": (over, np.angle(stiffness), "angle"),
            "coherence": (over, met.coherence, "ratio"),
            "deviation": (over, met.deviation, "ratio"),
        },
        {"frequency": (met.frequency, "frequency")},
        analysis="dynamic stiffness",
        segments=met.segments,
        inertia=inertia,
    )


@checked
def loop_of_run(run: xr.Dataset, name: str, inertia: float = 0.0, settled: float = 0.0) -> Record:
    """The loop of a steady swing from the channels of `measured_run`, what came before ``settled`` [s] left out.

    The torque is corrected for the ``inertia`` [kgm²] between sensor and springs by the acceleration of the held
    encoder's angle, of the orders of the swing that stand out of its noise.
    """
    later = run.sel(time=slice(settled, None))
    time = later.time.values
    angle, held = later.drive_angle.values - later.held_angle.values, later.held_angle.values
    swing = Record(name, float(run.attrs["speed"]), time, angle, later.sensor_torque.values).swing
    orders = np.arange(1, (swing.terms.size - 1) // 2 + 1)
    phase = 2.0 * np.pi * np.outer(time, orders) / swing.period
    waves = np.column_stack([np.ones(time.size), np.cos(phase), np.sin(phase)])
    terms = np.linalg.lstsq(waves, held, rcond=None)[0]
    terms[0] = 0.0
    terms[1:] *= -np.tile((2.0 * np.pi * orders / swing.period) ** 2, 2)
    torque = later.sensor_torque.values + inertia * (waves @ terms)
    return Record(name, float(run.attrs["speed"]), time, angle, torque)
