"""What an absorber is to the rest of a powertrain."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from torsional.components import Component
from torsional.errors import ModelError


@dataclass(frozen=True)
class Absorber:
    """Named ``components`` between an ``input`` node (crankshaft side) and an ``output`` node (clutch side).

    ``springs`` names the connections whose twist is the absorber's travel; ``nodes`` are the bodies that may carry
    more parts, a pendulum for one.  ``detail``: parts that stand beside these in the time domain, or in place of those
    of the same name, where the absorber has inner parts that linear and periodic analyses do without.
    """

    kind: str
    components: Mapping[str, Component]
    input: str
    output: str
    springs: tuple[str, ...] = ()
    nodes: tuple[str, ...] = ()
    detail: Mapping[str, Component] = field(default_factory=dict)

    def joined(self, parts: Mapping[str, Component], kind: str = "") -> Absorber:
        """A copy with more components; raises ModelError on a name that is taken."""
        taken = sorted(set(parts) & ({*self.components, *self.detail}))
        if taken:
            raise ModelError("the name is taken", where=taken[0], remedy="give the part another name")
        return replace(self, components={**self.components, **parts}, kind=kind or self.kind)

    def with_detail(self, parts: Mapping[str, Component], kind: str = "") -> Absorber:
        """A copy with its inner parts; those that are as in ``components`` are left out."""
        own = {name: part for name, part in parts.items() if self.components.get(name) != part}
        return replace(self, detail=own, kind=kind or self.kind)
