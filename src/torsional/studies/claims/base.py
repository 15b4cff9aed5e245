"""What a claim is, and what a model answers to it.

The claims are statements of L. Wramner, Torsional vibration absorbers in heavy-duty truck powertrains: simulation and
analysis of multiple-mass flywheel concepts, PhD thesis, Chalmers University of Technology, 2020 (extended summary,
whose section numbers are given).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray as xr

    from torsional.studies.claims.trucks import Trucks

Figure = float | str | tuple[float, ...] | tuple[str, ...]


@dataclass(frozen=True)
class Claim:
    """A statement of the thesis (``section``) in plain words, and the ``criterion`` by which a model is judged."""

    id: str
    section: str
    statement: str
    criterion: str


@dataclass(frozen=True)
class Finding:
    """What the models show: ``reproduced`` or not, under which ``condition`` (load, gear, amplitude), the ``figures``
    with their units in brackets, the ``reason`` where something stands against the claim, curves as a ``dataset``.

    ``proviso``: where the claim holds in one reading of its words or one region alone, which one.
    """

    reproduced: bool
    condition: str
    figures: Mapping[str, Figure]
    reason: str = ""
    dataset: xr.Dataset | None = field(default=None, compare=False)
    proviso: str = ""


@dataclass(frozen=True)
class Outcome:
    """A claim beside what was found."""

    claim: Claim
    finding: Finding

    @property
    def verdict(self) -> str:
        """Reproduced, reproduced with a condition or not, in words."""
        if not self.finding.reproduced:
            return "not reproduced"
        return "reproduced with a condition" if self.finding.proviso else "reproduced"

    def __str__(self) -> str:
        told = "; ".join(f"{name}: {shown(value)}" for name, value in self.finding.figures.items())
        because = "".join(f" — {text}" for text in (self.finding.proviso, self.finding.reason) if text)
        return f"{self.claim.id} {self.verdict} ({self.finding.condition}): {told}{because}"


def shown(value: Figure) -> str:
    """A figure as text, four digits of every number.

    >>> shown((1.0, 0.123456)), shown("clutch")
    ('1, 0.1235', 'clutch')
    """
    if isinstance(value, tuple):
        return ", ".join(shown(part) for part in value) or "none"
    return value if isinstance(value, str) else f"{value:.4g}"


@dataclass(frozen=True)
class Study:
    """A claim with the computation that answers it; called with `Trucks` it gives an `Outcome`."""

    claim: Claim
    question: Callable[[Trucks], Finding]

    def __call__(self, trucks: Trucks) -> Outcome:
        return Outcome(self.claim, self.question(trucks))


def claim(id: str, section: str, statement: str, criterion: str) -> Callable[[Callable[[Trucks], Finding]], Study]:
    """Decorate a function from `Trucks` to `Finding` so that it becomes the `Study` of a claim."""
    return lambda question: Study(Claim(id, section, statement, criterion), question)
