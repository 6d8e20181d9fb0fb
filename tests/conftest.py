"""Fixtures that several test files share: small scenes, and a limit of time for every test."""

import signal
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from hypothesis import settings

from contact1d import Scene, read_scene
from tests.approx import relative
from tests.limits import LIMIT, SLOW_LIMIT, time_limit
from tests.records import record_slow_tests
from tests.run_numbers import NumbersOfRuns
from tests.scenes import PLANE, chains

settings.register_profile("repeatable", deadline=None, derandomize=True)
settings.load_profile(
    "repeatable"
)  # by itself hypothesis fails an example that takes 0.2 s, and draws others each time

SMALL = chains(
    100.0,
    bodies={"particles": 20},
    accuracy={"tolerance": 1e-2},
    experiment={"kind": "path", "displacements": [0.0, 0.05]},
)


def pytest_configure(config: pytest.Config) -> None:
    """The records that are compared or written."""
    record_slow_tests(config)
    config.pluginmanager.register(NumbersOfRuns())


pytest.approx = relative  # before any test module is imported


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """No test waits for ever: what hangs fails, setting up and tidying up included."""
    with time_limit(SLOW_LIMIT if item.get_closest_marker("slow") else LIMIT):
        return (yield)


@pytest.fixture(autouse=True, scope="session")
def ctrl_c() -> Iterator[None]:
    """Ctrl-C interrupts here and in what the tests start, also where a shell's `&` has it ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


MakeScene = Callable[..., Scene]


@pytest.fixture
def make_scene() -> MakeScene:
    """`make_scene(table={…})`: SMALL with these tables; keys of bodies are added to its own, None removes a table."""

    def make(**tables: Any) -> Scene:
        bodies = SMALL["bodies"] | tables.pop("bodies", {})
        return read_scene(SMALL | {"bodies": bodies} | tables)

    return make


@pytest.fixture
def plane() -> MakeScene:
    """`plane(force=…)`: some particles on a rigid plane, the quickest run there is; keys are of its load."""

    def make(**experiment: Any) -> Scene:
        return read_scene(PLANE | {"experiment": {"kind": "load", "force": 0.5} | experiment})

    return make
