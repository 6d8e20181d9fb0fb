"""Random faults: a share of all small ones is put into the code, one at a time, and the tests that reach it must fail.

    python -m validation.tools.mutants [--number 100] [--fragments 50] [--seed 1] [--out FILE]

A fault changes one operator, comparison or number in a copy of this checkout, in Python or in a fragment of a deck. A
trace says which tests call its function, or open its fragment; these run there, quick ones first, up to the first that
fails or LONGEST. The control: that test then passes in a copy without the fault. One that takes too long tells nothing.
A fault that is not noticed survives: it is printed and listed in results/mutants.json, with the reason if one was
written there by hand (kept for the same change). Faults of fragments, of `src` and of chained comparisons, which were
not drawn before 2026-11-27, are counted apart. What no user could meet is not drawn: messages, types, drawings (sizes
and colours, not what they show), `strict=` and `repr=`. Exit code 1 where fewer than ASKED of Python or of fragments
are noticed. Every processor has a share of the trace, and a fault at a time.
"""

import ast
import json
import math
import os
import random
import re
import sys
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from itertools import pairwise
from multiprocessing import get_context
from pathlib import Path
from types import CodeType, FrameType
from typing import Any, NamedTuple

import pytest
import typer

from validation.age import today
from validation.row import tables_beside
from validation.tools.copies import BROKEN, HANGS, ROOT, copy_of_this, first_failure, load, run_tests

RESULTS = Path(__file__).parents[1] / "results" / "mutants.json"
FOLDERS = ("workflow", "analysis", "potentials", "src")
FRAGMENTS = "lammps_inputs/fragments"
PYTHON, NEW, DECKS = "Python", "src, chained comparisons", "fragments"
"""The places that faults are drawn from."""
TESTS = ("tests/unit", "tests/decks", "tests/validation", "tests/contracts", "tests/hard")
ASKED = 0.85
"""Asked of the share that is noticed."""
LONGEST = 60.0
"""Time of the tests that look for one fault, as they took when traced [s]."""
SHARE, TRACED = 8, 3600.0
"""Files of tests that are traced in one process, and its time limit [s]."""
STARTING, SLOWNESS = 30.0, 4.0
"""Time limit of a test, and of a run: so much to start [s], and so many times what it took when traced."""
ROUND_OFF = 1e-9
"""A number below it guards against round-off."""
OPERATORS, NAMES, SIGNS, LOOKS = tables_beside(__file__).values()
FORMULA = re.compile(r'"[^"]*"|(?<=\bequal )[^"&\n]+|(?<=\batom )[^"&\n]+')
SIGN = re.compile(r"(?<=[\w)\]} ])(?:&&|\|\||[<>=!]=|[<>]|[-+*/])(?=[\w( $])")
NUMBER = re.compile(r"(?<![\w.$/{])\d+(?:\.\d*)?(?:e[-+]?\d+)?(?![\w./}])")
SIZES = ("[inch]", "[1/inch]", "[pt]")
"""Units of a constant of drawings."""
SKIPPED = (ast.Assert, ast.Raise, ast.JoinedStr, ast.Import, ast.ImportFrom)
"""Words and types: no fault of these makes a wrong number."""
Called = dict[str, tuple[float, list[str]]]
"""For each test its time [s] and the functions, file:name."""
CALLS = ".calls"
"""Where a trace is written."""
Change = tuple[str, Callable[[], None]]


class Mutant(NamedTuple):
    """One change: file, its number there, line, its text, what becomes what, the function it is in."""

    file: str
    number: int
    line: int
    text: str
    change: str
    function: str

    @property
    def place(self) -> str:
        """One of PYTHON, NEW, DECKS."""
        new = self.file.startswith("src") or " of a chain" in self.change
        return DECKS if self.file.startswith(FRAGMENTS) else NEW if new else PYTHON

    @property
    def source(self) -> str:
        """The whole new text of the file."""
        if self.place == DECKS:
            return list(of_fragment((ROOT / self.file).read_text(encoding="utf-8")))[self.number][2]
        tree = ast.parse((ROOT / self.file).read_text(encoding="utf-8"))
        [do for node, _ in inner(tree) for _, do in changes(node)][self.number]()
        return ast.unparse(ast.fix_missing_locations(tree))


