"""A finished run: from memory or read from its folder, it has the same face; its figures, with the theory beside."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from html import escape
from math import nan, pi
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis import figures, plots
from contact1d.analysis.atoms import atoms
from contact1d.analysis.curve import (
    DETACHMENT_COLUMNS,
    DETACHMENTS,
    FRICTION_COLUMNS,
    SAMPLE_COLUMNS,
    SAMPLE_TABLE,
    TANGENTIAL_COLUMNS,
    Curve,
    read_columns,
    read_curve,
    read_profiles,
)
from contact1d.analysis.pressure import Profile
from contact1d.analysis.shear import stick_margin
from contact1d.analysis.theory.indenters import PowerLaw
from contact1d.analysis.theory.mindlin import mindlin_path, sliding_displacement
from contact1d.workflow.body.derived import REPORTED
from contact1d.workflow.body.reading import IMAGE
from contact1d.workflow.body.theory import Case, applying
from contact1d.workflow.body.traction import BodyPressure, BodyShear, body_pressures, body_shears, row_of
from contact1d.workflow.continuation.outcome import Outcome
from contact1d.workflow.continuation.state import RadiusRule
from contact1d.workflow.errors import FolderError, RunError
from contact1d.workflow.runs.report import quantities_in, read_results
from contact1d.workflow.scene import PullOff, Scene, SceneError, Slide, Tangential, scene_from_dict
from contact1d.workflow.units import FORCE, LENGTH, MASS, Quantity, Scales, scale_of

if TYPE_CHECKING:
    from ase import Atoms
    from matplotlib.figure import Figure


Array = NDArray[np.float64]
MEASURED = ("sampling", "unloading", "pulling")
"""Branches of a thermal motion that are results; the others are run-in."""
Drawings = dict[str, Callable[[], "Figure"]]
FINE = 300
"""Radii at which a closed form is drawn."""
BETWEEN = 50
"""Points of a closed form for each step of a path."""
LEAST, LARGEST = 0.05, 1.3
"""Radii over a₀ from and to which JKR is drawn; on a plane from where fixed grips part."""
SAME_LOAD = 1e-9
"""Change of a load over the load up to which it is one: round-off."""


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
        entries = quantities_in(self.document).items()
        object.__setattr__(self, "results", Results({name: Quantity.of(entry) for name, entry in entries}))

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
        there = drawings(self)
        name = name or next(iter(there))
        if name not in there:
            raise ValueError(f"the run has no figure {name!r}, it has {', '.join(there)}")
        return plots.plain_axes(there[name]())

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
        raise RunError(found.document["error"]["message"], found.folder)
    return found


def read_run(folder: Path) -> Run:
    """As `load_run`, but a run that failed is returned, without results, curve and profiles."""
    document = read_results(folder)
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
        return Run(folder.resolve(), document, scene, curve, profiles, friction, detachments)
    except (ValueError, OSError, SceneError, csv.Error) as error:
        reason = str(error).partition("\n")[0]
        raise FolderError(f"{folder} holds no run that this version can read: {reason}. Run its scene again") from None


def _said(quantity: Quantity) -> str:
    if quantity.si is None:
        return str(quantity)
    factor, unit = scale_of(quantity.si.value, quantity.si.unit)
    return f"{quantity} = {Quantity(quantity.si.value * factor, quantity.si.uncertainty * factor, unit)}"


def drawings(run: Run, scales: Scales | None = None) -> Drawings:
    """What draws each figure of a run, by the names of the files, the main one first.

    Args:
        run: finished, or as far as it came.
        scales: in place of the run's own: where they are known the figures are in SI.
    """
    title, scales = f"{run.scene.title}\n(reduction {run.scene.bodies.reduction})", scales or run.scales

    def dressed(draw: Callable[[], Figure]) -> Figure:
        figure = draw()
        figure.suptitle(title, fontsize=11)
        return figure if scales is None else plots.in_si(figure, scales.written)

    plain = _drawings(run)
    if (kept := run.folder / f"{SAMPLE_TABLE}.csv").is_file():
        measured = np.isin(run.curve.branch, MEASURED)
        traces = partial(
            figures.samples_figure, read_columns(kept, SAMPLE_COLUMNS), measured, _values(run).get("displacement")
        )
        plain = plain | {SAMPLE_TABLE: traces} if DETACHMENTS in plain else {SAMPLE_TABLE: traces} | plain
    return {name: partial(dressed, draw) for name, draw in plain.items()}


def draw(run: Run, form: str, scales: Scales | None = None) -> None:
    """Save every figure of a run in its folder; `form`: png, svg or pdf."""
    for name, figure in drawings(run, scales).items():
        plots.save_figure(figure(), run.folder / f"{name}.{form}")


def _drawings(run: Run) -> Drawings:
    """The figures without title, in model units."""
    scene, curve, profiles = run.scene, run.curve, run.profiles
    pressure: Drawings = {}
    if all(profile.x.size > 1 for profile in profiles.values()):  # one particle has no pressure over x
        radii = {state: _radius(scene, profile) for state, profile in profiles.items()}
        pressure["pressure"] = partial(figures.pressure_figure, profiles, radii)
    if scene.experiment.goes_along:
        return _sheared(run) | pressure | _body_pressure(run)
    if run.friction:
        return {"friction": partial(figures.friction_figure, run.friction), **pressure}
    if run.detachments and run.detachments["force"].size > 1:
        return {DETACHMENTS: partial(figures.detachments_figure, run.detachments["force"]), **pressure}
    if scene.noise is not None and not scene.experiment.way_is_given:
        return pressure
    values = _values(run)
    beside = _theory(scene, values, curve)
    over_d = None if beside is None else (beside[0], *beside[1][1:])
    found: Drawings = {"force_displacement": partial(figures.force_displacement_figure, curve, values, over_d)}
    if _adheres_over_a_width(values):
        marks = values["adhesion_force"], values["zero_load_radius"]
        found["force_radius"] = partial(figures.force_radius_figure, curve, *marks)
    elif np.unique(curve.contact_radius[curve.contact_radius > 0.0]).size > 1:
        over_a = (beside[0], *beside[1][::2]) if beside is not None and beside[0] == "Hertz" else None
        found["force_radius"] = partial(figures.load_radius_figure, curve, over_a)
    return found | pressure | _body_pressure(run)


def _values(run: Run) -> dict[str, float]:
    """The results by name, of lengths those of the image: they belong to the curve."""
    values = {name: quantity.value for name, quantity in run.results.items()}
    return values | {name.removeprefix(IMAGE): value for name, value in values.items() if name.startswith(IMAGE)}


def _sheared(run: Run) -> Drawings:
    """Force over displacement along x, the stick zone and q(r)."""
    theory = _mindlin(run.scene, run.curve, run.friction)
    loop = partial(figures.tangential_figure, run.friction, run.curve.branch, theory)
    found: Drawings = {"tangential": loop, "stick_slip": _stick_slip(run.scene, run.profiles, run.friction)}
    if shears := run.body_shears:
        lines = {name: (one.r, one.shear, one.edge, one.stick) for name, one in shears.items()}
        found["shear_3d"] = partial(figures.body_shear_figure, lines)
    return found


def _body_pressure(run: Run) -> Drawings:
    """p(r) of the body, where there is one, and the closed form beside it for the state that it speaks of."""
    pressures, case = run.body_pressures, Case(run.scene, run.results)
    theories: dict[str, tuple[str, Array, Array]] = {}
    state = next((name for name in REPORTED if name in pressures), None)
    forms = [form for form in applying(case) if form.pressure is not None] if state is not None else []
    if state is not None and forms and (pressure := forms[0].pressure):
        r = pressures[state].contact_radius * np.sin(np.linspace(0.005, 0.4999 * np.pi, FINE))
        theories[state] = forms[0].name, r, pressure(case, r)
    drawn = {name: (one.r, one.pressure, one.contact_radius) for name, one in pressures.items()}
    return {"pressure_3d": partial(figures.body_pressure_figure, drawn, theories)} if drawn else {}


def _stick_slip(scene: Scene, profiles: Mapping[str, Profile], columns: Mapping[str, Array]) -> Callable[[], Figure]:
    """The stick zone of each state, as the row at its place has it."""
    assert scene.friction is not None
    places, coefficient = columns["tangential_displacement"], scene.friction.coefficient
    states = {}
    for name, profile in profiles.items():
        row = row_of(name, columns)
        moves = np.diff(places[: row + 1], prepend=0.0)
        direction = int(np.sign(moves[moves != 0.0][-1])) if moves.any() else 0
        margin = stick_margin(profile, coefficient, direction)
        states[name] = profile, margin, float(columns["stick_radius"][row]), float(places[row])
    return partial(figures.stick_slip_figure, states, coefficient)


def _mindlin(scene: Scene, curve: Curve, columns: Mapping[str, Array]) -> Array | None:
    """u and F_x of Cattaneo and Mindlin along the path of a parabola under one load, shape (2, n); else None."""
    places, loads = columns["tangential_displacement"], columns["normal_force"]
    if scene.bodies.plane_radius is None or scene.friction is None or not scene.friction.coefficient:
        return None
    if np.ptp(loads) > SAME_LOAD * loads.max():
        return None
    ratio, coefficient = scene.tangential_stiffness / scene.bulk_stiffness, scene.friction.coefficient
    sliding = sliding_displacement(coefficient, ratio, float(curve.displacement[0]))
    rows = np.arange(places.size)
    dense = np.interp(np.linspace(0.0, rows[-1], 1 + BETWEEN * int(rows[-1])), rows, places)
    return np.asarray([dense, mindlin_path(dense.tolist(), float(loads[0]), coefficient, sliding)])


def _radius(scene: Scene, profile: Profile) -> float:
    found = RadiusRule(scene, scene.accuracy.tolerance).of(profile)
    return nan if found is None else found.value


def _adheres_over_a_width(values: Mapping[str, float]) -> bool:
    """Whether the run has F_A and an a₀ that is not 0, by which a reduced curve can be divided."""
    return "adhesion_force" in values and values.get("zero_load_radius", 0.0) > 0.0


def _theory(scene: Scene, values: Mapping[str, float], curve: Curve) -> tuple[str, Array] | None:
    """Name, and a, d, F of JKR: with the run's own F_A and a₀, on a plane with nothing fitted; or of Hertz; or none.

    The image x²/2R₁ on springs E* per length is the contact of R = 2R₁; its a₀ is twice that of the two spheres.
    """
    bodies, half = scene.bodies, scene.bodies.plane_radius
    if half is None:
        return None
    radius, modulus = 2.0 * half, scene.bulk_stiffness / bodies.spacing
    if scene.adhesion is not None and scene.adheres:
        jkr = PowerLaw.sphere(radius, modulus, scene.adhesion.work)
        return "JKR", jkr.curve(jkr.fixed_grips_radius(), LARGEST * jkr.zero_load_radius())
    if _adheres_over_a_width(values):
        force, a_0 = values["adhesion_force"], values["zero_load_radius"]
        fitted = PowerLaw.sphere(radius, 3.0 * force * radius / a_0**3, force / (1.5 * pi * radius))
        return "JKR, same $F_A$ and $a_0$", fitted.curve(LEAST * a_0, LARGEST * a_0)
    if scene.interaction is None:
        hertz = PowerLaw.sphere(radius, modulus)
        return "Hertz", hertz.curve(0.0, hertz.radius_at(max(float(curve.displacement.max()), 0.0)))
    return None
