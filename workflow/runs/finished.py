"""A finished run: from memory or read from its folder, it has the same face; its figures, with the theory beside."""

from __future__ import annotations

import csv
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from html import escape
from math import nan, pi
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis import figures, plots
from contact1d.analysis.atoms import atoms
from contact1d.analysis.curve import DETACHMENTS, PROFILE_COLUMNS, SAMPLE_TABLE, Columns, by_state, read_columns
from contact1d.analysis.named import Named
from contact1d.analysis.pressure import Profile
from contact1d.analysis.shear import stick_margin
from contact1d.analysis.theory.indenters import Ellipsoid, PowerLaw
from contact1d.analysis.theory.mindlin import mindlin_path
from contact1d.workflow.body.derived import REPORTED
from contact1d.workflow.body.reading import IMAGE
from contact1d.workflow.body.theory import Case, applying, drawn_along, in_words, sliding_contact
from contact1d.workflow.body.traction import body_pressures, body_shears, row_of
from contact1d.workflow.continuation.outcome import Outcome
from contact1d.workflow.continuation.state import RadiusRule
from contact1d.workflow.errors import FolderError, RunError
from contact1d.workflow.runs.report import FILES, in_units, quantities_in, read_results
from contact1d.workflow.runs.scales import scales_of
from contact1d.workflow.scene import Scene, SceneError, scene_from_dict
from contact1d.workflow.scene.tables import SPHERES
from contact1d.workflow.units import FORCE, LENGTH, MASS, Quantity, Scales

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
CURVE_COLUMNS = ("displacement", "force", "contact_radius", "branch")
"""Without which a table is no curve."""


class Results(Named[Quantity]):
    """Quantities by name; each is also an attribute: `results.adhesion_force` is `results["adhesion_force"]`."""

    def __missing__(self, name: str) -> Quantity:
        """Say what there is. Raises KeyError."""
        raise KeyError(f"the run has no {name}, it has {', '.join(self) or 'no results'}")

    def __repr__(self) -> str:
        """One line for each quantity."""
        return "\n".join(f"{name} = {quantity}" for name, quantity in self.items())


