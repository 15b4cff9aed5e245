"""`torsional sweep`: a plan worked through in a folder that can be gone back to."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from torsional import __version__
from torsional.cli.answers import print_json
from torsional.cli.documents import described, json_text
from torsional.cli.failures import UnansweredError, clean, complain
from torsional.cli.interrupts import Kept, taken
from torsional.cli.outputs import Writer, checked, text_writer, written
from torsional.cli.progress import counting
from torsional.cli.tables import Column, Table, print_tables
from torsional.errors import ModelError
from torsional.results import save_results
from torsional.studies.sweeps.collected import Collected
from torsional.studies.sweeps.plan import Plan, load_plan
from torsional.studies.sweeps.store import CHUNKS
from torsional.studies.sweeps.sweep import Pieces
from torsional.studies.sweeps.work import OK
from torsional.units import show

SUFFIXES = (".nc", ".csv", ".json")
REASONS = 5
"""Reasons that are told, the most frequent first."""


def run(
    plan: Path,
    folder: Path | None,
    resume: bool,
    status: bool,
    processes: int,
    as_json: bool,
    output: Sequence[Path] | None,
    quiet: bool,
) -> None:
    """Answer the command."""
    asked = load_plan(plan)
    outputs = checked(output, SUFFIXES, [plan])
    at = folder or plan.with_suffix(".sweep")
    if not (resume or status):
        _refuse_begun(at)
    if status and not at.exists():
        raise ModelError("there is no such folder", where="--folder", found=repr(str(at)))
    pieces = Pieces.of(asked.work, at, asked.chunk)
    if status:
        _tell_status(pieces, at)
        return
    _worked(pieces, asked, processes, quiet or as_json)
    _deliver(pieces.collected(), asked, at, outputs, as_json, quiet)


def _refuse_begun(folder: Path) -> None:
    if (folder / CHUNKS).is_dir() and any((folder / CHUNKS).iterdir()):
        remedy = "--resume goes on with it; or remove it, or name another --folder"
        raise ModelError("the folder holds pieces of a sweep", where="--folder", found=repr(str(folder)), remedy=remedy)


def _tell_status(pieces: Pieces, folder: Path) -> None:
    designs = len(pieces.work.designs)
    done = designs - sum(map(pieces.length, pieces.store.missing(pieces.count)))
    print(f"{folder}: {done} of {designs} designs are worked out ({100 * done / designs:.1f} %)")


def _worked(pieces: Pieces, asked: Plan, processes: int, silent: bool) -> None:
    try:
        with counting(asked.name, "designs", silent) as moved:
            pieces.worked(processes or asked.processes, moved)
    except KeyboardInterrupt:
        taken()
        left = sum(map(pieces.length, pieces.store.missing(pieces.count)))
        told = f"{len(pieces.work.designs) - left} of {len(pieces.work.designs)} designs are kept in"
        raise Kept(f"{told} {pieces.store.folder}; --resume goes on") from None


def _deliver(
    found: Collected, asked: Plan, folder: Path, outputs: Sequence[Path], as_json: bool, quiet: bool
) -> None:
    head = {"torsional": __version__, "command": "sweep", "plan": asked.name, "folder": str(folder)}
    wanted = as_json or any(path.suffix.lower() == ".json" for path in outputs)
    text = json_text({**head, "designs": found.counts, "result": described(found.whole())}) if wanted else ""
    written({path: _writer(found, path, text) for path in outputs})
    if as_json:
        print_json(text)
    elif not quiet:
        print_tables([_table(asked, found.counts), *_ranges(found)])
    if not quiet:
        print("\n".join(f"written: {path}" for path in (folder, *outputs)), file=sys.stderr)
    _tell_failures(found)


def _writer(found: Collected, path: Path, text: str) -> Writer:
    """A file that takes the answers chunk by chunk where its format lets it."""
    if path.suffix.lower() == ".json":
        return text_writer(text)
    return found.write if path.suffix.lower() == ".nc" else lambda draft: save_results(found.whole(), draft)


def _table(asked: Plan, counts: dict[str, int]) -> Table:
    rows = [[word, count] for word, count in counts.items() if count or word == "ok"]
    return Table(f"{asked.name}: {sum(counts.values())} designs", [Column("designs"), Column("number")], rows)


def _ranges(found: Collected) -> list[Table]:
    """Smallest, median and largest of every figure over all designs and all else."""
    rows = [
        [name, *(show(value, found.quantity(name)) for value in values)] for name, values in found.ranges().items()
    ]
    columns = [Column("figure"), Column("least"), Column("median"), Column("most")]
    return [Table("Over all designs", columns, rows)] if rows else []


def _tell_failures(found: Collected) -> None:
    """Say why designs have no answer, the most frequent reasons first, and end with an exit code of its own."""
    state, reasons = found.states
    failed = state != OK
    if not failed.any():
        return
    told = Counter(map(str, reasons[failed])).most_common(REASONS)
    for reason, count in told:
        complain(f"{count} × {clean(reason)}", kind="warning")
    raise UnansweredError(
        f"{int(failed.sum())} of {state.size} designs have no answer; status and reason of each stand in the result"
    )
