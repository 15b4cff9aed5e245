"""Machines of the periodic tests, described once: as a `System` for the package and as plain matrices for a judge.

The judge knows nothing of the package: it samples the laws between their kinks by Gauss's rule, puts the torques on all
coordinates at once and looks at what is left over.  `balanced` solves the same equations by Newton's method.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
import xarray as xr
from tests.validation.periodic_reference import RPM, Case, Cubic, Stages

from torsional.components import Component, Coupling, GearPair, Inertia, Shaft
from torsional.engine import Excitation
from torsional.laws import Hinges, Law, Polynomial
from torsional.powertrain import Powertrain
from torsional.solvers.periodic import periodic_response
from torsional.system import System, assemble

NodeTorques = Mapping[str, Mapping[float, complex]]


def as_hinges(law: Stages) -> Hinges:
    """The package's law of the same stages."""
    middle = law.stage(0.0)
    steps = np.diff(law.slopes)
    sides = np.where(np.arange(len(law.edges)) < middle, -1.0, 1.0)
    return Hinges(law.slopes[middle], law.edges, tuple(sides.tolist()), tuple((sides * steps).tolist()))


def as_law(law: Stages | Cubic | Law) -> Law:
    if isinstance(law, Law):
        return law
    return as_hinges(law) if isinstance(law, Stages) else Polynomial((0.0, 0.0, law.gamma))


@dataclass(frozen=True)
class Machine:
    """Discs by name; springs (a, b, k, c), laws (a, b, law, c) and gears (a, b, ratio): θ_a = ratio θ_b.

    A spring or a law acts on θ_b − θ_a; a may be "ground".  ``torques``: complex 0-peak of each node by order.
    """

    discs: Mapping[str, float]
    springs: Mapping[str, tuple[str, str, float, float]] = field(default_factory=dict)
    laws: Mapping[str, tuple[str, str, Stages | Cubic, float]] = field(default_factory=dict)
    gears: Mapping[str, tuple[str, str, float]] = field(default_factory=dict)
    torques: NodeTorques = field(default_factory=dict)
    hold: str = ""

    # --- for the package ---

    def components(self) -> dict[str, Component]:
        parts: dict[str, Component] = {name: Inertia(inertia) for name, inertia in self.discs.items()}
        parts |= {name: Shaft(a, b, k, c) for name, (a, b, k, c) in self.springs.items()}
        parts |= {name: Coupling(a, b, as_law(law), c) for name, (a, b, law, c) in self.laws.items()}
        return parts | {name: GearPair(a, b, ratio) for name, (a, b, ratio) in self.gears.items()}

    @property
    def system(self) -> System:
        return assemble(Powertrain(self.components()))

    @property
    def grounded(self) -> bool:
        return any("ground" in part[:2] for part in (*self.springs.values(), *self.laws.values()))

    @property
    def orders(self) -> np.ndarray:
        return np.array(sorted({order for given in self.torques.values() for order in given}))

    @property
    def excitation(self) -> Excitation:
        rows = [[given.get(order, 0.0) for order in self.orders.tolist()] for given in self.torques.values()]
        return Excitation(tuple(self.torques), self.orders, 1.0, np.array(rows, dtype=complex))

    # --- for the judge ---

    @property
    def onto(self) -> tuple[np.ndarray, list[int]]:
        """T (nodes, coordinates) and the nodes that are the coordinates, gears eliminated one after the other."""
        names = list(self.discs)
        T = np.eye(len(names))
        for a, b, ratio in self.gears.values():
            i, j = names.index(a), names.index(b)
            row = ratio * T[j] - T[i]
            T = T + np.outer(T[:, i], row) / T[i, i] if T[i, i] else T
        kept = [i for i in range(len(names)) if T[:, i].any()]
        return T[:, kept], kept

    def row(self, a: str, b: str) -> np.ndarray:
        """The direction θ_b − θ_a among the nodes."""
        names = list(self.discs)
        return np.array([float(n == b) - float(n == a) for n in names])

    def case(self, order: float | None = None) -> Case:
        """Matrices on the coordinates; harmonics in multiples of ``order`` (default: the lowest above 0)."""
        base = order or float(self.orders[self.orders > 0].min())
        T, _ = self.onto
        rows = np.array([self.row(a, b) @ T for a, b, _, _ in self.springs.values()]).reshape(-1, T.shape[1])
        k, c = (np.array([s[i] for s in self.springs.values()]) for i in (2, 3))
        W = np.array([self.row(a, b) @ T for a, b, _, _ in self.laws.values()])
        d = np.array([law[3] for law in self.laws.values()])
        names = list(self.discs)
        loads = {round(order / base): np.zeros(T.shape[1], dtype=complex) for order in self.orders.tolist()}
        for node, given in self.torques.items():
            for order_, torque in given.items():
                loads[round(order_ / base)] += T[names.index(node)] * torque
        M = T.T @ np.diag(list(self.discs.values())) @ T
        C = (rows.T * c) @ rows + (W.T * d) @ W
        return Case(M, C, (rows.T * k) @ rows, W, tuple(law[2] for law in self.laws.values()), loads, base)

    def with_torques(self, torques: NodeTorques) -> Machine:
        return replace(self, torques=torques)


