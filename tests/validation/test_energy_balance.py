"""Work and loss over a cycle: what the engine puts in is what dampers turn into heat, on every shipped example.

Powers come from angles and torques of the response and the data of the dampers, ½ Re(T conj(iωθ)), ½ω²c|φ|² and
½ωηk|φ|², not from any matrix.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from tests.shipped import MODEL_FILES

import torsional as tv
from torsional.files.load import model_from_document
from torsional.solvers.run_up import run_up_response

ORDERS = np.arange(0.5, 12.5, 0.5)
CASES = [(path, share, end) for path in MODEL_FILES for share, end in ((0.2, 0), (1.0, -1))]


@cache
def model(path: Path) -> tv.Model:
    return tv.load_model(path)


def at_operating_point(path: Path, share: float, gear: str) -> tuple[tv.System, tv.Excitation]:
    """The linear system under a share of the full torque, and what excites it: the engine, else random torques."""
    machine = model(path)
    speeds = machine.speeds(9)
    if machine.engine is None:
        system = tv.at_operating_point(machine, 0.0)[0]
        torque = np.random.default_rng(1).normal(size=(2, 9, 3, len(ORDERS)))
        return system, tv.Excitation(system.nodes[2:5], ORDERS, speeds, torque[0] + 1j * torque[1])
    mean = share * float(machine.torques(2)[-1])
    system, _ = tv.at_operating_point(machine, mean, gear)
    return system, machine.engine.excitation(machine.landmarks.throws, speeds, mean, ORDERS)


def power(torque: np.ndarray, angle: np.ndarray, omega: np.ndarray) -> np.ndarray:
    """Mean power [W] of complex 0-peak torque and angle."""
    return np.asarray(0.5 * (torque * np.conj(1j * omega * angle)).real)


def twists(path: Path, gear: str, angle: xr.DataArray) -> dict[str, tuple[tv.Connection, np.ndarray]]:
    """Relative angle of every connection from the angles of its nodes."""
    stamps = [stamp for stamp in model(path).powertrain(gear).stamps if isinstance(stamp, tv.Connection)]
    still = np.zeros(angle.shape[:2], complex)
    by_node = {**{str(node): angle.sel(node=node).values for node in angle.node.values}, "ground": still}
    return {c.name: (c, sum((w * by_node[n] for n, w in c.weights.items()), still)) for c in stamps}


@pytest.mark.parametrize(("path", "share", "end"), CASES, ids=lambda v: getattr(v, "stem", str(v)))
def test_engine_work_is_damper_heat(path: Path, share: float, end: int) -> None:
    """Order by order, in the first and the last gear: each order's work alone, since orders are orthogonal."""
    gear = model(path).gear_names[end]
    system, excitation = at_operating_point(path, share, gear)
    found = tv.harmonic_response(system, excitation)
    omega = excitation.speed[:, None] * ORDERS
    worked, apparent = np.zeros(omega.shape), np.zeros(omega.shape)
    for number, node in enumerate(excitation.nodes):
        angle, torque = found.angle.sel(node=node).values, excitation.torque[:, number]
        worked += power(torque, angle, omega)
        apparent += 0.5 * np.abs(torque) * omega * np.abs(angle)
    tangent = dict(zip(system.connections.names, system.connections.stiffness, strict=True))
    heat = np.zeros(omega.shape)
    for name, (part, twist) in twists(path, gear, found.angle).items():
        own = 0.5 * np.abs(twist) ** 2 * (omega**2 * part.damping + omega * tangent[name] * part.loss_factor)
        taken = power(found.torque.sel(element=name).values, twist, omega)
        assert (np.abs(taken - own) <= 1e-12 * (np.abs(taken) + apparent)).all()  # the torque holds the damper's share
        heat += own
    if heat.any():
        assert (np.abs(worked / heat - 1) < 1e-9).all()
    assert (np.abs(worked - heat) < 1e-12 * apparent).all()


