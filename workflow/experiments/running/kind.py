"""What everything outside of an experiment needs to know of its kind, in one record."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.scene import Method, Scene
from contact1d.workflow.settings.settings import Settings


@dataclass(frozen=True)
class ExperimentKind:
    """One kind of experiment.

    Attributes:
        run: for each method, what does it.
        planned: the schedule of a deck that is written and not run: known for a path, estimated where a run would
            search.
        main_results: names of the results that an error is judged by, as far as a scene has them.
        advice: what makes a result that is known too little known better.
        branches: phases whose branch of the curve has another name than they.
    """

    run: Mapping[Method, Callable[[RunContext], Outcome]]
    planned: Callable[[Scene, Settings], tuple[Phase, ...]]
    main_results: tuple[str, ...]
    advice: Callable[[Scene], str]
    branches: Mapping[str, str] = field(default_factory=dict)

    def branch(self, phase: str) -> str:
        """The branch of the curve that a phase belongs to."""
        name = phase.partition("_")[0]
        return self.branches.get(name, name)


FINER_SPACING = "a smaller bodies.spacing at the same stiffness and energy per length"
"""What every radius gains from."""


def advice_at_rest(scene: Scene) -> str:
    """What helps a search for a state at rest, by its method."""
    if scene.method == "dynamic":
        return 'What helps is method = "quasistatic"'
    if scene.interaction is None:
        return f"What helps is {FINER_SPACING}"
    return f'What helps is to leave interaction.cutoff and bodies.particles "auto"; for a radius {FINER_SPACING}, too'
