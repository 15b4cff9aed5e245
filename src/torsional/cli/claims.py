"""`torsional claims`: the claims of the thesis judged on a truck, a page and a document."""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Sequence
from pathlib import Path

from torsional import __version__
from torsional.cli.answers import print_json
from torsional.cli.documents import json_text
from torsional.cli.outputs import text_writer, written
from torsional.cli.progress import progress
from torsional.cli.study import truck_of, trucks_of
from torsional.cli.tables import Column, Table, print_tables
from torsional.errors import ModelError, nearest
from torsional.model import Model
from torsional.numerics.compiling import WATCH
from torsional.report.claims import write_claims
from torsional.report.claims.robustness import share_told
from torsional.studies.asking import Asked, asked
from torsional.studies.base import Outcome
from torsional.studies.register import claims


def run(
    ids: Sequence[str] | None,
    truck: Path | None,
    changes: Sequence[str] | None,
    quick: bool,
    trucks: int,
    thorough: bool,
    processes: int,
    as_json: bool,
    output: Path,
    quiet: bool,
) -> None:
    """Answer the command."""
    chosen = chosen_ids(ids or ())
    beside = output.with_suffix(".json")
    model, _ = truck_of(truck, changes, [output], (".html", ".htm"))
    truck_of(truck, None, [beside], (".json",))
    silent = quiet or as_json
    with WATCH.silent(silent), progress("claims", silent) as moved:
        many, count = 0 if quick else trucks, processes or None
        found = asked(trucks_of(model), chosen, many=many, thorough=thorough, processes=count, progress=moved)
    text = json_text(document(found, model))
    written({beside: text_writer(text)})  # first: no picture that fails shall cost a quarter of an hour's work
    written({output: lambda draft: write_claims(found, model, draft)})
    if as_json:
        print_json(text)
    elif not quiet:
        print_tables([verdicts(found, model)])
    if not quiet:
        print(f"written: {output}\nwritten: {beside}", file=sys.stderr)


def chosen_ids(ids: Sequence[str]) -> tuple[str, ...]:
    """The claims of ids and letters, in their order, all of them where none is given; ModelError for unknown ones."""
    known = list(claims())
    for id in ids:
        if id.upper() not in {*known, *(each[0] for each in known)}:
            raise ModelError("there is no such claim", where="IDS", found=repr(id), remedy=nearest(id.upper(), known))
    wanted = {id.upper() for id in ids}
    return tuple(id for id in known if not wanted or id in wanted or id[0] in wanted)


def verdicts(found: Asked, truck: Model) -> Table:
    """Every claim's verdict, and on how many varied trucks it holds."""
    columns = (
        [Column("claim"), Column("verdict"), Column("holds on")]
        if found.robustness
        else [Column("claim"), Column("verdict")]
    )
    rows = [
        [id, outcome.verdict, *([share_told(found.robustness.get(id))] if found.robustness else [])]
        for id, outcome in found.outcomes.items()
    ]
    return Table(f"Claims judged on {truck.name}", columns, rows)


def document(found: Asked, truck: Model) -> dict[str, object]:
    """All figures and verdicts for machines; what the clock of this machine told stands apart."""
    settings = {"trucks": found.many, "seed": found.seed, "parameters": list(found.parameters)}
    return {
        "torsional": __version__,
        "command": "claims",
        "model": {"name": truck.name, "hash": truck.hash},
        "trucks": dict(found.origins),
        "versions": dict(found.versions),
        "settings": settings,
        "claims": [_claim(found, outcome) for outcome in found.outcomes.values()],
    }


def _claim(found: Asked, outcome: Outcome) -> dict[str, object]:
    finding, known = outcome.finding, found.robustness.get(outcome.claim.id)
    told = {key: getattr(finding, key) for key in ("condition", "proviso", "reason", "figures", "measured")}
    study = {"varies": claims()[outcome.claim.id].varies, "verdict": outcome.verdict}
    robustness = {} if known is None else {"robustness": dataclasses.asdict(known)}
    return {**dataclasses.asdict(outcome.claim), **study, **told, **robustness}
