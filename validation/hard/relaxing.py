"""Bodies that relax, pushed in and drawn out over time: `[viscoelasticity]` with the experiment `history`.

Peaks, curves and the end of contact of a triangle and a trapezoid are held against Lee, Radok and Ting, those of a
sawtooth, whose surface recovers and is touched again, against springs with events in their own time, creep against the
compliance, and random histories against all of them.

python -m validation.hard.relaxing SEED COUNT FOLDER      random histories: a summary, and FOLDER/found.json
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from validation.doors import Run
from validation.hard.kinks import Judged
from validation.hard.plane_bodies import Scene
from validation.hard.random_plane import Found, judge, main, outside, rows, run_of
from validation.hard.relaxing_draws import (
    JUMPING,
    Law,
    exact_of_creep,
    exact_of_path,
    history,
    in_units,
    plain,
    profile_of,
    scene_of,
)
from validation.references.creeping import Creeping
from validation.references.recovering import Prony, evenly, followed
from validation.references.relaxing import (
    Indentation,
    KelvinVoigt,
    Legs,
    Material,
    Power,
    Punch,
)
from validation.row import Row, at_least, at_most, worst
from validation.study import LONGEST, Bench, Findings, Refused, Study

NAME = "relaxing"
SEED, QUICK, FULL = 20261126, 20, 200
"""The date as the seed."""
RADIUS, DEPTH = 30.0, 1.0
"""a and d of the deepest contact [LU]; E* = 1 FU/LU²."""
PARTICLES, FINE = 31.7, 4.0
"""In a; how much finer the lattice is from which an order is had."""
ASKED = 1e-3
"""Tolerance of these scenes."""
ALONG = 5e-4
"""What a force may be off, over the peak: of a sphere with 29 particles in a 4e-4, of a power n (n + 1)/3 of that."""
FEWEST = 8.0
"""Particles in a from which on a displacement under a force is compared along the curve: its error goes with 1/a."""
PUNCHED = 1e-9
ORDER = 1.7
"""Of 2: where the edge is between two particles changes the errors of both lattices."""
STEPS = 400
"""Of a leg, with which an order in the spacing is not hidden by that in the steps."""
SPRINGS = 1000
"""Of the reference with events: 1e-7 of the peak."""
EXACT, LARGEST = 1e-7, 1e-6
"""Relative errors of quadratures, and of the largest of samples."""
MATERIALS = {
    "standard solid": Material(((0.5, 1.0),)),
    "Maxwell": Material(((1.0, 1.0),)),
    "three arms": Material(((0.3, 0.2), (0.3, 1.0), (0.2, 10.0))),
}
RETARDED = (0.1, 0.3)
"""Retardation times [TU]."""
TRIANGLE = Legs(((0.0, 0.0), (1.0, DEPTH), (2.0, 0.0)))
TRAPEZOID = Legs(((0.0, 0.0), (1.0, DEPTH), (2.0, DEPTH), (3.0, 0.0)))
SAWTOOTH = Legs(
    tuple(
        (t, DEPTH * d) for t, d in ((0.0, 0.0), (1.0, 1.0), (1.5, 0.0), (2.5, 0.9), (3.0, 0.3), (4.0, 0.3), (5.0, -1.0))
    )
)
TING, EVENTS, CREEP = "Lee, Radok and Ting", "springs with events in their own time", "the creep compliance"
Force = Callable[[float], float]


def bodies() -> dict[str, Power]:
    """Of one contact radius at one depth."""
    made = {"sphere": Power(2.0, 1.0), "cone": Power(1.0, 1.0), "power 3": Power(3.0, 1.0)}
    return {name: replace(one, factor=DEPTH / one.depth(RADIUS)) for name, one in made.items()}


def pairs(bench: Bench) -> list[tuple[str, Power, Material]]:
    """Every body on every material, or each once."""
    named = list(bodies().items())
    if bench.full:
        return [(f"{b}, {m}", body, one) for b, body in named for m, one in MATERIALS.items()]
    return [(f"{b}, {m}", body, one) for (b, body), (m, one) in zip(named, MATERIALS.items(), strict=True)]


def measure(bench: Bench) -> Findings:
    """Each kind of history, then random ones."""
    found = [*_single(bench), *_sawtooth(bench), *_creep(bench), *_punch(bench), *_retarded(bench), *_order(bench)]
    return Findings([*found, *rows(conducted(bench, SEED, FULL if bench.full else QUICK), SEED, TING)])


def scene(body: Power, law: Law, legs: Legs, spacing: float, by_force: bool = False, **more: float) -> Scene:
    """Of model units."""
    return plain(profile_of(body, RADIUS), spacing, ASKED) | history(law, legs, by_force, **more)


@dataclass
class Free:
    """Scenes with units and the program's own spacing: errors over the uncertainties."""

    words: str
    source: str

    def __post_init__(self) -> None:
        """None yet."""
        self.found = Found()

    def add(self, bench: Bench, label: str, one: Scene, exact: dict[str, float], slack: float = EXACT) -> None:
        """Run and take in one."""
        name = f"{self.words}_{label}_free"
        drawn = in_units("free", label, one, exact, slack, free=True)
        judge(self.found, name, drawn, run_of(bench, name, drawn.scene))

    def row(self) -> Row:
        """The worst; a number that is missing, or a refusal, fails."""
        each, lost = self.found.numbers, [*self.found.silent, *self.found.refused.values()]
        first = max(each, key=lambda n: n.over, default=None)
        words = f"{self.words}, automatic spacing: worst of {len(each)} errors over the uncertainty"
        value = math.nan if lost else worst([n.over for n in each])
        label = ", ".join(lost)[:LONGEST] or (f"{first.name}, {first.words}" if first else "–")
        return at_most(words, value, 1.0, self.source, label)


