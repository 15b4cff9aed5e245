"""Calls in compiled functions: of mathematics, of tuples with names, of other compiled functions, of laws."""

from __future__ import annotations

import ast
import functools
import inspect
from collections.abc import Callable, Hashable
from typing import TYPE_CHECKING, Any

from torsional.exchange.translation.functions import BY_NAME, EXTREME, TWO, WHOLE
from torsional.exchange.translation.kinds import DOUBLE, INT, LAW, Block, Group, tuple_of, wider
from torsional.exchange.translation.terms import Term, number
from torsional.numerics.callbacks import RETURNED, law_at

if TYPE_CHECKING:
    from torsional.exchange.translation.expressions import Expressions

TOLD = tuple_of([DOUBLE] * RETURNED)
"""What a law's kernel gives back."""


def called(of: Expressions, node: ast.Call) -> Term:
    """A call as a term."""
    target = of.term(node.func)
    if target.kind == LAW:
        return Term(f"{target.text}({', '.join(_law_arguments(of, node))})", TOLD)
    if target.text:
        raise of.refused(node, "only functions are called")
    known = target.known
    if known is law_at:
        return Term(f"law_at({of.as_kind(node, of.number(node.args[0]), INT)})", LAW)
    if isinstance(known, type) and issubclass(known, tuple):
        return _group(of, node, known)
    if (function := python_of(known)) is not None:
        return _function(of, node, function)
    return _mathematics(of, node, known)


def python_of(known: Any) -> Callable[..., Any] | None:
    """The Python function behind a compiled one, or one that compiled code may call; None for anything else."""
    found = getattr(known, "py_func", known)
    return found if inspect.isfunction(found) else None


def _law_arguments(of: Expressions, node: ast.Call) -> list[str]:
    first, *rest = of.values(node.args)
    return [first.text, *(of.as_kind(node, one, DOUBLE) for one in rest)]


def _ordered(of: Expressions, node: ast.Call, names: list[str]) -> list[Term | None]:
    """The arguments in the order of their names; None for one that is left out."""
    listed = of.values(node.args)
    given: dict[str, Term] = dict(zip(names, listed, strict=False))
    for keyword in node.keywords:
        given[str(keyword.arg)] = of.value(keyword.value)
    if len(listed) > len(names) or set(given) - set(names):
        raise of.refused(node, "the arguments do not fit")
    return [given.get(name) for name in names]


def _group(of: Expressions, node: ast.Call, made: Any) -> Term:
    """A tuple with names, made of its parts."""
    parts = _ordered(of, node, list(made._fields))
    if None in parts:
        raise of.refused(node, "every field is told")
    found = [part for part in parts if part is not None]
    kind = Group(made.__name__, tuple((name, part.kind) for name, part in zip(made._fields, found, strict=True)), True)
    kind = of.program.declare(kind)
    return Term(f"({kind.name}){{{', '.join(part.text for part in found)}}}", kind)


def _function(of: Expressions, node: ast.Call, function: Callable[..., Any]) -> Term:
    """Another compiled function, translated for the kinds of these arguments."""
    parameters = inspect.signature(function).parameters
    terms: list[Term] = []
    for (name, told), term in zip(parameters.items(), _ordered(of, node, list(parameters)), strict=True):
        if term is None and told.default is inspect.Parameter.empty:
            raise of.refused(node, f"'{name}' is not told")
        terms.append(number(told.default) if term is None else term)
    made = of.program.function(function, [term.kind for term in terms])
    return Term(f"{made.name}({', '.join(_passed(of, node, term) for term in terms)})", made.kind)


def _passed(of: Expressions, node: ast.Call, term: Term) -> str:
    """An argument as C takes it: tuples with names by their address."""
    if not (isinstance(term.kind, Group) and term.kind.named):
        return term.text
    if term.text.endswith(")") and not term.text.startswith("("):
        raise of.refused(node, "a tuple that a function gives back has a name before it is handed on")
    return f"&{term.text}"


def _mathematics(of: Expressions, node: ast.Call, known: Any) -> Term:
    if known is len and len(node.args) == 1 and isinstance(told := of.term(node.args[0]).known, tuple):
        return number(len(told))
    if not isinstance(known, Hashable):
        raise of.refused(node, "only functions are called")
    terms = of.values(node.args)
    if known is abs and len(terms) == 1:
        return Term(f"fabs({terms[0].text})" if terms[0].kind == DOUBLE else f"llabs({terms[0].text})", terms[0].kind)
    if known in EXTREME and len(terms) > 1:
        return functools.reduce(lambda a, b: _extreme(of, node, EXTREME[known], a, b), terms)
    if known is len and len(terms) == 1 and isinstance(terms[0].kind, Block):
        return Term(f"{terms[0].text}.n[0]", INT)
    if known is float and len(terms) == 1:
        return Term(of.as_kind(node, terms[0], DOUBLE), DOUBLE)
    if known in BY_NAME and len(terms) == 1:
        return Term(f"{BY_NAME[known]}({of.as_kind(node, terms[0], DOUBLE)})", DOUBLE)
    if known in TWO and len(terms) == 2:
        return Term(f"{TWO[known]}({', '.join(of.as_kind(node, term, DOUBLE) for term in terms)})", DOUBLE)
    if known in WHOLE and len(terms) == 1:
        return Term(f"(int64_t)({WHOLE[known]}({terms[0].text}))", INT)
    raise of.refused(node, "no C is written for this function")


def _extreme(of: Expressions, node: ast.Call, name: str, a: Term, b: Term) -> Term:
    kind = wider(a.kind, b.kind)
    if kind is None or kind not in (INT, DOUBLE):
        raise of.refused(node, "numbers are compared")
    ending = "double" if kind == DOUBLE else "int"
    return Term(f"{name}_{ending}({of.as_kind(node, a, kind)}, {of.as_kind(node, b, kind)})", kind)
