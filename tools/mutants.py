"""Small mistakes that could be made in a source file, each a change of one place in its text.

Left alone: docstrings and other texts, annotations, decorators, what is raised and how it is worded.  A change that
leaves the syntax tree as it was is none.
"""

from __future__ import annotations

import ast
import random
import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

SWAPS: dict[type[ast.AST], tuple[str, str]] = {
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "/"),
    ast.Div: ("/", "*"),
    ast.FloorDiv: ("//", "/"),
    ast.Mod: ("%", "*"),
    ast.Pow: ("**", "*"),
    ast.MatMult: ("@", "*"),
    ast.BitAnd: ("&", "|"),
    ast.BitOr: ("|", "&"),
}
COMPARISONS: dict[type[ast.AST], tuple[str, tuple[str, ...]]] = {
    ast.Lt: ("<", ("<=", ">")),
    ast.LtE: ("<=", ("<", ">=")),
    ast.Gt: (">", (">=", "<")),
    ast.GtE: (">=", (">", "<=")),
    ast.Eq: ("==", ("!=",)),
    ast.NotEq: ("!=", ("==",)),
    ast.Is: ("is", ("is not",)),
    ast.IsNot: ("is not", ("is",)),
    ast.In: ("in", ("not in",)),
    ast.NotIn: ("not in", ("in",)),
}
LEFT_ALONE = re.compile(r"Error$|partial$|njit|uncounted|inlined|warn|cast$")
"""Calls whose arguments are words, types or settings of the compiler."""
GENEROUS = 16
"""Counts from here on are likely to be limits of passes or numbers of samples."""
TINY = 1e-5
"""Constants below this are tolerances and guards: a mutant there that survives may well do what the source did."""


class Mutant(NamedTuple):
    """A change of the bytes ``start`` to ``stop`` of a file; ``place``: the function, class or constant it lies in."""

    file: str
    place: str
    line: int
    kind: str
    start: int
    stop: int
    old: str
    new: str
    equal: str = ""
    """Why it may do what the source did; empty where nothing speaks for it."""

    def applied(self, source: bytes) -> bytes:
        """The changed source."""
        return source[: self.start] + self.new.encode() + source[self.stop :]


class _Finder:
    def __init__(self, file: str, source: bytes) -> None:
        self.file, self.source = file, source
        self.starts = [0]
        for line in source.splitlines(keepends=True):
            self.starts.append(self.starts[-1] + len(line))

    def span(self, node: ast.AST) -> tuple[int, int]:
        n: ast.expr = node  # type: ignore[assignment]
        return self.starts[n.lineno - 1] + n.col_offset, self.starts[(n.end_lineno or 0) - 1] + (n.end_col_offset or 0)

    def text(self, node: ast.AST) -> str:
        start, stop = self.span(node)
        return self.source[start:stop].decode()

    def made(self, place: str, kind: str, span: tuple[int, int], new: str, equal: str = "") -> Mutant:
        start, stop = span
        line = self.source.count(b"\n", 0, start) + 1
        return Mutant(self.file, place, line, kind, start, stop, self.source[start:stop].decode(), new, equal)

    def between(self, left: ast.AST, right: ast.AST, word: str) -> tuple[int, int] | None:
        """The place of an operator between two operands."""
        start, stop = self.span(left)[1], self.span(right)[0]
        gap = re.sub(rb"#[^\n]*", lambda found: b" " * len(found[0]), self.source[start:stop])
        edge = rb"\b" if word[0].isalpha() else b""
        found = re.search(edge + re.escape(word.encode()).replace(rb"\ ", rb"\s+") + edge, gap)
        return (start + found.start(), start + found.end()) if found else None

    def of(self, node: ast.AST, place: str) -> Iterator[Mutant]:
        """Mutants of one node itself."""
        if isinstance(node, ast.BinOp) and type(node.op) in SWAPS and not _text(node.left) and not _text(node.right):
            word, new = SWAPS[type(node.op)]
            yield from self._replaced(place, "arithmetic", self.between(node.left, node.right, word), new)
        elif isinstance(node, ast.AugAssign) and type(node.op) in SWAPS:
            word, new = SWAPS[type(node.op)]
            yield from self._replaced(place, "arithmetic", self.between(node.target, node.value, word + "="), new + "=")
        elif isinstance(node, ast.Compare):
            yield from self._compared(node, place)
        elif isinstance(node, ast.BoolOp):
            word, new = ("and", "or") if isinstance(node.op, ast.And) else ("or", "and")
            yield from self._replaced(place, "condition", self.between(node.values[0], node.values[1], word), new)
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.Not):
            kind = "sign" if isinstance(node.op, ast.USub) else "condition"
            yield self.made(place, kind, self.span(node), f"({self.text(node.operand)})")
        elif isinstance(node, ast.If | ast.IfExp | ast.While):
            yield self.made(place, "condition", self.span(node.test), f"(not ({self.text(node.test)}))")
        elif isinstance(node, ast.Constant):
            yield from self._constant(node, place)
        elif isinstance(node, ast.Call):
            yield from self._swapped(node, place)
        yield from self._removed(node, place)

    def _replaced(self, place: str, kind: str, span: tuple[int, int] | None, new: str) -> Iterator[Mutant]:
        if span is not None:
            yield self.made(place, kind, span, new)

    def _compared(self, node: ast.Compare, place: str) -> Iterator[Mutant]:
        operands = [node.left, *node.comparators]
        for i, operator in enumerate(node.ops):
            word, news = COMPARISONS[type(operator)]
            span = self.between(operands[i], operands[i + 1], word)
            for new in news if span else ():
                boundary = new.strip("=") == word.strip("=") and new != word
                whole = any(isinstance(o, ast.Constant) and type(o.value) is int for o in operands)
                why = "a boundary that real numbers rarely meet" if boundary and not whole else ""
                yield self.made(place, "boundary" if boundary else "comparison", span or (0, 0), new, why)

    def _constant(self, node: ast.Constant, place: str) -> Iterator[Mutant]:
        value, text = node.value, self.text(node)
        if isinstance(value, bool):
            yield self.made(place, "constant", self.span(node), str(not value))
        elif isinstance(value, int):
            why = "a count that may be generous" if value >= GENEROUS else ""
            for other in (value + 1, value - 1):
                yield self.made(place, "constant", self.span(node), str(other) if other >= 0 else f"({other})", why)
        elif isinstance(value, float):
            why = "a tolerance or a guard" if 0.0 < value < TINY else ""
            for new in (f"(2.0 * {text})", f"(0.5 * {text})") if value else ("1.0",):
                yield self.made(place, "constant", self.span(node), new, why)

    def _swapped(self, node: ast.Call, place: str) -> Iterator[Mutant]:
        if any(isinstance(a, ast.Starred) for a in node.args):
            return
        for left, right in zip(node.args, node.args[1:], strict=False):
            if ast.dump(left) != ast.dump(right) and not _text(left) and not _text(right):
                (start, middle), (begin, stop) = self.span(left), self.span(right)
                comma = self.source[middle:begin].decode()
                why = "the order may not matter" if _symmetric(node) else ""
                yield self.made(place, "arguments", (start, stop), self.text(right) + comma + self.text(left), why)

    def _removed(self, node: ast.AST, place: str) -> Iterator[Mutant]:
        stored = isinstance(node, ast.Assign) and not isinstance(node.targets[0], ast.Name | ast.Tuple)
        called = isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
        if stored or called or isinstance(node, ast.AugAssign | ast.Raise | ast.Continue | ast.Break):
            start, stop = self.span(node)
            yield self.made(place, "statement", (start, stop), "pass" + "\n" * self.source.count(b"\n", start, stop))


