"""Claim: every shipped scene runs as it is shipped, and its main number stays what it was measured to be.

Each number was measured once with this program and, where the last column says so, by something independent of it.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from workflow import read_scene, run

SCENES = Path(__file__).parents[2] / "lammps_inputs" / "scenes"

PINNED = {
    # scene: (quantity, value, tolerance and what limits it)
    "hertz_plane": ("largest_force", 84.328125, 1e-6 * 84.3),  # the exact sum; threshold of the minimiser
    "load": ("displacement", 0.395227, 1e-5),  # threshold of the minimiser and of the search for the force
    "pull_off": ("adhesion_force", 1.483414, 1e-4),  # the reference solver gives 1.483414; tail beyond the cutoff
    "pull_off_dynamic": ("adhesion_force", 1.483414, 4e-3),  # the same; half a bracket of the tolerance 5e-3
    "path_hysteresis": ("adhesion_force", 0.481134, 4e-3),  # the reference solver; half an increment before a snap
    "thermal_load": ("displacement", 0.2592, 2e-3),  # statistics: four standard errors of either run
}


def test_every_shipped_scene_is_pinned() -> None:
    assert {path.stem for path in SCENES.glob("*.toml")} == PINNED.keys()


@pytest.mark.parametrize("name", PINNED)
def test_a_shipped_scene_gives_its_number(name: str, tmp_path: Path) -> None:
    quantity, value, tolerance = PINNED[name]
    results = run(read_scene(SCENES / f"{name}.toml"), tmp_path / name, figures=False).results
    assert results["status"] == "done"
    assert results["warnings"] == []
    assert results[quantity]["value"] == pytest.approx(value, abs=tolerance)
    assert abs(results[quantity]["value"] - value) <= max(3 * results[quantity]["uncertainty"], 0.2 * tolerance)
