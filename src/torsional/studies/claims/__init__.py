"""The thesis's claims as studies: `CLAIMS` maps each id to a `Study`, loaded when it is first asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import TYPE_CHECKING

from torsional.studies.claims.base import Claim, Finding, Outcome, Study

if TYPE_CHECKING:
    from torsional.studies.claims.trucks import Trucks

__all__ = ["CLAIMS", "Claim", "Finding", "Outcome", "Study", "judged"]

_THEMES = {
    "excitation": "A1 A13 A15",
    "resonances": "A2 A3 A4 A6 A7 A8",
    "comparison": "A10 A11 A14",
    "power_split": "C1 C2 C3 C6",
    "planetary": "C4 C5",
    "friction": "A5 A9",
    "stages": "A12",
    "subharmonic": "B1 B2 B3 B4",
    "coexistence": "B5",
    "idle": "B6",
    "tuned": "D1 D2 D3 D4",
    "hysteresis": "F3",
    "arc_losses": "F4",
    "time_stepping": "E1",
    "longer_steps": "E2",
    "pendulum": "G1",
    "start_up": "G2",
    "engagement": "G3",
}
_WHERE = dict(sorted((id, theme) for theme, ids in _THEMES.items() for id in ids.split()))
_ORDER = sorted(_WHERE, key=lambda id: (id[0], int(id[1:])))


class _Register(Mapping[str, Study]):
    """Studies by claim id; a theme is imported when one of its claims is asked for."""

    def __getitem__(self, id: str) -> Study:
        module = import_module(f"{__name__}.{_WHERE[id]}")
        study: Study = getattr(module, id.lower())
        return study

    def __iter__(self) -> Iterator[str]:
        return iter(_ORDER)

    def __len__(self) -> int:
        return len(_ORDER)


CLAIMS: Mapping[str, Study] = _Register()


def judged(trucks: Trucks) -> list[Outcome]:
    """Every claim judged on these trucks, in the order of the ids."""
    return [CLAIMS[id](trucks) for id in CLAIMS]
