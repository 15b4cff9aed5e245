"""Every claim says what it varies and which figure it turns on, and its picture draws with units on every axis."""

from __future__ import annotations

import re
from collections.abc import Mapping

import pytest
from matplotlib.figure import Figure
from matplotlib.text import Text

from torsional.plots import plot_sweep, save_png
from torsional.studies.base import Outcome
from torsional.studies.register import claims

OTHERS = {"A16", "F1", "F2", "G2", "G3", "G4"}
"""Claims whose pictures are tested elsewhere."""
IDS = [id for id in claims() if id not in OTHERS]
NAMES = {"gear", "connection of the line"}
"""Axes of names, which have no unit."""


@pytest.mark.parametrize("id", IDS)
def test_a_claim_says_what_it_varies(id: str) -> None:
    study = claims()[id]
    assert len(study.varies) > 5 and study.leading


@pytest.mark.parametrize("id", IDS)
def test_the_leading_figure_is_a_number(id: str, outcomes: Mapping[str, Outcome]) -> None:
    assert isinstance(outcomes[id].finding.figures[claims()[id].leading], float)


@pytest.mark.parametrize("id", IDS)
def test_the_picture_has_units_on_every_axis(id: str, outcomes: Mapping[str, Outcome]) -> None:
    data = outcomes[id].finding.dataset
    assert data is not None
    figure = (claims()[id].picture or plot_sweep)(data)
    assert save_png(figure).startswith(b"\x89PNG")
    assert figure.axes
    labels = [label for axes in figure.axes for label in (axes.get_xlabel(), axes.get_ylabel()) if label]
    assert labels and all(re.search(r"\[.+\]", label) or label in NAMES for label in labels), labels
    assert _apart(figure)


def _apart(figure: Figure) -> bool:
    """Whether no two labels of axes lie upon each other."""
    renderer = figure.canvas.get_renderer()  # type: ignore[attr-defined]
    texts: list[Text] = [part for axes in figure.axes for part in (axes.xaxis.label, axes.yaxis.label, axes.title)]
    boxes = [text.get_window_extent(renderer) for text in texts if text.get_text()]
    return not any(a.overlaps(b) for n, a in enumerate(boxes) for b in boxes[:n])
