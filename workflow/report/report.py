"""Runs, or a sweep, as one HTML page that needs no network and no other file.

A scene is put in words for somebody who has not seen its file, from the tables' own descriptions.
"""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from importlib.resources import files
from itertools import islice
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

from jinja2 import Environment, FunctionLoader, StrictUndefined

from contact1d.analysis.curve import read_states
from contact1d.files import write_whole
from contact1d.workflow.body.theory import in_words
from contact1d.workflow.errors import FolderError
from contact1d.workflow.report.charts import Chart, curves, over_axes, pressures, way
from contact1d.workflow.runs.campaign import AnyPath
from contact1d.workflow.runs.finished import Run, read_run
from contact1d.workflow.scene import Scene, Table, scene_to_toml
from contact1d.workflow.scene.quantities import keys_of
from contact1d.workflow.sweep.table import RECORD, counts_in, read_record, read_table, units_in

PACKAGE = files("contact1d.workflow.report")
MOST_ROWS = 500
"""Rows of a sweep's table that the page shows; results.csv has all."""
MOST_RUNS = 24
"""Runs on one page: more make neither a table nor a figure that can be read; that is what a sweep is for."""
INDEX = re.compile(r"(?<!\w)([^\W\d_][\u0303\u0304]?)_(\w{1,3})(?!\w)")
TOGETHER = re.compile(r" ?= ?(?=[\d−-])|(?<=\d) (?=(?:LU|FU|nm|[µm]N|[MG]Pa)\b|%)")
EXPONENT = re.compile(r"\^(?:\{([^{}]+)\}|([−-]?\d+(?:[./]\d+)?|[a-z](?!\w)))")


def report(folders: Sequence[AnyPath], out: AnyPath = "report.html") -> Path:
    """Write the page of run folders, or of one sweep's folder.

    Args:
        folders: one or several runs, which are overlaid; or one sweep.
        out: the file.

    Returns:
        The file's path.

    Raises:
        FolderError: a folder holds neither a run nor a sweep, or there are too many.
    """
    places = [Path(folder) for folder in folders]
    sweeps = [place for place in places if (place / RECORD).is_file()]
    if sweeps and len(places) > 1:
        raise FolderError(f"{sweeps[0]} holds a sweep: a page shows one sweep, or runs")
    if len(places) > MOST_RUNS:
        raise FolderError(f"{len(places)} runs are more than the {MOST_RUNS} that one page can show")
    try:
        page = _of_sweep(places[0]) if sweeps else _of_runs([read_run(place) for place in places])
    except (OSError, LookupError, TypeError, ValueError, EOFError, BadZipFile, csv.Error) as error:
        raise FolderError(
            f"a file in {' or '.join(map(str, places))} can't be read ({error}): start the run or the sweep again"
        ) from error
    write_whole(Path(out), page)
    return Path(out)


def _of_runs(runs: Sequence[Run]) -> str:
    """Runs in words for somebody who has not seen their scenes; one that failed says why."""
    names = _names(runs)
    done = {name: run for name, run in zip(names, runs, strict=True) if run.status == "done"}
    charts = [*curves(done), *filter(None, [pressures(done)])]
    moving = None
    if len(runs) == 1 and done:
        states = runs[0].folder / "states.npz"
        if states.is_file() and len(runs[0].curve.displacement) > 1:
            moving = way(runs[0], read_states(states))
    quantities = list(dict.fromkeys(name for run in done.values() for name in run.results))
    told = [
        {
            "name": run.folder.name, "anchor": f"run-{number}", "run": run, "facts": _facts(run),
            "error": "" if run.status == "done" else run.document["error"]["message"],
            "scene": scene_in_words(run.scene), "toml": scene_to_toml(run.scene),
            "deck": _text(run.folder / "in.lammps"),
        }
        for number, run in enumerate(runs, 1)
    ]  # fmt: skip
    return _page("runs.html", charts, moving, told=told, names=names, done=done, quantities=quantities, beside=in_words)


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8") if path.is_file() else ""


