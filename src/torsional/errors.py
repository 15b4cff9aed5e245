"""Errors that teach: what was found, where, what is allowed, what to do."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class TorsionalError(Exception):
    """Base of every error that is the user's to mend; the command line turns it into exit code 2."""


class ModelError(TorsionalError, ValueError):
    """A model, file or setting is not what physics or the schema allows.

    The parts are kept apart so that a face (command line, workbench) can place them; ``str`` joins them into one
    sentence.  ``where`` is the user's own name for the thing: a key path, a component or a node.

    >>> print(ModelError("the inertia must be positive", where="absorber.primary_inertia", found="-1.2"))
    absorber.primary_inertia: the inertia must be positive; found -1.2
    """

    def __init__(
        self, problem: str, *, where: str = "", found: str = "", allowed: str = "", remedy: str = "", file: str = ""
    ) -> None:
        self.problem, self.where, self.found = problem, where, found
        self.allowed, self.remedy, self.file = allowed, remedy, file
        super().__init__(problem)

    def __str__(self) -> str:
        place = ": ".join(part for part in (self.file, self.where) if part)
        told = [self.problem]
        told += [f"found {self.found}"] if self.found else []
        told += [f"allowed: {self.allowed}"] if self.allowed else []
        told += [self.remedy] if self.remedy else []
        return (f"{place}: " if place else "") + "; ".join(told)

    def located(self, *, file: str = "", prefix: str = "") -> ModelError:
        """The same error with the file named and the key path prefixed."""
        where = ".".join(part for part in (prefix, self.where) if part)
        told = {"found": self.found, "allowed": self.allowed, "remedy": self.remedy}
        return type(self)(self.problem, where=where, file=file or self.file, **told)


def nearest(word: str, known: Iterable[str], listed: bool = True) -> str:
    """A remedy that names the known word nearest to a misspelt one, or lists them all where they are to be ``listed``.

    A number is no misspelling of another one.

    >>> nearest("stifness", ["stiffness", "damping"])
    "did you mean 'stiffness'?"
    """
    words = [str(k) for k in known]
    close = [] if word.isdigit() else difflib.get_close_matches(word, words, n=1, cutoff=0.6)
    if close:
        return f"did you mean '{close[0]}'?"
    if not listed:
        return ""
    return "known: " + ", ".join(sorted(words)[:20]) if words else "none is known here"
