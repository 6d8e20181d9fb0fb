"""Experiments: each a script over the continuation and a reader of the resulting trace."""

from typing import Any

from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.outcome import Outcome
from contact1d.workflow.continuation.trust import slowness
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments.experiment import Experiment, in_smaller_steps
from contact1d.workflow.experiments.history import HistoryExperiment
from contact1d.workflow.experiments.hold import HoldExperiment
from contact1d.workflow.experiments.impact import ImpactExperiment
from contact1d.workflow.experiments.keeping import with_output, with_planned_output
from contact1d.workflow.experiments.load import LoadExperiment, ThermalLoad
from contact1d.workflow.experiments.path import PathExperiment, ThermalPath
from contact1d.workflow.experiments.pull_off import PullOffExperiment, ThermalPullOff
from contact1d.workflow.experiments.slide import SlideExperiment, ThermalSlide
from contact1d.workflow.experiments.tangential import TangentialExperiment
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

__all__ = ["KINDS", "kind_of", "perform", "planned"]

KINDS: dict[str, Experiment[Any]] = {
    "history": HistoryExperiment(),
    "hold": HoldExperiment(),
    "impact": ImpactExperiment(),
    "load": LoadExperiment(),
    "path": PathExperiment(),
    "pull_off": PullOffExperiment(),
    "slide": SlideExperiment(),
    "tangential": TangentialExperiment(),
}
"""Experiments by the `kind` of a scene."""
THERMAL: dict[str, Experiment[Any]] = {
    "load": ThermalLoad(),
    "path": ThermalPath(),
    "pull_off": ThermalPullOff(),
    "slide": ThermalSlide(),
}
"""Experiments under noise, by the `kind` of a scene, where they differ."""


def kind_of(scene: Scene) -> Experiment[Any]:
    """Return the experiment object of the `kind` that the scene names, one and the same for all scenes of that kind.

    With noise it is the one with averages, of a load, path, pull-off or slide.
    """
    kinds = KINDS | THERMAL if scene.noise else KINDS
    return kinds[scene.experiment.kind]


def planned(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    """Return the schedule of a deck that is written without a run: phases of load steps, in order.

    It is exact where the scene prescribes the load steps, else it is that of the reduced model, or in time what is
    known of it before a run. With [output] the load steps whose states are to be written are marked (`Phase.kept`).
    """
    return with_planned_output(scene, kind_of(scene).planned(scene, settings))


def perform(context: RunContext) -> Outcome:
    """Run the experiment that the scene names, with its method, and return its outcome.

    A scene that relaxes slowly is reported to `context.progress` before. Where bodies pass through each other the run
    restarts in smaller steps, and `context.deck` is then the deck with these. With [output] the file of states in the
    run folder is rewritten without those that are not to be kept.

    Raises:
        UntrustedError: bodies pass through each other or do not come to rest, or the contact reaches the end of a chain
            or does not sustain a force of the scene, or results contradict each other.
        EngineError: LAMMPS failed.
    """
    scene = context.deck.scene
    if slow := slowness(scene, context.deck.settings):
        context.progress.note(slow)
    return with_output(context, in_smaller_steps(kind_of(scene).run)(context))
