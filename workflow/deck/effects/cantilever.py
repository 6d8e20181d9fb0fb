"""Effect [cantilever]: F_x = c (v t − X) pulls the plate along x through a spring whose far end moves at velocity v."""

from contact1d.workflow.deck.effects.base import Contribution, Stage, number
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings


def cantilever(scene: Scene, settings: Settings) -> Contribution:
    """The drive starts with the phase that slides; see `steps/drive`."""
    assert scene.cantilever is not None
    variables = {
        "cantilever_stiffness": number(scene.cantilever.stiffness),
        "cantilever_velocity": number(scene.cantilever.velocity),
    }
    return Contribution("cantilever", Stage.PULL, ("cantilever",), variables)
