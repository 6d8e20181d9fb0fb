"""Slides that are hard to get right: back, at rest, too fast, without slips, with many at once, unloaded, off the end.

Each trace and mean is held against an integrator in numpy, one particle on a row against its corrugation as well.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from validation.doors import Run, law_table, read_scene, settings_for
from validation.references.prandtl_tomlinson import corrugation
from validation.references.slide import Trace
from validation.row import Row, at_most, so
from validation.slides import integrated, mean_friction
from validation.study import Bench, Findings, Refused, Study, over_claim, said
from validation.study import found as result

TRACE = 1e-3
"""Of the peak: the tolerance of the scenes; further legs have the inertia of the first one's drag."""
CLOSED = 5e-3
"""Work that is neither dissipated nor stored, over the largest of the three."""
STATIC = 5e-3
"""Of the largest force of the corrugation: the plate moves on while it slips."""
LAW = (1.0, 0.5, 0.5, 1.0)
"""A [FU·LU], a [LU], B [FU·LU], b [LU]."""
LOAD = 0.2
"""Of a particle on a row [FU]."""
SOURCE = "an integrator in numpy"
DRIVE = 0.02
"""[LU/TU]"""


def curved(**tables: Any) -> dict[str, Any]:
    """A sticky curved body on a longer flat one; keys of tables are added to those here."""
    return _with(
        {
            "bodies": {
                "particles": 48, "upper_particles": 20, "upper_offset": 0.5, "spacing": 1.0, "mass": 1.0,
                "bulk_stiffness": 3.0, "profile": {"kind": "parabola", "radius": 8.0},
            },
            "damping": {"coefficient": 0.2},
            "plate": {"free": ["x", "z"], "mass": 20.0, "damping": 2.0},
            "cantilever": {"stiffness": 0.4, "velocity": DRIVE},
            "experiment": {"kind": "slide", "normal_force": 1.0, "distance": 5.0},
        },
        tables,
    )  # fmt: skip


def flat(below: int, above: int, **tables: Any) -> dict[str, Any]:
    """A row of so many particles on a rigid one that goes on for ever."""
    return _with(
        {
            "bodies": {
                "particles": below, "upper_particles": above, "upper_spacing": below / above, "spacing": 1.0,
                "mass": 1.0, "bulk_stiffness": 1.0, "lower": "rigid_chain", "periodic": True,
                "profile": {"kind": "flat"},
            },
            "damping": {"coefficient": 0.3},
            "plate": {"free": ["x", "z"], "mass": float(above), "damping": 0.0},
            "cantilever": {"stiffness": 0.05 * above, "velocity": 0.01},
            "experiment": {"kind": "slide", "normal_force": LOAD * above, "distance": 4.0},
        },
        tables,
    )  # fmt: skip


def _with(base: dict[str, dict[str, Any]], tables: dict[str, Any]) -> dict[str, Any]:
    own = base | {"interaction": law_table(*LAW), "horizontal": {}, "accuracy": {"tolerance": 1e-3}}
    found = {name: own.get(name, {}) | tables.get(name, {}) for name in {**own, **tables}}
    if "path" in found["experiment"]:
        del found["experiment"]["distance"]
    return found


CASES: dict[str, dict[str, Any]] = {
    "drive reversed": curved(experiment={"path": [[DRIVE, 3.0], [-DRIVE, 6.0]]}),
    "drive at rest": curved(experiment={"path": [[DRIVE, 2.0], [0.0, 1.0]]}),
    "faster than the particles follow": curved(
        bodies={"particles": 64}, cantilever={"velocity": 0.5, "stiffness": 4.0}, experiment={"distance": 12.0}
    ),
    "cantilever stiffer than the contact": curved(cantilever={"stiffness": 20.0}),
    "no load": curved(experiment={"normal_force": 0.0}),
    "a pull": curved(experiment={"normal_force": -0.3}),
    "one particle": flat(32, 1),
    "particles that slip one by one": flat(
        13, 8, bodies={"bulk_stiffness_tangential": 0.03}, cantilever={"stiffness": 8.0}, accuracy={"tolerance": 1e-4}
    ),
}  # fmt: skip
BACK, REST = "drive reversed", "drive at rest"
Wrong = Callable[[Run], bool]


def _slips(run: Run) -> float:
    return result(run, "slips").value


