"""What the page is told where something is not right: the parts of an error, so that it can stand at its field."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from torsional.errors import ModelError

ErrorText = dict[str, str]
PARTS = ("where", "problem", "found", "allowed", "remedy")


class RefusedError(Exception):
    """A request that is not answered: an HTTP ``status`` and the ``errors`` to tell."""

    def __init__(self, status: int, errors: Sequence[ErrorText]) -> None:
        self.status, self.errors = status, list(errors)
        super().__init__(self.errors[0]["text"] if self.errors else str(status))

    def __reduce__(self) -> tuple[type[RefusedError], tuple[int, list[ErrorText]]]:
        return RefusedError, (self.status, self.errors)


def refused(status: int, problem: str, **parts: str) -> RefusedError:
    """A refusal in one sentence.

    >>> refused(413, "the request is too large", allowed="at most 5 MB").errors[0]["text"]
    'the request is too large; allowed: at most 5 MB'
    """
    return RefusedError(status, faults(ModelError(problem, **parts)))


def faults(error: ModelError) -> list[ErrorText]:
    """An error, or the several that one of a file holds, by their parts.

    >>> faults(ModelError("must be positive", where="clutch.stiffness", found="-1"))[0]["where"]
    'clutch.stiffness'
    """
    several: Sequence[ModelError] = getattr(error, "errors", (error,))
    return [{**{part: str(getattr(each, part)) for part in PARTS}, "text": str(each)} for each in several]


def document(errors: Sequence[ErrorText]) -> Mapping[str, object]:
    """What goes over the wire."""
    return {"errors": list(errors)}