class Trace:
    """A pytest plugin that notes which functions of a copy each test calls, and the fragments that it opens.

    What its fixtures do is included.
    """

    def __init__(self, folder: Path) -> None:
        """Nothing is noted yet."""
        self._root, self._names = f"{folder}{os.sep}", dict[CodeType, str]()
        self._now, self._failed, self._of_fixtures, self.found = set[str](), set[str](), dict[str, set[str]](), Called()
        sys.addaudithook(self.opened)

    def opened(self, event: str, arguments: tuple[Any, ...]) -> None:
        """Note a fragment that is opened."""
        if event == "open" and (path := str(arguments[0])).endswith(".lmp"):
            local = os.path.realpath(path).removeprefix(self._root)
            if local.startswith(FRAGMENTS):
                self._now.add(f"{local}:")

    def note(self, frame: FrameType, event: str, value: object) -> None:
        """A call."""
        code = frame.f_code
        if code not in self._names:
            local = os.path.realpath(code.co_filename).removeprefix(self._root)  # src/contact1d holds links
            ours = local.startswith(FOLDERS)
            self._names[code] = f"{local}:{code.co_qualname.split('.<locals>')[0]}" if ours else ""
        self._now.add(self._names[code])

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        """Trace the test; what is kept (`functools.cache`) is forgotten before it. One that fails tells nothing."""
        for module in [module for name, module in sys.modules.items() if name.startswith(("contact1d", "tests"))]:
            for kept in list(vars(module).values()):
                if callable(clear := getattr(kept, "cache_clear", None)):
                    clear()
        self._now, started = set(), time.monotonic()
        threading.settrace(self.note)
        sys.settrace(self.note)
        done = yield
        sys.settrace(None)
        if item.nodeid not in self._failed:
            reached = self._now | self._of_fixtures.get(item.nodeid.partition("::")[0], set())
            self.found[item.nodeid] = time.monotonic() - started, sorted(reached - {""})
        return done

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """What fails."""
        if report.failed:
            self._failed.add(report.nodeid)

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, request: pytest.FixtureRequest) -> Iterator[None]:
        """What a fixture of a file calls counts for every test of the file."""
        before, self._now = self._now, set()
        done = yield
        self._of_fixtures.setdefault(request.node.nodeid.partition("::")[0], set()).update(self._now)
        self._now |= before
        return done

    def pytest_sessionfinish(self) -> None:
        """Write what was found into the copy."""
        (Path(self._root) / CALLS).write_text(json.dumps(self.found), encoding="utf-8")


def traced(tests: Sequence[str]) -> Called:
    """What these tests call, where they pass."""
    with copy_of_this() as folder:
        run_tests(folder, tests, Trace(folder), TRACED)
        calls = folder / CALLS
        return Called(json.loads(calls.read_text(encoding="utf-8")) if calls.exists() else {})


def shares() -> list[list[str]]:
    """The files of TESTS, the rooms mixed: each share takes about as long."""
    files = [str(path.relative_to(ROOT)) for name in TESTS for path in sorted((ROOT / name).rglob("test_*.py"))]
    count = math.ceil(len(files) / SHARE)
    return [files[first::count] for first in range(count)]


def changes(node: ast.AST) -> Iterator[Change]:
    """Every change of this node itself: words, and what does it."""

    def swap(owner: Any, field: str, new: Any, words: str) -> Change:
        return words, lambda: setattr(owner, field, new)

    match node:
        case ast.BinOp(op=op) | ast.AugAssign(op=op) | ast.BoolOp(op=op) if new := OPERATORS.get(type(op).__name__):
            yield swap(node, "op", getattr(ast, new)(), f"{type(op).__name__} → {new}")
        case ast.Compare(ops=ops):
            for i, old in enumerate(ops):
                if after := OPERATORS.get(type(old).__name__):
                    words = f"{type(old).__name__} → {after}" + f", {i + 1} of a chain" * (len(ops) > 1)
                    yield swap(node, "ops", [*ops[:i], getattr(ast, after)(), *ops[i + 1 :]], words)
        case ast.UnaryOp(op=ast.USub()):
            yield swap(node, "op", ast.UAdd(), "−x → x")
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            yield swap(node, "operand", ast.UnaryOp(ast.Not(), operand), "not x → x")
        case ast.Constant(value=bool(value)):
            yield swap(node, "value", not value, f"{value} → {not value}")
        case ast.Constant(value=int(value) | float(value)) if value == 0 or abs(value) > ROUND_OFF:
            yield swap(node, "value", 2 * value or 1, f"{value:g} → {2 * value or 1:g}")
        case ast.Name(id=name) if name in NAMES:
            yield swap(node, "id", NAMES[name], f"{name} → {NAMES[name]}")
        case ast.Attribute(attr=name) if name in NAMES:
            yield swap(node, "attr", NAMES[name], f"{name} → {NAMES[name]}")


