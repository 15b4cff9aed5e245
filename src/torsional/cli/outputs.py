"""Output files: refused before the work where they cannot be, written whole or not at all."""

from __future__ import annotations

import os
import shutil
import uuid
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path

from torsional.cli.interrupts import uninterrupted
from torsional.errors import ModelError, nearest

Writer = Callable[[Path], object]


def checked(
    paths: Sequence[Path] | None, suffixes: Sequence[str], inputs: Sequence[Path] = (), where: str = "--output"
) -> list[Path]:
    """The output files, refused while nothing is lost yet; ``where`` is what names them on the command line.

    ModelError for an ending that is not among ``suffixes``, a folder that is not there or may not be written, a folder
    in the file's place, one name given twice, and a name of one of the ``inputs``.
    """
    listed = list(paths or ())
    for index, path in enumerate(listed):
        if path.suffix.lower() not in suffixes:
            _refuse_suffix(path, suffixes, where)
        if path.resolve() in [other.resolve() for other in listed[:index]]:
            raise ModelError("the file is named twice", where=where, found=repr(str(path)))
        _refuse_place(path, where)
        if any(_same(path, given) for given in inputs):
            raise ModelError(
                "this would overwrite an input file",
                where=where,
                found=repr(str(path)),
                remedy="choose another name",
            )
    return listed


def refuse_overwriting(paths: Sequence[Path]) -> None:
    """ModelError for a file that is there already, of commands that replace one only where they are told to."""
    for path in paths:
        if path.exists():
            raise ModelError("the file is there already", file=str(path), remedy="choose another name, or say --force")


def written(writers: Mapping[Path, Writer]) -> None:
    """Write all files beside their places, then move them there; a failure or Ctrl-C before that leaves nothing."""
    with ExitStack() as stack:
        moves: list[tuple[Path, Path]] = []
        for path, write in writers.items():
            target = path.resolve()  # a link stays a link, and what it points at is replaced
            draft = stack.enter_context(_draft_folder(target.parent)) / path.name
            try:
                write(draft)
                _settled(draft, target)
            except OSError as error:
                raise _unwritten(path, error) from None
            moves.append((draft, target))
        with uninterrupted():
            for draft, target in moves:
                draft.replace(target)


def text_writer(text: str) -> Writer:
    """A writer of a UTF-8 text with plain line ends."""
    return lambda path: path.write_text(text, encoding="utf-8", newline="\n")


def _refuse_suffix(path: Path, suffixes: Sequence[str], where: str) -> None:
    remedy = nearest(path.suffix, suffixes) if path.suffix else ""
    found = repr(path.suffix) if path.suffix else f"{str(path)!r}, a name without one"
    raise ModelError(
        "the ending of the file says what is written, and this one is not known here",
        where=where,
        found=found,
        allowed=", ".join(suffixes),
        remedy=remedy if remedy.startswith("did") else "",
    )


def _refuse_place(path: Path, where: str) -> None:
    if path.is_dir():
        raise ModelError("this is a folder", where=where, found=repr(str(path)), remedy="name a file in it")
    folder = path.resolve().parent
    if not folder.is_dir():
        remedy = "make the folder first, or name one that is there"
        raise ModelError("there is no such folder", where=where, found=repr(str(path.parent)), remedy=remedy)
    if not os.access(folder, os.W_OK):
        raise ModelError("nothing may be written in this folder", where=where, found=repr(str(path.parent)))


def _same(path: Path, given: Path) -> bool:
    try:
        return path.samefile(given)
    except OSError:
        return False


@contextmanager
def _draft_folder(parent: Path) -> Iterator[Path]:
    """A folder on the same disk, so that moving out of it is one step; it goes whatever happens."""
    folder = parent / f".torsional-{uuid.uuid4().hex}"
    try:  # a Ctrl-C may come between the making of the folder and the next line
        _make(folder)
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _make(folder: Path) -> None:
    try:
        folder.mkdir(mode=0o700)
    except OSError as error:
        raise _unwritten(folder.parent, error) from None


def _settled(draft: Path, target: Path) -> None:
    """The bytes on disk, the permissions those of the file that is replaced."""
    with draft.open("r+b") as file:
        os.fsync(file.fileno())
    if target.exists():
        shutil.copymode(target, draft)


def _unwritten(path: Path, error: OSError) -> ModelError:
    return ModelError("the file cannot be written", file=str(path), found=error.strerror or str(error))
