"""The words of messages, docstrings and pages: standard terms, and none of the paraphrases that they replace."""

import ast
import re
from collections.abc import Iterator

import pytest

from tests.scenes import ROOT

TERMS = {
    r"let(s|ting)? go\b": "separates, pull-off, premature detachment",
    r"torn off": "snap-out, instability",
    r"\b(?-i:[Tt]ooth|[Tt]eeth)\b": "maxima of the force, instabilities",
    r"Tabor('s)? number": "Tabor parameter",
    r"is known to (?!fail|be)|known (less well|no better)": "uncertainty, uncertain by",
    r"how it comes near|comes? nearer to the limit": "convergence, order of convergence",
    r"what (the|a|its) (lattice|spacing|cells) leaves?|leaves? open of": "discretisation error",
    r"what (the|its) rows miss": "sampling error",
    r"what (the|a) minimi[sz]er leaves|left by the minimi[sz]er": "residual",
    r"what is left out": "truncation error, cutoff error",
    r"sideways": "tangential, lateral",
    r"by a hair": "within the tolerance",
    r"rows follow|follow each other without time": "quasi-static",
    r"\bcalm(er|ly|s|ing)?\b(?!_)": "at rest, in equilibrium, relaxed",
    r"what helps": "suggested fix, use …",
    r"\b(is|are|was|were|be) told\b|told (of|before)": "reported, printed, stated",
    r"(drawn|prescribed|held) way": "displacement control, load control",
    r"area of (a|the|its) loop": "hysteresis, dissipated energy",
    r"largest tension (that )?(it|they|a contact|the contact|held)": "pull-off force, force maximum",
    r"answers? to the hand": "interactive",
    r"installation (is (not )?)?whole": "installed correctly, complete",
    r"where it has it\b(?! )": "contact edge, cohesive zone",
    r"sums over arms|Prony's sums": "Prony series",
    r"go on for ?ever|endless(ly)?": "periodic; too large",
    r"under (this )?heat|without heat|heat alone": "thermal fluctuations, at a temperature, with noise",
    r"nothing beside": "too small compared with",
    r"the (drive's|whole) way|way along x|way of a (run|slide)": "path, loading history, distance",
    r"no more of it than that|in the same go": "(say it in one clause)",
    r"wide beside|small beside|thin beside|short beside": "small compared with",
    r"swings? once": "period",
    r"\bmoving pictures?\b": "animation",
    r"what is asked for|asked-for": "required",
}
"""A pattern without a legitimate use, and the standard terms."""
WORD = re.compile("|".join(f"(?P<t{i}>{pattern})" for i, pattern in enumerate(TERMS)), re.IGNORECASE)
PAGES = ("README.md", "VALIDATION.md", "CONTRIBUTING.md", "CHANGELOG.md")
TEXTS = [*(ROOT / page for page in PAGES), *(ROOT / "docs").rglob("*.md"), *(ROOT / "lammps_inputs").rglob("*.lmp")]
CODE = [path for folder in ("workflow", "analysis", "potentials", "src") for path in (ROOT / folder).rglob("*.py")]


def found_in(text: str, first_line: int = 1) -> Iterator[tuple[int, str]]:
    """The line and the remedy of each paraphrase; one that goes over the end of a line is found, too."""
    for found in WORD.finditer(re.sub(r"\s", " ", text)):
        term = list(TERMS.values())[int(str(found.lastgroup)[1:])]
        yield first_line + text.count("\n", 0, found.start()), f"{found[0]!r}: write {term}"


def strings(source: str) -> Iterator[tuple[int, str]]:
    """Each string literal of a module, docstrings among them, with the line where it begins."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.lineno, node.value


def test_pages_and_fragments_use_standard_terms() -> None:

    wrong = [
        f"{path.relative_to(ROOT)}:{line}: {what}"
        for path in TEXTS
        for line, what in found_in(path.read_text(encoding="utf-8"))
    ]
    assert not wrong, "\n".join(wrong)


def test_messages_and_docstrings_use_standard_terms() -> None:
    wrong = [
        f"{path.relative_to(ROOT)}:{line}: {what}"
        for path in CODE
        for begin, text in strings(path.read_text(encoding="utf-8"))
        for line, what in found_in(text, begin)
    ]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("text", ["the contact lets go", "moves\nsideways", "Tabor's number", "is told before the run"])
def test_a_paraphrase_is_found_across_lines(text: str) -> None:
    assert list(found_in(text))
