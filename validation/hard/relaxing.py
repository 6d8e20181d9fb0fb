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
from validation.hard.random_plane import Found, judge, main, outside, rows
from validation.hard.relaxing_draws import exact_of_creep, exact_of_path, plain, profile_of, scene_of, terms_of
from validation.references.recovering import Prony, evenly, followed
from validation.references.relaxing import (
    Creeping,
    Indentation,
    KelvinVoigt,
    Legs,
    Material,
    Power,
    Punch,
)
from validation.row import Row, at_least, at_most, worst
from validation.study import Bench, Findings, Refused, Study

NAME = "relaxing"
SEED, QUICK, FULL = 20261126, 20, 200
"""The date as the seed."""
RADIUS, DEPTH = 30.0, 1.0
"""a and d of the deepest contact [LU]; E* = 1 FU/LU²."""
PARTICLES, FINE = 29.3, 4.0
"""In a; how much finer the lattice is from which an order is had."""
ALONG = 5e-4
"""What a force may be off, over the peak, with 30 particles in a (guide: 4e-4 with 29)."""
PUNCHED = 1e-9
ORDER = 1.7
"""Of 2: where the edge is between two particles changes the errors of both lattices."""
STEPS = 400
"""Of a leg, with which an order in the spacing is not hidden by that in the steps."""
SPRINGS = 1000
"""Of the reference with events: 1e-7 of the peak."""
WORK = 1e-4
"""Relative error of its ∫F dd, of samples."""
EXACT = 1e-7
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


def scene(body: Power, material: Material, d: Legs, spacing: float, by_force: bool = False, **more: float) -> Scene:
    """Of model units."""
    history = {"kind": "history", "force" if by_force else "displacement": [list(point) for point in d.points]}
    return plain(profile_of(body, RADIUS), spacing, 1e-3) | {"viscoelasticity": terms_of(material),
                                                            "experiment": history | more}  # fmt: skip


@dataclass
class Curves:
    """Columns of several curves beside their references."""

    words: str
    column: str = "force"
    bound: float = ALONG

    def __post_init__(self) -> None:
        """None yet."""
        self.off: dict[str, float] = {}

    def add(self, label: str, run: Run | Refused, exact: Force, scale: float) -> None:
        """The largest error along one, over a scale."""
        self.off[label] = math.nan if isinstance(run, Refused) else max(errors(run, exact, scale, self.column))

    def row(self, source: str) -> Row:
        """The worst of them."""
        label = max(self.off, key=lambda name: self.off[name])
        words = f"{self.words}: {self.column} along {len(self.off)} curves over its largest"
        return at_most(words, worst(list(self.off.values())), self.bound, source, label)


def errors(run: Run, exact: Force, scale: float, column: str = "force") -> list[float]:
    """|value − reference| over a scale at each point of a curve."""
    curve = run.curve
    return [abs(float(y) - exact(float(t))) / scale for t, y in zip(curve["time"], curve[column], strict=True)]


def _kept(words: str, run: Run | Refused, exact: dict[str, float], off: dict[str, dict[str, float]]) -> None:
    """Relative errors of results that the table asks for."""
    for name in ("peak_force", "contact_time"):
        if name in exact:
            there = not isinstance(run, Refused) and name in run.results
            value = run.results[name].value if there and not isinstance(run, Refused) else math.nan
            off.setdefault(name, {})[words] = abs(value / exact[name] - 1.0)


def _results(words: str, off: dict[str, dict[str, float]], source: str) -> list[Row]:
    found = []
    for name, each in off.items():
        label = max(each, key=lambda one: each[one])
        found.append(at_most(f"{words}: {name}, relative", worst(list(each.values())), ALONG, source, label))
    return found


