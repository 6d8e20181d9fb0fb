"""How old the records are: of each result the commit and the date at which it was measured.

Age counts the commits since then that touch the program itself, and days. What was measured with changes that were not
committed has a + behind the commit.
"""

import datetime
import json
import subprocess
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from validation.row import tables_beside

ROOT = Path(__file__).parents[1]
CODE = ("src", "workflow", "analysis", "potentials", "lammps_inputs")
"""Folders of the program itself."""
RECORDS = tables_beside(__file__)
NAMED = 4
"""Parts of a record that are named; of more the number is."""


@dataclass(frozen=True, order=True)
class Measured:
    """When something was measured: date and commit; without a commit those of the file that holds it."""

    date: str
    commit: str

    def __str__(self) -> str:
        """`2026-11-23 at 3b526f9`."""
        return f"{self.date} at {self.commit}" if self.commit else self.date


def git(*words: str) -> str:
    """What git prints in this checkout; "" where it fails, or where there is no git."""
    try:
        done = subprocess.run(["git", "-C", str(ROOT), *words], capture_output=True, text=True, check=False)
    except OSError:
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""


def commit() -> str:
    """The commit that is checked out, with a + where the program has changes beside it; "" outside of a checkout."""
    changed = git("status", "--porcelain", "--untracked-files=no", "--", *CODE)
    return git("rev-parse", "--short=7", "HEAD") + "+" * bool(changed)


def today() -> Measured:
    """Date and commit of what is measured now."""
    return Measured(datetime.date.today().isoformat(), commit())


def measured(file: str) -> dict[str, Measured]:
    """Of each part of a record when it was measured; of a record that says nothing, when it was committed."""
    data: Any = json.loads((ROOT / file).read_text(encoding="utf-8")) if file.endswith(".json") else {"": {}}
    whole = {"": data} if "seed" in data else data
    parts = {one["name"]: one for one in data["answers"]} if "answers" in data else whole
    at, _, date = git("log", "-1", "--format=%h %cs", "--", file).partition(" ")
    entries = {name: one if isinstance(one, dict) else {} for name, one in parts.items()}
    return {name: Measured(one.get("date", date), one.get("commit") or at) for name, one in entries.items()}


def times(found: Iterable[Measured]) -> str:
    """All of them in words, each once: `2026-11-22 at e6ba351, 2026-11-23 at eb2c9bc`."""
    return ", ".join(map(str, sorted(set(found))))


def ages() -> Iterator[str]:
    """A line for each record, and for each time at which parts of it were measured: which, when, how old."""
    for name, file in RECORDS.items():
        parts = measured(file)
        for when in sorted(set(parts.values())):
            those = [part for part, other in parts.items() if other == when]
            which = ", ".join(those) if len(those) <= NAMED else f"{len(those)} of {len(parts)}"
            since = git("rev-list", "--count", f"{when.commit.rstrip('+')}..HEAD", "--", *CODE)
            commits = f"{since} commits to the program" if since else "a commit that is not here"
            days = (datetime.date.today() - datetime.date.fromisoformat(when.date)).days if when.date else 0
            part = f" ({which})" if len(those) < len(parts) else ""
            yield f"{name}{part}: {when}, {commits} and {days} days ago"
