"""Reference pages of the two faces, the command line and the model file, written from what they accept."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

Schema = Mapping[str, Any]


# --- the command line ---


def command_line_page(program: Any) -> str:
    """Every command with its arguments and options, from the program itself."""
    parts = ["# Command line", _cell(program.help), "`torsional COMMAND --help` says the same at the terminal."]
    parts.append("\n".join(f"* [`{name}`](#torsional-{name}): {_cell(c.help)}" for name, c in program.commands.items()))
    for name, command in program.commands.items():
        parts += [f"(torsional-{name})=\n## `torsional {name}`", _cell(command.help), _parameters(command)]
        parts += _members(name, command)
    return "\n\n".join(parts) + "\n"


def _members(name: str, group: Any) -> list[str]:
    """The commands of a command that has some."""
    parts = []
    for member in group.list_commands(None) if hasattr(group, "list_commands") else []:
        command = group.get_command(None, member)
        head = f"(torsional-{name}-{member})=\n### `torsional {name} {member}`"
        parts += [head, _cell(command.help), _parameters(command)]
    return parts


def _parameters(command: Any) -> str:
    rows = [
        f"| {_spelling(p)} | {_cell(p.help or '')}{_shown_default(p)} |" for p in command.params if p.name != "help"
    ]
    return "\n".join(["| argument or option | meaning |", "| --- | --- |", *rows]) if rows else ""


def _spelling(parameter: Any) -> str:
    """`--gear`, `-g` NAME, as it is typed."""
    if parameter.param_type_name == "argument":
        return f"`{_cell(parameter.metavar or parameter.name.upper())}`"
    names = ", ".join(
        f"`{name}`" for name in sorted([*parameter.opts, *parameter.secondary_opts], key=len, reverse=True)
    )
    return names if parameter.is_flag else f"{names} {_cell(parameter.metavar or '')}"


def _shown_default(parameter: Any) -> str:
    plain = parameter.default in (None, "", False) or callable(parameter.default) or parameter.required
    return "" if plain else f" Default: `{parameter.default}`."


# --- the model file ---


def model_file_page(schema: Schema) -> str:
    """Every block and key of a model file, from its JSON schema."""
    parts = ["# Model file", _ABOUT_FILES, "## The whole file", _cell(schema["description"]), _keys(schema)]
    for name, block in schema["$defs"].items():
        parts += [f"(block-{_anchor(name)})=\n## {_spaced(name)}", _told(block), _keys(block)]
    return "\n\n".join(parts) + "\n"


_ABOUT_FILES = """A model file is YAML 1.2 (or JSON). A plain number is in the SI unit named here; any other unit is
written behind the number, as in `25 kNm/rad`, `600 rpm`, `131 mm`. A key that is not listed is refused, and the nearest
one is named.
`torsional schema` prints the same as a JSON schema, for editors."""


def _told(block: Schema) -> str:
    return _cell(block.get("description", ""))


def _keys(block: Schema) -> str:
    required = set(block.get("required", ()))
    rows = [_key(name, told, name in required) for name, told in block.get("properties", {}).items()]
    return "\n".join(["| key | value | default | meaning |", "| --- | --- | --- | --- |", *rows])


def _key(name: str, told: Schema, required: bool) -> str:
    default = told.get("default")
    shown = "required" if required else "" if default in (None, "", {}, []) else f"`{default}`"
    return f"| `{name}` | {'; '.join(dict.fromkeys(_values(told)))} | {shown} | {_cell(_meaning(told))} |"


def _meaning(told: Schema) -> str:
    """The description, looked for in the alternatives where the key itself has none."""
    found = [told.get("description", ""), *(part.get("description", "") for part in told.get("anyOf", ()))]
    return next(filter(None, found), "")


def _values(told: Schema) -> Iterator[str]:
    """What may be written, alternative by alternative."""
    if "$ref" in told:
        name = told["$ref"].rsplit("/", 1)[-1]
        yield f"[{_spaced(name).lower()}](#block-{_anchor(name)})"
    elif "x-quantity" in told:
        yield from _quantity(told)
    elif "const" in told or "enum" in told:
        yield ", ".join(f"`{value}`" for value in told.get("enum", [told.get("const")]))
    elif "oneOf" in told or "anyOf" in told:
        for part in told.get("oneOf", told.get("anyOf")):
            yield from _values(part)
    elif "items" in told:
        yield f"list of {' or '.join(dict.fromkeys(_values(told['items'])))}"
    elif "additionalProperties" in told:
        yield f"by name: {', '.join(dict.fromkeys(_values(told['additionalProperties'])))}"
    elif told.get("type") != "null":
        yield _WORDS.get(told.get("type", ""), "value") + _limits(told)


_WORDS = {"string": "text", "integer": "whole number", "number": "number", "boolean": "`true` or `false`"}


def _quantity(told: Schema) -> Iterator[str]:
    from torsional.units import QUANTITIES

    unit = QUANTITIES[told["x-quantity"]].unit
    numbers = list(_numbers(told))
    limits = next((text for number in numbers if (text := _limits(number))), "")
    what = "number" if unit == "-" else unit
    yield f"{what}{limits}" + (", or a list" if any("items" in part for part in _parts(told)) else "")


def _parts(told: Schema) -> Iterator[Schema]:
    """A schema and all its alternatives."""
    yield told
    for part in told.get("anyOf", ()):
        yield from _parts(part)


def _numbers(told: Schema) -> Iterator[Schema]:
    for part in _parts(told):
        if part.get("type") in ("number", "integer"):
            yield part
        elif isinstance(part.get("items"), Mapping):
            yield from _numbers(part["items"])


_LIMITS = {"exclusiveMinimum": ">", "minimum": "≥", "exclusiveMaximum": "<", "maximum": "≤"}


def _limits(told: Schema) -> str:
    return "".join(f" {sign} {told[key]:g}" for key, sign in _LIMITS.items() if key in told)


def _anchor(name: str) -> str:
    return _spaced(name).lower().replace(" ", "-")


def _spaced(name: str) -> str:
    """CrankDamper as Crank damper."""
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name.removesuffix("Block")).lower()
    return words[:1].upper() + words[1:]


def _cell(text: str | None) -> str:
    """Text on one line that a table's cell may hold."""
    return re.sub(r"\s+", " ", text or "").strip().replace("|", "\\|").replace("*", "\\*").replace("<", "\\<")