@dataclass
class Curves:
    """Columns of several curves beside their references."""

    words: str
    column: str = "force"
    bound: float = ALONG
    scaled: str = "its largest"

    def __post_init__(self) -> None:
        """None yet."""
        self.off: dict[str, float] = {}

    def add(self, label: str, run: Run | Refused, exact: Force, scale: float) -> None:
        """The largest error along one, over a scale."""
        self.off[label] = math.nan if isinstance(run, Refused) else max(errors(run, exact, scale, self.column))

    def row(self, source: str) -> Row:
        """The worst of them."""
        label = _worst_of(self.off)
        words = f"{self.words}: {self.column} along {len(self.off)} curves over {self.scaled}"
        return at_most(words, worst(list(self.off.values())), self.bound, source, label)


def errors(run: Run, exact: Force, scale: float, column: str = "force") -> list[float]:
    """|value − reference| over a scale at each point of a curve; of displacements those of contacts with FEWEST."""
    curve, least = run.curve, FEWEST * RADIUS / PARTICLES
    every = zip(curve["time"], curve[column], curve["contact_radius"], strict=True)
    return [abs(float(y) - exact(float(t))) / scale for t, y, a in every if column == "force" or a >= least]


def _worst_of(off: dict[str, float]) -> str:
    """The name of the largest, or of one that is missing."""
    return max(off, key=lambda name: math.inf if math.isnan(off[name]) else off[name])


def _peak(words: str, off: dict[str, float], source: str) -> Row:
    """Of the largest force."""
    label = _worst_of(off)
    return at_most(f"{words}: peak_force, relative", worst(list(off.values())), ALONG, source, label)


def _force_off(run: Run | Refused, exact: float) -> float:
    there = not isinstance(run, Refused) and "peak_force" in run.results
    return abs(run.results["peak_force"].value / exact - 1.0) if there and not isinstance(run, Refused) else math.nan


