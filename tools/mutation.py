"""Mutation testing: how many small mistakes in the sources do the tests find?

    python tools/mutation.py map                         # once: which tests reach which functions (a whole test run)
    python tools/mutation.py run --count 300 --seed 1 --jobs 2
    python tools/mutation.py report

Each mutant is put into a private copy of the checkout whose compiled code is thrown away as far as the change may
reach, and the tests that reach its function run until one fails: those beside it first, then the quickest.  A line of
JSON tells the outcome: ``killed`` (by which test), ``survived``, ``timeout`` (counts as found: it no longer ends),
``unreached`` (no test comes there; counts as survived), ``broken`` (the tests did not run).  ``equal`` tells why a
survivor may do what the source did.
``tests`` of ``reaching``: the tests' usual time is limited by --budget.  A run that is stopped goes on where it was.
Before the mutants some are run without their change: tests that fail then are not to be trusted.

The ready-made tools do not fit: mutmut leaves decorated functions alone, and every compiled one is decorated;
cosmic-ray runs one command for every mutant, here all tests, and meets machine code of callers in other files.
"""

from __future__ import annotations

import argparse
import collections
import json
import os
import re
import subprocess
import sys
import threading
import time
from collections.abc import Iterable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from mutants import Mutant, drawn
from private import ROOT, Copy, stopped
from reach import Names

PACKAGES = ("numerics", "laws", "system.py", "solvers")
FOUND = ("killed", "timeout")
CONTROL = "control"
"""Kind of a mutant without a change: its tests must pass."""


class Tests:
    """Which tests reach which place, from the recorded map."""

    def __init__(self, file: Path, names: Names) -> None:
        lines = [json.loads(line) for line in file.read_text(encoding="utf-8").splitlines()]
        self.seconds = {line["test"]: float(line["seconds"]) for line in lines}
        self.by_place: dict[tuple[str, str], set[str]] = {}
        for line in lines:
            for place in names.reached(line["ran"]):
                self.by_place.setdefault(place, set()).add(line["test"])

    def of(self, mutant: Mutant, budget: float) -> tuple[list[str], int]:
        """Tests to run, the likeliest and quickest first, as many as ``budget`` [s] allows; and how many there are.

        A class or constant that something uses is reached with whatever stands in the same file, as a last resort.
        """
        reaching = self.by_place.get((mutant.file, mutant.place), set())
        if not reaching and "." in mutant.place:
            reaching = self.by_place.get((mutant.file, mutant.place.rpartition(".")[0]), set())
        order = sorted(reaching, key=lambda test: (self._rank(test, mutant.file), self.seconds[test], test))
        kept: list[str] = []
        used = 0.0
        for test in order:
            if not kept or used + self.seconds[test] <= budget:
                kept.append(test)
                used += self.seconds[test]
        return kept, len(order)

    def _rank(self, test: str, file: str) -> int:
        path, stem, floor = test.partition("::")[0], Path(file).stem, Path(file).parent.name
        if path in (f"src/{file}",) or Path(path).stem == f"test_{stem}":
            return 0
        return 1 if f"/{floor}/" in path else 2


def build_map(home: Path, words: list[str]) -> None:
    """Runs the tests in a private copy, and writes down what each of them ran."""
    copy, file = Copy(home / "job0"), home / "reach.jsonl"
    file.unlink(missing_ok=True)
    environment = copy.environment(copy.kept, REACH_FILE=str(file), REACH_SOURCES=str(copy.sources))
    command = copy.pytest("-p", "reach", "-p", "no:xdist", "--hypothesis-seed=0", *words)
    done = subprocess.run(command, cwd=copy.tree, env=environment, check=False)
    print(f"{file}: {len(file.read_text(encoding='utf-8').splitlines())} tests; pytest ended with {done.returncode}")


def outcome(copy: Copy, names: Names, mutant: Mutant, tests: list[str], allowed: float) -> dict[str, object]:
    """What the tests say of a mutant in a private copy, within an ``allowed`` time [s]."""
    path = copy.sources / mutant.file
    source, stamp = path.read_bytes(), path.stat()
    listed = copy.folder / "tests.txt"
    listed.write_text("\n".join(tests) + "\n", encoding="utf-8")
    path.write_bytes(mutant.applied(source))
    began = time.perf_counter()
    try:
        outdated = names.importers(mutant.file) if names.compiled((mutant.file, mutant.place)) else {mutant.file}
        environment = copy.environment(copy.without(outdated), PYTHONDONTWRITEBYTECODE="1")
        command = copy.pytest("-x", "-p", "no:xdist", "--hypothesis-seed=0", "--tb=line", f"@{listed}")
        said, code = _run(command, copy, environment, allowed)
    finally:
        path.write_bytes(source)
        os.utime(path, ns=(stamp.st_atime_ns, stamp.st_mtime_ns))
    failed = re.findall(r"^(?:FAILED|ERROR) (\S+)", said, re.MULTILINE)
    told = {None: "timeout", 0: "survived"}.get(code, "killed")
    if code in (3, 4, 5) and _run([*command, "--collect-only"], copy, environment, allowed)[1] != 0:
        told = "broken"  # the tests cannot be gathered without the change either
    by = failed[0] if failed else "" if told in ("survived", "timeout") else f"pytest ended with {code}"
    return {"outcome": told, "by": by, "seconds": round(time.perf_counter() - began, 1)}


