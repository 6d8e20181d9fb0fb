"""Runs, or a sweep, as one HTML page that needs nothing beside it: no network, no other file.

A scene is put in words for somebody who has not seen its file, from the tables' own descriptions.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

from contact1d.analysis.curve import read_states
from contact1d.files import write_whole
from contact1d.workflow.body.theory import in_words
from contact1d.workflow.errors import FolderError
from contact1d.workflow.pages.parts import environment, text_of
from contact1d.workflow.report.charts import Chart, curves, over_axes, pressures, way
from contact1d.workflow.runs.campaign import AnyPath
from contact1d.workflow.runs.finished import Run, read_run
from contact1d.workflow.scene import Scene, Table, scene_to_toml
from contact1d.workflow.scene.quantities import keys_of
from contact1d.workflow.sweep.axes import read_sweep
from contact1d.workflow.sweep.table import RECORD, TABLE, read_table, units_in

PACKAGE = "contact1d.workflow.report"
MOST_ROWS = 500
"""Rows of a sweep's table that the page shows; results.csv has all."""
MOST_RUNS = 24
"""Runs on one page: more make neither a table nor a figure that can be read; that is what a sweep is for."""


@dataclass(frozen=True)
class Told:
    """A run as the page tells it.

    Attributes:
        name: of its folder; anchor: its `id` on the page.
        run: what was read.
        scene: in words.
        error: why it gave no numbers; empty if it did.
        toml, deck: the scene and in.lammps, as text.
    """

    name: str
    anchor: str
    run: Run
    scene: Sequence[Said]
    error: str
    toml: str
    deck: str

    @property
    def facts(self) -> dict[str, str]:
        """What accuracy cost: tolerance, refinements, steps, times."""
        document, timing = self.run.document, self.run.timing
        accuracy: Mapping[str, Any] = document.get("accuracy", {})
        asked = self.run.scene.accuracy.tolerance
        return {
            "tolerance asked for": f"{asked:g}",
            "tolerance of the settings": f"{accuracy.get('tolerance', asked):g}",
            "refinements": str(accuracy.get("refinements", 0)),
            "LAMMPS steps": f"{timing['steps']:,.0f}".replace(",", "\u202f"),
            "time in LAMMPS": f"{timing['lammps_s']:.2f} s",
            "time in all": f"{timing['total_s']:.2f} s",
        }


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
    if len(places) == 1 and (places[0] / RECORD).is_file():
        page = _of_sweep(places[0])
    else:
        if len(places) > MOST_RUNS:
            raise FolderError(f"{len(places)} runs are more than the {MOST_RUNS} that one page can show")
        for place in places:
            if (place / RECORD).is_file():
                raise FolderError(f"{place} holds a sweep: a page shows one sweep, or runs")
        page = _of_runs([_told(place, number) for number, place in enumerate(places)])
    write_whole(Path(out), page)
    return Path(out)


def _told(place: Path, number: int) -> Told:
    run = read_run(place)
    error = "" if run.status == "done" else str(run.document["error"]["message"])
    deck = place / "in.lammps"
    return Told(
        name=run.folder.name,
        anchor=f"run-{number + 1}",
        run=run,
        scene=scene_in_words(run.scene),
        error=error,
        toml=scene_to_toml(run.scene),
        deck=deck.read_text(encoding="utf-8") if deck.is_file() else "",
    )


def _of_runs(told: Sequence[Told]) -> str:
    names = _names(told)
    done = {name: one.run for name, one in zip(names, told, strict=True) if not one.error}
    charts = [*curves(done), *filter(None, [pressures(done)])]
    moving = None
    if len(told) == 1 and done:
        states = told[0].run.folder / "states.npz"
        if states.is_file() and len(told[0].run.curve.displacement) > 1:
            moving = way(told[0].run, read_states(states))
    quantities = list(dict.fromkeys(name for run in done.values() for name in run.results))
    return _page("runs.html", charts, moving, told=told, names=names, done=done, quantities=quantities, beside=in_words)


def _names(told: Sequence[Told]) -> list[str]:
    """What each run is called on the page: its title, or its folder where titles are the same."""
    titles = [one.run.scene.title for one in told]
    names = titles if len(set(titles)) == len(titles) else [one.name for one in told]
    return names if len(set(names)) == len(names) else [str(one.run.folder) for one in told]


def _of_sweep(folder: Path) -> str:
    from tomllib import loads

    if not (folder / TABLE).is_file():
        raise FolderError(f"{folder} holds a sweep without {TABLE}: start it again, it goes on")
    plan = read_sweep(loads((folder / RECORD).read_text(encoding="utf-8")))
    units = units_in(folder)
    rows = list(islice(read_table(folder), MOST_ROWS))
    counts: dict[str, int] = {}
    for row in read_table(folder):
        counts[row["status"]] = counts.get(row["status"], 0) + 1
    charts = over_axes(folder, plan, units)
    return _page(
        "sweep.html", charts, None, plan=plan, units=units, rows=rows, counts=counts, folder=folder,
        base=json.dumps(plan.base, indent=2, ensure_ascii=False),
    )  # fmt: skip


def _page(template: str, charts: Sequence[Chart], moving: Mapping[str, Any] | None, **values: Any) -> str:
    from jinja2 import FunctionLoader
    from plotly.offline import get_plotlyjs

    made = environment()
    made.loader = FunctionLoader(lambda name: text_of(PACKAGE, name))
    data = json.dumps({"charts": list(charts), "way": moving}, ensure_ascii=False, allow_nan=False)
    values |= {"charts": charts, "moving": moving is not None}
    if moving is not None:
        values |= {"last": len(moving["words"]) - 1, "start": moving["start"]}
    page = {"plotly": get_plotlyjs(), "script": text_of(PACKAGE, "page.js"), "data": data.replace("</", "<\\/")}
    return made.get_template(template).render(page | values)


MOST_ITEMS = 6
"""Items of a list that are shown; of more, the ends."""


@dataclass(frozen=True)
class Said:
    """A table of the scene: its name, what it stands for, and its values: what each is, and the value with its unit."""

    name: str
    meaning: str
    values: tuple[tuple[str, str], ...]


def scene_in_words(scene: Scene) -> list[Said]:
    """Every table that the scene has, in the order of a scene file."""
    tables = ((name, getattr(scene, name)) for name in Scene.model_fields)
    return [
        Said(name.replace("_", " "), _meaning(table), tuple(_values(table)))
        for name, table in tables
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