def _single(bench: Bench) -> list[Row]:
    """A triangle and a trapezoid; 30 particles in a, and as many as the program wants."""
    found: list[Row] = []
    for name, d in {"triangle": TRIANGLE, "trapezoid": TRAPEZOID}.items():
        curves, given, free = Curves(name), Judged(f"{name}, spacing given", TING), Free(name, TING)
        off: dict[str, float] = {}
        for words, body, material in pairs(bench):
            exact = Indentation(body, material, d)
            numbers = exact_of_path(body, material, d)[0]
            run = bench.run(f"{name}_{words}", scene(body, material, d, RADIUS / PARTICLES))
            curves.add(words, run, exact.force, exact.peak[1])
            given.add(words, run, numbers, EXACT)
            off[words] = _force_off(run, numbers["peak_force"])
            free.add(bench, words, scene(body, material, d, RADIUS / PARTICLES), numbers)
        found += [curves.row(TING), _peak(name, off, TING), *given.rows(), free.row()]
    return found


def _sawtooth(bench: Bench) -> list[Row]:
    """A surface that is touched again while it recovers."""
    curves, given, free = Curves("sawtooth"), Judged("sawtooth, spacing given", EVENTS), Free("sawtooth", EVENTS)
    off: dict[str, float] = {}
    for words, body, material in pairs(bench):
        numbers, least = exact_of_path(body, material, SAWTOOTH)
        run = bench.run(f"sawtooth_{words}", scene(body, material, SAWTOOTH, RADIUS / PARTICLES))
        if not isinstance(run, Refused):
            times = sorted({float(t) for t in run.curve["time"]})
            path = followed(Prony(material), body.depth, 1.0001 * RADIUS, SAWTOOTH, times, SPRINGS)
            known = dict(zip(times, path.force.tolist(), strict=True))
            curves.add(words, run, lambda t, known=known: known[t], numbers["peak_force"])  # type: ignore[misc]
        else:
            curves.off[words] = math.nan
        given.add(words, run, numbers, least)
        off[words] = _force_off(run, numbers["peak_force"])
        free.add(bench, words, scene(body, material, SAWTOOTH, RADIUS / PARTICLES), numbers, least)
    return [curves.row(EVENTS), _peak("sawtooth", off, EVENTS), *given.rows(), free.row()]


def _creep(bench: Bench) -> list[Row]:
    """A force that is applied and held; and taken away."""
    found: list[Row] = []
    for name, shares in {
        "force held": ((0.0, 0.0), (1.0, 1.0), (3.0, 1.0)),
        "force held and removed": ((0.0, 0.0), (1.0, 1.0), (2.0, 1.0), (3.0, 0.0)),
    }.items():
        curves, judged = Curves(name, "displacement"), Judged(name, CREEP)
        for words, body, material in pairs(bench):
            force = Legs(tuple((t, share * 0.5 * body.volume(RADIUS)) for t, share in shares))
            exact = Creeping(body, material, force)
            run = bench.run(f"{name}_{words}", scene(body, material, force, RADIUS / PARTICLES, by_force=True))
            curves.add(words, run, exact.displacement, exact.peak_displacement)
            judged.add(words, run, exact_of_creep(body, material, force), EXACT)
        found += [curves.row(CREEP), *judged.rows()]
    return found


