"""Claim: the error that `contact1d cost` states is the true one, and its command leaves a table and two files."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from click.testing import Result
from typer.testing import CliRunner

from contact1d.__main__ import app
from contact1d.workflow.cost.report import CostRecord
from tests.costs import read_record
from tests.unit.test_cost import SCENES, SPACING, STEPS, TOLERANCE

CERTAIN = 0.1
"""Of an error that is stated as a number."""
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


def cost(scene: Path | str, folder: Path, *options: str) -> tuple[Result, CostRecord]:
    call = ["cost", str(scene), "--repeats", "1", "--workers", "1", "--out", str(folder), *options]
    done = CliRunner().invoke(app, call)
    assert done.exit_code == 0, done.stderr
    return done, read_record(folder / "cost.json")


def require_true(record: CostRecord, exact: dict[str, float]) -> None:
    """Every stated error is that against the exact value, in its units, within a tenth or below the bound."""
    for one in record.rows:
        for name, value in exact.items():
            true, stated = abs(one.results[name].value / value - 1.0), one.errors[name]
            if stated.is_bound:
                assert true <= stated.relative
            else:
                assert true == pytest.approx(stated.relative, rel=CERTAIN), (name, one.edit)


def test_the_errors_of_jkr_are_those_against_its_closed_form(tmp_path: Path) -> None:
    """F_A = 3πWR/2, a₀ = (9πWR²/2E*)^(1/3), E* = k/h = 1."""
    work, radius = 0.005, 100.0
    exact = {
        "adhesion_force": 1.5 * math.pi * work * radius,
        "zero_load_radius": (4.5 * math.pi * work * radius**2) ** (1 / 3),
    }
    done, found = cost(SCENES / "jkr.toml", tmp_path)
    require_true(found, exact)
    errors = {
        float(str(one.edit.values[SPACING])): one.error.relative for one in found.rows if SPACING in one.edit.values
    }
    assert errors[0.8] > errors[0.4] > found.baseline.error.relative > errors[0.1]
    assert found.baseline.dominant.startswith("discretisation")
    assert found.baseline.error.relative > 0.0
    assert "Keep the scene as it is" in done.stdout


def test_with_an_automatic_spacing_the_error_of_hertz_follows_the_tolerance(tmp_path: Path) -> None:
    """d = (9F²/16RE*²)^(1/3), a = √(Rd)."""
    force, radius = 10.0, 10e-3
    modulus = 1.0 / ((1.0 - 0.3**2) / 210e9 + (1.0 - 0.22**2) / 70e9)
    displacement = (9.0 * force**2 / (16.0 * radius * modulus**2)) ** (1 / 3)
    _, found = cost(SCENES / "steel_on_glass.toml", tmp_path, "--set", "bodies.spacing=auto")
    require_true(found, {"displacement": displacement, "contact_radius": math.sqrt(radius * displacement)})
    errors = {one.edit.values[TOLERANCE]: one.error.relative for one in found.rows}
    assert errors[1e-3] > 10.0 * errors[1e-5]


def test_the_command_prints_a_table_and_leaves_two_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "tiny.toml").write_text(TINY, encoding="utf-8")
    done = CliRunner().invoke(app, ["cost", "tiny.toml", "--repeats", "1", "--workers", "1"])
    assert done.exit_code == 0, done.stderr
    folder = tmp_path / "costs" / "tiny"
    assert {path.name for path in folder.iterdir()} == {"cost.json", "cost.png"}
    found = read_record(folder / "cost.json")
    assert not [one.failure for one in found.rows if one.failure]
    assert {one.change[0] for one in found.rows} == {TOLERANCE, SPACING, STEPS, "without"}
    assert found.baseline.cpu_s > 0.0
    assert f"{found.tolerance:g} (as it is)" in done.stdout
    assert found.advice in done.stdout


@pytest.mark.parametrize(
    ("scene", "change", "code", "words"),
    [
        ("hertz_plane", "experiment.displacements={from=-2.0,to=-1.0,steps=2}", 3, "its main results are all 0"),
        ("mindlin", 'bodies.profile={kind="circle",radius=1.0}', 2, "would cover the profile, which ends at 1 LU"),
    ],
)
def test_a_scene_without_a_reference_ends_with_the_reason(
    scene: str, change: str, code: int, words: str, tmp_path: Path
) -> None:
    call = ["cost", str(SCENES / f"{scene}.toml"), "--out", str(tmp_path / "new"), "--set", change]
    done = CliRunner().invoke(app, call)
    assert (done.exit_code, done.stdout) == (code, "")
    assert words in done.stderr
    assert not list(tmp_path.glob("new/*"))
