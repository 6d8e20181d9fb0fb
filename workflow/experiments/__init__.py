"""Experiments: load, path, pull_off, slide; each a sequence of phases on one deck."""

from contact1d.workflow.experiments.load.dynamic import load_dynamic
from contact1d.workflow.experiments.load.quasistatic import load_quasistatic
from contact1d.workflow.experiments.path.path import path
from contact1d.workflow.experiments.planned_schedule import planned
from contact1d.workflow.experiments.pull_off.dynamic import pull_off_dynamic
from contact1d.workflow.experiments.pull_off.quasistatic import pull_off_quasistatic
from contact1d.workflow.experiments.running.outcome import Outcome, UntrustedError, in_words, unmet
from contact1d.workflow.experiments.running.prescribing import in_smaller_steps
from contact1d.workflow.experiments.running.run_context import RunContext, write_system
from contact1d.workflow.experiments.running.slowness import slowness
from contact1d.workflow.experiments.slide.slide import slide
from contact1d.workflow.units import Quantity

__all__ = [
    "Outcome",
    "Quantity",
    "RunContext",
    "UntrustedError",
    "in_words",
    "perform",
    "planned",
    "unmet",
    "write_system",
]  # fmt: skip

EXPERIMENTS = {
    ("load", "quasistatic"): in_smaller_steps(load_quasistatic),
    ("load", "dynamic"): load_dynamic,
    ("path", "quasistatic"): in_smaller_steps(path),
    ("path", "dynamic"): path,
    ("pull_off", "quasistatic"): in_smaller_steps(pull_off_quasistatic),
    ("pull_off", "dynamic"): pull_off_dynamic,
    ("slide", "dynamic"): slide,
}


def perform(context: RunContext) -> Outcome:
    """Run the experiment that the scene names, with its method.

    Raises:
        UntrustedError: the result can't be trusted.
        EngineError: LAMMPS failed.
    """
    scene = context.deck.scene
    if slow := slowness(scene, context.deck.settings):
        context.progress.note(slow)
    return EXPERIMENTS[scene.experiment.kind, scene.method](context)
