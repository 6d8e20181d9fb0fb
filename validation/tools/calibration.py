"""The cost study behind `[accuracy] tolerance`: what each setting may use up of it, in many scenes.

    python -m validation.tools.calibration             # twenty minutes: all runs, then the same as with --choose
    python -m validation.tools.calibration --choose    # a minute: the choice from kept runs

The runs are kept in validation/results/calibration.csv, the choice in workflow/model/calibration.json.

Every scene runs at every tolerance with one share after the other at each value of its LADDER, all others as they are.
A value is good where it adds no more than PART of the tolerance to the error of any main result, and brings no warning
and no failure, against the finest value. Chosen is the cheapest of the values that are good in every scene at every
tolerance and whose next coarser value still keeps the tolerance itself; of values that cost the same the finest one.
A result that the run itself says to be known less well than the tolerance is not looked at. In a pull-off in time it
is the schedule that decides how well the critical radius is known, now more and now less: there that is no trouble.
"""

import json
import math
import os
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import repeat
from pathlib import Path
from statistics import geometric_mean
from typing import Any

import pandas as pd

from contact1d.workflow.continuation.outcome import LATTICE, MODEL, Result, unmet
from contact1d.workflow.engine.progress import choose_progress
from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.model.calibration import CALIBRATION, FILE, Calibration, calibration_of, meanings
from contact1d.workflow.model.settings import Settings, settings_for
from contact1d.workflow.runs.accuracy import main_results
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.runs.processors import pool
from contact1d.workflow.scene import Scene, read_scene
from validation.row import tables_beside

ROOT = Path(__file__).parents[2]
RECORD = ROOT / "validation" / "results" / "calibration.csv"
TARGETS = (1e-2, 1e-3, 1e-4, 1e-5)
"""The tolerances."""
PART = 0.1
"""Of the tolerance, that one share may add to the error of a main result."""
SAME_COST = 0.03
"""Costs that differ by less are the same: tens of times on a machine that does other things too."""
PROMISED = {"residual": (1e-3, "on a rigid plane forces are promised to 1e-6, tests/validation/test_hertz_plane.py")}
"""Largest value of a share that something other than the tolerance allows, and what."""
TOGETHER = "together"
"""In place of a share's name, of runs with all shares as chosen."""
WORKERS = 2
"""Runs at a time; none is repeated, since a cost is the mean over all scenes and tolerances."""
REFERENCES = (1e-7, 1e-6, 1e-5)
"""Tolerances of a reference, of which the first is taken that works."""
LADDERS, SCENES = tables_beside(__file__).values()


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


@dataclass(frozen=True)
class Found:
    """What a run gave.

    Attributes:
        results: by name; none of a run that failed.
        cpu_s, steps: processor time in LAMMPS [s]; minimiser iterations or timesteps.
        warnings: by name, of the experiment.
        failure: why it failed, else "".
    """

    results: Mapping[str, Result] = field(default_factory=dict)
    cpu_s: float = math.nan
    steps: int = 0
    warnings: frozenset[str] = frozenset()
    failure: str = ""

    def open_results(self, tolerance: float) -> set[str]:
        """The results that the settings leave more uncertain than the tolerance."""
        return {*unmet(self.results, tolerance, (LATTICE, "input", MODEL))}


def found(scene: Scene, settings: Settings, folder: Path) -> Found:
    """Run a scene with these settings, in a folder of this process in `folder`."""
    try:
        done = run(scene, folder / str(os.getpid()), figures=False, settings=settings, workers=1)
    except Contact1dError as error:
        return Found(failure=getattr(error, "message", str(error)))
    assert done.outcome is not None
    results, warnings = done.outcome.results, frozenset(done.outcome.warnings)
    return Found(results, done.timing["lammps_cpu_s"], int(done.timing["steps"]), warnings)


def at_tolerance(scene: Scene, tolerance: float) -> Scene:
    """The scene with another tolerance, and as long as that needs."""
    return scene.with_({"accuracy.tolerance": tolerance, "bodies.particles": "auto"})


