"""A finished run, from memory or read from its folder: results, tables, figures and closed forms."""

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
from contact1d.workflow.scene import Scene, SceneError, read_scene
from contact1d.workflow.units import NUMBER, Quantity, Scales, scale_of

if TYPE_CHECKING:
    from ase import Atoms
    from matplotlib.figure import Figure
    from xarray import Dataset


class Results(Named[Quantity]):
    """Quantities by name; each is also an attribute: `results.adhesion_force` is `results["adhesion_force"]`.

    A missing name raises KeyError, as an attribute AttributeError.
    """

    def __missing__(self, name: str) -> Quantity:
        """Raise KeyError for a name that the run has no result of, with the names that there are."""
        raise KeyError(f"the run has no {name}, it has {', '.join(self) or 'no results'}")

    def __repr__(self) -> str:
        """Return a line "name = value ± uncertainty unit" for each quantity, with SI prefixes; "" without any."""
        return "\n".join(f"{name} = {quantity}" for name, quantity in self.items())


@dataclass(frozen=True, repr=False)
class Run:
    """A finished run; `run` returns it, `load_run` reads it from its folder. Two are equal by folder and document.

    Numbers are in SI base units where the scene has units, else in units of the model.

    Attributes:
        folder: with every file of the run.
        document: the content of results.json.
        scene: the scene that ran.
        tables: the columns of the CSV files, by the files' names without ending.
        outcome: states and results of the experiment in units of the model; None for a run that was read from its
            folder, or made by `run_many`.
    """

    folder: Path
    document: Mapping[str, Any]
    scene: Scene = field(compare=False)
    tables: Mapping[str, Columns] = field(compare=False)
    outcome: Outcome | None = field(default=None, compare=False)

    @cached_property
    def results(self) -> Results:
        """The reported quantities by name, each with uncertainty and unit: in SI where the scene has units; cached.

        Those too uncertain to be reported are missing, as are all of a run that failed.
        """
        return Results({name: Quantity.of(entry) for name, entry in quantities_in(self.document).items()})

    @property
    def status(self) -> str:
        """Whether the run has results, as text: "done", or "failed" for a run read by `read_run`.

        `run` and `load_run` raise RunError in place of the latter.
        """
        return str(self.document["status"])

    @property
    def warnings(self) -> dict[str, str]:
        """The messages of the warnings, by name, in the units of the scene; empty where there are none."""
        return {warning["name"]: warning["message"] for warning in self.document["warnings"]}

    @property
    def timing(self) -> dict[str, float]:
        """Times [s] by name: `total_s`, `lammps_s` in LAMMPS and of that `rows_s` in load steps; and number of `steps`.

        These are wall times; `lammps_cpu_s` is the processor time of LAMMPS. `steps` are timesteps.
        """
        return dict(self.document["timing"])

    @property
    def curve(self) -> Columns:
        """The states of the loading history, one element each: all columns of curve.csv, SI where the scene has units.

        Raises:
            KeyError: the run failed and has no tables.
        """
        return self.tables["curve"]

    @property
    def friction(self) -> Columns:
        """The columns of friction.csv of a slide; of a tangential experiment those of the curve; empty of any other.

        In SI where the scene has units, else in units of the model.

        Raises:
            KeyError: a tangential run that failed, which has no tables.
        """
        return self.curve if self.scene.experiment.goes_along else self.tables.get("friction", Columns({}))

    @property
    def detachments(self) -> Columns:
        """The columns of detachments.csv, an element for each pull of a pull-off with [noise]; empty of any other run.

        In SI where the scene has units, else in units of the model.
        """
        return self.tables.get(DETACHMENTS, Columns({}))

    @property
    def profiles(self) -> dict[str, Profile]:
        """Line load and shear along x of the reported states, by name; the content of profile.csv.

        Lengths are in [m] and loads in [N/m] where the scene has units, else in [LU] and [FU/LU]; compression positive.

        Raises:
            KeyError: the run failed and has no tables.
        """
        return {
            state: Profile(*(columns[name] for name in PROFILE_COLUMNS))
            for state, columns in by_state(self.tables["profile"]).items()
        }

    @property
    def body_pressures(self) -> dict[str, Columns]:
        """The pressure p(r) of the three-dimensional body by state, as in pressure_3d.csv.

        Empty where the run has none. Columns are `r`, `pressure`, compression positive, and `pressure_uncertainty`: [m]
        and [Pa], without units of the scene [LU] and [FU/LU²].
        """
        return by_state(self.tables.get("pressure_3d", Columns({})))

    @property
    def body_shears(self) -> dict[str, Columns]:
        """The shear stress q(r) of the three-dimensional body by state, as in shear_3d.csv.

        Empty where the run has none. Columns are `r`, `shear_stress` and `shear_stress_uncertainty`: [m] and [Pa],
        without units of the scene [LU] and [FU/LU²].
        """
        return by_state(self.tables.get("shear_3d", Columns({})))

    @property
    def _numbers(self) -> Results:
        """The reported results by name in units of the model, LU, FU, MU and TU; those of pure numbers have "1"."""
        return Results({name: Quantity.of(entry, False) for name, entry in quantities_in(self.document).items()})

    @cached_property
    def scales(self) -> Scales:
        """The scales of LU, FU and, where it is known, MU in SI, with their uncertainties; cached.

        Unknown (`known` is False) without a [material], or without the results that fix them.
        """
        return scales_of(self.scene, self._numbers)

    @cached_property
    def model(self) -> Run:
        """The run with its tables and results in units of the model, LU, FU and MU; cached.

        Its own `model` is itself, and its `document` is that of this run, which has both units.
        """
        tables = {name: in_model_units(columns, self.scales) for name, columns in self.tables.items()}
        run = replace(self, tables=tables)
        vars(run).update(results=self._numbers, model=run)
        return run

    def plot(self, name: str | None = None) -> Figure:
        """Return a new matplotlib Figure of the run, by default the experiment's main one; `.savefig(path)` keeps it.

        Args:
            name: "force_displacement", "force_radius", "force_time", "displacement_time", "pressure", "pressure_3d",
                "friction", "tangential", "stick_slip", "shear_3d", "inputs", "detachments", "samples" or "scan", as the
                files in the folder are called; None: the first one.

        Raises:
            ValueError: the run has no such figure; the message says which it has.
            KeyError: the run failed and has no tables.
        """
        drawable = charts(self)
        name = name or next(iter(drawable))
        if name not in drawable:
            raise ValueError(f"the run has no figure {name!r}, it has {', '.join(drawable)}")
        return plots.draw(drawable[name].written(scale_of))

    def atoms(self, state: int = -1) -> Atoms:
        """Return a reported state as ase.Atoms, read from the run's folder, positions [LU], by default the last.

        Atoms are of the species X, in the order of their LAMMPS ids, with arrays "id", "type", "body", "role" and
        "opposite_force", (n, 3) [FU], and the timestep in `info`.

        `state`: index in the order of the loading; negative from the end.

        Raises:
            FileNotFoundError: the folder has no states.
            IndexError: there is no such state.
            ValueError: the state is cut short or lacks a column.
        """
        return atoms(self.folder, state)

    def to_json(self, path: AnyPath | None = None) -> str:
        """Return the text of results.json, and write it to a file `path`, replacing an earlier one, if given."""
        return _written(as_json(self.document), path)

    def to_csv(self, path: AnyPath | None = None, table: str = "results") -> str:
        """Return a table as CSV text, and write it to `path`, in place of an earlier file, unless that is None.

        Columns in SI have their unit in the header. Numbers have all digits, NaN is an empty cell.

        Args:
            path: of the file.
            table: "results", with columns name, value, uncertainty and unit, or a name in `tables`.

        Raises:
            ValueError: the run has no such table; the message says which it has.
        """
        file, columns = StringIO(), self._table(table)
        put_columns(file, columns, columns.units)
        return _written(file.getvalue(), path)

    def to_latex(self, path: AnyPath | None = None) -> str:
        """Return results, uncertainties and units as a LaTeX tabular, a row for each, and write it to `path`.

        In SI with prefixes where the scene has units. Nothing is written where `path` is None.
        """
        lines = [f"{name.replace('_', ' ')} & ${_tex(quantity)}$ \\\\" for name, quantity in self.results.items()]
        return _written("\n".join([r"\begin{tabular}{ll}", *lines, r"\end{tabular}", ""]), path)

    def to_xarray(self, table: str = "curve") -> Dataset:
        """Return "results" or one of `tables` as xarray.Dataset, variables along the dimension "row" with SI units.

        Variables in units of the model have no unit. The attributes are the title, and the results as text.

        Args:
            table: "results", with variables name, value, uncertainty and unit, or a name in `tables`.

        Raises:
            Contact1dError: xarray isn't installed.
            ValueError: the run has no such table; the message says which it has.
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
        results = {name: str(quantity) for name, quantity in self.results.items()}
        return xarray.Dataset(variables, attrs={"title": self.scene.title, **results})

    def _table(self, name: str) -> Columns:
        """Return the table "results" (name, value, uncertainty, unit) or one of `tables`, which has priority.

        Raises:
            ValueError: there is no such table; the message says which there are.
        """
        parts, quantities = ("value", "uncertainty", "unit"), self.results.values()
        results = {"name": [*self.results]} | {part: [getattr(number, part) for number in quantities] for part in parts}
        tables = {"results": Columns(results), **self.tables}
        if name not in tables:
            raise ValueError(f"the run has no table {name!r}, it has {', '.join(tables)}")
        return tables[name]

    def __repr__(self) -> str:
        """Return title, status, folder, results with their closed forms, and warnings, a line each.

        Warnings of implausible values come before the results, since every result follows from them, others after
        these.
        """
        lines = [f"Run {self.scene.title!r}: {self.status}, {self.folder}"]
        for name, quantity in self.results.items():
            closed_forms = ", ".join(in_words(self.document, name))
            lines.append(f"  {name:<18} {quantity!s:<24} {closed_forms}".rstrip())
        for name, message in self.warnings.items():
            index = 1 if name.startswith(IMPLAUSIBLE) else len(lines)
            lines.insert(index, f"  warning {name}: {message}")
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        """Return title, status, folder, results and warnings as an HTML table, for notebooks.

        Warnings of implausible values come before the results, others after these.
        """
        cells = [(name.replace("_", " "), str(quantity)) for name, quantity in self.results.items()]
        for name, message in self.warnings.items():
            cells.insert(0 if name.startswith(IMPLAUSIBLE) else len(cells), (f"warning: {name}", message))
        rows = "".join(f"<tr><th>{escape(name)}</th><td>{escape(text)}</td></tr>" for name, text in cells)
        caption = f"{escape(self.scene.title)}: {self.status}<br><code>{escape(str(self.folder))}</code>"
        return f"<table><caption>{caption}</caption>{rows}</table>"


TEX = {"±": r"\pm", "µ": r"\mu ", "·": r"\cdot ", "²": "^2"}
"""LaTeX of the signs in a quantity."""


def _tex(quantity: Quantity) -> str:
    """Return a quantity with its uncertainty and unit, SI units with a prefix, in LaTeX, without dollar signs."""
    number, unit = str(quantity).rsplit(" ", 1) if quantity.unit != NUMBER else (str(quantity), "")
    number = re.sub(r"e([+-]\d+)", lambda power: rf"\cdot 10^{{{int(power[1])}}}", number)
    text = number + re.sub(r"[A-Za-z]+", r"\\mathrm{\g<0>}", rf"\,{unit}" if unit else "")
    for sign, tex in TEX.items():
        text = text.replace(sign, tex)
    return text


def _written(text: str, path: AnyPath | None) -> str:
    """Return a text, after writing it to a path in place of an earlier file, unless the path is None or empty."""
    if path:
        write_whole(Path(path), text)
    return text


def load_run(folder: AnyPath) -> Run:
    """Return the finished run in a folder; its `outcome` is None.

    Raises:
        FolderError: the folder holds no run, or none that this version can read.
        RunError: the run failed; with its message.
    """
    run = read_run(Path(folder))
    if run.status != "done":
        raise RunError(run.document["error"]["message"], run.folder)
    return run


def read_run(folder: Path) -> Run:
    """Return the run in a folder; one that failed is returned, too (`status` is "failed"), without tables.

    Its `outcome` is None, and `folder` absolute.

    Raises:
        FolderError: the folder holds no run, or none that this version can read.
    """
    document = read_results(folder)
    try:
        scene = read_scene(document["scene"])
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
    """Save charts in a folder, each under its name, in place of earlier ones; numbers get units with SI prefixes.

    Args:
        drawn: charts by name, in base units.
        folder: an existing one.
        figures: format, "png", "svg" or "pdf"; True or False: "png".
    """
    form = figures if isinstance(figures, str) else FORMATS[0]
    for name, chart in drawn.items():
        plots.save_figure(plots.draw(chart.written(scale_of)), folder / f"{name}.{form}")
