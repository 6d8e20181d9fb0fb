"""What a cost study varies in a scene: tolerance, numerical settings that it gives, effects; one at a time.

What the scene leaves to the program ("auto") stays so: it follows the tolerance. A setting is numerical where the
physics does not depend on it. With a spacing, stiffness per length is kept, and of neighbour springs stiffness times
length.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import NamedTuple

from contact1d.digits import EXACT, cleaned
from contact1d.workflow.errors import SceneEdit
from contact1d.workflow.laws import law_of
from contact1d.workflow.runs.advised import in_si
from contact1d.workflow.scene import Scene, SceneError
from contact1d.workflow.scene.quantities import Place
from contact1d.workflow.scene.tables import WHOLE

SPACING, PARTICLES = "bodies.spacing", "bodies.particles"
POWERS = {
    SPACING: 1, "bodies.bulk_stiffness": 1, "bodies.bulk_stiffness_tangential": 1, "neighbours.stiffness": -1,
    PARTICLES: -1,
}  # fmt: skip
"""Powers of the spacing by which numbers change with it."""


class Setting(NamedTuple):
    """A key of a scene file whose number costs time and buys accuracy.

    Attributes:
        factors: over the scene's number, to be tried; None: "auto".
        finer: that of a reference over the one before.
        is_numerical: whether the physics of a scene does not depend on it.
    """

    factors: tuple[float | None, ...]
    finer: float | None
    is_numerical: Callable[[Scene], object] = bool


def at_rest(scene: Scene) -> list[SceneEdit]:
    """How to find the result of a motion without time; nothing where time is physics, or there is none."""
    edit = SceneEdit({"experiment.method": "quasistatic"}, tuple(sorted({"damping", "plate"} & {*scene.effects})))
    return [edit] if scene.method == "dynamic" and edited(scene, edit) else []


SETTINGS = {
    "accuracy.tolerance": Setting((100.0, 30.0, 10.0, 3.0, 1.0, 0.1, 0.01), 0.1),
    # A chain that is allowed no other length is the body.
    PARTICLES: Setting((0.7, 1.4, None), 1.2, lambda scene: edited(scene, SceneEdit({PARTICLES: "auto"}))),
    # The spacing of opposite particles is physics, and masses and drags belong to one spacing.
    SPACING: Setting(
        (4.0, 2.0, 0.5, None), 0.5, lambda scene: scene.bodies.lower == "rigid_plane" and scene.method == "quasistatic"
    ),
    # Without attraction displacements are measured from the cutoff.
    "interaction.cutoff": Setting((0.8, None), None, lambda scene: law_of(scene).attracts(scene)),
    "experiment.displacements.steps": Setting((0.25, 0.5, 2.0), 2.0),
    "experiment.steps": Setting((0.5, 2.0, None), 2.0),
    "damping.coefficient": Setting((0.5, 2.0, None), None, at_rest),
    "noise.seed": Setting((), 3.0),
}


def numbers_of(scene: Scene) -> dict[str, float]:
    """The numbers that stand in a scene, by dotted keys; what it leaves to the program is not among them."""
    return {one.path: one.value for one in Place(scene.model_dump(by_alias=True), WHOLE) if one.is_number}


def settings_of(scene: Scene) -> dict[str, Setting]:
    """The numerical settings that a scene gives, the tolerance first."""
    numbers = numbers_of(scene)
    return {key: one for key, one in SETTINGS.items() if key in numbers and one.is_numerical(scene)}


def variants_of(scene: Scene) -> list[tuple[SceneEdit, Scene]]:
    """The variants of a scene, itself among its tolerances; those that are no scenes are left out."""
    edits = [scaled(scene, key, factor) for key, one in settings_of(scene).items() for factor in one.factors]
    edits += [*at_rest(scene), *(SceneEdit(without=(effect,)) for effect in scene.effects)]
    return [(in_si(scene, edit, EXACT), other) for edit in edits if (other := edited(scene, edit))]


def edited(scene: Scene, edit: SceneEdit) -> Scene | None:
    """The scene with an edit; None where it is none."""
    with suppress(SceneError):
        return scene.with_(edit.values, without=edit.without)
    return None


def scaled(scene: Scene, key: str, factor: float | None) -> SceneEdit:
    """A number of a scene changed by a factor, a count by an even number, a spacing with its POWERS; None: "auto"."""
    if factor is None:
        return SceneEdit({key: "auto"})
    values: dict[str, object] = {}
    numbers = numbers_of(scene)
    for one, power in (POWERS if key == SPACING else {key: 1}).items():
        number, change = numbers.get(one), factor**power
        if isinstance(number, int):
            values[one] = number + 2 * round(0.5 * number * (change - 1.0))
        elif number:
            values[one] = cleaned(number * change)
    return SceneEdit(values)


def finer(scene: Scene) -> Scene:
    """The scene with everything finer, as far as allowed: tolerance, spacing, steps; without time where this is no
    physics, with noise of another seed.
    """
    for edit in [*(scaled(scene, key, one.finer) for key, one in settings_of(scene).items()), *at_rest(scene)]:
        scene = edited(scene, edit) or scene
    return scene
