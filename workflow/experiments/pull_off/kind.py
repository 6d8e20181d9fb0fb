"""The record of `[experiment] kind = "pull_off"`."""

from __future__ import annotations

import numpy as np

from contact1d.workflow.deck.steps import Phase, displacements
from contact1d.workflow.experiments.pull_off.dynamic import pull_off_dynamic
from contact1d.workflow.experiments.pull_off.quasistatic import pull_off_quasistatic
from contact1d.workflow.experiments.pull_off.stepped import APART
from contact1d.workflow.experiments.pull_off.thermal import planned_thermal, pull_off_thermal
from contact1d.workflow.experiments.running.holding import held_phase
from contact1d.workflow.experiments.running.kind import ExperimentKind, advice_at_rest
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.prescribing import LOADING_STEPS, in_smaller_steps
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.scene import PullOff, Scene
from contact1d.workflow.settings.settings import Settings

UNLOADING_STEPS, TENSIONS = 80, 12
"""Rows of a planned way back, and tensions of a planned pull, where a run would search."""
LARGEST_TENSION = 1.2
"""The last of these tensions over the estimate's pull-off force."""


def planned(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    """The schedule by the estimate of independent pairs."""
    experiment = scene.experiment
    assert isinstance(experiment, PullOff)
    if scene.noise is not None:
        return planned_thermal(scene, settings)
    if scene.method == "quasistatic":
        deepest, apart = settings.largest_displacement, settings.rest - settings.cutoff
        if scene.is_stepped:
            apart = APART * settings.estimate.parted(0.0)
        down = displacements(np.linspace(0.0, deepest, LOADING_STEPS + 1).tolist())
        back = displacements(np.linspace(deepest, apart, UNLOADING_STEPS).tolist())
        return (Phase("loading", down), Phase("unloading", back, state=True))
    preload, tension = experiment.preload, settings.estimate.pull_off_force()
    tensions = [float(-t) for t in np.linspace(0.0, LARGEST_TENSION * tension, TENSIONS + 1)[1:]]
    return (
        held_phase("loading", scene, settings, (preload,), max(preload, tension)),
        held_phase("unloading", scene, settings, (0.0,), max(preload, tension), state=True),
        held_phase("pulling", scene, settings, tensions, tension, state=True),
    )


def _in_time(context: RunContext) -> Outcome:
    """With heat the detachment force of each pull; without, the largest tension held."""
    return pull_off_dynamic(context) if context.deck.scene.noise is None else pull_off_thermal(context)


def advice(scene: Scene) -> str:
    """As for every search at rest; in time there is a reason of its own."""
    since = ", since force control never sees the pull-off itself" if scene.method == "dynamic" else ""
    return advice_at_rest(scene) + since


PULL_OFF = ExperimentKind(
    run={"quasistatic": in_smaller_steps(pull_off_quasistatic), "dynamic": in_smaller_steps(_in_time)},
    planned=planned,
    main_results=("adhesion_force", "zero_load_radius", "critical_radius"),
    advice=advice,
    branches={"pulling": "unloading", "separating": "unloading", "critical": "unloading"},
)