@dataclass(frozen=True, repr=False)
class Run:
    """A finished run; `run` returns it, `load_run` reads it from its folder. Two are equal by folder and document.

    What the scene gives in SI is in SI here, too, in base units; without units all is in those of the model.

    Attributes:
        folder: with every file of the run.
        document: what results.json holds.
        scene: what ran.
        tables: what the CSV files hold, by their names without ending.
        outcome: what the experiment handed over, in units of the model; None for a run that was read from its folder,
            or made by `run_many`.
        results: quantities by name, each with uncertainty and unit.
    """

    folder: Path
    document: Mapping[str, Any]
    scene: Scene = field(compare=False)
    tables: Mapping[str, Columns] = field(compare=False)
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
    def curve(self) -> Columns:
        """The measured states: every column of curve.csv."""
        return self.tables["curve"]

    @property
    def friction(self) -> Columns:
        """Of a slide what friction.csv holds, of a tangential the curve; else nothing."""
        return self.curve if self.scene.experiment.goes_along else self.tables.get("friction", Columns({}))

    @property
    def detachments(self) -> Columns:
        """Of a pull-off with [noise], a row for each pull; what detachments.csv holds."""
        return self.tables.get(DETACHMENTS, Columns({}))

    @property
    def profiles(self) -> dict[str, Profile]:
        """Line load and shear along x of the reported states, by name; what profile.csv holds."""
        return {
            state: Profile(*(columns[name] for name in PROFILE_COLUMNS))
            for state, columns in by_state(self.tables["profile"]).items()
        }

    @property
    def body_pressures(self) -> dict[str, Columns]:
        """p(r) of the body of three dimensions, by state; what pressure_3d.csv holds. Empty where there is none."""
        return by_state(self.tables.get("pressure_3d", Columns({})))

    @property
    def body_shears(self) -> dict[str, Columns]:
        """q(r) of the body of three dimensions, by state; what shear_3d.csv holds. Empty where there is none."""
        return by_state(self.tables.get("shear_3d", Columns({})))

    @property
    def scales(self) -> Scales:
        """What LU, FU and, where it is known, MU stand for in SI."""
        units = self.document.get("units")
        if units is None:
            return scales_of(self.scene, {})
        entries = (units[unit] for unit in (LENGTH, FORCE))
        (length, off_length), (force, off_force) = ((entry["value"], entry["uncertainty"]) for entry in entries)
        mass = units.get(MASS)
        return Scales(length, force, off_length, off_force, None if mass is None else mass["value"])

    @cached_property
    def model(self) -> Run:
        """The same run with its tables and results in units of the model."""
        scales = self.scales
        own = replace(self, tables={name: in_units(one, scales, name, True) for name, one in self.tables.items()})
        entries = quantities_in(self.document).items()
        numbers = {name: Quantity(entry["value"], entry["uncertainty"], entry["unit"]) for name, entry in entries}
        vars(own).update(results=Results(numbers), model=own)
        return own

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
        """A few lines: title, status, folder, results with the closed forms beside, warnings."""
        lines = [f"Run {self.scene.title!r}: {self.status}, {self.folder}"]
        for name, quantity in self.results.items():
            beside = ", ".join(in_words(self.document, name))
            lines.append(f"  {name:<18} {quantity!s:<24} {beside}".rstrip())
        return "\n".join(lines + [f"  warning {name}: {message}" for name, message in self.warnings.items()])

    def _repr_html_(self) -> str:
        """The same as a table, for notebooks."""
        cells = [(name.replace("_", " "), str(quantity)) for name, quantity in self.results.items()]
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
    """As `load_run`, but a run that failed is returned, without results and tables."""
    document = read_results(folder)
    try:
        scene = scene_from_dict(document["scene"])
        tables = {}
        if document["status"] == "done":
            needed = {"curve.csv": CURVE_COLUMNS, "profile.csv": (*PROFILE_COLUMNS, "state")}
            files = [name for name in FILES if name in needed or (name.endswith(".csv") and (folder / name).is_file())]
            tables = {name[:-4]: read_columns(folder / name, needed.get(name, ())) for name in files}
        return Run(folder.resolve(), document, scene, tables)
    except (ValueError, OSError, SceneError, csv.Error) as error:
        reason = str(error).partition("\n")[0]
        raise FolderError(f"{folder} has no run readable by this version: {reason}. Run its scene again") from None


def drawings(run: Run) -> Drawings:
    """What draws each figure of a run, by the names of the files, the main one first; in SI where it is known."""
    title, scales, reduction = run.scene.title, run.scales, run.scene.bodies.reduction
    title += "" if reduction == "mdr" else f"\n(reduction {reduction})"

    def dressed(draw: Callable[[], Figure]) -> Figure:
        figure = draw()
        figure.suptitle(title, fontsize=11)
        return plots.in_si(figure, scales)

    return {name: partial(dressed, draw) for name, draw in plain_drawings(run.model).items()}


def draw(run: Run, form: str) -> None:
    """Save every figure of a run in its folder; `form`: png, svg or pdf."""
    for name, figure in drawings(run).items():
        plots.save_figure(figure(), run.folder / f"{name}.{form}")


def main_curve(run: Run) -> dict[str, tuple[str, Array]]:
    """What the path of a run is drawn in, along x and y: name, and unit and column of a run in units of the model.

    A row for each state: a slide begins with one under the load, before it is driven.
    """
    names, columns = ("displacement", "force"), run.curve
    if run.scene.experiment.goes_along:
        names = "tangential_displacement", "tangential_force"
    elif run.friction:
        names, columns = ("drive", "friction"), run.friction
    missing = np.full(len(run.curve.force) - len(columns[names[0]]), nan)
    filled = (np.append(missing, columns[name]) for name in names)
    return {
        name.replace("_", " "): (unit, column)
        for name, unit, column in zip(names, (LENGTH, FORCE), filled, strict=True)
    }


