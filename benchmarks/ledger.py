"""What was timed: the ratios to this project's own time, and the distance to the floor that counting gives."""

from __future__ import annotations

import json
import platform
import time
from dataclasses import asdict, dataclass, field
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np

OURS = "torsional"


@dataclass(frozen=True)
class Floor:
    """Counted work of one case: real additions and multiplications, and bytes that must be read or written."""

    flops: float
    bytes: float

    def seconds(self, machine: Machine) -> float:
        """The least time [s] the machine needs for one case."""
        return max(self.flops / machine.flops_per_second, self.bytes / machine.bytes_per_second)


@dataclass(frozen=True)
class Machine:
    """Measured rates of one core."""

    flops_per_second: float
    bytes_per_second: float

    @classmethod
    def measured(cls) -> Machine:
        """Rates seen in a matrix product and in a long copy, the best of several tries each."""
        a, out = np.random.default_rng(0).random((768, 768)), np.empty((768, 768))
        source, target = np.ones(8_000_000), np.empty(8_000_000)
        product = min(_timed(lambda: np.matmul(a, a, out=out)) for _ in range(12))
        copy = min(_timed(lambda: np.copyto(target, source)) for _ in range(12))
        return cls(2 * 768**3 / product, 2 * source.nbytes / copy)


def _timed(work) -> float:
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


@dataclass(frozen=True)
class Entry:
    """One contender's median time at one piece of work of ``cases`` equal cases."""

    work: str
    contender: str
    seconds: float
    cases: int
    note: str = ""


@dataclass
class Ledger:
    """The entries of a run, and the floors and titles of the pieces of work."""

    entries: list[Entry] = field(default_factory=list)
    floors: dict[str, Floor] = field(default_factory=dict)
    titles: dict[str, str] = field(default_factory=dict)

    def ours(self, work: str) -> float | None:
        """This project's time for a case, by its public function, which is entered first; None without one."""
        times = [e.seconds / e.cases for e in self.entries if e.work == work and e.contender.startswith(OURS)]
        return next(iter(times), None)

    def rows(self, machine: Machine) -> list[dict[str, object]]:
        """The entries with ratios: ``times_ours`` to this project, ``times_floor`` to the counted floor."""
        rows = []
        for entry in self.entries:
            ours, floor = self.ours(entry.work), self.floors.get(entry.work)
            per_case = entry.seconds / entry.cases
            ratio = None if ours is None else per_case / ours
            distance = None if floor is None else per_case / floor.seconds(machine)
            rows.append(asdict(entry) | {"per_case": per_case, "times_ours": ratio, "times_floor": distance})
        return rows

    def table(self, machine: Machine) -> str:
        """The rows as text, a block for each piece of work."""
        rows, lines = self.rows(machine), []
        for work in dict.fromkeys(entry.work for entry in self.entries):
            lines += ["", f"{work}  {self.titles.get(work, '')}", _HEAD]
            lines += [_line(row) for row in rows if row["work"] == work]
            if work in self.floors:
                lines.append(f"  floor {_duration(self.floors[work].seconds(machine))} a case")
        rates = machine.flops_per_second / 1e9, machine.bytes_per_second / 1e9
        return "\n".join([*lines, "", "one core: {:.1f} Gflop/s, {:.1f} GB/s".format(*rates)])

    def save(self, path: Path, machine: Machine) -> None:
        """Write rows, machine and versions as JSON."""
        path.parent.mkdir(parents=True, exist_ok=True)
        packages = {name: _version(name) for name in ("torsional", "opentorsion", "numpy", "scipy", "numba")}
        told = {"machine": asdict(machine), "python": platform.python_version(), "packages": packages}
        path.write_text(json.dumps(told | {"rows": self.rows(machine)}, indent=1) + "\n", encoding="utf-8")


_HEAD = f"  {'contender':38} {'median':>10} {'a case':>10} {'x ours':>8} {'x floor':>8}"


def _line(row: dict[str, object]) -> str:
    ratios = [f"{value:8.1f}" if isinstance(value, float) else f"{'-':>8}" for value in _ratios(row)]
    times = f"{_duration(row['seconds']):>10} {_duration(row['per_case']):>10}"
    return f"  {row['contender']:38} {times} {' '.join(ratios)}  {row['note']}"


def _ratios(row: dict[str, object]) -> tuple[object, object]:
    return row["times_ours"], row["times_floor"]


def _duration(seconds: float) -> str:
    for unit, scale in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= scale:
            return f"{seconds / scale:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None
