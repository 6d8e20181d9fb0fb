"""Claim: names and docstrings of the installed code stay as readable as they are; the limits may only be lowered.

A pronoun names nothing, a number at the head of a module is far from its use, and a docstring of three words or one
that points elsewhere leaves a reader alone. Tests go through public doors, so that rooms can be rebuilt behind them.
"""

import ast
import re
from collections import Counter
from collections.abc import Iterator

from tests.scenes import ROOT

PRONOUNS = {
    "found", "one", "ones", "own", "at", "other", "others", "beside", "said", "it", "its", "them", "that", "there",
    "here", "such", "same", "so", "all", "both", "each", "what", "which", "way", "told",
}  # fmt: skip
POINTS_ELSEWHERE = re.compile(
    r"(the same|see |as above|likewise|ditto|both ways|of (it|them|these|those)\b)", re.IGNORECASE
)
MOST = {"constants": 143, "pronouns": 0, "short docstrings": 0, "docstrings that point elsewhere": 0,
        "functions without a docstring": 2, "long functions": 0, "numbers": 1090}  # fmt: skip
LONGEST = 60
PLAIN = (0, 0.5, 1, 2)
"""Numbers that are not counted."""
INNER = re.compile(r"contact1d\.workflow(?!\.(?:laws|units|errors))|contact1d import workflow")
MOST_INNER = 0.25
"""Of the text of tests, in files that import inner rooms."""


def modules() -> Iterator[ast.Module]:
    for room in ("workflow", "analysis", "potentials", "src"):
        for path in sorted((ROOT / room).rglob("*.py")):
            if not any(parent.is_symlink() for parent in path.parents):
                yield ast.parse(path.read_text(encoding="utf-8"))


def constants_in(node: ast.stmt) -> int:
    """How many names in capitals a statement of a module gives to numbers."""
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
    names = [name for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)]
    numbers = [leaf for leaf in ast.walk(node) if isinstance(leaf, ast.Constant) and type(leaf.value) in (int, float)]
    return sum(name.id.isupper() for name in names) if numbers else 0


def names_bound_by(node: ast.AST) -> list[str]:
    """Names that a node gives: of a function, its arguments, a variable."""
    if isinstance(node, ast.FunctionDef):
        return [node.name, *(one.arg for one in [*node.args.args, *node.args.kwonlyargs])]
    return [node.id] if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) else []


def counted() -> Counter[str]:
    counts: Counter[str] = Counter()
    for module in modules():
        counts["constants"] += sum(map(constants_in, module.body))
        for node in ast.walk(module):
            counts["pronouns"] += sum(name in PRONOUNS for name in names_bound_by(node))
            if isinstance(node, ast.FunctionDef):
                counts["functions without a docstring"] += not ast.get_docstring(node)
                counts["long functions"] += (node.end_lineno or 0) - node.lineno > LONGEST
            if isinstance(node, ast.Constant) and type(node.value) in (int, float):
                counts["numbers"] += node.value not in PLAIN
            text = ast.get_docstring(node) if isinstance(node, ast.FunctionDef | ast.ClassDef) else None
            if text:
                first = text.split("\n\n")[0].replace("\n", " ")
                counts["short docstrings"] += len(first.split()) <= 3
                counts["docstrings that point elsewhere"] += bool(POINTS_ELSEWHERE.match(first))
    return counts


def test_the_code_is_no_harder_to_read_than_it_was() -> None:
    counts = counted()
    assert {name: counts[name] for name in MOST if counts[name] > MOST[name]} == {}


def test_most_tests_go_through_public_doors() -> None:
    sizes: Counter[bool] = Counter()
    for path in (ROOT / "tests").rglob("*.py"):
        text = path.read_text(encoding="utf-8")
        sizes[bool(INNER.search(text))] += len(text)
    assert sizes[True] <= MOST_INNER * sizes.total()
