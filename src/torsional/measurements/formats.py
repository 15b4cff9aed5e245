"""The formats of measurement files: told by how a file begins, which its name must not contradict."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import MappingProxyType, ModuleType

from torsional.errors import ModelError

HEAD = 1024
"""Bytes that tell a format."""
_UFF = re.compile(rb"\s*\n?[ ]{4}-1[ \t]*\r?\n")


@dataclass(frozen=True)
class Format:
    """A format: its ``words``, the endings of its files, and the module here that reads it."""

    words: str
    endings: tuple[str, ...]
    module: str
    magic: tuple[bytes, ...] = ()


FORMATS: Mapping[str, Format] = MappingProxyType(
    {
        "mdf": Format("MDF 4", (".mf4", ".mdf"), "mdf", (b"MDF     ", b"UnFinMF ")),
        "mat73": Format("MATLAB 7.3", (".mat",), "mat_hdf5", (b"MATLAB 7.3 MAT-file",)),
        "netcdf": Format("netCDF 4", (".nc", ".nc4"), "results_file", (b"\x89HDF\r\n\x1a\n",)),
        "mat": Format("MATLAB 5", (".mat",), "mat", (b"MATLAB 5.0 MAT-file",)),
        "parquet": Format("Parquet", (".parquet", ".pq"), "parquet", (b"PAR1",)),
        "uff": Format("UFF 58", (".uff", ".unv", ".bunv"), "uff"),
        "csv": Format("CSV", (".csv", ".txt", ".tsv", ".asc"), "table_text"),
    }
)
_OTHERS = {
    b"PK\x03\x04": "an archive or a workbook",
    b"\xd0\xcf\x11\xe0": "an old workbook",
    b"\x93NUMPY": "an array of NumPy",
    b"\x1f\x8b": "a compressed file",
    b"%PDF": "a PDF",
    b"\x80\x04": "a Python pickle",
    b"\x80\x05": "a Python pickle",
    b"TDSm": "a TDMS file",
}
ENDINGS = tuple(dict.fromkeys(ending for each in FORMATS.values() for ending in each.endings))


def format_of(path: Path, head: bytes) -> Format:
    """The format of a file by its first bytes; ModelError where its name says another, or where it is none of these."""
    found = next((each for each in FORMATS.values() if head.startswith(each.magic)), None)
    if found is None:
        found = FORMATS["uff"] if _UFF.match(head) else FORMATS["csv"]
    ending = path.suffix.lower()
    said = [each.words for each in FORMATS.values() if ending in each.endings]
    if said and ending not in found.endings:
        raise _contradiction(" or ".join(said), ending, head, found)
    other = _other(head)
    if found is FORMATS["csv"] and other:
        raise ModelError("this is no measurement file", found=other, allowed=", ".join(ENDINGS))
    return found


def _other(head: bytes) -> str:
    return next((words for magic, words in _OTHERS.items() if head.startswith(magic)), "")


def _contradiction(said: str, ending: str, head: bytes, found: Format) -> ModelError:
    """The error for a name that says another format than the first bytes."""
    if not head.strip(b"\0 \t\r\n"):
        return ModelError("the file is empty" if not head else "the file begins with nothing but zeros")
    words = _other(head)
    if found is FORMATS["csv"] and not words:
        return ModelError(
            f"this is no {said} file", found=f"it begins with {head[:16]!r}", remedy="is it cut or broken?"
        )
    remedy = f"name it {found.endings[0]}" if not words else ""
    return ModelError(
        f"the name ends in {ending}, but this is no {said} file", found=words or found.words, remedy=remedy
    )


def library(name: str, what: str) -> ModuleType:
    """A library that the extra `measurement` brings; raises ModelError where it is not installed."""
    try:
        return import_module(name)
    except ImportError:
        package = name.partition(".")[0]
        remedy = "pip install 'torsional[measurement]'"
        raise ModelError(f"{what} needs the library {package}, which is not installed", remedy=remedy) from None
