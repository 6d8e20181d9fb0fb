"""What the validation tests share: a scene from its tables, run to the end in a folder of its own."""

from collections.abc import Callable
from itertools import count
from typing import Any

import pytest

from contact1d import Run, read_scene, run

RunTables = Callable[[dict[str, Any]], Run]


@pytest.fixture(scope="module")
def run_tables(tmp_path_factory: pytest.TempPathFactory) -> RunTables:
    """`run_tables(tables)`: the scene's tables, without a title, to a finished run; no figures."""
    numbers = count()

    def finished(tables: dict[str, Any]) -> Run:
        scene = read_scene({"title": f"validation {next(numbers)}"} | tables)
        return run(scene, tmp_path_factory.mktemp("run"), figures=False)

    return finished
