"""What an absorber is to the rest of a powertrain."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from torsional.arguments import checked_fields
from torsional.components import Component, GearPair
from torsional.errors import ModelError
from torsional.stamps import Stamp


@dataclass(frozen=True)
@checked_fields
class Absorber:
    """Named ``components`` between an ``input`` node (crankshaft side) and an ``output`` node (clutch side).

    ``springs`` names the connections whose twist is the absorber's travel; ``nodes`` are the bodies that may carry
    more parts, a pendulum for one.  ``detail``: parts that stand beside these in the time domain, or in place of those
    of the same name, where the absorber has inner parts that linear and periodic analyses do without.

    >>> from torsional.absorbers import single_mass_flywheel
    >>> single_mass_flywheel(1.9).components["flywheel"].inertia
    1.9
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

    def between(self, start: str, end: str) -> Absorber:
        """A copy whose ``input`` and ``output`` are two other nodes, rigidly joined to those it has.

        Raises ModelError for a name that is taken, and where one node would be both ends of its springs.

        >>> from torsional.absorbers import single_mass_flywheel
        >>> list(single_mass_flywheel(1.9).between("crank", "clutch").components)
        ['flywheel', 'input_joint', 'output_joint']
        """
        if start == end and self.input != self.output:
            remedy = "begin with a model whose crankshaft and clutch are on two nodes"
            raise ModelError("one node would be both ends of the absorber", where=start, remedy=remedy)
        ends = {(start, self.input): "input_joint", (end, self.output): "output_joint"}  # one joint if both are alike
        joints = {name: GearPair(*pair, 1.0) for pair, name in ends.items() if pair[0] != pair[1]}
        within = {node for part in self._stamps() for node in part.weights}
        for joint in joints.values():
            if joint.a in within:
                remedy = "name input and output as the model does, or this part otherwise"
                raise ModelError("the model has another node by this name", where=joint.a, remedy=remedy)
        return replace(self.joined(joints), input=start, output=end)

    def _stamps(self) -> Iterator[Stamp]:
        for name, part in {**self.components, **self.detail}.items():
            yield from part.stamps(name)

    def with_detail(self, parts: Mapping[str, Component], kind: str = "") -> Absorber:
        """A copy with its inner parts; those that are as in ``components`` are left out."""
        own = {name: part for name, part in parts.items() if self.components.get(name) != part}
        return replace(self, detail=own, kind=kind or self.kind)
