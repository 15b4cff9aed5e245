"""Units as parts of a run in time: at points of communication motions of nodes go in and torques come out."""

from __future__ import annotations

import contextlib
import io
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple, Self

import numpy as np

from torsional.arguments import checked_fields
from torsional.errors import ModelError
from torsional.exchange.fmu.reading import fmpy, reference, unpacked
from torsional.numerics.arrays import Array
from torsional.solvers.transient.acting import Acting, Source, row_of
from torsional.solvers.transient.profiles import Level
from torsional.solvers.transient.speed_profile import SpeedProfile
from torsional.system import System

Motion = tuple[Array, Array, Array]
"""Angles, speeds and accelerations of the coordinates."""
SENSED = ("angle", "speed", "acceleration")
"""What a unit may be told of nodes."""


class Sensed(NamedTuple):
    """What an input of a unit is told: angle, speed or acceleration along a combination of ``nodes``, whole."""

    quantity: str
    nodes: Mapping[str, float]


@dataclass(frozen=True)
@checked_fields
class FmuPart:
    """A functional mock-up unit in a line: ``inputs`` {variable: `Sensed`}, ``torques`` {variable: {node: share}} and
    ``parameters`` {variable: value}.

    A unit is code of whoever made it: it runs with your rights, and only what you name here is run.

    >>> FmuPart.between("spring.fmu", "a", "b", angle="phi", torque="tau").torques["tau"]
    {'a': 1.0, 'b': -1.0}
    """

    path: str | os.PathLike[str]
    inputs: Mapping[str, Sensed]
    torques: Mapping[str, Mapping[str, float]]
    parameters: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name, sensed in self.inputs.items():
            if sensed.quantity not in SENSED:
                found, allowed = sensed.quantity, ", ".join(SENSED)
                raise ModelError("a unit is not told this", where=name, found=found, allowed=allowed)
        if not self.torques:
            raise ModelError("the unit gives no torque", where=str(self.path), remedy="name an output that is one")

    @classmethod
    def between(
        cls,
        path: str | os.PathLike[str],
        a: str,
        b: str,
        *,
        torque: str,
        angle: str = "",
        speed: str = "",
        acceleration: str = "",
        parameters: Mapping[str, float] | None = None,
    ) -> Self:
        """A unit that sees θ_b − θ_a and gives the torque that a spring between them would: on a, and back on b."""
        told = _told({"angle": angle, "speed": speed, "acceleration": acceleration}, {a: -1.0, b: 1.0})
        return cls(path, told, {torque: {a: 1.0, b: -1.0}}, dict(parameters or {}))

    @classmethod
    def on(
        cls,
        path: str | os.PathLike[str],
        node: str,
        *,
        torque: str,
        angle: str = "",
        speed: str = "",
        acceleration: str = "",
        parameters: Mapping[str, float] | None = None,
    ) -> Self:
        """A unit that sees one node and gives a torque on it."""
        told = _told({"angle": angle, "speed": speed, "acceleration": acceleration}, {node: 1.0})
        return cls(path, told, {torque: {node: 1.0}}, dict(parameters or {}))

    @classmethod
    def absorber(cls, path: str | os.PathLike[str], *sides: str, parameters: Mapping[str, float] | None = None) -> Self:
        """An absorber written by `export_fmu`, on the nodes of its own names, ``sides``."""
        told = {f"{node}.{name}": Sensed(name, {node: 1.0}) for node in sides for name in SENSED}
        return cls(path, told, {f"{node}.torque": {node: 1.0} for node in sides}, dict(parameters or {}))


def _told(names: Mapping[str, str], nodes: Mapping[str, float]) -> dict[str, Sensed]:
    return {variable: Sensed(quantity, nodes) for quantity, variable in names.items() if variable}


@dataclass(frozen=True, eq=False)
class PartTorques:
    """The torques of a part as sources of a run: a level of two knots each, which is told anew at each step."""

    part: FmuPart

    def acting(self, system: System, speed: SpeedProfile) -> Acting:
        """One source a torque."""
        rows = [_row(system, nodes) for nodes in self.part.torques.values()]
        return Acting(tuple(Source(row, level=Level(np.array([0.0, 1.0]), np.zeros(2))) for row in rows))


