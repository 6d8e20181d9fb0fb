"""The states that `[output] states` keeps of all that a run has written."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.outcome import Outcome
from contact1d.workflow.deck.steps import Phase, chosen, keeping, leave_out, marked_rows
from contact1d.workflow.scene import Scene


def with_planned_output(scene: Scene, phases: tuple[Phase, ...]) -> tuple[Phase, ...]:
    """Return a planned schedule in which the load steps are marked whose states `[output]` requires.

    They are evenly spaced over all load steps, with the last ones of phases that write a state. The phases are copies
    with `kept` set; the same phases are returned without `[output]`.
    """
    if scene.output is None:
        return phases
    rows = range(sum(len(phase.rows) for phase in phases))
    return keeping(phases, chosen(rows, scene.output.states, marked_rows(phases)))


def with_output(context: RunContext, outcome: Outcome) -> Outcome:
    """Return the outcome with a schedule in which the load steps are marked whose states `[output]` requires.

    They are evenly spaced over the load steps of the outcome's states, with the last ones of phases that write a state.
    The file of states in the run folder is rewritten without the others. The same outcome is returned, and no file is
    changed, without `[output]`.
    """
    scene = context.deck.scene
    if scene.output is None:
        return outcome
    rows = sorted({state.number for state in outcome.states})
    phases = keeping(outcome.phases, chosen(rows, scene.output.states, marked_rows(outcome.phases)))
    leave_out(context.folder, phases, context.deck.stepped)
    return replace(outcome, phases=phases)


def kept_states(scene: Scene, outcome: Outcome) -> Sequence[int] | None:
    """Return the indices, rising, of the outcome's states that are written to the file of states.

    None, for all, without `[output]`.
    """
    if scene.output is None:
        return None
    kept = [keep for phase in outcome.phases for keep in phase.kept or (True,) * len(phase.rows)]
    return [i for i, state in enumerate(outcome.states) if kept[state.number]]
