"""Effects: each is a scene table, a fragment of LAMMPS text, a row of the cost table; an absent one adds nothing."""

from collections.abc import Callable

from contact1d.workflow.deck.effects.base import Contribution, Stage
from contact1d.workflow.deck.effects.cantilever import cantilever
from contact1d.workflow.deck.effects.damping import damping
from contact1d.workflow.deck.effects.horizontal import horizontal
from contact1d.workflow.deck.effects.interaction import interaction
from contact1d.workflow.deck.effects.neighbours import neighbours
from contact1d.workflow.deck.effects.noise import noise
from contact1d.workflow.deck.effects.plate import plate
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings

EFFECTS: dict[str, Callable[[Scene, Settings], Contribution]] = {
    effect.__name__: effect for effect in (interaction, neighbours, horizontal, damping, noise, plate, cantilever)
}

__all__ = ["EFFECTS", "Contribution", "Stage", "contributions"]


def contributions(scene: Scene, settings: Settings) -> tuple[Contribution, ...]:
    """What the effects of a scene bring to its deck."""
    return tuple(EFFECTS[name](scene, settings) for name in scene.effects)
