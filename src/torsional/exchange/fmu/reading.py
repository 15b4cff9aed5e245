"""Units of others: opened with care, since an archive from a stranger may hold anything."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path, PurePosixPath, PureWindowsPath
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import Any

from torsional.errors import ModelError, nearest
from torsional.exchange.fmu.packing import platform_of
from torsional.units import quoted

MOST_BYTES, MOST_FILES, MOST_RATIO = 2_000_000_000, 20_000, 1000
"""What an archive may hold unpacked, and how much of it may come of one byte where it is more than 50 MB."""
DESCRIPTION = "modelDescription.xml"


def fmpy(name: str = "fmpy") -> ModuleType:
    """A module of FMPy, which the extra `fmi` brings; raises ModelError where it is not installed."""
    try:
        return import_module(name)
    except ImportError:
        remedy = "pip install 'torsional[fmi]'"
        raise ModelError("a library that units need is not installed", found="FMPy", remedy=remedy) from None


def _refuse_entry(entry: zipfile.ZipInfo, file: str) -> None:
    """ModelError for a name that leads out of the folder that is unpacked into."""
    name, windows = entry.filename, PureWindowsPath(entry.filename)
    outside = windows.drive or windows.root or PurePosixPath(name).is_absolute() or ".." in windows.parts
    link = (entry.external_attr >> 16) & 0o170000 == 0o120000
    if outside or link or "\0" in name:
        problem = "the archive holds a link" if link else "the archive holds a file that would lie outside of it"
        raise ModelError(problem, file=file, found=quoted(name), remedy="do not use this file")


def checked_archive(path: Path) -> zipfile.ZipFile:
    """The archive, open; ModelError for what is none, and for one that is not safe to unpack."""
    file = str(path)
    try:
        archive = zipfile.ZipFile(path)
    except (OSError, zipfile.BadZipFile) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else "not an archive"
        remedy = "a functional mock-up unit is a file that ends in .fmu"
        raise ModelError("this is no functional mock-up unit", file=file, found=reason, remedy=remedy) from None
    entries = archive.infolist()
    for entry in entries:
        _refuse_entry(entry, file)
    size, kept = sum(e.file_size for e in entries), sum(e.compress_size for e in entries)
    if len(entries) > MOST_FILES or size > MOST_BYTES or (size > 5e7 and size > MOST_RATIO * max(kept, 1)):
        found, remedy = f"{len(entries)} files of {size} bytes", "do not use this file"
        raise ModelError("the archive would fill the disk", file=file, found=found, remedy=remedy)
    if DESCRIPTION not in archive.namelist():
        remedy = f"a functional mock-up unit has {DESCRIPTION}"
        raise ModelError("this is no functional mock-up unit", file=file, found="another archive", remedy=remedy)
    return archive


@contextmanager
def unpacked(path: Path) -> Iterator[tuple[str, Any]]:
    """The folder of an unpacked unit for co-simulation on this machine, and its description.

    Raises ModelError for anything else.
    """
    with checked_archive(path) as archive, TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        try:
            text = archive.read(DESCRIPTION)
            if re.search(rb"<!(DOCTYPE|ENTITY)", text):
                raise ModelError("the description declares entities", file=str(path), remedy="do not use this file")
            archive.extractall(folder)
        except (zipfile.BadZipFile, RuntimeError, NotImplementedError, OSError) as error:
            raise ModelError("the archive cannot be unpacked", file=str(path), found=str(error)[:80]) from None
        yield folder, _described(folder, path)


def _described(folder: str, path: Path) -> Any:
    try:
        described = fmpy().read_model_description(folder, validate=True)
    except ModelError:
        raise
    except Exception as error:  # whatever the library or the parser says
        found = str(error).strip().splitlines()[-1][:200] if str(error).strip() else type(error).__name__
        raise ModelError("the unit's description is not what FMI wants", file=str(path), found=found) from None
    if described.coSimulation is None:
        remedy = "export it for co-simulation"
        raise ModelError(
            "the unit is not made for co-simulation", file=str(path), found="model exchange", remedy=remedy
        )
    _refuse_platform(folder, described, path)
    return described


def _refuse_platform(folder: str, described: Any, path: Path) -> None:
    wanted = platform_of("2.0" if described.fmiVersion.startswith("2") else "3.0")
    places = Path(folder) / "binaries"
    there = sorted(p.name for p in places.iterdir() if p.is_dir()) if places.is_dir() else []
    if not wanted or wanted not in there:
        found = ", ".join(there) or "sources alone"
        remedy = f"have it compiled for {wanted or 'this machine'}"
        raise ModelError("the unit has no binary for this machine", file=str(path), found=found, remedy=remedy)


def reference(described: Any, name: str, causality: str, path: Path) -> int:
    """The number of a variable; ModelError, with the nearest name, for one that is not there or is something else."""
    known = {v.name: v for v in described.modelVariables}
    fitting = [v.name for v in described.modelVariables if v.causality == causality and v.type in ("Real", "Float64")]
    if name not in known:
        remedy = nearest(name, fitting)
        raise ModelError("the unit has no such variable", file=str(path), where=quoted(name), remedy=remedy)
    if name not in fitting:
        found = f"{known[name].causality} of type {known[name].type}"
        raise ModelError(f"the variable is no real {causality}", file=str(path), where=quoted(name), found=found)
    return int(known[name].valueReference)