def _backwards(run: Run) -> bool:
    friction = run.friction["friction"]
    half = friction.size // 3
    return not friction[half // 2 : half].mean() > 0.0 > friction[2 * half :].mean()


def _gives_work(run: Run) -> bool:
    return not float(np.trapezoid(run.friction["cantilever_force"], run.friction["drive"])) > 0.0


def _slippery(run: Run) -> bool:
    return not result(run, "mean_friction").value > 0.0


WRONG: dict[str, dict[str, Wrong]] = {
    BACK: {
        "friction of the wrong sign there or back": _backwards,
        "loop of the cantilever that gives work": _gives_work,
    },
    REST: {"a mean friction of a drive at rest that is not that of the leg before": lambda run: _slips(run) < 0.0},
    "faster than the particles follow": {
        "a drive past 2π v/s = √(k/m) that is not warned about": lambda run: "fast" not in run.warnings
    },
    "cantilever stiffer than the contact": {"slips of a plate that follows its drive": lambda run: _slips(run) > 0.0},
    "no load": {"no friction where adhesion holds, no load": _slippery},
    "a pull": {"no friction where adhesion holds, a pull": _slippery},
    "particles that slip one by one": {
        "slips of the plate where its particles slip in turn": lambda run: _slips(run) > 0.0
    },
}
"""What a case is there for, and must not be."""


def measure(bench: Bench) -> Findings:
    """Three rows of each slide, what is special of each, and two that end nowhere."""
    rows: list[Row] = []
    for name, tables in CASES.items():
        scene = read_scene({"title": name} | tables)
        run = bench.run(name.replace(" ", "_"), tables)
        if isinstance(run, Refused):
            rows.append(at_most(f"trace, {name}", math.nan, 0.0, SOURCE, said("–", run)))
            continue
        rows += _rows(name, run, integrated(scene, settings_for(scene)))
        rows += [so(words, wrong(run)) for words, wrong in WRONG.get(name, {}).items()]
    return Findings([*rows, *_ends(bench)])


def _rows(name: str, run: Run, trace: Trace) -> Iterator[Row]:
    peak = float(np.abs(trace.friction).max())
    off = float(np.abs(run.friction["friction"] - trace.friction).max()) / peak
    yield at_most(f"trace off over the peak, {name}", off, TRACE, SOURCE, "table of the law", "independent solver")
    work, lost, stored = (result(run, key).value for key in ("cantilever_work", "dissipated_energy", "stored_energy"))
    gone = abs(work - lost - stored) / max(map(abs, (work, lost, stored)))
    yield at_most(f"energy that is lost over the largest, {name}", gone, CLOSED, "the first law", "samples of the drag")
    if name == REST:
        sums = (abs(one["friction"][-1] - one["cantilever_force"][-1]) / float(np.abs(one["friction"]).max())
                for one in (run.friction, vars(trace)))  # fmt: skip
        balance, own = sums
        yield at_most("force left at rest over the peak, beside the integrator's", balance, own + TRACE, SOURCE)
    elif name != BACK:
        assert run.scene.cantilever is not None
        over = over_claim(run, "mean_friction", mean_friction(trace, 1.0 / run.scene.cantilever.velocity))
        yield at_most(f"mean friction off over its claim, {name}", over, 1.0, SOURCE, "run-in", "independent solver")
    if name == "one particle":
        exact = corrugation(LAW, 1.0, LOAD).largest_force
        off = abs(result(run, "static_friction").value / exact - 1.0)
        yield at_most("static friction of one particle off", off, STATIC, "max of U′ of its corrugation", "slip")


def _ends(bench: Bench) -> Iterator[Row]:
    """A chain that is too short for the way, and a plate that is thrown off a chain that is long enough for it."""
    short = bench.run("too_short", curved(bodies={"particles": 26}))
    refused = isinstance(short, Refused) and short.before and "too short for the sliding distance" in short.words
    yield so("a way off the end that is not refused beforehand", not refused)
    bodies = {"particles": 68, "upper_particles": 36, "bulk_stiffness": 2.0}
    thrown = bench.run(
        "thrown_off",
        curved(
            bodies=bodies | {"profile": {"kind": "parabola", "radius": 30.0}},
            damping={"coefficient": 0.01},
            plate={"damping": 0.0, "mass": 36.0},
            cantilever={"stiffness": 0.05, "velocity": 0.05},
            experiment={"distance": 14.0},
            accuracy={"tolerance": 1e-2},
        ),
    )
    told = isinstance(thrown, Refused) and not thrown.before and "slid off the lower body" in thrown.words
    yield so("a plate thrown off the end that is not told", not told)
    left = all((bench.folder / "thrown_off" / name).is_file() for name in ("friction.csv", "curve.csv", "results.json"))
    yield so("a trace that is not left of it", not left)


SLIDES = Study(
    "slides",
    "Slides with a drive that reverses, stops or is too fast, without slips, without a load, with particles that slip"
    " singly, off the end",
    "A drive that reverses or stops, several slips in one load step, an integrator that lags by half a step, or a "
    "plate that leaves its chain gives a smooth trace and a wrong friction. Are traces and mean friction those of an "
    "independent integrator?",
    measure,
)
