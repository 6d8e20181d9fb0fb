"""The table of ratios of docs/performance.md, made from validation/speed/results: what was asked, what was reached, by what.

    python -m validation.speed.ratios

writes it between the page's markers. A figure that is not reached says so.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import groupby
from pathlib import Path
from typing import Any

from validation.judging.markdown import table
from validation.speed.pages import write_between
from validation.speed.peers.table import OURS as PROGRAM
from validation.speed.peers.table import ROWS, comparisons
from validation.speed.scaling import MEMORY, SPREAD

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "performance.md"
RESULTS = Path(__file__).parent / "results"
HEAD = ("what", "asked", "reached", "by")
NO_FIGURE = "–"
PLAIN_ASKED = {("quasistatic", 1e-3): 100.0, ("dynamic", 1e-2): 10.0}
"""Asked of the plain way's processor time over ours, by method and tolerance."""
SOLVER_ASKED = 1.0
"""Asked of the scipy solver's time over ours."""
PEERS_ASKED = {"Hertz": 10.0, "adhesive": 100.0, "JKR": 1000.0}
"""Asked of the other solvers' time over ours."""
WHOLE_ASKED = 0.025
"""Asked of the whole run of the quickest Hertz curve, through Python, by the clock [s]."""
OVERHEAD, SCALING = "`python validation/speed/deck_overhead.py`", "`python validation/speed/scaling.py`"
PEERS = "`python -m validation.speed.peers.compare`"
SCIPY, PLAIN, OURS = "scipy solver", "plain", "quasistatic"
SHOWN = ("Hertz, 1 % of the largest", f"Hertz, {ROWS}", "adhesive", "JKR")
"""Beginnings of the comparisons with other solvers that are shown; validation/speed/README.md has all of them."""

Row = tuple[str, str, str, str]
Results = dict[str, dict[str, Any]]


def read_results() -> Results:
    """The contents of validation/speed/results by file name. Raises OSError where one is missing."""
    names = ("plain", "scaling", "peers", "deck_overhead")
    return {name: json.loads((RESULTS / f"{name}.json").read_text(encoding="utf-8")) for name in names}


def markdown(results: Results) -> str:
    """The text between the markers."""
    parts = (_plain, _overhead, _outside, _scaling, _peers)
    return table(HEAD, [row for part in parts for row in part(results)])


def _plain(results: Results) -> Iterator[Row]:
    """Every way at every tolerance over the plain way of the paper, then the solver over ours."""
    rows = results["plain"]["rows"]
    by = "`python validation/speed/plain.py`"
    for way in dict.fromkeys(row["way"] for row in rows if row["way"] not in (PLAIN, SCIPY)):
        mine = [row for row in rows if row["way"] == way]
        said = ", ".join(f"{row['plain_over_it']:.3g} (tolerance {row['tolerance']:g})" for row in mine)
        wanted = {t: figure for (whose, t), figure in PLAIN_ASKED.items() if whose == way}
        asked = ", ".join(f"≥ {figure:g} (tolerance {t:g})" for t, figure in wanted.items()) or NO_FIGURE
        reached = all(row["plain_over_it"] >= wanted.get(row["tolerance"], 0.0) for row in mine)
        yield f"pull-off, CPU time: the paper's plain way over `{way}`", asked, _held(said, reached), by
    ours = {row["tolerance"]: row["cpu_s"] for row in rows if row["way"] == OURS}
    solver = {row["tolerance"]: row["cpu_s"] for row in rows if row["way"] == SCIPY}
    both = [tolerance for tolerance in solver if tolerance in ours]
    if both:
        said = ", ".join(f"{solver[t] / ours[t]:.3g} (tolerance {t:g})" for t in both)
        reached = all(solver[t] / ours[t] >= SOLVER_ASKED for t in both)
        what = f"pull-off, CPU time: the scipy solver of the tests over `{OURS}`"
        yield what, f"≥ {SOLVER_ASKED:g}", _held(said, reached), by


