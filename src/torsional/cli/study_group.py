"""`torsional study NAME`: a command a tool, its options read off the tool's signature when it is asked for."""

from __future__ import annotations

import inspect
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, get_args, get_origin, get_type_hints

import typer
from typer.core import TyperGroup

from torsional.cli import options as o
from torsional.cli import typed
from torsional.cli.jobs import Job, job
from torsional.errors import ModelError, nearest

if TYPE_CHECKING:
    from torsional.studies.base import Tool

COMMON = {"changes": o.Changes, "as_json": o.Json, "output": o.Output, "quiet": o.Quiet}
"""The options that every study has."""


@dataclass(frozen=True)
class Option:
    """An option of a tool: its ``name`` in Python, the ``kind`` of one value, ``many`` of them or one, the ``quantity``
    that says the unit of a plain number, what it is in ``words``, and its ``default``."""

    name: str
    kind: type
    many: bool
    quantity: str
    words: str
    default: Any

    @property
    def flag(self) -> str:
        """As it is typed."""
        return "--" + self.name.replace("_", "-")

    @property
    def declared(self) -> Any:
        """The option as typer takes it: texts, which are read with their units later; a switch where it is one."""
        if self.kind is bool:
            return Annotated[bool, typer.Option(self.flag, help=_sentence(self.words))]
        unit = typed.unit_of(self.quantity) if self.quantity else "-"
        parts = [f"{self.words}{'' if unit == '-' else f' [{unit}]'}{', several as 1,2,3' if self.many else ''}"]
        if self.default not in (None, "") or "default" not in self.words.replace("empty:", "default"):
            parts.append(f"default: {self._shown_default()}")
        help = _sentence("; ".join(parts))
        metavar = "TEXT" if self.kind is str else "VALUES" if self.many else "VALUE"
        return Annotated[str, typer.Option(self.flag, metavar=metavar, help=help, show_default=False)]

    def _shown_default(self) -> str:
        if self.default in (None, ""):
            return "from the truck"
        listed = self.default if self.many else (self.default,)
        return ",".join(each if isinstance(each, str) else f"{self._as_typed(each):.4g}" for each in listed)

    def _as_typed(self, value: float) -> float:
        unit = typed.unit_of(self.quantity) if self.quantity else "-"
        return value if unit == "-" else value / typed.read(f"1 {unit}", self.quantity, self.flag)

    def read(self, text: Any) -> Any:
        """The value of what was typed [SI]; ModelError for what cannot be."""
        if self.kind is bool or self.kind is str:
            return text
        values = [self._one(part.strip()) for part in text.split(",")] if self.many else [self._one(text)]
        return tuple(values) if self.many else values[0]

    def _one(self, text: str) -> Any:
        value = typed.read(text, self.quantity or "ratio", self.flag)
        if self.kind is not int:
            return value
        if value != round(value):
            raise ModelError("a whole number is wanted", where=self.flag, found=text)
        return round(value)


def options_of(tool: Tool) -> list[Option]:
    """The options of a tool, in the order of its signature."""
    hints = get_type_hints(tool.question, include_extras=True)
    listed = list(inspect.signature(tool.question).parameters.values())[1:]
    return [_option(parameter.name, hints[parameter.name], parameter.default) for parameter in listed]


def _option(name: str, hint: Any, default: Any) -> Option:
    hint, *told = get_args(hint) if get_origin(hint) is Annotated else (hint, "")
    quantity, words = told if len(told) == 2 else ("", told[0])
    kinds = [kind for kind in get_args(hint) if kind is not type(None)] if type(None) in get_args(hint) else [hint]
    many = get_origin(kinds[0]) is tuple
    return Option(name, get_args(kinds[0])[0] if many else kinds[0], many, quantity, words, default)


def _sentence(text: str) -> str:
    return text[:1].upper() + text[1:].rstrip(".") + "."


class StudyGroup(TyperGroup):
    """The studies as commands; nothing of them is imported before one is asked for, or their list."""

    def list_commands(self, ctx: Any) -> list[str]:
        """The names of all studies."""
        from torsional.studies.register import tools

        return list(tools())

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """The command of one study; ModelError where there is none of the name."""
        from torsional.studies.register import tools

        if cmd_name not in tools():
            raise ModelError("there is no such study", found=repr(cmd_name), remedy=nearest(cmd_name, tools()))
        return _command(tools()[cmd_name])


def _command(tool: Tool) -> Any:
    listed = options_of(tool)

    def asked(model: Path | None = None, **typed_in: Any) -> Job:
        common = {key: typed_in.pop(key) for key in COMMON}
        return job("study", name=tool.name, model=model, given=_given(listed, typed_in), **common)

    own = {option.name: (option.declared, False if option.kind is bool else "") for option in listed}
    kept = {name: (kind, False if name in ("as_json", "quiet") else None) for name, kind in COMMON.items()}
    signed = {"model": (o.StudyModel, None), **own, **kept}
    asked.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
        [_parameter(name, kind, default) for name, (kind, default) in signed.items()]
    )
    asked.__annotations__ = {name: kind for name, (kind, _) in signed.items()}
    asked.__doc__ = inspect.getdoc(tool.question)
    one = typer.Typer(rich_markup_mode=None, add_completion=False)
    one.command(name=tool.name, help=_help(tool))(asked)
    return typer.main.get_command(one)


def _parameter(name: str, kind: Any, default: Any) -> inspect.Parameter:
    return inspect.Parameter(name, inspect.Parameter.POSITIONAL_OR_KEYWORD, default=default, annotation=kind)


def _help(tool: Tool) -> str:
    return f"{tool.about}\n\n{_sentence(f'Varies {tool.varies}')}"


def _given(listed: Sequence[Option], typed_in: Mapping[str, Any]) -> dict[str, Any]:
    """What was typed, without the options that were left alone."""
    return {o.name: o.read(typed_in[o.name]) for o in listed if typed_in[o.name] not in ("", None, False)}
