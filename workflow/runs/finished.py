"""A finished run: from memory or read from its folder, it has the same face; its figures, with the theory beside."""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from html import escape
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis import plots
from contact1d.analysis.atoms import atoms
from contact1d.analysis.chart import Chart
from contact1d.analysis.curve import DETACHMENTS, PROFILE_COLUMNS, Columns, by_state, put_columns, read_columns
from contact1d.analysis.named import Named
from contact1d.analysis.pressure import Profile
from contact1d.files import AnyPath, write_whole
from contact1d.workflow.body.theory import in_words
from contact1d.workflow.continuation.outcome import Outcome
from contact1d.workflow.errors import Contact1dError, FolderError, RunError
from contact1d.workflow.runs.charts import CURVE_COLUMNS, charts
from contact1d.workflow.runs.plausibility import IMPLAUSIBLE
from contact1d.workflow.runs.report import FILES, FORMATS, as_json, in_model_units, quantities_in, read_results
from contact1d.workflow.runs.scales import scales_of
from contact1d.workflow.scene import Scene, SceneError, scene_from_dict
from contact1d.workflow.units import NUMBER, Quantity, Scales, scale_of

if TYPE_CHECKING:
    from ase import Atoms
    from matplotlib.figure import Figure
    from xarray import Dataset


Array = NDArray[np.float64]


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
    """

    folder: Path
    document: Mapping[str, Any]
    scene: Scene = field(compare=False)
    tables: Mapping[str, Columns] = field(compare=False)
    outcome: Outcome | None = field(default=None, compare=False)

    @cached_property
    def results(self) -> Results:
        """Quantities by name, each with uncertainty and unit."""
        return Results({name: Quantity.of(entry) for name, entry in quantities_in(self.document).items()})

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
    def _numbers(self) -> Results:
        """The results in units of the model."""
        return Results({name: Quantity.of(entry, False) for name, entry in quantities_in(self.document).items()})

    @cached_property
    def scales(self) -> Scales:
        """What LU, FU and, where it is known, MU stand for in SI."""
        return scales_of(self.scene, self._numbers)

    @cached_property
    def model(self) -> Run:
        """The same run with its tables and results in units of the model."""
        tables = {name: in_model_units(one, self.scales) for name, one in self.tables.items()}
        own = replace(self, tables=tables)
        vars(own).update(results=self._numbers, model=own)
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
        return _kept(as_json(self.document), path)

    def to_csv(self, path: AnyPath | None = None, table: str = "results") -> str:
        """Name, value, uncertainty and unit of the results, or one of `tables`: "curve"; also written to a path."""
        file, columns = StringIO(), self._table(table)
        put_columns(file, columns, columns.units)
        return _kept(file.getvalue(), path)

    def to_latex(self, path: AnyPath | None = None) -> str:
        """The results as a tabular, the name, and value, uncertainty and unit; also written to a path."""
        lines = [f"{name.replace('_', ' ')} & ${_tex(one)}$ \\\\" for name, one in self.results.items()]
        return _kept("\n".join([r"\begin{tabular}{ll}", *lines, r"\end{tabular}", ""]), path)

    def to_xarray(self, table: str = "curve") -> Dataset:
        """One of `tables` as an xarray.Dataset with units, the results in its attributes as text.

        Raises Contact1dError where xarray isn't installed.
        """
        try:
            import xarray
        except ImportError:
            raise Contact1dError("a dataset needs xarray: install it with pip install 'contact1d[tables]'") from None
        columns = self._table(table)
        variables = {
            name: ("row", column, {"units": columns.units[name]} if name in columns.units else {})
            for name, column in columns.items()
        }
        said = {name: str(quantity) for name, quantity in self.results.items()}
        return xarray.Dataset(variables, attrs={"title": self.scene.title, **said})

    def _table(self, name: str) -> Columns:
        parts, quantities = ("value", "uncertainty", "unit"), self.results.values()
        results = {"name": [*self.results]} | {part: [getattr(one, part) for one in quantities] for part in parts}
        known = {"results": Columns(results), **self.tables}
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


TEX = {"±": r"\pm", "µ": r"\mu ", "·": r"\cdot ", "²": "^2"}
"""Signs in a quantity."""


def _tex(one: Quantity) -> str:
    number, unit = str(one).rsplit(" ", 1) if one.unit != NUMBER else (str(one), "")
    number = re.sub(r"e([+-]\d+)", lambda power: rf"\cdot 10^{{{int(power[1])}}}", number)
    text = number + re.sub(r"[A-Za-z]+", r"\\mathrm{\g<0>}", rf"\,{unit}" if unit else "")
    for sign, tex in TEX.items():
        text = text.replace(sign, tex)
    return text


def _kept(text: str, path: AnyPath | None) -> str:
    """The text, which is written to the path if there is one."""
    if path:
        write_whole(Path(path), text)
    return text


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


def draw(drawn: Mapping[str, Chart], folder: Path, figures: bool | str) -> None:
    """Save charts in a folder, by their names; `figures`: png, svg or pdf, and True is png."""
    form = figures if isinstance(figures, str) else FORMATS[0]
    for name, chart in drawn.items():
        plots.save_figure(plots.draw(chart.written(scale_of)), folder / f"{name}.{form}")
