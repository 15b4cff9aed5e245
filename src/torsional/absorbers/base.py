"""What an absorber is to the rest of a powertrain."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from torsional.components import Component
from torsional.errors import ModelError


@dataclass(frozen=True)
class Absorber:
    """Named ``components`` between an ``input`` node (crankshaft side) and an ``output`` node (clutch side).

    ``springs`` names the connections whose twist is the absorber's travel; ``nodes`` are the bodies that may carry
    more parts, a pendulum for one.
    """

    kind: str
    components: Mapping[str, Component]
    input: str
    output: str
    springs: tuple[str, ...] = ()
    nodes: tuple[str, ...] = ()

    def joined(self, parts: Mapping[str, Component], kind: str = "") -> Absorber:
        """A copy with more components; raises ModelError on a name that is taken."""
        taken = sorted(set(parts) & set(self.components))
        if taken:
            raise ModelError("the name is taken", where=taken[0], remedy="give the part another name")
        return replace(self, components={**self.components, **parts}, kind=kind or self.kind)
