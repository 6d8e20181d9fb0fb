"""From a scene file to a finished run folder.

from workflow import atoms, read_scene, run

finished = run(read_scene("lammps_inputs/scenes/pull_off.toml"), "runs/pull_off")
finished.results["adhesion_force"]          # {"value": …, "uncertainty": …, "unit": "FU"}
atoms("runs/pull_off")                      # the last state as ase.Atoms
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from analysis.atoms import atoms
    from workflow.campaign import Run, RunError, run, run_many, write_deck
    from workflow.scene import Scene, SceneError, read_scene, scene_from_dict

__all__ = [
    "Run",
    "RunError",
    "Scene",
    "SceneError",
    "atoms",
    "read_scene",
    "run",
    "run_many",
    "scene_from_dict",
    "write_deck",
]

_HOMES = {
    "atoms": "analysis.atoms",
    "Run": "workflow.campaign",
    "RunError": "workflow.campaign",
    "run": "workflow.campaign",
    "run_many": "workflow.campaign",
    "write_deck": "workflow.campaign",
    "Scene": "workflow.scene",
    "SceneError": "workflow.scene",
    "read_scene": "workflow.scene",
    "scene_from_dict": "workflow.scene",
}


def __getattr__(name: str) -> object:
    """Import a public name when it is first used: the command line starts without LAMMPS, numpy or matplotlib."""
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'workflow' has no attribute {name!r}")
