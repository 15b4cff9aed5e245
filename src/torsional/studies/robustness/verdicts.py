"""Verdicts on many trucks as figures: how often a claim holds, what turns it, how far its leading figure spreads."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from torsional.studies.base import Figure, Outcome
from torsional.studies.robustness.samples import Samples

FEWEST = 5
"""Trucks of either verdict from which on it is told in which parameter they differ most."""
CHANCE = 0.05
"""Probability with which chance alone may name a parameter."""
NORMAL = 1.959963984540054
"""Quantile of the normal distribution for an interval of 95 %."""


@dataclass(frozen=True)
class Answer:
    """What one truck says to a claim: ``reproduced`` (None: it gives no answer, for an ``error``), ``conditional``
    where with a condition, and the ``leading`` figure."""

    reproduced: bool | None
    conditional: bool = False
    leading: float | None = None
    error: str = ""

    @property
    def verdict(self) -> str:
        """In words."""
        if self.reproduced is None:
            return "not answered"
        return (
            ("reproduced with a condition" if self.conditional else "reproduced")
            if self.reproduced
            else ("not reproduced")
        )

    @classmethod
    def of(cls, outcome: Outcome, leading: str) -> Answer:
        """Of an outcome; ``leading`` names the figure, whose largest value is taken where there are several."""
        finding = outcome.finding
        if finding.reproduced is None:
            return cls(None, error=finding.reason)
        return cls(bool(finding.reproduced), bool(finding.proviso), _number(finding.figures.get(leading)))


def _number(figure: Figure | None) -> float | None:
    """A figure as one number, None where it is none."""
    values = figure if isinstance(figure, tuple) else (figure,)
    numbers = [float(value) for value in values if isinstance(value, int | float) and math.isfinite(value)]
    return max(numbers) if numbers else None


@dataclass(frozen=True)
class Turn:
    """A parameter that, alone multiplied by ``factor``, gives another ``verdict`` than the truck as it is."""

    parameter: str
    factor: float
    verdict: str


@dataclass(frozen=True)
class Robustness:
    """On how many trucks a claim holds.

    ``asked`` of so many trucks of the Latin hypercube it ``held`` on some, ``conditional`` of them with a condition,
    and ``failed`` to give an answer on others, which count as trucks on which it does not hold; ``interval``: 95 %
    interval (Wilson) of the share on which it holds.  ``spread``: 5, 50, 95 % of the ``leading`` figure.  ``turns``:
    parameters whose ±20 % ``alone`` (so many trucks) turn the verdict.  ``reasons``: errors with their numbers.
    ``separates``: the parameter whose means differ most between trucks on which it holds and others, in standard
    deviations, where there are five of each and chance would not do it.
    """

    id: str
    asked: int
    held: int
    conditional: int
    failed: int
    interval: tuple[float, float]
    alone: int
    turns: tuple[Turn, ...] = ()
    leading: str = ""
    spread: tuple[float, float, float] | None = None
    reasons: Mapping[str, int] | None = None
    separates: tuple[str, float] | None = None

    @property
    def share(self) -> float:
        """The share of trucks on which it holds; not a number where none was asked."""
        return self.held / self.asked if self.asked else math.nan


def wilson(held: int, asked: int) -> tuple[float, float]:
    """The 95 % interval of a share of which ``held`` of ``asked`` were seen; E. B. Wilson, JASA 22, 1927, 209–212.

    >>> [round(bound, 4) for bound in wilson(200, 200)], wilson(0, 0)
    ([0.9812, 1.0], (0.0, 1.0))
    """
    if not asked:
        return 0.0, 1.0
    z2 = NORMAL**2 / asked
    middle = (held / asked + z2 / 2) / (1 + z2)
    half = math.sqrt(z2 * held / asked * (1 - held / asked) + z2**2 / 4) / (1 + z2)
    return max(middle - half, 0.0), min(middle + half, 1.0)


def judged(id: str, base: Answer, answers: Mapping[int, Answer], samples: Samples, leading: str) -> Robustness:
    """Answers by the trucks' numbers in the samples as figures, ``base`` being that of the truck as it is."""
    together = {number: answers[number] for number in sorted(answers) if number < samples.many}
    alone = {number: answers[number] for number in sorted(answers) if number >= samples.many}
    held = [number for number, each in together.items() if each.reproduced]
    errors = Counter(each.error for each in (*together.values(), *alone.values()) if each.reproduced is None)
    numbers = [each.leading for each in together.values() if each.leading is not None]
    return Robustness(
        id,
        asked=len(together),
        held=len(held),
        conditional=sum(together[number].conditional for number in held),
        failed=sum(each.reproduced is None for each in together.values()),
        interval=wilson(len(held), len(together)),
        alone=len(alone),
        turns=tuple(
            Turn(*samples.alone(number), each.verdict)
            for number, each in alone.items()
            if each.reproduced != base.reproduced
        ),
        leading=leading if numbers else "",
        spread=_quantiles(numbers) if numbers else None,
        reasons=dict(errors.most_common()),
        separates=_separating(held, [number for number in together if number not in held], samples),
    )


def _quantiles(numbers: list[float]) -> tuple[float, float, float]:
    low, middle, high = np.quantile(numbers, (0.05, 0.5, 0.95)).tolist()
    return low, middle, high


def _separating(held: list[int], others: list[int], samples: Samples) -> tuple[str, float] | None:
    """The parameter with the largest standardised difference of means, positive where it is higher when it holds.

    None where chance alone would make one of them as large in one case of twenty.
    """
    if min(len(held), len(others)) < FEWEST or not samples.parameters:
        return None
    pair = samples.together[held], samples.together[others]
    deviation = np.sqrt((pair[0].var(axis=0, ddof=1) + pair[1].var(axis=0, ddof=1)) / 2)
    difference = (pair[0].mean(axis=0) - pair[1].mean(axis=0)) / deviation
    place = int(np.argmax(np.abs(difference)))
    # the largest of so many differences that nothing but chance makes (Bonferroni)
    chance = ndtri(1 - CHANCE / 2 / len(samples.parameters)) * math.sqrt(1 / len(held) + 1 / len(others))
    return (samples.parameters[place], float(difference[place])) if abs(difference[place]) > chance else None
