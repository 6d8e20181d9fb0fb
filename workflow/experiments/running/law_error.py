"""What table and cutoff, or a plane that is not quite rigid, change in the force of a state."""

from __future__ import annotations

from contact1d.analysis.law_error import left_out
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings

TAIL = 10.0
"""Force of the tail beyond the cutoff, summed over particles, over the force at the cutoff times a particle's share."""
COMPLIANCE_FACTOR = 2.0
"""Error of an equilibrium over that of the force on particles held in place: they follow it, and a table's error, here
at the distances that happen to be there, is half of what it is between two entries on average."""


def law_share(scene: Scene, settings: Settings) -> float:
    """Relative error of a force that table and cutoff, or a plane that is not quite rigid, may cause, before a run."""
    if settings.table is None or settings.law is None:
        return _plane_share(scene, settings)
    tail = TAIL * abs(float(settings.law.force(settings.cutoff)))
    return (tail + settings.table.error_beyond(settings.table_from)) / settings.force_scale


def law_error(scene: Scene, settings: Settings, state: State) -> float:
    """Error of the force of a measured state that table and cutoff, or the plane, cause [FU].

    COMPLIANCE_FACTOR Σ |F_table(r) - f(r)| |z|/r over the pairs of opposite particles, F_table = 0 beyond the cutoff.
    """
    if settings.table is None or settings.law is None:
        return _plane_share(scene, settings) * abs(state.force)
    return COMPLIANCE_FACTOR * left_out(settings.law, settings.table, state.profile)


def _plane_share(scene: Scene, settings: Settings) -> float:
    neighbours = 0.0 if scene.neighbours is None else scene.neighbours.stiffness
    return 4.0 * neighbours / settings.plane_stiffness
