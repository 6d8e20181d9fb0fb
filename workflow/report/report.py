"""The HTML page of runs, of a sweep or of a fit, which needs no network and no other file.

A scene is described for readers who have not seen its file, with the descriptions of its tables and keys.
"""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator, Mapping, Sequence
from importlib.resources import files
from itertools import islice
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

from jinja2 import Environment, FunctionLoader, StrictUndefined

from contact1d.analysis.chart import Axis
from contact1d.analysis.curve import read_states
from contact1d.files import AnyPath, write_whole
from contact1d.workflow.body.theory import in_words
from contact1d.workflow.errors import FolderError
from contact1d.workflow.fit.curve import NOUNS
from contact1d.workflow.fit.report import RECORD as FIT
from contact1d.workflow.fit.report import TABLE, chart, noise_in_words, written
from contact1d.workflow.fit.subject import POINT
from contact1d.workflow.report.charts import Data, charts_of, path_of, symbols
from contact1d.workflow.runs.charts import charts
from contact1d.workflow.runs.finished import Run, read_run
from contact1d.workflow.runs.report import results_in
from contact1d.workflow.scene import Scene, Table
from contact1d.workflow.scene.quantities import keys_of
from contact1d.workflow.sweep.figures import label_in, sweep_charts, title_of
from contact1d.workflow.sweep.table import RECORD, columns_of, counts_in, read_record, read_table, units_in
from contact1d.workflow.units import NUMBER, SI, Quantity, Scales, scale_of

PACKAGE = files("contact1d.workflow.report")
SIGNATURES = (
    b'<meta name="generator" content="contact1d report">',
    b'<script type="application/json" id="data">{"charts": ',
)
"""Text by which a page of contact1d is recognised: since 0.2.0, and in every version."""


def report(folders: Sequence[AnyPath], out: AnyPath = "report.html") -> Path:
    """Return the path of the page of runs, of a sweep or of a fit, after writing it.

    A failed run is on the page, with its reason.

    Args:
        folders: folders of one or several runs, 24 at most, which are overlaid; or the folder of one sweep or one fit.
        out: file to write, with .html behind a name without it; an earlier page is replaced.

    Raises:
        FolderError: a folder holds neither a run nor a sweep nor a fit, there are too many, or a sweep or fit among
            others; a file in it can't be read; or the file is there and no page.
    """
    path = Path(out)
    if path.suffix.lower() not in (".html", ".htm") and not path.exists():
        path = path.with_name(f"{path.name}.html")  # a browser would show the text of another file
    if path.exists() and not (path.is_file() and any(signature in path.read_bytes() for signature in SIGNATURES)):
        raise FolderError(f"{path} is no page of contact1d: a page replaces an earlier page only; choose another file")
    paths = [Path(folder) for folder in folders]
    single = [folder for folder in paths if any((folder / name).is_file() for name in (RECORD, FIT))]
    if single and len(paths) > 1:
        raise FolderError(f"{single[0]} holds a sweep or a fit: a page shows one of them, or runs")
    most_runs = 24  # more make neither a table nor a figure that can be read: they are for a sweep
    if len(paths) > most_runs:
        raise FolderError(f"{len(paths)} runs are too many for one page; at most {most_runs}")
    try:
        if single:
            page = _of_sweep(paths[0]) if (paths[0] / RECORD).is_file() else _of_fit(paths[0])
        else:
            page = _of_runs([read_run(folder) for folder in paths])
    except (OSError, LookupError, TypeError, ValueError, EOFError, BadZipFile, csv.Error) as error:
        raise FolderError(
            f"a file in {' or '.join(map(str, paths))} can't be read ({error}): start the run or the sweep again"
        ) from error
    write_whole(path, page)
    return path


def _of_runs(runs: Sequence[Run]) -> str:
    """Return the HTML page of runs.

    A failed run is reported with the reason. A single finished run has a slider over its states, where it has kept
    them.
    """
    names = _names(runs)
    done = {name: run for name, run in zip(names, runs, strict=True) if run.status == "done"}
    drawn = {name: charts(run) for name, run in done.items()}
    moving = None
    if len(runs) == 1 and done and (states := runs[0].folder / "states.npz").is_file():
        moving = path_of(runs[0], read_states(states))
    entries = {name: results_in(run.document) for name, run in done.items()}
    return _page(
        "runs.html", charts_of(drawn), moving, runs=runs, names=names, done=done, entries=entries,
        sentence=sentence, scene_in_words=scene_in_words, facts=_facts, deck=_deck,
        quantities=list(dict.fromkeys(name for results in entries.values() for name in results)), theory=in_words,
    )  # fmt: skip


