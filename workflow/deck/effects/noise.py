"""Effect [noise]: thermal forces of variance 2 γ k_BT/Δt on every particle, with the damping γ (Langevin)."""

from contact1d.workflow.deck.effects.base import Contribution, Stage, number
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings


def noise(scene: Scene, settings: Settings) -> Contribution:
    """`fix langevin` takes the relaxation time m/γ."""
    assert scene.noise is not None
    variables = {
        "noise_temperature": number(scene.noise.temperature),
        "noise_damp": number(scene.bodies.mass / settings.damping),
        "noise_seed": str(scene.noise.seed),
    }
    return Contribution("noise", Stage.DRAG, ("noise",), variables)
