"""Effects: each is a scene table, a fragment of LAMMPS text, a row of the cost table; an absent one adds nothing."""

from collections.abc import Callable
from importlib import import_module

from contact1d.workflow.deck.effects.base import Contribution, Stage
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import EFFECTS as NAMES
from contact1d.workflow.scene import Scene

EFFECTS: dict[str, Callable[[Scene, Settings], Contribution]] = {
    name: getattr(import_module(f"{__name__}.{name}"), name) for name in NAMES
}
"""The function of each effect: that of its name, in the module of its name."""

__all__ = ["EFFECTS", "Contribution", "Stage", "contributions"]


def contributions(scene: Scene, settings: Settings) -> tuple[Contribution, ...]:
    """What the effects of a scene bring to its deck."""
    return tuple(EFFECTS[name](scene, settings) for name in scene.effects)
