"""Effect [interaction]: V(r) = A exp(−r/a) − B exp(−r/b) between particles of opposite bodies, from a table."""

from contact1d.workflow.deck.effects import Contribution, Stage, number, skin
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene


def interaction(scene: Scene, settings: Settings) -> Contribution:
    """Return the part of the pair forces, with the shared slot `pair_style`.

    Each measurement sums those of opposite particles.
    """
    assert settings.forces.table
    return Contribution(
        "interaction",
        Stage.SPRINGS,
        ("interaction",),
        {"interaction_skin": number(skin(scene))},
        pair_style=f"table spline {settings.forces.table.points}",
        step_begin=("steps/measuring_opposite",),
        step_end=("steps/measured_opposite",),
    )
