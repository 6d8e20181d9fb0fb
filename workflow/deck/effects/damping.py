"""Effect [damping]: F = −γ v on every particle."""

from contact1d.workflow.deck.effects import Contribution, Stage, number
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene


def damping(scene: Scene, settings: Settings) -> Contribution:
    """Return the part of the drag on the particles; with noise without fragments, since its thermostat includes it."""
    if scene.noise:
        return Contribution("damping", Stage.DRAG, ())
    return Contribution("damping", Stage.DRAG, ("damping",), {"damping_coefficient": number(settings.motion.damping)})
