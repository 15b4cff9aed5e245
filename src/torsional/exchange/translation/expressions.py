"""Expressions of compiled functions in C."""

from __future__ import annotations

import ast
import builtins
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from torsional.exchange.translation.calls import called
from torsional.exchange.translation.kinds import BOOL, DOUBLE, INT, NUMBERS, Block, Group, Kind, block, tuple_of, wider
from torsional.exchange.translation.terms import Term, UntranslatableError, number, of_python

if TYPE_CHECKING:
    from torsional.exchange.translation.program import Program

_OPERATORS: Mapping[type[ast.operator], str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*"}
_WHOLE: Mapping[type[ast.operator], str] = {
    ast.BitOr: "|",
    ast.BitAnd: "&",
    ast.BitXor: "^",
    ast.LShift: "<<",
    ast.RShift: ">>",
}
_DIVIDED: Mapping[type[ast.operator], str] = {ast.FloorDiv: "floor", ast.Mod: "left"}
_COMPARED: Mapping[type[ast.cmpop], str] = {
    ast.Lt: "<",
    ast.LtE: "<=",
    ast.Gt: ">",
    ast.GtE: ">=",
    ast.Eq: "==",
    ast.NotEq: "!=",
}


class Expressions:
    """Expressions of one function, whose variables have the ``kinds`` found so far."""

    def __init__(self, program: Program, name: str, scope: Mapping[str, Any], kinds: dict[str, Kind]) -> None:
        self.program, self.name, self.scope, self.kinds = program, name, scope, kinds
        self.spelled: Callable[[str, Kind], str] = program.variable

    def refused(self, node: ast.AST, problem: str) -> UntranslatableError:
        """UntranslatableError, with function, line and source."""
        where = f"{self.name}, line {getattr(node, 'lineno', 0)}"
        remedy = "write numbers, indices, if, while, for over range, and calls of other compiled functions"
        return UntranslatableError(problem, where=where, found=ast.unparse(node)[:80], remedy=remedy)

    def term(self, node: ast.expr) -> Term:
        """What an expression is in C."""
        made = getattr(self, f"_{type(node).__name__.lower()}", None)
        if made is None:
            raise self.refused(node, "no C is written for this expression")
        found: Term = made(node)
        return found

    def value(self, node: ast.expr) -> Term:
        """A term that is there at run time."""
        found = self.term(node)
        if not found.text:
            raise self.refused(node, "this is no value of compiled code")
        return found

    def values(self, nodes: Sequence[ast.expr]) -> list[Term]:
        """Terms that are there at run time, those of a tuple with a star one by one."""
        found: list[Term] = []
        for node in nodes:
            of = self.value(node.value if isinstance(node, ast.Starred) else node)
            if not isinstance(node, ast.Starred):
                found.append(of)
            elif isinstance(of.kind, Group):
                found += [Term(f"{of.text}.{name}", kind) for name, kind in of.kind.fields]
            else:
                raise self.refused(node, "only tuples have a star")
        return found

    def number(self, node: ast.expr) -> Term:
        """A term that is a number."""
        found = self.value(node)
        if found.kind not in NUMBERS:
            raise self.refused(node, "a number is wanted here")
        return found

    def as_kind(self, node: ast.AST, term: Term, kind: Kind) -> str:
        """The text of a term where a ``kind`` is wanted; a tuple is written of its parts."""
        if term.kind == kind:
            return term.text
        if isinstance(kind, Group) and term.parts:
            fields = [own for _, own in kind.fields]
            return _literal(kind, [self.as_kind(node, p, k) for p, k in zip(term.parts, fields, strict=True)])
        if wider(term.kind, kind) != kind or kind not in NUMBERS:
            raise self.refused(node, f"a {kind.name} is wanted here, and this is a {term.kind.name or 'name'}")
        return f"({kind.name})({term.text})"

    def _constant(self, node: ast.Constant) -> Term:
        if not isinstance(node.value, bool | int | float):
            raise self.refused(node, "no C is written for this constant")
        return number(node.value)

    def _name(self, node: ast.Name) -> Term:
        if node.id in self.kinds:
            return Term(self.spelled(node.id, self.kinds[node.id]), self.kinds[node.id])
        if node.id in self.scope:
            return of_python(self.scope[node.id])
        if hasattr(builtins, node.id):
            return of_python(getattr(builtins, node.id))
        raise self.refused(node, "the name has no value here")

    def _attribute(self, node: ast.Attribute) -> Term:
        of = self.term(node.value)
        if isinstance(of.kind, Block) and node.attr == "size":
            return Term("*".join(f"{of.text}.n[{i}]" for i in range(of.kind.dims)), INT)
        if isinstance(of.kind, Group) and (kind := of.kind.kind_of(node.attr)) is not None:
            return Term(f"{of.text}.{node.attr}", kind)
        if not of.text and hasattr(of.known, node.attr):
            return of_python(getattr(of.known, node.attr))
        raise self.refused(node, "there is no such attribute in C")

    def _subscript(self, node: ast.Subscript) -> Term:
        if isinstance(node.value, ast.Attribute) and node.value.attr == "shape":
            return self._length(node, self.value(node.value.value))
        of = self.term(node.value)
        if not of.text and isinstance(of.known, tuple | np.ndarray):
            of = self.program.table(of.known)
        if isinstance(of.kind, Group):
            return self._field(node, of)
        if not isinstance(of.kind, Block):
            raise self.refused(node, "only arrays and tuples have indices")
        if isinstance(node.slice, ast.Slice):
            return self._slice(node, node.slice, of, of.kind)
        return self._element(node, of, of.kind)

    def _length(self, node: ast.Subscript, of: Term) -> Term:
        place = self.term(node.slice).known
        if not isinstance(of.kind, Block) or not isinstance(place, int) or not 0 <= place < of.kind.dims:
            raise self.refused(node, "the array has no such dimension")
        return Term(f"{of.text}.n[{place}]", INT)

    def _field(self, node: ast.Subscript, of: Term) -> Term:
        place = self.term(node.slice).known
        assert isinstance(of.kind, Group)
        if not isinstance(place, int) or not 0 <= place < len(of.kind.fields):
            raise self.refused(node, "a tuple's place is a number that is there already")
        name, kind = of.kind.fields[place]
        return Term(f"{of.text}.{name}", kind)

    def _slice(self, node: ast.Subscript, cut: ast.Slice, of: Term, kind: Block) -> Term:
        if kind.dims != 1 or cut.step is not None or cut.lower is None or cut.upper is None:
            raise self.refused(node, "slices are from one place to another, of arrays with one dimension")
        first, last = self.number(cut.lower).text, self.number(cut.upper).text
        return Term(f"({kind.name}){{{of.text}.p + ({first}), {{({last}) - ({first})}}}}", kind)

    def _element(self, node: ast.Subscript, of: Term, kind: Block) -> Term:
        given = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
        index = [self.number(one) for one in given]
        if len(index) > kind.dims or any(one.kind == DOUBLE for one in index):
            raise self.refused(node, "indices are whole numbers, no more than the array has dimensions")
        place = f"({index[0].text})"
        for i in range(1, kind.dims):
            place = f"({place})*{of.text}.n[{i}]" + (f" + ({index[i].text})" if i < len(index) else "")
        if len(index) == kind.dims:
            return Term(f"{of.text}.p[{place}]", kind.item)
        left = block(kind.item, kind.dims - len(index))
        sizes = ", ".join(f"{of.text}.n[{i}]" for i in range(len(index), kind.dims))
        return Term(f"({left.name}){{{of.text}.p + {place}, {{{sizes}}}}}", left)

    def _tuple(self, node: ast.Tuple) -> Term:
        parts = tuple(self.value(one) for one in node.elts)
        kind = tuple_of([part.kind for part in parts])
        self.program.declare(kind)
        return Term(_literal(kind, [part.text for part in parts]), kind, None, parts)

    def _unaryop(self, node: ast.UnaryOp) -> Term:
        if isinstance(node.op, ast.Not):
            return Term(f"(!{self.test(node.operand).text})", BOOL)
        of = self.number(node.operand)
        if isinstance(node.op, ast.Invert):
            raise self.refused(node, "no C is written for this sign")
        sign = "-" if isinstance(node.op, ast.USub) else "+"
        known = -of.known if sign == "-" and of.known is not None else of.known
        return Term(f"({sign}{of.text})", INT if of.kind == BOOL else of.kind, known)

    def _binop(self, node: ast.BinOp) -> Term:
        return self.operated(node, self.number(node.left), node.op, self.number(node.right))

    def operated(self, node: ast.AST, a: Term, op: ast.operator, b: Term) -> Term:
        """Two numbers and the sign between them."""
        kind = wider(wider(a.kind, b.kind) or DOUBLE, INT) or DOUBLE
        if (sign := _OPERATORS.get(type(op))) is not None:
            return Term(f"({a.text} {sign} {b.text})", kind)
        if isinstance(op, ast.Div):
            return Term(f"({self.as_kind(node, a, DOUBLE)} / {self.as_kind(node, b, DOUBLE)})", DOUBLE)
        if isinstance(op, ast.Pow):
            return self._power(node, a, b)
        if (name := _DIVIDED.get(type(op))) is not None:
            ending = "double" if kind == DOUBLE else "int"
            return Term(f"{name}_{ending}({a.text}, {b.text})", kind)
        if (sign := _WHOLE.get(type(op))) is not None and kind != DOUBLE:
            both = BOOL if a.kind == b.kind == BOOL and sign in "|&^" else INT
            return Term(f"({a.text} {sign} {b.text})", both)
        raise self.refused(node, "no C is written for this sign between these kinds")

    def _power(self, node: ast.AST, a: Term, b: Term) -> Term:
        base = self.as_kind(node, a, DOUBLE)
        if b.kind == DOUBLE:
            return Term(f"pow({base}, {b.text})", DOUBLE)
        if a.kind != DOUBLE:
            raise self.refused(node, "a power of a whole number; write it of a float")
        return Term(f"whole_power({base}, {b.text})", DOUBLE)

    def test(self, node: ast.expr) -> Term:
        """Whether something holds, of which any number but nought does."""
        if isinstance(node, ast.BoolOp):
            sign = " && " if isinstance(node.op, ast.And) else " || "
            return Term("(" + sign.join(self.test(one).text for one in node.values) + ")", BOOL)
        found = self.number(node)
        return found if found.kind == BOOL else Term(f"({found.text} != 0)", BOOL)

    def _boolop(self, node: ast.BoolOp) -> Term:
        if any(self.number(part).kind != BOOL for part in node.values):
            raise self.refused(node, "'and' and 'or' stand between comparisons")
        return self.test(node)

    def _compare(self, node: ast.Compare) -> Term:
        terms = [self.number(one) for one in (node.left, *node.comparators)]
        told = []
        for a, op, b in zip(terms[:-1], node.ops, terms[1:], strict=True):
            if type(op) not in _COMPARED:
                raise self.refused(node, "no C is written for this comparison")
            told.append(f"{a.text} {_COMPARED[type(op)]} {b.text}")
        return Term("(" + " && ".join(told) + ")", BOOL)

    def _ifexp(self, node: ast.IfExp) -> Term:
        test, a, b = self.test(node.test), self.value(node.body), self.value(node.orelse)
        kind = wider(a.kind, b.kind)
        if kind is None:
            raise self.refused(node, "both values of a choice are of one kind")
        if isinstance(kind, Group):
            self.program.declare(kind)
        first, second = self.as_kind(node, a, kind), self.as_kind(node, b, kind)
        return Term(f"({test.text} ? {first} : {second})", kind)

    def _call(self, node: ast.Call) -> Term:
        if any(k.arg is None for k in node.keywords):
            raise self.refused(node, "arguments are told one by one")
        return called(self, node)


def _literal(kind: Group, parts: Sequence[str]) -> str:
    return f"({kind.name}){{{', '.join(parts)}}}"
