"""The record of `[experiment] kind = "load"`."""

from __future__ import annotations

import numpy as np

from contact1d.workflow.deck.steps import Phase, displacements
from contact1d.workflow.experiments.load.dynamic import SAMPLES, load_dynamic
from contact1d.workflow.experiments.load.quasistatic import load_quasistatic
from contact1d.workflow.experiments.running.holding import held_phase
from contact1d.workflow.experiments.running.kind import ExperimentKind, advice_at_rest
from contact1d.workflow.experiments.running.prescribing import LOADING_STEPS, curve_steps, in_smaller_steps
from contact1d.workflow.experiments.running.sampling import SETTLING_LOOKS, sampled_phase
from contact1d.workflow.scene import Load, Scene
from contact1d.workflow.settings.settings import Settings


def planned(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    """The schedule by the estimate of independent pairs."""
    experiment = scene.experiment
    assert isinstance(experiment, Load)
    force = experiment.force
    if scene.method == "quasistatic":
        steps = curve_steps(settings) if scene.is_stepped else LOADING_STEPS
        down = displacements(np.linspace(0.0, settings.largest_displacement, steps + 1).tolist())
        return (Phase("loading", down, state=True),)
    if scene.noise is None:
        return (held_phase("loading", scene, settings, (force,), max(abs(force), settings.force_scale), state=True),)
    return (
        sampled_phase("settling", settings, force, SETTLING_LOOKS),
        sampled_phase("sampling", settings, force, SAMPLES, state=True),
    )


LOAD = ExperimentKind(
    run={"quasistatic": in_smaller_steps(load_quasistatic), "dynamic": in_smaller_steps(load_dynamic)},
    planned=planned,
    main_results=("displacement", "force", "contact_radius"),
    advice=advice_at_rest,
)
