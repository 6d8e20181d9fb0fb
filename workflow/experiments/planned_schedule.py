"""The schedule of a deck that is written and not run: known for a path, estimated where a run would search."""

from __future__ import annotations

import numpy as np

from contact1d.workflow.deck.deck import Phase
from contact1d.workflow.experiments.load.dynamic import SAMPLES, SETTLING
from contact1d.workflow.experiments.path.path import schedule
from contact1d.workflow.experiments.running.holding import Start, chunk_steps, hold_row
from contact1d.workflow.experiments.slide.slide import slide_rows
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings

TENSIONS = 12
LOADING_STEPS, UNLOADING_STEPS = 24, 80


def planned(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    """A schedule without a search. For load and pull_off it follows the estimate of independent pairs."""
    kind = scene.experiment.kind
    if kind == "path":
        return schedule(scene, settings)
    if kind == "slide":
        return _slide(scene, settings)
    if scene.method == "dynamic":
        return _loads(scene, settings)
    deepest = settings.largest_displacement
    down = _rows(np.linspace(0.0, deepest, LOADING_STEPS + 1))
    if kind == "load":
        return (Phase("loading", "displace", down, state=True),)
    apart = settings.rest - settings.cutoff
    return (
        Phase("loading", "displace", down),
        Phase("unloading", "displace", _rows(np.linspace(deepest, apart, UNLOADING_STEPS)), state=True),
    )


def _rows(displacements: np.ndarray) -> tuple[tuple[float, ...], ...]:
    return tuple((float(d),) for d in displacements)


def _loads(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    tension = settings.estimate.pull_off_force()
    if scene.experiment.kind == "load":
        force = scene.experiment.force
        if scene.noise is None:
            return (_held("loading", scene, settings, (force,), max(abs(force), settings.force_scale), state=True),)
        row = (force, chunk_steps(settings))
        return Phase("settling", "load", (row,) * SETTLING), Phase("sampling", "load", (row,) * SAMPLES, state=True)
    assert scene.experiment.kind == "pull_off"
    preload = scene.experiment.preload
    tensions = tuple(float(-t) for t in np.linspace(0.0, 1.2 * tension, TENSIONS + 1)[1:])
    return (
        _held("loading", scene, settings, (preload,), max(preload, tension)),
        _held("unloading", scene, settings, (0.0,), max(preload, tension), state=True),
        _held("pulling", scene, settings, tensions, tension, state=True),
    )


def _held(
    name: str, scene: Scene, settings: Settings, loads: tuple[float, ...], scale: float, state: bool = False
) -> Phase:
    return Phase(name, "hold", tuple(hold_row(scene, settings, load, scale, Start.KEPT) for load in loads), state)


def _slide(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    experiment, cantilever = scene.experiment, scene.cantilever
    assert experiment.kind == "slide"
    assert cantilever is not None
    rows, stride = slide_rows(scene, settings)
    force = experiment.normal_force
    loading = _held("loading", scene, settings, (force,), force)
    if scene.noise is not None:
        loading = Phase("loading", "load", ((force, chunk_steps(settings)),) * SETTLING)
    return (
        loading,
        Phase("sliding", "load", ((force, stride),) * rows, state=True, begin=("steps/drive",)),
    )
