"""A contact in a line of Python: `contact1d.sphere(radius="2 mm", upper="rubber", lower="glass").load("1 N")`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, overload

from contact1d.files import AnyPath
from contact1d.workflow.identify.choice import on_plane, usual_preload
from contact1d.workflow.identify.contact import AskedContact, read_contact
from contact1d.workflow.runs.advised import run
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.scene import Measured, Scene
from contact1d.workflow.scene.quantities import keys_of


@dataclass(frozen=True)
class Contact:
    """A body on a flat one, which experiments are made with; `sphere`, `cone`, `punch` and `profile` make it.

    Each experiment returns the finished run. Quantities are texts with units, or numbers in SI.

    Attributes:
        asked: what was given.
    """

    asked: AskedContact

    def scene(self, kind: str, friction: float | None = None, **experiment: Any) -> Scene:
        """The scene of an experiment with the keys of docs/scene.md, to run, to sweep or to print.

        A pull-off has by default a preload of 0.7 of the theory's pull-off force.

        Raises:
            SceneError: with every problem at once.
        """
        if kind == "pull_off" and experiment.get("preload") is None:
            experiment["preload"] = usual_preload(self.asked)
        tables: dict[str, Any] = {} if friction is None else {"friction": {"coefficient": friction}}
        return on_plane(self.asked, experiment | {"kind": kind}, **tables)

    @overload
    def load(self, force: str | float, folder: AnyPath | None = None) -> Run: ...

    @overload
    def load(self, force: list[Any], folder: AnyPath | None = None) -> list[Run]: ...

    def load(self, force: Any, folder: AnyPath | None = None) -> Run | list[Run]:
        """Press with a force; negative: pull. The folder is temporary where none is given.

        Of a list of forces a run for each, in folders 1, 2, … of the folder.
        """
        if isinstance(force, list):
            return [self.load(one, folder and Path(folder) / str(i)) for i, one in enumerate(force, 1)]
        return run(self.scene("load", force=force), folder)

    def pull_off(self, preload: str | float | None = None, folder: AnyPath | None = None) -> Run:
        """Press with a preload, and pull until the bodies separate; see `scene`."""
        return run(self.scene("pull_off", preload=preload), folder)

    def path(self, displacements: Any, folder: AnyPath | None = None) -> Run:
        """Follow displacements: a list, or { from, to, steps, return }."""
        return run(self.scene("path", displacements=displacements), folder)

    def tangential(
        self, normal_force: str | float, friction: float, folder: AnyPath | None = None, **experiment: Any
    ) -> Run:
        """Press with a normal force and displace tangentially, by `displacements` or `cycles`, with Coulomb's law."""
        return run(self.scene("tangential", friction, normal_force=normal_force, **experiment), folder)


def sphere(radius: str | float, counter_radius: str | float | None = None, **contact: Any) -> Contact:
    """A sphere, as a paraboloid, on a flat body, or on another sphere of `counter_radius` (negative: in a cup).

        contact1d.sphere(radius="2 mm", upper="rubber", lower="glass", work_of_adhesion="80 mJ/m²").pull_off()

    Args:
        radius: at the apex.
        counter_radius: of the other body.
        contact: `upper` and `lower` (names of materials, or tables with youngs_modulus and poisson_ratio), or
            `contact_modulus`; `work_of_adhesion`, `tolerance`, `title` (docs/identify.md).

    Raises:
        SceneError: with every problem at once.
    """
    other = {} if counter_radius is None else {"counter_radius": counter_radius}
    return _contact(contact, kind="parabola", radius=radius, **other)


def cone(half_angle: str, **contact: Any) -> Contact:
    """A cone of this angle between axis and flank, "80°"; further arguments as of `sphere`."""
    return _contact(contact, kind="cone", half_angle=half_angle)


def punch(radius: str | float, **contact: Any) -> Contact:
    """A flat punch; further arguments as of `sphere`."""
    return _contact(contact, kind="flat_punch", radius=radius)


def profile(file: AnyPath | None = None, **contact: Any) -> Contact:
    """A measured profile from a file, or from the lists `r` or `x` and `z`; further arguments as of `sphere`.

    How a scan is read say `centre`, `level`, `smooth`, `fit` and `units`, as in a scene (docs/scene.md).
    """
    keys = keys_of(Measured).keys() - {"kind", "file"}
    given: dict[str, Any] = {key: contact.pop(key) for key in keys if key in contact}
    given |= {} if file is None else {"file": str(file)}
    return _contact(contact, kind="table", **given)


def _contact(contact: dict[str, Any], **profile: Any) -> Contact:
    return Contact(read_contact({"profile": profile, **contact}, False))
