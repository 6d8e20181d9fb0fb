"""Effect [interaction]: V(r) = A exp(−r/a) − B exp(−r/b) between particles of opposite bodies, from a table."""

from contact1d.workflow.deck.effects import Contribution, Stage, number, skin
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene


def interaction(scene: Scene, settings: Settings) -> Contribution:
    """Return the deck part (fragments, variables) of the pair forces between opposite particles.

    It has the `pair_style` table, and as variable the skin of the neighbour lists, in the units of the arguments.
    In a measurement springs are off.

    Raises:
        AssertionError: the settings have no table.
    """
    assert settings.forces.table
    return Contribution(
        "interaction",
        Stage.SPRINGS,
        ("interaction",),
        {"interaction_skin": number(skin(scene))},
        pair_style=f"table spline {settings.forces.table.points}",
        step_begin=("steps/without_springs",),
    )