def legs_of(run: Run, along: Array) -> list[tuple[str, NDArray[np.int64]]]:
    """Name and rows of each leg of a prescribed path, which begins where the one before it ends.

    Otherwise of each branch, in the order of the positions `along`: a search goes to and fro.
    """
    branch, kind = run.curve.branch, run.scene.experiment
    if not (kind.way_is_given or kind.goes_along):
        rows = [np.flatnonzero(branch == name) for name in dict.fromkeys(branch.tolist())]
        return [(str(branch[part[0]]), part[np.argsort(along[part], kind="stable")]) for part in rows]
    parts = np.split(np.arange(branch.size), np.flatnonzero(branch[1:] != branch[:-1]) + 1)
    return [(str(branch[part[0]]), np.arange(max(part[0] - 1, 0), part[-1] + 1)) for part in parts]


def plain_drawings(run: Run) -> Drawings:
    """The figures of a run in units of the model, without title, by the names of the files, the main one first."""
    found = _drawings(run)
    if SAMPLE_TABLE in run.tables:
        measured, mean = np.isin(run.curve.branch, MEASURED), _values(run).get("displacement")
        traces = partial(figures.samples_figure, run.tables[SAMPLE_TABLE], measured, mean)
        found = found | {SAMPLE_TABLE: traces} if DETACHMENTS in found else {SAMPLE_TABLE: traces} | found
    return found


def _drawings(run: Run) -> Drawings:
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
    beside = _theory(run, values)
    over_d = None if beside is None else (beside[0], *beside[1][1:])
    tension = run.results.get("adhesion_force")
    adhesion = (tension.value, tension.uncertainty) if tension and tension.value else None
    legs = legs_of(run, curve.displacement)
    found: Drawings = {"force_displacement": partial(figures.force_displacement_figure, curve, legs, adhesion, over_d)}
    if _adheres_over_a_width(values) and scene.bodies.profile.kind in SPHERES:
        marks = values["adhesion_force"], values["zero_load_radius"]
        found["force_radius"] = partial(figures.force_radius_figure, curve, *marks)
    elif np.unique(curve.contact_radius[curve.contact_radius > 0.0]).size > 1:
        over_a = (beside[0], *beside[1][::2]) if beside is not None and not scene.adheres else None
        found["force_radius"] = partial(figures.load_radius_figure, curve, over_a)
    return found | pressure | _body_pressure(run)


def _values(run: Run) -> dict[str, float]:
    """The results by name, of lengths those of the image: they belong to the curve."""
    values = {name: quantity.value for name, quantity in run.results.items()}
    return values | {name.removeprefix(IMAGE): value for name, value in values.items() if name.startswith(IMAGE)}


def _sheared(run: Run) -> Drawings:
    """Force over displacement along x, the stick zone and q(r)."""
    loop = partial(figures.tangential_figure, run.friction, legs_of(run, run.curve.displacement), _mindlin(run))
    found: Drawings = {"tangential": loop, "stick_slip": _stick_slip(run)}
    if shears := body_shears(run.scene, run.profiles, run.friction, run.curve.contact_radius):
        lines = {name: (one.r, one.shear, one.uncertainty, one.edge, one.stick) for name, one in shears.items()}
        found["shear_3d"] = partial(figures.body_shear_figure, lines)
    return found


