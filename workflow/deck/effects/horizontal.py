"""Effect [horizontal]: particles may also move along x, against k_t u_x; k_t may differ from the normal stiffness."""

from contact1d.workflow.deck.effects.base import BINS, Contribution, Stage, number
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings


def horizontal(scene: Scene, settings: Settings) -> Contribution:
    """Shared slots: the guide's direction x; with k_t ≠ k_n the far anchors and their bond type in system.data."""
    if settings.far == 0.0:
        return Contribution("horizontal", Stage.SPRINGS, ("horizontal",))
    difference = abs(scene.tangential_stiffness - settings.bulk_stiffness)
    variables = {
        "far_bond_type": "2" if scene.neighbours is None else "3",
        "far_bond_coefficient": number(difference / 2),
        "far_length": number(settings.far),
        "far_bin": number(max(settings.far / BINS, settings.cutoff)),
    }
    return Contribution("horizontal", Stage.SPRINGS, ("horizontal", "far"), variables)
