"""Opening the user's files: only a regular, moderately sized UTF-8 text gets past here, whatever the path names."""

from __future__ import annotations

import errno
import itertools
import os
import re
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import BinaryIO

from torsional.errors import ModelError, nearest
from torsional.units import quoted

TABLE_BYTES = 20_000_000
_UTF16 = (b"\xff\xfe", b"\xfe\xff")
_CONTROL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028\u2029\ufeff\ufffe\uffff]")
_LISTED = 2000
_REASONS = {
    errno.EACCES: ("the file may not be read", "ask for permission to read it"),
    errno.EPERM: ("the file may not be read", "ask for permission to read it"),
    errno.ENOTDIR: ("a part of the path is a file, not a folder", ""),
    errno.ELOOP: ("the path is a loop of links", "name the file itself"),
    errno.ENAMETOOLONG: ("the file name is too long", "shorten it"),
}


def shown(path: object) -> str:
    """A path as it may be printed: control characters and undecodable bytes escaped, a long one cut in the middle."""
    text = "".join(letter if letter.isprintable() else ascii(letter)[1:-1] for letter in str(path))
    return text[:80] + "..." + text[-110:] if len(text) > 200 else text or "''"


def read_text(path: str | os.PathLike[str], most: int) -> str:
    """The text of a regular UTF-8 file of at most ``most`` bytes, without a byte order mark.

    ModelError names the file for a missing, unreadable, empty or binary one, a folder, a device, UTF-16 and control
    characters.
    """
    with _named(path):
        return decoded(_read_bytes(Path(path), most))


def read_bytes(path: str | os.PathLike[str], most: int) -> bytes:
    """The bytes of a regular file of at most ``most``; ModelError names it for a missing or unreadable one, a folder
    and a device."""
    with _named(path):
        return _read_bytes(Path(path), most)


def first_bytes(path: str | os.PathLike[str], count: int, most: int) -> bytes:
    """The first bytes of a regular file of at most ``most``; ModelError as for all of them."""
    with _named(path), _opened(Path(path)) as file:
        if os.fstat(file.fileno()).st_size > most:
            raise _too_large(most)
        return file.read(count)


@contextmanager
def _named(path: object) -> Iterator[None]:
    """What goes wrong with a file is told with its name."""
    try:
        yield
    except ModelError as error:
        raise error.located(file=shown(path)) from None
    except OSError as error:
        problem, remedy = _REASONS.get(error.errno or 0, (f"the file cannot be read ({error.strerror})", ""))
        raise ModelError(problem, remedy=remedy, file=shown(path)) from None
    except (ValueError, TypeError):
        raise ModelError("this cannot be a file name", found=quoted(path), file=shown(path)) from None


@contextmanager
def _opened(path: Path) -> Iterator[BinaryIO]:
    """A regular file, opened without blocking, so that a pipe put in its place cannot hang the reader."""
    _refuse_irregular(path)
    handle = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(handle, "rb") as file:
        if not stat.S_ISREG(os.fstat(handle).st_mode):
            raise ModelError("this is not a regular file")
        yield file


def _read_bytes(path: Path, most: int) -> bytes:
    with _opened(path) as file:
        data = file.read(min(most, os.fstat(file.fileno()).st_size) + 1)  # as much is allocated as is asked for
    if len(data) > most:
        raise _too_large(most)
    return data


def _too_large(most: int) -> ModelError:
    return ModelError("the file is too large", allowed=f"at most {most:,} bytes".replace(",", " "))


def _refuse_irregular(path: Path) -> None:
    try:
        mode = path.stat().st_mode
    except FileNotFoundError:
        raise _missing(path) from None
    if stat.S_ISDIR(mode):
        raise ModelError("this is a folder, not a file", remedy="name the file in it")
    if not stat.S_ISREG(mode):
        raise ModelError("this is not a regular file", remedy="pipes, devices and sockets are not read")


def _missing(path: Path) -> ModelError:
    """The error for a file that is not there, with the nearest name of its folder."""
    if not path.parent.is_dir():
        return ModelError("there is no such folder", found=quoted(shown(path.parent)))
    names = _neighbours(path.parent)
    alike = [name for name in names if Path(name).suffix == path.suffix]
    return ModelError("there is no such file", remedy=nearest(shown(path.name), alike or names))


def _neighbours(folder: Path) -> list[str]:
    try:
        with os.scandir(folder) as entries:
            return [shown(entry.name) for entry in itertools.islice(entries, _LISTED) if not entry.name.startswith(".")]
    except OSError:
        return []


def decoded(data: bytes) -> str:
    """The text of UTF-8 bytes; ModelError for an empty one, another encoding, and control characters."""
    if not data.strip(b"\xef\xbb\xbf \t\r\n"):
        raise ModelError("the file is empty")
    if data.startswith(_UTF16) or data[:400].count(0) > len(data[:400]) // 4:
        raise ModelError("the file is not UTF-8 but probably UTF-16", remedy="save it as UTF-8")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        found = f"byte 0x{data[error.start]:02x} at offset {error.start}"
        raise ModelError(
            "the file is not UTF-8 text", where=f"line {line}", found=found, remedy="save it as UTF-8"
        ) from None
    _refuse_controls(text)
    return text


def _refuse_controls(text: str) -> None:
    control = _CONTROL.search(text)
    if control:
        line = text.count("\n", 0, control.start()) + 1
        name = "a NUL byte" if control[0] == "\0" else f"U+{ord(control[0]):04X}"
        raise ModelError("the file holds a control character", where=f"line {line}", found=name, remedy="remove it")


def resolve_reference(model_path: str | os.PathLike[str], reference: str, where: str = "") -> Path:
    """The real path of a file that a model file refers to (a pressure trace, a full-load curve).

    It is taken relative to the model's folder and must be a regular file of at most 20 MB inside that folder, links
    followed; ModelError otherwise, so that a model from a stranger reads nothing of the reader's own.
    """
    _refuse_reference(reference, where)
    try:
        folder = Path(model_path).parent.resolve(strict=True)
        target = folder / reference
        _refuse_irregular(target)
        real = target.resolve(strict=True)
        size = real.stat().st_size
    except ModelError as error:
        raise error.located(prefix=where, file=shown(reference)) from None
    except (OSError, RuntimeError) as error:
        reason = _REASONS.get(getattr(error, "errno", 0) or 0, ("the file cannot be read", ""))[0]
        raise ModelError(reason, where=where, file=shown(reference)) from None
    if not real.is_relative_to(folder):
        raise _outside(reference, where, "the file is a link out of the model's folder")
    if size > TABLE_BYTES:
        raise ModelError("the file is too large", where=where, file=shown(reference), allowed="at most 20 MB")
    return real


def _refuse_reference(reference: str, where: str) -> None:
    """Refuse, before any disk is touched, whatever could name a place outside the model's folder."""
    if not isinstance(reference, str) or not reference.strip() or _CONTROL.search(reference):
        raise ModelError("a file name is wanted", where=where, found=quoted(reference))
    windows = PureWindowsPath(reference)
    if windows.drive or windows.root or PurePosixPath(reference).is_absolute():
        raise _outside(reference, where, "an absolute path or a drive is not followed")
    if ".." in windows.parts:
        raise _outside(reference, where, "'..' is not followed")
    if "\\" in reference:
        raise ModelError("folders are separated by '/'", where=where, found=quoted(reference))


def _outside(reference: str, where: str, problem: str) -> ModelError:
    return ModelError(
        problem, where=where, found=quoted(reference), remedy="put the file beside the model file, or in a folder there"
    )