def _body_pressure(run: Run) -> Drawings:
    """p(r) of the body, where there is one, and the closed form beside it for the state that it speaks of."""
    pressures, case = body_pressures(run.scene, run.profiles), Case(run.scene, run.results)
    theories: dict[str, tuple[str, Array, Array]] = {}
    state = next((name for name in REPORTED if name in pressures), None)
    forms = [form for form in applying(case) if form.pressure is not None] if state is not None else []
    if state is not None and forms and (pressure := forms[0].pressure):
        r = pressures[state].contact_radius * np.sin(np.linspace(0.005, 0.4999 * np.pi, FINE))
        theories[state] = forms[0].name, r, pressure(case, r)
    drawn = {name: (one.r, one.pressure, one.uncertainty, one.contact_radius) for name, one in pressures.items()}
    return {"pressure_3d": partial(figures.body_pressure_figure, drawn, theories)} if drawn else {}


def _stick_slip(run: Run) -> Callable[[], Figure]:
    """The stick zone of each state, as the row at its place has it."""
    assert run.scene.friction is not None
    places, coefficient = run.friction["tangential_displacement"], run.scene.friction.coefficient
    states = {}
    for name, profile in run.profiles.items():
        row = row_of(name, run.friction)
        moves = np.diff(places[: row + 1], prepend=0.0)
        direction = int(np.sign(moves[moves != 0.0][-1])) if moves.any() else 0
        margin = stick_margin(profile, coefficient, direction)
        states[name] = profile, margin, float(run.friction["stick_radius"][row]), float(places[row])
    return partial(figures.stick_slip_figure, states, coefficient)


def _mindlin(run: Run) -> Array | None:
    """u and F_x of Cattaneo and Mindlin along the path of a parabola under one load, shape (2, n); else None."""
    case, places = Case(run.scene, run.results), run.friction["tangential_displacement"]
    if not drawn_along(case):
        return None
    steps = places.size - 1
    dense = np.interp(np.linspace(0.0, steps, 1 + BETWEEN * steps), range(places.size), places)
    return np.asarray([dense, mindlin_path(dense.tolist(), *sliding_contact(case)[:3])])


def _radius(scene: Scene, profile: Profile) -> float:
    found = RadiusRule(scene, scene.accuracy.tolerance).of(profile)
    return nan if found is None else found.value


def _adheres_over_a_width(values: Mapping[str, float]) -> bool:
    """Whether the run has F_A and an a₀ that is not 0, by which a reduced curve can be divided."""
    return "adhesion_force" in values and values.get("zero_load_radius", 0.0) > 0.0


def _theory(run: Run, values: Mapping[str, float]) -> tuple[str, Array] | None:
    """Name, and a, d, F of the closed form of the body; of two chains that of JKR with the run's own F_A and a₀.

    The image x²/2R₁ on springs E* per length is the contact of R = 2R₁; its a₀ is twice that of the two spheres.
    """
    scene, half, case = run.scene, run.scene.bodies.plane_radius, Case(run.scene, run.results)
    radius, forms = 2.0 * (half or 0.0), applying(case)
    body: PowerLaw | Ellipsoid
    if half is not None:
        work = scene.adhesion.work if scene.adhesion is not None else 0.0
        name, body = (
            "JKR" if work else "Hertz",
            PowerLaw.sphere(radius, scene.bulk_stiffness / scene.bodies.spacing, work),
        )
    elif forms and case.kind != "flat_punch":
        name, body = forms[0].name, case.body
    else:
        return None
    if scene.adhesion is not None and scene.adheres:
        return name, body.curve(body.fixed_grips_radius(), LARGEST * body.zero_load_radius())
    if _adheres_over_a_width(values):
        force, a_0 = values["adhesion_force"], values["zero_load_radius"]
        fitted = PowerLaw.sphere(radius, 3.0 * force * radius / a_0**3, force / (1.5 * pi * radius))
        return "JKR, same $F_A$ and $a_0$", fitted.curve(LEAST * a_0, LARGEST * a_0)
    if scene.interaction is None:
        return name, body.curve(0.0, body.radius_at(max(float(run.curve.displacement.max()), 0.0)))
    return None
