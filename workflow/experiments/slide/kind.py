"""The record of `[experiment] kind = "slide"`."""

from __future__ import annotations

from contact1d.workflow.deck.steps import Phase, UnderLoad
from contact1d.workflow.experiments.running.kind import ExperimentKind
from contact1d.workflow.experiments.slide.loading import loading_phase
from contact1d.workflow.experiments.slide.slide import leg_begin, leg_name, slide
from contact1d.workflow.scene import Scene, Slide
from contact1d.workflow.settings.drive import MOST_ROWS
from contact1d.workflow.settings.settings import Settings


def planned(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    """The schedule that runs, but for the way to rest under the normal force."""
    experiment = scene.experiment
    assert isinstance(experiment, Slide)
    force = experiment.normal_force
    legs = settings.drive
    sliding = (
        Phase(
            leg_name(i), (UnderLoad(force, leg.steps),) * leg.rows, state=i == len(legs) - 1, begin=leg_begin(scene, i)
        )
        for i, leg in enumerate(legs)
    )
    return loading_phase(scene, settings, force), *sliding


def advice(scene: Scene) -> str:
    """A mean is known by the length of what it is taken over."""
    assert isinstance(scene.experiment, Slide)
    way = "experiment.distance" if scene.experiment.path is None else "last leg of experiment.path that moves"
    return (
        f"What helps is a longer {way}, of more whole periods of the spacing; not for static_friction, which is "
        f"known to what lies between two of {MOST_ROWS} rows in a spacing"
    )


SLIDE = ExperimentKind(
    run={"dynamic": slide}, planned=planned, main_results=("mean_friction", "static_friction"), advice=advice
)