def _run(command: list[str], copy: Copy, environment: dict[str, str], allowed: float) -> tuple[str, int | None]:
    process = subprocess.Popen(
        command, cwd=copy.tree, env=environment, text=True, start_new_session=True,
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    try:
        return process.communicate(timeout=allowed)[0], process.returncode
    except subprocess.TimeoutExpired:
        stopped(process)
        return "", None


def run(home: Path, given: argparse.Namespace) -> None:
    """Tries the mutants that the results do not hold yet, several at a time."""
    first = Copy(home / "job0")
    names = Names(first.sources)
    tests = Tests(home / "reach.jsonl", names)
    files = [file for file in names.trees if file.removeprefix("torsional/").startswith(tuple(given.packages))]
    picked = drawn(((file, (first.sources / file).read_bytes()) for file in files), given.count, given.seed)
    unchanged = [m._replace(kind=CONTROL, new=m.old) for m in picked[: given.controls]]
    picked = [*unchanged, *picked]
    results = home / f"mutants_{given.seed}.jsonl"
    lines = results.read_text(encoding="utf-8").splitlines() if results.exists() else []
    known = {(line["file"], line["start"], line["new"]) for line in map(json.loads, lines)}
    waiting = collections.deque(m for m in picked if (m.file, m.start, m.new) not in known)
    print(f"{len(picked)} mutants, {len(picked) - len(waiting)} known; results in {results}", flush=True)
    lock = threading.Lock()

    def work(job: int) -> None:
        copy = Copy(home / f"job{job}")
        if copy.folder != first.folder:
            copy.take_machine_code(first)
        while True:
            with lock:
                if not waiting:
                    return
                mutant = waiting.popleft()
            told = _tried(copy, names, tests, mutant, given)
            with lock, results.open("a", encoding="utf-8") as out:
                out.write(json.dumps({**mutant._asdict(), **told}, ensure_ascii=False) + "\n")
                where = f"{mutant.file}:{mutant.line} {mutant.kind}"
                print(f"{told['outcome']:9} {told['seconds']:6} s  {where}", flush=True)

    workers = [threading.Thread(target=work, args=(job,)) for job in range(given.jobs)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    report([results])


def _tried(copy: Copy, names: Names, tests: Tests, mutant: Mutant, given: argparse.Namespace) -> dict[str, object]:
    chosen, reaching = tests.of(mutant, given.budget)
    counts = {"tests": len(chosen), "reaching": reaching}
    if not chosen:
        return {"outcome": "unreached", "by": "", "seconds": 0.0, **counts}
    usual = sum(tests.seconds[test] for test in chosen)
    return {**outcome(copy, names, mutant, chosen, given.compiling + 4 * usual), **counts}


def report(files: Iterable[Path]) -> None:
    """The score, and every survivor."""
    told = [json.loads(line) for file in files for line in file.read_text(encoding="utf-8").splitlines()]
    lines = [line for line in told if line["kind"] != CONTROL]
    for line in told:
        if line["kind"] == CONTROL and line["outcome"] != "survived":
            print(f"CONTROL {line['outcome']}: without any change, {line['by']} (what it kills is not to be trusted)")
    counts = collections.Counter(line["outcome"] for line in lines)
    found, spent = sum(counts[name] for name in FOUND), sum(line["seconds"] for line in lines)
    share = 100 * found / max(len(lines), 1)
    print(f"{len(lines)} mutants, {found} found ({share:.1f} %): {dict(counts)}; {spent:.0f} s in all")
    for line in lines:
        if line["outcome"] not in FOUND:
            part = f", {line['tests']} of {line['reaching']} tests" if line["tests"] < line["reaching"] else ""
            doubt = f" ({line['equal']})" if line["equal"] else ""
            where, change = f"{line['file']}:{line['line']} {line['place']}", f"{line['old']!r} -> {line['new']!r}"
            print(f"  {line['outcome']} {where}: {change}{doubt}{part}")


def main() -> None:
    """Reads the command line."""
    parser = argparse.ArgumentParser(description="mutation testing of the package's core")
    parser.add_argument("--home", type=Path, default=ROOT / "out" / "mutation", help="for copies, map and results")
    commands = parser.add_subparsers(dest="command", required=True)
    mapping = commands.add_parser("map", help="record which tests reach which functions")
    mapping.add_argument("words", nargs="*", help="what pytest is told; default: all tests")
    running = commands.add_parser("run", help="try mutants")
    running.add_argument("--count", type=int, default=300)
    running.add_argument("--seed", type=int, default=1)
    running.add_argument("--jobs", type=int, default=2)
    running.add_argument("--packages", nargs="+", default=PACKAGES, help="folders or files of the package")
    running.add_argument("--controls", type=int, default=6, help="mutants to run without their change as well")
    running.add_argument("--budget", type=float, default=120.0, help="usual time of a mutant's tests [s]")
    running.add_argument("--compiling", type=float, default=240.0, help="time for compiling and starting [s]")
    commands.add_parser("report", help="the score so far")
    given = parser.parse_args()
    home = given.home.resolve()
    if given.command == "map":
        build_map(home, given.words)
    elif given.command == "run":
        run(home, given)
    else:
        report(sorted(home.glob("mutants_*.jsonl")))


if __name__ == "__main__":
    main()
