"""The last run of the long tests, for VALIDATION.md: `WRITE_DOCS=1 pytest -m slow` writes docs/slow.json."""

from __future__ import annotations

import datetime
import json
import os
import time
from pathlib import Path
from typing import Any

import pytest

from contact1d.workflow.judging.machine import machine
from contact1d.workflow.judging.markdown import table
from contact1d.workflow.judging.words import duration

SLOW = Path(__file__).parents[1] / "docs" / "slow.json"
COMMAND = "make test ARGS='-m slow'"


class SlowTests:
    """Notes how each test of a session ends, and writes it down in the end."""

    def __init__(self) -> None:
        self._tests: dict[str, dict[str, Any]] = {}
        self._started = time.time()

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        found = self._tests.setdefault(report.nodeid, {"outcome": "passed", "seconds": 0.0})
        found["seconds"] += report.duration
        if report.failed:
            found["outcome"] = "failed"

    def pytest_sessionfinish(self, exitstatus: int) -> None:
        if exitstatus not in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED):
            return  # it broke off
        document = {
            "date": datetime.date.today().isoformat(),
            "machine": machine(),
            "wall_s": time.time() - self._started,
            "tests": self._tests,
        }
        SLOW.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")


def record_slow_tests(config: pytest.Config) -> None:
    """Write docs/slow.json at the end of this session, if it is one of the long tests and WRITE_DOCS is set."""
    if config.getoption("markexpr") == "slow" and os.environ.get("WRITE_DOCS"):
        config.pluginmanager.register(SlowTests())


def slow_markdown() -> str:
    """The section of VALIDATION.md about the long tests."""
    found = json.loads(SLOW.read_text(encoding="utf-8"))
    tests = found["tests"]
    passed = sum(one["outcome"] == "passed" for one in tests.values())
    verdicts = {"passed": "PASS", "failed": "**FAIL**"}
    rows = [(f"`{name}`", duration(one["seconds"]), verdicts[one["outcome"]]) for name, one in tests.items()]
    return (
        f"## Long tests\n\n`{COMMAND}`, last on {found['date']}, on {found['machine']} beside other work, in "
        f"{duration(found['wall_s'])}: **{passed} of {len(tests)} pass.**\n\n"
        + table(("test", "took", "verdict"), rows)
    )
