"""`contact1d identify` and `cost` as a person uses them."""

from __future__ import annotations

import json
import subprocess
import sys
from contextlib import chdir
from pathlib import Path

import pytest
from click.testing import Result
from typer.testing import CliRunner

from contact1d.__main__ import app

ROUGH = 2e-2
"""Of the loose runs here, and of the two printed digits of the paper's units."""
PULL_OFF = Path(__file__).parents[2] / "lammps_inputs" / "scenes" / "pull_off.toml"


def contact1d(*arguments: str | Path, cwd: Path) -> Result:
    with chdir(cwd):
        return CliRunner().invoke(app, [str(argument) for argument in arguments])


def test_a_sphere_gets_a_scene_whose_run_is_jkrs(tmp_path: Path) -> None:
    command = [
        sys.executable, "-m", "contact1d", "identify", "--contact-modulus", "200e9",
        "--surface-energy", "1", "--radius", "6.1e-6", "--tolerance", "0.01", "--out", "sphere",
    ]  # fmt: skip
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    assert "target 57.49 µN" in done.stdout
    results = json.loads((tmp_path / "sphere" / "results.json").read_text(encoding="utf-8"))
    assert results["adhesion_force"]["si"]["value"] == pytest.approx(57.491e-6, rel=ROUGH)
    assert results["zero_load_radius"]["si"]["value"] == pytest.approx(173.9e-9, rel=ROUGH)
    again = contact1d("run", "sphere/scene.toml", "--out", "again", "--no-figures", "-q", cwd=tmp_path)
    assert again.exit_code == 0, again.stderr
    assert "µN" in again.stdout


def test_a_finished_run_gets_the_units_of_table_1(tmp_path: Path) -> None:
    done = contact1d("run", PULL_OFF, "--out", "run", "--no-figures", "-q", cwd=tmp_path)
    assert done.exit_code == 0, done.stderr
    found = contact1d("identify", "--contact-modulus", "200e9", "--surface-energy", "1", "--run", "run", cwd=tmp_path)
    assert found.exit_code == 0, found.stderr
    units = dict(line.split(maxsplit=2)[1:] for line in found.stdout.splitlines() if line.startswith("  1 "))
    assert float(units["LU"].split()[0]) == pytest.approx(6.1, rel=ROUGH)  # nm
    assert float(units["FU"].split()[0]) == pytest.approx(39.0, rel=0.03)  # µN; F_A is 1 % above


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--surface-energy", "1"], "or either --run"),
        (["--surface-energy", "1", "--radius", "1e-6", "--run", "x"], "or either --run"),
        (["--radius", "1e-6"], "give --surface-energy, or --adhesion-force together"),
        (["--radius", "1e-6", "--adhesion-force", "1e-6"], "go together"),
        (["--radius", "-1", "--surface-energy", "1"], "--radius must be greater than 0, not -1"),
        (["--radius", "nan", "--surface-energy", "1"], "--radius must be greater than 0, not nan"),
        (["--run", "nowhere", "--surface-energy", "1"], "give the folder of a finished run"),
        (["--run", "nowhere", "--surface-energy", "1", "--length-unit", "1e-9"], "the run has all other values"),
        (["--radius", "1e-6", "--surface-energy", "1", "--length-unit", "1e-6"], "at most 6.5"),
        (
            ["--radius", "6.1e-6", "--adhesion-force", "1e-4", "--zero-load-radius", "170e-9"],
            "Nearest: the same force with a radius of at least",
        ),
    ],
)
def test_what_cannot_be_identified_is_told_with_exit_code_2(options: list[str], words: str, tmp_path: Path) -> None:
    done = contact1d("identify", "--contact-modulus", "200e9", *options, cwd=tmp_path)
    assert done.exit_code == 2, done.stdout
    assert words in done.stderr
    assert "Traceback" not in done.stderr
    assert not list(tmp_path.iterdir())


def test_a_run_without_adhesion_is_no_material(tmp_path: Path) -> None:
    scene = PULL_OFF.with_name("hertz_plane.toml")
    assert contact1d("run", scene, "--out", "run", "--no-figures", "-q", cwd=tmp_path).exit_code == 0
    done = contact1d("identify", "--contact-modulus", "1e9", "--surface-energy", "1", "--run", "run", cwd=tmp_path)
    assert done.exit_code == 2
    assert "no adhesion_force and no zero_load_radius" in done.stderr


@pytest.mark.parametrize("scene", [None, {}, {"bodies": "two"}])
def test_a_run_that_does_not_say_its_scene_is_told(scene: object, tmp_path: Path) -> None:
    one = {"value": 1.0, "uncertainty": 0.0, "unit": "FU"}
    document = {"status": "done", "adhesion_force": one, "zero_load_radius": one}
    (tmp_path / "results.json").write_text(json.dumps(document if scene is None else document | {"scene": scene}))
    done = contact1d("identify", "--contact-modulus", "1e9", "--surface-energy", "1", "--run", ".", cwd=tmp_path)
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr.startswith("results.json is not the results.json of a run; ")
    assert done.stderr.endswith("run its scene again\n")
    assert done.stderr.count("\n") == 1


def test_a_place_that_is_no_folder_is_told(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("mine")
    for out, words in (
        ("taken", "taken is a file; a folder is needed"),
        ("taken/in", "taken/in cannot be written: Not a"),
    ):
        done = contact1d("cost", PULL_OFF, "--out", out, cwd=tmp_path)
        assert (done.exit_code, done.stdout) == (2, "")
        assert words in done.stderr
    assert (tmp_path / "taken").read_text() == "mine"
