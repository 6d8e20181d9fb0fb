"""Many faults, one collection of tests: each fault is put into a fork of a process that has all tests at hand.

What is changed is the code of a function that is loaded already, so that nothing is imported or collected anew: tens of
milliseconds in place of seconds. What stands in no function, as a constant of a module, is not for this.
"""

from __future__ import annotations

import ast
import contextlib
import functools
import json
import math
import os
import resource
import signal
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

from validation.tools.faulty import CRASHES, FAILED, HANGS, QUICK, in_copy
from validation.tools.mutating import Mutant

TOLD = ".told"
"""File of a copy with a line for each mutant: its number, and the test that noticed."""
LONGEST_ROOM = 1e6
"""[s], for all mutants of a copy."""
Wanted = tuple[int, Mutant, list[str], float]
"""Number of a mutant, the mutant, its tests, and the time after which it counts as killed, the processor's own [s]."""
WAITING = 20.0
"""The same by the clock, over that: for what waits for ever, on a machine that does other things too."""


def code_in(source: str, function: str) -> CodeType | None:
    """The code of a function, of a class or alone, in a text; None where it is not in it once."""
    found = [compile(source, "<mutant>", "exec")]
    for name in function.split("."):
        found = [c for one in found for c in one.co_consts if isinstance(c, CodeType) and c.co_name == name]
    return found[0] if len(found) == 1 else None


def is_quick(mutant: Mutant, whole: str) -> bool:
    """Whether the fault is in the code of a function: not in a default value of it, and in no function's decorator."""
    same = ast.unparse(ast.parse(whole))
    before, after = code_in(same, mutant.function), code_in(mutant.source, mutant.function)
    return before is not None and after is not None and before != after


def loaded(mutant: Mutant) -> FunctionType | None:
    """The function that a mutant changes, as it is loaded."""
    found: Any = sys.modules.get("contact1d." + mutant.file.removesuffix(".py").replace("/", "."))
    for name in mutant.function.split("."):
        found = vars(found).get(name) if found is not None else None
    kinds: tuple[tuple[type, str], ...] = (
        (property, "fget"), (functools.cached_property, "func"), (staticmethod, "__func__"), (classmethod, "__func__"),
    )  # fmt: skip
    for kind, inside in kinds:
        if isinstance(found, kind):
            found = getattr(found, inside)
    while hasattr(found, "__wrapped__"):
        found = found.__wrapped__
    return found if isinstance(found, FunctionType) else None


class Patches:
    """A pytest plugin that in place of running the tests runs those of each mutant, in a fork with that mutant."""

    def __init__(self, folder: Path, wanted: Sequence[Wanted]) -> None:
        """The mutants of the copy in `folder`."""
        self._folder, self._wanted = folder, wanted
        self._noted = folder / FAILED

    def pytest_runtest_logreport(self, report: Any) -> None:
        """Note the first test that fails."""
        if report.failed and not self._noted.exists():
            self._noted.write_text(report.nodeid, encoding="utf-8")

    def pytest_runtestloop(self, session: Any) -> bool:
        """One fork for each mutant."""
        items = {item.nodeid: item for item in session.items}
        for number, mutant, tests, patience in self._wanted:
            function, code = loaded(mutant), code_in(mutant.source, mutant.function)
            if function is None or code is None:
                continue
            self._noted.unlink(missing_ok=True)
            by = self._fork(session, [items[test] for test in tests if test in items], function, code, patience)
            with (self._folder / TOLD).open("a", encoding="utf-8") as file:
                file.write(json.dumps([number, by]) + "\n")
        return True

    def _fork(self, session: Any, items: list[Any], function: FunctionType, code: CodeType, patience: float) -> str:
        child = os.fork()
        if child == 0:
            os.setsid()
            resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(patience), math.ceil(patience)))
            function.__code__ = code
            try:
                for item, after in zip(items, [*items[1:], None], strict=True):
                    session.config.hook.pytest_runtest_protocol(item=item, nextitem=after)
                    if self._noted.exists():
                        break
            except BaseException:
                self._noted.write_text("they do not run", encoding="utf-8")
            finally:
                os._exit(0)
        end = time.monotonic() + WAITING * patience
        while time.monotonic() < end:
            done, status = os.waitpid(child, os.WNOHANG)
            if done and os.WIFSIGNALED(status):
                with contextlib.suppress(ProcessLookupError):
                    os.killpg(child, signal.SIGKILL)  # what it started
                return HANGS if os.WTERMSIG(status) in (signal.SIGKILL, signal.SIGXCPU) else CRASHES
            if done:
                return self._noted.read_text(encoding="utf-8") if self._noted.exists() else ""
            time.sleep(0.005)
        os.killpg(child, signal.SIGKILL)
        os.waitpid(child, 0)
        return HANGS


def noticed(folder: Path, wanted: Sequence[Wanted], tell: Callable[[int, str], None]) -> set[int]:
    """Tell which test notices each mutant, "" for none; returns the numbers of those that could be put in."""
    told = folder / TOLD
    told.write_text("", encoding="utf-8")

    def run() -> int:
        import pytest

        files = sorted({test.partition("::")[0] for _, _, tests, _ in wanted for test in tests})
        options = [*QUICK, "--rootdir", str(folder), "--basetemp", str(folder / ".temporary")]
        return int(pytest.main([*options, *files], [Patches(folder, wanted)]))

    in_copy(folder, run, LONGEST_ROOM)
    found = [json.loads(line) for line in told.read_text(encoding="utf-8").splitlines()]
    for number, by in found:
        tell(number, by)
    return {number for number, _ in found}
