"""Which tests call which functions of this folder, and how long each takes: who could notice a fault in a function.

Each test file runs once in a fork, with a trace of calls. What a fixture of a module or the session calls counts for
every test that asks for it; what is kept (`functools.cache`) is forgotten before every test. What runs in other
processes is not seen: a fault may be noticed by more tests than are listed here, never by fewer.
"""

from __future__ import annotations

import ast
import hashlib
import json
import os
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

from validation.tools.faulty import QUICK, ROOT, in_copy

WHOLE = "<module>"
"""Name of what stands in no function."""
NOTED = ".calls"
"""File of a copy that the calls of a test file are written to."""
Called = dict[str, tuple[float, list[str]]]
"""For each test its time [s] and the functions, file:name."""


class Trace:
    """A pytest plugin that notes which functions below `folder` each test calls."""

    def __init__(self, folder: Path) -> None:
        """Nothing is noted yet."""
        self._root, self._names = f"{folder}{os.sep}", dict[CodeType, str]()
        self._now: set[str] = set()
        self._of_fixture: dict[int, set[str]] = {}
        self.found: Called = {}
        self.failed: list[str] = []

    def _note(self, frame: FrameType, event: str, value: object) -> None:
        code = frame.f_code
        if code not in self._names:
            path = os.path.realpath(code.co_filename)  # src/contact1d holds links
            local = path.removeprefix(self._root) if code.co_filename.startswith(self._root) else ""
            ours = local and not local.startswith(("tests", "benchmarks"))
            self._names[code] = f"{local}:{code.co_qualname.split('.<locals>')[0]}" if ours else ""
        if name := self._names[code]:
            self._now.add(name)

    def pytest_runtest_protocol(self, item: Any) -> Iterator[None]:
        """Trace the test, its fixtures included."""
        forget()
        self._now, started = set(), time.monotonic()
        threading.settrace(self._note)
        sys.settrace(self._note)
        yield
        sys.settrace(None)
        threading.settrace(None)  # type: ignore[arg-type]  # which ends it, as of sys.settrace
        fixtures = getattr(item, "_fixtureinfo").name2fixturedefs.values()  # noqa: B009 (a name of pytest that is not public)
        for definition in (one for several in fixtures for one in several):
            self._now |= self._of_fixture.get(id(definition), set())
        self.found[item.nodeid] = time.monotonic() - started, sorted(self._now)

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Note what fails."""
        if report.failed:
            self.failed.append(report.nodeid)

    def pytest_fixture_setup(self, fixturedef: Any) -> Iterator[None]:
        """What a fixture calls is kept apart, for the other tests that ask for it."""
        before, self._now = self._now, set()
        yield
        self._of_fixture[id(fixturedef)] = self._now
        self._now = before | self._now


def forget() -> None:
    """Empty every `functools.cache` of this program and its tests."""
    for name, module in list(sys.modules.items()):
        if module is not None and name.split(".")[0] in ("contact1d", "tests"):
            for kept in list(vars(module).values()):
                if callable(clear := getattr(kept, "cache_clear", None)):
                    clear()


def called_in(folder: Path, test_file: str) -> Called:
    """What the tests of one file call, in a copy of this folder; those that fail there are left out, and named."""

    def run() -> int:
        import pytest

        trace = Trace(folder)
        for name in ("pytest_runtest_protocol", "pytest_fixture_setup"):
            setattr(Trace, name, pytest.hookimpl(wrapper=True)(getattr(Trace, name)))
        code = int(pytest.main([*QUICK, "--rootdir", str(folder), test_file], [trace]))
        (folder / NOTED).write_text(json.dumps([trace.found, trace.failed]), encoding="utf-8")
        return code

    (folder / NOTED).unlink(missing_ok=True)
    in_copy(folder, run, 3600.0)
    if not (folder / NOTED).exists():
        raise SystemExit(f"{test_file} does not run")
    found, failed = json.loads((folder / NOTED).read_text(encoding="utf-8"))
    for test in failed:
        print(f"fails without any fault, and is left out: {test}", flush=True)
    return {test: call for test, call in found.items() if test not in failed}


def collected(folder: Path, test_files: list[str]) -> dict[str, str]:
    """The tests of each file, a line each, as pytest finds them in a copy of this folder."""

    class Notes:
        @staticmethod
        def pytest_collection_finish(session: Any) -> None:
            (folder / NOTED).write_text(json.dumps([item.nodeid for item in session.items]), encoding="utf-8")

    def run() -> int:
        import pytest

        return int(pytest.main([*QUICK, "--collect-only", "--rootdir", str(folder), *test_files], [Notes()]))

    (folder / NOTED).unlink(missing_ok=True)
    in_copy(folder, run, 3600.0)
    found: dict[str, str] = {}
    for test in json.loads((folder / NOTED).read_text(encoding="utf-8")):
        name = test.partition("::")[0]
        found[name] = found.get(name, "") + f"{test}\n"
    return found


def callers(folder: Path, test_files: list[str], kept: Path | None) -> Called:
    """All tests of these files; what was looked at before, and `kept`, is taken from there where the file is the same.

    So must its tests be, which may come from another file. A test that is the same may call other functions since:
    without `kept` all is looked at anew.
    """
    old = json.loads(kept.read_text(encoding="utf-8")) if kept and kept.exists() else {}
    there = collected(folder, test_files) if kept else {}
    for name in test_files:
        mark = hashlib.sha256((ROOT / name).read_bytes() + there.get(name, "").encode()).hexdigest()
        if old.get(name, {}).get("mark") != mark:
            old[name] = {"mark": mark, "calls": called_in(folder, name)}
            print(f"{len(old[name]['calls'])} tests of {name}", flush=True)
            if kept:
                kept.write_text(json.dumps(old), encoding="utf-8")
    return {test: call for name in test_files for test, call in old[name]["calls"].items()}


def function_of(tree: ast.Module, line: int) -> str:
    """The outermost function, with its class, that a line stands in; WHOLE where it is in none."""

    def within(nodes: list[ast.stmt], before: str) -> str:
        for node in nodes:
            if not node.lineno <= line <= (node.end_lineno or node.lineno):
                continue
            if isinstance(node, ast.FunctionDef):
                return before + node.name
            if isinstance(node, ast.ClassDef):
                return within(node.body, f"{before}{node.name}.")
        return WHOLE

    return within(tree.body, "")
