"""Effect [plate]: the upper plate is a rigid body, M Z″ = F_contact − F_load − c Z′ (Eq. 5 of the paper)."""

from workflow.effects.base import Contribution, Stage, number
from workflow.scene import Scene
from workflow.settings import Settings


def plate(scene: Scene, settings: Settings) -> Contribution:
    """Shared slot: the mass of the anchors in system.data. The drag is shared out among them."""
    assert scene.plate is not None
    anchors = settings.particles * (1 if settings.far == 0.0 else 2)
    variables = {
        "plate_damping_per_anchor": number(settings.plate_damping / anchors),
        "plate_free_x": "on" if "x" in scene.plate.free else "off",
    }
    return Contribution("plate", Stage.PLATE, ("plate",), variables, integrates="plate")
