"""A body that hits the plane, and an edge that recedes at a finite speed: the experiment `impact`, `[adhesion] rate`.

Restitution, duration and peaks of a half-space that is elastic, of Kelvin and Voigt, relaxes, or adheres are held
against motions of few variables that no chain takes part in; a pull-off at a velocity against the equation of its edge.

python -m validation.hard.impacts SEED COUNT FOLDER      random scenes: a summary, and FOLDER/found.json
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

from validation.doors import Run
from validation.hard.impact_draws import numbers, scene_of
from validation.hard.kinks import Judged
from validation.hard.plane_bodies import Scene
from validation.hard.random_plane import Found, judge, main, outside, rows, run_of
from validation.hard.relaxing_draws import Law, plain, profile_of, terms_of
from validation.references.impact import Adhesive, elastic, kelvin_voigt, relaxing
from validation.references.receding_edge import Receding
from validation.references.relaxing import KelvinVoigt, Material, Power, sphere
from validation.row import Row, at_most, worst
from validation.study import Bench, Findings, Refused, Study, said

NAME = "impacts"
SEED, QUICK, FULL = 20261126, 20, 200
"""The date as the seed."""
PARTICLES, ASKED = 40.0, 1e-3
"""In the radius of the elastic impact, and the tolerance; E* = R = m = v = 1."""
RESTITUTION, STILL, SQUARE = 5e-4, 1e-6, 1e-3
"""What e may be off: with a loss, without one; and e² with adhesion (issue 34)."""
TENSION = 1e-3
"""What a pull-off force at a velocity may be off, relative."""
RETARDED = (0.1, 0.3, 1.0)
"""Retardation times [TU] (guide: e = 0.8327, 0.6091, 0.2808)."""
MATERIALS = {
    "standard solid": Material(((0.5, 1.0),)),
    "Maxwell": Material(((1.0, 1.0),)),
    "three arms": Material(((0.3, 0.2), (0.3, 1.0), (0.2, 10.0))),
}
WORK, WORK_OF_IMPACTS, PARTICLES_AT_REST = 1e-2, 1e-3, 40.0
"""W of the edge and of impacts [FU/LU], with which 10 v_s does not cover the body; particles in the radius at d = 0."""
TIMES, SLOWER = (1.1, 1.5, 3.0, 10.0), 0.9
"""Velocities over the sticking velocity."""
SPEED, EXPONENT, PRELOAD = 1.0, 0.6, 0.1
"""v_0 [LU/TU], n, and the force of the preload [FU]."""
VELOCITIES = (1e-4, 1e-2, 1.0)
"""Of a pull-off, over v_0."""
REFERENCE, PEAKS = 1e-8, 1e-7
"""Relative errors of the references."""
MOTION, ENERGY, EDGE = "the motion, by scipy", "Johnson and Pollock's balance of energy", "Maugis and Barquins's edge"


def bodies() -> dict[str, Power]:
    """Of one radius at one depth."""
    unit = sphere(1.0)
    others = {"cone": Power(1.0, 1.0), "power 3": Power(3.0, 1.0)}
    return {"sphere": unit} | {name: replace(one, factor=1.0 / one.depth(1.0)) for name, one in others.items()}


def measure(bench: Bench) -> Findings:
    """Elastic, of Kelvin and Voigt, relaxing, adhesive; then the edge; then random scenes of all."""
    impacts = [*_elastic(bench), *_retarded(bench), *_relaxing(bench), *_adhesive(bench)]
    found = [*impacts, *_edges(bench), *_histories(bench)]
    return Findings([*found, *rows(conducted(bench, SEED, FULL if bench.full else QUICK), SEED, MOTION)])


def hit(body: Power, spacing: float, velocity: float, **tables: Scene) -> Scene:
    """An impact of the mass 1."""
    experiment = {"kind": "impact", "velocity": velocity}
    return plain(profile_of(body, 1.0), spacing, ASKED) | {"plate": {"mass": 1.0}, "experiment": experiment} | tables


def _result(run: Run | Refused, name: str) -> float:
    return run.results[name].value if not isinstance(run, Refused) and name in run.results else math.nan


def _elastic(bench: Bench) -> list[Row]:
    """Nothing is lost."""
    judged, off = Judged("elastic impact", "the closed form"), []
    for name, body in bodies().items():
        exact = elastic(body, 1.0, 1.0, 1.0)
        run = bench.run(f"elastic_{name}", hit(body, exact.peak_contact_radius / PARTICLES, 1.0))
        judged.add(name, run, numbers(exact, 1.0, 1.0), REFERENCE)
        off.append(abs(_result(run, "restitution") - 1.0))
    return [at_most("elastic impact: e − 1", worst(off), STILL, "the closed form"), *judged.rows()]


def _retarded(bench: Bench) -> list[Row]:
    """Kelvin and Voigt: a sphere, and other bodies in the full form."""
    found: list[Row] = []
    judged = Judged("impact on Kelvin and Voigt's", MOTION)
    for time in RETARDED:
        for name, body in bodies().items():
            exact = kelvin_voigt(KelvinVoigt(body, time), 1.0, 1.0)
            words = f"{name}, T = {time:g}"
            run = _lossy(bench, body, KelvinVoigt(body, time), words)
            judged.add(words, run, numbers(exact, 1.0, 1.0), PEAKS)
            if name == "sphere":
                off = abs(_result(run, "restitution") - exact.restitution)
                found.append(at_most(f"Kelvin and Voigt, {words}: e", off, RESTITUTION, MOTION, said("issue 34", run)))
    return [*found, *judged.rows()]


def _relaxing(bench: Bench) -> list[Row]:
    """A Prony series."""
    judged, off = Judged("impact on a body that relaxes", MOTION), {}
    for kind, material in MATERIALS.items():
        for name, body in bodies().items():
            words, exact = f"{name}, {kind}", relaxing(body, material, 1.0, 1.0)
            run = _lossy(bench, body, material, words)
            judged.add(words, run, numbers(exact, 1.0, 1.0), PEAKS)
            off[words] = abs(_result(run, "restitution") - exact.restitution)
    label = max(off, key=lambda one: math.inf if math.isnan(off[one]) else off[one])
    return [
        at_most("impact on a body that relaxes: e", worst(list(off.values())), RESTITUTION, MOTION, label),
        *judged.rows(),
    ]


def _lossy(bench: Bench, body: Power, law: Law, words: str) -> Run | Refused:
    spacing = elastic(body, 1.0, 1.0, 1.0).peak_contact_radius / PARTICLES
    return bench.run(f"lossy_{words}", hit(body, spacing, 1.0, viscoelasticity=terms_of(law)))


def _adhesive(bench: Bench) -> list[Row]:
    """Johnson, Kendall and Roberts's."""
    found, judged = list[Row](), Judged("adhesive impact", ENERGY)
    for name, body in bodies().items():
        contact = Adhesive(body, WORK_OF_IMPACTS)
        sticks, spacing = contact.sticking_velocity(1.0), contact.touch / PARTICLES_AT_REST
        for times in TIMES:
            velocity, words = times * sticks, f"{name}, {times:g} v_s"
            run = bench.run(
                f"adhesive_{words}", hit(body, spacing, velocity, adhesion={"work_of_adhesion": WORK_OF_IMPACTS})
            )
            exact = contact.impact(1.0, velocity)
            judged.add(words, run, numbers(exact, 1.0, velocity), PEAKS)
            if name == "sphere":
                off = abs(_result(run, "restitution") ** 2 - (1.0 - times**-2))
                found.append(at_most(f"adhesive impact, {words}: e²", off, SQUARE, ENERGY, said("issue 34", run)))
        slow = hit(body, spacing, SLOWER * sticks, adhesion={"work_of_adhesion": WORK_OF_IMPACTS})
        run = bench.run(f"adhesive_{name}_slow", slow)
        kinetic = {"restitution": 0.0, "dissipated_energy": 0.5 * (SLOWER * sticks) ** 2, "contact_time": math.inf}
        judged.add(f"{name}, {SLOWER:g} v_s", run, kinetic, PEAKS)
    return [*found, *judged.rows()]


