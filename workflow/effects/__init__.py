"""Effects: each is a scene table, a fragment of LAMMPS text, a row of the cost table; an absent one adds nothing."""

from collections.abc import Callable

from workflow.effects.base import Contribution, Stage
from workflow.effects.cantilever import cantilever
from workflow.effects.damping import damping
from workflow.effects.horizontal import horizontal
from workflow.effects.interaction import interaction
from workflow.effects.neighbours import neighbours
from workflow.effects.noise import noise
from workflow.effects.plate import plate
from workflow.scene import Scene
from workflow.settings import Settings

EFFECTS: dict[str, Callable[[Scene, Settings], Contribution]] = {
    effect.__name__: effect for effect in (interaction, neighbours, horizontal, damping, noise, plate, cantilever)
}

__all__ = ["EFFECTS", "Contribution", "Stage", "contributions"]


def contributions(scene: Scene, settings: Settings) -> tuple[Contribution, ...]:
    """What the effects of a scene bring to its deck."""
    return tuple(EFFECTS[name](scene, settings) for name in scene.effects)
