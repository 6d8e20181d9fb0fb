"""A finished run: from memory or read from its folder, it has the same face; its figures, with the theory beside."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from html import escape
from itertools import pairwise
from math import nan, pi
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis import figures, plots
from contact1d.analysis.atoms import atoms
from contact1d.analysis.chart import Axis, Chart, Series
from contact1d.analysis.curve import DETACHMENTS, PROFILE_COLUMNS, SAMPLE_TABLE, Columns, by_state, read_columns
from contact1d.analysis.named import Named
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius
from contact1d.analysis.theory.indenters import Ellipsoid, PowerLaw
from contact1d.analysis.theory.mindlin import mindlin_path
from contact1d.files import AnyPath
from contact1d.workflow.body.derived import REPORTED
from contact1d.workflow.body.reading import IMAGE, stands_for_spheres
from contact1d.workflow.body.theory import Case, applying, drawn_along, in_words, indented, sliding_contact
from contact1d.workflow.body.traction import row_of
from contact1d.workflow.continuation.outcome import Outcome
from contact1d.workflow.continuation.state import radius_rule
from contact1d.workflow.errors import FolderError, RunError
from contact1d.workflow.runs import inputs
from contact1d.workflow.runs.export import csv_text, dataset, kept, latex, listed
from contact1d.workflow.runs.plausibility import IMPLAUSIBLE
from contact1d.workflow.runs.report import COLUMN_UNITS, FILES, as_json, in_units, quantities_in, read_results
from contact1d.workflow.runs.scales import scales_of
from contact1d.workflow.scene import History, Scene, SceneError, scene_from_dict
from contact1d.workflow.scene.tables import SPHERES, WIDER_THAN_SPHERES
from contact1d.workflow.units import FORCE, LENGTH, MASS, NUMBER, Quantity, Scales, scale_of

if TYPE_CHECKING:
    from ase import Atoms
    from matplotlib.figure import Figure
    from xarray import Dataset


Array = NDArray[np.float64]
CONTACT_RADIUS = "contact radius a"
MAIN = {
    "tangential_displacement": "tangential_force", "drive": "friction", "time": "displacement", "displacement": "force",
}  # fmt: skip
"""What the path of a run is drawn over, the first that it has, and what is drawn over it."""
FROM_ZERO = ("contact_radius", "force", "friction", "tangential_force")
"""Columns whose 0 a figure shows."""
SAME_LOAD = 1e-9
"""Relative change up to which a load is constant."""
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
            name: "force_displacement", "force_radius", "force_time", "displacement_time", "pressure", "pressure_3d",
                "friction", "tangential", "stick_slip", "shear_3d", "inputs", "detachments", "samples" or "scan", as the
                files in the folder are called.

        Raises:
            ValueError: the run has no such figure; the message says which it has.
        """
        there = charts(self)
        name = name or next(iter(there))
        if name not in there:
            raise ValueError(f"the run has no figure {name!r}, it has {', '.join(there)}")
        return plots.draw(there[name].written(scale_of))

    def atoms(self, state: int = -1) -> Atoms:
        """Return a reported state as ase.Atoms, by default the last; see `contact1d.atoms`."""
        return atoms(self.folder, state)

    def to_json(self, path: AnyPath | None = None) -> str:
        """What results.json holds; also written to a path."""
        return kept(as_json(self.document), path)

    def to_csv(self, path: AnyPath | None = None, table: str = "results") -> str:
        """Name, value, uncertainty and unit of the results, or one of `tables`: "curve"; also written to a path."""
        return kept(csv_text(self._table(table)), path)

    def to_latex(self, path: AnyPath | None = None) -> str:
        """The results as a tabular; also written to a path."""
        return kept(latex(self.results), path)

    def to_xarray(self, table: str = "curve") -> Dataset:
        """One of `tables` as an xarray.Dataset with units, the results in its attributes as text.

        Raises Contact1dError where xarray isn't installed.
        """
        said = {name: str(quantity) for name, quantity in self.results.items()}
        return dataset(self._table(table), {"title": self.scene.title, **said})

    def _table(self, name: str) -> Columns:
        known = {"results": listed(self.results), **self.tables}
        if name not in known:
            raise ValueError(f"the run has no table {name!r}, it has {', '.join(known)}")
        return known[name]

    def __repr__(self) -> str:
        """A few lines: title, status, folder, results with the closed forms beside, warnings.

        What is implausible comes first, since every result follows from it.
        """
        lines = [f"Run {self.scene.title!r}: {self.status}, {self.folder}"]
        for name, quantity in self.results.items():
            beside = ", ".join(in_words(self.document, name))
            lines.append(f"  {name:<18} {quantity!s:<24} {beside}".rstrip())
        for name, message in self.warnings.items():
            place = 1 if name.startswith(IMPLAUSIBLE) else len(lines)
            lines.insert(place, f"  warning {name}: {message}")
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        """The same as a table, for notebooks."""
        cells = [(name.replace("_", " "), str(quantity)) for name, quantity in self.results.items()]
        for name, message in self.warnings.items():
            cells.insert(0 if name.startswith(IMPLAUSIBLE) else len(cells), (f"warning: {name}", message))
        rows = "".join(f"<tr><th>{escape(name)}</th><td>{escape(text)}</td></tr>" for name, text in cells)
        caption = f"{escape(self.scene.title)}: {self.status}<br><code>{escape(str(self.folder))}</code>"
        return f"<table><caption>{caption}</caption>{rows}</table>"


