"""Effect [neighbours]: F = k_n (u_{i+1} − u_i) along x and z between neighbours, u from the undeformed profile."""

from workflow.effects.base import Contribution, Stage, number
from workflow.scene import Scene
from workflow.settings import Settings


def neighbours(scene: Scene, settings: Settings) -> Contribution:
    """Shared slots: a bond type in system.data, and the places of the anchors (`workflow.lattice`)."""
    assert scene.neighbours is not None
    coefficient = number(scene.neighbours.stiffness / 2)
    return Contribution("neighbours", Stage.SPRINGS, ("neighbours",), {"neighbours_bond_coefficient": coefficient})
