"""From a scene file to a finished run folder.

from contact1d import atoms, read_scene, run

finished = run(read_scene("lammps_inputs/scenes/pull_off.toml"), "runs/pull_off")
finished.results["adhesion_force"]          # {"value": …, "uncertainty": …, "unit": "FU"}
atoms("runs/pull_off")                      # the last state as ase.Atoms
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from contact1d.analysis.atoms import atoms
    from contact1d.workflow.runs.campaign import Run, RunError, run, run_many, write_deck
    from contact1d.workflow.scene import Scene, SceneError, read_scene, scene_from_dict

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
    "atoms": "contact1d.analysis.atoms",
    "Run": "contact1d.workflow.runs.campaign",
    "RunError": "contact1d.workflow.runs.campaign",
    "run": "contact1d.workflow.runs.campaign",
    "run_many": "contact1d.workflow.runs.campaign",
    "write_deck": "contact1d.workflow.runs.campaign",
    "Scene": "contact1d.workflow.scene",
    "SceneError": "contact1d.workflow.scene",
    "read_scene": "contact1d.workflow.scene",
    "scene_from_dict": "contact1d.workflow.scene",
}


def __getattr__(name: str) -> object:
    """Import a public name when it is first used: the command line starts without LAMMPS, numpy or matplotlib."""
    if name in _HOMES:
        return getattr(import_module(_HOMES[name]), name)
    raise AttributeError(f"module 'contact1d' has no attribute {name!r}")