def _deck(run: Run) -> str:
    """Return the text of in.lammps, the LAMMPS input of a run, from its folder; "" without the file."""
    path = run.folder / "in.lammps"
    return path.read_text(encoding="utf-8") if path.is_file() else ""


def _facts(run: Run) -> dict[str, str]:
    """Return tolerance, refinements, LAMMPS steps and wall times [s] of a run as texts by what they are.

    Without an entry in results.json the tolerance of the settings is the required one, and there are 0 refinements.
    """
    accuracy: Mapping[str, Any] = run.document.get("accuracy", {})
    asked, timing = run.scene.accuracy.tolerance, run.timing
    return {
        "required tolerance": f"{asked:g}",
        "tolerance of the settings": f"{accuracy.get('tolerance', asked):g}",
        "refinements": str(accuracy.get("refinements", 0)),
        "LAMMPS steps": f"{timing['steps']:,.0f}".replace(",", "\u202f"),
        "time in LAMMPS": f"{timing['lammps_s']:.2f} s",
        "total time": f"{timing['total_s']:.2f} s",
    }


def _names(runs: Sequence[Run]) -> list[str]:
    """Return the name of each run on the page, in order: its title, unless two runs have the same one.

    Then it is the name of its folder, and where two of these are the same the whole path.
    """
    for names in ([run.scene.title for run in runs], [run.folder.name for run in runs]):
        if len(set(names)) == len(names):
            return names
    return [str(run.folder) for run in runs]


def _of_sweep(folder: Path) -> str:
    """Return the HTML page of a sweep, with the first 500 points in its table.

    Raises:
        FolderError: the folder holds no record of a sweep.
    """
    most_rows = 500  # results.csv has all
    plan, units, rows = read_record(folder), units_in(folder), list(islice(read_table(folder), most_rows))
    sizes = {name: max((abs(float(row[name])) for row in rows if row[name]), default=0.0) for name in units}
    columns = {name: scale_of(sizes[name], unit) for name, unit in units.items()}
    drawn = {"": sweep_charts(folder, plan, units)}

    def number(row: Mapping[str, str], name: str) -> str:
        """Return a result of a row as text with uncertainty, in the unit of its column; "—" for an empty cell."""
        if not row[name]:
            return "—"
        value, uncertainty = (columns[name][0] * float(row[column]) for column in columns_of(name))
        return str(Quantity(value, uncertainty, NUMBER))

    return _page(
        "sweep.html", charts_of(drawn), None, plan=plan, folder=folder, number=number, label=label_in, rows=rows,
        titles={axis.key: title_of(plan, axis) for axis in plan.axes}, counts=counts_in(folder),
        columns={name: Axis(name.replace("_", " "), unit).label for name, (_, unit) in columns.items()},
        base=json.dumps(plan.base, indent=2, ensure_ascii=False),
    )  # fmt: skip


def _of_fit(folder: Path) -> str:
    """Return the HTML page of a fit, from the files in its folder."""
    from pandas import read_csv

    record = json.loads((folder / FIT).read_text(encoding="utf-8"))
    agreed = record["parameters"] | {POINT: record[POINT]}
    columns = {"both segments": agreed} if len(record["segments"]) != 1 else {}
    for name, part in record["segments"].items():
        columns[NOUNS[name]] = {} if "refused" in part else part["parameters"] | {POINT: part[POINT]}
    rows = {
        key: {name: written(entries[key]) if entries.get(key) else "—" for name, entries in columns.items()}
        for key in agreed
    }
    if record["pull_off_force"]:
        measured = Quantity.of(record["pull_off_force"])
        rows["measured pull-off force"] = dict.fromkeys(columns, "—") | {list(columns)[-1]: str(measured)}
    noise = noise_in_words(*(record["noise"][name] for name in ("value", "share_with_memory", "memory")))
    return _page(
        "fit.html", charts_of({"": {"fit": chart(record, read_csv(folder / TABLE))}}), None, record=record, rows=rows,
        columns=[*columns], folder=folder, noise=noise,
        scene=(folder / "scene.toml").read_text(encoding="utf-8"),
    )  # fmt: skip


