"""What both ways to a pull-off hand over: the states at F = 0 and at the largest tension."""

from __future__ import annotations

from collections.abc import Mapping

from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.units import Quantity


def marked_outcome(
    quantities: Mapping[str, Quantity],
    states: tuple[State, ...],
    marked: Mapping[str, State],
    phases: tuple[Phase, ...],
    warnings: Mapping[str, str],
    spacing_uncertainty: Mapping[str, float],
) -> Outcome:
    """The outcome whose profiles are those of the `marked` states; the preload is the scene's own."""
    return Outcome(
        quantities,
        states,
        {name: state.profile for name, state in marked.items()},
        {name: state.radius_or_spot.value for name, state in marked.items()},
        phases,
        warnings,
        spacing_uncertainty=spacing_uncertainty,
        prescribed=frozenset({"preload"}),
    )
