"""From a material to a finished run: the contact that a person knows, the scene that stands for it, its numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.identify.choice import Choice, chosen
from contact1d.workflow.identify.contact import AnyContact, AskedContact, read_contact
from contact1d.workflow.identify.search import identify
from contact1d.workflow.identify.theories import Theories
from contact1d.workflow.runs import advised
from contact1d.workflow.runs.campaign import AnyPath
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.scene import Scene


@dataclass(frozen=True)
class MaterialRun:
    """A contact with the run that stands for it.

    Attributes:
        contact: what was asked for.
        scene: that was chosen, and ran.
        run: of it.
        theories: what is said of an adhesive sphere; None of another body.
        doubts: by name, why the scene stands for the contact in part only.
        contact_radius: in which the spacing was chosen [m].
    """

    contact: AskedContact
    scene: Scene
    run: Run
    theories: Theories | None
    doubts: Mapping[str, str]
    contact_radius: float


def from_material(source: AnyContact, folder: AnyPath, progress: Progress | None = None) -> MaterialRun:
    """Choose a scene for a contact that is described in SI, and run it.

        contact1d.from_material("silica.toml", "runs/silica").run.results.adhesion_force

    Args:
        source: a TOML file, by its path, or its tables; see docs/identify.md.
        folder: run folder.
        progress: told of phases and steps.

    Raises:
        SceneError: the description has mistakes; all of them.
        IdentifyError: no chain can stand for this contact; the message says which theory holds, with its value.
        SettingsError, RunError: see `workflow.runs.campaign.run`.
    """
    contact = read_contact(source)
    choice = chosen(contact)
    if choice.target is not None:
        found = identify(choice.scene, choice.target, Path(folder), progress)
        return _with(contact, choice, found.scene, found.run)
    return _with(contact, choice, choice.scene, advised.run(choice.scene, folder, progress=progress))


def _with(contact: AskedContact, choice: Choice, scene: Scene, run: Run) -> MaterialRun:
    return MaterialRun(contact, scene, run, choice.theories, choice.doubts, choice.contact_radius)
