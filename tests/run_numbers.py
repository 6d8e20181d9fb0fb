"""The numbers of every run that a test makes, beside those of the record.

A run is known by its scene, a fit by its data. What is compared is what it leaves: results with their uncertainties,
closed forms, checks of validity, numbers of steps and in warnings, the commands of its deck, and of each column of its
tables two sums. Not compared are a run that the record does not have, thermal fluctuations, scenes that were run in
more than one way, and numbers that another processor's arithmetic changed.

`RUN_NUMBERS=renew make test` writes the record anew. `RUN_NUMBERS=drop make test` takes out of it what this processor
has otherwise; another one's arithmetic is had by GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F
OPENBLAS_CORETYPE=Nehalem NPY_DISABLE_CPU_FEATURES="X86_V3 X86_V4".
"""

import csv
import gzip
import hashlib
import json
import math
import os
import re
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest

RECORD = Path(__file__).with_name("run_numbers.json.gz")
MOVED, WIDENED, SUMMED = 0.02, 0.02, 1e-4
"""What a result may move in its uncertainty; this, and a sum over a column, relatively."""
ROUND_OFF = 1e-7
"""Relative, of the largest result or column of the same unit."""
LEFT_OUT = ("scene", "timing", "versions", "consistency", "units", "si", "deviation", "warnings")
TEXTS = re.compile(r"[-+\d.eE]*|[-+]?inf|nan")
Numbers = dict[str, tuple[float, float, str]]
"""Value, uncertainty or size, and unit."""


def leaves(entry: Any, path: str = "") -> Iterator[tuple[str, tuple[float, float, str]]]:
    """All numbers of a document but LEFT_OUT."""
    if isinstance(entry, Mapping) and isinstance(entry.get("value"), int | float):
        yield path, (entry["value"], entry.get("uncertainty", 0.0), entry.get("unit", ""))
    elif isinstance(entry, int | float):
        yield path, (entry, 0.0, "")
    for name, inner in (
        entry.items() if isinstance(entry, Mapping) else enumerate(entry if isinstance(entry, list) else ())
    ):
        if isinstance(inner, Mapping | list) and name not in LEFT_OUT:
            yield from leaves(inner, f"{path} {name}".strip())


def columns(folder: Path) -> Iterator[tuple[str, tuple[float, float, str]]]:
    """Of each column of numbers in the tables of a run the sum, and the sum of sizes."""
    for path in sorted(folder.glob("*.csv")):
        head, *rows = csv.reader(path.read_text(encoding="utf-8").splitlines())
        for name, texts in zip(head, zip(*rows, strict=True), strict=True) if rows else ():
            if all(TEXTS.fullmatch(text) for text in texts):
                values = [number for text in texts if math.isfinite(number := float(text or "nan"))]
                yield f"{path.name} {name}", (math.fsum(values), math.fsum(map(abs, values)), "column")


def deck(text: str) -> float:
    """A number for the commands of a deck, without comments and computed numbers, which have many digits."""
    commands = [line for line in text.splitlines() if not line.startswith("#")]
    known = re.sub(r"\d[\d.]*\d{4}[\d.]*(?:e[-+]?\d+)?", "", "\n".join(commands))
    return float(int(hashlib.sha256(known.encode()).hexdigest()[:12], 16) % 1_000_000)


def moved(now: Numbers, before: Mapping[str, tuple[float, float, str] | None]) -> dict[str, str]:
    """What differs by more than it may, or is missing on one side, by its name."""
    found = dict.fromkeys(now.keys() ^ before.keys(), "missing")
    sizes = dict[str, float]()
    for kept in before.values():
        value, _, unit = kept or (0.0, 0.0, "")
        sizes[unit] = max(sizes.get(unit, 0.0), abs(value))
    for name, (value, doubt, _) in now.items():
        if (kept := before.get(name)) is None:
            continue
        old, told, unit = kept
        least = ROUND_OFF * sizes[unit]
        share = {"column": WIDENED if "uncertainty" in name else SUMMED, "steps": WIDENED, "said": WIDENED}.get(
            unit, MOVED
        )
        size = old if unit == "steps" else told
        if not (abs(value - old) <= share * size + least and abs(doubt - told) <= WIDENED * told + least):
            found[name] = f"{value:.9g} ± {doubt:.4g}, before {old:.9g} ± {told:.4g}"
    return found


