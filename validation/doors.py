"""What validation needs of the program's inside, in one place; all else is had from `contact1d.run` and results files.

`contact_of` opens a contact in a deck, so that single particles can be moved and read.
"""

import os
import platform
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from contact1d.files import write_whole
from contact1d.workflow.continuation.budget import ForceErrors, budgeted
from contact1d.workflow.continuation.contact import Contact
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.lattice import start_offset
from contact1d.workflow.deck.steps import Displace, UnderLoad
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.engine.session import Engine, Session
from contact1d.workflow.engine.worker import load_lammps
from contact1d.workflow.errors import Contact1dError, FolderError, RunError, SettingsError
from contact1d.workflow.experiments import kind_of, planned
from contact1d.workflow.experiments.spacing import with_spacing
from contact1d.workflow.experiments.thermal import chunk_steps
from contact1d.workflow.fit.fit import fit
from contact1d.workflow.fit.many import fit_many
from contact1d.workflow.identify.interaction import Target, identify, jkr_target, material_scene, scaled, start
from contact1d.workflow.model.calibration import CALIBRATION
from contact1d.workflow.model.settings import Settings, settings_for
from contact1d.workflow.runs import campaign
from contact1d.workflow.runs.campaign import write_deck
from contact1d.workflow.runs.finished import Run, load_run, read_run
from contact1d.workflow.runs.many import completed
from contact1d.workflow.runs.processors import cores, pool
from contact1d.workflow.runs.report import versions
from contact1d.workflow.runs.scales import jkr_scales
from contact1d.workflow.scene import (
    Impact,
    Parabola,
    PullOff,
    Reduction,
    Scene,
    SceneError,
    Slide,
    read_scene,
)
from contact1d.workflow.sweep.axes import read_sweep, scene_of
from contact1d.workflow.units import Quantity, rounded

IN_TIME: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}
"""Tables of a contact that comes to rest in time."""
BEFORE = (SceneError, SettingsError, FolderError)
"""What a scene is refused with before anything runs."""
TIME_LIMIT = 7200.0
"""Of LAMMPS in a deck under the hand [s], far above what anything takes: what hangs has failed."""
CPUINFO = Path("/proc/cpuinfo")


def run(scene: Scene, folder: Path, time_limit: float) -> None:
    """Run a scene as it is, with no advice where it fails. Raises as `contact1d.run`."""
    campaign.run(scene, folder, figures=False, progress=Silent(), time_limit=time_limit)


def estimated(scene: Scene, target: Target) -> Scene:
    """The scene with its interaction scaled so that independent pairs of particles have F_A [FU] and a₀ [LU]."""
    return scaled(scene, start(scene, target))


def finished(scene: Scene, folder: Path) -> Run | None:
    """The run in `folder` in units of the model, if it is of this scene and of these versions, and whole."""
    try:
        run = read_run(folder).model
    except FolderError:
        return None
    return run if run.scene == with_spacing(scene) and run.document.get("versions") == versions() else None


def finish(scenes: Mapping[str, Scene], folder: Path, workers: int) -> None:
    """Run every scene that `folder` does not have yet, each in a folder of its name.

    Raises:
        RunError: a run could not begin.
    """
    missing = [name for name, scene in scenes.items() if finished(scene, folder / name) is None]
    with pool(min(workers, max(1, len(missing)))) as executor:
        for _, entry in completed([(scenes[name], folder / name) for name in missing], executor):
            if isinstance(entry, RunError) and not entry.kept:
                raise entry


@contextmanager
def contact_of(tables: dict[str, Any], folder: Path, **motion: Any) -> Iterator[Contact]:
    """The contact of a scene, at displacement 0; numbers of its `motion` in place of the chosen ones."""
    with context_of(read_scene({"title": folder.name} | tables), folder, **motion).contact() as contact:
        yield contact


def context_of(scene: Scene, folder: Path, **motion: Any) -> RunContext:
    """What opens contacts of a scene in a folder; numbers of its `motion` in place of the chosen ones."""
    settings = settings_for(scene)
    deck = Deck(scene, replace(settings, motion=replace(settings.motion, **motion)))
    folder.mkdir(parents=True, exist_ok=True)
    write_system(deck, folder)
    return RunContext(deck, folder, Silent(), TIME_LIMIT)


def law_table(A: float, a: float, B: float, b: float) -> dict[str, dict[str, float]]:
    """[interaction] of A [FU·LU], a [LU], B [FU·LU], b [LU]."""
    return {"repulsion": {"amplitude": A, "range": a}, "attraction": {"amplitude": B, "range": b}}


def on_plane(profile: dict[str, Any], spacing: float, tolerance: float = 1e-3) -> dict[str, Any]:
    """[bodies] and [accuracy] of a profile in model units on a rigid plane, E* = 1 FU/LU²."""
    bodies = {"particles": "auto", "spacing": spacing, "bulk_stiffness": spacing, "reduction": "mdr",
              "lower": "rigid_plane", "profile": profile}  # fmt: skip
    return {"bodies": bodies, "accuracy": {"tolerance": tolerance}}


def law_of(scene: Scene) -> tuple[float, float, float, float]:
    """A [FU·LU], a [LU], B [FU·LU], b [LU] of the scene's law."""
    terms = scene.interaction
    assert terms is not None
    assert terms.attraction is not None
    return terms.repulsion.amplitude, terms.repulsion.range, terms.attraction.amplitude, terms.attraction.range


def modelled(scene: Scene) -> dict[str, Quantity]:
    """The results of a scene's experiment on its reduced model, with their errors but those of a solver."""
    with_one = with_spacing(scene)
    case = kind_of(with_one).reduction(with_one, settings_for(with_one))
    assert case is not None
    trace = case.trace(case.model)
    none = np.zeros(len(trace))
    found = budgeted(case, trace, ForceErrors(none, none, law=0.0, anchor=0.0))
    return {name: Quantity(one.value, sum(one.errors.values()), one.unit) for name, one in found.items()}


def deck_text(scene: Scene) -> str:
    """The deck of a scene with its planned schedule."""
    settings = settings_for(scene)
    return Deck(scene, settings).text(planned(scene, settings))


def shipped(name: str) -> Path:
    """A file of `lammps_inputs`, such as "scenes/paper.toml"."""
    return Path(str(files("contact1d.lammps_inputs") / name))


def sweep_points(name: str) -> dict[tuple[float, ...], Scene]:
    """The scenes of a shipped sweep by the values of the axes that have several."""
    plan = read_sweep(shipped(f"sweeps/{name}.toml"))
    varied = [i for i, axis in enumerate(plan.axes) if len(axis.values) > 1]
    found = {}
    for values in plan.values():
        found[tuple(float(values[i]) for i in varied)] = scene_of(plan, values)
    return found


def machine() -> str:
    """Kind of machine, without names: "x86_64 with 2 processors (AMD EPYC) under Linux"."""
    text = CPUINFO.read_text(encoding="utf-8") if CPUINFO.exists() else ""
    known = re.search(r"^model name\s*:\s*([^\d\n]*)", text, re.M)
    words = re.sub(r"\(.*?\)", "", known[1]).strip() if known else ""
    kind = f" ({words})" if words else ""
    return f"{platform.machine()} with {os.cpu_count()} processors{kind} under {platform.system()}"
