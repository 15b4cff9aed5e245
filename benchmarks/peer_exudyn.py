"""Exudyn at DMF-LCP-1, in an environment of its own: generalised-α at a fixed step, its own compiled objects.

One-sided springs and the torque are symbolic functions, which Exudyn evaluates without Python; its built-in limit stops
are as quick, but let go of a spring by the gap alone, which is another law.

Run: .venv-bench-exudyn/bin/python benchmarks/peer_exudyn.py ; prints what it found and its CPU times as JSON.
"""

from __future__ import annotations

import os

os.environ |= {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}

import json
import sys
import time
import warnings
from importlib.metadata import version
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent))
warnings.simplefilter("ignore")

import exudyn as exu  # noqa: E402
from exudyn.advancedUtilities import CreateSymbolicUserFunction  # noqa: E402
from exudyn.itemInterface import (  # noqa: E402
    LoadCoordinate,
    MarkerNodeCoordinate,
    Node1D,
    ObjectConnectorCoordinateSpringDamper,
    ObjectMass1D,
    SensorNode,
)
from tests.validation import dmf_lcp  # noqa: E402

ROUNDS = 5
KEPT: list = []  # expression trees must live as long as the models that use them


def force(mbs, t, itemNumber, displacement, velocity, stiffness, damping, offset):
    """A spring that only pushes; the arguments are named as Exudyn names them."""
    return exu.symbolic.min(0.0, stiffness * (displacement - offset) + damping * velocity)


def torque(mbs, t, load):
    """Torque on the primary; what a symbolic function holds are numbers."""
    low, high, span, mean = dmf_lcp.RUN_UP.drive
    return mean + dmf_lcp.SWING * exu.symbolic.sin(dmf_lcp.ORDER * (low * t + (high - low) / (2 * span) * t * t))


def model():
    """The flywheel as masses on one coordinate each, and the sensors of what is compared."""
    container = exu.SystemContainer()
    mbs = container.AddSystem()
    KEPT.append(container)
    nodes = [mbs.AddNode(Node1D(referenceCoordinates=[0.0])) for _ in dmf_lcp.INERTIA]
    for node, inertia in zip(nodes, dmf_lcp.INERTIA, strict=True):
        mbs.AddObject(ObjectMass1D(mass=float(inertia), nodeNumber=node))
    markers = [mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0)) for node in nodes]
    spring = ObjectConnectorCoordinateSpringDamper
    for a, b, k, c in dmf_lcp.LINEAR:
        mbs.AddObject(spring(markerNumbers=[markers[b], markers[a]], stiffness=k, damping=c))
    push = symbolic(mbs, force, "springForceUserFunction", "ObjectConnectorCoordinateSpringDamper")
    for a, b, gap, k in zip(dmf_lcp.PLUS, dmf_lcp.MINUS, dmf_lcp.GAP, dmf_lcp.SPRING_STIFFNESS, strict=True):
        laws = {"stiffness": float(k), "damping": float(k * dmf_lcp.CONTACT_TIME), "offset": -float(gap)}
        mbs.AddObject(spring(markerNumbers=[markers[b], markers[a]], springForceUserFunction=push, **laws))
    drive = symbolic(mbs, torque, "loadUserFunction", "LoadCoordinate")
    mbs.AddLoad(LoadCoordinate(markerNumber=markers[dmf_lcp.PRIMARY], loadUserFunction=drive))
    mbs.AddLoad(LoadCoordinate(markerNumber=markers[dmf_lcp.VEHICLE], load=-dmf_lcp.MEAN))
    kind = exu.OutputVariableType.Coordinates
    seen = (dmf_lcp.PRIMARY, dmf_lcp.SECONDARY)
    sensors = [
        mbs.AddSensor(SensorNode(nodeNumber=nodes[n], storeInternal=True, outputVariableType=kind)) for n in seen
    ]
    mbs.Assemble()
    return mbs, sensors


def symbolic(mbs, function, name: str, kind: str):
    """A Python function as an expression that Exudyn evaluates by itself."""
    made = CreateSymbolicUserFunction(mbs, function, name, itemTypeName=kind)
    KEPT.append(made)
    return made


def settings(step: float, span: float, sampling: float):
    """Fixed steps, the modified Newton method that is Exudyn's default; less than that many digits it does not need."""
    made = exu.SimulationSettings()
    integration = made.timeIntegration
    integration.numberOfSteps, integration.endTime = round(span / step), span
    integration.automaticStepSize = integration.adaptiveStep = False
    integration.newton.relativeTolerance = 1e-6
    made.solutionSettings.writeSolutionToFile = False
    made.solutionSettings.sensorsWritePeriod = sampling
    return made


def run(step: float, span: float, sampling: float) -> tuple[float, np.ndarray]:
    """CPU time [s] of a run of a fresh model, and θ0 − θ1 [rad] at the samples."""
    mbs, sensors = model()
    chosen = settings(step, span, sampling)
    start = time.process_time()
    mbs.SolveDynamic(chosen, solverType=exu.DynamicSolverType.GeneralizedAlpha)
    seconds = time.process_time() - start
    primary, secondary = (mbs.GetSensorStoredData(sensor)[:, 1] for sensor in sensors)
    return seconds, primary - secondary


def main() -> None:
    """One round warms up, the others are timed."""
    step, span, sampling = (float(text) for text in sys.argv[1:])
    rounds = [run(step, span, sampling) for _ in range(ROUNDS + 1)][1:]
    seconds = float(np.median([each for each, _ in rounds]))
    print(json.dumps({"version": version("exudyn"), "seconds": seconds, "twist": rounds[-1][1].tolist()}))


if __name__ == "__main__":
    main()
