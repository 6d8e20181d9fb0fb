"""Experiments: load, path, pull_off, slide; each a sequence of phases on one deck."""

from workflow.experiments.bench import Bench, write_system
from workflow.experiments.load import load_quasistatic
from workflow.experiments.load_dynamic import load_dynamic
from workflow.experiments.outcome import Outcome, Quantity, UntrustedError, in_words, unmet
from workflow.experiments.pace import slowness
from workflow.experiments.path import path
from workflow.experiments.plan import planned
from workflow.experiments.pull_off_dynamic import pull_off_dynamic
from workflow.experiments.pull_off_quasistatic import pull_off_quasistatic
from workflow.experiments.quasistatic import in_smaller_steps
from workflow.experiments.slide import slide

__all__ = [
    "Bench", "Outcome", "Quantity", "UntrustedError", "in_words", "perform", "planned", "unmet", "write_system",
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


def perform(bench: Bench) -> Outcome:
    """Run the experiment that the scene names, with its method.

    Raises:
        UntrustedError: the result can't be trusted.
        EngineError: LAMMPS failed.
    """
    scene = bench.deck.scene
    if slow := slowness(scene, bench.deck.settings):
        bench.progress.note(slow)
    return EXPERIMENTS[scene.experiment.kind, scene.method](bench)
