"""The command line as a person uses it: what it prints, its exit code, what it leaves. One process of its own."""

from __future__ import annotations

import errno
import json
import re
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

import pytest
from click.testing import Result
from typer.testing import CliRunner

from contact1d.__main__ import app

ROOT = Path(__file__).parents[2]
SCENE = """
title = "plane"
[bodies]
particles = 21
spacing = 1.0
profile = { kind = "parabola", radius = 50.0 }
bulk_stiffness = 0.5
lower = "rigid_plane"
[neighbours]
stiffness = 0.1
[experiment]
kind = "load"
force = 0.5
"""


@pytest.fixture(autouse=True)
def _with_a_scene(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("plane.toml").write_text(SCENE)


def contact1d(*arguments: str) -> Result:
    return CliRunner().invoke(app, arguments)


def test_run_prints_numbers_closed_forms_and_a_picture() -> None:
    done = contact1d(
        "run", "plane.toml", "--format", "svg", "--without", "neighbours", "--set", "experiment.force=0.25"
    )
    assert done.exit_code == 0, done.stderr
    first, *rest = done.stdout.splitlines()
    assert first.split()[:2] == ["reduction", "mdr:"]
    assert any("contact radius a" in line and "±" in line and "Hertz" in line and "%)" in line for line in rest)
    assert "█" in done.stdout
    assert "loading" in done.stderr  # plain progress lines where there is no terminal
    folder = Path("runs/plane")
    assert {path.suffix for path in folder.glob("pressure*.*")} == {".svg", ".csv"}
    document = json.loads((folder / "results.json").read_text())
    assert (document["scene"]["experiment"]["force"], document["effects"]) == (0.25, [])


def test_a_wrong_scene_exits_with_2_names_every_problem_and_writes_nothing() -> None:
    done = contact1d("run", "plane.toml", "--set", "bodies.spacing=-1.0", "--set", "experiment.colour=1")
    assert done.exit_code == 2
    assert "2 problems" in done.stderr
    assert "bodies.spacing = -1.0" in done.stderr
    assert "experiment.colour" in done.stderr
    assert not Path("runs").exists()


def test_a_run_that_fails_exits_with_3_and_says_why_in_words() -> None:
    done = contact1d("run", "plane.toml", "--set", "experiment.force=30")
    assert done.exit_code == 3
    assert "end of the chain" in done.stderr
    assert "±" not in done.stdout


def test_numbers_are_printed_though_no_figure_can_be_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(errno.ENOSPC, "no space", "pressure.png")

    monkeypatch.setattr("contact1d.workflow.runs.campaign.draw", full)
    done = contact1d("run", "plane.toml")
    assert done.exit_code == 3
    assert "±" in done.stdout
    assert done.stderr.endswith("the run failed: the disk is full (pressure.png); files are kept in runs/plane\n")


def test_what_to_cite_is_said_as_in_the_repository() -> None:
    done, kept = contact1d("--cite"), (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert done.exit_code == 0, done.stderr
    cited = re.findall(r"doi *= \{(.*)\}", done.stdout)
    assert cited == re.findall(r"doi: (.*)", kept)
    assert f"version = {{{version('contact1d')}}}" in done.stdout
    assert f"version: {version('contact1d')}\n" in kept


def test_deck_writes_and_does_not_run() -> None:
    done = contact1d("deck", "plane.toml", "--out", "deck")
    assert done.exit_code == 0, done.stderr
    assert "lmp -in in.lammps" in done.stdout
    assert not Path("deck/results.json").exists()


def test_help_loads_nothing_heavy() -> None:
    code = (
        "import sys, typer.testing, contact1d.workflow.cli.app as cli;"
        "result = typer.testing.CliRunner().invoke(cli.app, ['--help']);"
        "assert result.exit_code == 0, result.output;"
        "heavy = {'numpy', 'scipy', 'matplotlib', 'ase', 'lammps', 'pydantic', 'pint'} & set(sys.modules);"
        "assert not heavy, heavy"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)