def reference_of(scene: Scene, folder: Path) -> dict[str, Result]:
    """The main results of the scene without time, at the smallest of REFERENCES that works."""
    timed = [name for name in ("damping", "plate") if name in scene.effects]
    still = scene.with_({"experiment.method": "quasistatic"}, without=timed)
    finer = (at_tolerance(still, tolerance) for tolerance in REFERENCES)
    return next(main for one in finer if (main := main_results(one, found(one, settings_for(one), folder).results)))


def studied(name: str, shares: Mapping[str, Sequence[Calibration]]) -> list[Row]:
    """Run a scene of SCENES at every tolerance of TARGETS with these shares; the first of each list is the finest."""
    given = SCENES[name]
    file = ROOT / "lammps_inputs" / "scenes" / f"{given['file']}.toml"
    scene = read_scene(file, given.get("keys", ()), given.get("without", ()))
    rows = list[Row]()
    in_time = scene.method == "dynamic" and scene.experiment.kind == "pull_off"
    with tempfile.TemporaryDirectory() as place:
        reference = reference_of(scene, Path(place))
        for tolerance in TARGETS:
            asked = at_tolerance(scene, tolerance)
            chosen = {
                (share, one): settings_for(asked, calibration=one) for share, many in shares.items() for one in many
            }
            same = {key: _effective(asked, settings) for key, settings in chosen.items()}
            ready = {same[key]: settings for key, settings in chosen.items()}
            progress = choose_progress()
            progress.phase(f"{name}, tolerance {power(tolerance)}: {len(ready)} runs")
            with pool(WORKERS) as executor:
                runs = executor.map(found, repeat(asked), ready.values(), repeat(Path(place)))
                done = dict(zip(ready, runs, strict=True))
            progress.close()
            for share, many in shares.items():
                if len({same[share, one] for one in many}) > 1 or share == TOGETHER:
                    mine = [done[same[share, one]] for one in many]
                    values = [getattr(one, share, math.nan) for one in many]
                    rows += _rows((name, tolerance, share), values, mine, reference, claims=not in_time)
    return rows


def power(value: float) -> str:
    """`1e-3`."""
    return f"{value:.0e}".replace("e-0", "e-")


def _effective(scene: Scene, settings: Settings) -> str:
    """What a run of the scene depends on among the settings that shares choose: runs that agree in it are one."""
    timed = scene.method == "dynamic"
    step = settings.increments.smooth_step if settings.is_smooth else settings.increments.displacement_step
    points = settings.forces.table.points if settings.forces.table is not None else 0
    pace = settings.motion.time_step if timed else settings.forces.residual
    searched = not timed and scene.experiment.kind != "path"
    return f"{settings.chains.upper} {settings.forces.cutoff!r} {points} {pace!r} {step if searched else 0.0!r}"


def _rows(
    key: tuple[str, float, str],
    values: Sequence[float],
    runs: Sequence[Found],
    reference: Mapping[str, Result],
    claims: bool,
) -> Iterator[Row]:
    tolerance, finest = key[1], runs[0]
    if finest.failure:
        return
    for value, one in zip(values, runs, strict=True):
        if trouble := one.failure or next((f"no {name}" for name in reference if name not in one.results), ""):
            yield Row(*key, value, math.nan, math.nan, math.nan, 0, " ".join(trouble.split()))
            continue
        left = finest.open_results(tolerance)
        known = {name: best.value for name, best in reference.items() if name not in left}
        mine, base = (
            {name: abs(it.results[name].value / best - 1.0) / tolerance for name, best in known.items()}
            for it in (one, finest)
        )
        added = max((mine[name] - base[name] for name in known), default=0.0)
        error, open_ = max(mine.values(), default=0.0), one.open_results(tolerance) - left if claims else ()
        warned = sorted([*(one.warnings - finest.warnings), *(f"tolerance {name}" for name in open_)])
        yield Row(*key, value, max(added, 0.0), error, one.cpu_s, one.steps, ", ".join(warned))


