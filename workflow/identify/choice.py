"""Which scene stands for a contact: a chain on a rigid plane, or two; spacing, springs and attraction chosen."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

from contact1d.workflow.experiments.spacing import fine_enough
from contact1d.workflow.identify.contact import AskedContact
from contact1d.workflow.identify.judgement import judged, require_size
from contact1d.workflow.identify.material import jkr_target, material_scene
from contact1d.workflow.identify.reduced import contact_radius, largest_tension, profile_in
from contact1d.workflow.identify.target import IdentifyError, Target
from contact1d.workflow.identify.theories import Theories
from contact1d.workflow.scene import Scene, scene_from_dict

PRELOAD_SHARE = 0.7
"""Preload of a pull-off over JKR's F_A, where no load is given."""


@dataclass(frozen=True)
class Choice:
    """A scene for a contact.

    Attributes:
        scene: with every number chosen; of two chains, its interaction is still to be searched for.
        theories: of an adhesive sphere; None of others.
        target: what the interaction of two chains is to give, in units of the scene; None on the plane.
        doubts: sentences, by name.
        contact_radius: that the spacing was chosen by [m].
    """

    scene: Scene
    theories: Theories | None
    target: Target | None
    doubts: dict[str, str]
    contact_radius: float


def theories_of(contact: AskedContact) -> Theories | None:
    """What is said of an adhesive sphere; None of another body, or without attraction."""
    if contact.radius is None or not contact.work_of_adhesion:
        return None
    return Theories(contact.radius, contact.contact_modulus, contact.work_of_adhesion, contact.range, contact.load)


def chosen(contact: AskedContact) -> Choice:
    """A scene for a contact.

    Raises:
        IdentifyError: no chain can stand for it; the message says what holds.
        SceneError: the profile is none.
    """
    theories = theories_of(contact)
    doubts = {} if theories is None else judged(contact, theories)
    if contact.model == "particles":
        return _particles(contact, theories, doubts)
    radius = contact_radius(contact)
    require_size(contact, radius)
    return Choice(fine_enough(partial(_on_plane, contact, radius)), theories, None, doubts, radius)


def _on_plane(contact: AskedContact, radius: float, count: int) -> Scene:
    """The scene of a chain with so many particles in the contact radius [m]: a whole number, as a punch needs."""
    unit = radius / count
    force = contact.contact_modulus * unit**2
    data = {
        "title": contact.title,
        "bodies": {
            "particles": "auto",
            "spacing": 1.0,
            "profile": profile_in(contact, unit),
            "reduction": "mdr",
            "lower": "rigid_plane",
            "bulk_stiffness": "auto",
        },
        "material": _material(contact) | {"length_unit": unit, "force_unit": force},
        "accuracy": {"tolerance": contact.tolerance},
        "experiment": _experiment(contact, force, unit),
    }
    if contact.work_of_adhesion:
        data["adhesion"] = {"work_of_adhesion": contact.work_of_adhesion * unit / force}
    return scene_from_dict(data)


def _experiment(contact: AskedContact, force: float, unit: float) -> dict[str, Any]:
    """A pull-off where something holds, else the load."""
    if not contact.work_of_adhesion:
        assert contact.load is not None
        return {"kind": "load", "force": contact.load / force}
    load = contact.load or PRELOAD_SHARE * largest_tension(contact)
    return {"kind": "pull_off", "preload": load / force}


def _material(contact: AskedContact) -> dict[str, Any]:
    if contact.bodies:
        return {name: body.model_dump() for name, body in contact.bodies.items()}
    return {"contact_modulus": contact.contact_modulus}


def _particles(contact: AskedContact, theories: Theories | None, doubts: dict[str, str]) -> Choice:
    """Two chains, whose interaction is to give JKR's F_A and a₀."""
    if theories is None or contact.radius is None or contact.profile["kind"] != "parabola":
        raise IdentifyError(
            'model = "particles" is for an adhesive sphere, with a radius and a work_of_adhesion: leave it out, and a '
            "chain on a rigid plane stands for the body"
        )
    wanted = jkr_target(contact.contact_modulus, 0.5 * contact.work_of_adhesion, contact.radius)
    scene, target = material_scene(contact.contact_modulus, contact.radius, wanted, tolerance=contact.tolerance)
    data = scene.model_dump(by_alias=True, exclude_none=True)
    data["title"] = contact.title
    assert scene.material is not None
    assert scene.material.force_unit is not None
    if contact.load:
        data["experiment"]["preload"] = contact.load / scene.material.force_unit
    image = (
        "of two chains only F_A and a_0 are JKR's, since the interaction is searched for by them: displacement, "
        'critical radius and work are those of the one-dimensional image. Without model = "particles" all of them are '
        "JKR's"
    )
    return Choice(scene_from_dict(data), theories, target, doubts | {"image": image}, wanted.zero_load_radius)
