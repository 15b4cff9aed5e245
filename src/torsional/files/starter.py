"""Model files to start from, as `torsional new` writes them."""

from __future__ import annotations

from importlib.resources import files

from torsional.errors import ModelError, nearest

KINDS = {"truck": "a vehicle by its blocks", "line": "any machine by its components"}


def starter(kind: str = "truck") -> str:
    """The text of a commented model file that loads as it is: ``truck`` (blocks) or ``line`` (components).

    >>> starter("line").splitlines()[-1]
    '  input: rotor'
    """
    if kind not in KINDS:
        raise ModelError("there is no such starter model", found=repr(kind), remedy=nearest(kind, KINDS))
    return (files("torsional") / "data" / f"{kind}.yaml").read_text(encoding="utf-8")
