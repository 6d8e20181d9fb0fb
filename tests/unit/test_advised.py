"""A run that fails says which change was tried and helps; what it says can be typed."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from contact1d import RunError, load_run, read_scene, run
from contact1d.workflow.scene import Scene, SceneError, scene_from_dict
from tests.scenes import chains

SIDEWAYS = chains(1000.0, horizontal={}, experiment={"kind": "pull_off", "preload": 3.0})
"""The README's scene without neighbours under three times its preload: its particles step aside."""


def changed(scene: Scene, message: str) -> Scene:
    """The scene with the first change that a message says gives a result."""
    found = re.search(r"Tried: (.*?) gives a result", message)
    assert found is not None, message
    words = shlex.split(found[1])
    pairs = list(zip(words[::2], words[1::2], strict=True))
    sets = [value for option, value in pairs if option == "--set"]
    return read_scene(scene, sets, [value for option, value in pairs if option == "--without"])


def test_message_names_a_change_with_which_the_scene_gives_a_result(tmp_path: Path) -> None:
    scene = scene_from_dict(SIDEWAYS)
    with pytest.raises(RunError) as caught:
        run(scene, tmp_path / "run", figures=False)
    assert "lower the load" not in str(caught.value)  # what nobody tried
    assert "Tried: --without horizontal gives a result" in caught.value.message
    mended = changed(scene, caught.value.message)
    assert mended.horizontal is None
    assert run(mended, tmp_path / "mended", figures=False).results.adhesion_force.value > 0.0
    with pytest.raises(RunError, match="Tried: --without horizontal gives a result"):
        load_run(tmp_path / "run")


def test_law_that_is_none_is_mended_by_trying(tmp_path: Path) -> None:
    tables = chains(1000.0, law=(0.18, 0.39, 0.09, 0.26), experiment={"kind": "pull_off", "preload": 1.0})
    with pytest.raises(SceneError, match=r"Tried: --set interaction\.attraction\.range=0\.78 gives a result"):
        run(tables, tmp_path / "run")
    assert not (tmp_path / "run").exists()