def load_run(folder: AnyPath) -> Run:
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


def charts(run: Run) -> dict[str, Chart]:
    """What each figure of a run shows, by the names of the files, the main one first; in base units."""
    scales, bodies = run.scales, run.scene.bodies
    title = run.scene.title + ("" if bodies.reduction == "mdr" else f"\n(reduction {bodies.reduction})")
    return {
        name: replace(chart, title=title).written(lambda _, unit: scales.base(unit), scales.in_words)
        for name, chart in _charts(run.model)
    }


def draw(run: Run, form: str) -> None:
    """Save every figure of a run in its folder; `form`: png, svg or pdf."""
    for name, chart in charts(run).items():
        plots.save_figure(plots.draw(chart.written(scale_of)), run.folder / f"{name}.{form}")


def axis_of(column: str) -> Axis:
    """The axis of a column of the tables, in units of the model."""
    remark = figures.COMPRESSIVE if column in CURVE_COLUMNS[:2] else ""
    name = "displacement of the drive" if column == "drive" else column.replace("_", " ")
    return Axis(name, COLUMN_UNITS[column], remark, zero=column in FROM_ZERO)


def main_curve(run: Run) -> dict[str, Array]:
    """What the path of a run is drawn over, and what is drawn over it: columns by their names, in units of the model.

    A row for each state: a slide begins with one under the load, before it is driven.
    """
    columns = run.friction or run.curve
    over = next(name for name in MAIN if name in columns)
    names = [over, "force" if over == "time" and run.scene.experiment.places() else MAIN[over]]
    if "normal_force" in columns and np.ptp(load := columns["normal_force"]) > SAME_LOAD * np.abs(load).max():
        names.append("normal_force")
    missing = np.full(run.curve.force.size - columns[over].size, nan)
    return {name: np.append(missing, columns[name]) for name in names}


def legs_of(run: Run, along: Array) -> list[tuple[str, NDArray[np.int64]]]:
    """Name and rows of each leg of a prescribed path, which begins where the one before it ends.

    Otherwise of each branch of a cycle, in the order of the positions `along`: a search goes to and fro.
    """
    branch, kind = run.curve.branch, run.scene.experiment
    if kind.way_is_given or kind.goes_along:
        starts = [0, *np.flatnonzero(branch[1:] != branch[:-1]) + 1, branch.size]
        legs = [np.arange(max(start - 1, 0), end) for start, end in pairwise(starts)]
    else:
        order = np.argsort(along, kind="stable")
        names = np.char.add(branch, run.curve.get("cycle", np.zeros(branch.size)).astype(str))
        legs = [order[names[order] == name] for name in dict.fromkeys(names.tolist())]
    return [(str(branch[rows[-1]]), rows) for rows in legs]


