"""How far a verdict can be trusted, in words, in a table and in one picture of all claims."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from torsional.report.blocks import Block, Picture, Table, Text, picture
from torsional.studies.asking import Asked
from torsional.studies.base import shown
from torsional.studies.robustness import Robustness

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FEW = 0.5
"""A claim that holds on a smaller share of the varied trucks is said to hold on a tuned truck only."""


def share_told(known: Robustness | None) -> str:
    """On how many of the varied trucks a claim holds.

    >>> share_told(None)
    'not asked of varied trucks'
    """
    if known is None or not known.asked:
        return "not asked of varied trucks"
    unanswered = f", {known.failed} without an answer" if known.failed else ""
    return f"{known.held} of {known.asked}{unanswered}"


def turned_by(known: Robustness | None) -> str:
    """The parameters that turn the verdict when they alone are 20 % off."""
    if known is None or not known.alone:
        return "–"
    return ", ".join(dict.fromkeys(turn.parameter for turn in known.turns)) or "none"


def robustness_blocks(known: Robustness | None) -> list[Block]:
    """What the varied trucks said of one claim."""
    if known is None or not known.asked:
        return []
    low, high = (100 * bound for bound in known.interval)
    share = 100 * known.held / known.asked
    told = f"Of {known.asked} varied trucks it holds on {known.held} "
    told += f"({share:.0f} %, 95 % interval {low:.0f} to {high:.0f} %)."
    if known.conditional:
        told += f" On {known.conditional} of these it holds with a condition."
    if known.failed and known.reasons:
        told += f" {known.failed} gave no answer: {'; '.join(f'{why} ({n})' for why, n in known.reasons.items())}."
    if known.separates is not None:
        name, far = known.separates
        told += f" Trucks on which it holds differ most from the others by a {'higher' if far > 0 else 'lower'} {name}."
    if known.spread is not None:
        told += f" {known.leading}: {' / '.join(shown(value) for value in known.spread)} at 5 / 50 / 95 % of them."
    if known.held < FEW * known.asked:
        told += " It is a claim about tuned trucks."
    if known.alone:
        told += f" With one parameter alone 20 % off ({known.alone} trucks), the verdict "
        told += "is turned by:" if known.turns else "stays."
    blocks: list[Block] = [Text(told, "note")]
    if known.turns:
        rows = [(turn.parameter, f"{turn.factor:g} ×", turn.verdict) for turn in known.turns]
        blocks.append(Table("", ("parameter", "value", "verdict then"), tuple(rows)))
    return blocks


def turning_picture(asked: Asked) -> Sequence[Picture]:
    """Which parameter turns which verdict, all in one picture; nothing where none does."""
    from torsional.plots.turning import plot_turning

    turning = {id: known.turns for id, known in asked.robustness.items() if known.turns}
    if not turning:
        return []
    marks = {id: [(turn.parameter, turn.factor) for turn in turns] for id, turns in turning.items()}
    figure: Figure = plot_turning(marks)
    unasked = [id for id, known in asked.robustness.items() if not known.alone]
    caption = (
        "Parameters that turn a verdict when they alone are 20 % lower (−) or higher (+) than the truck's. Claims and "
        "parameters that are not named stand firm"
    ) + (f"; not asked so: {', '.join(unasked)}." if unasked else ".")
    return [picture(figure, caption, "A table of claims against parameters, marked where the verdict turns.")]