def _single(bench: Bench) -> list[Row]:
    """A triangle and a trapezoid; 30 particles in a, and as many as the program wants."""
    found: list[Row] = []
    for name, d in {"triangle": TRIANGLE, "trapezoid": TRAPEZOID}.items():
        curves, given, free = Curves(name), Judged(f"{name}, spacing given"), Judged(f"{name}, automatic spacing")
        given.source = free.source = TING
        off: dict[str, dict[str, float]] = {}
        for words, body, material in pairs(bench):
            exact = Indentation(body, material, d)
            numbers = exact_of_path(body, material, d)[0]
            run = bench.run(f"{name}_{words}", scene(body, material, d, RADIUS / PARTICLES))
            curves.add(words, run, exact.force, exact.peak[1])
            given.add(words, run, numbers, EXACT)
            _kept(words, run, numbers, off)
            own = scene(body, material, d, RADIUS / PARTICLES)
            free.add(words, bench.run(f"{name}_{words}_free", automatic(own)), numbers, EXACT)
        found += [curves.row(TING), *_results(name, off, TING), *given.rows(), *free.rows()]
    return found


def automatic(one: Scene) -> Scene:
    """The same with the program's own spacing, and units of 1."""
    bodies = {key: value for key, value in one["bodies"].items() if key != "bulk_stiffness"} | {"spacing": "auto"}
    return one | {"bodies": bodies, "material": {"contact_modulus": 1.0, "length_unit": 1.0, "force_unit": 1.0}}


def _sawtooth(bench: Bench) -> list[Row]:
    """A surface that is touched again while it recovers."""
    curves, given, free = Curves("sawtooth"), Judged("sawtooth, spacing given"), Judged("sawtooth, automatic spacing")
    given.source = free.source = EVENTS
    off: dict[str, dict[str, float]] = {}
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
        _kept(words, run, numbers, off)
        own = automatic(scene(body, material, SAWTOOTH, RADIUS / PARTICLES))
        free.add(words, bench.run(f"sawtooth_{words}_free", own), numbers, least)
    return [curves.row(EVENTS), *_results("sawtooth", off, EVENTS), *given.rows(), *free.rows()]


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
    forces, places = Curves("punch", "force", PUNCHED), Curves("punch", "displacement", PUNCHED)
    held = Legs(((0.0, 0.0), (1.0, DEPTH), (2.0, DEPTH), (3.0, 0.5 * DEPTH)))
    profile, punch = {"kind": "flat_punch", "radius": RADIUS}, {m: Punch(RADIUS, one) for m, one in MATERIALS.items()}
    for name, one in punch.items():
        tables = plain(profile, 1.0, 1e-3) | {"viscoelasticity": terms_of(one.material)}
        by_place = {"kind": "history", "displacement": [list(point) for point in held.points]}
        by_force = {"kind": "history", "force": [list(point) for point in held.points]}
        run = bench.run(f"punch_{name}", tables | {"experiment": by_place})
        top = max(one.force(held, t) for t in evenly(held, 20))

        def force(t: float, one: Punch = one) -> float:
            return max(0.0, one.force(held, t))

        forces.add(name, run, force, top)
        creeps = bench.run(f"punch_creep_{name}", tables | {"experiment": by_force})

        def place(t: float, one: Punch = one) -> float:
            return one.displacement(held, t)

        places.add(name, creeps, place, place(3.0))
    return [forces.row("E(t)"), places.row("C(t)")]


def _retarded(bench: Bench) -> list[Row]:
    """Kelvin and Voigt."""
    curves, judged = Curves("Kelvin and Voigt"), Judged("Kelvin and Voigt", "the closed form")
    for time in RETARDED:
        for name, body in bodies().items():
            law, words = KelvinVoigt(body, time), f"{name}, T = {time:g}"
            history = {"kind": "history", "displacement": [list(point) for point in TRIANGLE.points]}
            tables = plain(profile_of(body, RADIUS), RADIUS / PARTICLES, 1e-3)
            run = bench.run(
                f"retarded_{words}", tables | {"viscoelasticity": {"retardation_time": time}, "experiment": history}
            )

            def force(t: float, law: KelvinVoigt = law) -> float:
                return law.force(TRIANGLE(t), DEPTH if t <= 1.0 else -DEPTH)

            curves.add(words, run, force, force(1.0))
            judged.add(words, run, exact_of_path(body, law, TRIANGLE)[0], EXACT)
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
            judge(found, name, one, bench.run(name, one.scene))
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
