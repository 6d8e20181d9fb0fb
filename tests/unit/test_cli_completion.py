"""A shell completes commands, scene files, effects, studies and kinds: bash asks through the environment."""

from __future__ import annotations

import os
import subprocess
import sys
from contextlib import chdir
from pathlib import Path

import pytest
from typer.testing import CliRunner

from contact1d.workflow.cli.app import app, scene_files
from contact1d.workflow.scene import EFFECTS

PROGRAM = "import sys; from contact1d.workflow.cli.app import main; main()"


def completed(words: str, cwd: Path) -> set[str]:
    """What bash is offered for the last of `words`."""
    asked = {"_CONTACT1D_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
    with chdir(cwd):
        done = CliRunner().invoke(app, env=asked, prog_name="contact1d")
    assert done.exit_code == 0, done.stderr
    return set(done.stdout.split())


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "scenes" / "more").mkdir(parents=True)
    for name in ("ball.toml", "notes.md", "scenes/cone.toml", "scenes/.hidden.toml"):
        (tmp_path / name).touch()
    return tmp_path


@pytest.mark.parametrize(
    ("words", "offered"),
    [
        ("contact1d ", {command.callback.__name__ for command in app.registered_commands if command.callback}),
        ("contact1d run ", {"ball.toml", "scenes/"}),
        ("contact1d deck ba", {"ball.toml"}),
        ("contact1d cost sc", {"scenes/cone.toml", "scenes/more/"}),
        ("contact1d run ball.toml --without n", {"neighbours", "noise"}),
        ("contact1d deck ball.toml --without ", set(EFFECTS)),
        ("contact1d new ball --kind p", {"pull_off", "path"}),
    ],
)
def test_bash_is_offered_what_fits(words: str, offered: set[str], folder: Path) -> None:
    assert completed(words, folder) == offered


def test_a_folder_that_is_not_there_has_no_scenes(folder: Path) -> None:
    assert scene_files(str(folder / "nowhere" / "b")) == []


def test_the_script_for_bash_asks_in_this_way(tmp_path: Path) -> None:
    environment = os.environ | {"_CONTACT1D_COMPLETE": "source_bash"}
    command = [sys.executable, "-c", PROGRAM]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=60)
    assert "_CONTACT1D_COMPLETE=complete_bash" in done.stdout
