"""`torsional sweep`: a plan worked through in a folder that can be gone back to."""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from torsional import __version__
from torsional.cli.answers import print_json
from torsional.cli.documents import described, json_text
from torsional.cli.failures import UnansweredError, clean, complain
from torsional.cli.interrupts import Kept, taken
from torsional.cli.outputs import Writer, checked, text_writer, written
from torsional.cli.progress import counting, lasting, paced
from torsional.cli.request import Request
from torsional.cli.tables import Column, Table, print_tables
from torsional.errors import ModelError
from torsional.model import Model
from torsional.results import save_results
from torsional.studies.sweeps.collected import Collected
from torsional.studies.sweeps.plan import Plan, load_plan
from torsional.studies.sweeps.standing import standing
from torsional.studies.sweeps.store import CHUNKS, plan_in
from torsional.studies.sweeps.sweep import Pieces
from torsional.studies.sweeps.work import OK
from torsional.studies.sweeps.workers import Dask, Processes, Settings, scheduler_address
from torsional.units import show

SUFFIXES = (".nc", ".csv", ".json")
REASONS = 5
"""Reasons that are told, the most frequent first."""
FOUND = re.compile(r"; found [^;]*")
"""What was found differs from design to design where the reason is the same."""


def run(
    plan: Path,
    folder: Path | None,
    resume: bool,
    status: bool,
    processes: int,
    cluster: str,
    as_json: bool,
    output: Sequence[Path] | None,
    quiet: bool,
) -> None:
    """Answer the command."""
    if status:
        _tell_status(plan, folder or folder_of(plan))
        return
    outputs = checked(output, SUFFIXES, [plan])
    if not resume:
        refuse_begun(folder or folder_of(plan))
    asked, at, found = worked_through(plan, folder, True, chosen_workers(processes, cluster), quiet or as_json)
    _deliver(found, asked, at, outputs, as_json, quiet)


def folder_of(plan: Path) -> Path:
    """Where the pieces of a plan are kept unless told."""
    return plan.with_suffix(".sweep")


def worked_through(
    path: Path,
    folder: Path | None,
    resume: bool,
    workers: Settings | None,
    silent: bool,
    fitting: Callable[[Plan], None] = lambda plan: None,
) -> tuple[Plan, Path, Collected]:
    """A plan, the folder of its pieces, and what all its designs answered; ``fitting`` refuses plans before any work.

    ``workers``: None for those of the plan.

    Raises ModelError for a folder that holds pieces, unless its sweep is gone on with or needs no more work.
    """
    asked, at = load_plan(path), folder or folder_of(path)
    fitting(asked)
    pieces = Pieces.of(asked.work, at, asked.chunk)
    if not resume and pieces.store.missing(pieces.count):
        refuse_begun(at)
    _worked(pieces, asked, workers or asked.workers, silent)
    return asked, at, pieces.collected()


def chosen_workers(processes: int, cluster: str) -> Settings | None:
    """Who works, where the command says it; else the plan does."""
    if not cluster:
        return Processes(kind="processes", count=processes) if processes else None
    if processes:
        raise ModelError("there are processes here or a cluster, not both", where="--cluster", found=repr(cluster))
    try:
        return Dask(kind="dask", address=scheduler_address(cluster))
    except ModelError as error:
        raise error.located(prefix="--cluster") from None


def refuse_begun(folder: Path) -> None:
    """ModelError for a folder that holds work."""
    if (folder / CHUNKS).is_dir() and any((folder / CHUNKS).iterdir()):
        remedy = "--resume goes on with it; or remove it, or name another --folder"
        raise ModelError("the folder holds pieces of a sweep", where="--folder", found=repr(str(folder)), remedy=remedy)


def _tell_status(plan: Path, folder: Path) -> None:
    """How far the sweep is, and how fast it goes where somebody works on it; nothing is made or changed."""
    asked = load_plan(plan)
    if plan_in(folder) is None:
        problem = "there is no such folder" if not folder.exists() else "the folder holds no sweep"
        raise ModelError(problem, where="--folder", found=repr(str(folder)))
    at = standing(Pieces.of(asked.work, folder, asked.chunk))
    failed = f"; {' and '.join(f'{count} {word}' for word, count in at.failed.items())}" if at.failed else ""
    share = f"{100 * at.done / at.total:.1f} %" if at.done else "0 %"
    print(f"{folder}: {at.done} of {at.total} designs are worked out ({share}){failed}; {_bytes(at.size)}")
    if at.done == at.total:
        return
    if at.working:
        print(f"about {paced(at.rate)}, {lasting(at.left)} left; the latest piece came {lasting(at.idle)} ago")
    elif at.done:
        print(f"the latest piece came {lasting(at.idle)} ago; if nobody works on it, --resume goes on")


def _bytes(size: int) -> str:
    for unit, factor in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if size >= factor:
            return f"{size / factor:.3g} {unit}"
    return f"{size} bytes"


def _worked(pieces: Pieces, asked: Plan, workers: Settings, silent: bool) -> None:
    try:
        with counting(asked.name, "designs", silent) as moved:
            pieces.worked(workers, moved)
    except KeyboardInterrupt:
        taken()
        left = sum(map(pieces.length, pieces.store.missing(pieces.count)))
        told = f"{len(pieces.work.designs) - left} of {len(pieces.work.designs)} designs are kept in"
        raise Kept(f"{told} {pieces.store.folder}; --resume goes on") from None


def _deliver(found: Collected, asked: Plan, folder: Path, outputs: Sequence[Path], as_json: bool, quiet: bool) -> None:
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
    tell_failures(found)


def asked_of(
    plan: Plan, folder: Path, found: Collected, outputs: Sequence[Path], as_json: bool, quiet: bool
) -> tuple[dict[str, object], Request]:
    """The head of a document about a plan's sweep, and what was asked of whom."""
    model = plan.work.build
    assert isinstance(model, Model)  # plans name one
    request = Request(model, folder, (), outputs, as_json, quiet)
    head = {"plan": plan.name, "folder": str(folder), "designs": found.counts}
    return {**head, "model": {"name": model.name, "hash": model.hash}}, request


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
    rows = [[name, *(show(value, found.quantity(name)) for value in values)] for name, values in found.ranges().items()]
    columns = [Column("figure"), Column("least"), Column("median"), Column("most")]
    return [Table("Over all designs", columns, rows)] if rows else []


def tell_failures(found: Collected) -> None:
    """Say why designs have no answer, the most frequent reasons first, and end with an exit code of its own."""
    tell_states(*found.states)


def tell_states(state: Any, reasons: Any) -> None:
    """The same of the status and the reason of every design."""
    failed = state != OK
    if not failed.any():
        return
    alike: dict[str, Counter[str]] = {}
    for reason in map(str, reasons[failed]):
        alike.setdefault(FOUND.sub("", reason), Counter())[reason] += 1
    for told in sorted(alike.values(), key=lambda each: -each.total())[:REASONS]:
        (reason, _), *others = told.most_common(2)
        complain(f"{told.total()} × {clean(reason)}" + (", and the like" if others else ""), kind="warning")
    raise UnansweredError(
        f"{int(failed.sum())} of {state.size} designs have no answer; status and reason of each stand in the result"
    )