def inner(node: ast.AST, function: str = "") -> Iterator[tuple[ast.AST, str]]:
    """The nodes whose change may make a wrong number, each with the outermost function that it is in."""
    if isinstance(node, SKIPPED) or (isinstance(node, ast.keyword) and node.arg in ("strict", "encoding", "repr")):
        return
    if isinstance(node, ast.FunctionDef | ast.ClassDef) and (not function or function.endswith(".")):
        told = [node.returns, *(one.annotation for one in node.args.args)] if isinstance(node, ast.FunctionDef) else []
        if any(word in ast.unparse(one) for one in told if one for word in ("Figure", "Axes")):
            return
        function += node.name + "." * isinstance(node, ast.ClassDef)
    yield node, function
    left = looks(node)
    for name, value in ast.iter_fields(node):
        if name not in ("annotation", "returns", "decorator_list"):
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST) and child not in left:
                    yield from inner(child, function)


def looks(node: ast.AST) -> list[ast.AST]:
    """Children of a node that say how something looks: sizes of drawings, digits of messages."""
    match node:
        case ast.Module(body=body):
            told = [(one, after.value.value) for one, after in pairwise(body) if isinstance(after, ast.Expr)
                    and isinstance(one, ast.Assign) and isinstance(after.value, ast.Constant)]  # fmt: skip
            return [one for one, words in told if any(unit in str(words) for unit in SIZES)]
        case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name), args=args, keywords=words) if name in LOOKS:
            return [*args[LOOKS[name]["first"] :], *(one for one in words if one.arg in LOOKS[name]["names"])]
    return []


def of_fragment(text: str) -> Iterator[tuple[int, str, str]]:
    """Every change of a fragment's commands: its line (from 1), words, and the whole new text.

    A number of any command is doubled, an operator or comparison of a formula exchanged.
    """
    lines = text.splitlines(keepends=True)
    commands = "".join(" " * (len(line) - 1) + "\n" if line.startswith(("#", "print")) else line for line in lines)
    formulas = [formula.span() for formula in FORMULA.finditer(commands)]
    spans = [(sign, SIGNS[sign[0]]) for span in formulas for sign in SIGN.finditer(commands, *span)]
    spans += [(number, f"{2.0 * float(number[0]) or 1:g}") for number in NUMBER.finditer(commands)]
    for old, new in spans:
        row, column = text.count("\n", 0, old.start()) + 1, old.start() - text.rfind("\n", 0, old.start())
        yield row, f"{old[0]} → {new} in column {column}", text[: old.start()] + new + text[old.end() :]


def mutants(file: str) -> list[Mutant]:
    """Every mutant of a file."""
    source = (ROOT / file).read_text(encoding="utf-8")
    lines, found = source.splitlines(), list[Mutant]()
    if file.startswith(FRAGMENTS):
        changed = enumerate(of_fragment(source))
        return [Mutant(file, i, line, lines[line - 1].strip(), words, "") for i, (line, words, _) in changed]
    for node, function in inner(ast.parse(source)):
        line = getattr(node, "lineno", 1)
        for words, _ in changes(node):
            found.append(Mutant(file, len(found), line, lines[line - 1].strip(), words, function))
    return found


