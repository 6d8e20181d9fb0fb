"""Runs, or a sweep, as one HTML page that needs no network and no other file.

A scene is put in words for somebody who has not seen its file, from the tables' own descriptions.
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

from contact1d.analysis.curve import read_states
from contact1d.files import AnyPath, write_whole
from contact1d.workflow.body.theory import in_words
from contact1d.workflow.errors import FolderError
from contact1d.workflow.report.charts import Data, charts_of, path_of, symbols
from contact1d.workflow.runs.charts import charts
from contact1d.workflow.runs.finished import Run, read_run
from contact1d.workflow.runs.report import results_in
from contact1d.workflow.scene import Scene, Table
from contact1d.workflow.scene.quantities import keys_of
from contact1d.workflow.sweep.figures import label_in, sweep_charts, title_of
from contact1d.workflow.sweep.table import RECORD, counts_in, read_record, read_table, units_in
from contact1d.workflow.units import NUMBER, SI, Quantity, Scales

PACKAGE = files("contact1d.workflow.report")
MOST_ROWS = 500
"""Rows of a sweep's table that the page shows; results.csv has all."""
MOST_RUNS = 24
"""Runs on one page: more make neither a table nor a figure that can be read; that is what a sweep is for."""
MARKS = (
    b'<meta name="generator" content="contact1d report">',
    b'<script type="application/json" id="data">{"charts": ',
)
"""What a page has that is ours: since 0.2.0, and always."""


def report(folders: Sequence[AnyPath], out: AnyPath = "report.html") -> Path:
    """Write the page of run folders, or of one sweep's folder.

    Args:
        folders: one or several runs, which are overlaid; or one sweep.
        out: the file.

    Returns:
        The file's path.

    Raises:
        FolderError: a folder holds neither a run nor a sweep, or there are too many; or the file is there and no page.
    """
    path = Path(out)
    if path.exists() and not (path.is_file() and any(mark in path.read_bytes() for mark in MARKS)):
        raise FolderError(f"{path} is no page of contact1d: a page replaces an earlier page only; choose another file")
    places = [Path(folder) for folder in folders]
    sweeps = [place for place in places if (place / RECORD).is_file()]
    if sweeps and len(places) > 1:
        raise FolderError(f"{sweeps[0]} holds a sweep: a page shows one sweep, or runs")
    if len(places) > MOST_RUNS:
        raise FolderError(f"{len(places)} runs are too many for one page; at most {MOST_RUNS}")
    try:
        page = _of_sweep(places[0]) if sweeps else _of_runs([read_run(place) for place in places])
    except (OSError, LookupError, TypeError, ValueError, EOFError, BadZipFile, csv.Error) as error:
        raise FolderError(
            f"a file in {' or '.join(map(str, places))} can't be read ({error}): start the run or the sweep again"
        ) from error
    write_whole(path, page)
    return path


def _of_runs(runs: Sequence[Run]) -> str:
    """Runs in words for somebody who has not seen their scenes; one that failed says why."""
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
        quantities=list(dict.fromkeys(name for one in entries.values() for name in one)), beside=in_words,
    )  # fmt: skip


def _deck(run: Run) -> str:
    path = run.folder / "in.lammps"
    return path.read_text(encoding="utf-8") if path.is_file() else ""


def _facts(run: Run) -> dict[str, str]:
    """What accuracy cost: tolerance, refinements, steps, times."""
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
    """What each run is called on the page: its title, or its folder where titles are the same."""
    for names in ([run.scene.title for run in runs], [run.folder.name for run in runs]):
        if len(set(names)) == len(names):
            return names
    return [str(run.folder) for run in runs]


def _of_sweep(folder: Path) -> str:
    plan, units = read_record(folder), units_in(folder)
    drawn = {"": sweep_charts(folder, plan, units)}

    def number(row: Mapping[str, str], name: str) -> str:
        return str(Quantity(float(row[name]), float(row[f"{name}_uncertainty"]), units[name])) if row[name] else "—"

    return _page(
        "sweep.html", charts_of(drawn), None, plan=plan, units=units, folder=folder, number=number, label=label_in,
        titles={axis.key: title_of(plan, axis) for axis in plan.axes},
        rows=list(islice(read_table(folder), MOST_ROWS)), counts=counts_in(folder),
        base=json.dumps(plan.base, indent=2, ensure_ascii=False),
    )  # fmt: skip


def _page(template: str, charts: Sequence[Data], moving: Mapping[str, Any] | None, **values: Any) -> str:
    """A page without other files. Texts are plain; through `symbols` `F_A` and `R^0.5` become HTML."""
    from plotly.offline import get_plotlyjs

    made = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True,
        loader=FunctionLoader(lambda name: PACKAGE.joinpath(name).read_text(encoding="utf-8")),
    )  # fmt: skip
    made.filters["symbols"] = symbols
    data = json.dumps({"charts": charts, "path": moving}, ensure_ascii=False, allow_nan=False).replace("</", "<\\/")
    return made.get_template(template).render(values, plotly=get_plotlyjs(), data=data, charts=charts, moving=moving)


MOST_ITEMS = 6
"""Items of a list that are shown; of more, the ends."""


def sentence(scene: Scene, scales: Scales) -> str:
    """The scene in a sentence: the body and what it is pressed on, the effects, the experiment."""
    bodies, experiment = scene.bodies, scene.experiment
    size, given = (
        ", ".join(f"{name} {value}" for name, value in _values(table, scales) if name != "kind")
        for table in (bodies.profile, experiment)
    )
    lower = "a rigid plane" if bodies.lower == "rigid_plane" else "a lower body"
    effects = f" with {', '.join(scene.effects)}" if scene.effects else ""
    kind, what = bodies.profile.kind.replace("_", " "), experiment.kind.replace("_", " ")
    return f"A {kind} ({size}) on {lower}{effects}. Experiment: {what}, {given}.".replace(" ()", "")


def scene_in_words(scene: Scene, scales: Scales) -> list[dict[str, Any]]:
    """Every table that the scene has, in order: its name, what it stands for, what each value is, with its unit."""
    tables = {name: getattr(scene, name) for name in Scene.model_fields}
    return [
        {"name": name.replace("_", " "), "meaning": _meaning(table), "values": list(_values(table, scales))}
        for name, table in tables.items()
        if isinstance(table, Table)
    ]


def _meaning(table: Table) -> str:
    text = (type(table).__doc__ or "").partition("\n")[0].removeprefix("Effect: ")
    return text[:1].upper() + text[1:]


def _values(table: Table, scales: Scales, within: str = "") -> Iterator[tuple[str, str]]:
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


def _shown(value: Any, unit: str, scales: Scales) -> str:
    if isinstance(value, Table):
        return f"({', '.join(text for _, text in _values(value, scales))})"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        factor, name = scales.written(value, unit)
        return f"{value * factor:.6g} {name}".removesuffix(f" {NUMBER}")
    if isinstance(value, tuple | list):
        items = [_shown(item, unit, scales) for item in value]
        few = items if len(items) <= MOST_ITEMS else [*items[: MOST_ITEMS // 2], "…", *items[-MOST_ITEMS // 2 :]]
        return ", ".join(few) + (f" ({len(items)} in all)" if few != items else "")
    return str(value)
