"""Small faults of a file: one operator, comparison or number changed at a time.

What no user could meet is not drawn:
- words and types: messages, annotations, imports for the type checker, and drawings, which are looked at by eye;
- guards against round-off: a number in a formula below ROUND_OFF, and < in place of ≤ beside a number with a point
  that is not 0, which differ at one last bit only;
- `strict=`, which raises where the program contradicts itself, and never makes a number.
A constant in capitals with its reason below it is a judgement, as 20 steps or 1 % are: it is changed by DECADE.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from validation.tools.callers import function_of
from validation.tools.faulty import ROOT

DECADE, ROUND_OFF = 10, 1e-9
OPERATORS: dict[type[ast.AST], type[ast.AST]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.FloorDiv: ast.Mult,
    ast.Pow: ast.Mult, ast.Mod: ast.Mult, ast.And: ast.Or, ast.Or: ast.And, ast.Lt: ast.GtE, ast.GtE: ast.Lt,
    ast.Gt: ast.LtE, ast.LtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
    ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
NAMES = {"min": "max", "max": "min", "argmin": "argmax", "argmax": "argmin", "ceil": "floor", "floor": "ceil"}
SKIPPED = (ast.Assert, ast.Raise, ast.JoinedStr, ast.Import, ast.ImportFrom)
"""Words and types: no fault of these makes a wrong number."""
BORDERS = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt}


@dataclass(frozen=True)
class Mutant:
    """One change: the file, the line and its text, what becomes what, and the whole new text of the file."""

    file: str
    line: int
    text: str
    change: str
    source: str
    function: str

    @property
    def name(self) -> tuple[str, str, str]:
        """What stays the same when lines above are added."""
        return self.file, self.text, self.change


Change = tuple[str, Callable[[], None], Callable[[], None]]


def is_measured(node: ast.AST) -> bool:
    """Whether a number with a point, but not 0, is in the formula: it is never met to the last bit."""
    return any(isinstance(one, ast.Constant) and isinstance(one.value, float) and one.value for one in ast.walk(node))


def changes(node: ast.AST, factor: int = 2) -> Iterator[Change]:
    """(words, do, undo) of every change of this node itself; numbers are multiplied by the factor."""

    def swap(owner: Any, field: str, new: Any, words: str) -> Change:
        old = getattr(owner, field)
        return words, lambda: setattr(owner, field, new), lambda: setattr(owner, field, old)

    match node:
        case ast.BinOp(op=op) | ast.AugAssign(op=op) | ast.BoolOp(op=op) if type(op) in OPERATORS:
            new = OPERATORS[type(op)]
            yield swap(node, "op", new(), f"{type(op).__name__} → {new.__name__}")
        case ast.Compare(left=left, ops=[op], comparators=[right]) if type(op) in OPERATORS:
            new = OPERATORS[type(op)]
            yield swap(node, "ops", [new()], f"{type(op).__name__} → {new.__name__}")
            border = next((other for kind, other in BORDERS.items() if isinstance(op, kind)), None)
            if border is not None and not (is_measured(left) or is_measured(right)):
                yield swap(node, "ops", [border()], f"{type(op).__name__} → {border.__name__}")
        case ast.UnaryOp(op=ast.USub()):
            yield swap(node, "op", ast.UAdd(), "−x → x")
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            yield swap(node, "operand", ast.UnaryOp(ast.Not(), operand), "not x → x")
        case ast.Constant(value=bool(value)):
            yield swap(node, "value", not value, f"{value} → {not value}")
        case ast.Constant(value=int(value) | float(value)) if value == 0 or abs(value) > ROUND_OFF:
            yield swap(node, "value", factor * value if value else 1, f"{value:g} → {factor * value if value else 1:g}")
        case ast.Name(id=name) if name in NAMES:
            yield swap(node, "id", NAMES[name], f"{name} → {NAMES[name]}")
        case ast.Attribute(attr=name) if name in NAMES:
            yield swap(node, "attr", NAMES[name], f"{name} → {NAMES[name]}")


def is_type_checking(node: ast.AST) -> bool:
    """Whether it is `if TYPE_CHECKING:`."""
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"


def draws(node: ast.AST) -> bool:
    """Whether it is a function that draws: it takes or returns a figure or axes."""
    if not isinstance(node, ast.FunctionDef):
        return False
    told = [node.returns, *(one.annotation for one in node.args.args)]
    return any(word in ast.unparse(one) for one in told if one for word in ("Figure", "Axes"))


def inner(node: ast.AST) -> Iterator[ast.AST]:
    """The node and all below it whose change may make a wrong number: no annotations, no words, no types."""
    if isinstance(node, SKIPPED) or is_type_checking(node) or draws(node):
        return
    if isinstance(node, ast.keyword) and node.arg in ("strict", "encoding"):
        return
    yield node
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST):
                yield from inner(child)


def judgements(tree: ast.Module) -> set[ast.AST]:
    """All parts of constants in capitals that are followed by a text of their own."""
    found: set[ast.AST] = set()
    for node, after in zip(tree.body, tree.body[1:], strict=False):
        told = isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
        if told and isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name | ast.Tuple):
            found |= set(ast.walk(node.value))
    return found


def mutants(file: str) -> list[Mutant]:
    """Every mutant of a file."""
    source = (ROOT / file).read_text(encoding="utf-8")
    tree, lines = ast.parse(source), source.splitlines()
    judged, found = judgements(tree), []
    for node in inner(tree):
        line = getattr(node, "lineno", 0)
        for words, do, undo in changes(node, DECADE if node in judged else 2):
            function = function_of(tree, line)
            do()
            text = ast.unparse(ast.fix_missing_locations(tree))
            found.append(Mutant(file, line, lines[line - 1].strip(), words, text, function))
            undo()
    return found