def key_of(document: Mapping[str, Any]) -> str:
    """The scene of a run or the data of a fit, as a short text."""
    fitted = "" if "scene" in document else Path(document["data"]).read_text(encoding="utf-8", errors="replace")
    scene = json.dumps(document.get("scene") or [document["title"], *document["parameters"]], sort_keys=True)
    return hashlib.sha256(f"{scene}{fitted}".encode()).hexdigest()[:12]


class NumbersOfRuns:
    """A pytest plugin: a test whose run has other numbers than the record fails."""

    def __init__(self) -> None:
        self.record = json.loads(gzip.decompress(RECORD.read_bytes())) if RECORD.exists() else {}
        self.made: dict[str, list[Numbers]] = {}
        self._new: list[str] = []
        self._asked = os.environ.get("RUN_NUMBERS")
        sys.addaudithook(self._written)

    def _written(self, event: str, arguments: tuple[Any, ...]) -> None:
        """Read what a run has just left: its temporary file, whole, is renamed to results.json."""
        if event != "os.rename" or not str(arguments[1]).endswith(("results.json", "fit.json")):
            return
        document = json.loads(Path(arguments[0]).read_text(encoding="utf-8"))
        if document.get("status") != "done" or "noise" in document.get("scene", ()):
            return
        found = dict(leaves(document)) | dict(columns(Path(arguments[0]).parent))
        if timing := document.get("timing"):
            found["steps"] = timing["steps"], 0.0, "steps"
            found["deck"] = deck(Path(arguments[0]).with_name("in.lammps").read_text(encoding="utf-8")), 0.0, "deck"
        for warning in document["warnings"]:
            numbers = [float(text) for text in re.findall(r"\d+(?:\.\d+)?(?:e[-+]?\d+)?", warning["message"])]
            named = f"warning {warning['name']}"
            found |= {f"{named} {i}": (x, x, "said") for i, x in enumerate([float(len(numbers)), *numbers])}
        self._new.append(key_of(document))
        self.made.setdefault(self._new[-1], []).append(found)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_call(self, item: pytest.Item) -> Iterator[None]:
        """Compare what this test and its fixtures ran."""
        yield
        new, self._new = set(self._new), []
        for key in new & self.record.keys() if not self._asked else ():
            found = moved(self.made[key][-1], self.record[key])
            assert not found, f"run {key} has other numbers than {RECORD.name}: {dict(list(found.items())[:5])}"

    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        """Write what is asked for, or hand what a worker ran to the session that started it."""
        if hasattr(session.config, "workeroutput"):
            session.config.workeroutput["runs"] = json.dumps(self.made)
            return
        for key, (one, *others) in self.made.items():
            if self._asked == "renew" and not any(moved(other, one) for other in others):
                short = {
                    name: (float(f"{value:.10g}"), float(f"{doubt:.3g}"), unit)
                    for name, (value, doubt, unit) in one.items()
                }
                dropped = [name for name, kept in self.record.get(key, {}).items() if kept is None]
                self.record[key] = short | dict.fromkeys(dropped)
            elif self._asked == "drop" and key in self.record:
                self.record[key] |= dict.fromkeys(moved(one, self.record[key]))
        if self._asked:
            RECORD.write_bytes(gzip.compress(json.dumps(dict(sorted(self.record.items()))).encode(), mtime=0))

    def pytest_testnodedown(self, node: Any) -> None:
        """Take over what a worker of pytest-xdist ran."""
        for key, numbers in json.loads(getattr(node, "workeroutput", {}).get("runs", "{}")).items():
            self.made.setdefault(key, []).extend(numbers)
