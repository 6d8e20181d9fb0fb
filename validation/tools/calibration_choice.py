"""From the runs of `validation.tools.calibration` to what every run uses, `settings/calibration.json`."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from contact1d.workflow.cost.report import power
from contact1d.workflow.cost.study import TARGETS
from contact1d.workflow.model.settings import FILE, Calibration, calibration_of, meanings

RECORD = Path(__file__).parents[1] / "results" / "calibration.csv"
PART = 0.1
"""Of the tolerance, that one share may add to the error of a main result."""
SAME_COST = 0.03
"""Costs that differ by less are the same: tens of times on a machine that does other things too."""
PROMISED = {"residual": (1e-3, "on a rigid plane forces are promised to 1e-6, tests/validation/test_hertz_plane.py")}
"""Largest value of a share that something other than the tolerance allows, and what."""
TOGETHER = "together"
"""In place of a share's name, of runs with all shares as chosen."""


@dataclass(frozen=True)
class Row:
    """A scene at a tolerance with one share at one value.

    Attributes:
        added: what the relative error of a main result is larger than with the finest value, over the tolerance.
        error: relative error against the reference, over the tolerance; both of the result where it is largest.
        cpu_s, steps: median processor time in LAMMPS [s]; minimiser iterations or timesteps.
        trouble: names of warnings that the finest value does not bring, or why there are no numbers.
    """

    scene: str
    tolerance: float
    share: str
    value: float
    added: float
    error: float
    cpu_s: float
    steps: int
    trouble: str


def chosen_values(rows: Sequence[Row]) -> dict[str, Any]:
    """The contents of `calibration.json`: of each setting what it is, its value, and what that was chosen by."""
    document: dict[str, Any] = {
        "made_by": "python -m validation.tools.calibration",
        "record": "validation/results/calibration.csv",
        "tolerances": list(TARGETS),
        "adds_at_most": PART,
        "values": {},
    }
    for share in meanings():
        ladder = sorted({row.value for row in rows if row.share == share})
        refusals = _refusals(rows, share, ladder)
        costs = {value: _cost(rows, share, value) for value in ladder if not refusals[value]}
        value = next(one for one in costs if costs[one] <= (1.0 + SAME_COST) * min(costs.values()))
        worst = max((row for row in rows if (row.share, row.value) == (share, value)), key=lambda row: row.added)
        document["values"][share] = {
            "is": meanings()[share],
            "value": value,
            "adds": float(f"{worst.added:.2g}"),
            "most_in": f"{worst.scene} at {power(worst.tolerance)}",
            "cpu_over_finest": float(f"{costs[value]:.3g}"),
            "next": _next(ladder, value, refusals, costs),
        }
    return document


def _refusals(rows: Sequence[Row], share: str, ladder: Sequence[float]) -> dict[float, str]:
    """Why a value is not taken, by its worst case; "" where it could be."""
    cases = {value: [row for row in rows if (row.share, row.value) == (share, value)] for value in ladder}
    refusals = {}
    for value, coarser in zip(ladder, [*ladder[1:], None], strict=True):
        worst = max(cases[value], key=lambda row: (bool(row.trouble), row.added))
        where = f"in {worst.scene} at {power(worst.tolerance)}"
        most, promise = PROMISED.get(share, (math.inf, ""))
        if value > most:
            refusals[value] = promise
        elif worst.trouble:
            refusals[value] = f"{worst.trouble.split(':')[0]} {where}"
        elif worst.added > PART:
            refusals[value] = f"adds {worst.added:.2g} of the tolerance {where}"
        elif coarser is None:
            refusals[value] = "nothing coarser was tried"
        elif any(not row.added <= 1.0 for row in cases[coarser]):
            refusals[value] = f"{coarser:.3g} misses the tolerance"
        else:
            refusals[value] = ""
    return refusals


def _cost(rows: Sequence[Row], share: str, value: float) -> float:
    """Geometric mean over scenes and tolerances of the processor time over that with the finest value."""
    times = {(row.scene, row.tolerance, row.value): row.cpu_s for row in rows if row.share == share}
    finest = min(one for _, _, one in times)
    ratios = [time / times[scene, t, finest] for (scene, t, one), time in times.items() if one == value]
    return math.exp(math.fsum(map(math.log, ratios)) / len(ratios))


def _next(ladder: Sequence[float], value: float, refusals: Mapping[float, str], costs: Mapping[float, float]) -> str:
    """The next coarser value, and why it was not taken."""
    after = ladder.index(value) + 1
    if after == len(ladder):
        return ""
    coarser = ladder[after]
    return f"{coarser:.3g}: {refusals[coarser] or f'is no cheaper ({costs[coarser]:.3g} of the finest)'}"


def read_rows(path: Path = RECORD) -> list[Row]:
    """The rows of results/calibration.csv."""
    kinds: dict[str, Any] = {"scene": str, "share": str, "trouble": str, "steps": int}
    with path.open(encoding="utf-8", newline="") as file:
        return [Row(**{k: kinds.get(k, float)(v) for k, v in line.items()}) for line in csv.DictReader(file)]


def write_rows(rows: Sequence[Row], path: Path = RECORD) -> None:
    """Write them, with three digits of what was measured."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([one.name for one in fields(Row)])
        for row in rows:
            writer.writerow([f"{v:.3g}" if k in ("added", "error", "cpu_s") else v for k, v in asdict(row).items()])


def write_choice(rows: Sequence[Row]) -> Calibration:
    """Write workflow/model/calibration.json ; returns the chosen values."""
    document = chosen_values(rows)
    FILE.write_text(json.dumps(document, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    return calibration_of(document)
