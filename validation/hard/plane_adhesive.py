"""Random adhesive contacts on the rigid plane, of any profile, and contacts after preloads up to a million F_A.

References are quadratures of the profile's slope; those after preloads are `references.mdr`, a second one. A closed
path dissipates ∮ F dd = E(a_fg) − E(a_in) at its two instabilities, the snap-in at d = 0 and the separation under
fixed grips, with E(a) = U_el − πa²W.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import product

from validation.hard.judge import OUTSIDE, Case, Expected, Judge, judged, rows_of
from validation.hard.random_plane import ADHESIVE, SOURCE, conducted
from validation.hard.surfaces import surface
from validation.references.mdr import with_zero_load_radius
from validation.row import Row, at_most
from validation.study import Bench, Findings, Study

OF_A_NAME = 0.9
"""Share of the numbers of one name that is to be inside."""
PRELOADS, TOLERANCES = (1.0, 10.0, 1e3, 1e5, 1e6), (1e-2, 1e-3, 1e-4, 1e-5)
FLATTEST, PARTICLES = 1.58e-3, 20.0
"""a₀/R of a sphere with W = 2.8e-10 E*R, whose a/R stays below 0.1; particles in a₀ under these preloads."""
BODIES = (
    surface(1.0, "parabola", radius=1.0 / FLATTEST),
    surface(1.0, "circle", radius=1.0 / FLATTEST),
    surface(1.0, "cone", slope=FLATTEST),
    surface(1.0, "power", exponent=3.0, radius=1.0, height=FLATTEST / 3.0),
)


def after_preloads(full: bool) -> Iterator[Case]:
    """F_A and a₀ after every preload at every tolerance; the quick form takes a Latin square of the profiles."""
    for number, (preload, tolerance, solid) in enumerate(product(PRELOADS, TOLERANCES, BODIES)):
        if not full and (number // 16 + number // 4 - number) % 4:
            continue
        kind, contact = solid.profile["kind"], with_zero_load_radius(solid.body.slope, 1.0, 1.0)
        exact = {"adhesion_force": contact.pull_off_force(), "zero_load_radius": 1.0}
        scene = solid.tables(1.0 / PARTICLES, tolerance) | {"adhesion": {"work_of_adhesion": contact.work_of_adhesion}}
        scene |= {"experiment": {"kind": "pull_off", "preload": preload * exact["adhesion_force"]}}
        yield Case(f"{kind}_{preload:g}_{tolerance:g}", f"{kind} after {preload:g} F_A to {tolerance:g}", kind, scene,
                   Expected(exact))  # fmt: skip


def of_names(judge: Judge) -> Row:
    """A row of the number that is outside most often."""
    names = Counter(n.name for n in judge.numbers)
    outside = Counter(n.name for n in judge.outside)
    shares = {name: outside[name] / count for name, count in sorted(names.items())}
    within = ", ".join(f"{name} {1.0 - share:.3g} of {names[name]}" for name, share in shares.items())
    return at_most("largest share outside of one name", max(shares.values()), 1.0 - OF_A_NAME, SOURCE, within)


def measure(bench: Bench) -> Findings:
    """Rows of the random scenes, and of preloads up to a million F_A."""
    judge = conducted(bench, ADHESIVE)
    rows = [*judge.rows(f"random scenes of seed {ADHESIVE.seed}", SOURCE, OUTSIDE), of_names(judge)]
    return Findings([*rows, *rows_of(judged(bench, after_preloads(bench.full)), "the MDR by quadrature")])


PLANE_ADHESIVE = Study(
    "plane_adhesive",
    "Random adhesive contacts on the rigid plane",
    "JKR's closed form is that of a paraboloid. Are results within their uncertainties for any profile, under "
    "tension, after a preload of a million times the pull-off force, and along paths with instabilities?",
    measure,
)
