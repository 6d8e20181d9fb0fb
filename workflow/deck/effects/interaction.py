"""Effect [interaction]: V(r) = A exp(−r/a) − B exp(−r/b) between particles of opposite bodies, from a table."""

from contact1d.workflow.deck.effects import Contribution, Stage, number
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

SKIN = 0.5
"""Neighbour-list skin over the spacing: a row of a path moves a body by less, so a list lasts for a relaxation."""


def interaction(scene: Scene, settings: Settings) -> Contribution:
    """Shared slots: `pair_style`, and the tally of opposite forces in every measurement."""
    assert settings.forces.table
    return Contribution(
        "interaction",
        Stage.SPRINGS,
        ("interaction",),
        {"interaction_skin": number(SKIN * scene.bodies.spacing)},
        pair_style=f"table spline {settings.forces.table.points}",
        step_begin=("steps/measuring_opposite",),
        step_end=("steps/measured_opposite",),
    )
