"""What a study is: a question asked of trucks, what it varies, how its answer is judged, and its picture.

The claims are statements of L. Wramner, Torsional vibration absorbers in heavy-duty truck powertrains: simulation and
analysis of multiple-mass flywheel concepts, PhD thesis, Chalmers University of Technology, 2020 (extended summary,
whose section numbers are given).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from torsional.errors import ModelError
from torsional.notebook import html_table

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure as Picture

    from torsional.studies.trucks import Trucks

Figure = float | str | tuple[float, ...] | tuple[str, ...]
MANY = 200
"""Trucks that a claim is asked of, to see on how many of them it holds."""


@dataclass(frozen=True)
class Claim:
    """A statement of the thesis (``section``) in plain words, and the ``criterion`` by which a model is judged."""

    id: str
    section: str
    statement: str
    criterion: str


@dataclass(frozen=True)
class Finding:
    """What the models show of a claim: ``reproduced`` or not (None: they give no answer), under which ``condition``
    (load, gear, amplitude), the ``figures`` with their units in brackets, the ``reason`` where something stands against
    the claim, curves as a ``dataset``.

    ``proviso``: where the claim holds in one reading of its words or one region alone, which one.  ``measured``:
    figures that the machine has a share in, such as run times; all others are the same in every run.
    """

    reproduced: bool | None
    condition: str
    figures: Mapping[str, Figure]
    reason: str = ""
    dataset: xr.Dataset | None = field(default=None, compare=False)
    proviso: str = ""
    measured: Mapping[str, Figure] = field(default_factory=dict, compare=False)


VERDICTS = ("reproduced", "reproduced with a condition", "not reproduced", "not answered")


@dataclass(frozen=True)
class Outcome:
    """A claim beside what was found."""

    claim: Claim
    finding: Finding

    @property
    def verdict(self) -> str:
        """Reproduced, reproduced with a condition or not, or not answered, in words."""
        if self.finding.reproduced is None:
            return VERDICTS[3]
        if not self.finding.reproduced:
            return VERDICTS[2]
        return VERDICTS[1] if self.finding.proviso else VERDICTS[0]

    def __str__(self) -> str:
        found = {**self.finding.figures, **self.finding.measured}
        told = "; ".join(f"{name}: {shown(value)}" for name, value in found.items())
        because = "".join(f" — {text}" for text in (self.finding.proviso, self.finding.reason) if text)
        return f"{self.claim.id} {self.verdict} ({self.finding.condition}): {told}{because}"

    def _repr_html_(self) -> str:
        """In a notebook: statement and verdict, how it was judged, every figure."""
        finding, section = self.finding, f"thesis § {self.claim.section}"
        judged = {"judged by": self.claim.criterion, "asked under": finding.condition}
        judged |= {"holds where": finding.proviso, "to be said": finding.reason}
        found = {name: shown(value) for name, value in {**finding.figures, **finding.measured}.items()}
        rows = [(name, text) for name, text in {**judged, **found}.items() if text]
        return html_table(f"{self.claim.id}: {self.verdict}. {self.claim.statement}", ("", section), rows)


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
    """A claim with the computation that answers it; called with `Trucks` it gives an `Outcome`.

    ``varies``: what it varies, in words; ``picture`` draws the finding's dataset (None: its curves as they are).
    ``leading``: the figure whose spread over many trucks is told; ``trucks``: of how many it is asked, 0 where it is
    about a method, not about trucks.
    """

    claim: Claim
    question: Callable[[Trucks], Finding]
    varies: str = ""
    picture: Callable[[xr.Dataset], Picture] | None = None
    leading: str = ""
    trucks: int = MANY

    @property
    def name(self) -> str:
        """The claim's id."""
        return self.claim.id

    def __call__(self, trucks: Trucks) -> Outcome:
        return Outcome(self.claim, self.question(trucks))

    def asked_of(self, trucks: int) -> Study:
        """A copy that is asked of so many trucks; one about a method stays as it is."""
        return replace(self, trucks=trucks if self.trucks else 0)

    def drawn(self, finding: Finding) -> Picture | None:
        """The picture of a finding; None of one that has no curves."""
        from torsional.plots import plot_sweep

        return None if finding.dataset is None else (self.picture or plot_sweep)(finding.dataset)

    def tried(self, trucks: Trucks) -> Outcome:
        """The outcome; one that is not answered, with the reason, where the trucks refuse the question."""
        try:
            return self(trucks)
        except ModelError as error:
            return Outcome(self.claim, Finding(None, "", {}, str(error)))


@dataclass(frozen=True)
class Tool:
    """A study that engineers run under its own ``name`` on their own truck.

    ``question`` takes `Trucks` and options by name, whose defaults and descriptions stand in its signature, and gives
    a Dataset: values over what was varied, ``condition`` and ``findings`` (sentences, one a line) among its
    attributes; ``picture`` draws it.
    """

    name: str
    question: Callable[..., xr.Dataset]
    varies: str
    picture: Callable[[xr.Dataset], Picture]

    @property
    def about(self) -> str:
        """What it is for: the first line of the question's docstring."""
        return (self.question.__doc__ or "").strip().partition("\n")[0]

    def __call__(self, trucks: Trucks, **options: object) -> xr.Dataset:
        return self.question(trucks, **options)


def claim(
    id: str,
    section: str,
    statement: str,
    criterion: str,
    *,
    varies: str = "",
    picture: Callable[[xr.Dataset], Picture] | None = None,
    leading: str = "",
    trucks: int = MANY,
) -> Callable[[Callable[[Trucks], Finding]], Study]:
    """Decorate a function from `Trucks` to `Finding` so that it becomes the `Study` of a claim."""
    about = Claim(id, section, statement, criterion)
    return lambda question: Study(about, question, varies, picture, leading, trucks)


def tool(
    name: str, *, varies: str, picture: Callable[[xr.Dataset], Picture]
) -> Callable[[Callable[..., xr.Dataset]], Tool]:
    """Decorate a function of `Trucks` and options to a Dataset so that it becomes a `Tool`."""
    return lambda question: Tool(name, question, varies, picture)
