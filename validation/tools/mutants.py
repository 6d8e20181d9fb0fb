"""Do the tests notice? One small fault after the other is put into the code, and its tests must fail.

    python -m validation.tools.mutants [FILE ...] [--part 0.25] [--seed 1] [--workers 2] [--callers KEPT.json]

A mutant changes one operator, comparison or number of one file in a copy of this folder. The tests that call the
function run there, those of files that name its module first, up to the first that fails or LONGEST; goldens, which
hold any number, run last. One that passes them is looked at again, by more of the tests that call it, up to
LONGEST_AGAIN: whole runs of tests/validation and tests/hard among them. One that passes these too survives: it is
printed, and listed in results/mutants.json, with the reason if one was written there by hand (it is kept for the same
change of the same line). All files take a night; `--part` draws a share of each file's mutants, the same ones for one
seed. `--callers` keeps which test calls what. Exit code 1 where fewer than ASKED are killed. What is changed, and what
is not: `validation/tools/mutating.py`.

mutmut and cosmic-ray were not taken: neither follows src/contact1d, whose folders are links, and both start Python
anew for every mutant (`validation/tools/faulty.py` forks).
"""

from __future__ import annotations

import argparse
import json
import os
import random
import sys
import tempfile
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Any

from validation.tools.callers import WHOLE, Called, callers
from validation.tools.faulty import ROOT, copy_of_this, first_failure, load
from validation.tools.mutating import Mutant, mutants
from validation.tools.patched import WAITING, Wanted, is_quick, noticed

RESULTS = Path(__file__).parents[1] / "speed" / "results" / "mutants.json"
ASKED = 0.9
"""Asked of the share that is killed."""
LONGEST, LONGEST_AGAIN = 30.0, 300.0
"""Time of the tests that look for one mutant, and of those that look again, as long as they took when traced [s]."""
PATIENCE, LEAST = 2.0, 120.0
"""Time of the processor after which a mutant counts as killed, over that of its tests, and at least [s]."""
ROOMS = {
    "analysis": ("analysis/*.py",),
    "settings": ("workflow/settings/*.py",),
    "effects": ("workflow/deck/effects/*.py",),
    "experiments": ("workflow/experiments/*/*.py",),
    "potentials": ("potentials/*.py",),
    "reproduce": ("validation/paper/*.py", "validation/paper/*/*.py", "validation/judging/*.py"),
    "body": ("workflow/body/*.py",),
}
"""Where faults are looked for."""
DRAWN = ("plots.py", "figures.py")
"""Ends of names of files that only draw."""
TESTS = ("tests/unit", "tests/decks", "tests/validation", "tests/hard")
PROCESSES = ("cost", "sweep", "report", "readme", "benchmarks", "cli", "engine", "tutorial", "stability", "browser")
"""In names of test files that run commands in processes of their own, which are not seen, or for minutes."""
GOLDEN = ("tests/decks/test_goldens.py", "tests/unit/test_judged_runs.py::test_the_")
"""What was written once, and is the same."""


def tests_of(mutant: Mutant, called: Called) -> tuple[list[str], list[str]]:
    """Those that call the mutant's function up to LONGEST, and after them those up to LONGEST_AGAIN.

    First those of files that name its module, quick ones that call little else before others; goldens last. What stands
    in no function belongs to all functions of its file.
    """
    module = mutant.file.removesuffix(".py").replace("/", ".")
    name = f"{mutant.file}:{mutant.function}"
    wanted = name.removesuffix(WHOLE) if mutant.function == WHOLE else name
    those = {
        test: (taken, taken * len(functions))
        for test, (taken, functions) in called.items()
        if any(one == wanted or (mutant.function == WHOLE and one.startswith(wanted)) for one in functions)
    }
    first: list[str] = []
    again: list[str] = []
    whole = 0.0
    for test in sorted(
        those, key=lambda t: (t.startswith(GOLDEN), not names(t.partition("::")[0], module), those[t][1])
    ):
        whole += those[test][0]
        if not first or (whole <= LONGEST and not again):
            first.append(test)
        elif whole <= LONGEST + LONGEST_AGAIN:
            again.append(test)
    return first, again


@cache
def names(test_file: str, module: str) -> bool:
    """Whether a file of tests has the name of a module in it."""
    return module in (ROOT / test_file).read_text(encoding="utf-8")


@dataclass
class Found:
    """What the tests said: the mutants that survive, and those that goldens alone have noticed."""

    alive: list[Mutant] = field(default_factory=list)
    golden: list[Mutant] = field(default_factory=list)


def looked_for(chosen: Sequence[Mutant], workers: int, kept: Path | None) -> Found:
    """Run the tests of each."""
    load()
    found = Found()
    with tempfile.TemporaryDirectory() as temporary, ThreadPoolExecutor(workers) as executor:
        copies = [copy_of_this(Path(temporary) / str(number)) for number in range(workers)]
        called = callers(copies[0], test_files(), kept)
        of_function = {(one.file, one.function): tests_of(one, called) for one in chosen}
        several = [of_function[mutant.file, mutant.function] for mutant in chosen]

        def wanted(number: int, again: bool) -> Wanted:
            tests = several[number][again]
            patience = max(LEAST, PATIENCE * sum(called[test][0] for test in tests))
            return number, chosen[number], tests, patience

        def tell(number: int, by: str, again: bool) -> None:
            mutant = chosen[number]
            if not by and not again and several[number][1]:
                return
            if not by:
                found.alive.append(mutant)
            elif by.startswith(GOLDEN):
                found.golden.append(mutant)
            word = "killed  " if by else "SURVIVES" if several[number][0] else "NO TEST "
            print(f"{word} {mutant.file}:{mutant.line}: {mutant.change}   {by or mutant.text}", flush=True)

        def look(folder: Path, mine: Sequence[int]) -> None:
            left = [number for number in mine if not several[number][0]]
            for number in left:
                tell(number, "", again=True)
            left = [number for number in mine if several[number][0]]
            for again in (False, True):
                by = tried(folder, [wanted(number, again) for number in left], lambda n, by, a=again: tell(n, by, a))
                left = [number for number in left if not by[number] and several[number][1]]

        list(executor.map(look, copies, [range(number, len(chosen), workers) for number in range(workers)]))
    return found


