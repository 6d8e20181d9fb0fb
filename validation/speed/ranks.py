"""What several MPI ranks save: one large contact on one rank and on more, by turns, from 10⁴ to 10⁶ particles per body.

    python -m validation.speed.ranks [--sizes 10000 100000 1000000] [--ranks 2] [--turns 3]

A size is a path of two rows of two chains (`validation.speed.scaling.scaled_scene`). Of each the median of the wall time of
its rows, and of the whole run, in which one rank alone reads the bodies and Python writes them. The numbers of both are
compared: the largest difference of a force over the largest force.
The table goes to validation/speed/results/ranks.json and between the markers of docs/performance.md.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from contact1d import Run, run
from validation.judging.markdown import table
from validation.speed.pages import write_between
from validation.speed.ratios import PAGE
from validation.speed.scaling import DEEPEST, machine, scaled_scene

RESULTS = Path(__file__).parent / "results" / "ranks.json"
WAY = {"from": 0.0, "to": DEEPEST, "steps": 1}
METHODS = ("quasistatic", "dynamic")
HEAD = ("method", "particles per body", "rows, 1 rank", "ranks", "rows", "1 rank over that", "whole run", "forces")


def compared(particles: int, method: str, ranks: int, turns: int) -> dict[str, Any]:
    """Medians of one size on one rank and on several, by turns; and how far their forces are apart."""
    scene = scaled_scene(particles, method).with_({"experiment.displacements": WAY})
    runs: dict[int, list[Run]] = {1: [], ranks: []}
    with tempfile.TemporaryDirectory() as folder:
        for count in runs:
            run(scaled_scene(1000, method), Path(folder) / "first", figures=False, ranks=count)
        for _ in range(turns):
            for count, done in runs.items():
                done.append(run(scene, Path(folder) / str(count), figures=False, ranks=count))
    one, more = (np.asarray(runs[count][-1].curve.force) for count in runs)
    times = {
        name: {count: statistics.median(each.timing[f"{name}_s"] for each in done) for count, done in runs.items()}
        for name in ("lammps", "rows", "total")
    }
    return {
        "particles_per_body": particles, "method": method, "ranks": ranks, "turns": turns,
        **{f"{name}_s": {str(count): seconds for count, seconds in of.items()} for name, of in times.items()},
        "load_average": os.getloadavg()[0], "force_difference": float(np.abs(one - more).max() / np.abs(one).max()),
    }  # fmt: skip


def markdown(rows: Sequence[dict[str, Any]]) -> str:
    """The text between the markers."""

    def cells(row: dict[str, Any]) -> tuple[str, ...]:
        rows, total, ranks = row["rows_s"], row["total_s"], str(row["ranks"])
        size, one, more = row["particles_per_body"], rows["1"], rows[ranks]
        return (
            f"`{row['method']}`", str(size), f"{one:.3g} s", ranks, f"{more:.3g} s", f"{one / more:.2f}",
            f"{total['1'] / total[ranks]:.2f}",
            f"within {row['force_difference']:.0e}",
        )  # fmt: skip

    return table(HEAD, [cells(row) for row in rows])


def main() -> None:
    """Measure, print and write."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", nargs="+", type=int, default=[10_000, 100_000, 1_000_000])
    parser.add_argument("--methods", nargs="+", choices=METHODS, default=list(METHODS))
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--turns", type=int, default=3)
    options = parser.parse_args()
    where, rows = machine(), []
    for method in options.methods:
        for size in options.sizes:
            rows.append(compared(size, method, options.ranks, options.turns))
            print(json.dumps(rows[-1]), flush=True)
    RESULTS.write_text(json.dumps({"machine": where, "rows": rows}, indent=1) + "\n")
    write_between(PAGE, "ranks", markdown(rows))


if __name__ == "__main__":
    main()
