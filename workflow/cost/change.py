"""A variant of a scene: scene keys and effects left out, which add up.

base + one knob's change = a variant;  base + several = a combination
"""

from __future__ import annotations

from dataclasses import dataclass

from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.scene.tables import TIMED

BASE_TOLERANCE = 1e-5
"""Of the base of a quasistatic scene; in time the scene's own is taken, since time costs by the tolerance."""


@dataclass(frozen=True)
class Change:
    """What makes a variant of a scene.

    Attributes:
        overrides: "table.key=value", as `--set` takes them.
        without: effects left out.
    """

    overrides: tuple[str, ...] = ()
    without: tuple[str, ...] = ()

    def __add__(self, later: Change) -> Change:
        """Both; where they meet, the later one prevails."""
        return Change(self.overrides + later.overrides, tuple(dict.fromkeys(self.without + later.without)))

    def scene(self, scene: Scene) -> Scene:
        """The changed scene. Raises SceneError where it is none."""
        return scene_from_dict(scene, self.overrides, self.without)


def base_change(scene: Scene) -> Change:
    """Much more exact than the scene (in time: as exact), on a chain and with a cutoff that are long enough."""
    tolerance = scene.accuracy.tolerance
    if scene.method == "quasistatic":
        tolerance = min(BASE_TOLERANCE, tolerance)
    return at_tolerance(scene, tolerance)


def at_tolerance(scene: Scene, tolerance: float) -> Change:
    """The tolerance, and nothing numerical that the scene fixed by itself."""
    overrides = [f"accuracy.tolerance={tolerance!r}"]
    if not scene.bodies.profile.has_edge:
        overrides.append("bodies.particles=auto")
    if scene.interaction is not None and scene.interaction.attraction is not None:
        overrides.append("interaction.cutoff=auto")
    return Change(tuple(overrides))


def with_method(scene: Scene, method: str) -> Change:
    """The scene with the other method: what exists in time only goes, or comes as far as the experiment needs it."""
    if method == "quasistatic":
        return Change(("experiment.method=quasistatic",), tuple(name for name in TIMED if name in scene.effects))
    needed = ["damping.coefficient=auto"] + (["plate.mass=auto"] if scene.experiment.kind != "path" else [])
    return Change(("experiment.method=dynamic", *needed))
