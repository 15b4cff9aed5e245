"""Many designs of one truck: the coupling alone, a sweep with all that belongs to it, and NumPy at the same work."""

from __future__ import annotations

import json
import resource
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from ledger import Floor

import torsional
from torsional.numerics.elimination.coupling import CoupledPlan, Rest, Values
from torsional.solvers.operating import at_operating_point
from torsional.studies.sweeps import Designs, sampled
from torsional.studies.sweeps.analyses import ResponseRun
from torsional.studies.sweeps.sweep import Pieces
from torsional.studies.sweeps.work import Work

TRUCK = torsional.load_model(Path(__file__).parents[1] / "examples/truck_dmf.yaml")
FREQUENCIES, ORDER, TORQUE = 128, 3.0, 1500.0
SPEED = np.linspace(650.0, 1950.0, FREQUENCIES) * torsional.RPM
VARIED = {
    "absorber.stiffness": (10e3, 18e3),  # soft enough for no stop at this torque
    "absorber.damping": (10.0, 40.0),
    "absorber.primary_inertia": (0.8, 1.8),
    "absorber.secondary_inertia": (0.6, 1.4),
}
SWEPT = ResponseRun.model_validate(
    {"analysis": "response", "torque": TORQUE, "orders": [ORDER], "speed": [SPEED[0], SPEED[-1], SPEED[1] - SPEED[0]]}
)


def designs(count: int) -> Designs:
    """Sobol points over springs and inertias of the dual mass flywheel."""
    return sampled("sobol", VARIED, count, seed=20)


@dataclass(frozen=True)
class Chain:
    """The truck's linear system, what varies of it, and the numbers of every design."""

    count: int

    def __post_init__(self) -> None:
        system, _ = at_operating_point(TRUCK, TORQUE)
        columns = designs(self.count).columns(0, self.count)
        c, m = system.connections, system.masses
        spring, bodies = c.names.index("dmf"), [m.names.index(name) for name in ("primary", "secondary")]
        loads = TRUCK.running_engine.excitation(TRUCK.landmarks.throws, SPEED, np.full(FREQUENCIES, TORQUE), [ORDER])
        told = {
            "system": system,
            "plan": CoupledPlan.build(c.weights, m.weights, [spring], bodies),
            "spring": (columns["absorber.stiffness"], columns["absorber.damping"]),
            "bodies": np.column_stack([columns["absorber.primary_inertia"], columns["absorber.secondary_inertia"]]),
            "loads": loads.torque[..., 0],
            "throws": [system.node_index(node) for node in TRUCK.landmarks.throws],
            "input": system.node_index(TRUCK.landmarks.input),
            "places": (spring, bodies),
        }
        for name, value in told.items():
            object.__setattr__(self, name, value)

    def rest(self) -> Rest:
        """What all designs share."""
        c = self.system.connections
        values = c.stiffness, c.loss_factor, c.damping, c.centrifugal_stiffness
        at = ORDER * SPEED, SPEED
        return self.plan.rest(values, self.system.masses.inertia, at, self.throws, self.loads, [self.input])

    def coupled(self) -> Callable[[], np.ndarray]:
        """The coupling alone, in stretches that a sweep would ask: angles (designs, frequencies) at the input."""
        rest, size, (k, c) = self.rest(), 1000, self.spring
        zero, found = np.zeros((1, 1)), np.empty((self.count, FREQUENCIES), dtype=complex)

        def work() -> np.ndarray:
            for first in range(0, self.count, size):
                part = slice(first, first + size)
                values: Values = (k[part, None], zero, c[part, None], zero)
                found[part] = self.plan.solve(rest, values, self.bodies[part])[0][:, 0]
            return found

        return work

    def assembled(self) -> tuple[np.ndarray, np.ndarray]:
        """Matrices with a design's numbers added (designs, frequencies, n, n), and the loads, for NumPy."""
        c, m = self.system.connections, self.system.masses
        spring, bodies = self.places
        omega = ORDER * SPEED
        z = c.stiffness * (1 + 1j * c.loss_factor) + 1j * omega[:, None] * c.damping
        z[:, spring] = 0.0
        J = m.inertia.copy()
        J[bodies] = 0.0
        base = np.einsum("fe,ei,ej->fij", z, c.weights, c.weights)
        base = base - omega[:, None, None] ** 2 * (m.weights.T * J) @ m.weights
        k, damping = self.spring
        w, v = c.weights[spring], m.weights[bodies]
        own = (k[:, None] + 1j * omega * damping[:, None])[..., None, None] * np.outer(w, w)
        own = own - omega[:, None, None] ** 2 * np.einsum("db,bi,bj->dij", self.bodies, v, v)[:, None]
        loads = np.zeros((FREQUENCIES, w.size), dtype=complex)
        loads[:, self.throws] = self.loads
        return base + own, loads

    def dense(self) -> np.ndarray:
        """Assembled and solved by NumPy's batched solver."""
        Z, loads = self.assembled()
        return np.linalg.solve(Z, loads[None, ..., None])[..., self.input, 0]


def floor() -> Floor:
    """One case: two row sums, a coupling, one elimination with its load, one back substitution, the output's way."""
    stamps, leaf, root, back, way = 22, 11 + 8 + 14 + 8 + 8, 11 + 8, 8 + 8 + 2, 8 + 2
    return Floor(stamps + leaf + root + back + way, 16.0)


def swept(count: int, folder: Path, processes: int = 1) -> dict[str, float]:
    """A sweep of so many designs kept in a folder and written to netCDF: seconds, most memory [GB], size [GB], and how
    long it takes to ask the file for the design whose worst is least."""
    start = time.perf_counter()
    pieces = Pieces.of(Work(TRUCK, designs(count), SWEPT), folder / "sweep", 10_000)
    pieces.worked(processes, lambda done, total: None)
    worked = time.perf_counter() - start
    found = pieces.collected()
    found.write(folder / "found.nc")
    spent = time.perf_counter() - start
    memory = sum(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)) / 1e6
    size = (folder / "found.nc").stat().st_size / 1e9
    start = time.perf_counter()
    best = _least(folder / "found.nc", count)
    asked = time.perf_counter() - start
    told = {"worked": worked, "seconds": spent, "memory": memory, "size": size, "asked": asked, "best": best}
    return told | {"ok": found.counts["ok"]}


def _least(path: Path, count: int) -> int:
    """The design whose largest acceleration is least, asked of the file in stretches."""
    import xarray as xr

    with xr.open_dataset(path, engine="h5netcdf") as opened:
        parts = [opened.acceleration[at : at + 50_000].max(("speed", "order")).values for at in range(0, count, 50_000)]
    return int(np.concatenate(parts).argmin())


if __name__ == "__main__":
    print(json.dumps(swept(int(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]))))