TRUCKS = [path for path in MODEL_FILES if path.stem.startswith(("truck", "passenger"))]
BEHIND = ("clutch_hub", "gearbox", "propeller_shaft", "half_shafts", "tyres")


@pytest.mark.parametrize("path", TRUCKS, ids=lambda path: path.stem)
def test_power_through_the_clutch_is_lost_behind_it(path: Path) -> None:
    """The clutch gives off to its disc what hub, gearbox, shafts and tyres turn into heat, whatever the absorber."""
    gear = model(path).gear_names[len(model(path).gear_names) // 2]
    system, excitation = at_operating_point(path, 0.7, gear)
    found = tv.harmonic_response(system, excitation)
    omega = excitation.speed[:, None] * ORDERS
    given = power(found.torque.sel(element="clutch").values, found.angle.sel(node="clutch_disc").values, omega)
    parts = twists(path, gear, found.angle)
    lost = sum(0.5 * omega**2 * parts[name][0].damping * np.abs(parts[name][1]) ** 2 for name in BEHIND)
    scale = 0.5 * np.abs(found.torque.sel(element="clutch").values * omega * found.angle.sel(node="clutch_disc").values)
    assert (lost > 0).all()
    assert (np.abs(given - lost) < 1e-9 * lost + 1e-13 * scale).all()


@pytest.mark.parametrize("path", TRUCKS, ids=lambda path: path.stem)
@pytest.mark.parametrize("mean", [-100.0, 60.0, 300.0])
def test_mean_torque_is_carried_to_the_wheels(path: Path, mean: float) -> None:
    """Clutch: the engine's torque; tyres: times both ratios; a power split: share r; signs of driving."""
    machine = model(path)
    torque = mean * float(machine.torques(2)[-1]) / 400
    for gear in (machine.gear_names[0], machine.top_gear):
        _, point = tv.at_operating_point(machine, torque, gear)
        carried = dict(zip(point.names, point.torque, strict=True))
        final = machine.components["final_drive"].ratio  # type: ignore[attr-defined]
        assert carried["clutch"] == pytest.approx(torque, rel=1e-11)
        assert carried["crank1"] == pytest.approx(torque / len(machine.landmarks.throws), rel=1e-10)
        assert carried["propeller_shaft"] == pytest.approx(torque * machine.gears[gear].ratio, rel=1e-10)
        assert carried["tyres"] == pytest.approx(torque * machine.gears[gear].ratio * final, rel=1e-10)
        for name in machine.landmarks.springs:
            share = machine.components["power_split"].ratio if "power_split" in machine.components else 1.0  # type: ignore[attr-defined]
            assert carried[name] == pytest.approx(share * torque, rel=1e-10)


@pytest.mark.parametrize("lumped", [False, True])
def test_map_and_run_up_are_responses_at_each_mean_torque(lumped: bool) -> None:
    """Six throws, and a crankshaft of one node with the torques of all cylinders."""
    document = dict(model(TRUCKS[-1]).document)
    if lumped:
        document["crankshaft"] = {"lumped_inertia": 1.1, "flange_stiffness": 3e6}
    machine = model_from_document(document)
    speeds, means = machine.speeds(4), np.array([300.0, 1500.0])
    grid = tv.response_map(machine, speeds, means, [machine.top_gear], ORDERS)
    assert machine.engine is not None
    for number, mean in enumerate(means):
        torque = machine.engine.harmonics(speeds, mean, ORDERS)
        torque = torque.sum(axis=1, keepdims=True) if lumped else torque
        nodes = ("crankshaft",) if lumped else tuple(f"throw{i}" for i in range(1, 7))
        load = tv.Excitation(nodes, ORDERS, speeds, torque)
        wanted = tv.harmonic_response(tv.at_operating_point(machine, mean)[0], load)
        angle = wanted.angle.sel(node=grid.node.values).values
        assert grid.angle.values[0, number] == pytest.approx(angle, rel=1e-10)
        along = run_up_response(machine, speeds, mean, machine.top_gear, ORDERS)
        assert along.angle.values == pytest.approx(wanted.angle.values, rel=1e-10)
