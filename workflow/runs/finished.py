"""A finished run: from memory or read from its folder, it has the same face."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from html import escape
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.atoms import atoms
from contact1d.analysis.curve import (
    DETACHMENT_COLUMNS,
    DETACHMENTS,
    FRICTION_COLUMNS,
    TANGENTIAL_COLUMNS,
    Curve,
    read_columns,
    read_curve,
    read_profiles,
)
from contact1d.analysis.pressure import Profile
from contact1d.workflow.body.traction import BodyPressure, BodyShear, body_pressures, body_shears
from contact1d.workflow.continuation.outcome import Outcome
from contact1d.workflow.errors import FolderError, RunError
from contact1d.workflow.runs.report import RESULTS
from contact1d.workflow.scene import PullOff, Scene, SceneError, Slide, Tangential, scene_from_dict
from contact1d.workflow.units import FORCE, LENGTH, MASS, Quantity, Scales, scale_of

if TYPE_CHECKING:
    from ase import Atoms
    from matplotlib.figure import Figure


class Results(dict[str, Quantity]):
    """Quantities by name; each is also an attribute: `results.adhesion_force` is `results["adhesion_force"]`."""

    def __missing__(self, name: str) -> Quantity:
        """Say what there is. Raises KeyError."""
        raise KeyError(f"the run has no {name}, it has {', '.join(self) or 'no results'}")

    def __getattr__(self, name: str) -> Quantity:
        """Return the quantity of that name."""
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __dir__(self) -> list[str]:
        """Names for completion, those of the quantities among them."""
        return [*super().__dir__(), *self]

    def __repr__(self) -> str:
        """One line for each quantity."""
        return "\n".join(f"{name} = {_said(quantity)}" for name, quantity in self.items())


@dataclass(frozen=True, repr=False)
class Run:
    """A finished run; `run` returns it, `load_run` reads it from its folder. Two are equal by folder and document.

    Attributes:
        folder: with every file of the run.
        document: what results.json holds.
        scene: what ran.
        curve: the measured states, arrays by name; what curve.csv holds.
        profiles: pressure and shear along x of the reported states, by name; what profile.csv holds.
        friction: of a slide or a tangential, arrays by name; what friction.csv holds, or curve.csv beside the curve.
        detachments: of a pull-off with [noise], arrays by name, an entry for each pull; what detachments.csv holds.
        results: quantities by name, each with uncertainty and unit, and in SI where the scene has a [material].
        outcome: what the experiment handed over; None for a run that was read from its folder, or made by `run_many`.
    """

    folder: Path
    document: Mapping[str, Any]
    scene: Scene = field(compare=False)
    curve: Curve = field(compare=False)
    profiles: Mapping[str, Profile] = field(compare=False)
    friction: Mapping[str, NDArray[np.float64]] = field(compare=False)
    detachments: Mapping[str, NDArray[np.float64]] = field(default_factory=dict, compare=False)
    outcome: Outcome | None = field(default=None, compare=False)
    results: Results = field(init=False, compare=False)

    def __post_init__(self) -> None:
        """Take the quantities from the document."""
        entries = {name: entry for name, entry in self.document.items() if isinstance(entry, dict) and "value" in entry}
        object.__setattr__(self, "results", Results({name: Quantity.of(entry) for name, entry in entries.items()}))

    @property
    def status(self) -> str:
        """`done`; a run that failed has no numbers and raises instead (`run`, `load_run`)."""
        return str(self.document["status"])

    @property
    def warnings(self) -> dict[str, str]:
        """By name, what limits the trust in the numbers."""
        return {warning["name"]: warning["message"] for warning in self.document["warnings"]}

    @property
    def timing(self) -> dict[str, float]:
        """Wall time, wall and processor time in LAMMPS [s], and steps."""
        return dict(self.document["timing"])

    @property
    def scales(self) -> Scales | None:
        """What LU, FU and, where it is known, MU stand for in SI; None where that is not known."""
        units = self.document.get("units")
        if units is None:
            return None
        entries = (units[unit] for unit in (LENGTH, FORCE))
        (length, off_length), (force, off_force) = ((entry["value"], entry["uncertainty"]) for entry in entries)
        mass = units.get(MASS)
        return Scales(length, force, off_length, off_force, None if mass is None else mass["value"])

    @property
    def body_pressures(self) -> dict[str, BodyPressure]:
        """p(r) of the body of three dimensions, by state; what pressure_3d.csv holds. Empty where there is none."""
        return body_pressures(self.scene, self.profiles)

    @property
    def body_shears(self) -> dict[str, BodyShear]:
        """q(r) of the body of three dimensions, by state; what shear_3d.csv holds. Empty where there is none."""
        return body_shears(self.scene, self.profiles, self.friction, self.curve.contact_radius)

    def plot(self, name: str | None = None) -> Figure:
        """Draw a figure, by default the experiment's main one; `.savefig(path)` keeps it.

        Args:
            name: "force_displacement", "force_radius", "pressure", "pressure_3d", "friction", "tangential",
                "stick_slip", "shear_3d", "detachments" or "samples", as the files in the folder are called.

        Raises:
            ValueError: the run has no such figure; the message says which it has.
        """
        from contact1d.analysis.plots import plain_axes
        from contact1d.workflow.runs.drawing import drawings

        there = drawings(self)
        name = name or next(iter(there))
        if name not in there:
            raise ValueError(f"the run has no figure {name!r}, it has {', '.join(there)}")
        return plain_axes(there[name]())

    def atoms(self, state: int = -1) -> Atoms:
        """Return a reported state as ase.Atoms, by default the last; see `contact1d.atoms`."""
        return atoms(self.folder, state)

    def __repr__(self) -> str:
        """A few lines: title, status, folder, results, names of the warnings."""
        lines = [f"Run {self.scene.title!r}: {self.status}, {self.folder}"]
        lines += [f"  {name:<18} {_said(quantity)}" for name, quantity in self.results.items()]
        return "\n".join(lines + [f"  warnings: {', '.join(self.warnings)}"] * bool(self.warnings))

    def _repr_html_(self) -> str:
        """The same as a table, for notebooks."""
        cells = [(name.replace("_", " "), _said(quantity)) for name, quantity in self.results.items()]
        cells += [(f"warning: {name}", message) for name, message in self.warnings.items()]
        rows = "".join(f"<tr><th>{escape(name)}</th><td>{escape(text)}</td></tr>" for name, text in cells)
        caption = f"{escape(self.scene.title)}: {self.status}<br><code>{escape(str(self.folder))}</code>"
        return f"<table><caption>{caption}</caption>{rows}</table>"


def load_run(folder: str | PathLike[str]) -> Run:
    """Read a run from its folder.

    Raises:
        FolderError: the folder holds no run, or none that this version can read.
        RunError: the run failed; the message is its own.
    """
    found = read_run(Path(folder))
    if found.status != "done":
        raise RunError(str(found.document["error"]["message"]), found.folder)
    return found


def read_run(folder: Path) -> Run:
    """As `load_run`, but a run that failed is returned, without results, curve and profiles."""
    path = folder / RESULTS
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise FolderError(f"{path}: {error.strerror}; give the folder of a finished run") from None
    except ValueError:
        raise FolderError(f"{path} is no results file: run the scene again") from None
    try:
        scene = scene_from_dict(document["scene"])
        if document["status"] == "done":
            curve, profiles = read_curve(folder / "curve.csv"), read_profiles(folder / "profile.csv")
            friction, detachments = {}, {}
            if isinstance(scene.experiment, Slide):
                friction = read_columns(folder / "friction.csv", FRICTION_COLUMNS)
            elif isinstance(scene.experiment, Tangential):
                friction = read_columns(folder / "curve.csv", TANGENTIAL_COLUMNS)
            elif isinstance(scene.experiment, PullOff) and scene.noise is not None:
                detachments = read_columns(folder / f"{DETACHMENTS}.csv", DETACHMENT_COLUMNS)
        else:
            curve, profiles, friction, detachments = Curve(*np.empty((6, 0))), {}, {}, {}
            str(document["error"]["message"])
        return Run(folder.resolve(), document, scene, curve, profiles, friction, detachments)
    except (KeyError, TypeError, AttributeError, ValueError, OSError, SceneError) as error:
        reason = f"no {error}" if isinstance(error, KeyError) else str(error).partition("\n")[0]
        raise FolderError(f"{folder} holds no run that this version can read: {reason}. Run its scene again") from None


def _said(quantity: Quantity) -> str:
    if quantity.si is None:
        return str(quantity)
    factor, unit = scale_of(quantity.si.value, quantity.si.unit)
    return f"{quantity} = {Quantity(quantity.si.value * factor, quantity.si.uncertainty * factor, unit)}"
