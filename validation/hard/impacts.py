"""A body that hits the plane, and an edge that recedes at a finite speed: the experiment `impact`, `[adhesion] rate`.

Restitution, duration and peaks of a half-space that is elastic, of Kelvin and Voigt, relaxes, or adheres are held
against motions of few variables that no chain takes part in; a pull-off at a velocity against the equation of its edge.
"""

from collections.abc import Iterator

from validation.hard import draws, random_plane, relaxing, surfaces, units
from validation.hard.expected import looked_up
from validation.hard.judge import Case, Number, absolute, judged
from validation.references.impact import Adhesive, elastic
from validation.references.receding_edge import Receding
from validation.references.relaxing import KelvinVoigt, Legs, Power, sphere
from validation.study import Bench, Lines, Study

PARTICLES = 40.0
"""In the radius of the elastic impact, or in that at d = 0; E* = R = m = v = 1."""
RESTITUTION, STILL, SQUARE = 5e-4, 1e-6, 1e-3
"""What e may be off: with a loss, without one; and e² with adhesion (issue 34)."""
TENSION = 1e-3
"""What a pull-off force at a velocity may be off, relative; a force along a history over the largest tension."""
RETARDED = (0.1, 0.3, 1.0)
"""Retardation times [TU] (guide: e = 0.8327, 0.6091, 0.2808)."""
WORK, WORK_OF_IMPACTS = 1e-2, 1e-3
"""W of the edge and of impacts [FU/LU], with which 10 v_s does not cover the body."""
TIMES = (0.9, 1.1, 1.5, 3.0, 10.0)
"""Velocities over the sticking velocity."""
RATE, PRELOAD = {"velocity": 1.0, "exponent": 0.6}, 0.1
"""v_0 [LU/TU], n, and the force of the preload [FU]."""
VELOCITIES = (1e-4, 1e-2, 1.0)
"""Of a pull-off, over v_0."""
MOTION, ENERGY, EDGE = "the motion, by scipy", "Johnson and Pollock's balance of energy", "Maugis and Barquins's edge"


def cases() -> Iterator[Case]:
    """Of each body."""
    for name, body in (relaxing.bodies(1.0, 1.0) | {"sphere": sphere(1.0)}).items():
        solid = surfaces.power(body, 1.0)
        laws: dict[str, dict[str, units.Scene]] = {
            "elastic impact": {name: {}},
            "impact on Kelvin and Voigt's": {
                f"{name}, T = {time:g}": draws.terms_of(KelvinVoigt(body, time)) for time in RETARDED
            },
            "impact on a body that relaxes": {
                f"{name}, {kind}": draws.terms_of(one) for kind, one in relaxing.MATERIALS.items()
            },
        }
        width = elastic(body, 1.0, 1.0, 1.0).peak_contact_radius
        for group, tables in laws.items():
            for words, table in tables.items():
                more = {"viscoelasticity": table} if table else {}
                yield looked_up(f"{group}_{words}", group, words, solid, hit(solid, width, 1.0) | more)
        contact = Adhesive(body, WORK_OF_IMPACTS)
        for times in TIMES:
            scene = hit(solid, contact.touch, times * contact.sticking_velocity(1.0))
            scene |= {"adhesion": {"work_of_adhesion": WORK_OF_IMPACTS}}
            yield looked_up(
                f"adhesive_{name}, {times:g} v_s", "adhesive impact", f"{name}, {times:g} v_s", solid, scene
            )
        yield from _edges(name, solid, body)


def hit(solid: surfaces.Surface, width: float, velocity: float) -> units.Scene:
    """An impact of the mass 1 whose contact is so wide."""
    experiment = {"kind": "impact", "velocity": velocity}
    return solid.tables(width / PARTICLES) | {"plate": {"mass": 1.0}, "experiment": experiment}


def _edges(name: str, solid: surfaces.Surface, body: Power) -> Iterator[Case]:
    """Pull-offs at velocities; pressed in at equilibrium, then drawn off at a velocity, as a history."""
    for velocity in VELOCITIES:
        words = f"{name}, V = {velocity:g} v₀"
        scene = solid.tables(Adhesive(body, WORK).touch / PARTICLES)
        scene |= {"adhesion": {"work_of_adhesion": WORK, "rate": RATE},
                  "experiment": {"kind": "pull_off", "preload": PRELOAD, "velocity": velocity}}  # fmt: skip
        yield looked_up(f"edge_{words}", "pull-off at a velocity", words, solid, scene)
        contact = Adhesive(body, WORK_OF_IMPACTS)
        edge, deepest = Receding(contact, RATE["velocity"], RATE["exponent"]), body.depth(2.5 * contact.touch)
        # Half as far again as where they part.
        way = 1.5 * float(edge.drawn(contact.radius_at(deepest), velocity).t[-1])
        legs = Legs(((0.0, -deepest), (2.0, deepest), (2.0 + way / velocity, deepest - way)))
        scene = solid.tables(contact.touch / PARTICLES) | draws.history(legs)
        scene |= {"adhesion": {"work_of_adhesion": WORK_OF_IMPACTS, "rate": RATE}}
        if velocity > VELOCITIES[0]:
            yield looked_up(f"history_{words}", "history of an edge with a speed", words, solid, scene)


def squared(n: Number) -> float:
    """The error of e²."""
    return abs(n.value**2 - n.reference**2)


def measure(bench: Bench) -> Lines:
    """Elastic, of Kelvin and Voigt, relaxing, adhesive; then the edge; then random scenes of all."""
    for words, judge in judged(bench, cases()).items():
        source = EDGE if "edge" in words or "velocity" in words else ENERGY if words.startswith("adhesive") else MOTION
        yield from judge.rows(words, source)
        if words == "pull-off at a velocity":
            yield judge.near(words, "adhesion_force", TENSION, source)
        elif words.startswith("history"):
            yield judge.curve(words, "force", TENSION, source, "the largest tension")
        elif words.startswith("adhesive"):
            yield judge.near(f"{words}, e²", "restitution", SQUARE, source, squared)
        else:
            bound = STILL if words.startswith("elastic") else RESTITUTION
            yield judge.near(words, "restitution", bound, source, absolute)
    yield from random_plane.random_rows(bench, random_plane.IMPACTS, MOTION)


IMPACTS = Study(
    "impacts",
    "Impacts, and a contact edge that recedes at a finite speed",
    "Restitution, contact time and largest force follow from ordinary differential equations of few variables, and a "
    "pull-off at a velocity from the equation of its edge. Are the results of the particles within their "
    "uncertainties of these?",
    measure,
)
