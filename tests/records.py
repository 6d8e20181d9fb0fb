"""The last result of each long test: `WRITE_DOCS=1 pytest -m slow` writes docs/slow.json."""

import json
import os
from pathlib import Path
from typing import Any

import pytest

from validation.age import today
from validation.doors import machine

SLOW = Path(__file__).parents[1] / "docs" / "slow.json"


def slow_results() -> dict[str, Any]:
    """What docs/slow.json holds: outcome, time [s], date, commit and kind of machine of each test, by its name."""
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
            **vars(today()),
            "machine": machine(),
        }
        SLOW.write_text(json.dumps(dict(sorted(found.items())), indent=1) + "\n", encoding="utf-8")


def record_slow_tests(config: pytest.Config) -> None:
    """Have docs/slow.json written by this session, if it is one of the long tests and WRITE_DOCS is set."""
    worker = hasattr(config, "workerinput")  # of pytest-xdist: what it reports is written where all come together
    if config.getoption("markexpr") == "slow" and os.environ.get("WRITE_DOCS") and not worker:
        config.pluginmanager.register(SlowTests())
