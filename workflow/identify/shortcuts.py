"""A contact in a line of Python: `contact1d.sphere(radius="2 mm", upper="rubber", lower="glass").load("1 N")`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, overload

from contact1d.files import AnyPath
from contact1d.workflow.identify.choice import default_preload, on_plane
from contact1d.workflow.identify.contact import AskedContact, read_contact
from contact1d.workflow.runs.advised import run
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.scene import Measured, Scene
from contact1d.workflow.scene.quantities import keys_of


@dataclass(frozen=True)
class Contact:
    """A body on a flat one, made by `sphere`, `cone`, `punch` or `profile`; each experiment returns the finished run.

    Quantities are texts with units, or numbers in SI.

    Attributes:
        asked: the described contact.
    """

    asked: AskedContact

    def scene(self, kind: str, friction: float | None = None, **experiment: Any) -> Scene:
        """Return the scene of an experiment on a rigid plane, in metres and newtons, to run, to sweep or to print.

        Args:
            kind: experiment, such as "pull_off"; without a preload that has 0.7 of JKR's pull-off force of the body.
            friction: coefficient μ; None: without friction.
            experiment: keys of the experiment, as in docs/scene.md.

        Raises:
            SceneError: all problems of the scene, such as a pull_off without adhesion.
        """
        if kind == "pull_off" and experiment.get("preload") is None:
            experiment["preload"] = default_preload(self.asked)
        tables: dict[str, Any] = {} if friction is None else {"friction": {"coefficient": friction}}
        return on_plane(self.asked, experiment | {"kind": kind}, **tables)

    @overload
    def load(self, force: str | float, folder: AnyPath | None = None) -> Run: ...

    @overload
    def load(self, force: list[Any], folder: AnyPath | None = None) -> list[Run]: ...

    def load(self, force: Any, folder: AnyPath | None = None) -> Run | list[Run]:
        """Return the run under a force, which presses, or pulls if it is negative: a text with a unit, or [N].

        A list of forces gives a list of runs, in their order, in the subfolders 1, 2, … of the folder. Without a
        folder, each run folder is temporary, and figures are not drawn.

        Raises:
            SceneError: the scene is invalid.
            SettingsError: its numbers lead to no computable system.
            FolderError: the folder holds something else, or another run is active in it.
            RunError: the run failed, or the contact does not sustain the force.
        """
        if isinstance(force, list):
            return [self.load(step, folder and Path(folder) / str(i)) for i, step in enumerate(force, 1)]
        return run(self.scene("load", force=force), folder)

    def pull_off(self, preload: str | float | None = None, folder: AnyPath | None = None) -> Run:
        """Return the run that presses with a preload, by default 0.7 of JKR's pull-off force, and pulls until pull-off.

        The preload is a text with a unit or [N], compression positive; without a folder, the run folder is temporary,
        and figures are not drawn.

        Raises:
            SceneError: the scene is invalid, as without adhesion.
            SettingsError: its numbers lead to no computable system.
            FolderError: the folder holds something else, or another run is active in it.
            RunError: the run failed.
        """
        return run(self.scene("pull_off", preload=preload), folder)

    def path(self, displacements: Any, folder: AnyPath | None = None) -> Run:
        """Return the finished run along displacements, compression positive, texts with units or [m].

        They are a list, or a table { from, to, steps, return }. Without a folder, the run folder is temporary, and
        figures are not drawn.

        Raises:
            SceneError: the scene is invalid.
            SettingsError: its numbers lead to no computable system.
            FolderError: the folder holds something else, or another run is active in it.
            RunError: the run failed.
        """
        return run(self.scene("path", displacements=displacements), folder)

    def tangential(
        self, normal_force: str | float, friction: float, folder: AnyPath | None = None, **experiment: Any
    ) -> Run:
        """Return the finished run under a normal force with a tangential motion under Coulomb friction.

        Args:
            normal_force: text with a unit, or [N], compression positive.
            friction: coefficient μ.
            folder: run folder; None: a temporary one, and figures are not drawn.
            experiment: `displacements` or `cycles`, and other keys of the experiment.

        Raises:
            SceneError: the scene is invalid.
            SettingsError: its numbers lead to no computable system.
            FolderError: the folder holds something else, or another run is active in it.
            RunError: the run failed.
        """
        return run(self.scene("tangential", friction, normal_force=normal_force, **experiment), folder)


def sphere(radius: str | float, counter_radius: str | float | None = None, **contact: Any) -> Contact:
    """Return the contact of a sphere, as a paraboloid, with a flat body or a sphere (`counter_radius` < 0: a cup).

        contact1d.sphere(radius="2 mm", upper="rubber", lower="glass", work_of_adhesion="80 mJ/m²").pull_off()

    Nothing runs before an experiment is called.

    Args:
        radius: radius of curvature at the apex, text with a unit or [m].
        counter_radius: radius of the opposite body, text with a unit or [m]; None: flat.
        contact: `upper` and `lower` (names of materials, or tables with youngs_modulus and poisson_ratio), or
            `contact_modulus`; `work_of_adhesion`, `tolerance`, `title` (docs/identify.md).

    Raises:
        SceneError: all problems of the description.
    """
    curvature = {} if counter_radius is None else {"counter_radius": counter_radius}
    return _contact(contact, kind="parabola", radius=radius, **curvature)


def cone(half_angle: str, **contact: Any) -> Contact:
    """Return the contact of a rigid or elastic cone with a flat body; nothing runs before an experiment is called.

    Args:
        half_angle: angle between axis and flank, such as "80°".
        contact: `upper` and `lower` (names of materials, or tables with youngs_modulus and poisson_ratio), or
            `contact_modulus`; `work_of_adhesion`, `tolerance`, `title` (docs/identify.md).

    Raises:
        SceneError: all problems of the description.
    """
    return _contact(contact, kind="cone", half_angle=half_angle)


def punch(radius: str | float, **contact: Any) -> Contact:
    """Return the contact of a flat cylindrical punch with a flat body; nothing runs before an experiment is called.

    Args:
        radius: of the punch, text with a unit or [m].
        contact: `upper` and `lower` (names of materials, or tables with youngs_modulus and poisson_ratio), or
            `contact_modulus`; `work_of_adhesion`, `tolerance`, `title` (docs/identify.md).

    Raises:
        SceneError: all problems of the description.
    """
    return _contact(contact, kind="flat_punch", radius=radius)


def profile(file: AnyPath | None = None, **contact: Any) -> Contact:
    """Return the contact of a body of measured profile, from a file or lists, with a flat body; nothing runs yet.

    `centre`, `level`, `smooth`, `fit` and `units` determine how a scan is read, as in a scene (docs/scene.md).

    Args:
        file: with columns r or x, and z; None: `r` or `x` and `z` are given as lists.
        contact: these keys of a profile; `upper` and `lower` (names of materials, or tables with youngs_modulus and
            poisson_ratio), or `contact_modulus`; `work_of_adhesion`, `tolerance`, `title` (docs/identify.md).

    Raises:
        SceneError: all problems of the description.
    """
    keys = keys_of(Measured).keys() - {"kind", "file"}
    given: dict[str, Any] = {key: contact.pop(key) for key in keys if key in contact}
    given |= {} if file is None else {"file": str(file)}
    return _contact(contact, kind="table", **given)


def _contact(contact: dict[str, Any], **profile: Any) -> Contact:
    """Return the contact of a profile, by its keys, and the description's other keys; no load or adhesion is required.

    Raises:
        SceneError: all problems of the description, such as an unknown key.
    """
    return Contact(read_contact({"profile": profile, **contact}, False))
