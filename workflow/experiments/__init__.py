"""Experiments: each kind is a folder with its record; a sequence of phases on one deck."""

from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments.load import LOAD
from contact1d.workflow.experiments.path import PATH
from contact1d.workflow.experiments.pull_off import PULL_OFF
from contact1d.workflow.experiments.running.kind import ExperimentKind
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.slowness import slowness
from contact1d.workflow.experiments.running.way import kept_way, planned_way
from contact1d.workflow.experiments.slide import SLIDE
from contact1d.workflow.experiments.tangential import TANGENTIAL
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings

__all__ = ["KINDS", "kind_of", "perform", "planned"]

KINDS: dict[str, ExperimentKind] = {
    "load": LOAD,
    "path": PATH,
    "pull_off": PULL_OFF,
    "slide": SLIDE,
    "tangential": TANGENTIAL,
}
"""By the word that a scene has for it."""


def kind_of(scene: Scene) -> ExperimentKind:
    """The record of the scene's experiment."""
    return KINDS[scene.experiment.kind]


def planned(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    """A schedule without a search."""
    return planned_way(scene, kind_of(scene).planned(scene, settings))


def perform(context: RunContext) -> Outcome:
    """Run the experiment that the scene names, with its method.

    Raises:
        UntrustedError: the result can't be trusted.
        EngineError: LAMMPS failed.
    """
    scene = context.deck.scene
    if slow := slowness(scene, context.deck.settings):
        context.progress.note(slow)
    return kept_way(context, kind_of(scene).run[scene.method](context))