def _overhead(results: Results) -> Iterator[Row]:
    asked, rows = results["deck_overhead"]["asked"], results["deck_overhead"]["rows"]
    worst = max(row["ratio"] for row in rows)
    said = _held(f"{min(row['ratio'] for row in rows):.3f} to {worst:.3f}, {len(rows)} scenes", worst <= asked)
    yield "time per step: generated deck over one written by hand", f"≤ {asked:g}", said, OVERHEAD


def _outside(results: Results) -> Iterator[Row]:
    """Wall time outside LAMMPS, as far as a figure was asked for; later runs in Python share a row."""
    asked = [row for row in results["scaling"]["outside_lammps"] if row["asked_s"] is not None]
    for (is_python, limit), group in groupby(asked, lambda row: (row["run"].startswith("Python"), row["asked_s"])):
        mine = list(group)
        said = ", ".join(f"{1e3 * row['wall_s']:.0f} ms" for row in mine)
        names = [row["run"].removeprefix("Python, later runs of ").split(".toml")[0] for row in mine]
        what = f"later runs in Python, no figures: {', '.join(names)}" if is_python else f"`{mine[0]['run']}`"
        reached = all(row["wall_s"] <= limit for row in mine)
        yield f"wall time outside LAMMPS, {what}", f"≤ {1e3 * limit:.0f} ms", _held(said, reached), SCALING


def _scaling(results: Results) -> Iterator[Row]:
    rows = results["scaling"]["scaling"]
    for method in dict.fromkeys(row["method"] for row in rows):
        mine = [row for row in rows if row["method"] == method]
        costs, sizes = ([row[key] for row in mine] for key in ("ns_per_particle_step", "particles_per_body"))
        ratio = max(costs) / min(costs)
        said = f"{ratio:.2f} ({min(costs):.0f} to {max(costs):.0f} ns)"
        what = f"cost per particle and step, {method}, largest over smallest from N = {min(sizes)} to {max(sizes)}"
        yield what, f"≤ {SPREAD:g}", _held(said, ratio <= SPREAD), SCALING
    largest = max(rows, key=lambda row: float(row["python_bytes"] + row["lammps_bytes"]))
    memory = largest["python_bytes"] + largest["lammps_bytes"]
    what = f"memory of both processes at N = {largest['particles_per_body']}, the most that was measured"
    yield what, f"≤ {MEMORY / 1e9:g} GB", _held(f"{memory / 1e9:.2g} GB", memory <= MEMORY), SCALING


def _peers(results: Results) -> Iterator[Row]:
    shown = [one for one in comparisons(results["peers"]) if one[0].startswith(SHOWN)]
    for what, group in groupby(shown, lambda one: one[0].split(" (rms)")[0].rsplit(" (", 1)[0]):
        said, reached = [], True
        asked = next(figure for name, figure in PEERS_ASKED.items() if what.startswith(name))
        for _, solver, ours, theirs in group:
            if ours is None or theirs is None:
                said.append(f"{solver} –")
            else:
                ratio = theirs["seconds"] / ours["seconds"]
                said.append(f"{solver} {float(format(ratio, '.2g')):g}")
                reached = reached and ratio >= asked
        yield f"time of a curve over ours: {what}", f"≥ {asked:g}", _held(", ".join(said), reached), PEERS
    hertz = [r for r in results["peers"]["records"] if r["contact"] == "hertz" and r["solver"] == PROGRAM]
    quickest = min(hertz, key=lambda record: float(record["seconds"]))
    cpu, wall = f"{1e3 * quickest['seconds']:.0f} ms", quickest["parts"].get("wall")
    said = f"processor time of all processes {cpu}"
    said = said if wall is None else f"{_held(f'{1e3 * wall:.0f} ms', wall <= WHOLE_ASKED)}; {said}"
    what = "wall time of Hertz's curve of 50 rows, the whole run through Python"
    yield what, f"≤ {1e3 * WHOLE_ASKED:.0f} ms", said, PEERS


def _held(said: str, reached: bool) -> str:
    return said if reached else f"{said}: **not reached**"


if __name__ == "__main__":
    write_between(PAGE, "ratios", markdown(read_results()))
