"""A program in C, translated from compiled functions for the kinds of values that they are called with."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from torsional.exchange.translation.calls import TOLD, python_of
from torsional.exchange.translation.kinds import DOUBLE, INT, LAW, NOTHING, Group, Kind, block
from torsional.exchange.translation.statements import Statements
from torsional.exchange.translation.terms import Term, UntranslatableError, number

ROUNDS = 8
_WORDS = """
    auto break case char const continue default do double else enum extern float for goto if inline int long register
    restrict return short signed sizeof static struct switch typedef union unsigned void volatile while bool true
    false law_at law_function exp log log10 sqrt sin cos tan sinh cosh tanh expm1 log1p asin acos atan atan2 fabs
    floor ceil copysign hypot pow fmod llabs least most left_int left_double floor_int floor_double whole_power
    least_int least_double most_int most_double I NAN INFINITY
"""
_TAKEN = frozenset(_WORDS.split())
"""Names that a variable in C must not have."""


class Made(NamedTuple):
    """A translated function: its ``name`` in C and the ``kind`` of what it gives back."""

    name: str
    kind: Kind


class Program:
    """Grows function by function; ``text`` is what there is of it."""

    def __init__(self) -> None:
        self._made: dict[tuple[object, tuple[Kind, ...]], Made | None] = {}
        self._groups: dict[str, Group] = {}
        self._tables: dict[tuple[float, ...], Term] = {}
        self._names: set[str] = set()
        self._told: list[str] = []
        self._laws: list[str] = []
        self.declare(TOLD)

    @property
    def text(self) -> str:
        """The program in C."""
        return "\n".join(self._told) + "\n"

    def variable(self, name: str, kind: Kind) -> str:
        """What a variable of Python is called in C."""
        plain = "".join(c if c.isascii() else f"u{ord(c):x}" for c in name)
        return plain + "_" if plain in _TAKEN or plain.startswith("kept_") else plain

    def declare(self, kind: Kind) -> Any:
        """Declare a tuple, and those within it first; the kind itself."""
        if not isinstance(kind, Group):
            return kind
        known = self._groups.get(kind.name)
        if known is None:
            for _, part in kind.fields:
                self.declare(part)
            fields = " ".join(f"{part.name} {name};" for name, part in kind.fields)
            self._told.append(f"typedef struct {{ {fields} }} {kind.name};")
            self._groups[kind.name] = kind
        elif known != kind:
            raise UntranslatableError("one tuple has fields of two kinds", where=kind.name)
        return kind

    def table(self, values: Sequence[float] | Any) -> Term:
        """Numbers that are there already, as an array."""
        row = np.asarray(values)
        kind = block(DOUBLE if row.dtype.kind == "f" else INT, 1)
        if row.ndim != 1 or not row.size or row.dtype.kind not in "fiu":
            raise UntranslatableError("a row of numbers is wanted", found=repr(values)[:60])
        key = (float(kind.item is DOUBLE), *row.tolist())
        if key not in self._tables:
            name, told = f"table_{len(self._tables)}", ", ".join(number(v).text for v in row.tolist())
            self._told.append(f"static {kind.item.name} {name}[] = {{{told}}};")
            self._tables[key] = Term(f"({kind.name}){{{name}, {{{row.size}}}}}", kind)
        return self._tables[key]

    def laws(self, kernels: Sequence[Callable[..., Any]]) -> None:
        """Translate kernels of laws and number them for ``law_at``; once, before what calls them."""
        took = [block(DOUBLE, 1), *(DOUBLE,) * 4]
        made = [self.function(kernel, took) for kernel in kernels]
        for kernel, own in zip(kernels, made, strict=True):
            if own.kind != TOLD:
                name = getattr(kernel, "__name__", repr(kernel))
                raise UntranslatableError("a law's kernel gives back eight floats", where=name, found=own.kind.name)
        listed = ", ".join(own.name for own in made) or "0"
        self._told += [
            f"typedef {TOLD.name} (*{LAW.name})(f1, double, double, double, double);",
            f"static const {LAW.name} laws[] = {{{listed}}};",
            f"static inline {LAW.name} law_at(int64_t number) {{ return laws[number]; }}",
        ]

    def function(self, function: Callable[..., Any], kinds: Sequence[Kind]) -> Made:
        """A function translated for arguments of these kinds, with all that it calls.

        Raises UntranslatableError for what is not the plain arithmetic of compiled functions.
        """
        python = python_of(function)
        if python is None:
            raise UntranslatableError("this is no function of Python", found=repr(function)[:60])
        key = (python, tuple(kinds))
        if key not in self._made:
            self._made[key] = None
            self._made[key] = self._translated(python, list(kinds))
        found = self._made[key]
        if found is None:
            raise UntranslatableError("a function calls itself", where=python.__name__, remedy="write a loop")
        return found

    def _translated(self, python: Callable[..., Any], kinds: list[Kind]) -> Made:
        node, scope = _source(python), {**inspect.getclosurevars(python).nonlocals}
        scope = {**getattr(python, "__globals__", {}), **scope}
        names = [one.arg for one in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)]
        if node.args.vararg or node.args.kwarg or len(names) != len(kinds):
            raise UntranslatableError("the arguments do not fit", where=python.__name__, found=f"{len(kinds)} values")
        for kind in kinds:
            self.declare(kind)
        parameters, found = dict(zip(names, kinds, strict=True)), dict(zip(names, kinds, strict=True))
        returned: Kind | None = None
        for _ in range(ROUNDS):
            before, seen = dict(found), returned
            written = Statements(self, python.__name__, scope, found, returned)
            self._spell(written, parameters)
            written.body(node.body)
            returned = written.returned
            if before == found and seen == returned:
                break
        return self._finished(python.__name__, written, parameters, returned or NOTHING)

    def _spell(self, written: Statements, parameters: dict[str, Kind]) -> None:
        """Tuples with names come by their address, so that they are read as what is there."""
        pointed = {name for name, kind in parameters.items() if isinstance(kind, Group) and kind.named}
        plain = self.variable
        written.spelled = lambda name, kind: f"(*{plain(name, kind)})" if name in pointed else plain(name, kind)

    def _finished(self, python: str, written: Statements, parameters: dict[str, Kind], returned: Kind) -> Made:
        name = f"k_{python.strip('_')}"
        while name in self._names:
            name += "_"
        self._names.add(name)
        taken = ", ".join(self._parameter(own, kind) for own, kind in parameters.items()) or "void"
        local = {own: kind for own, kind in written.kinds.items() if own not in parameters}
        for own, kind in parameters.items():
            if written.kinds[own] != kind:
                raise UntranslatableError(f"'{own}' is given a value of another kind", where=python)
        declared = [f"    {kind.name} {self.variable(own, kind)} = {_nothing(kind)};" for own, kind in local.items()]
        head = f"static {returned.name} {name}({taken})"
        self._told.append("\n".join(["", head, "{", *declared, *written.lines, "}"]))
        return Made(name, returned)

    def _parameter(self, name: str, kind: Kind) -> str:
        spelled = self.variable(name, kind)
        return f"const {kind.name} *{spelled}" if isinstance(kind, Group) and kind.named else f"{kind.name} {spelled}"


def _nothing(kind: Kind) -> str:
    return "{0}" if kind.name not in ("double", "int64_t", "bool", LAW.name) else "0"


def _source(python: Callable[..., Any]) -> ast.FunctionDef:
    """The syntax of a function."""
    try:
        found = ast.parse(textwrap.dedent(inspect.getsource(python))).body[0]
    except (OSError, SyntaxError, TypeError) as error:
        remedy = "write the function in a file, so that it can be read there"
        raise UntranslatableError("the source is not to be had", where=python.__name__, remedy=remedy) from error
    if not isinstance(found, ast.FunctionDef):
        raise UntranslatableError("a function written with def is wanted", where=python.__name__)
    return found
