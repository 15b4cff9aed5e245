"""What every component offers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from torsional.stamps import Stamp


class Component(Protocol):
    """Anything that yields stamps under the name it is given in a powertrain."""

    def stamps(self, name: str) -> Iterator[Stamp]:
        """The stamps of this component when it is called ``name``."""
        ...
