"""MATLAB 7.3 files, which are HDF5, through h5py: only what lies in the file itself is followed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from torsional.errors import ModelError
from torsional.measurements.mat_channels import DEPTH, found_in
from torsional.measurements.recording import Found, bounded
from torsional.units import quoted

ITEMS = 100_000
_NOT_READ = ("cell", "function_handle", "table", "canonical empty")


def read(path: Path) -> Found:
    """The channels of numeric variables and structures; cells, objects, and links out of the file are left alone."""
    import h5py

    with h5py.File(path, "r") as file:
        return found_in(_Tree().of(file, 0), "MATLAB 7.3")


class _Tree:
    """Groups as mappings, bounded in numbers and in depth."""

    def __init__(self) -> None:
        self._items = self._numbers = 0

    def of(self, group: Any, depth: int) -> dict[str, Any]:
        """What a group holds, by name."""
        return dict(self._held(group, depth))

    def _held(self, group: Any, depth: int) -> Iterator[tuple[str, Any]]:
        import h5py

        if depth > DEPTH:
            raise ModelError("structures are nested too deeply", allowed=f"{DEPTH} levels")
        for name in group:
            self._items += 1
            if self._items > ITEMS:
                raise ModelError("the file holds too many variables", allowed=f"at most {ITEMS}")
            if name.startswith("#"):
                continue
            if not isinstance(group.get(name, getlink=True), h5py.HardLink):
                yield name, None
                continue
            item = group[name]
            yield name, self.of(item, depth + 1) if isinstance(item, h5py.Group) else self._value(item, name)

    def _value(self, item: Any, name: str) -> Any:
        kind = _class(item)
        if item.external or item.is_virtual or kind in _NOT_READ or item.attrs.get("MATLAB_empty", 0):
            return None
        if item.shape is None or item.dtype.kind not in "biufV":
            return None
        self._numbers += int(np.prod(item.shape, dtype=object)) * (2 if item.dtype.kind == "V" else 1)
        bounded(self._numbers)
        values = np.asarray(item[()]).T
        if values.dtype.kind == "V":
            return _complex(values, name)
        return "".join(map(chr, values.ravel("F").astype(int).tolist()[:1000])) if kind == "char" else values


def _class(item: Any) -> str:
    found = item.attrs.get("MATLAB_class", b"")
    return found.decode("latin-1") if isinstance(found, bytes) else str(found)


def _complex(values: Any, name: str) -> Any:
    """Complex numbers are pairs of a real and an imaginary part."""
    if values.dtype.names != ("real", "imag"):
        raise ModelError("numbers in this form are not read", where=quoted(name), found=str(values.dtype)[:60])
    return values["real"] + 1j * values["imag"]