def _charts(run: Run) -> Iterator[tuple[str, Chart]]:
    """The charts of a run in units of the model, by their names."""
    scene, profiles = run.scene, figures.seen(run.profiles)
    over, up, *_ = main_curve(run)
    rule = radius_rule(scene, scene.accuracy.tolerance)
    radii = {state: radius for state in profiles if (radius := rule.of(run.profiles[state]))}
    if run.detachments and run.detachments["force"].size > 1:
        yield DETACHMENTS, figures.detachments(run.detachments["force"])
    if SAMPLE_TABLE in run.tables:
        yield SAMPLE_TABLE, _samples(run)
    if scene.friction:
        yield "tangential", path_chart(run, tangential_force=_mindlin(run))
        yield "stick_slip", figures.stick_slip(profiles, scene.friction.coefficient, _zones(run, profiles))
    elif over != "displacement":
        name = "friction" if run.friction else f"{up}_{over}"
        yield name, path_chart(run, force=_ting(run, over) if up == "force" else [])
    if ("displacement" in (over, up) or isinstance(scene.experiment, History)) and (
        not scene.noise or scene.experiment.way_is_given
    ):
        yield from _under_load(run)
    if all(profile.x.size > 1 for profile in profiles.values()):  # one particle has no pressure over x
        yield "pressure", figures.pressure(profiles, radii)
    marks = _marks(run, radii)
    if pressures := run.body_pressures:
        yield "pressure_3d", figures.body("pressure", pressures, marks, _body_theory(run, marks))
    if "inputs" in run.tables:
        yield "inputs", inputs.chart(run.tables["inputs"])
    if shears := run.body_shears:
        yield "shear_3d", figures.body("shear_stress", shears, marks, {})
    if taken := scene.bodies.profile.taken:
        yield "scan", figures.scan(taken)


def path_chart(run: Run, columns: Mapping[str, Array] | None = None, **beside: Sequence[Series]) -> Chart:
    """Columns over the first one, by default the main curve, with what is beside each; in units of the model."""
    (over, along), *upwards = (columns or main_curve(run)).items()
    panels = [(axis_of(name), column, beside.get(name, ())) for name, column in upwards]
    return figures.path(axis_of(over), along, legs_of(run, along), *panels)


def _samples(run: Run) -> Chart:
    """The motion of a contact with noise, and the load on it."""
    table, mean = run.tables[SAMPLE_TABLE], run.results.get("displacement")
    beside = {"force": figures.lines(("load", table["time"], table["load"]))}
    if mean is not None:
        beside["displacement"] = figures.level(mean.value, mean.uncertainty, "mean")
    return path_chart(run, {name: table[name] for name in ("time", "displacement", "force")}, **beside)


def _under_load(run: Run) -> Iterator[tuple[str, Chart]]:
    """Force over displacement and, where that changes, over the contact radius."""
    curve, theory, scale, tension = run.curve, _theory(run), _pull_off(run), run.results.get("adhesion_force")
    beside = figures.lines(*((name, d, force) for name, _, d, force in theory))
    beside += _ting(run, "displacement")
    if tension and tension.value:
        beside += figures.level(-tension.value, tension.uncertainty, f"$F_A$ = {tension.value:.4g} FU")
    yield "force_displacement", path_chart(run, {name: curve[name] for name in CURVE_COLUMNS[:2]}, force=beside)
    radius = np.where(curve.contact_radius > 0.0, curve.contact_radius, nan)
    x, y = axis_of("contact_radius"), axis_of("force")
    beside = [] if run.scene.adheres else figures.lines(*((name, a, force) for name, a, _, force in theory))
    width, height = 1.0, 1.0
    if scale and run.scene.bodies.profile.kind in SPHERES:
        height, width = scale
        x, y = Axis("contact radius $a/a_0$"), replace(y, name="force $F/F_A$", unit=NUMBER)
        beside = figures.reduced(float(np.nanmax(radius)) / width)
    elif np.unique(radius[np.isfinite(radius)]).size < 2:
        return
    panel, spread = (y, curve.force / height, beside), curve.contact_radius_uncertainty / width
    yield "force_radius", figures.path(x, radius / width, legs_of(run, radius), panel, spread=spread)


def _ting(run: Run, over: str) -> list[Series]:
    """F of Lee, Radok and Ting over a column of the curve; nothing where they do not apply."""
    history = indented(Case(run.scene, run.results))
    return [] if history is None else figures.lines(("Ting", run.curve[over], history.forces(run.curve.time)))


