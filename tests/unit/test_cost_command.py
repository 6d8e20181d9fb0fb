"""Claim: the errors that `contact1d cost` states are the true ones, and its command leaves a table and two files."""

import math
from pathlib import Path

import pytest

from tests.command import contact1d
from tests.scenes import SCENES, read_json

CERTAIN = 0.1
"""Of an error that is stated as a number."""
WORK, RADIUS = 0.005, 100.0
EXACT = {
    "adhesion_force": 1.5 * math.pi * WORK * RADIUS,
    "zero_load_radius": (4.5 * math.pi * WORK * RADIUS**2) ** (1 / 3),
}
"""Of `jkr.toml`: F_A = 3πWR/2, a₀ = (9πWR²/2E*)^(1/3), E* = k/h = 1."""


def test_the_errors_of_jkr_are_those_against_its_closed_form(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every error is the true one within a tenth, or a bound of it; a wider spacing has a larger one."""
    monkeypatch.chdir(tmp_path)
    done = contact1d("cost", SCENES / "jkr.toml", "--repeats", "1", "--workers", "1")
    assert done.exit_code == 0, done.stderr
    folder = tmp_path / "costs" / "jkr"
    assert {path.name for path in folder.iterdir()} == {"cost.json", "cost.png"}
    found = read_json(folder / "cost.json")
    by_spacing = {}
    for row in found["rows"]:
        assert not row["failure"]
        for name, exact in EXACT.items():
            true, (stated, is_bound) = abs(row["results"][name]["value"] / exact - 1.0), row["errors"][name]
            assert true <= stated if is_bound else true == pytest.approx(stated, rel=CERTAIN), (name, row["edit"])
        largest = max(error for error, _ in row["errors"].values())
        key, value = next(iter(row["edit"]["values"].items()))
        if key == "bodies.spacing":
            by_spacing[float(value)] = largest
        elif value == found["tolerance"]:
            own = largest
    assert by_spacing[0.8] > by_spacing[0.4] > own > by_spacing[0.1]
    for words in (f"{found['tolerance']:g} (as it is)", "discretisation of", "Keep the scene as it is"):
        assert words in done.stdout


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
    done = contact1d("cost", SCENES / f"{scene}.toml", "--out", tmp_path / "new", "--set", change)
    assert (done.exit_code, done.stdout) == (code, "")
    assert words in done.stderr
    assert not list(tmp_path.glob("new/*"))