# --- the judge ---

_GAUSS = np.polynomial.legendre.leggauss(12)


def law_harmonics(law: Stages | Cubic, x: np.ndarray) -> np.ndarray:
    """Complex 0-peak harmonics of a law's torque along those of an angle (H + 1,), integrated kink by kink."""
    count = len(x)
    cuts = np.arange(4 * count + 17) * 2 * np.pi / (4 * count + 16)
    if isinstance(law, Stages):
        cuts = np.unique(np.concatenate([cuts, *(_passages(x, edge) for edge in law.edges)]))
    half = 0.5 * np.diff(cuts)
    tau = ((cuts[:-1] + half)[:, None] + half[:, None] * _GAUSS[0]).ravel()
    weight = (half[:, None] * _GAUSS[1]).ravel() / (2 * np.pi)
    turns = np.exp(-1j * np.multiply.outer(np.arange(count), tau))
    out = turns @ (weight * law.along((x @ turns.conj()).real))
    out[1:] *= 2
    return np.asarray(out)


def _passages(x: np.ndarray, edge: float) -> np.ndarray:
    """Angles at which a motion passes an edge: a dense grid, then halving."""
    h, size = np.arange(len(x)), max(4096, 64 * len(x))

    def gap(tau: np.ndarray) -> np.ndarray:
        return (x @ np.exp(1j * np.multiply.outer(h, tau))).real - edge

    grid = np.arange(size + 1) * 2 * np.pi / size
    sampled = np.fft.irfft(np.concatenate([x[:1] * 2, x[1:], np.zeros(size // 2 + 1 - len(x))]), size) * size / 2 - edge
    sampled = np.append(sampled, sampled[0])
    at = np.flatnonzero((sampled[:-1] > 0) != (sampled[1:] > 0))
    low, high, rising = grid[at], grid[at + 1], sampled[at + 1] > 0
    for _ in range(50):
        middle = 0.5 * (low + high)
        up = (gap(middle) > 0) == rising
        low, high = np.where(up, low, middle), np.where(up, middle, high)
    return 0.5 * (low + high)


def leftover(case: Case, speed: float, q: np.ndarray, step: float = 1.0, hold: np.ndarray | None = None) -> float:
    """What Newton's equations leave over, as a share of the largest torque that acts.

    ``q`` (H + 1, coordinates) harmonics in multiples of ``step`` times the case's base order; ``hold``: the row of the
    node whose reaction may be anything at harmonic 0.
    """
    omega = np.arange(len(q)) * step * case.order * speed
    x = q @ case.weights.T
    force = np.stack([law_harmonics(law, x[:, e]) for e, law in enumerate(case.laws)], axis=1)
    rest = q @ case.K + 1j * omega[:, None] * (q @ case.C) - omega[:, None] ** 2 * (q @ case.M) + force @ case.weights
    for h, load in case.loads.items():
        if round(h / step) < len(q):
            rest[round(h / step)] -= load
    if hold is not None:
        rest[0] -= hold * (hold @ rest[0]) / (hold @ hold)
    return float(np.abs(rest).max() / max(np.abs(load).max() for load in case.loads.values()))


def worst_leftover(machine: Machine, data: xr.Dataset, step: int = 1) -> float:
    """`leftover` of every ``step``-th point of a result (``speed`` is the parameter)."""
    T, kept = machine.onto
    orders = data.order.values
    case = machine.case()
    names = list(machine.discs)
    angle = data.angle.sel(node=names).values
    hold = T[names.index(machine.hold)] if machine.hold and not machine.grounded else None
    worst = 0.0
    for i in range(0, len(angle), step):
        q = angle[i][:, kept]
        assert np.abs(q @ T.T - angle[i]).max() <= 1e-12 * np.abs(angle[i]).max()
        worst = max(worst, leftover(case, float(data.speed[i]), q, orders[1] / case.order, hold))
    return worst


def balanced(case: Case, speed: float, q: np.ndarray, step: float = 1.0, samples: int = 1 << 13) -> np.ndarray:
    """Newton's method on all coordinates with sampled laws: harmonics (H + 1, coordinates) near a guess."""
    count, n = q.shape
    omega = np.arange(count) * step * case.order * speed
    tau = np.arange(samples) * 2 * np.pi / samples
    turns = np.exp(1j * np.multiply.outer(tau, np.arange(count)))
    table = np.concatenate([turns.real, -turns.imag[:, 1:]], axis=1)
    back = np.concatenate([turns.real * 2, -turns.imag[:, 1:] * 2], axis=1).T / samples
    back[0] /= 2
    z = np.concatenate([q.real, q.imag[1:]])
    Z = case.K + 1j * omega[:, None, None] * case.C - omega[:, None, None] ** 2 * case.M
    linear = np.zeros((2 * count - 1, n, 2 * count - 1, n))
    for h in range(count):
        linear[h, :, h] = Z[h].real
        if h:
            i = count + h - 1
            linear[h, :, i], linear[i, :, h], linear[i, :, i] = -Z[h].imag, Z[h].imag, Z[h].real
    load = np.zeros_like(z)
    for h, u in case.loads.items():
        i = round(h / step)
        load[i] += u.real
        if i:
            load[count + i - 1] += u.imag
    for _ in range(60):
        x = table @ z @ case.weights.T
        rest, jacobian = np.tensordot(linear, z, 2) - load, linear.copy()
        for e, law in enumerate(case.laws):
            w = case.weights[e]
            rest += np.multiply.outer(back @ law.along(x[:, e]), w)
            slope = (back * law.slopes_along(x[:, e])) @ table
            jacobian += np.einsum("ij,a,b->iajb", slope, w, w)
        change = np.linalg.solve(jacobian.reshape(z.size, z.size), rest.ravel()).reshape(z.shape)
        z -= change
        if np.abs(change).max() <= 1e-12 * np.abs(z).max():
            break
    else:
        raise RuntimeError("the judge's Newton method does not converge")
    out = z[:count].astype(complex)
    out[1:] += 1j * z[count:]
    return out


# --- the machines ---

TWO_STAGES = Stages((1.0,), (1.0, 2.0))
DMF = Stages((-0.08, 0.08), (25e3, 10e3, 25e3))


def oscillator(
    law: Stages | Cubic, damping: float, torques: Mapping[float, complex], stiffness: float = 0.0
) -> Machine:
    """One disc of 1 kgm² before ground."""
    springs = {"beside": ("ground", "disc", stiffness, 0.0)} if stiffness else {}
    return Machine({"disc": 1.0}, springs, {"spring": ("ground", "disc", law, damping)}, torques={"disc": torques})


def dmf12(damping: float = 15.0, mean: float = 1000.0, third: float = 2500.0) -> Machine:
    """The truck-like chain of twelve bodies, a dual mass flywheel of two stages in its middle."""
    throws = [f"throw{i}" for i in range(1, 7)]
    names = ["front", *throws, "primary", "secondary", "gearbox", "axle", "vehicle"]
    discs = dict(zip(names, [0.05, *[0.1] * 6, 1.5, 0.8, 0.3, 0.5, 400.0], strict=True))
    springs = {f"crank{i}": (names[i + 1], names[i], 2e6, 5.0) for i in range(7)} | {
        "clutch": ("gearbox", "secondary", 8e4, 10.0),
        "propshaft": ("axle", "gearbox", 3e4, 5.0),
        "drive": ("vehicle", "axle", 6e3, 10.0),
        "road": ("ground", "vehicle", 1000.0, 0.0),
    }
    torques = {node: {0.0: mean / 6, 3.0: third / 6} for node in throws}
    return Machine(discs, springs, {"dmf": ("secondary", "primary", DMF, damping)}, torques=torques)


def stop_machine() -> Machine:
    """Two masses, the first before a one-sided stop; NLvib example 03."""
    springs = {"link": ("first", "second", 1.0, 0.03), "own": ("ground", "second", 1.0, 0.03)}
    laws = {"stop": ("ground", "first", Stages((1.0,), (0.0, 100.0)), 0.0)}
    return Machine({"first": 1.0, "second": 1.0}, springs, laws, torques={"second": {1.0: 0.1}})


def three_laws(mean: float = 100.0, third: float = 2500.0, grounded: bool = True) -> Machine:
    """Dual mass flywheel, clutch stages and a gear's lash in one line."""
    clutch = Stages((-0.05, -0.004, 0.004, 0.02), (3e3, 6e3, 1e3, 6e3, 2e4))
    lash = Stages((-0.002, 0.002), (2e5, 0.0, 2e5))
    discs = {"engine": 1.8, "secondary": 0.7, "input": 0.05, "output": 0.25, "axle": 0.6, "vehicle": 60.0}
    springs = {"shaft": ("axle", "output", 1.5e4, 12.0), "drive": ("vehicle", "axle", 5e3, 25.0)}
    if grounded:
        springs["road"] = ("ground", "vehicle", 500.0, 50.0)
    laws = {
        "dmf": ("secondary", "engine", Stages((-0.03, 0.03), (25e3, 8e3, 25e3)), 12.0),
        "clutch": ("input", "secondary", clutch, 6.0),
        "lash": ("output", "input", lash, 4.0),
    }
    torques = {"engine": {0.0: mean, 3.0: third}}
    return Machine(discs, springs, laws, torques=torques, hold="vehicle")


def geared(mean: float = 300.0, third: float = 4000.0) -> Machine:
    """Dual mass flywheel before a gear pair of 1 : 2.5 with lash on its slow side, no link to ground."""
    lash = Stages((-0.004, 0.004), (3e5, 0.0, 3e5))
    return Machine(
        {"engine": 1.5, "secondary": 0.6, "pinion": 0.05, "wheel": 0.3, "output": 0.8, "vehicle": 150.0},
        {"shaft": ("pinion", "secondary", 6e4, 8.0), "drive": ("vehicle", "output", 2e4, 60.0)},
        {"dmf": ("secondary", "engine", DMF, 15.0), "lash": ("output", "wheel", lash, 10.0)},
        {"mesh": ("pinion", "wheel", 2.5)},
        {"engine": {0.0: mean, 3.0: third}},
        "vehicle",
    )


def thirty_nodes(mean: float = 100.0, third: float = 4000.0) -> Machine:
    """A line of thirty discs with a dual mass flywheel and a gear's lash in it."""
    names = [f"d{i}" for i in range(30)]
    inertias = [*[0.08] * 8, 1.2, 0.6, *[0.05] * 10, *[0.2] * 9, 120.0]
    springs = {f"s{i}": (names[i + 1], names[i], 8e5 if i < 8 else 2e5, 6.0) for i in range(29) if i not in (8, 19)}
    springs |= {"s28": ("d29", "d28", 8e3, 30.0), "road": ("ground", "d29", 800.0, 10.0)}
    laws = {
        "dmf": ("d9", "d8", DMF, 14.0),
        "lash": ("d20", "d19", Stages((-0.004, 0.004), (1.5e5, 0.0, 1.5e5)), 6.0),
    }
    torques = {f"d{i}": {0.0: mean / 6, 3.0: third / 6} for i in range(1, 7)}
    return Machine(dict(zip(names, inertias, strict=True)), springs, laws, torques=torques, hold="d29")


def clutch_machine(mean: float = 60.0, third: float = 2500.0) -> Machine:
    """Dual mass flywheel and the stages of a clutch disc."""
    line = three_laws(mean, third)
    springs = dict(line.springs) | {"gear": ("output", "input", 4e5, 5.0)}
    return replace(line, springs=springs, laws={name: line.laws[name] for name in ("dmf", "clutch")})


def rpm(speed: float) -> float:
    """Speed [rad/s] of revolutions per minute."""
    return speed * RPM


# --- answers of the package ---


def respond(machine: Machine, span: tuple[float, float], **changed: object) -> xr.Dataset:
    """`periodic_response` of a machine."""
    return periodic_response(machine.system, machine.excitation, span, hold=machine.hold, **changed)  # type: ignore[arg-type]


def picked(data: xr.Dataset, value: float, kind: str = "") -> xr.Dataset:
    """The points at one value of the parameter, on branches of one kind."""
    at = np.abs(data.value.values - value) <= 1e-12 * abs(value)
    if kind:
        at &= (data.kind.values == kind)[data.branch.values]
    return data.isel(point=np.flatnonzero(at))


def bifurcations(data: xr.Dataset, name: str, branch: int = 0) -> np.ndarray:
    """Values of the parameter at the bifurcations of one type on a branch, ascending."""
    chosen = (data.bifurcation_type.values == name) & (data.on_branch.values == branch)
    return np.sort(data.bifurcation_value.values[chosen])
