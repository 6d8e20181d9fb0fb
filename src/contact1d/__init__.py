"""From a scene file to a finished run: contact, adhesion and friction of one-dimensional particle chains, on LAMMPS.

    import contact1d

    scene = contact1d.read_scene("lammps_inputs/scenes/pull_off.toml")
    finished = contact1d.run(scene, "runs/pull_off")
    finished                                    # title and results
    finished.results.adhesion_force             # value, uncertainty, unit
    finished.curve.force                        # numpy arrays; also .profiles, .friction
    finished.plot()                             # a matplotlib figure
    finished.atoms()                            # the last state as ase.Atoms
    contact1d.load_run("runs/pull_off")         # the same again, from the folder

    sweep = [(scene.with_({"bodies.profile.radius": R}), f"runs/R{R}") for R in (500, 1000, 2000)]
    contact1d.run_many(sweep)                   # several at a time

    ball = contact1d.sphere(radius="2 mm", upper="rubber", lower="glass", work_of_adhesion="80 mJ/m²")
    ball.pull_off().results.adhesion_force      # also cone, punch, profile; .load, .path, .tangential

Every error about a scene, a folder or a run is a `Contact1dError`. What a scene gives in SI is in SI here, in base
units; without units LU length, FU force, MU mass, TU = √(MU·LU/FU). Compression is positive.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from contact1d.analysis.atoms import atoms
    from contact1d.workflow.engine.failure import EngineError
    from contact1d.workflow.errors import Contact1dError, FolderError, RunError, SettingsError
    from contact1d.workflow.fit.fit import fit
    from contact1d.workflow.fit.many import fit_many
    from contact1d.workflow.identify.choice import from_material
    from contact1d.workflow.identify.prony import prony_terms
    from contact1d.workflow.identify.shortcuts import Contact, cone, profile, punch, sphere
    from contact1d.workflow.runs.advised import run
    from contact1d.workflow.runs.campaign import write_deck
    from contact1d.workflow.runs.finished import Run, load_run
    from contact1d.workflow.runs.many import run_many
    from contact1d.workflow.scene import Scene, SceneError, read_scene
    from contact1d.workflow.sweep.sweep import Sweep, sweep
    from contact1d.workflow.units import Quantity

    __version__: str

__all__ = [
    "Contact",
    "Contact1dError",
    "EngineError",
    "FolderError",
    "Quantity",
    "Run",
    "RunError",
    "Scene",
    "SceneError",
    "SettingsError",
    "Sweep",
    "atoms",
    "cone",
    "fit",
    "fit_many",
    "from_material",
    "load_run",
    "profile",
    "prony_terms",
    "punch",
    "read_scene",
    "run",
    "run_many",
    "sphere",
    "sweep",
    "write_deck",
]

_HOMES = {
    "analysis.atoms": ("atoms",),
    "workflow.engine.failure": ("EngineError",),
    "workflow.errors": ("Contact1dError", "FolderError", "RunError", "SettingsError"),
    "workflow.fit.fit": ("fit",),
    "workflow.fit.many": ("fit_many",),
    "workflow.identify.choice": ("from_material",),
    "workflow.identify.prony": ("prony_terms",),
    "workflow.identify.shortcuts": ("Contact", "cone", "profile", "punch", "sphere"),
    "workflow.runs.advised": ("run",),
    "workflow.runs.campaign": ("write_deck",),
    "workflow.runs.finished": ("Run", "load_run"),
    "workflow.runs.many": ("run_many",),
    "workflow.scene": ("Scene", "SceneError", "read_scene"),
    "workflow.sweep.sweep": ("Sweep", "sweep"),
    "workflow.units": ("Quantity",),
}


def __getattr__(name: str) -> object:
    """Return a public object of this package by its name, imported when it is first used.

    So the command line starts without LAMMPS, numpy or matplotlib. "__version__" is the installed version, as text.

    Raises:
        AttributeError: there is no such public name.
    """
    if name == "__version__":
        from importlib.metadata import version

        return version("contact1d")
    for home, names in _HOMES.items():
        if name in names:
            return getattr(import_module(f"contact1d.{home}"), name)
    raise AttributeError(f"module 'contact1d' has no attribute {name!r}")


def __dir__() -> list[str]:
    """Return the public names, for completion: the list `__all__` itself, without "__version__"."""
    return __all__
