"""The schedule of a deck that is written and not run: known for a path, estimated where a run would search."""

from __future__ import annotations

import math

import numpy as np

from workflow.deck import Phase
from workflow.experiments.dynamic import chunk_steps
from workflow.experiments.load_dynamic import SAMPLES, SETTLING
from workflow.experiments.path import schedule
from workflow.experiments.slide import slide_rows
from workflow.scene import Scene
from workflow.settings import LOADING_STEPS, Settings

SETTLED = 10.0
"""Settling times that an unsearched schedule gives each load."""
TENSIONS = 12
UNLOADING_STEPS = 80


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
    steps = math.ceil(SETTLED * settings.settle_time / settings.time_step)
    if scene.experiment.kind == "load":
        force = scene.experiment.force
        if scene.noise is None:
            return (Phase("loading", "load", ((force, steps),), state=True),)
        row = (force, chunk_steps(settings))
        return Phase("settling", "load", (row,) * SETTLING), Phase("sampling", "load", (row,) * SAMPLES, state=True)
    assert scene.experiment.kind == "pull_off"
    tension = settings.estimate.pull_off_force()
    rows = tuple((float(-t), steps) for t in np.linspace(0.0, 1.2 * tension, TENSIONS + 1)[1:])
    return (
        Phase("loading", "load", ((scene.experiment.preload, steps),)),
        Phase("unloading", "load", ((0.0, steps),), state=True),
        Phase("pulling", "load", rows, state=True),
    )


def _slide(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    experiment, cantilever = scene.experiment, scene.cantilever
    assert experiment.kind == "slide"
    assert cantilever is not None
    rows, stride = slide_rows(scene, settings)
    force = experiment.normal_force
    settle = math.ceil(SETTLED * settings.settle_time / settings.time_step)
    return (
        Phase("loading", "load", ((force, settle),)),
        Phase("sliding", "load", ((force, stride),) * rows, state=True, begin=("steps/drive",)),
    )
