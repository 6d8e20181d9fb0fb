"""Where the time of a quick run goes: the Hertz curve of `validation.speed.peers`, 50 points, as a later run in one process.

    python -m validation.speed.breakdown

writes the table between the markers of validation/speed/README.md. Medians over RUNS runs of processor times, the worker's
with ours; functions are timed from outside, each without what it calls of the others.
"""

from __future__ import annotations

import tempfile
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

import contact1d.workflow.runs.campaign as campaign
from contact1d.workflow.engine.process import WorkerProcess
from contact1d.workflow.experiments.running.stepped import SteppedRows
from contact1d.workflow.scene import scene_from_dict
from validation.judging.markdown import table
from validation.speed.pages import write_between
from validation.speed.peers.clock import spent
from validation.speed.peers.contact1d_peer import SETTINGS, plane_tables
from validation.speed.peers.contacts import displacements

README = Path(__file__).parent / "README.md"
RUNS = 15
LAMMPS = "LAMMPS: 50 rows, each a step, and the deck's head"
ASKED = "the worker beside LAMMPS (per-atom arrays, LAMMPS opened and closed), and the pipe"
REST = "all else"
PARTS: dict[str, tuple[tuple[Any, str], ...]] = {
    "settings": ((campaign, "settings_for"),),
    "deck, data file and table": ((campaign, "_write"),),
    ASKED: ((WorkerProcess, "ask"),),
    "states from the rows' frames": ((SteppedRows, "profiles"),),
    "results, tables and files": tuple(
        (campaign, name) for name in ("write_whole", "curve_of", "write_tables", "results", "write_results")
    ),
}
"""What is timed: where it is looked up, and its name."""


class Clock:
    """Wall times by part; of nested parts each has its own."""

    def __init__(self) -> None:
        """All at zero."""
        self.spent: dict[str, float] = defaultdict(float)
        self._inside: list[float] = []

    def timed(self, part: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """The same function, whose time counts for a part."""

        def call(*arguments: Any, **named: Any) -> Any:
            began = spent()
            self._inside.append(0.0)
            try:
                return function(*arguments, **named)
            finally:
                taken, inner = spent() - began, self._inside.pop()
                self.spent[part] += taken - inner
                if self._inside:
                    self._inside[-1] += taken

        return call


def measured() -> list[dict[str, float]]:
    """Seconds by part of each of RUNS runs."""
    data = plane_tables("hertz", next(one for one in SETTINGS["hertz"] if one.grid == 12))
    data["experiment"] = {"kind": "path", "displacements": displacements("hertz").tolist()}
    scene, clock, found = scene_from_dict(data), Clock(), []
    for part, functions in PARTS.items():
        for place, name in functions:
            setattr(place, name, clock.timed(part, getattr(place, name)))
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(RUNS + 2):
            clock.spent.clear()
            began = spent()
            lammps = campaign.run(scene, folder, figures=False).document["timing"]["lammps_cpu_s"]
            total = spent() - began
            parts = dict(clock.spent)
            parts[REST] = total - sum(parts.values())
            found.append({"whole run": total, LAMMPS: lammps} | parts | {ASKED: parts[ASKED] - lammps})
    return found[2:]


def main() -> None:
    """Measure, print, and write the table."""
    found = measured()
    whole = median(one["whole run"] for one in found)
    names = ["whole run", LAMMPS, ASKED, *(part for part in PARTS if part != ASKED), REST]
    times = {name: median(one[name] for one in found) for name in names}
    rows = [(name, f"{1e3 * time:.1f} ms", f"{time / whole:.0%}") for name, time in times.items()]
    text = table(("part", "processor time", "share"), rows)
    write_between(README, "breakdown", text)
    print(text)


if __name__ == "__main__":
    main()
