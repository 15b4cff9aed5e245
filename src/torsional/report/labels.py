"""Short names of variants, and numbers as sentences write them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from torsional.model import Model
from torsional.units import QUANTITIES, convert


def labels(models: Sequence[Model]) -> list[str]:
    """What tells models apart: their names without the words that all begin with.

    Of models with one name, as copies of a file have, it is their absorbers; what is still the same is numbered.
    """
    words = [model.name.split() or ["model"] for model in models]
    alike = len({tuple(w) for w in words}) == 1
    kinds = [model.absorber.kind if model.absorber else "" for model in models]
    if alike and all(kinds) and len({*kinds}) == len(models):
        return kinds
    common = 0
    while not alike and all(len(w) > common + 1 and w[common] == words[0][common] for w in words):
        common += 1
    short = [" ".join(w[common:]) for w in words]
    return [f"{name} ({short[: i + 1].count(name)})" if short.count(name) > 1 else name for i, name in enumerate(short)]


def rounded(value: float, digits: int = 3) -> str:
    """A number with three significant digits and no exponent.

    >>> rounded(812.4), rounded(0.0274), rounded(12345.0)
    ('812', '0.0274', '12345')
    """
    if not math.isfinite(value):
        return "–"
    if abs(value) >= 10 ** (digits - 1) or value == 0:
        return f"{value:.0f}"
    places = digits - 1 - math.floor(math.log10(abs(value)))
    return f"{value:.{places}f}".rstrip("0").rstrip(".")


def told(value: float, quantity: str, digits: int = 3) -> str:
    """An SI value in the unit its quantity is shown in: 80.5 rad/s of speed is 769 rpm.

    >>> told(80.53, "speed"), told(0.2, "relative_angle"), told(0.271, "ratio")
    ('769 rpm', '11.5°', '0.271')
    """
    entry = QUANTITIES[quantity]
    number = value if entry.unit == entry.shown else convert(value, entry.unit, entry.shown)
    if entry.shown == "-":
        return rounded(number, digits)
    return f"{rounded(number, digits)}°" if entry.shown == "deg" else f"{rounded(number, digits)} {entry.shown}"


def listed(things: Sequence[str]) -> str:
    """Things in a sentence.

    >>> listed(["1", "2", "3"])
    '1, 2 and 3'
    """
    *first, last = things
    return f"{', '.join(first)} and {last}" if first else last


def gears_told(gears: Sequence[str], known: Sequence[str]) -> str:
    """Gears as ranges of those known: all 12 gears, gear 8, gears 8 to 12, gears 1, 3 and 5; empty for none at all.

    >>> gears_told(["8", "9", "10", "12"], [str(i) for i in range(1, 13)])
    'gears 8 to 10 and 12'
    """
    if not any(known):
        return ""
    if len(gears) == len(known):
        return f"all {len(known)} gears" if len(known) > 1 else f"gear {gears[0]}"
    runs: list[list[int]] = []
    for place in sorted(list(known).index(gear) for gear in gears):
        if runs and place == runs[-1][-1] + 1:
            runs[-1].append(place)
        else:
            runs.append([place])
    spans = [[f"{known[run[0]]} to {known[run[-1]]}"] if len(run) > 2 else [known[i] for i in run] for run in runs]
    parts = [part for span in spans for part in span]
    return ("gear " if len(gears) == 1 else "gears ") + listed(parts)
