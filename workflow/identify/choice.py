"""From a material to a finished run: the scene of a contact, one chain on a rigid plane or two chains, and its run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from contact1d.analysis.theory.adhesion import MaugisDugdale
from contact1d.files import AnyPath
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.experiments.spacing import contact_curve, contact_radius, with_spacing
from contact1d.workflow.identify.contact import AnyContact, AskedContact, read_contact
from contact1d.workflow.identify.interaction import (
    PRELOAD_SHARE,
    IdentifyError,
    Target,
    identify,
    jkr_target,
    material_scene,
)
from contact1d.workflow.identify.theories import Theories, limitations, require_size
from contact1d.workflow.runs import advised
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.scene import Scene, read_scene


@dataclass(frozen=True)
class Choice:
    """The scene that represents a contact.

    Attributes:
        contact: the described contact.
        scene: scene with every number chosen; the interaction of two chains is still to be identified.
        theories: theories of an adhesive sphere; None for any other body.
        target: F_A and a₀ that the interaction of two chains must give, in units of the scene; None on the plane.
        doubts: limitations of the scene as a model of the contact, by name.
        contact_radius: contact radius that determines the spacing [m].
    """

    contact: AskedContact
    scene: Scene
    theories: Theories | None
    target: Target | None
    doubts: Mapping[str, str]
    contact_radius: float


@dataclass(frozen=True)
class MaterialRun(Choice):
    """The finished run that represents a contact, with its scene."""

    run: Run


def choose(contact: AskedContact) -> Choice:
    """Return the scene that represents a contact, one chain on a rigid plane or two chains, and how it was chosen.

    On the plane, the experiment is a pull-off with the load as preload (0.7 of JKR's pull-off force without one), or
    without attraction the load. Two chains are chosen only by model = "particles". An adhesive sphere has its theories
    under its load, in SI; a range that is not given is 0.3 nm.

    Raises:
        IdentifyError: no chain can represent it; the message says why.
        SceneError: the profile is invalid.
        SettingsError: the bodies do not touch, or the tolerance needs too many particles.
    """
    theories, doubts = None, dict[str, str]()
    if contact.radius is not None and contact.work_of_adhesion:
        sphere = MaugisDugdale(contact.radius, contact.contact_modulus, contact.work_of_adhesion, contact.range)
        theories = Theories(sphere, contact.load)
        doubts = limitations(contact, theories)
    if contact.is_of_particles:
        return _particles(contact, theories, doubts)
    experiment: dict[str, Any] = {"kind": "load", "force": contact.load}
    if contact.work_of_adhesion:
        experiment = {"kind": "pull_off", "preload": contact.load or default_preload(contact)}
    scene = on_plane(contact, experiment)
    radius = contact_radius(scene)
    require_size(contact, radius)
    return Choice(contact, with_spacing(scene), theories, None, doubts, radius)


def default_preload(contact: AskedContact) -> float:
    """Return the preload of a pull-off without a given one [N], compression positive: 0.7 of JKR's pull-off force.

    This is that of the body's own profile. Without adhesion it is not above 0.
    """
    return -PRELOAD_SHARE * float(contact_curve(on_plane(contact, {"kind": "load", "force": 1.0}))[2].min())


def on_plane(contact: AskedContact, experiment: Any, **tables: Any) -> Scene:
    """Return the scene of a contact on a rigid plane, with an experiment and further tables, in metres and newtons.

    Args:
        contact: the described contact; one without attraction has no [adhesion].
        experiment: the table of the experiment.
        tables: further tables by name, which replace those of the description as a whole.

    Raises:
        SceneError: the tables make no valid scene.
    """
    data = contact.scene.given
    if not contact.work_of_adhesion:
        data.pop("adhesion", None)
    return read_scene(data | tables | {"experiment": experiment})


def _particles(contact: AskedContact, theories: Theories | None, doubts: dict[str, str]) -> Choice:
    """Return the scene of two chains, with JKR's F_A and a₀ as the target of their interaction, and its limitations.

    The interaction in the scene is only a start. The limitation "image" is added to `doubts` in a copy.

    Raises:
        IdentifyError: the contact is no adhesive sphere, a number of it has ±, or no interaction can have the target.
    """
    if contact.scene.shares:
        raise IdentifyError(
            f'model = "particles" fits an interaction to values alone, and {", ".join(contact.scene.shares)} has ±: '
            "leave one of the two out"
        )
    if theories is None or contact.radius is None or contact.shape.kind != "parabola":
        raise IdentifyError(
            'model = "particles" is for an adhesive sphere, with a radius and a work_of_adhesion: leave it out, and a '
            "chain on a rigid plane represents the body"
        )
    wanted = jkr_target(contact.contact_modulus, 0.5 * contact.work_of_adhesion, contact.radius)
    tolerance = contact.scene.accuracy.tolerance
    scene, target = material_scene(contact.contact_modulus, contact.radius, wanted, tolerance=tolerance)
    changes: dict[str, Any] = {"title": contact.scene.title}
    assert scene.material is not None
    assert scene.material.force_unit is not None
    if contact.load:
        changes["experiment.preload"] = contact.load / scene.material.force_unit
    image = (
        "of two chains only F_A and a_0 are JKR's, since the interaction is fitted to these two: displacement, "
        'critical radius and work are those of the one-dimensional image. Without model = "particles" all of them are '
        "JKR's"
    )
    return Choice(contact, scene.with_(changes), theories, target, doubts | {"image": image}, wanted.zero_load_radius)


def from_material(source: AnyContact, folder: AnyPath, progress: Progress | None = None) -> MaterialRun:
    """Return the finished run of a contact that is described in SI, with the scene that was chosen for it.

        contact1d.from_material("rubber.toml", "runs/rubber").run.results.adhesion_force

    With model = "particles" several runs identify the interaction, and the last one is returned, without figures.

    Args:
        source: a TOML file, by its path, or its tables; docs/identify.md has the keys.
        folder: run folder.
        progress: informed of phases and steps; None: nobody is.

    Raises:
        SceneError: all problems of the description.
        IdentifyError: no chain can represent this contact; the message says why.
        SettingsError: the numbers of the scene lead to no computable system.
        FolderError: the folder holds something else, or another run is active in it.
        RunError: LAMMPS failed, or the result can't be trusted.
    """
    choice = choose(read_contact(source))
    if choice.target is None:
        run = advised.run(choice.scene, folder, progress=progress)
    else:
        run = identify(choice.scene, choice.target, Path(folder), progress)[0]
    return MaterialRun(**vars(choice) | {"scene": run.scene, "run": run})