def _row(system: System, nodes: Mapping[str, float]) -> Array:
    return np.asarray(sum(share * row_of(system, node) for node, share in nodes.items()), dtype=float)


class Running:
    """An instance of a part's unit, on a ``stack`` that ends it."""

    def __init__(self, part: FmuPart, system: System, stack: contextlib.ExitStack) -> None:
        self.path, self._said, self._begun = Path(part.path), io.StringIO(), False
        folder, described = stack.enter_context(unpacked(self.path))
        self._inputs = [reference(described, name, "input", self.path) for name in part.inputs]
        self._torques = [reference(described, name, "output", self.path) for name in part.torques]
        given = {reference(described, name, "parameter", self.path): v for name, v in part.parameters.items()}
        self._sensed = [
            (s.quantity, _row(system, s.nodes), sum(w * _ratio(system, node) for node, w in s.nodes.items()))
            for s in part.inputs.values()
        ]
        self._version = 2 if described.fmiVersion.startswith("2") else 3
        self._unit = self._instance(folder, described, stack)
        with self._doing("does not take its parameters"):
            self._set(list(given), list(given.values()))

    def _instance(self, folder: str, described: Any, stack: contextlib.ExitStack) -> Any:
        module = fmpy(f"fmpy.fmi{self._version}")
        own: dict[str, Any] = {"unzipDirectory": folder, "modelIdentifier": described.coSimulation.modelIdentifier}
        made = module.FMU2Slave if self._version == 2 else module.FMU3Slave
        with self._doing("does not start"):
            unit = made(guid=described.guid, instanceName=described.modelName, **own)
            unit.instantiate()
        stack.callback(self._end)
        return unit

    def _end(self) -> None:
        with contextlib.suppress(Exception), contextlib.redirect_stdout(self._said):
            if self._begun:
                self._unit.terminate()
        self._unit.freeInstance()

    @contextlib.contextmanager
    def _doing(self, failing: str) -> Iterator[None]:
        """Whatever goes wrong within is told in the words of the unit, which FMPy would print."""
        try:
            with contextlib.redirect_stdout(self._said):
                yield
        except Exception as error:
            said = self._said.getvalue().strip().splitlines() or [str(error) or type(error).__name__]
            found = said[-1].removeprefix("[ERROR] ")[:200]
            raise ModelError(f"the unit {failing}", file=str(self.path), found=found) from None

    def _set(self, numbers: Sequence[int], values: Sequence[float]) -> None:
        if numbers:
            (self._unit.setReal if self._version == 2 else self._unit.setFloat64)(list(numbers), list(values))

    def begin(self, time: float, motion: Motion, frame: tuple[float, float]) -> Array:
        """Initialised at a motion; the torques there."""
        with self._doing("cannot be initialised"):
            if self._version == 2:
                self._unit.setupExperiment(startTime=time)
                self._unit.enterInitializationMode()
            else:
                self._unit.enterInitializationMode(startTime=time)
            self._tell(motion, frame)
            self._unit.exitInitializationMode()
            self._begun = True
            return self._torque()

    def step(self, time: float, length: float, motion: Motion, frame: tuple[float, float]) -> Array:
        """The torques after a step from a motion on."""
        with self._doing(f"gives up at {time:.6g} s"):
            self._tell(motion, frame)
            self._unit.doStep(time, length)
            return self._torque()

    def _tell(self, motion: Motion, frame: tuple[float, float]) -> None:
        turned = (frame[0], frame[1], 0.0)
        places = [(SENSED.index(quantity), row, ratio) for quantity, row, ratio in self._sensed]
        self._set(self._inputs, [float(row @ motion[i]) + ratio * turned[i] for i, row, ratio in places])

    def _torque(self) -> Array:
        get = self._unit.getReal if self._version == 2 else self._unit.getFloat64
        return np.array(get(self._torques), dtype=float)


def _ratio(system: System, node: str) -> float:
    return float(system.speed_ratio[system.node_index(node)])
