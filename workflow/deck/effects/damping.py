"""Effect [damping]: F = −γ v on every particle."""

from contact1d.workflow.deck.effects import Contribution, Stage, number
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene


def damping(scene: Scene, settings: Settings) -> Contribution:
    """With noise in the scene the Langevin thermostat does the damping, and this effect has no line of its own."""
    if scene.noise is not None:
        return Contribution("damping", Stage.DRAG, ())
    return Contribution("damping", Stage.DRAG, ("damping",), {"damping_coefficient": number(settings.damping)})
