"""Powertrain: named components, frozen, checked when it is made."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from types import MappingProxyType
from typing import Any

from torsional.arguments import checked
from torsional.components import Component
from torsional.errors import ModelError, nearest
from torsional.notebook import components_table
from torsional.stamps import GROUND, Stamp
from torsional.structure import Structure, resolve

_REFUSED = set(":=,;*?[]{}<>\"'`\\/|&\t\r\n")


@dataclasses.dataclass(frozen=True, eq=False)
class Powertrain:
    """Named components that hang together; nodes are the names the components give.

    ``components``: {name: component} (or pairs, in which a repeated name is refused); ``parts``: how many connected
    parts are meant, 2 with an open clutch; ``reference``: the node whose mean speed is the engine speed Ω (default: the
    first that turns).
    Raises ModelError, by name, for unknown, massless or disconnected nodes and for contradictory gears.

    >>> from torsional.components import Inertia, Shaft
    >>> discs = {"disc": Inertia(211.4), "rotor": Inertia(8.3)}
    >>> pair = Powertrain({**discs, "shaft": Shaft("disc", "rotor", stiffness=9.775e6)})
    >>> pair.replaced("shaft", damping=30.0)["shaft"].damping
    30.0
    """

    components: Mapping[str, Component]
    parts: int = 1
    reference: str = ""

    @checked
    def __init__(
        self,
        components: Mapping[str, Component] | Iterable[tuple[str, Component]],
        parts: int = 1,
        reference: str = "",
    ) -> None:
        pairs = list(components.items() if isinstance(components, Mapping) else components)
        for name, component in pairs:
            _checked_name(name, component)
        names = [name for name, _ in pairs]
        repeated = [name for name in dict.fromkeys(names) if names.count(name) > 1]
        if repeated:
            raise ModelError("two components have the same name", where=repeated[0], remedy="rename one of them")
        object.__setattr__(self, "components", MappingProxyType(dict(pairs)))
        object.__setattr__(self, "parts", parts)
        object.__setattr__(self, "reference", reference)
        _ = self.structure

    @cached_property
    def stamps(self) -> tuple[Stamp, ...]:
        """The stamps of all components, in order; part names must not collide."""
        stamps = tuple(s for name, component in self.components.items() for s in component.stamps(name))
        names = [(type(stamp), stamp.name) for stamp in stamps]
        if len(set(names)) < len(names):
            repeated = next(name for kind, name in names if names.count((kind, name)) > 1)
            raise ModelError("two components have a part of the same name", where=repeated)
        return stamps

    @cached_property
    def structure(self) -> Structure:
        """Nodes, connected parts, coordinates and speed ratios."""
        return resolve(self.stamps, self.parts, self.reference)

    @property
    def nodes(self) -> tuple[str, ...]:
        """Every node, in the order in which the components name them."""
        return self.structure.nodes

    def speed_ratio(self, node: str) -> float:
        """Mean speed of a node over that of the reference node."""
        if node not in self.nodes:
            raise ModelError(f"there is no node '{node}'", where=node, remedy=nearest(node, self.nodes))
        return float(self.structure.speed_ratio[self.nodes.index(node)])

    def __getitem__(self, name: str) -> Any:
        """The component of that name."""
        return named(self.components, name)

    def __iter__(self) -> Iterator[str]:
        return iter(self.components)

    def replaced(self, name: str, component: Component | None = None, **changes: Any) -> Powertrain:
        """A copy with one component exchanged, or with some of its fields changed."""
        return Powertrain(exchanged(self.components, name, component, changes), self.parts, self.reference)

    def joined(self, parts: Mapping[str, Component]) -> Powertrain:
        """A copy with more components; a name that is taken is refused."""
        return Powertrain([*self.components.items(), *parts.items()], self.parts, self.reference)

    def without(self, *names: str) -> Powertrain:
        """A copy without some components."""
        for name in names:
            _ = self[name]
        return Powertrain({n: c for n, c in self.components.items() if n not in names}, self.parts, self.reference)

    def described(self) -> list[dict[str, object]]:
        """One row a component: name, kind and its fields, for tables and reports."""
        rows = []
        for name, component in self.components.items():
            part: Any = component
            names = [field.name for field in dataclasses.fields(part)] if dataclasses.is_dataclass(part) else []
            values = {key: getattr(part, key) for key in names}
            rows.append({"name": name, "kind": type(component).__name__, **values})
        return rows

    def __repr__(self) -> str:
        return f"<Powertrain: {len(self.components)} components on {len(self.nodes)} nodes>"

    def _repr_html_(self) -> str:
        return components_table(repr(self)[1:-1], self.components)


def exchanged(
    components: Mapping[str, Component], name: str, component: Component | None, changes: Mapping[str, Any]
) -> dict[str, Component]:
    """Components with one of them exchanged for another ``component``, or with ``changes`` of its fields."""
    old = named(components, name)
    fields = [field.name for field in dataclasses.fields(old)] if dataclasses.is_dataclass(old) else []
    for key in changes:
        if key not in fields:
            raise ModelError(f"'{name}' has no field '{key}'", where=f"{name}.{key}", remedy=nearest(key, fields))
    try:
        return {**components, name: component or dataclasses.replace(old, **changes)}
    except ModelError as error:
        raise error.located(prefix=name) from None


def named(components: Mapping[str, Component], name: str) -> Any:
    """One component; raises ModelError with the nearest name."""
    if name not in components:
        raise ModelError(f"there is no component '{name}'", where=name, remedy=nearest(name, components))
    return components[name]


def _checked_name(name: object, component: object) -> None:
    if not isinstance(name, str) or not name.strip() or name != name.strip() or _REFUSED & set(name):
        allowed = "text without the marks " + " ".join(sorted(_REFUSED - set("\t\r\n")))
        raise ModelError("this cannot be a component's name", found=repr(name), allowed=allowed)
    if name == GROUND:
        raise ModelError("'ground' is the node that never moves", where=name, remedy="choose another name")
    if not callable(getattr(component, "stamps", None)):
        found = type(component).__name__
        raise ModelError("is not a component", where=name, found=found, allowed="Inertia, Shaft, GearPair, …")