def chosen_values(rows: Sequence[Row]) -> dict[str, Any]:
    """The contents of `calibration.json`: of each setting what it is, its value, and what that was chosen by."""
    values = {}
    for share, meaning in meanings().items():
        ladder = sorted({row.value for row in rows if row.share == share})
        cases = {value: [row for row in rows if (row.share, row.value) == (share, value)] for value in ladder}
        refusals = {
            value: _refusal(share, value, cases[value], coarser, cases.get(coarser))
            for value, coarser in zip(ladder, [*ladder[1:], math.inf], strict=True)
        }
        costs = {value: _cost(cases[value], cases[ladder[0]]) for value in ladder if not refusals[value]}
        value = next(one for one in costs if costs[one] <= (1.0 + SAME_COST) * min(costs.values()))
        worst = max(cases[value], key=lambda row: row.added)
        values[share] = {
            "is": meaning,
            "value": value,
            "adds": float(f"{worst.added:.2g}"),
            "most_in": f"{worst.scene} at {power(worst.tolerance)}",
            "cpu_over_finest": float(f"{costs[value]:.3g}"),
            "next": "".join(
                f"{one:.3g}: {refusals[one] or f'is no cheaper ({costs[one]:.3g} of the finest)'}"
                for one in ladder[ladder.index(value) + 1 :][:1]
            ),
        }
    return {
        "made_by": "python -m validation.tools.calibration",
        "record": "validation/results/calibration.csv",
        "tolerances": list(TARGETS),
        "adds_at_most": PART,
        "values": values,
    }


def _refusal(share: str, value: float, cases: Sequence[Row], coarser: float, beyond: Sequence[Row] | None) -> str:
    """Why a value is not taken, by its worst case, or by those of the next coarser value; "" where it could be."""
    worst = max(cases, key=lambda row: (bool(row.trouble), row.added))
    where = f"in {worst.scene} at {power(worst.tolerance)}"
    most, promise = PROMISED.get(share, (math.inf, ""))
    if value > most:
        return promise
    if worst.trouble:
        return f"{worst.trouble.split(':')[0]} {where}"
    if worst.added > PART:
        return f"adds {worst.added:.2g} of the tolerance {where}"
    if beyond is None:
        return "nothing coarser was tried"
    return "" if all(row.added <= 1.0 for row in beyond) else f"{coarser:.3g} misses the tolerance"


def _cost(cases: Sequence[Row], finest: Sequence[Row]) -> float:
    """Geometric mean over scenes and tolerances of the processor time over that with the finest value."""
    base = {(row.scene, row.tolerance): row.cpu_s for row in finest}
    return geometric_mean(row.cpu_s / base[row.scene, row.tolerance] for row in cases)


def read_rows() -> list[Row]:
    """The rows of results/calibration.csv."""
    table = pd.read_csv(RECORD, float_precision="round_trip").fillna({"trouble": ""})
    return [Row(**line) for line in table.to_dict("records")]


def write_rows(rows: Sequence[Row]) -> None:
    """Write them, with three digits of what was measured."""
    table = pd.DataFrame(rows)
    measured = ["added", "error", "cpu_s"]
    table[measured] = table[measured].map("{:.3g}".format)
    table.to_csv(RECORD, index=False, na_rep="nan", lineterminator="\n")


def main(arguments: Sequence[str]) -> None:
    """The command."""
    if "--choose" not in arguments:
        ladders = {share: [replace(CALIBRATION, **{share: one}) for one in many] for share, many in LADDERS.items()}
        write_rows([row for name in SCENES for row in studied(name, ladders)])
    rows = [row for row in read_rows() if row.share != TOGETHER]
    document = chosen_values(rows)
    FILE.write_text(json.dumps(document, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    chosen = {TOGETHER: [calibration_of(document)]}
    write_rows([*rows, *(row for name in SCENES for row in studied(name, chosen))])


if __name__ == "__main__":
    main(sys.argv[1:])
