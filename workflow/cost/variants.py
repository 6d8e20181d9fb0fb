"""The variants of a scene in a cost study: its tolerance, the numerical settings that it gives, its effects, one each.

A number that the scene leaves to the program ("auto") stays "auto" and follows the tolerance. A setting is numerical
if the physics does not depend on it. A variant of the spacing keeps the bulk stiffness per length, and of neighbour
springs the stiffness times length.
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
"""Exponents of the spacing in the numbers that change with it."""


class Setting(NamedTuple):
    """A key of a scene file whose number determines accuracy and time.

    Attributes:
        factors: factors by which variants change the number of the scene; None: "auto".
        finer: factor from one reference to the next; None: "auto".
        is_numerical: whether the physics of a scene is independent of the number.
    """

    factors: tuple[float | None, ...]
    finer: float | None
    is_numerical: Callable[[Scene], object] = bool


def quasistatic(scene: Scene) -> list[SceneEdit]:
    """Return the edit that makes a motion quasi-static, without its damping and plate, as the only item of a list.

    Empty where the scene is not dynamic, or is invalid with that edit, since time is physics.
    """
    edit = SceneEdit({"experiment.method": "quasistatic"}, tuple(sorted({"damping", "plate"} & {*scene.effects})))
    return [edit] if scene.method == "dynamic" and edited(scene, edit) else []


SETTINGS = {
    "accuracy.tolerance": Setting((100.0, 30.0, 10.0, 3.0, 1.0, 0.1, 0.01), 0.1),
    # A chain that is allowed no other length is the body.
    PARTICLES: Setting((0.7, 1.4, None), 1.2, lambda scene: edited(scene, SceneEdit({PARTICLES: "auto"}))),
    # Between opposite particles the spacing is physics, and masses and drags belong to one spacing.
    SPACING: Setting(
        (4.0, 2.0, 0.5, None), 0.5, lambda scene: scene.bodies.lower == "rigid_plane" and scene.method == "quasistatic"
    ),
    # Without attraction displacements are measured from the cutoff.
    "interaction.cutoff": Setting((0.8, None), None, lambda scene: law_of(scene).attracts(scene)),
    "experiment.displacements.steps": Setting((0.25, 0.5, 2.0), 2.0),
    "experiment.steps": Setting((0.5, 2.0, None), 2.0),
    "damping.coefficient": Setting((0.5, 2.0, None), None, quasistatic),
    "noise.seed": Setting((), 3.0),
}


def numbers_of(scene: Scene) -> dict[str, float]:
    """Return the numbers of a scene other than 0, given or by default, by dotted keys; whole numbers are int.

    They are in units of the model, those of [material] in SI. Items of lists have an index, `displacements[1]`. Left
    out are keys that are "auto", or absent without a number as default.
    """
    return {place.path: place.value for place in Place(scene.model_dump(by_alias=True), WHOLE) if place.is_number}


def settings_of(scene: Scene) -> dict[str, Setting]:
    """Return the settings of a scene that are numbers, by dotted keys, the tolerance first, which has a default.

    They are tolerance, particles, spacing, cutoff, steps, damping and seed. Left out are those on "auto", absent, or on
    which the physics of this scene depends.
    """
    numbers = numbers_of(scene)
    return {key: setting for key, setting in SETTINGS.items() if key in numbers and setting.is_numerical(scene)}


def variants_of(scene: Scene) -> list[tuple[SceneEdit, Scene]]:
    """Return (edit, edited scene) of each valid variant of a scene; edits are in SI where LU and FU are known.

    They are in the order of the settings and their factors, then a quasi-static motion, then each effect left out. The
    scene itself is among the tolerances, with the factor 1; variants that are no valid scene are left out.
    """
    edits = [scaled(scene, key, factor) for key, setting in settings_of(scene).items() for factor in setting.factors]
    edits += [*quasistatic(scene), *(SceneEdit(without=(effect,)) for effect in scene.effects)]
    return [(in_si(scene, edit, EXACT), variant) for edit in edits if (variant := edited(scene, edit))]


def edited(scene: Scene, edit: SceneEdit) -> Scene | None:
    """Return a new scene with an edit; None where the result is no valid scene, or an effect to leave out is absent."""
    with suppress(SceneError):
        return scene.with_(edit.values, without=edit.without)
    return None


def scaled(scene: Scene, key: str, factor: float | None) -> SceneEdit:
    """Return the edit that scales a number of a scene by a factor, or sets it to "auto" if the factor is None.

    A count (int) changes by the nearest even number. With the spacing h bulk stiffnesses per particle change as h, that
    of neighbour springs and the number of particles as 1/h. Other numbers are rounded to 12 digits, in units of the
    model. A number that the scene lacks, or that is 0 or "auto", is left out, so that the edit may be empty.
    """
    if factor is None:
        return SceneEdit({key: "auto"})
    values: dict[str, object] = {}
    numbers = numbers_of(scene)
    for name, power in (POWERS if key == SPACING else {key: 1}).items():
        number, change = numbers.get(name), factor**power
        if isinstance(number, int):
            values[name] = number + 2 * round(0.5 * number * (change - 1.0))
        elif number:
            values[name] = cleaned(number * change)
    return SceneEdit(values)


def finer(scene: Scene) -> Scene:
    """Return the scene with tolerance, spacing, particles and steps finer, as far as its rules allow.

    One edit follows the other; one that gives no valid scene is left out. A cutoff of attracting particles becomes
    "auto", a motion quasi-static without damping and plate where such a scene is valid, and noise gets another seed.
    Without any valid edit it is the scene itself.
    """
    settings = settings_of(scene)
    for edit in [*(scaled(scene, key, setting.finer) for key, setting in settings.items()), *quasistatic(scene)]:
        scene = edited(scene, edit) or scene
    return scene
