"""contact1d cost from end to end: two files, failures as rows, mistakes told."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from contact1d import read_scene
from contact1d.workflow.cli.app import app
from contact1d.workflow.cost.measure import measure
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.model.settings import settings_for
from tests.costs import read_record
from tests.unit.test_cost import SCENES, MakeScene

TINY = """
title = "tiny"
[bodies]
particles = "auto"
spacing = 1.0
profile = { kind = "parabola", radius = 100.0 }
bulk_stiffness = 0.5
lower = "rigid_plane"
[neighbours]
stiffness = 0.1
[accuracy]
tolerance = 1e-2
[experiment]
kind = "path"
displacements = { from = 0.0, to = 0.5, steps = 2 }
"""


def test_a_variant_that_fails_is_listed_and_does_not_stop_the_others(make_scene: MakeScene, tmp_path: Path) -> None:
    scene = make_scene(bodies={"particles": "auto"})
    usual = settings_for(scene)
    loose = replace(usual, forces=replace(usual.forces, residual=1e3))
    ready = {"loose": (scene, loose), "usual": (scene, usual)}
    done = measure(ready, tmp_path, repeats=2, workers=1, progress=Silent())
    assert "not converged" in done["loose"].failure
    assert not done["usual"].failure
    assert len(done["usual"].cpu_runs) == 2
    assert done["usual"].cpu_s > 0.0
    assert not list(tmp_path.iterdir())


def test_the_command_studies_a_scene_from_end_to_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tiny.toml").write_text(TINY, encoding="utf-8")
    done = CliRunner().invoke(app, ["cost", "tiny.toml", "--repeats", "1"])
    assert done.exit_code == 0, done.stderr
    assert "Keep it" in done.stdout
    assert "gave numbers" not in done.stdout  # the shortest chains are too short, which nobody asked for
    folder = tmp_path / "costs" / "tiny"
    assert {path.name for path in folder.iterdir()} == {"cost.json", "cost.png"}
    found = read_record(folder / "cost.json")
    assert {knob.name for knob in found.knobs} == {
        "accuracy.tolerance",
        "bodies.particles",
        "experiment.displacements.steps",
        "experiment.method",
        "bodies.spacing",
    }
    assert not [one.label for one in found.variants if one.failure]
    assert [one.name for one in found.effect_costs] == ["neighbours"]
    assert found.effect_costs[0].without_us > 0.0
    assert json.loads((folder / "cost.json").read_text(encoding="utf-8"))["reference"].startswith("quasistatic")


def test_a_variant_that_its_run_refuses_is_a_row_with_the_reason(tmp_path: Path) -> None:
    """A lower chain that is too short for the sliding distance is found as the run begins."""
    scene = read_scene(SCENES / "slide.toml", ["bodies.particles=34"])
    done = measure({"short": (scene, settings_for(scene))}, tmp_path, 1, 1, Silent())
    assert "too short for the sliding distance" in done["short"].failure
