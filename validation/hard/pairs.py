"""Independent pairs beside their closed form: stiffness ratios, random sharp scenes.

Pairs that feel their opposite only have every number exactly (`cases`), smooth, about to snap, or with snaps.
"""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from validation.hard.cases import CAPACITY, PAIRS, TENSION, PairCase, reach, shaped
from validation.hard.judge import OF_ALL, REFUSED, Case, Judge, judged
from validation.hard.units import Scene
from validation.row import at_most, tables_beside
from validation.study import Bench, Lines, Study

TOLERANCES = (1e-2, 1e-3, 1e-4)
SHAPES = (("flat_punch", 3), ("flat_punch", 10), ("cone", 9), ("parabola", 21), ("power", 40), ("parabola", 200))
SHARP, FULL_SHARP, SEED = 20, 100, 3
KINDS = ("flat_punch", "parabola", "cone", "power")
TIMED, CALM = 0.3, 0.97
"""Share of the sharp scenes that are run in time, and the largest ratio there but for a path: behind a snap a plate
under a load lands where its momentum takes it."""


def stiffnesses(full: bool) -> Iterator[Case]:
    """Every shape at every ratio in the long form, every second in the quick one; the tolerance goes round."""
    table = tables_beside(__file__)["full" if full else "short"]
    for i, ratio in enumerate(table["ratios"]):
        for j, shape in enumerate(SHAPES):
            wide = j == len(SHAPES) - 1
            if full or not ((i + j) % 2 or (wide and ratio > 1.0)):
                yield from _pull_off(shape, ratio, TOLERANCES[(i + 2 * j) % len(TOLERANCES)], dynamic=False)
    for i, ratio in enumerate(table["dynamic_ratios"]):
        for j, shape in enumerate(table["dynamic_shapes"]):
            yield from _pull_off(shape, ratio, TOLERANCES[(i + 2 * j) % len(TOLERANCES) if full else 0], dynamic=True)


def _pull_off(shape: tuple[str, int], ratio: float, tolerance: float, dynamic: bool) -> Iterator[Case]:
    """A pull-off that has a stable way below a share of the core's force."""
    kind, particles = shape
    words = f"{kind} of {particles}, {tolerance:g}"
    case = PairCase(f"{kind}_of_{particles}_{ratio:g}_{tolerance:g}{'_dynamic' * dynamic}", ratio,
                    shaped(kind, particles, reach(ratio)), particles, 1.5 * TENSION, tolerance, dynamic)  # fmt: skip
    if case.solvable():
        exact = {"adhesion_force": case.pairs.adhesion(case.preload)[0]}
        yield case.judged(f"F_A, ratio {ratio:g}, {case.method}", words, exact)


def sharp(wanted: int) -> Iterator[Case]:
    """Few particles, ratio 0.3 to 3, all of load, pull_off and path, at rest and in time."""
    rng, number = np.random.default_rng(SEED), 0
    while number < wanted:
        kind, timed = str(rng.choice(["load", "pull_off", "path"])), rng.random() < TIMED
        highest = CALM if timed and kind != "path" else 3.0
        ratio = float(np.exp(rng.uniform(math.log(0.3), math.log(highest))))
        particles, shape = int(rng.integers(3, 13)), str(rng.choice(KINDS))
        profile = shaped(shape, particles, reach(ratio) * rng.uniform(1.0, 2.0))
        preload = TENSION * float(10.0 ** rng.uniform(-1.0, 1.0))
        tolerance = float(10.0 ** rng.uniform(-4.0, -2.0))
        case = PairCase(f"sharp_{number}", ratio, profile, particles, preload, tolerance, timed and kind != "path")
        made = _sharp(rng, case, kind, timed)
        if made is not None:
            number += 1
            yield made


def _sharp(rng: np.random.Generator, case: PairCase, kind: str, timed: bool) -> Case | None:
    """The case with its experiment and numbers; None where there is no state, or its contact leaves the chain.

    A flat punch ends on its chain wherever it ends.
    """
    pairs, load, method = case.pairs, case.preload, "dynamic" if timed else "quasistatic"
    if kind == "load" and rng.random() < 0.5:
        load = -rng.uniform(0.1, 0.95) * pairs.adhesion(0.0)[0]
    if not case.solvable():
        return None
    deepest, lowest = pairs.deepest(case.preload), -(reach(case.ratio) + float(np.ptp(pairs.heights)))
    way = {"from": lowest, "to": deepest, "steps": int(rng.integers(20, 80)) if kind == "path" else 1}
    if case.profile["kind"] != "flat_punch" and not case.radii(inside=0.5, deepest=deepest):
        return None
    group, words = f"{kind} {'in time' if timed else 'at rest'}", f"ratio {case.ratio:.3g}"
    if kind == "pull_off":
        return case.judged(group, words, case.pulled())
    keys = {"force": load} if kind == "load" else {"displacements": way}
    tables: Scene = {"experiment": {"kind": kind, "method": method} | keys}
    if kind == "path" and timed:
        tables |= {"damping": {"coefficient": "auto"}}
    exact = case.loaded(load) if kind == "load" else case.passed(deepest)
    return replace(case, more=tables).judged(group, words, exact)


def measure_stiffness(bench: Bench) -> Lines:
    """Rows of F_A, ratio by ratio; of the refusals of all."""
    source, every = f"{PAIRS}, by bisection and Newton's method", judged(bench, stiffnesses(bench.full))
    for words, judge in every.items():
        yield from judge.rows(words, source)[:-1]
    refused = sum(len(judge.refused) for judge in every.values())
    count = sum(judge.scenes.total() for judge in every.values())
    words = f"share refused of {count} cases that have a stable way below {CAPACITY} of the core's force"
    yield at_most(words, refused / count, REFUSED, "what is asked: 95 % must run")


def measure_sharp(bench: Bench) -> Lines:
    """Rows of all random scenes."""
    judge = Judge(OF_ALL)
    for case in sharp(FULL_SHARP if bench.full else SHARP):
        judge.add(case, case.run(bench))
    return judge.rows("random sharp scenes", PAIRS, REFUSED)


CLASSES = (
    Study(
        "stiffness",
        "Stiffness ratio 0.3 to 100",
        "The stiffness ratio is the largest negative stiffness of a pair's attraction over the stiffness of its two "
        "springs in series. Below 1 no pair snaps, and close to 1 the force has a kink that a coarse path misses; "
        "above 1 the force has many maxima, of which the highest is F_A. Sharp and blunt bodies, 3 to 200 particles, "
        "tolerances 1e-2 to 1e-4, quasi-static and in time.",
        measure_stiffness,
    ),
    Study(
        "sharp",
        "Random scenes of 3 to 12 particles per body",
        "With few particles and pairs about to snap a search may find a force maximum that is not the highest. Is "
        "every result of a hundred random scenes within its uncertainty?",
        measure_sharp,
    ),
)