def tests_of(mutant: Mutant, called: Called) -> list[str]:
    """The tests that call the mutant's function, the quick ones that call little else first, up to LONGEST.

    What none calls runs in another process, or as the file is loaded: tests of its class, its file or its folder do.
    """
    inside = mutant.function.rpartition(".")[0]
    for wanted in (mutant.function, f"{inside}." if inside else "", "", None):
        place = f"{mutant.file.rpartition('/')[0]}/" if wanted is None else f"{mutant.file}:{wanted}"
        whole = place.endswith((".", ":", "/"))
        those = {
            test: taken * len(functions)
            for test, (taken, functions) in called.items()
            if any(one.startswith(place) if whole else one == place for one in functions)
        }
        if those:
            break
    chosen = list[str]()
    for test in sorted(those, key=lambda test: those[test]):
        if chosen and sum(called[one][0] for one in [*chosen, test]) > LONGEST:
            break
        chosen.append(test)
    return chosen


def killed_by(mutant: Mutant, tests: dict[str, float]) -> str:
    """The first of these tests (and their times [s]) that fails with the mutant, and passes without it.

    Empty where there is none, and where one takes too long.
    """
    if not tests:
        return ""
    longest, whole = (STARTING + SLOWNESS * seconds for seconds in (max(tests.values()), sum(tests.values())))
    with copy_of_this() as folder:
        path = folder / mutant.file
        before = path.read_text(encoding="utf-8")
        path.write_text(mutant.source, encoding="utf-8")
        by = first_failure(folder, list(tests), whole, longest)
        path.write_text(before, encoding="utf-8")
        again = [*tests][:1] if by == BROKEN else [by]
        return "" if by in ("", HANGS) or first_failure(folder, again, whole, longest) else by


def drawn(number: int, fragments: int, seed: int) -> list[Mutant]:
    """So many mutants of Python files in FOLDERS, and of fragments; links are not followed."""
    draw = random.Random(seed)
    files = [path.relative_to(ROOT) for name in FOLDERS for path in sorted((ROOT / name).rglob("*.py"))]
    own = [str(file) for file in files if (ROOT / file).resolve() == ROOT.resolve() / file]
    decks = [str(path.relative_to(ROOT)) for path in sorted((ROOT / FRAGMENTS).rglob("*.lmp"))]
    every = [[mutant for file in chosen for mutant in mutants(file)] for chosen in (own, decks)]
    return [
        mutant
        for of, count in zip(every, (number, fragments), strict=True)
        for mutant in draw.sample(of, min(count, len(of)))
    ]


def main(number: int = 100, fragments: int = 50, seed: int = 1, out: Path = RESULTS) -> None:
    """Draw faults, look for them, and write down those that no test notices."""
    chosen = drawn(number, fragments, seed)
    old = json.loads(RESULTS.read_text(encoding="utf-8")).get("survivors", []) if RESULTS.exists() else []
    reasons = {(row["file"], row["text"], row["change"]): row["reason"] for row in old}
    load()
    began, alive = time.monotonic(), list[Mutant]()
    with ProcessPoolExecutor(mp_context=get_context("fork")) as pool:
        called = Called()
        for one in pool.map(traced, shares()):
            called |= one
        print(f"{len(called)} tests are traced: {time.monotonic() - began:.0f} s", flush=True)
        tests = [{name: called[name][0] for name in tests_of(mutant, called)} for mutant in chosen]
        for mutant, those, by in zip(chosen, tests, pool.map(killed_by, chosen, tests), strict=True):
            if not by:
                alive.append(mutant)
            word = "killed  " if by else "SURVIVES" if those else "NO TEST "
            print(f"{word} {mutant.file}:{mutant.line}: {mutant.change}   {by or mutant.text}", flush=True)
    count, lost = (Counter(mutant.place for mutant in which) for which in (chosen, alive))
    places = {place: {"faults": n, "noticed": (n - lost[place]) / n} for place, n in count.items()}
    rows = [
        {"file": m.file, "line": m.line, "text": m.text, "change": m.change,
         "reason": reasons.get((m.file, m.text, m.change), "")}
        for m in alive
    ]  # fmt: skip
    record = {"asked": ASKED, "seed": seed, **vars(today()), "places": places, "survivors": rows}
    out.write_text(json.dumps(record, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    for place, row in places.items():
        print(f"{place}: {row['faults']} faults, {100.0 * row['noticed']:.1f} % noticed")
    missed, put = ((n[DECKS], n.total() - n[DECKS]) for n in (lost, count))
    raise typer.Exit(int(any(n > (1.0 - ASKED) * of for n, of in zip(missed, put, strict=True))))


if __name__ == "__main__":
    typer.run(main)
