"""The last result of each long test, for VALIDATION.md: `WRITE_DOCS=1 pytest -m slow` writes docs/slow.json."""

from __future__ import annotations

import datetime
import json
import os
from pathlib import Path
from typing import Any

import pytest

from validation.judging.machine import machine
from validation.judging.markdown import table
from validation.judging.words import duration

SLOW = Path(__file__).parents[1] / "docs" / "slow.json"
COMMAND = "make test ARGS='-m slow'"
VERDICTS = {"passed": "PASS", "failed": "**FAIL**"}


def slow_results() -> dict[str, Any]:
    """What docs/slow.json holds: outcome, time [s], date and kind of machine of each test, by its name."""
    return dict(json.loads(SLOW.read_text(encoding="utf-8"))) if SLOW.exists() else {}


class SlowTests:
    """Writes down how each test ends, when it ends: a session of them takes hours, and parts may be run alone."""

    @staticmethod
    def pytest_runtest_logreport(report: pytest.TestReport) -> None:
        if report.when != "call" and not report.failed:
            return
        found = slow_results()
        found[report.nodeid] = {
            "outcome": "failed" if report.failed else "passed",
            "seconds": round(report.duration, 1),
            "date": datetime.date.today().isoformat(),
            "machine": machine(),
        }
        SLOW.write_text(json.dumps(dict(sorted(found.items())), indent=1) + "\n", encoding="utf-8")


def record_slow_tests(config: pytest.Config) -> None:
    """Have docs/slow.json written by this session, if it is one of the long tests and WRITE_DOCS is set."""
    worker = hasattr(config, "workerinput")  # of pytest-xdist: what it reports is written where all come together
    if config.getoption("markexpr") == "slow" and os.environ.get("WRITE_DOCS") and not worker:
        config.pluginmanager.register(SlowTests())


def slow_markdown() -> str:
    """The section of VALIDATION.md about the long tests: a row for each, with how many of its cases pass."""
    found = slow_results()
    if not found:
        return f"## Long tests\n\n`{COMMAND}` was not run for this record."
    passed = sum(one["outcome"] == "passed" for one in found.values())
    cases: dict[str, list[dict[str, Any]]] = {}
    for name, one in found.items():
        cases.setdefault(name.partition("[")[0], []).append(one)
    return (
        f"## Long tests\n\n`{COMMAND}`: **{passed} of {len(found)} cases pass.** Each test with the day on which its "
        "cases were last run, and the time that they took beside other work.\n\n"
        + table(("test", "cases", "last run", "machine", "took", "verdict"), [_row(*each) for each in cases.items()])
    )


def _row(name: str, cases: list[dict[str, Any]]) -> tuple[str, ...]:
    """Of a test whose cases ran on several days or machines, the earliest day and every machine."""
    failed = sum(one["outcome"] == "failed" for one in cases)
    machines = ", ".join(sorted({one["machine"] for one in cases}))
    took = duration(sum(one["seconds"] for one in cases))
    verdict = VERDICTS["failed" if failed else "passed"] + (f" ({failed} of {len(cases)} fail)" if failed else "")
    return f"`{name}`", str(len(cases)), min(one["date"] for one in cases), machines, took, verdict
