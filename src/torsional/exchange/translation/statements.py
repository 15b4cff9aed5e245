"""Statements of compiled functions in C."""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from torsional.exchange.translation.expressions import Expressions
from torsional.exchange.translation.kinds import BOOL, DOUBLE, INT, NOTHING, Block, Group, Kind, wider
from torsional.exchange.translation.terms import Term

if TYPE_CHECKING:
    from torsional.exchange.translation.program import Program

INDENT = "    "


class Statements(Expressions):
    """The body of one function; read until its variables' kinds and what it gives back, ``returned``, stay."""

    def __init__(
        self, program: Program, name: str, scope: Mapping[str, Any], kinds: dict[str, Kind], returned: Kind | None
    ) -> None:
        super().__init__(program, name, scope, kinds)
        self.returned, self.lines, self.depth, self.made = returned, list[str](), 1, 0

    def write(self, line: str) -> None:
        """One line of C."""
        self.lines.append(INDENT * self.depth + line)

    def body(self, statements: Sequence[ast.stmt]) -> None:
        """Statements one after the other."""
        for node in statements:
            made = getattr(self, f"_{type(node).__name__.lower()}", None)
            if made is None:
                raise self.refused(node, "no C is written for this statement")
            made(node)

    def _within(self, statements: Sequence[ast.stmt]) -> None:
        self.depth += 1
        self.body(statements)
        self.depth -= 1

    def _temporary(self, kind: Kind, text: str) -> str:
        self.made += 1
        name = f"kept_{self.made}"
        self.write(f"{kind.name} {name} = {text};")
        return name

    def _pass(self, node: ast.Pass) -> None:
        pass

    def _break(self, node: ast.Break) -> None:
        self.write("break;")

    def _continue(self, node: ast.Continue) -> None:
        self.write("continue;")

    def _expr(self, node: ast.Expr) -> None:
        if isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            return  # what the function says of itself
        if not isinstance(node.value, ast.Call):
            raise self.refused(node, "the expression does nothing")
        self.write(f"{self.term(node.value).text};")

    def _return(self, node: ast.Return) -> None:
        if node.value is None:
            self.returned = self.returned or NOTHING
            self.write("return;")
            return
        told = self.value(node.value)
        kind = told.kind if self.returned is None else wider(self.returned, told.kind)
        if kind is None:
            raise self.refused(node, "a function gives back values of one kind")
        self.returned = self.program.declare(kind) if isinstance(kind, Group) else kind
        self.write(f"return {self.as_kind(node, told, kind)};")

    def _if(self, node: ast.If) -> None:
        self.write(f"if ({self.test(node.test).text}) {{")
        self._within(node.body)
        if node.orelse:
            self.write("} else {")
            self._within(node.orelse)
        self.write("}")

    def _while(self, node: ast.While) -> None:
        self._refuse_else(node, node.orelse)
        self.write(f"while ({self.test(node.test).text}) {{")
        self._within(node.body)
        self.write("}")

    def _for(self, node: ast.For) -> None:
        self._refuse_else(node, node.orelse)
        if not (isinstance(node.iter, ast.Call) and self.term(node.iter.func).known is range):
            raise self.refused(node, "loops go over range")
        given = [self.number(one) for one in node.iter.args]
        if node.iter.keywords or any(one.kind == DOUBLE for one in given) or not isinstance(node.target, ast.Name):
            raise self.refused(node, "loops go over whole numbers, one at a time")
        first, last = ("0", given[0].text) if len(given) == 1 else (given[0].text, given[1].text)
        step = given[2].known if len(given) == 3 else 1
        if not isinstance(step, int) or step == 0:
            raise self.refused(node, "the step of a loop is a whole number that is there already")
        name, end = self._variable(node, node.target, INT), self._temporary(INT, last)
        count = self._temporary(INT, first)
        self.write(f"for (; {count} {'<' if step > 0 else '>'} {end}; {count} += {step}) {{")
        self.depth += 1
        self.write(f"{name} = {count};")
        self.body(node.body)
        self.depth -= 1
        self.write("}")

    def _refuse_else(self, node: ast.AST, statements: Sequence[ast.stmt]) -> None:
        if statements:
            raise self.refused(node, "no C is written for a loop's else")

    def _variable(self, node: ast.AST, name: ast.Name, kind: Kind) -> str:
        """A variable that is given a value of this kind."""
        known = self.kinds.get(name.id, kind)
        joined = wider(known, kind)
        if joined is None:
            raise self.refused(node, f"'{name.id}' is of one kind throughout, and no {kind.name} after a {known.name}")
        self.kinds[name.id] = joined
        return self.spelled(name.id, joined)

    def _assign(self, node: ast.Assign) -> None:
        for target in node.targets:
            if isinstance(target, ast.Tuple):
                self._unpack(node, target)
                return
        told = self.value(node.value)
        if len(node.targets) > 1:
            told = Term(self._temporary(told.kind, told.text), told.kind)
        for target in node.targets:
            self._put(node, target, told)

    def _annassign(self, node: ast.AnnAssign) -> None:
        if node.value is None:
            raise self.refused(node, "a name is given a value")
        self._put(node, node.target, self.value(node.value))

    def _unpack(self, node: ast.Assign, target: ast.Tuple) -> None:
        """Values side by side, all of them worked out before the first is put in its place."""
        if len(node.targets) > 1:
            raise self.refused(node, "one row of names is given values at once")
        if isinstance(node.value, ast.Tuple):
            parts = [self.value(one) for one in node.value.elts]
            kept = [part if part.known is not None else self._kept(part) for part in parts]
        else:
            told = self.value(node.value)
            if not isinstance(told.kind, Group):
                raise self.refused(node, "a tuple is wanted here")
            whole = self._temporary(told.kind, told.text)
            kept = [Term(f"{whole}.{name}", kind) for name, kind in told.kind.fields]
        if len(kept) != len(target.elts):
            raise self.refused(node, f"{len(target.elts)} names for {len(kept)} values")
        for one, term in zip(target.elts, kept, strict=True):
            self._put(node, one, term)

    def _kept(self, term: Term) -> Term:
        return Term(self._temporary(term.kind, term.text), term.kind)

    def _put(self, node: ast.AST, target: ast.expr, told: Term) -> None:
        """A value in its place."""
        if isinstance(target, ast.Name):
            name = self._variable(node, target, told.kind)
            self.write(f"{name} = {self.as_kind(node, told, self.kinds[target.id])};")
        elif isinstance(target, ast.Subscript) and isinstance(target.slice, ast.Slice):
            self._fill(node, target, told)
        elif isinstance(target, ast.Subscript):
            place = self.number(target)
            self.write(f"{place.text} = {self.as_kind(node, told, place.kind)};")
        else:
            raise self.refused(node, "values go to names and places of arrays")

    def _fill(self, node: ast.AST, target: ast.Subscript, told: Term) -> None:
        """One number in all places of an array."""
        whole, cut = self.value(target.value), target.slice
        empty = isinstance(cut, ast.Slice) and cut.lower is None and cut.upper is None and cut.step is None
        if not isinstance(whole.kind, Block) or not empty or whole.kind.dims != 1:
            raise self.refused(node, "an array of one dimension is filled as a whole")
        value = self.as_kind(node, told, whole.kind.item)
        self.write(f"for (int64_t k_ = 0; k_ < {whole.text}.n[0]; k_++) {whole.text}.p[k_] = {value};")

    def _augassign(self, node: ast.AugAssign) -> None:
        if not isinstance(node.target, ast.Name | ast.Subscript):
            raise self.refused(node, "values go to names and places of arrays")
        told = self.operated(node, self.number(node.target), node.op, self.number(node.value))
        if isinstance(node.target, ast.Name) and self.kinds.get(node.target.id) == BOOL and told.kind == INT:
            self._variable(node, node.target, INT)
        self._put(node, node.target, told)
