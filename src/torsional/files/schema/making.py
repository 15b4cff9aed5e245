"""Blocks that make what they describe, and the choice between all that there are of a kind."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, ClassVar, TypeVar, Union, cast, get_args

from pydantic import Field

from torsional.errors import ModelError
from torsional.files.schema.fields import Block

Kind = TypeVar("Kind", bound=Block)


class Making(Block):
    """A block that stands for one thing; its keys are what ``makes`` is called with, unless it says otherwise."""

    makes: ClassVar[Callable[..., Any]]
    apart: ClassVar[tuple[str, ...]] = ("type",)
    """Keys that are not handed over."""

    def made(self) -> Any:
        """The thing itself; ModelError, with the key path from this block on, where it cannot be."""
        return type(self).makes(**self.values())

    def values(self) -> dict[str, Any]:
        """The keys that are given: blocks as what they make, lists as tuples."""
        own = {key: getattr(self, key) for key in type(self).model_fields if key not in self.apart}
        return {key: _value(key, value) for key, value in own.items() if value is not None}


def _value(key: str, value: Any) -> Any:
    if not isinstance(value, Making):
        return tuple(value) if isinstance(value, list) else value
    try:
        return value.made()
    except ModelError as error:
        raise error.located(prefix=key) from None


def choice(base: type[Block]) -> Any:
    """One of all blocks derived from ``base`` that have a type of their own, told apart by it."""
    return Annotated[cast("Any", Union)[tuple(kinds(base))], Field(discriminator="type")]


def kinds(base: type[Kind]) -> list[type[Kind]]:
    """All blocks derived from ``base`` that have a type of their own."""
    own = [base] if "type" in base.model_fields else []
    return own + [leaf for kind in base.__subclasses__() for leaf in kinds(kind)]


def tags(base: type[Block]) -> list[str]:
    """The types that a file may name, in the order of the alphabet."""
    return sorted(tag for kind in kinds(base) for tag in get_args(kind.model_fields["type"].annotation))
