"""Claim: a run warns where what lies beyond a given cutoff changes a force by more than the tolerance."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from contact1d import Run
from tests.scenes import chains


@pytest.mark.parametrize(("cutoff", "warns"), [(1.5, True), (6.0, False)])
def test_a_tail_that_matters_is_named(run_tables: Callable[[dict[str, Any]], Run], cutoff: float, warns: bool) -> None:
    tables = chains(1000.0, experiment={"kind": "load", "force": 1.0})
    tables["interaction"] = tables["interaction"] | {"cutoff": cutoff}
    assert ("cutoff" in run_tables(tables).warnings) is warns
