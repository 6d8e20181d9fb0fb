"""The interaction with which a scene's run has a wanted F_A and a₀: Newton's method, with runs for the values.

    ( ln F_A/F_A*,  ln a₀/a₀* )  over  ( ln of the amplitudes' factor, ln of the ranges' factor ),

the start and the slopes from independent pairs (`workflow.identify.start`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.identify.start import scaled, slopes, start
from contact1d.workflow.identify.target import IdentifyError, Target, require_reachable
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]
MOST_RUNS = 8
"""Runs after which the search gives up; two to four are usual."""
SEARCH_SHARE = 0.3
"""A search ends where both deviations are below this share of the scene's tolerance."""


@dataclass(frozen=True)
class Identified:
    """A scene that has its target.

    Attributes:
        scene: with the interaction that was found.
        run: of that scene.
        deviations: relative ones of F_A and a₀ from the target.
        runs: how many it took.
    """

    scene: Scene
    run: Run
    deviations: tuple[float, float]
    runs: int


def identify(scene: Scene, target: Target, folder: Path, progress: Progress | None = None) -> Identified:
    """Scale the interaction of a pull_off `scene` so that its F_A and a₀ are those of `target`.

    Args:
        scene: a pull_off with attraction; its interaction's shape is kept.
        target: wanted.
        folder: run folder; it holds the last run.
        progress: told of phases and steps.

    Raises:
        IdentifyError: no interaction of this shape has the target, or the search does not end.
        SettingsError, RunError: see `workflow.runs.campaign.run`.
    """
    require_reachable(scene, target)
    at = start(scene, target)
    found: Identified | None = None
    for count in range(1, MOST_RUNS + 1):
        trial = scaled(scene, at)
        finished = run(trial, folder, figures=False, progress=progress)
        reached = _deviations(
            (finished.results["adhesion_force"].value, finished.results["zero_load_radius"].value), target
        )
        found = Identified(trial, finished, (math.expm1(reached[0]), math.expm1(reached[1])), count)
        if np.abs(reached).max() < SEARCH_SHARE * scene.accuracy.tolerance:
            return found
        at = at - np.linalg.solve(slopes(scene, at), reached)
    assert found is not None
    raise IdentifyError(
        f"the search did not come to its end in {MOST_RUNS} runs: adhesion force off by {found.deviations[0]:.1e}, "
        f"zero-load radius by {found.deviations[1]:.1e}. A finer [accuracy] tolerance or more particles in a₀ may help"
    )


def _deviations(values: tuple[float, float], target: Target) -> Array:
    return np.log(np.asarray(values) / (target.adhesion_force, target.zero_load_radius))
