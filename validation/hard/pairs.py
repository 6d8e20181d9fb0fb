"""Independent pairs beside their closed form: stiffness ratios, random sharp scenes, other units, loads near the core.

Pairs that feel their opposite only have every number exactly (`cases`), smooth, about to snap, or with snaps.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from validation.doors import Run
from validation.hard.cases import CAPACITY, CORE, PAIRS, TENSION, PairCase, reach, shaped
from validation.hard.judge import OF_ALL, REFUSED, Case, Judge, judged
from validation.hard.units import Scene, Units
from validation.row import Row, at_most
from validation.study import Bench, Findings, Refused, Study, claim_row

RATIOS = (0.3, 0.7, 0.9, 0.99, 1.01, 1.5, 3.0, 10.0, 100.0)
FULL_RATIOS = (0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 0.999, 1.001, 1.01, 1.1, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 30.0, 50.0,
               100.0)  # fmt: skip
DYNAMIC_RATIOS, FULL_DYNAMIC = (0.3, 0.9, 3.0), (0.3, 0.7, 0.9, 0.99, 1.01, 1.5, 3.0, 10.0, 30.0, 100.0)
"""In time a tension that passes one tooth is carried by the next that is higher: the highest counts there as well."""
TOLERANCES = (1e-2, 1e-3, 1e-4)
SHAPES = (("flat_punch", 3), ("flat_punch", 10), ("cone", 9), ("parabola", 21), ("power", 40), ("parabola", 200))
DYNAMIC_SHAPES, FULL_DYNAMIC_SHAPES = (SHAPES[0], SHAPES[3]), (SHAPES[1], SHAPES[3], SHAPES[4])
SHARP, FULL_SHARP, SEED = 20, 100, 3
KINDS = ("flat_punch", "parabola", "cone", "power")
TIMED, CALM = 0.3, 0.97
"""Share of the sharp scenes that are run in time, and the largest ratio there but for a path: behind a snap a plate
under a load lands where its momentum takes it."""
LENGTHS, ENERGIES = (1e-9, 1e-6, 1e-3, 1e3, 1e6), (1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9)
EQUAL = {False: 1e-5, True: 1e-2}
"""Relative: a hundredth of the tolerance of 1e-3, since the numbers of a scaled scene are rounded anew, and the
minimiser stops elsewhere within its own share of the tolerance; in time the tolerance of the bracket."""
PUNCH, SHARES, PAST = 10, (0.1, 0.5, 0.85), (1.02, 10.0)
"""Particles of the punch that is pressed, and loads over what its cores carry."""
PATIENCE, HANGING = 20, ("LAMMPS", "time limit", "nothing was said")
"""For a refusal [s], and words of one that came too late."""


def stiffnesses(full: bool) -> Iterator[Case]:
    """Every shape at every ratio in the long form, every second in the quick one; the tolerance goes round."""
    for i, ratio in enumerate(FULL_RATIOS if full else RATIOS):
        for j, shape in enumerate(SHAPES):
            wide = j == len(SHAPES) - 1
            if full or not ((i + j) % 2 or (wide and ratio > 1.0)):
                yield from _pull_off(shape, ratio, TOLERANCES[(i + 2 * j) % len(TOLERANCES)], dynamic=False)
    for i, ratio in enumerate(FULL_DYNAMIC if full else DYNAMIC_RATIOS):
        for j, shape in enumerate(FULL_DYNAMIC_SHAPES if full else DYNAMIC_SHAPES):
            tolerance = TOLERANCES[(i + 2 * j) % len(TOLERANCES) if full else 0]
            yield from _pull_off(shape, ratio, tolerance, dynamic=True)


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
        kind, timed = str(rng.choice(["load", "pull_off", "path"])), bool(rng.random() < TIMED)
        highest = CALM if timed and kind != "path" else 3.0
        ratio = float(np.exp(rng.uniform(math.log(0.3), math.log(highest))))
        particles, shape = int(rng.integers(3, 13)), str(rng.choice(KINDS))
        profile = shaped(shape, particles, reach(ratio) * float(rng.uniform(1.0, 2.0)))
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
        load = -float(rng.uniform(0.1, 0.95)) * pairs.adhesion(0.0)[0]
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


def similar(full: bool) -> Iterator[Case]:
    """Lengths × s and energies × e are the same physics; masses are as they are."""
    for dynamic in EQUAL:
        base = PairCase("base", 0.5, shaped("parabola", 21, reach(0.5)), 21, TENSION, 1e-3, dynamic)
        exact = {"adhesion_force": base.pairs.adhesion(base.preload)[0]}
        for what, factors in (("lengths", LENGTHS), ("energies", ENERGIES)):
            for factor in factors if full or not dynamic else factors[::2]:
                s, e = (factor, 1.0) if what == "lengths" else (1.0, factor)
                words = f"{what} × {factor:g}, {base.method}"
                case = replace(base, name=f"{base.method}_{what}_{factor:g}")
                yield case.judged(words, words, exact, Units(s, e / s**3, scaled=True))


def measure_stiffness(bench: Bench) -> Findings:
    """Rows of F_A, ratio by ratio; of the refusals of all."""
    source, every = f"{PAIRS}, by bisection and Newton's method", judged(bench, stiffnesses(bench.full))
    rows = [row for words, judge in every.items() for row in judge.rows(words, source)[:-1]]
    refused = sum(len(judge.refused) for judge in every.values())
    count = sum(judge.scenes.total() for judge in every.values())
    words = f"share refused of {count} cases that have a stable way below {CAPACITY} of the core's force"
    return Findings([*rows, at_most(words, refused / count, REFUSED, "what is asked: 95 % must run")])


def measure_sharp(bench: Bench) -> Findings:
    """Rows of all random scenes."""
    judge = Judge(OF_ALL)
    for case in sharp(FULL_SHARP if bench.full else SHARP):
        judge.add(case, case.run(bench))
    return Findings(judge.rows("random sharp scenes", PAIRS, REFUSED))


def measure_similarity(bench: Bench) -> Findings:
    """F_A·s/e of each scaled scene."""
    rows = []
    for words, judge in judged(bench, similar(bench.full)).items():
        rows.append(judge.near(words, "adhesion_force", EQUAL["dynamic" in words], f"{PAIRS}, not scaled"))
    return Findings(rows)


def measure_core(bench: Bench) -> Findings:
    """d under shares of what N cores carry over its claim; loads past that are refused in words of this program."""
    rows: list[Row] = []
    for dynamic in (False, True):
        case = PairCase("core", 0.5, shaped("flat_punch", PUNCH, 0.0), PUNCH, dynamic=dynamic)

        def pressed(share: float, bench: Bench, case: PairCase = case) -> Run | Refused:
            experiment = {"kind": "load", "force": share * PUNCH * CORE, "method": case.method}
            return bench.run(f"{case.method}_{share:g}", case.scene() | {"experiment": experiment})

        for share in SHARES:
            words = f"d off over its claim at {share:g} of the core's force, {case.method}"
            exact = case.pairs.deepest(share * PUNCH * CORE)
            rows.append(claim_row(words, pressed(share, bench), "displacement", exact, PAIRS))
        ends = [pressed(share, replace(bench, patience=PATIENCE)) for share in PAST]
        bad = sum(not isinstance(end, Refused) or any(word in end.words for word in HANGING) for end in ends)
        words = f"loads of {PAST} core forces that are held, hang, or end in words of LAMMPS, {case.method}"
        rows.append(at_most(words, bad, 0.0, "the core carries no more"))
    return Findings(rows)


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
    Study(
        "similarity",
        "Similarity: lengths × 1e-9 … 1e6, energies × 1e-9 … 1e9",
        "An absolute threshold in a program gives different reduced results for metres and nanometres. Are the "
        "reduced results of scaled scenes the same?",
        measure_similarity,
    ),
    Study(
        "core",
        "Compression up to the largest repulsion of the pairs and beyond",
        "The repulsion of a pair is finite at distance 0: under a larger load one body passes through the other. Are "
        "displacements below it within their uncertainties, and larger loads refused?",
        measure_core,
    ),
)