def _pull_off(run: Run) -> tuple[float, float] | None:
    """F_A and a₀ of the image, to which the curve belongs; None where there is none, or no width at F = 0."""
    found = [run.results.get(name) for name in ("adhesion_force", f"{IMAGE}zero_load_radius", "zero_load_radius")]
    force, radius = found[0], found[1] or found[2]
    return (force.value, radius.value) if force and radius and radius.value > 0.0 else None


def _zones(run: Run, states: Iterable[str]) -> dict[str, tuple[float, float, int]]:
    """Stick radius, place along x and direction of each state: as the row of the curve has them."""
    zones, places = {}, run.curve.tangential_displacement
    for state in states:
        row = row_of(state, run.curve)
        moves = np.trim_zeros(np.diff(places[: row + 1], prepend=0.0))
        zones[state] = run.curve.stick_radius[row], places[row], int(np.sign(moves[-1:]).sum())
    return zones


def _marks(run: Run, radii: Mapping[str, ContactRadius]) -> dict[str, dict[str, float]]:
    """What has a radius on the body, by state."""
    wider = WIDER_THAN_SPHERES if stands_for_spheres(run.scene) else 1.0
    sticks = _zones(run, radii) if run.scene.experiment.goes_along else {}
    return {
        state: {CONTACT_RADIUS: radius.value / wider} | ({"stick radius c": sticks[state][0]} if sticks else {})
        for state, radius in radii.items()
    }


def _body_theory(run: Run, marks: Mapping[str, Mapping[str, float]]) -> dict[str, figures.Theory]:
    """The closed form of p(r), by the state that it speaks of."""
    case = Case(run.scene, run.results)
    for state in (name for name in REPORTED if name in marks):
        for form in applying(case):
            if form.pressure is not None:
                r = marks[state][CONTACT_RADIUS] * np.sin(np.linspace(0.005, 0.4999 * np.pi, FINE))
                return {state: (form.name, r, form.pressure(case, r))}
    return {}


def _mindlin(run: Run) -> list[Series]:
    """F_x of Cattaneo and Mindlin over u along the path of a parabola under one load; of others nothing."""
    case, places = Case(run.scene, run.results), run.friction["tangential_displacement"]
    if not drawn_along(case):
        return []
    steps = places.size - 1
    dense = np.interp(np.linspace(0.0, steps, 1 + BETWEEN * steps), range(places.size), places)
    force = mindlin_path(dense.tolist(), *sliding_contact(case)[:3])
    return figures.lines(("Cattaneo–Mindlin", dense, np.asarray(force)))


def _theory(run: Run) -> list[tuple[str, Array, Array, Array]]:
    """Name, and a, d, F of the closed form of the body; of two chains that of JKR with the run's own F_A and a₀.

    The image x²/2R₁ on springs E* per length is the contact of R = 2R₁; its a₀ is twice that of the two spheres.
    """
    scene, half, case, pull_off = run.scene, run.scene.bodies.plane_radius, Case(run.scene, run.results), _pull_off(run)
    radius, forms = 2.0 * (half or 0.0), applying(case)
    body: PowerLaw | Ellipsoid
    if scene.viscoelasticity:
        return []
    if half is not None:
        work = scene.work_of_adhesion
        name, body = (
            "JKR" if work else "Hertz",
            PowerLaw.sphere(radius, scene.bulk_stiffness / scene.bodies.spacing, work),
        )
    elif forms and case.kind != "flat_punch":
        name, body = forms[0].name, case.body
    else:
        return []
    if scene.work_of_adhesion:
        return [(name, *body.curve(body.fixed_grips_radius(), LARGEST * body.zero_load_radius()))]
    if pull_off is not None:
        force, a_0 = pull_off
        fitted = PowerLaw.sphere(radius, 3.0 * force * radius / a_0**3, force / (1.5 * pi * radius))
        return [("JKR, same $F_A$ and $a_0$", *fitted.curve(LEAST * a_0, LARGEST * a_0))]
    if not scene.interaction:
        return [(name, *body.curve(0.0, body.radius_at(max(float(run.curve.displacement.max()), 0.0))))]
    return []
