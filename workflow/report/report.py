"""Runs, or a sweep, as one HTML page that needs nothing beside it: no network, no other file."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any

from contact1d.analysis.states import read_states
from contact1d.files import write_whole
from contact1d.workflow.body.theory import in_words
from contact1d.workflow.errors import FolderError
from contact1d.workflow.pages.parts import environment, text_of
from contact1d.workflow.report.charts import Chart, curves, over_axes, pressures, way
from contact1d.workflow.report.words import Said, scene_in_words
from contact1d.workflow.runs.campaign import AnyPath
from contact1d.workflow.runs.finished import Run, read_run
from contact1d.workflow.scene import scene_to_toml
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