def _page(template: str, charts: Sequence[Data], moving: Mapping[str, Any] | None, **values: Any) -> str:
    """Return a page with its scripts and data, as HTML.

    In the template the filter `symbols` writes `F_A` and `R^0.5` as HTML.

    Args:
        template: name of its file.
        charts: in plotly's form.
        moving: charts that a slider moves, with their texts; None: without a slider.
        values: of the names in the template.

    Raises:
        ValueError: a number in the charts that is not finite.
        jinja2.UndefinedError: a name in the template without a value.
    """
    from plotly.offline import get_plotlyjs

    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True,
        loader=FunctionLoader(lambda name: PACKAGE.joinpath(name).read_text(encoding="utf-8")),
    )  # fmt: skip
    environment.filters["symbols"] = symbols
    data = json.dumps({"charts": charts, "path": moving}, ensure_ascii=False, allow_nan=False).replace("</", "<\\/")
    page = environment.get_template(template)
    return page.render(values, plotly=get_plotlyjs(), data=data, charts=charts, moving=moving)


def sentence(scene: Scene, scales: Scales) -> str:
    """Return a sentence with the bodies, effects and experiment of a scene, numbers in SI with `scales` where known.

    Else they are in units of the model. The upper body has its shape and sizes, effects their names.
    """
    bodies, experiment = scene.bodies, scene.experiment
    size, given = (
        ", ".join(f"{name} {value}" for name, value in _values(table, scales) if name not in left_out)
        for table, left_out in ((bodies.profile, ("kind", "x", "z")), (experiment, ("kind",)))
    )
    lower = "a rigid plane" if bodies.lower == "rigid_plane" else "a lower body"
    effects = f" with {', '.join(scene.effects)}" if scene.effects else ""
    shape, test = bodies.profile.kind.replace("_", " "), experiment.kind.replace("_", " ")
    return f"A {shape} ({size}) on {lower}{effects}. Experiment: {test}, {given}.".replace(" ()", "")


def scene_in_words(scene: Scene, scales: Scales) -> list[dict[str, Any]]:
    """Return name, meaning and values with units of each table of a scene, in order; in SI with `scales` where known.

    They are under `name`, `meaning`, and `values`, pairs of label and text. Tables that the scene lacks are left out.
    """
    tables = {name: getattr(scene, name) for name in Scene.model_fields}
    return [
        {"name": name.replace("_", " "), "meaning": _meaning(table), "values": list(_values(table, scales))}
        for name, table in tables.items()
        if isinstance(table, Table)
    ]


def _meaning(table: Table) -> str:
    """Return the first line of the docstring of a table's class, without "Effect: ", with a capital; "" without one."""
    text = (type(table).__doc__ or "").partition("\n")[0].removeprefix("Effect: ")
    return text[:1].upper() + text[1:]


def _values(table: Table, scales: Scales, within: str = "") -> Iterator[tuple[str, str]]:
    """Yield label and text with unit of each key of a table that has a value, also of those of tables in it.

    Labels begin with `within`. A key on None is left out, one whose name ends in "_unit" where it is 1, and, with known
    scales, one whose unit has no known size in SI.
    """
    for name, key in keys_of(type(table)).items():
        value, unit = getattr(table, key.field), key.allowed.unit
        label = name.replace("_", " ")
        if isinstance(value, Table):
            yield from _values(value, scales, f"{within}{label}: ")
        elif (
            value is not None
            and (not name.endswith("_unit") or value != 1.0)
            and not (unit and scales.known and unit.name in SI and not scales.know(unit.name))
        ):
            text = _shown(value, NUMBER if unit is None else unit.name, scales)
            yield within + label, text.replace("N/m", "J/m²") if unit and "J/m²" in unit.text else text


def _shown(value: Any, unit: str, scales: Scales, most_items: int = 6) -> str:
    """Return a value of a scene as text: "yes" or "no", a float with its unit in six digits, else as it prints.

    A float is in SI with a prefix where `scales` know its unit. Of a list with more than `most_items` it has the first
    and last ones, half of that number each, and their number. A table is the texts of its values in brackets, without
    their labels.
    """
    if isinstance(value, Table):
        return f"({', '.join(text for _, text in _values(value, scales))})"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        factor, name = scales.written(value, unit)
        return f"{value * factor:.6g} {name}".removesuffix(f" {NUMBER}")
    if isinstance(value, tuple | list):
        items = [_shown(item, unit, scales) for item in value]
        half = most_items // 2
        shown = items if len(items) <= most_items else [*items[:half], "…", *items[-half:]]
        return ", ".join(shown) + (f" ({len(items)} in all)" if shown != items else "")
    return str(value)
