"""One finding: a sentence and the values it tells."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class Finding:
    """A sentence and the values it tells, in SI, by name; ``kind`` says what it is about."""

    kind: str
    text: str
    values: Mapping[str, float] = field(default_factory=dict)
