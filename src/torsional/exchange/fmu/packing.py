"""Units as files: the sources compiled where a compiler is at hand, everything in one archive."""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from torsional.errors import ModelError
from torsional.exchange.fmu.description import VERSIONS, build_description, description_of, identifier
from torsional.exchange.fmu.sources import ENTRY, entry_of, sources_of, token_of
from torsional.exchange.fmu.unit import Unit

COMPILERS = ("cc", "gcc", "clang")
OPTIONS = ("-std=c99", "-O2", "-fPIC", "-shared", "-ffp-contract=off", "-fvisibility=hidden", "-w", "-s")
"""No products are fused with sums, so that figures are those of the compiled kernels."""
_SYSTEMS = {"linux": ("linux", ".so"), "darwin": ("darwin", ".dylib")}
_OLD = (1980, 1, 1, 0, 0, 0)


class Packed(NamedTuple):
    """What was written: the file's ``size`` [bytes], the platform it is ``compiled`` for, empty where for none, the
    longest ``step`` [s], and names of variables."""

    size: int
    compiled: str
    step: float
    inputs: tuple[str, ...]
    parameters: tuple[str, ...]
    outputs: tuple[str, ...]


def packed(unit: Unit, path: str | os.PathLike[str], version: str = "2.0", compiled: bool | None = None) -> Packed:
    """Write a unit.

    ``version`` of FMI; ``compiled``: with a binary for this machine; None: where a compiler is at hand.
    Raises ModelError for another version, and where a binary is wanted and there is no compiler.
    """
    version = {short[0]: short for short in VERSIONS}.get(version, version)
    if version not in VERSIONS:
        raise ModelError("this version of FMI is not written", where="fmi", found=version, allowed=", ".join(VERSIONS))
    sources = sources_of(unit, version)
    token = token_of(sources, version)
    sources[ENTRY] = entry_of(sources, token)
    files: dict[str, str | bytes] = {"modelDescription.xml": description_of(unit, version, token)}
    files |= {f"sources/{name}": text for name, text in sources.items()}
    if version == "3.0":
        files["sources/buildDescription.xml"] = build_description(unit)
    place = platform_of(version)
    compiler = _compiler(place) if compiled is None or compiled else ""
    if compiled and not compiler:
        raise ModelError("no C compiler was found", where="compiled", allowed=", ".join(COMPILERS))
    if compiler:
        name = f"binaries/{place}/{identifier(unit.name)}{_SYSTEMS[sys.platform][1]}"
        files[name] = binary_of(sources, compiler)
    _write(Path(path), files)
    named = [tuple(v.name for kind, v in unit.variables if kind == c) for c in ("input", "parameter", "output")]
    return Packed(Path(path).stat().st_size, place if compiler else "", unit.accuracy.step, *named)


def platform_of(version: str) -> str:
    """What FMI calls this machine; empty where it has no name or none is compiled for."""
    system, machine = _SYSTEMS.get(sys.platform, ("", ""))[0], platform.machine().lower()
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(machine, machine)
    if version != "2.0":
        return f"{machine}-{system}" if system and machine in ("x86_64", "aarch64") else ""
    return f"{system}64" if system and machine == "x86_64" else ""


def _compiler(place: str) -> str:
    return next((found for name in COMPILERS if (found := shutil.which(name))), "") if place else ""


def binary_of(sources: Mapping[str, str], compiler: str) -> bytes:
    """The sources as a shared library; ModelError with what the compiler said."""
    with tempfile.TemporaryDirectory() as folder:
        for name, text in sources.items():
            (Path(folder) / name).write_text(text, encoding="utf-8", newline="\n")
        order = [compiler, *OPTIONS, "-o", "unit", ENTRY, "-lm"]
        told = subprocess.run(order, cwd=folder, capture_output=True, text=True, check=False)
        if told.returncode:
            found = (told.stderr or "nothing").strip().splitlines()[-1][:200]
            raise ModelError("the C compiler refuses the sources", where=compiler, found=found)
        return (Path(folder) / "unit").read_bytes()


def _write(path: Path, files: Mapping[str, str | bytes]) -> None:
    """An archive whose bytes follow from what is in it."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name, _OLD), content, zipfile.ZIP_DEFLATED)
