"""What the pages on claims share: the table of verdicts, each linked to where the claim is told."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from html import escape
from typing import Any

PAGES = {**{letter: f"paper-{letter.lower()}" for letter in "ABCDEF"}, "G": "beyond"}
"""Pages in `papers` by the letter of the claims they are about."""


def verdicts(outcomes: Mapping[str, Any]) -> str:
    """A table for a page in `papers`: each claim is linked to its figures on the page of all claims."""
    return _table((id, f"../claims.html#claim-{id.lower()}", outcome) for id, outcome in outcomes.items())


def all_verdicts(outcomes: Mapping[str, Any]) -> str:
    """A table for the page of all claims: each is linked to the page of its paper."""
    return _table((id, f"papers/{PAGES[id[0]]}.html", outcome) for id, outcome in outcomes.items())


def sections(outcomes: Mapping[str, Any]) -> str:
    """Every claim with how it was judged and what was found, to be linked to."""
    return "\n".join(_section(id, outcome) for id, outcome in outcomes.items())


def _section(id: str, outcome: Any) -> str:
    page = f"papers/{PAGES[id[0]]}.html"
    table = outcome._repr_html_().replace("<table>", '<table class="docutils">', 1)
    return f'<section id="claim-{id.lower()}"><h3><a href="{page}">{id}</a>: {outcome.verdict}</h3>{table}</section>'


def _table(rows: Iterable[tuple[str, str, Any]]) -> str:
    head = "<tr><th>claim</th><th>what is said</th><th>verdict</th></tr>"
    body = "".join(
        f'<tr><td><a href="{link}">{id}</a></td><td>{escape(each.claim.statement)}</td><td>{_verdict(each)}</td></tr>'
        for id, link, each in rows
    )
    return f'<table class="docutils"><thead>{head}</thead><tbody>{body}</tbody></table>'


def _verdict(outcome: Any) -> str:
    """In words; what is not plainly reproduced stands out."""
    told = escape(outcome.verdict)
    return told if outcome.verdict == "reproduced" else f"<strong>{told}</strong>"
