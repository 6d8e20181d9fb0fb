"""The record of `[experiment] kind = "slide"`."""

from __future__ import annotations

from contact1d.workflow.deck.steps import Phase, UnderLoad
from contact1d.workflow.experiments.running.holding import held_phase
from contact1d.workflow.experiments.running.kind import ExperimentKind
from contact1d.workflow.experiments.running.sampling import SETTLING_LOOKS, sampled_phase
from contact1d.workflow.experiments.slide.slide import slide, slide_rows
from contact1d.workflow.scene import Scene, Slide
from contact1d.workflow.settings.settings import Settings


def planned(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    """The schedule that runs, but for the way to rest under the normal force."""
    experiment = scene.experiment
    assert isinstance(experiment, Slide)
    force = experiment.normal_force
    loading = held_phase("loading", scene, settings, (force,), force)
    if scene.noise is not None:
        loading = sampled_phase("loading", settings, force, SETTLING_LOOKS)
    rows, stride = slide_rows(scene, settings)
    return loading, Phase("sliding", (UnderLoad(force, stride),) * rows, state=True, begin=("steps/drive",))


def advice(scene: Scene) -> str:
    """A mean is known by the length of what it is taken over."""
    return "What helps is a longer experiment.distance, of more whole periods of the spacing"


SLIDE = ExperimentKind(
    run={"dynamic": slide}, planned=planned, main_results=("mean_friction", "static_friction"), advice=advice
)