def tried(folder: Path, wanted: Sequence[Wanted], tell: Callable[[int, str], None]) -> dict[int, str]:
    """For the numbers of mutants the test that notices, "" for none; each is told as soon as it is known."""
    found: dict[int, str] = {}

    def note(number: int, by: str) -> None:
        found[number] = by
        tell(number, by)

    whole = {one.file: (ROOT / one.file).read_text(encoding="utf-8") for _, one, _, _ in wanted}
    quick = [one for one in wanted if is_quick(one[1], whole[one[1].file])]
    if quick:
        noticed(folder, quick, note)
    for number, mutant, tests, patience in wanted:
        if number not in found:
            path = folder / mutant.file
            path.write_text(mutant.source, encoding="utf-8")
            note(number, first_failure(folder, tests, WAITING * patience))
            path.write_text(whole[mutant.file], encoding="utf-8")
    return found


def test_files() -> list[str]:
    """The files of tests that are traced."""
    paths = (path for room in TESTS for path in sorted((ROOT / room).glob("test_*.py")))
    return [str(path.relative_to(ROOT)) for path in paths if not any(word in path.name for word in PROCESSES)]


def record(chosen: Sequence[Mutant], found: Found, part: float, seed: int) -> dict[str, Any]:
    """What mutants.json holds: the files of this time anew, and those of earlier times."""
    old = json.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {"files": {}, "survivors": []}
    reasons = {(row["file"], row["text"], row["change"]): row["reason"] for row in old["survivors"]}
    files = {mutant.file: None for mutant in chosen}
    date = datetime.now(UTC).date().isoformat()
    counts = {
        file: {
            "mutants": sum(m.file == file for m in chosen),
            "survive": sum(m.file == file for m in found.alive),
            "goldens_only": sum(m.file == file for m in found.golden),
            "part": part,
            "seed": seed,
            "date": date,
        }
        for file in files
    }
    rows = [row for row in old["survivors"] if row["file"] not in files]
    rows += [
        {"file": m.file, "line": m.line, "text": m.text, "change": m.change, "reason": reasons.get(m.name, "")}
        for m in found.alive
    ]
    every = {file: row for file, row in (old["files"] | counts).items() if (ROOT / file).exists()}
    rows = [row for row in rows if row["file"] in every]
    return {
        "asked": ASKED,
        "rooms": {room: shares(room, every, rows) for room in ROOMS if set(looked_at([room])) & set(every)},
        "files": every,
        "survivors": sorted(rows, key=lambda r: (r["file"], r["line"])),
    }


def shares(room: str, files: dict[str, Any], rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Of the mutants of a room: the share killed, and that with the survivors whose reason is written."""
    names = set(looked_at([room])) & set(files)
    drawn = sum(files[name]["mutants"] for name in names)
    alive = [row for row in rows if row["file"] in names]
    told = sum(bool(row["reason"]) for row in alive)
    every = max(drawn, 1)
    return {
        "mutants": drawn,
        "killed": round(1.0 - len(alive) / every, 3),
        "killed_or_explained": round(1.0 - (len(alive) - told) / every, 3),
    }


def looked_at(rooms: Sequence[str]) -> list[str]:
    """The files of these rooms that do more than draw."""
    paths = (path for room in rooms for pattern in ROOMS[room] for path in ROOT.glob(pattern))
    return sorted(str(p.relative_to(ROOT)) for p in paths if p.name != "__init__.py" and not p.name.endswith(DRAWN))


def main() -> int:
    """Look for faults that no test notices; 1 where there are too many."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", help="files, or rooms by name")
    parser.add_argument("--part", type=float, default=1.0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--callers", type=Path)
    options = parser.parse_args()
    wanted = options.files or list(ROOMS)
    chosen = []
    for file in (name for one in wanted for name in (looked_at([one]) if one in ROOMS else [one])):
        every = mutants(file)
        count = max(1, round(options.part * len(every))) if every else 0
        draw = random.Random(f"{options.seed} {file}").sample(every, count)
        chosen += sorted(draw, key=lambda mutant: mutant.line)
    found = looked_for(chosen, options.workers, options.callers)
    told = record(chosen, found, options.part, options.seed)
    RESULTS.write_text(json.dumps(told, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    killed = 1.0 - len(found.alive) / max(1, len(chosen))
    print(f"{len(chosen)} mutants, {len(found.alive)} survive: {100.0 * killed:.1f} % killed")
    print(f"{len(found.golden)} of them by goldens alone")
    return int(killed < ASKED)


if __name__ == "__main__":
    sys.exit(main())
