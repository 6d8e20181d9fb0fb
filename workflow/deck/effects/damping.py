"""Effect [damping]: F = −γ v on every particle."""

from contact1d.workflow.deck.effects import Contribution, Stage, number
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene


def damping(scene: Scene, settings: Settings) -> Contribution:
    """Return the deck part (fragments, variables) of the drag on the particles, in the units of the arguments.

    With noise it has no fragment and no variable, since the thermostat includes this drag.
    """
    if scene.noise:
        return Contribution("damping", Stage.DRAG, ())
    return Contribution("damping", Stage.DRAG, ("damping",), {"damping_coefficient": number(settings.motion.damping)})