def _facts(run: Run) -> dict[str, str]:
    """What accuracy cost: tolerance, refinements, steps, times."""
    accuracy: Mapping[str, Any] = run.document.get("accuracy", {})
    asked, timing = run.scene.accuracy.tolerance, run.timing
    return {
        "tolerance asked for": f"{asked:g}",
        "tolerance of the settings": f"{accuracy.get('tolerance', asked):g}",
        "refinements": str(accuracy.get("refinements", 0)),
        "LAMMPS steps": f"{timing['steps']:,.0f}".replace(",", "\u202f"),
        "time in LAMMPS": f"{timing['lammps_s']:.2f} s",
        "time in all": f"{timing['total_s']:.2f} s",
    }


def _names(runs: Sequence[Run]) -> list[str]:
    """What each run is called on the page: its title, or its folder where titles are the same."""
    for names in ([run.scene.title for run in runs], [run.folder.name for run in runs]):
        if len(set(names)) == len(names):
            return names
    return [str(run.folder) for run in runs]


def _of_sweep(folder: Path) -> str:
    plan, units = read_record(folder), units_in(folder)
    return _page(
        "sweep.html", over_axes(folder, plan, units), None, plan=plan, units=units, folder=folder,
        rows=list(islice(read_table(folder), MOST_ROWS)), counts=counts_in(folder),
        base=json.dumps(plan.base, indent=2, ensure_ascii=False),
    )  # fmt: skip


def _page(template: str, charts: Sequence[Chart], moving: Mapping[str, Any] | None, **values: Any) -> str:
    """A page without other files. Texts are plain; through `symbols` `F_A` and `R^0.5` become HTML."""
    from plotly.offline import get_plotlyjs

    made = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True,
        loader=FunctionLoader(lambda name: PACKAGE.joinpath(name).read_text(encoding="utf-8")),
    )  # fmt: skip
    made.filters["symbols"] = symbols
    data = json.dumps({"charts": charts, "way": moving}, ensure_ascii=False, allow_nan=False).replace("</", "<\\/")
    return made.get_template(template).render(values, plotly=get_plotlyjs(), data=data, charts=charts, moving=moving)


def symbols(text: str) -> str:
    """Return `text` as HTML, escaped: `F_A` has an index, `R^{2/3}` an exponent, no line ends inside `R = 1000 LU`."""
    whole = TOGETHER.sub(lambda found: found[0].replace(" ", "\u00a0"), escape(text))
    indexed = INDEX.sub(r"<i>\1</i><sub>\2</sub>", whole)
    return EXPONENT.sub(lambda found: f"<sup>{found[1] or found[2]}</sup>", indexed)


MOST_ITEMS = 6
"""Items of a list that are shown; of more, the ends."""


def scene_in_words(scene: Scene) -> list[dict[str, Any]]:
    """Every table that the scene has, in order: its name, what it stands for, what each value is, with its unit."""
    tables = {name: getattr(scene, name) for name in Scene.model_fields}
    return [
        {"name": name.replace("_", " "), "meaning": _meaning(table), "values": list(_values(table))}
        for name, table in tables.items()
        if isinstance(table, Table)
    ]


def _meaning(table: Table) -> str:
    text = (type(table).__doc__ or "").partition("\n")[0].removeprefix("Effect: ")
    return text[:1].upper() + text[1:]


def _values(table: Table, within: str = "") -> Iterator[tuple[str, str]]:
    for name, key in keys_of(type(table)).items():
        value = getattr(table, key.field)
        label = name.replace("_", " ")
        if isinstance(value, Table):
            yield from _values(value, f"{within}{label}: ")
        elif value is not None:
            unit = key.allowed.unit
            named = unit is not None and unit.name != "1" and value != "auto"
            yield within + label, _shown(value) + (f" {unit.name}" if unit and named else "")


def _shown(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, tuple | list):
        items = [_shown(item) for item in value]
        few = items if len(items) <= MOST_ITEMS else [*items[: MOST_ITEMS // 2], "…", *items[-MOST_ITEMS // 2 :]]
        return ", ".join(few) + (f" ({len(items)} in all)" if few != items else "")
    return str(value)
