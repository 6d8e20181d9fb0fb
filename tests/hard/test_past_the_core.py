"""Claim: a load that no displacement carries is refused in words, at once: particles stand on each other before."""

from __future__ import annotations

import pytest

from contact1d import read_scene
from contact1d.workflow.model.chain import SettingsError
from contact1d.workflow.model.settings import settings_for
from tests.scenes import chains


@pytest.mark.parametrize("load", [{"kind": "load", "force": 1e4}, {"kind": "pull_off", "preload": 1e4}])
def test_a_punch_says_how_much_it_carries(load: dict[str, object]) -> None:
    bodies = {"profile": {"kind": "flat_punch", "radius": 5.0}}
    with pytest.raises(SettingsError, match="exceeds what the repulsion"):
        settings_for(read_scene(chains(100.0, bodies=bodies, experiment=load)))