def _edges(bench: Bench) -> list[Row]:
    """A pull-off at a velocity."""
    found, judged = list[Row](), Judged("pull-off at a velocity", EDGE)
    for name, body in bodies().items():
        contact = Adhesive(body, WORK)
        edge = Receding(contact, SPEED, EXPONENT)
        rate = {"work_of_adhesion": WORK, "rate": {"velocity": SPEED, "exponent": EXPONENT}}
        for velocity in VELOCITIES:
            force, radius = edge.pull_off(PRELOAD, velocity)
            pull = {"kind": "pull_off", "preload": PRELOAD, "velocity": velocity}
            tables = plain(profile_of(body, 1.0), contact.touch / PARTICLES_AT_REST, ASKED)
            words = f"{name}, V = {velocity:g} v₀"
            run = bench.run(f"edge_{words}", tables | {"adhesion": rate, "experiment": pull})
            judged.add(words, run, {"adhesion_force": force, "critical_radius": radius}, PEAKS)
            off = abs(_result(run, "adhesion_force") / force - 1.0)
            found.append(at_most(f"pull-off at a velocity, {words}: F_A", off, TENSION, EDGE, said("issue 34", run)))
    return [*found, *judged.rows()]


def _histories(bench: Bench) -> list[Row]:
    """Pressed in at equilibrium, then drawn off at a velocity, as a history."""
    judged, off = Judged("history of an edge with a speed", EDGE), {}
    for name, body in bodies().items():
        contact = Adhesive(body, WORK_OF_IMPACTS)
        edge, deepest = Receding(contact, SPEED, EXPONENT), body.depth(2.5 * contact.touch)
        start = edge.at(deepest)
        for velocity in VELOCITIES[1:]:
            path, words = edge.drawn(start, velocity), f"{name}, V = {velocity:g} v₀"
            last = float(path.t[-1])
            lasts = 1.5 * last / velocity
            rate = {"work_of_adhesion": WORK_OF_IMPACTS, "rate": {"velocity": SPEED, "exponent": EXPONENT}}
            points = [[0.0, -deepest], [2.0, deepest], [2.0 + lasts, deepest - 1.5 * last]]
            tables = plain(profile_of(body, 1.0), contact.touch / PARTICLES_AT_REST, ASKED)
            history = {"kind": "history", "displacement": points}
            run = bench.run(f"history_{words}", tables | {"adhesion": rate, "experiment": history})
            judged.add(words, run, {"peak_force": contact.force(start), "contact_time": 1.0 + last / velocity}, 1e-4)
            off[words] = math.nan
            if isinstance(run, Refused):
                continue
            tension, each = edge.largest(start, velocity)[0], [0.0]
            for t, d, F in zip(*(run.curve[key] for key in ("time", "displacement", "force")), strict=True):
                if (drawn := (float(t) - 2.0) * velocity) > 0.0:
                    exact = edge.force(float(path.sol(drawn)[0]), float(d)) if drawn < last else 0.0
                    each.append(abs(float(F) - exact) / tension)
            off[words] = max(each)
    label = max(off, key=lambda one: math.inf if math.isnan(off[one]) else off[one])
    words = f"history of an edge with a speed: force along {len(off)} curves over the largest tension"
    return [at_most(words, worst(list(off.values())), TENSION, EDGE, label), *judged.rows()]


def conducted(bench: Bench, seed: int, count: int, tell: Callable[[str], None] = lambda _: None) -> Found:
    """`count` random scenes of a seed."""
    found = Found()
    for number in range(count):
        one, name = scene_of(seed, number), f"impact_{seed}_{number}"
        judge(found, name, one, run_of(bench, name, one.scene))
        if (number + 1) % 25 == 0:
            tell(f"{number + 1} scenes, {len(found.numbers)} numbers, {len(outside(found))} outside")
    return found


IMPACTS = Study(
    NAME,
    "Impacts, and an edge with a speed",
    "How fast a body leaves, how long it touches and how hard it presses follow from motions of few variables, and a "
    "pull-off at a velocity from the equation of its edge. Are the chain's numbers these, within their uncertainties?",
    measure,
)


if __name__ == "__main__":
    main(conducted)