def _punch(bench: Bench) -> list[Row]:
    """A flat punch is the functions of the material themselves."""
    forces, places = Curves("punch", "force", PUNCHED), Curves("punch, force given", "displacement")
    judged = Judged("punch, force given", "C(t)")
    held = Legs(((0.0, 0.0), (1.0, DEPTH), (2.0, DEPTH), (3.0, 0.5 * DEPTH)))
    profile, punch = {"kind": "flat_punch", "radius": RADIUS}, {m: Punch(RADIUS, one) for m, one in MATERIALS.items()}
    for name, one in punch.items():
        tables = plain(profile, 1.0, ASKED)
        run = bench.run(f"punch_{name}", tables | history(one.material, held))
        top = max(one.force(held, t) for t in evenly(held, 20))

        def force(t: float, one: Punch = one) -> float:
            return max(0.0, one.force(held, t))

        forces.add(name, run, force, top)
        creeps = bench.run(f"punch_creep_{name}", tables | history(one.material, held, by_force=True))

        def place(t: float, one: Punch = one) -> float:
            return one.displacement(held, t)

        top = max(place(t) for t in evenly(held, 400))
        places.add(name, creeps, place, top)
        judged.add(name, creeps, {"displacement": place(held.times[-1]), "peak_displacement": top}, LARGEST)
    return [forces.row("E(t)"), places.row("C(t)"), *judged.rows()]


def _retarded(bench: Bench) -> list[Row]:
    """Kelvin and Voigt, whose pressure jumps at the edge: a particle more or less is 2 E* A d′ s."""
    curves, judged = Curves("Kelvin and Voigt"), Judged("Kelvin and Voigt", "the closed form")
    curves.scaled, curves.bound = f"{ALONG:g} of its largest and one particle at the edge", 1.0
    for time in RETARDED:
        for name, body in bodies().items():
            law, words = KelvinVoigt(body, time), f"{name}, T = {time:g}"
            run = bench.run(f"retarded_{words}", scene(body, law, TRIANGLE, RADIUS / PARTICLES))

            def force(t: float, law: KelvinVoigt = law) -> float:
                return law.force(TRIANGLE(t), DEPTH if t <= 1.0 else -DEPTH)

            particle = 2.0 * time * DEPTH * RADIUS / PARTICLES
            curves.add(words, run, force, ALONG * force(1.0) + particle)
            judged.add(words, run, exact_of_path(body, law, TRIANGLE)[0], JUMPING)
    return [curves.row("the closed form"), *judged.rows()]


def _order(bench: Bench) -> list[Row]:
    """In the spacing, of a sphere."""
    found, body = [], bodies()["sphere"]
    for name, material in MATERIALS.items():
        exact, off = Indentation(body, material, TRIANGLE), []
        for finer in (1.0, FINE):
            one = scene(body, material, TRIANGLE, RADIUS / (PARTICLES * finer), steps=STEPS)
            run = bench.run(f"order_{name}_{finer:g}", one)
            each = [math.nan] if isinstance(run, Refused) else errors(run, exact.force, exact.peak[1])
            off.append(float(np.sqrt(np.mean(np.square(each)))))
        order = math.log(off[0] / off[1]) / math.log(FINE)
        found.append(at_least(f"sphere, {name}: order of the force in the spacing", order, ORDER, TING))
    return found


def conducted(bench: Bench, seed: int, count: int, tell: Callable[[str], None] = lambda _: None) -> Found:
    """`count` random histories of a seed; a last force or displacement is compared with the largest."""
    found, number, made = Found(), 0, 0
    while made < count:
        if (one := scene_of(seed, number)) is not None:
            name, before = f"relaxing_{seed}_{number}", len(found.numbers)
            judge(found, name, one, run_of(bench, name, one.scene))
            for i in range(before, len(found.numbers)):
                n = found.numbers[i]
                if peak := one.exact.get(f"peak_{n.name}"):
                    share = abs(n.reference) / peak
                    found.numbers[i] = replace(n, far=n.far * share, wide=n.wide * share)
            made += 1
            if made % 25 == 0:
                tell(f"{made} scenes, {len(found.numbers)} numbers, {len(outside(found))} outside")
        number += 1
    return found


RELAXING = Study(
    NAME,
    "Bodies that relax",
    "Histories of a displacement or a force, in which the contact grows, is held, shrinks, ends and begins anew while "
    "the surface recovers. Are forces, approaches, durations and losses those of Ting and of the creep compliance?",
    measure,
)


if __name__ == "__main__":
    main(conducted)
