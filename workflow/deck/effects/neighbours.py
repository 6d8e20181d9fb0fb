"""Effect [neighbours]: F = k_n (u_{i+1} − u_i) along x and z between neighbours, u from the undeformed profile."""

from contact1d.workflow.deck.effects import Contribution, Stage, number
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Neighbours, Scene


def neighbours(scene: Scene, settings: Settings) -> Contribution:
    """Return the deck part (fragments, variables) of the springs between neighbours of a body.

    Its coefficient is half their stiffness, in the units of the arguments. System.data has their bonds, and
    neighbours.moves the moves of anchors against their forces.
    """
    coefficient = number(scene.the(Neighbours).stiffness / 2)
    return Contribution(
        "neighbours",
        Stage.SPRINGS,
        ("neighbours",),
        {"neighbours_bond_coefficient": coefficient},
        springs=("neighbour_springs",),
    )
