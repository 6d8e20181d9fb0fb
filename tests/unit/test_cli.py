"""The command line as a person uses it: a process of its own, its exit code and what it prints."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

SCENE = """
title = "plane"
[bodies]
particles = 21
spacing = 1.0
profile = { kind = "parabola", radius = 50.0 }
bulk_stiffness = 0.5
lower = "rigid_plane"
[experiment]
kind = "load"
force = 0.5
"""


def contact1d(*arguments: str | Path, cwd: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "contact1d.workflow.cli.app", *map(str, arguments)]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=120, check=False)


def scene_file(folder: Path, text: str = SCENE) -> Path:
    path = folder / "plane.toml"
    path.write_text(text)
    return path


def test_run_prints_numbers_and_a_picture_and_exits_with_0(tmp_path: Path) -> None:
    done = contact1d("run", scene_file(tmp_path), "--no-figures", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "±" in done.stdout
    assert "█" in done.stdout
    assert (tmp_path / "runs" / "plane" / "results.json").exists()
    assert "loading" in done.stderr  # plain progress lines where there is no terminal


def test_run_names_the_reduction_and_draws_in_the_format_that_is_asked_for(tmp_path: Path) -> None:
    done = contact1d("run", scene_file(tmp_path), "--format", "svg", "-q", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    first, *rest = done.stdout.splitlines()
    assert first.split()[:2] == ["reduction", "mdr:"]
    assert any("contact radius a" in line and "Hertz" in line and "%)" in line for line in rest)
    assert {path.suffix for path in (tmp_path / "runs" / "plane").glob("pressure*.*")} == {".svg", ".csv"}


def test_set_and_without_change_the_scene(tmp_path: Path) -> None:
    done = contact1d(
        "run", scene_file(tmp_path, SCENE + "[neighbours]\nstiffness = 0.1\n"), "--out", "here", "--no-figures", "-q",
        "--set", "experiment.force=0.25", "--without", "neighbours", cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    document = json.loads((tmp_path / "here" / "results.json").read_text())
    assert document["scene"]["experiment"]["force"] == 0.25
    assert document["effects"] == []


def test_a_wrong_scene_exits_with_2_names_every_problem_and_writes_nothing(tmp_path: Path) -> None:
    wrong = SCENE.replace("spacing = 1.0", "spacing = -1.0").replace("force = 0.5", "force = 0.5\ncolour = 1")
    done = contact1d("run", scene_file(tmp_path, wrong), cwd=tmp_path)
    assert done.returncode == 2
    assert "2 problems" in done.stderr
    assert "bodies.spacing = -1.0" in done.stderr
    assert "experiment.colour" in done.stderr
    assert not (tmp_path / "runs").exists()


def test_a_run_that_fails_exits_with_3_and_says_why_in_words(tmp_path: Path) -> None:
    done = contact1d("run", scene_file(tmp_path), "--set", "experiment.force=30", cwd=tmp_path)
    assert done.returncode == 3
    assert "end of the chain" in done.stderr
    assert "Traceback" not in done.stderr
    assert "±" not in done.stdout


def test_deck_writes_and_does_not_run(tmp_path: Path) -> None:
    done = contact1d("deck", scene_file(tmp_path), "--out", "deck", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "lmp -in in.lammps" in done.stdout
    assert not (tmp_path / "deck" / "results.json").exists()


def test_help_loads_nothing_heavy(tmp_path: Path) -> None:
    code = (
        "import sys, typer.testing, contact1d.workflow.cli.app as cli;"
        "result = typer.testing.CliRunner().invoke(cli.app, ['--help']);"
        "assert result.exit_code == 0, result.output;"
        "heavy = {'numpy', 'scipy', 'matplotlib', 'ase', 'lammps', 'pydantic', 'pint'} & set(sys.modules);"
        "assert not heavy, heavy"
    )
    subprocess.run([sys.executable, "-c", code], cwd=tmp_path, check=True, timeout=60)
