"""A run that fails says what helps: the first change that its error carries was tried, once, and can be typed."""

import pickle
import re
import shlex
from itertools import pairwise
from pathlib import Path
from unittest.mock import Mock

import pytest

from contact1d import Contact1dError, RunError, SceneError, load_run, read_scene, run
from contact1d.workflow.errors import SceneEdit, TensionError
from tests.scenes import STEEL_ON_GLASS, chains

SIDEWAYS = chains(1000.0, horizontal={}, experiment={"kind": "pull_off", "preload": 3.0})
"""The scene of docs/effects.md without neighbours under three times its preload: its particles step aside."""
SHORT = {"bodies": SIDEWAYS["bodies"] | {"particles": 41}, "experiment": {"kind": "pull_off", "preload": 1.0}}
PULLED = chains(1000.0, experiment={"kind": "load", "force": -9.0})


def trials(progress: Mock) -> list[str]:
    return [note.args[0] for note in progress.note.mock_calls if note.args[0].startswith("trying a suggested fix")]


@pytest.mark.parametrize(
    ("tables", "tried"),
    [
        (SIDEWAYS, "--without horizontal"),
        (SIDEWAYS | SHORT, "--set bodies.particles=auto"),
        (PULLED, "--set experiment.force=-"),
    ],
    ids=["through", "chain_end", "tension"],
)
def test_message_names_a_change_with_which_the_scene_gives_a_result(
    tables: dict[str, object], tried: str, tmp_path: Path
) -> None:
    with pytest.raises(RunError, match=f"Tried: {tried}") as caught:
        run(tables, tmp_path / "run", figures=False, progress=(progress := Mock()))
    assert len(trials(progress)) == 1
    found = re.search(r"Tried: (.*?) gives a result", caught.value.message)
    assert found is not None
    options = shlex.split(found[1])
    sets, without = ([words[1] for words in pairwise(options) if words[0] == option]
                     for option in ("--set", "--without"))  # fmt: skip
    assert run(read_scene(tables, sets, without), tmp_path / "mended", figures=False).results
    with pytest.raises(RunError, match=f"Tried: {tried}"):  # as results.json has it
        load_run(tmp_path / "run")


def test_law_that_is_none_is_mended_by_trying(tmp_path: Path) -> None:
    tables = chains(1000.0, law=(0.18, 0.39, 0.09, 0.26), experiment={"kind": "pull_off", "preload": 1.0})
    with pytest.raises(SceneError, match=r"Tried: --set interaction\.attraction\.range=0\.78 gives a result"):
        run(tables, tmp_path / "run")
    assert not (tmp_path / "run").exists()


def test_load_that_no_pair_carries_is_refused_at_once_and_what_failed_too_is_said(tmp_path: Path) -> None:
    """200 pairs of A/a = 1.38 FU each; half of that is not carried where particles may step aside."""
    scene = read_scene(SIDEWAYS | {"experiment": {"kind": "load", "force": 1e6}}).with_({"bodies.particles": 200})
    with pytest.raises(Contact1dError, match=r"about 276\.9 FU.*Tried without a result") as caught:
        run(scene, tmp_path / "run", progress=(progress := Mock()))
    assert len(trials(progress)) == 1
    assert "--set experiment.force=138.0" in str(caught.value)


def test_changes_have_units_where_the_scene_has(tmp_path: Path) -> None:
    """They are for the scene's file, in which a plain number may have no meaning."""
    particles = (
        "bodies.lower=particles", "interaction.repulsion={ amplitude = '1 µJ', range = '1 µm' }",
        "bodies.particles=21", "experiment.force=1 kN",
    )  # fmt: skip
    with pytest.raises(Contact1dError, match=r"--set experiment\.force=\S+N\b"):
        run(read_scene(STEEL_ON_GLASS, particles), tmp_path / "run")


def test_an_error_and_its_changes_survive_pickling() -> None:
    error = pickle.loads(pickle.dumps(TensionError(-9.0, 2.0)))
    assert (error.most, error.changes) == (2.0, (SceneEdit({"experiment.force": -1.8}),))
