"""What a command hands back: tables for people, a document for machines, data and pictures for files."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from torsional import __version__
from torsional.cli.documents import described, escaped, json_text
from torsional.cli.failures import clean
from torsional.cli.outputs import Writer, text_writer, written
from torsional.cli.request import Request, Wanted
from torsional.cli.tables import Table, print_tables

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

PICTURES = (".png", ".svg")


@dataclass(frozen=True, eq=False)
class Answer:
    """``tables`` are printed; ``document`` goes to --json and .json, with ``data`` as its result.

    ``data`` is also what .csv holds, or ``columns`` where that is less; ``full`` what .nc holds, where that is more;
    ``picture`` draws a figure; ``sentences`` are printed before the tables; ``page`` writes .html.
    """

    command: str
    tables: Sequence[Table]
    document: Mapping[str, object] = field(default_factory=dict)
    data: xr.Dataset | None = None
    full: xr.Dataset | None = None
    picture: Callable[[], Figure] | None = None
    columns: xr.Dataset | None = None
    sentences: Sequence[str] = ()
    page: Writer | None = None


def told_settings(request: Request, **settings: object) -> dict[str, object]:
    """The head of a document: which model, and how it was asked."""
    model = request.model
    named = {"name": model.name, "file": str(request.path), "hash": model.hash, "changes": list(request.changes)}
    return {"model": named, "settings": settings}


def deliver(answer: Answer, request: Request | Wanted) -> None:
    """Write the files, then print: nothing is printed about files that could not be written."""
    wanted = request.as_json or any(path.suffix.lower() == ".json" for path in request.outputs)
    text = _document(answer) if wanted else ""
    written({path: _writer(answer, path, text) for path in request.outputs})
    if request.as_json:
        print_json(text)
    elif not request.quiet:
        if answer.sentences:
            print("\n".join(map(clean, answer.sentences)), end="\n\n")
        print_tables(answer.tables)
    if not request.quiet:
        for path in request.outputs:
            print(f"written: {path}", file=sys.stderr)


def print_json(text: str) -> None:
    """A JSON document to stdout, its letters escaped where the terminal does not have them."""
    utf8 = (sys.stdout.encoding or "").lower().replace("-", "") == "utf8"
    sys.stdout.write(text if utf8 else escaped(text))


def _document(answer: Answer) -> str:
    head = {"torsional": __version__, "command": answer.command, **answer.document}
    result = {} if answer.data is None else {"result": described(answer.data)}
    return json_text({**head, **result})


def _writer(answer: Answer, path: Path, text: str) -> Writer:
    suffix = path.suffix.lower()
    if suffix == ".json":
        return text_writer(text)
    if suffix in PICTURES:
        return lambda draft: _draw(answer, draft)
    if suffix == ".html":
        assert answer.page is not None
        return answer.page
    data = answer.data
    assert data is not None
    if suffix == ".csv":
        table = data if answer.columns is None else answer.columns
        return lambda draft: _save(table, draft)
    return lambda draft: _save(data if answer.full is None else answer.full, draft)


def _save(data: xr.Dataset, draft: Path) -> None:
    from torsional.results import save_results

    save_results(data, draft)


def _draw(answer: Answer, draft: Path) -> None:
    from torsional.plots import save_png, save_svg

    assert answer.picture is not None
    figure = answer.picture()
    draft.write_bytes(save_png(figure) if draft.suffix.lower() == ".png" else save_svg(figure))
