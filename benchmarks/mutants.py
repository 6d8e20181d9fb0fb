"""Do the tests notice? One small fault after the other is put into the code, and its tests must fail.

    python -m benchmarks.mutants [FILE ...] [--part 0.25] [--workers 2]

A mutant changes one operator, comparison or number of one file in a copy of this folder; the tests of TESTS run there,
up to the first that fails. One that passes them all survives: it is printed, and listed in results/mutants.json, with
the reason if one was written there by hand (it is kept for the same change of the same line). All files take a night;
`--part` draws a share of each file's mutants, the same ones every time. Exit code 1 where fewer than ASKED are killed.

mutmut and cosmic-ray were not taken: neither follows src/contact1d, whose folders are links, and both start Python
anew for every mutant (`benchmarks/faulty.py` forks).
"""

from __future__ import annotations

import argparse
import ast
import json
import os
import random
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from queue import Queue
from typing import Any

from benchmarks.faulty import ROOT, copy_of_this, first_failure, load

RESULTS = Path(__file__).parent / "results" / "mutants.json"
ASKED = 0.9
"""Asked of the share that is killed."""
PATIENCE, LEAST = 5.0, 60.0
"""Time of a mutant's tests over that of the unchanged ones, and at least [s], after which it counts as killed."""
UNIT = "tests/unit/"
COVERAGE, DECKS, MOTION = UNIT + "test_coverage.py", "tests/decks/", "tests/decks/test_motion.py"
ESTIMATE, SIMILAR = UNIT + "test_estimate.py", UNIT + "test_settings_similarity.py"
TESTS: dict[str, tuple[str, ...]] = {
    "potentials/double_exponential.py": (UNIT + "test_potential.py", UNIT + "test_table.py"),
    "potentials/table.py": (UNIT + "test_table.py",),
    "analysis/law_error.py": (UNIT + "test_law_error.py",),
    "analysis/loop.py": (UNIT + "test_loop.py",),
    "analysis/polynomial.py": (UNIT + "test_polynomial.py", UNIT + "test_curve_marks.py"),
    "analysis/curve_marks.py": (UNIT + "test_curve_marks.py", COVERAGE),
    "analysis/extremum.py": (UNIT + "test_extremum.py", UNIT + "test_radius.py"),
    "analysis/radius.py": (UNIT + "test_radius.py",),
    "analysis/pressure.py": (UNIT + "test_pressure.py",),
    "workflow/settings/dynamics.py": (ESTIMATE, SIMILAR, UNIT + "test_dynamic.py", MOTION, DECKS + "test_goldens.py"),
    "workflow/settings/": (
        ESTIMATE, SIMILAR, UNIT + "test_dynamic.py", UNIT + "test_lattice.py", MOTION, DECKS + "test_goldens.py",
        COVERAGE, "tests/hard/test_lattice.py",
    ),
    "workflow/deck/effects/": (MOTION, "tests/decks"),
    "workflow/experiments/slide/": ("tests/decks/test_slide.py", UNIT + "test_experiment_kinds.py"),
    "workflow/experiments/": (
        UNIT + "test_claims.py", UNIT + "test_trust.py", UNIT + "test_sampling.py", COVERAGE,
        UNIT + "test_law_error.py", UNIT + "test_experiment_kinds.py", "tests/decks/test_run_folder.py",
        "tests/validation/test_dynamic.py", "tests/validation/test_pull_off.py", "tests/hard/test_untrusted.py",
    ),
    "workflow/judging/": (UNIT + "test_reproduce_page.py", UNIT + "test_reproduce_rows.py"),
    "workflow/reproduce/": (
        UNIT + "test_reproduce_judges.py", UNIT + "test_reproduce_page.py", "tests/validation/test_reproduce.py",
    ),
}  # fmt: skip
"""For each file, or folder, whose faults are looked for: the tests that are to notice. The longest name counts."""
OPERATORS: dict[type[ast.AST], type[ast.AST]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.FloorDiv: ast.Mult,
    ast.Pow: ast.Mult, ast.Mod: ast.Mult, ast.And: ast.Or, ast.Or: ast.And, ast.Lt: ast.GtE, ast.GtE: ast.Lt,
    ast.Gt: ast.LtE, ast.LtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
    ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
NAMES = {"min": "max", "max": "min", "argmin": "argmax", "argmax": "argmin", "ceil": "floor", "floor": "ceil"}
SKIPPED = (ast.Assert, ast.Raise, ast.JoinedStr, ast.Import, ast.ImportFrom)
"""Words and types: no fault of these makes a wrong number."""


@dataclass(frozen=True)
class Mutant:
    """One change: the file, the line and its text, what becomes what, and the whole new text of the file."""

    file: str
    line: int
    text: str
    change: str
    source: str

    @property
    def name(self) -> tuple[str, str, str]:
        """What stays the same when lines above are added."""
        return self.file, self.text, self.change


Change = tuple[str, Callable[[], None], Callable[[], None]]


def changes(node: ast.AST) -> Iterator[Change]:
    """(words, do, undo) of every change of this node itself."""

    def swap(owner: Any, field: str, new: Any, words: str) -> Change:
        old = getattr(owner, field)
        return words, lambda: setattr(owner, field, new), lambda: setattr(owner, field, old)

    match node:
        case ast.BinOp(op=op) | ast.AugAssign(op=op) | ast.BoolOp(op=op) if type(op) in OPERATORS:
            new = OPERATORS[type(op)]
            yield swap(node, "op", new(), f"{type(op).__name__} → {new.__name__}")
        case ast.Compare(ops=[op]) if type(op) in OPERATORS:
            new = OPERATORS[type(op)]
            yield swap(node, "ops", [new()], f"{type(op).__name__} → {new.__name__}")
            limit = {ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt}.get(type(op))  # type: ignore[call-overload]
            if limit is not None:
                yield swap(node, "ops", [limit()], f"{type(op).__name__} → {limit.__name__}")
        case ast.UnaryOp(op=ast.USub()):
            yield swap(node, "op", ast.UAdd(), "−x → x")
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            yield swap(node, "operand", ast.UnaryOp(ast.Not(), operand), "not x → x")
        case ast.Constant(value=bool(value)):
            yield swap(node, "value", not value, f"{value} → {not value}")
        case ast.Constant(value=int(value) | float(value)):
            yield swap(node, "value", 2 * value if value else 1, f"{value:g} → {2 * value if value else 1:g}")
        case ast.Name(id=name) if name in NAMES:
            yield swap(node, "id", NAMES[name], f"{name} → {NAMES[name]}")
        case ast.Attribute(attr=name) if name in NAMES:
            yield swap(node, "attr", NAMES[name], f"{name} → {NAMES[name]}")


def inner(node: ast.AST) -> Iterator[ast.AST]:
    """The node and all below it whose change may make a wrong number: no annotations, no words, no types."""
    if isinstance(node, SKIPPED):
        return
    yield node
    for field, value in ast.iter_fields(node):
        if field in ("annotation", "returns", "decorator_list"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST):
                yield from inner(child)


def mutants(file: str) -> list[Mutant]:
    """Every mutant of a file."""
    source = (ROOT / file).read_text(encoding="utf-8")
    tree, lines = ast.parse(source), source.splitlines()
    found = []
    for node in inner(tree):
        for words, do, undo in changes(node):
            line = getattr(node, "lineno", 0)
            do()
            found.append(
                Mutant(file, line, lines[line - 1].strip(), words, ast.unparse(ast.fix_missing_locations(tree)))
            )
            undo()
    return found


def tests_of(file: str) -> tuple[str, ...]:
    """The tests that are to notice. Raises KeyError for a file that is not looked at."""
    return TESTS[max((name for name in TESTS if file.startswith(name)), key=len)]


def survivors(chosen: Sequence[Mutant], workers: int) -> list[Mutant]:
    """Those whose tests pass. Raises SystemExit where tests fail on the unchanged code."""
    load()
    with tempfile.TemporaryDirectory() as temporary, ThreadPoolExecutor(workers) as executor:
        free: Queue[Path] = Queue()
        for number in range(workers):
            free.put(copy_of_this(Path(temporary) / str(number)))
        taken: dict[tuple[str, ...], float] = {}
        for tests in {tests_of(mutant.file): None for mutant in chosen}:
            folder, started = free.queue[0], time.monotonic()
            if first_failure(folder, tests, 3600.0):
                raise SystemExit(f"the tests fail without any fault: {' '.join(tests)}")
            taken[tests] = time.monotonic() - started

        def survives(mutant: Mutant) -> bool:
            folder, tests = free.get(), tests_of(mutant.file)
            path = folder / mutant.file
            whole = path.read_text(encoding="utf-8")
            try:
                path.write_text(mutant.source, encoding="utf-8")
                alive = not first_failure(folder, tests, max(LEAST, PATIENCE * taken[tests]))
            finally:
                path.write_text(whole, encoding="utf-8")
                free.put(folder)
            print(f"{'SURVIVES' if alive else 'killed  '} {mutant.file}:{mutant.line}: {mutant.change}", flush=True)
            return alive

        return [m for m, alive in zip(chosen, executor.map(survives, chosen), strict=True) if alive]


def record(chosen: Sequence[Mutant], alive: Sequence[Mutant]) -> dict[str, Any]:
    """What mutants.json holds: the files of this time anew, and those of earlier times."""
    old = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {"files": {}, "survivors": []}
    reasons = {(row["file"], row["text"], row["change"]): row["reason"] for row in old["survivors"]}
    files = {mutant.file: None for mutant in chosen}
    counts = {
        file: {"mutants": sum(m.file == file for m in chosen), "survive": sum(m.file == file for m in alive)}
        for file in files
    }
    rows = [row for row in old["survivors"] if row["file"] not in files]
    rows += [
        {"file": m.file, "line": m.line, "text": m.text, "change": m.change, "reason": reasons.get(m.name, "")}
        for m in alive
    ]
    return {
        "asked": ASKED,
        "files": old["files"] | counts,
        "survivors": sorted(rows, key=lambda r: (r["file"], r["line"])),
    }


def looked_at() -> list[str]:
    """Every file that TESTS speaks of."""
    folders = (ROOT / name for name in TESTS)
    paths = (path for name in folders for path in ([name] if name.is_file() else name.rglob("*.py")))
    return sorted({str(path.relative_to(ROOT)) for path in paths if path.name != "__init__.py"})


def main() -> int:
    """Look for faults that no test notices; 1 where there are too many."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", default=looked_at())
    parser.add_argument("--part", type=float, default=1.0)
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    options = parser.parse_args()
    chosen = []
    for file in options.files:
        every = mutants(file)
        count = max(1, round(options.part * len(every))) if every else 0
        chosen += sorted(random.Random(file).sample(every, count), key=lambda mutant: mutant.line)
    alive = survivors(chosen, options.workers)
    RESULTS.write_text(json.dumps(record(chosen, alive), indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    killed = 1.0 - len(alive) / max(1, len(chosen))
    print(f"{len(chosen)} mutants, {len(alive)} survive: {100.0 * killed:.1f} % killed")
    return int(killed < ASKED)


if __name__ == "__main__":
    sys.exit(main())