def _text(node: ast.AST) -> bool:
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


def _symmetric(node: ast.Call) -> bool:
    name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
    return name in ("max", "min", "maximum", "minimum", "hypot", "allclose", "isclose", "intersect1d", "union1d")


def mutants(file: str, source: bytes) -> list[Mutant]:
    """All mutants of a file, in the order of its text; some may be no change, see `is_change`."""
    finder = _Finder(file, source)
    found = {m for node, place in _mutable(ast.parse(source)) for m in finder.of(node, place)}
    return sorted(found, key=lambda m: (m.start, m.stop, m.new))


def is_change(mutant: Mutant, source: bytes) -> bool:
    """Whether Python understands the changed source, and as something else than before."""
    try:
        return ast.dump(ast.parse(mutant.applied(source))) != ast.dump(ast.parse(source))
    except (SyntaxError, ValueError):
        return False


def _mutable(tree: ast.Module) -> Iterator[tuple[ast.AST, str]]:
    """Nodes that may be changed, with the function, class or constant that each lies in."""

    def below(node: ast.AST, place: str) -> Iterator[tuple[ast.AST, str]]:
        for field, value in ast.iter_fields(node):
            if field in ("decorator_list", "annotation", "returns", "type_comment", "exc"):
                continue
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST):
                    yield from visited(child, place)

    def visited(node: ast.AST, place: str) -> Iterator[tuple[ast.AST, str]]:
        if isinstance(node, ast.Import | ast.ImportFrom | ast.JoinedStr | ast.arg):
            return
        if isinstance(node, ast.Expr) and _text(node.value):
            return
        if isinstance(node, ast.Call) and LEFT_ALONE.search(ast.unparse(node.func)):
            return
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            inner = place if "()" in place else f"{place}.{node.name}" if place else node.name
            closed = inner if isinstance(node, ast.ClassDef) else inner + "()"
            yield from below(node, closed)
            return
        if not place:
            place = _constant_name(node)
            if not place:
                return
        yield node, place.replace("()", "")
        yield from below(node, place)

    for node in tree.body:
        yield from visited(node, "")


def _constant_name(node: ast.AST) -> str:
    target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", None)
    name = target.id if isinstance(target, ast.Name) else ""
    return "" if name == "__all__" else name


def drawn(files: Iterable[tuple[str, bytes]], count: int, seed: int) -> list[Mutant]:
    """So many mutants at random: a line first, each that can be changed as likely as any other, then one on it."""
    sources = dict(files)
    lines: dict[tuple[str, int], list[Mutant]] = {}
    for file, source in sources.items():
        for mutant in mutants(file, source):
            lines.setdefault((file, mutant.line), []).append(mutant)
    chance, found = random.Random(seed), []
    order = chance.sample(sorted(lines), len(lines))
    for line in order:
        options = chance.sample(lines[line], len(lines[line]))
        found += [m for m in options if is_change(m, sources[m.file])][:1]
        if len(found) == count:
            break
    return found
